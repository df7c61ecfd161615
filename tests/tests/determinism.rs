//! The same bits however many balls, threads, and in whatever order the surfaces, planes and faces are given.

use carom_dynamics::effects::friction::Friction;
use carom_dynamics::events::Event;
use carom_dynamics::observer::Trajectory;
use carom_dynamics::plan::Plan;
use carom_dynamics::run::run_balls;
use carom_tests::obj;
use carom_tests::stage::{Run, Stage, coulomb, rough, smooth};
use nalgebra::{Point3, Vector3};
use std::ops::ControlFlow;

const STAIRS: &str = include_str!("../../crates/app/scenes/meshes/stairs.obj");
const TERRAIN: &str = include_str!("../../crates/app/scenes/meshes/bullet_terrain.obj");

/// A room with a ramp in it, of several materials.
fn furnished_room(duration: f64) -> Stage {
    let ramp = [[0.5, 0.5, 0.1], [2.0, 0.5, 0.1], [2.0, 2.0, 0.9], [0.5, 2.0, 0.9]];
    Stage::new(duration)
        .down(9.81)
        .room(rough(0.8, coulomb(0.2)), [3.0, 4.0, 2.5])
        .polygon("ramp", rough(0.6, Friction::linear(0.1).unwrap()), &ramp)
        .plane("roof", rough(0.9, Friction::impulse(0.3).unwrap()), [0.0, 0.0, 2.4], [0.3, -0.2, -0.9])
}

/// The i-th ball of the room.
fn with_ball(stage: Stage, i: u32) -> Stage {
    let at = |k: u32, n: u32| f64::from((i * k) % n) / f64::from(n);
    let position = [0.3 + 2.4 * at(7, 101), 0.3 + 3.4 * at(11, 103), 1.1 + at(13, 107)];
    stage.ball(position, [4.0 * at(17, 109) - 2.0, 3.0 - 6.0 * at(19, 113), 2.0 * at(23, 127)], 0.05)
}

/// Every ball's events, on so many threads.
fn on_threads(plan: &Plan, threads: usize) -> Vec<Vec<Event>> {
    let mut all = Vec::new();
    let sink = |ball: usize, trajectory: Trajectory, _| {
        assert_eq!(ball, all.len(), "in the order of the balls");
        all.push(trajectory.events);
        ControlFlow::Continue(())
    };
    run_balls(plan, Some(threads), |_| Trajectory::default(), sink).unwrap();
    all
}

#[test]
fn r12_many_balls_and_threads_change_no_bit() {
    let mut few = furnished_room(1.0);
    for i in 0..10 {
        few = with_ball(few, i);
    }
    let mut many = few.clone();
    for i in 10..10_000 {
        many = with_ball(many, i);
    }
    let few: Vec<_> = few.run_all().into_iter().map(|run| run.trajectory.events).collect();
    let plan = many.plan();
    let (one, two) = (on_threads(&plan, 1), on_threads(&plan, 2));
    assert!(one == two, "threads");
    assert!(few[..] == one[..10], "many balls");
    let events: usize = one.iter().map(Vec::len).sum();
    assert!(events > 20_000, "{events} events");
}

/// Events with the names of their surfaces in place of the indices, and without their faces.
fn by_name(stage: &Stage, run: &Run) -> Vec<(String, Event)> {
    let named = |e: &Event| (stage.0.surfaces[e.surface].name.clone(), Event { surface: 0, face: None, ..*e });
    run.trajectory.events.iter().map(named).collect()
}

#[test]
fn r12_the_order_of_the_surfaces_changes_no_event() {
    let (mut events, orders) = (0, 8);
    for i in 0..12 {
        let stage = with_ball(furnished_room(20.0), i);
        let right = by_name(&stage, &stage.run());
        for order in 1..orders {
            let mut shuffled = stage.clone();
            // Every step coprime to 8 is another order.
            let n = shuffled.0.surfaces.len();
            assert_eq!(n, 8);
            shuffled.0.surfaces = (0..n).map(|k| stage.0.surfaces[(k * (2 * order + 1) + order) % n].clone()).collect();
            assert_eq!(by_name(&shuffled, &shuffled.run()), right, "ball {i}, order {order}");
        }
        events += right.len();
    }
    assert!(events > 300, "{events} events");
}

#[test]
fn r12_a_corner_gives_the_same_in_all_orders_of_its_planes() {
    let planes = [("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])];
    for c_r in [0.0, 0.5, 1.0] {
        let mut answers = Vec::new();
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let mut stage = Stage::new(1.0).ball([1.0; 3], [-1.0, -1.0, -1.0], 0.25);
            for k in order {
                let (name, normal) = planes[k];
                stage = stage.plane(name, smooth(c_r), [0.0; 3], normal);
            }
            let run = stage.run();
            let impacts = run.impacts();
            assert_eq!(impacts.len(), 3, "one for each plane");
            assert!(impacts.iter().all(|e| e.time == 0.75 && e.velocity == Vector3::from([c_r; 3])), "{impacts:?}");
            answers.push(by_name(&stage, &run));
        }
        assert!(answers.iter().all(|a| *a == answers[0]), "{answers:#?}");
    }
}

/// The same mesh with its faces in another order, each beginning with another corner.
fn permuted(faces: &[[u32; 3]], step: usize) -> Vec<[u32; 3]> {
    let turned = |k: usize| {
        let mut face = faces[(k * step + 5) % faces.len()];
        face.rotate_left(k % 3);
        face
    };
    (0..faces.len()).map(turned).collect()
}

#[test]
fn r12_the_order_of_the_faces_changes_nothing_but_their_numbers() {
    let mut events = 0;
    for (text, step, start, size) in [(STAIRS, 7, [0.0, 0.0, 3.0], 0.3), (TERRAIN, 101, [0.0, 0.0, 30.0], 8.0)] {
        let (vertices, faces) = obj::read(text);
        // The terrain lies with y up.
        let vertices: Vec<Point3<f64>> = vertices.into_iter().map(|v| Point3::new(v.z, v.x, v.y)).collect();
        let other = permuted(&faces, step);
        let sorted = |faces: &[[u32; 3]]| {
            let mut all: Vec<_> = faces
                .iter()
                .map(|f| {
                    let mut f = *f;
                    f.sort();
                    f
                })
                .collect();
            all.sort();
            all
        };
        assert_eq!(sorted(&faces), sorted(&other), "a permutation");
        for i in 0..40u32 {
            let at = |k: u32| size * (f64::from((i * k) % 41) / 41.0 - 0.5);
            let ball = [start[0] + at(7), start[1] + at(11), start[2]];
            let stage = |faces: &Vec<[u32; 3]>| {
                let material = rough(0.6, coulomb(0.4));
                let stage = Stage::new(10.0).down(9.81).mesh("mesh", material, vertices.clone(), faces.clone());
                stage.ball(ball, [0.3, -0.2, 0.0], 0.05)
            };
            let (stage, again) = (stage(&faces), stage(&other));
            let right = by_name(&stage, &stage.run());
            events += right.len();
            assert_eq!(by_name(&again, &again.run()), right, "ball {i} at {ball:?}");
        }
    }
    println!("{events} events");
    assert!(events > 500, "{events} events");
}
