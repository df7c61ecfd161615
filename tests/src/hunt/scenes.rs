//! The scenes of the families, and a free place in them for a ball.

use crate::random::Random;
use crate::world::World;
use carom_dynamics::body::Ball;
use carom_dynamics::effects::drag::Drag;
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::gravity::Gravity;
use carom_dynamics::effects::restitution::Restitution;
use carom_dynamics::error::ValueError;
use carom_dynamics::scene::{Method, Scene};
use carom_dynamics::surface::{Material, Shape, Surface};
use carom_geometry::mesh::Mesh;
use carom_geometry::plane::Plane;
use carom_geometry::polygon::Polygon;
use nalgebra::{Point3, Vector3};
use std::sync::Arc;

/// Gravity in m/s^2.
const G: f64 = 9.81;
/// Tries to find a place for a ball.
const TRIES: usize = 200;

/// A scene whose ball has no place yet.
pub(super) struct Draft {
    pub(super) scene: Scene,
    low: Point3<f64>,
    high: Point3<f64>,
    /// Whether the ball begins inside the mesh, if that matters.
    inside: Option<bool>,
    /// Whether planes count as a border only on the side that their normal points to.
    fenced: bool,
    /// Whether the middle of the box is a likely start, for the sake of exact ties.
    central: bool,
    radius: f64,
    mass: f64,
    velocity: Vector3<f64>,
}

fn pick<T: Clone>(random: &mut Random, all: &[T]) -> T {
    all[random.below(all.len())].clone()
}

/// From 10^-`decades` to 1, each decade as likely.
fn decades(random: &mut Random, decades: f64) -> f64 {
    10f64.powf(-decades * random.unit())
}

fn direction(random: &mut Random) -> Vector3<f64> {
    loop {
        let v = random.vector(1.0);
        if v.norm() < 1.0 && v.norm() > 0.1 {
            return v.normalize();
        }
    }
}

fn legal<T>(value: Result<T, ValueError>) -> T {
    value.unwrap_or_else(|e| panic!("{e}"))
}

fn material(random: &mut Random) -> Material {
    let restitution = legal(Restitution::new(pick(random, &[0.0, 0.3, 0.7, 0.9, 1.0])));
    let friction = match random.below(5) {
        0 => legal(Friction::linear(pick(random, &[0.1, 0.5, 1.0]))),
        1 => legal(Friction::coulomb(pick(random, &[0.05, 0.3, 0.8, 2.0]))),
        2 => legal(Friction::impulse(pick(random, &[0.05, 0.3, 0.8]))),
        _ => Friction::None,
    };
    Material { restitution, friction }
}

/// Half of the scenes by exact flight, the others by every other method, with drag and wind among them.
fn method(random: &mut Random) -> (Option<Method>, Option<Drag>) {
    let wind = |random: &mut Random| {
        let law = pick(random, &[Drag::linear(0.05), Drag::quadratic(0.47, 1.2)]);
        let wind = pick(random, &[0.0, 3.0]) * direction(random);
        Some(legal(law.and_then(|drag| drag.in_wind(wind))))
    };
    let step = pick(random, &[0.001, 0.01, 0.03]);
    match random.below(12) {
        0 => (Some(Method::Rk4 { step }), None),
        1 => (Some(Method::Rk4 { step }), wind(random)),
        2 => (Some(Method::Adaptive { tolerance: 1e-9 }), wind(random)),
        3 => (Some(Method::Adaptive { tolerance: 1e-6 }), None),
        4 => (Some(Method::Euler { step }), None),
        5 => (Some(Method::SemiImplicitEuler { step }), None),
        _ => (None, None),
    }
}

fn plane(point: Point3<f64>, normal: Vector3<f64>) -> Option<Shape> {
    Plane::from_point_normal(point, normal).ok().map(Shape::Plane)
}

