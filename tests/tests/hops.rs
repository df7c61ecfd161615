//! A ball that hops about on a mesh: what it has seen of it shortens the next search, and changes no bit of what is found.

use carom_dynamics::body::State;
use carom_dynamics::collision::{Obstacles, Returns};
use carom_dynamics::contacts::Contacts;
use carom_dynamics::counters::Counters;
use carom_dynamics::events::Event;
use carom_dynamics::integrators::{Step, exact};
use carom_geometry::closest::closest_point;
use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::mesh::Mesh;
use carom_geometry::path::Path;
use carom_geometry::rounding::contact_doubt;
use carom_tests::obj;
use carom_tests::random::Random;
use carom_tests::stage::{Stage, smooth};
use nalgebra::{Point3, Vector3};

const SCENES: [(&str, &str); 3] = [
    ("spot", include_str!("../../crates/app/scenes/meshes/spot_triangulated.obj")),
    ("bunny", include_str!("../../crates/app/scenes/meshes/low_poly_bunny.obj")),
    ("terrain", include_str!("../../crates/app/scenes/meshes/bullet_terrain.obj")),
];

/// How the hops of a series went.
#[derive(Debug, Default)]
struct Tally {
    hops: u32,
    /// Hops that end on the face they began on, or one beside it.
    short: u32,
    /// Hops of which the tree was not asked.
    known: u32,
    /// Flights that meet nothing.
    free: u32,
}

/// The first f in [`from`, `to`] at which a face is touched, by asking every one.
fn by_brute_force(mesh: &Mesh, step: &Step, radius: f64, from: f64, to: f64) -> Option<f64> {
    let ball = MovingBall { path: &step.path, radius, holds: &[] };
    let contact = |face: u32| match first_contact(&ball, &mesh.triangle(face), from, to, &mut 0) {
        Contact::At { f, .. } => Some(f),
        Contact::Miss => None,
    };
    (0..mesh.faces().len() as u32).filter_map(contact).reduce(f64::min)
}

/// A second from `state` with the acceleration `a`, that changes by `jerk` per second, and that as well.
fn curve(state: &State, a: Vector3<f64>, jerk: Vector3<f64>) -> Step {
    if jerk == Vector3::zeros() {
        return exact::step(state, a, 1.0);
    }
    let terms = [state.velocity, a * 0.5, jerk / 6.0, jerk / 24.0];
    let [v1, v2, v3, v4] = [0, 1, 2, 3].map(|k| terms[k] * (k + 1) as f64);
    let velocity = [v1, v2, v3, v4, Vector3::zeros()];
    Step { path: Path::from_terms(state.position, &terms), velocity, seconds: 1.0, to: 1.0, exact: true }
}

/// Hops from `state` under the acceleration `a` and its `jerk`, each with the share `e` of the speed that the one before ended with.
fn hop(mesh: &Mesh, radius: f64, mut state: State, [a, jerk]: [Vector3<f64>; 2], e: f64, tally: &mut Tally) {
    let stage = Stage::new(1.0).mesh("mesh", smooth(e), mesh.vertices().to_vec(), mesh.faces().to_vec());
    let plan = stage.ball(state.position, state.velocity, radius).plan();
    let size = mesh.bounds().extent().amax() + state.position.coords.amax() + radius;
    let mut kept = Obstacles::new(&plan, radius, &state, &a);
    let mut contacts = Contacts::new();
    for _ in 0..24 {
        let (step, mut counters) = (curve(&state, a, jerk), Counters::default());
        let mut returns = Returns::new();
        kept.returns(&step, &contacts, &mut returns, &mut counters);
        let hit = kept.earliest(&step, &contacts, &returns, &mut counters);
        let mut fresh = Obstacles::new(&plan, radius, &state, &a);
        assert_eq!(hit, fresh.earliest(&step, &contacts, &returns, &mut Counters::default()), "{step:?}");
        let doubt = contact_doubt(size + step.path.reach(step.to));
        let Some(hit) = hit else {
            assert_eq!(by_brute_force(mesh, &step, radius, 0.25 * step.to, step.to), None, "{step:?}");
            tally.free += 1;
            return;
        };
        tally.hops += 1;
        tally.known += u32::from(counters.nodes == 0);
        let end = step.at(hit.f);
        let touching = |f, counters: &mut Counters| {
            let mut touched = Contacts::new();
            kept.touching(&end, doubt, f, &mut touched, counters);
            touched
        };
        let touched = touching(Some(hit.f), &mut counters);
        assert_eq!(touched, touching(None, &mut Counters::default()), "at {} of {step:?}", hit.f);
        // What is touched when is known no better than from where: to the doubt, along the normal.
        let closing = touched.iter().map(|c| -c.rate).fold(0.0, f64::max);
        if hit.f > 0.0 {
            let earlier = by_brute_force(mesh, &step, radius, 0.25 * hit.f, hit.f).unwrap_or(hit.f);
            assert!((hit.f - earlier) * closing <= 4.0 * doubt, "{hit:?} after {earlier} along {step:?}");
        }
        let is_near = |c: &carom_dynamics::contacts::Contact| touched.iter().any(|t| t.site == c.site);
        tally.short += u32::from(contacts.iter().any(is_near));
        contacts = touched;
        state = end;
        for contact in &contacts {
            let closing = contact.normal.dot(&state.velocity);
            if closing < 0.0 {
                state.velocity -= contact.normal * ((1.0 + e) * closing);
            }
        }
        for contact in &mut contacts {
            contact.rate = contact.normal.dot(&state.velocity);
        }
        // In a corner that throws it back and forth, or where there is nothing left to see, it ends.
        if contacts.iter().any(|c| c.rate <= 0.0) || state.velocity.norm() < 1e-5 * (2.0 * a.norm() * radius).sqrt() {
            return;
        }
    }
}

