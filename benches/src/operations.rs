//! The operations whose instructions are counted, each in a function of its own name.

use crate::cases::{Case, ball_and_triangle};
use crate::random::Random;
use crate::scenes::{self, Result};
use crate::terrain::{HALF, height, terrain};
use carom_dynamics::body::Ball;
use carom_dynamics::plan::Plan;
use carom_dynamics::simulate::simulate;
use carom_geometry::bvh::Bvh;
use carom_geometry::clearance::Clearance;
use carom_geometry::closest::closest_point;
use carom_geometry::contact::{MovingBall, first_contact};
use carom_geometry::mesh::Mesh;
use carom_geometry::path::Path;
use carom_geometry::predicates::orient3d;
use carom_geometry::segment::segment_hits_triangle;
use carom_geometry::sweep::Work;
use nalgebra::{Point3, Vector3};
use std::hint::black_box;

/// How often each operation is done in one call of its function.
pub const TIMES: usize = 64;

/// Squares along a side of the terrain: small, since what is counted is not what the caches do.
const SQUARES: u32 = 64;

/// What the operations work on.
pub struct Bench {
    cases: Vec<Case>,
    mesh: Mesh,
    segments: Vec<[Point3<f64>; 2]>,
    throws: Vec<Path>,
    coefficients: Vec<[f64; 5]>,
    one_ball: Plan,
    room: Plan,
    terrain: Plan,
}

/// An operation: its name, and the function of that name that does it [`TIMES`] times.
pub type Operation = (&'static str, fn(&Bench));

/// Queries of geometry.
pub const GEOMETRY: [Operation; 11] = [
    ("orientation", orientation),
    ("quadratic_entry", quadratic_entry),
    ("quartic_entry", quartic_entry),
    ("closest_point_of_triangle", closest_point_of_triangle),
    ("segment_against_triangle", segment_against_triangle),
    ("ball_against_triangle", ball_against_triangle),
    ("segment_through_tree", segment_through_tree),
    ("segment_against_mesh", segment_against_mesh),
    ("ball_against_mesh", ball_against_mesh),
    ("touches_of_mesh", touches_of_mesh),
    ("tree_over_64_faces", tree_over_64_faces),
];

/// Flights and scenes.
pub const SCENES: [Operation; 3] = [
    ("one_ball_for_3_s", one_ball_for_3_s),
    ("ball_in_room_for_1_s", ball_in_room_for_1_s),
    ("ball_on_terrain_for_2_s", ball_on_terrain_for_2_s),
];

impl Bench {
    /// Makes everything that is worked on.
    pub fn new() -> Result<Self> {
        let (vertices, faces) = terrain(SQUARES);
        let mut random = Random::new(7);
        let mut over = || {
            let (x, y) = (random.within(1.0 - HALF, HALF - 1.0), random.within(1.0 - HALF, HALF - 1.0));
            let away = random.vector(1.0);
            (Point3::new(x, y, height(x, y) + 0.5), Vector3::new(away.x, away.y, -1.0))
        };
        let starts: Vec<_> = (0..TIMES).map(|_| over()).collect();
        let mut random = Random::new(8);
        let mut coefficients = || {
            let (a, b) = (random.vector(1.0), random.vector(1.0));
            [a.x.abs(), a.y, a.z, b.x, b.y]
        };
        Ok(Self {
            cases: ball_and_triangle().into_iter().step_by(7).take(TIMES).collect(),
            mesh: Mesh::new(vertices, faces)?,
            segments: starts.iter().map(|(p, v)| [*p, p + v]).collect(),
            throws: starts.iter().map(|(p, v)| Path::parabola(*p, *v, Vector3::new(0.0, 0.0, -4.9))).collect(),
            coefficients: (0..TIMES).map(|_| coefficients()).collect(),
            one_ball: Plan::new(&scenes::one_ball(3.0, 0.8)?)?,
            room: Plan::new(&scenes::balls_in_room(TIMES, 1.0)?)?,
            terrain: Plan::new(&scenes::balls_on_terrain(SQUARES, TIMES, 0.7, 2.0)?)?,
        })
    }
}

#[inline(never)]
fn orientation(bench: &Bench) {
    for case in &bench.cases {
        let [a, b, c] = &case.triangle;
        black_box(orient3d(a, b, c, &case.path.start()));
    }
}

#[inline(never)]
fn quadratic_entry(bench: &Bench) {
    for &[c, b, a, ..] in &bench.coefficients {
        black_box(Clearance::new(black_box([c, b, a, 0.0, 0.0])).first_entry(0.0, 1.0));
    }
}

#[inline(never)]
fn quartic_entry(bench: &Bench) {
    for coefficients in &bench.coefficients {
        black_box(Clearance::new(*coefficients).first_entry(0.0, 1.0));
    }
}

#[inline(never)]
fn closest_point_of_triangle(bench: &Bench) {
    for case in &bench.cases {
        black_box(closest_point(&case.triangle, &case.path.start()));
    }
}

#[inline(never)]
fn segment_against_triangle(bench: &Bench) {
    for case in &bench.cases {
        black_box(segment_hits_triangle(&case.path.start(), &case.path.at(1.0), &case.triangle));
    }
}

#[inline(never)]
fn ball_against_triangle(bench: &Bench) {
    for case in &bench.cases {
        let ball = MovingBall { path: &case.path, radius: case.radius, holds: &[] };
        black_box(first_contact(&ball, &case.triangle, 0.0, 1.0, &mut 0));
    }
}

#[inline(never)]
fn segment_through_tree(bench: &Bench) {
    for [from, to] in &bench.segments {
        let segment = carom_geometry::bvh::FatSegment { from: *from, to: *to, radius: 0.0 };
        black_box(bench.mesh.bvh().visit(&segment, |_| f64::INFINITY));
    }
}

#[inline(never)]
fn segment_against_mesh(bench: &Bench) {
    for [from, to] in &bench.segments {
        black_box(bench.mesh.first_pierced(from, to, &mut Work::default()));
    }
}

#[inline(never)]
fn ball_against_mesh(bench: &Bench) {
    for path in &bench.throws {
        let ball = MovingBall { path, radius: 0.05, holds: &[] };
        black_box(bench.mesh.first_contact(&ball, 1.0, |_| 0.0, &mut Work::default()));
    }
}

#[inline(never)]
fn touches_of_mesh(bench: &Bench) {
    for path in &bench.throws {
        let start = path.start();
        let place = Point3::new(start.x, start.y, start.z - 0.5);
        black_box(bench.mesh.touches(&place, &Vector3::z(), 0.05, 0.0, &mut Work::default()));
    }
}

#[inline(never)]
fn tree_over_64_faces(bench: &Bench) {
    // A face for each of the TIMES, so that the count is by face.
    let boxes: Vec<_> =
        (0..TIMES as u32).map(|face| carom_geometry::bounds::Aabb::of_points(&bench.mesh.triangle(face))).collect();
    black_box(Bvh::build(&boxes));
}

#[inline(never)]
fn one_ball_for_3_s(bench: &Bench) {
    for _ in 0..TIMES {
        black_box(simulate(&bench.one_ball, &bench.one_ball.balls()[0], &mut ()));
    }
}

fn all_balls(plan: &Plan) {
    let one = |ball: &Ball| simulate(plan, ball, &mut ());
    plan.balls().iter().for_each(|ball| {
        black_box(one(ball));
    });
}

#[inline(never)]
fn ball_in_room_for_1_s(bench: &Bench) {
    all_balls(&bench.room);
}

#[inline(never)]
fn ball_on_terrain_for_2_s(bench: &Bench) {
    all_balls(&bench.terrain);
}
