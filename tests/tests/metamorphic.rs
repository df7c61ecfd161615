//! What must change no bit on meshes: scale, mirrors, the order of faces and surfaces, doubled faces, a longer run.

use carom_dynamics::effects::friction::Friction;
use carom_dynamics::events::{Event, EventKind};
use carom_tests::obj;
use carom_tests::random::Random;
use carom_tests::stage::{Run, Stage, coulomb, rough};
use nalgebra::{Point3, Vector3};

const STAIRS: &str = include_str!("../../crates/app/scenes/meshes/stairs.obj");
const TERRAIN: &str = include_str!("../../crates/app/scenes/meshes/bullet_terrain.obj");
const BUNNY: &str = include_str!("../../crates/app/scenes/meshes/low_poly_bunny.obj");

/// A scene on a mesh, in plain numbers so that every one of them can be changed.
#[derive(Clone)]
struct Case {
    vertices: Vec<Point3<f64>>,
    faces: Vec<[u32; 3]>,
    c_r: f64,
    friction: Friction,
    gravity: Vector3<f64>,
    position: Point3<f64>,
    velocity: Vector3<f64>,
    radius: f64,
    duration: f64,
}

impl Case {
    fn stage(&self) -> Stage {
        let Case { vertices, faces, gravity, position, velocity, radius, .. } = self.clone();
        let material = rough(self.c_r, self.friction);
        let stage = Stage::new(self.duration).gravity(gravity).mesh("mesh", material, vertices, faces);
        // A floor below everything: lost balls come to rest as well.
        let down = gravity.normalize();
        let far = self.vertices.iter().map(|v| v.coords.amax()).fold(0.0, f64::max);
        stage.plane("floor", material, Point3::from(down * (4.0 * far)), -down).ball(position, velocity, radius)
    }

    fn run(&self) -> Run {
        self.stage().run()
    }
}

/// Balls over the stairs and the terrain, and in and around the bunny.
fn cases(count: usize) -> Vec<Case> {
    let mut random = Random::new(77);
    let meshes = [STAIRS, TERRAIN, BUNNY].map(obj::read);
    (0..count)
        .map(|i| {
            let (vertices, faces) = meshes[i % 3].clone();
            // Of these meshes, y is up; all are brought to z.
            let vertices: Vec<_> = vertices.iter().map(|v| Point3::new(v.z, v.x, v.y)).collect();
            let (low, high) = vertices.iter().fold((vertices[0], vertices[0]), |(l, h), v| (l.inf(v), h.sup(v)));
            let size = (high - low).amax();
            let over = Vector3::new(random.within(0.2, 0.8), random.within(0.2, 0.8), random.within(1.0, 1.2));
            Case {
                position: low + (high - low).component_mul(&over) + Vector3::new(0.0, 0.0, 0.05 * size),
                vertices,
                faces,
                c_r: [0.0, 0.5, 0.8, 1.0][random.below(4)],
                friction: [Friction::None, coulomb(0.3)][random.below(2)],
                gravity: Vector3::new(random.within(-1.0, 1.0), random.within(-1.0, 1.0), -9.81),
                velocity: random.vector(0.3 * size),
                radius: size * random.octave(-8, -5),
                // Some bounces, also on terrain of tens of metres.
                duration: 4.0 * size.sqrt().max(1.0),
            }
        })
        .collect()
}

/// Kind, surface, face and all numbers of an event, its lengths and times by powers of two.
fn scaled(e: &Event, k: i32, m: i32) -> (EventKind, usize, Option<u32>, Vec<u64>) {
    let (length, time, speed) = (2f64.powi(-k), 2f64.powi(-m), 2f64.powi(m - k));
    let numbers = [e.time * time].into_iter().chain((e.position.coords * length).iter().copied().collect::<Vec<_>>());
    let vectors = [e.normal, e.velocity_in * speed, e.velocity * speed];
    let numbers = numbers.chain(vectors.iter().flat_map(|v| [v.x, v.y, v.z]));
    (e.kind, e.surface, e.face, numbers.map(|x| (x + 0.0).to_bits()).collect())
}

fn plain(run: &Run) -> Vec<(EventKind, usize, Option<u32>, Vec<u64>)> {
    run.trajectory.events.iter().map(|e| scaled(e, 0, 0)).collect()
}

/// Fails with the first event that differs.
#[track_caller]
fn same<T: PartialEq + std::fmt::Debug>(found: &[T], right: &[T], place: impl Fn() -> String) {
    let first = found.iter().zip(right).position(|(a, b)| a != b).unwrap_or(found.len().min(right.len()));
    let lengths = (found.len(), right.len());
    assert!(found == right, "{}: event {first} of {lengths:?}: {:?} {:?}", place(), found.get(first), right.get(first));
}

