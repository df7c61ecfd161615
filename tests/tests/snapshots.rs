//! What happens in small scenes, and what it costs in counts: every change shows.

use carom_dynamics::effects::drag::Drag;
use carom_dynamics::scene::Method;
use carom_tests::obj;
use carom_tests::stage::{Stage, coulomb, rough, smooth};
use nalgebra::Point3;
use std::fmt::Write;

/// The events of every ball, in 12 digits, how each ended, and the counts that are not 0.
fn shown(stage: &Stage) -> String {
    let mut text = String::new();
    for (ball, run) in stage.run_all().iter().enumerate() {
        let outcome = &run.outcome;
        writeln!(text, "ball {ball}: {:?} at {}, {:?}", outcome.ending, outcome.time, outcome.motion).unwrap();
        // The last digits of a long run tell nothing; the bits are compared elsewhere.
        let v3 = |v: [f64; 3]| v.map(|c| format!("{:.9}", c + 0.0).replace("-0.000000000", "0.000000000")).join(" ");
        for e in &run.trajectory.events {
            let name = &stage.0.surfaces[e.surface].name;
            let face = e.face.map_or(String::new(), |face| format!(" {face}"));
            let (x, v, w) = (v3(e.position.coords.into()), v3(e.velocity_in.into()), v3(e.velocity.into()));
            let kind = format!("{:?}", e.kind).to_lowercase();
            writeln!(text, "  {:.9} {kind} {name}{face}\n    at {x}: {v} -> {w}", e.time).unwrap();
        }
        writeln!(text, "  end at {}", v3(outcome.state.position.coords.into())).unwrap();
        for (name, count) in outcome.counters.named().iter().filter(|(_, count)| *count > 0) {
            writeln!(text, "  {name} {count}").unwrap();
        }
    }
    text
}

#[test]
fn r31_a_drop() {
    let stage = Stage::new(10.0).down(9.81).floor(smooth(0.5)).rest_length(1e-4).ball([0.0, 0.0, 1.0], [0.0; 3], 0.1);
    insta::assert_snapshot!(shown(&stage));
}

#[test]
fn r23_a_throw_with_friction() {
    let stage = Stage::new(10.0).down(9.81).floor(rough(0.5, coulomb(0.3))).rest_length(1e-4);
    insta::assert_snapshot!(shown(&stage.ball([0.0, 0.0, 1.0], [4.0, 1.0, 0.0], 0.1)));
}

#[test]
fn r10_a_throw_by_eulers_steps() {
    let stage = Stage::new(3.0).down(9.81).floor(smooth(0.5)).method(Method::Euler { step: 0.1 });
    insta::assert_snapshot!(shown(&stage.ball([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.1)));
}

#[test]
fn r12_a_corner() {
    let stage = Stage::new(2.0).room(smooth(0.5), [2.0; 3]).ball([0.5; 3], [-1.0, -1.0, -1.0], 0.25);
    insta::assert_snapshot!(shown(&stage.ball([1.0, 1.0, 1.5], [0.0, 2.0, 2.0], 0.25)));
}

#[test]
fn r32_a_ramp() {
    let wood = rough(0.5, coulomb(0.4));
    let stage = Stage::new(10.0)
        .down(9.81)
        .rest_length(1e-4)
        .polygon("steep", wood, &[[0.0, 0.0, 1.2], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 1.2]])
        .polygon("gentle", wood, &[[0.0, 2.0, 0.4], [2.0, 2.0, 0.0], [2.0, 3.0, 0.0], [0.0, 3.0, 0.4]])
        .polygon("floor", wood, &[[2.0, -4.0, 0.0], [14.0, -4.0, 0.0], [14.0, 8.0, 0.0], [2.0, 8.0, 0.0]])
        .ball([0.5, 0.5, 1.8], [0.0; 3], 0.05)
        .ball([1.0, 2.5, 1.0], [0.0; 3], 0.05);
    insta::assert_snapshot!(shown(&stage));
}

#[test]
fn r33_a_valley_of_a_mesh() {
    // Two slopes that meet in a fold, and a wall across its lower end.
    let vertices = [
        [-2.0, 0.0, 1.0],
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 1.0],
        [-2.0, 4.0, 1.5],
        [0.0, 4.0, 0.5],
        [2.0, 4.0, 1.5],
        [-2.0, 0.0, 3.0],
        [2.0, 0.0, 3.0],
    ];
    let faces = vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [0, 6, 1], [6, 7, 1], [1, 7, 2]];
    let stage = Stage::new(30.0).down(9.81).rest_length(1e-4);
    let stage = stage.mesh("valley", rough(0.4, coulomb(0.05)), vertices.map(Point3::from).to_vec(), faces);
    insta::assert_snapshot!(shown(&stage.ball([0.8, 3.0, 2.0], [0.0; 3], 0.1)));
}

#[test]
fn r07_a_throw_in_the_wind() {
    let drag = Drag::quadratic(0.5, 1.2).unwrap().in_wind([3.0, 0.0, 0.0].into()).unwrap();
    let stage = Stage::new(3.0).down(9.81).drag(drag).floor(rough(0.7, coulomb(0.3))).rest_length(1e-4);
    insta::assert_snapshot!(shown(&stage.thing([0.0, 0.0, 1.0], [0.0, 2.0, 1.0], 0.1, Some(0.05))));
}

#[test]
fn r12_the_stairs() {
    let (vertices, faces) = obj::read(include_str!("../../crates/app/scenes/meshes/stairs.obj"));
    let stage = Stage::new(10.0).down(9.81).rest_length(1e-4).mesh("stairs", rough(0.6, coulomb(0.2)), vertices, faces);
    insta::assert_snapshot!(shown(&stage.ball([0.1, 0.1, 4.0], [0.2, 0.3, 0.0], 0.1)));
}