#[test]
fn h06_what_a_ball_has_seen_changes_nothing_of_what_it_meets_next() {
    let mut random = Random::new(17);
    for (name, text) in SCENES {
        let (vertices, faces) = obj::read(text);
        let mesh = Mesh::new(vertices, faces).unwrap();
        let mut tally = Tally::default();
        let balls = (75_000 / mesh.faces().len()).clamp(8, 24);
        for i in 0..balls {
            // Dropped onto a place of it from near, pressed against that from straight above or aslant, and on with some speed along it.
            let corners = mesh.triangle(random.below(mesh.faces().len()) as u32);
            let [p, q, r] = corners;
            let face = ((p - q).norm() * (r - q).norm()).sqrt();
            let on = if i % 3 == 0 { corners[0] } else { random.in_triangle(&corners) };
            let normal = (q - p).cross(&(r - p)).normalize();
            let radius = face * random.octave(-6, 1);
            let height = face * random.octave(-6, 0);
            let g = -normal + random.vector(0.25);
            let start = Point3::from(on.coords + normal * (radius + height));
            // Not in a narrow place, where it would begin inside something else.
            let aside = |face: u32| closest_point(&mesh.triangle(face), &start).offset.norm() < 1.001 * radius;
            if (0..mesh.faces().len() as u32).any(aside) {
                continue;
            }
            let fastest = 2.0 * (2.0 * height).sqrt() * random.unit();
            let along = random.vector(fastest);
            // Along a parabola, and where what presses it changes by as much as itself in one hop.
            let jerk = random.vector(g.norm() / (2.0 * height).sqrt());
            let (state, e) = (State { position: start, velocity: along }, random.within(0.5, 1.0));
            for jerk in [Vector3::zeros(), jerk] {
                hop(&mesh, radius, state, [g, jerk], e, &mut tally);
            }
        }
        println!("{name}: {tally:?}");
        assert!(tally.hops > 4 * balls as u32 && tally.known * 4 > tally.hops, "too few hops prove little: {tally:?}");
    }
}

#[test]
fn h06_a_ball_that_hops_along_a_floor_meets_the_wall_at_its_end_in_time() {
    // What it knows of the floor behind it says nothing of the wall, wherever on its way it has learnt it.
    let corners = [[-10.0, 0.0], [10.0, 0.0]].map(|[x, z]| [[x, -10.0, z], [x, 10.0, z]]);
    let top = [[10.0, -10.0, 10.0], [10.0, 10.0, 10.0]];
    let vertices: Vec<Point3<f64>> = corners.iter().flatten().chain(&top).map(|p| Point3::from(*p)).collect();
    let faces = vec![[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]];
    let radius = 0.5;
    for (speed, up) in [(0.5, 1.0), (1.0, 0.25), (2.5, 1.0)] {
        let hop = 2.0 * up / 10.0;
        for k in 0..40 {
            // The floor is hit at the end of each hop; it starts on the floor, with a whole one ahead.
            let x = 3.0013 + 0.017 * f64::from(k);
            let t = (10.0 - radius - x) / speed;
            let stage = Stage::new(t + 1.0).down(10.0).mesh("room", smooth(1.0), vertices.clone(), faces.clone());
            let run = stage.ball([x, 0.3, radius], [speed, 0.0, up], radius).run();
            let (walls, floors): (Vec<Event>, Vec<Event>) = run.impacts().iter().partition(|e| e.normal.x < -0.5);
            assert_eq!(walls.len(), 1, "from {x} at {speed}");
            assert!((walls[0].time - t).abs() <= 1e-12 * t, "from {x} at {speed}: {} s, not {t}", walls[0].time);
            assert_eq!(floors.len() as f64, ((t + 1.0) / hop).floor(), "from {x} at {speed}");
        }
    }
}