impl Draft {
    /// The draft of a family; `mesh` is its mesh. None where the random numbers meet in nothing.
    pub(super) fn of(family: &str, mesh: Option<&Arc<Mesh>>, random: &mut Random) -> Option<Self> {
        let (method, drag) = method(random);
        let gravity = match random.below(5) {
            0 => Vector3::zeros(),
            1 | 2 => G * direction(random),
            _ => Vector3::new(0.0, 0.0, -G),
        };
        let speed = pick(random, &[0.0, 0.5, 3.0, 10.0]);
        let duration = pick(random, &[1.0, 5.0]);
        let bounds = mesh.map(|m| (*m.bounds().min(), *m.bounds().max()));
        let (low, high) = bounds.unwrap_or((Point3::new(-2.0, -2.0, -2.0), Point3::new(2.0, 2.0, 2.0)));
        let scene = Scene { drag, method, ..Scene::lasting(duration) };
        let mut draft = Self {
            scene,
            low,
            high,
            inside: None,
            fenced: true,
            central: false,
            radius: pick(random, &[0.0, 1.0, 1.0, 1.0, 1.0, 1.0]) * 0.1 * decades(random, 2.0),
            mass: 0.1,
            velocity: speed * direction(random),
        };
        if let Some(mesh) = mesh {
            draft.add(random, Shape::Mesh(Arc::clone(mesh)));
        }
        let gravity = match family {
            "spot" => draft.inside_of_it(gravity),
            "bunny" => draft.bunny(random, gravity)?,
            "stairs" => draft.stairs(random, gravity),
            "terrain" => draft.terrain(random),
            "jacksboro" => draft.mountains(random),
            "soup" => draft.soup(random, gravity)?,
            "wedge" => draft.wedge(random)?,
            "box" => draft.closed_box(random, gravity)?,
            _ => panic!("no family {family}"),
        };
        draft.scene.gravity = (gravity != Vector3::zeros()).then(|| legal(Gravity::uniform(gravity)));
        Some(draft)
    }

    fn add(&mut self, random: &mut Random, shape: Shape) {
        let name = format!("s{}", self.scene.surfaces.len());
        self.scene.surfaces.push(Surface { name, material: material(random), shape });
    }

    fn grow(&mut self, share: f64) {
        let more = (self.high - self.low) * share;
        (self.low, self.high) = (self.low - more, self.high + more);
    }

    fn inside_of_it(&mut self, gravity: Vector3<f64>) -> Vector3<f64> {
        self.inside = Some(true);
        gravity
    }

    /// In the bunny, or around it over a floor across gravity.
    fn bunny(&mut self, random: &mut Random, gravity: Vector3<f64>) -> Option<Vector3<f64>> {
        self.inside = Some(random.below(2) == 0);
        if self.inside == Some(false) {
            let middle = self.low + (self.high - self.low) * 0.5;
            if let Some(down) = gravity.try_normalize(0.0) {
                self.add(random, plane(middle + down * 3.0, -gravity)?);
            }
            self.grow(0.2);
        }
        Some(gravity)
    }

    /// On the stairs or in them; half of the time gravity is along an axis.
    fn stairs(&mut self, random: &mut Random, gravity: Vector3<f64>) -> Vector3<f64> {
        self.inside = Some(random.below(3) == 0);
        if self.inside == Some(false) {
            self.grow(0.1);
        }
        let axes = [-Vector3::z(), -Vector3::y(), Vector3::y(), -Vector3::x()].map(|n| G * n);
        let axis = pick(random, &axes);
        pick(random, &[gravity, axis])
    }

    fn terrain(&mut self, random: &mut Random) -> Vector3<f64> {
        self.high.z += 3.0;
        self.low.z = self.high.z - pick(random, &[2.0, 6.0]);
        self.radius *= 5.0;
        -G * Vector3::z()
    }

    fn mountains(&mut self, random: &mut Random) -> Vector3<f64> {
        self.low.z = self.high.z + 400.0;
        self.high.z += 1000.0;
        self.radius = pick(random, &[0.0, 0.1, 1.0, 10.0, 100.0, 400.0]);
        // As heavy as clay.
        self.mass = (8000.0 * self.radius.powi(3)).max(0.1);
        self.velocity *= 10.0;
        self.scene.duration = pick(random, &[30.0, 120.0]);
        -G * Vector3::z()
    }