/// Without the numbers of the faces.
fn faceless(run: &Run) -> Vec<(EventKind, usize, Vec<u64>)> {
    plain(run).into_iter().map(|(kind, surface, _, numbers)| (kind, surface, numbers)).collect()
}

#[test]
fn r30_powers_of_two_change_no_bit_on_meshes() {
    let mut events = 0;
    let scales = [(-300, 0), (-200, 0), (-100, 130), (60, -140), (100, 180), (200, 0), (1, 1)];
    for (i, case) in cases(60).iter().enumerate() {
        let right = case.run();
        events += right.trajectory.events.len();
        for (k, m) in scales {
            let (length, time, speed) = (2f64.powi(k), 2f64.powi(m), 2f64.powi(k - m));
            let mut other = case.clone();
            other.vertices.iter_mut().for_each(|v| *v *= length);
            other.position *= length;
            other.radius *= length;
            other.velocity *= speed;
            other.gravity *= speed / time;
            other.duration *= time;
            let found: Vec<_> = other.run().trajectory.events.iter().map(|e| scaled(e, k, m)).collect();
            same(&found, &plain(&right), || format!("case {i} at 2^{k} m, 2^{m} s"));
        }
    }
    assert!(events > 300, "{events} events");
}

#[test]
fn r12_mirrors_change_no_bit_on_meshes() {
    let mut events = 0;
    for (i, case) in cases(60).iter().enumerate() {
        let right = case.run();
        events += right.trajectory.events.len();
        for signs in [[-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, -1.0, -1.0]] {
            let found = mirrored(case, Vector3::from(signs));
            same(&found, &plain(&right), || format!("case {i}, signs {signs:?}"));
        }
    }
    assert!(events > 300, "{events} events");
}

/// The events of the mirror image of a case, mirrored back, as [`plain`] has them.
fn mirrored(case: &Case, signs: Vector3<f64>) -> Vec<(EventKind, usize, Option<u32>, Vec<u64>)> {
    let mirror = |v: Vector3<f64>| v.component_mul(&signs);
    let mut other = case.clone();
    other.vertices.iter_mut().for_each(|v| v.coords = mirror(v.coords));
    other.position.coords = mirror(other.position.coords);
    other.velocity = mirror(other.velocity);
    other.gravity = mirror(other.gravity);
    let back = |e: &Event| Event {
        position: mirror(e.position.coords).into(),
        normal: mirror(e.normal),
        velocity_in: mirror(e.velocity_in),
        velocity: mirror(e.velocity),
        ..*e
    };
    other.run().trajectory.events.iter().map(|e| scaled(&back(e), 0, 0)).collect()
}

#[test]
fn r12_doubled_and_shuffled_faces_change_no_bit() {
    for (i, case) in cases(12).iter().enumerate() {
        let right = case.run();
        let mut doubled = case.clone();
        doubled.faces.extend(case.faces.iter().map(|&[a, b, c]| [b, c, a]));
        same(&plain(&doubled.run()), &plain(&right), || format!("case {i}, doubled"));
        let mut shuffled = case.clone();
        shuffled.faces.reverse();
        let shuffled = shuffled.run();
        same(&faceless(&shuffled), &faceless(&right), || format!("case {i}, reversed"));
        let mut first = case.stage();
        first.0.surfaces.reverse();
        let swapped = first.run();
        let named = |run: &Run, swap: bool| -> Vec<_> {
            let name = |s: usize| if swap { 1 - s } else { s };
            plain(run).into_iter().map(|(kind, s, face, numbers)| (kind, name(s), face, numbers)).collect()
        };
        same(&named(&swapped, true), &named(&right, false), || format!("case {i}, surfaces swapped"));
    }
}

#[test]
fn r10_a_longer_run_has_the_same_beginning_on_meshes() {
    for (i, case) in cases(12).iter().enumerate() {
        let right = case.run();
        // Curved slides choose their steps by how long they may be.
        let flights = right.trajectory.events.iter().position(|e| e.kind == EventKind::Slide);
        let until = flights.map_or(case.duration, |k| right.trajectory.events[k].time);
        for share in [0.25, 0.5, 0.75] {
            let mut short = case.clone();
            short.duration *= share;
            let before = |run: &Run| -> Vec<_> {
                let end = until.min(short.duration);
                run.trajectory.events.iter().filter(|e| e.time < end).map(|e| scaled(e, 0, 0)).collect()
            };
            same(&before(&short.run()), &before(&right), || format!("case {i}, {share} of the time"));
        }
    }
}
