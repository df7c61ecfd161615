//! An effect that is there in name only costs nothing and changes nothing: not a bit, and not a count.

use carom_dynamics::effects::drag::Drag;
use carom_dynamics::effects::magnus::Magnus;
use carom_dynamics::effects::restitution::Restitution;
use carom_dynamics::scene::Method;
use carom_dynamics::surface::Material;
use carom_tests::stage::{Run, Stage, coulomb, rough, smooth};
use nalgebra::Vector3;

/// A throw in a room with friction, whose bits everything that is added must leave alone.
fn throw() -> Stage {
    let stage = Stage::new(6.0).down(9.81).room(rough(0.8, coulomb(0.2)), [4.0, 3.0, 2.5]);
    stage.thing([1.0, 1.0, 1.0], [3.0, -2.0, 4.0], 0.05, Some(0.06))
}

#[track_caller]
fn assert_same(plain: &Run, other: &Run) {
    // Not printed: it is long.
    assert!(plain.trajectory == other.trajectory, "another trajectory");
    assert_eq!(plain.outcome, other.outcome, "counts and all");
}

/// A run as one would see it who does not see that the ball turns.
fn unturned(mut run: Run) -> Run {
    run.trajectory.events.iter_mut().for_each(|event| event.spin = None);
    run.trajectory.segments.iter_mut().for_each(|segment| segment.turning = None);
    run.outcome.spin = None;
    run
}

fn still_air() -> Drag {
    Drag::quadratic(0.5, 1.2).unwrap()
}

#[test]
fn drag_of_zero_is_no_drag() {
    let plain = throw().run();
    let none = [Drag::linear(0.0), Drag::quadratic(0.0, 1.2), Drag::quadratic(0.5, 0.0), Drag::sphere(0.0, 1.8e-5)];
    for drag in none {
        let drag = drag.unwrap().in_wind(Vector3::new(5.0, 0.0, 0.0)).unwrap();
        assert_same(&plain, &throw().drag(drag).run());
    }
    assert_eq!((plain.outcome.counters.drag, plain.outcome.counters.magnus), (0, 0));
}

#[test]
fn a_wind_of_zero_is_no_wind() {
    for drag in [still_air(), Drag::linear(0.01).unwrap(), Drag::sphere(1.2, 1.8e-5).unwrap()] {
        let calm = throw().drag(drag).run();
        assert_same(&calm, &throw().drag(drag.in_wind(Vector3::zeros()).unwrap()).run());
        assert!(calm.outcome.counters.drag > 0);
    }
}

#[test]
fn without_spin_there_is_no_magnus_force_and_no_decay() {
    let magnus = Magnus::new(1.0, 1.2).unwrap();
    for stage in [throw(), throw().drag(still_air()), throw().method(Method::Rk4 { step: 1e-3 })] {
        let plain = stage.run();
        assert_same(&plain, &stage.clone().magnus(magnus).spin_decay(5.0).run());
        assert_same(&plain, &stage.clone().magnus(magnus).spinning([0.0; 3]).run());
        assert_eq!(plain.outcome.counters.magnus, 0);
    }
}

#[test]
fn spin_without_the_magnus_force_or_one_of_zero_leaves_the_flight_alone() {
    for stage in [throw(), throw().drag(still_air())] {
        let plain = stage.run();
        let spinning = stage.spinning([10.0, 200.0, -30.0]).spin_decay(3.0);
        assert_same(&plain, &unturned(spinning.run()));
        assert_same(&plain, &unturned(spinning.magnus(Magnus::new(1.0, 0.0).unwrap()).run()));
    }
}

#[test]
fn a_ball_without_spin_beside_one_with_is_not_asked() {
    let stage = throw().drag(still_air()).magnus(Magnus::new(1.0, 1.2).unwrap());
    let alone = stage.run();
    let both = stage.thing([2.0, 2.0, 1.0], [1.0, 0.0, 0.0], 0.05, Some(0.06)).spinning([0.0, 0.0, 90.0]).run_all();
    assert_same(&alone, &both[0]);
    assert_eq!(both[0].outcome.counters.magnus, 0);
    assert!(both[1].outcome.counters.magnus > 0);
}

#[test]
fn buoyancy_in_nothing_is_none() {
    assert_same(&throw().run(), &throw().buoyancy(0.0).run());
}

#[test]
fn restitution_that_would_fall_only_above_every_speed_is_constant() {
    let floor = |restitution| Stage::new(5.0).down(9.81).floor(Material { restitution, ..smooth(0.5) });
    let drop = |stage: Stage| stage.ball([0.0, 0.0, 2.0], [0.0; 3], 0.1).run();
    let constant = drop(floor(Restitution::new(0.7).unwrap()));
    assert_same(&constant, &drop(floor(Restitution::falling(0.7, 100.0).unwrap())));
}