    /// Up to twelve triangles anyhow, a third of them needles, over a floor across gravity.
    fn soup(&mut self, random: &mut Random, gravity: Vector3<f64>) -> Option<Vector3<f64>> {
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        for i in 0..=random.below(12) as u32 {
            let corner = Point3::from(direction(random) * random.unit());
            let size = 2.0 * decades(random, 2.0);
            let needle = 0.1 * decades(random, 8.0);
            let thin = pick(random, &[1.0, 1.0, needle]);
            let a = direction(random) * size;
            vertices.extend([corner, corner + a, corner + a * random.unit() + direction(random) * (size * thin)]);
            faces.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        self.add(random, Shape::Mesh(Arc::new(Mesh::new(vertices, faces).ok()?)));
        let up = if gravity == Vector3::zeros() { direction(random) } else { -gravity };
        self.add(random, plane(Point3::origin() - up.normalize() * 1.5, up)?);
        self.radius *= pick(random, &[1.0, 10.0]);
        self.fenced = false;
        Some(gravity)
    }

    /// Two planes or squares that lean towards each other over an edge, acute on purpose, and up to two across its ends.
    fn wedge(&mut self, random: &mut Random) -> Option<Vector3<f64>> {
        let (axis, up) = (direction(random), direction(random));
        let side = up.cross(&axis).try_normalize(0.01)?;
        let along = axis.cross(&side);
        for k in 0..2 + random.below(3) {
            let lean = 1.5 * decades(random, 3.0);
            let (point, normal) = match k {
                0 => (Point3::origin(), along * lean.sin() - side * lean.cos()),
                1 => (Point3::origin(), along * lean.sin() + side * lean.cos()),
                2 => (Point3::from(-axis), axis + up * 0.2),
                _ => (Point3::from(axis), up * 0.2 - axis),
            };
            let square = |random: &mut Random| {
                let a = normal.cross(&direction(random)).try_normalize(0.01)? * 4.0;
                let b = normal.normalize().cross(&a);
                Polygon::new(vec![point - a - b, point + a - b, point + a + b, point - a + b]).ok().map(Shape::Polygon)
            };
            let shape = if random.below(2) == 0 { plane(point, normal) } else { square(random) };
            self.add(random, shape?);
        }
        (self.low, self.high) = (Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0));
        Some(-G * up)
    }

    /// A closed box of planes and rectangles, near the origin or far from it, with starts that meet in its corners.
    fn closed_box(&mut self, random: &mut Random, gravity: Vector3<f64>) -> Option<Vector3<f64>> {
        let size = Vector3::new(1.0, 2.0, 1.5);
        let shift = pick(random, &[0.0, 0.0, 1e3, 1e6]);
        (self.low, self.high) = (Point3::new(shift, shift, shift), Point3::new(shift, shift, shift) + size);
        for k in 0..6 {
            let (axis, far) = (k % 3, k >= 3);
            let unit = |i: usize| Vector3::from_fn(|j, _| if i % 3 == j { size[j] } else { 0.0 });
            let point = if far { self.low + unit(axis) } else { self.low };
            let (a, b) = (unit(axis + 1), unit(axis + 2));
            let shape = if random.below(2) == 0 {
                plane(point, if far { -unit(axis) } else { unit(axis) })?
            } else {
                Shape::Polygon(Polygon::new(vec![point, point + a, point + a + b, point + b]).ok()?)
            };
            self.add(random, shape);
        }
        self.radius = pick(random, &[0.0, 0.125, 0.25, 0.1, 0.3]);
        self.central = true;
        let exact = [Vector3::new(1.0, 1.0, 1.0), Vector3::x(), Vector3::new(-1.0, 1.0, 0.0), Vector3::zeros()];
        let exact = pick(random, &exact);
        self.velocity = pick(random, &[self.velocity, exact]);
        Some(gravity)
    }

    /// The scene with its ball in a free place; none if no try finds one.
    pub(super) fn place(mut self, world: &World, random: &mut Random) -> Option<Scene> {
        for _ in 0..TRIES {
            let mut share = Vector3::from_fn(|_, _| random.unit());
            if self.central && random.below(2) == 0 {
                share = Vector3::repeat(0.5);
            }
            let position = self.low + (self.high - self.low).component_mul(&share);
            if self.is_free(&position, world) {
                let ball = legal(Ball::new(position, self.velocity, self.radius, Some(self.mass)));
                self.scene.balls = vec![ball];
                return Some(self.scene);
            }
        }
        None
    }

    fn is_free(&self, position: &Point3<f64>, world: &World) -> bool {
        let beside = |d: f64| (if self.fenced { d } else { d.abs() }) > self.radius;
        world.planes.iter().all(|(p, n, _)| beside(n.dot(&(position - p))))
            && world.distance(position, 2.0 * self.radius + 1.0) > self.radius
            && self.inside.is_none_or(|inside| (world.winding(position).round() != 0.0) == inside)
    }
}
