//! Closed meshes, as they are, squashed, far away and tiny; and places inside them from which to shoot.

use crate::exact::segment_meets;
use crate::obj;
use crate::random::Random;
use crate::solids::{Solid, icosphere, moved};
use crate::world::{U, World};
use carom_geometry::mesh::Mesh;
use nalgebra::{Point3, Vector3};
use std::sync::Arc;

/// The bodies.
pub const BODIES: [&str; 3] = ["cow", "bunny", "icosphere"];

/// What is done to a body.
///
/// The vertices are rounded where they come to lie, the connectivity stays. Squashed and tiny, every product is exact but for one rounding
/// (none, for a power of two). Far away, places are rounded to 2^-27 m, a millionth of the smallest edge: faces turn by as much, and none of
/// the three bodies folds over for it, which the winding number of the starts confirms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Treatment {
    /// Nothing.
    AsItIs,
    /// z times 1e-6.
    Squashed,
    /// Moved by (1e8, -1e8, 1e8) m.
    Far,
    /// All lengths times 2^-300.
    Tiny,
}

/// The treatments.
pub const TREATMENTS: [Treatment; 4] = [Treatment::AsItIs, Treatment::Squashed, Treatment::Far, Treatment::Tiny];

/// A closed mesh, wound outwards.
#[derive(Debug, Clone)]
pub struct Closed {
    /// Which of [`BODIES`].
    pub body: &'static str,
    /// What was done to it.
    pub treatment: Treatment,
    /// It.
    pub mesh: Arc<Mesh>,
    /// It as a checker sees it.
    pub world: World,
    /// Its longest side, in m.
    pub size: f64,
}

/// A free place inside, near an edge or a vertex or anywhere.
#[derive(Debug, Clone, Copy)]
pub struct Start {
    /// The place.
    pub position: Point3<f64>,
    /// How far the nearest face is, in m.
    pub room: f64,
    /// The face it is near to.
    pub face: u32,
}

/// Tries to find a start.
const TRIES: usize = 1000;

fn body(name: &str) -> Solid {
    match name {
        "cow" => obj::read(include_str!("../../crates/app/scenes/meshes/spot_triangulated.obj")),
        "bunny" => obj::read(include_str!("../../crates/app/scenes/meshes/low_poly_bunny.obj")),
        "icosphere" => icosphere(2),
        _ => panic!("no body {name}"),
    }
}

impl Closed {
    /// A body under a treatment.
    pub fn new(name: &'static str, treatment: Treatment) -> Self {
        let solid = body(name);
        let (vertices, faces) = match treatment {
            Treatment::AsItIs => solid,
            Treatment::Squashed => moved(&solid, |p| Point3::new(p.x, p.y, 1e-6 * p.z)),
            Treatment::Far => moved(&solid, |p| p + Vector3::new(1e8, -1e8, 1e8)),
            Treatment::Tiny => moved(&solid, |p| p * 2f64.powi(-300)),
        };
        let mesh = Arc::new(Mesh::new(vertices, faces).unwrap_or_else(|e| panic!("{name}: {e}")));
        let world = World::of_mesh(&mesh);
        let size = mesh.bounds().extent().amax();
        Self { body: name, treatment, mesh, world, size }
    }

    /// Every body under every treatment.
    pub fn all() -> Vec<Self> {
        BODIES.iter().flat_map(|body| TREATMENTS.map(|treatment| Self::new(body, treatment))).collect()
    }

    /// Whether `x`, which is on no face, is inside: by the winding number, to which the solver is blind.
    ///
    /// Its rounding is far below 1/2 wherever there is room for a point: 0.03 in the rim of a squashed sphere.
    pub fn is_inside(&self, x: &Point3<f64>) -> bool {
        self.world.winding(x).round() == 1.0
    }

    /// Whether `x` is on the side of the mesh that `start` is on: by the parity of the faces between them, in rational numbers.
    pub fn is_with(&self, start: &Point3<f64>, x: &Point3<f64>) -> bool {
        self.world.triangles.iter().filter(|(triangle, _)| segment_meets(triangle, start, x)).count() % 2 == 0
    }

    /// The least distance at which a place is beside a face and not on it, whatever the face: what a point keeps, four times.
    pub fn resolved(&self) -> f64 {
        4.0 * 16384.0 * U * self.world.farthest
    }

    /// A point of an edge of `face`, or a corner of it, as near as f64 gets.
    pub fn feature(&self, face: u32, random: &mut Random) -> Point3<f64> {
        let corners = self.mesh.triangle(face);
        let side = random.below(3);
        let (a, b) = (corners[side], corners[(side + 1) % 3]);
        match random.below(4) {
            0 => a,
            1 => a + (b - a) * 0.5,
            _ => a + (b - a) * random.unit(),
        }
    }

    /// A place inside, by `random`.
    pub fn start(&self, random: &mut Random) -> Start {
        for _ in 0..TRIES {
            let face = random.below(self.mesh.faces().len()) as u32;
            let Some(normal) = self.mesh.normal(face) else { continue };
            let depth = self.size * random.octave(-26, -1);
            // Towards the middle of the face, so that beside an edge there is room.
            let corners = self.mesh.triangle(face);
            let middle = nalgebra::center(&nalgebra::center(&corners[0], &corners[1]), &corners[2]);
            let edge = self.feature(face, random);
            let position = edge + (middle - edge) * (0.5 * random.unit()) - normal.into_inner() * depth;
            let room = self.world.distance(&position, 2.0 * depth);
            if room > self.resolved() && self.is_inside(&position) {
                return Start { position, room, face };
            }
        }
        panic!("{} {:?}: no free place inside", self.body, self.treatment)
    }

    /// A face that shares a corner with `face`.
    pub fn neighbour(&self, face: u32, random: &mut Random) -> u32 {
        let corner = self.mesh.faces()[face as usize][random.below(3)];
        let around = self.mesh.vertex_faces(corner);
        around[random.below(around.len())]
    }
}
