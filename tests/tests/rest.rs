//! Rest: when it comes, where, on how many surfaces, and when it must not.

use carom_dynamics::effects::friction::Friction;
use carom_dynamics::events::{Ending, EventKind, Motion};
use carom_dynamics::scene::Method;
use carom_dynamics::tolerance::touch_distance;
use carom_tests::oracle::U;
use carom_tests::stage::{Run, Stage, coulomb, rough, smooth};
use nalgebra::{Point3, Vector3};

const G: f64 = 9.81;

/// A plane through the origin that falls towards +x with this slope: tan of its angle.
fn slope(tan: f64) -> Vector3<f64> {
    Vector3::new(tan, 0.0, 1.0)
}

#[test]
fn r26_rounding_integration_and_discretisation_are_three_numbers() {
    // One fall, three errors. A ball drops from 2 m above the lowest point of a trough of radius 1 along y.
    let trough = |corners: u32| {
        let at = |k: u32| {
            let angle = std::f64::consts::PI * (f64::from(k) / f64::from(corners) + 1.0);
            [angle.cos(), angle.sin() + 1.0]
        };
        // An odd number of strips: the lowest point lies in the middle of one.
        (0..corners).fold(Stage::new(1.0).down(G), |stage, k| {
            let ([x0, z0], [x1, z1]) = (at(k), at(k + 1));
            let strip = [[x0, -1.0, z0], [x1, -1.0, z1], [x1, 1.0, z1], [x0, 1.0, z0]];
            stage.polygon(&format!("strip {k}"), smooth(0.5), &strip)
        })
    };
    let fall = (2.0 * 2.0 / G).sqrt();
    let first = |stage: Stage| stage.run().impacts()[0];
    let flat = Stage::new(1.0).down(G).floor(smooth(0.5)).ball([0.0, 0.0, 2.0], [0.0; 3], 0.0);

    // Rounding: the exact flight onto the exact floor.
    let rounding = (first(flat.clone()).time - fall).abs();
    assert!(rounding <= 4.0 * U * fall, "{rounding:e}");

    // Integration: half a step for Euler, whatever the floor.
    let h = 1e-3;
    let integration = first(flat.method(Method::Euler { step: h })).time - fall;
    assert!((integration / h - 0.5).abs() < 0.01, "{integration:e}");

    // Discretisation: n strips lie 1 - cos(pi / 2n) above the circle, and the quadratic in 1/n shows.
    for corners in [5, 15, 45] {
        let sagitta = 1.0 - (std::f64::consts::PI / f64::from(2 * corners)).cos();
        let impact = first(trough(corners).ball([0.0, 0.0, 2.25], [0.0; 3], 0.25));
        assert!((impact.position.z - 0.25 - sagitta).abs() <= 8.0 * U, "{}", impact.position.z);
        let expected = (2.0 * (2.0 - sagitta) / G).sqrt();
        assert!((impact.time - expected).abs() <= 16.0 * U, "{}", impact.time);
    }
}

#[test]
fn r30_one_length_moves_the_end_of_bouncing_by_no_more_than_itself() {
    let end = |length: f64| {
        let run = Stage::new(20.0).down(G).floor(smooth(0.5)).ball([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.1);
        let run = run.rest_length(length).run();
        (run.events(EventKind::Slide)[0].time, run.impacts().len())
    };
    let (right, most) = end(1e-30);
    for k in 1..12 {
        let length = 10f64.powi(-2 * k);
        let (time, impacts) = end(length);
        // The tail is summed in closed form, so that the length decides how many bounces are computed, not when they end.
        assert!((time - right).abs() <= 8.0 * U * right, "{length:e}: {time}");
        assert!(impacts < most && impacts as f64 <= 2.0 + (1.0 / length).log2() / 2.0, "{length:e}: {impacts}");
    }
}

#[test]
fn r31_a_ball_that_rests_costs_nothing_more() {
    let run = |duration: f64| {
        let stage = Stage::new(duration).down(G).floor(rough(0.5, coulomb(0.3)));
        stage.ball([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.1).run()
    };
    let (short, long) = (run(10.0), run(1e9));
    assert_eq!(short.outcome.motion, Motion::Resting);
    assert_eq!(short.trajectory.events, long.trajectory.events);
    assert_eq!(short.outcome.counters, long.outcome.counters);
    assert_eq!(long.outcome.time, 1e9);
    // And it does not tremble.
    let end = long.outcome.state;
    assert_eq!((end.velocity, end.position.z), (Vector3::zeros(), 0.1));
}

/// A ball on a slope with friction, at a speed down it, under the book's thresholds e1 and e2.
fn laid(tan: f64, mu: f64, speed: f64, e1: f64) -> Run {
    let (n, down) = (slope(tan).normalize(), Vector3::new(1.0, 0.0, -tan).normalize());
    let stage = Stage::new(0.125).down(G).plane("slope", rough(0.0, coulomb(mu)), [0.0; 3], n);
    stage.book_rest(e1, 1e-9, 0.0).ball([0.0; 3], down * speed, 0.0).run()
}

#[test]
fn r32_all_four_conditions_are_needed() {
    let rests = |run: Run| run.events(EventKind::Rest).first().is_some_and(|e| e.time == 0.0);
    assert!(rests(laid(0.25, 0.5, 0.0, 1e-3)), "slow, in contact, pressed, held");
    assert!(rests(laid(0.25, 0.5, 0.5e-3, 1e-3)), "slow enough");
    assert!(!rests(laid(0.25, 0.5, 2e-3, 1e-3)), "too fast");
    assert!(!rests(laid(0.25, 0.2, 0.0, 1e-3)), "friction is too weak");
    // In contact, but pulled off; and pressed towards a floor that it does not touch.
    let pulled =
        Stage::new(1.0).gravity([0.0, 0.0, 1.0]).floor(rough(0.0, coulomb(0.5))).ball([0.0, 0.0, 0.5], [0.0; 3], 0.5);
    assert_eq!(pulled.run().events(EventKind::Rest), []);
    let above = Stage::new(0.125).down(G).floor(rough(0.0, coulomb(0.5))).ball([0.0, 0.0, 1.0], [0.0; 3], 0.5);
    assert_eq!(above.run().events(EventKind::Rest), []);
    // Where nothing pulls, what stands in contact rests: F = 0 is not strict.
    let still = Stage::new(1.0).floor(rough(0.0, coulomb(0.5))).ball([0.0, 0.0, 0.5], [0.0; 3], 0.5).run();
    assert_eq!(still.outcome.state.position, Point3::new(0.0, 0.0, 0.5));
    assert_eq!(still.outcome.state.velocity, Vector3::zeros());
}

#[test]
fn r32_friction_holds_up_to_mu_and_not_beyond() {
    for tan in [0.1, 0.25, 0.5, 1.0, 2.0] {
        let little = 2f64.powi(-40);
        let held = laid(tan, tan * (1.0 + little), 0.0, 1e-9);
        assert_eq!((held.kinds(), held.outcome.state.position), (vec![EventKind::Rest], Point3::origin()), "{tan}");
        let (mu, cos) = (tan * (1.0 - little), 1.0 / tan.hypot(1.0));
        let slides = laid(tan, mu, 0.0, 1e-9);
        assert_eq!(slides.kinds(), [EventKind::Slide], "{tan}");
        // g (sin - mu cos) t, which is a difference of two nearly equal numbers: to u over the share that is left.
        let expected = G * cos * tan * little * 0.125;
        let speed = slides.outcome.state.velocity.norm();
        assert!((speed - expected).abs() <= 16.0 * U / little * expected, "{tan}: {speed:e} {expected:e}");
    }
}

#[test]
fn r33_rest_in_a_groove_and_in_a_corner() {
    // Smooth sides: in a groove the ball comes to rest across, and slides along unless the ground is level.
    let groove = |g: [f64; 3], friction: Friction| {
        let stage = Stage::new(20.0).gravity(g).plane("left", rough(0.5, friction), [0.0; 3], [1.0, 0.0, 1.0]);
        let stage = stage.plane("right", rough(0.5, friction), [0.0; 3], [-1.0, 0.0, 1.0]);
        stage.ball([0.1, 0.0, 2.0], [0.0; 3], 0.25).run()
    };
    let depth = 0.25 * 2f64.sqrt();
    for friction in [Friction::None, coulomb(0.2)] {
        let run = groove([0.0, 0.0, -G], friction);
        let end = run.outcome.state;
        assert_eq!((run.outcome.ending, run.outcome.motion), (Ending::Completed, Motion::Resting), "{friction:?}");
        assert_eq!(end.velocity, Vector3::zeros());
        assert!((end.position - Point3::new(0.0, 0.0, depth)).norm() <= 1e-11, "{:?}", end.position);
    }
    // Tilted along the groove: the loads are shared, each larger than half, and so is the friction.
    let (down, along) = (-G, 1.0);
    let smooth_groove = groove([0.0, along, down], Friction::None);
    assert_eq!(smooth_groove.outcome.motion, Motion::Sliding);
    assert_eq!(groove([0.0, along, down], coulomb(0.1)).outcome.motion, Motion::Resting, "1 < 0.1 * 9.81 * sqrt 2");
    assert_eq!(groove([0.0, along, down], coulomb(0.07)).outcome.motion, Motion::Sliding, "1 > 0.07 * 9.81 * sqrt 2");

    // A corner of three smooth planes, met obliquely.
    let corner = Stage::new(60.0)
        .gravity([-2.0, -3.0, -G])
        .plane("x", smooth(0.6), [0.0; 3], [1.0, 0.0, 0.0])
        .plane("y", smooth(0.6), [0.0; 3], [0.0, 1.0, 0.0])
        .plane("z", smooth(0.6), [0.0; 3], [0.0, 0.0, 1.0])
        .ball([1.0, 2.0, 3.0], [0.3, -0.2, 0.1], 0.5)
        .run();
    assert_eq!((corner.outcome.motion, corner.outcome.ending), (Motion::Resting, Ending::Completed));
    assert!((corner.outcome.state.position - Point3::new(0.5, 0.5, 0.5)).norm() <= 1e-11);
    assert_eq!(corner.outcome.state.velocity, Vector3::zeros());
}

#[test]
fn r34_a_ball_at_the_top_of_its_flight_does_not_freeze() {
    for method in [None, Some(Method::Rk4 { step: 0.125 }), Some(Method::Euler { step: 0.125 })] {
        // At the top at t = 0.5, exactly at a step's end; and one that starts at its top.
        let mut stage = Stage::new(0.875).down(8.0).floor(smooth(0.5));
        stage.0.method = method;
        let thrown = stage.clone().ball([0.0, 0.0, 1.0], [0.0, 0.0, 4.0], 0.0).run();
        let dropped = stage.ball([0.0, 0.0, 1.0], [0.0; 3], 0.0).run();
        assert!(thrown.outcome.state.velocity.z <= -3.0, "{method:?}: {:?}", thrown.outcome.state);
        assert!(dropped.impacts().len() == 1, "{method:?}");
        assert_eq!((thrown.events(EventKind::Rest), dropped.events(EventKind::Rest)), (vec![], vec![]));
    }
    // Nor one whose top just touches a ceiling.
    let touching =
        Stage::new(1.0).down(8.0).plane("ceiling", rough(0.5, coulomb(1.0)), [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    let run = touching.ball([0.0; 3], [0.0, 0.0, 4.0], 0.0).run();
    assert_eq!(run.outcome.state.position.z, 0.0);
    assert_eq!(run.outcome.state.velocity.z, -4.0);
}

#[test]
fn r34_a_ball_on_a_slope_too_steep_slides_whatever_the_thresholds() {
    for (tan, mu) in [(0.5, 0.4), (1.0, 0.0), (0.01, 0.009), (3.0, 2.9)] {
        let run = Stage::new(2.0)
            .down(G)
            .plane("slope", rough(0.5, coulomb(mu)), [0.0; 3], slope(tan))
            .ball(Point3::from(slope(tan).normalize() * 0.1), [0.0; 3], 0.1)
            .run();
        assert_eq!((run.outcome.motion, run.events(EventKind::Rest)), (Motion::Sliding, vec![]), "{tan} {mu}");
        let cos = 1.0 / tan.hypot(1.0);
        let expected = 2.0 * G * cos * (tan - mu);
        // Laid on it to rounding, it first hops by as much: so long friction holds it less.
        let hops = 3.0 * (2.0 * touch_distance(0.1, 0.0) / G).sqrt();
        let bound = mu * G * hops + 16.0 * U * G;
        assert!(
            (run.outcome.state.velocity.norm() - expected).abs() <= bound,
            "{tan} {mu}: {:e}",
            run.outcome.state.velocity.norm() - expected
        );
    }
}

#[test]
fn r34_a_ball_that_bounces_down_a_slope_with_the_books_friction_may_speed_up() {
    // mu / (1 + c_r) < tan < mu: bouncing, it gains speed; resting, it would stick. With the impulse law it slows down.
    let (tan, c_r, mu) = (0.45, 0.9, 0.5);
    let speed_after = |friction: Friction| {
        let n = slope(tan).normalize();
        let stage = Stage::new(8.0).down(G).plane("slope", rough(c_r, friction), [0.0; 3], n);
        let run = stage.ball(Point3::from(n), Vector3::new(1.0, 0.0, -tan).normalize() * 4.0, 0.0).run();
        // From the top of one hop to the top of the next, in units of the time and of g cos: tan - mu / (1 + c_r).
        let impacts = run.impacts();
        let top = |k: usize| {
            let (a, b) = (&impacts[k], &impacts[k + 1]);
            let down = Vector3::new(1.0, 0.0, -tan).normalize();
            (0.5 * (a.time + b.time), 0.5 * (a.velocity + b.velocity_in).dot(&down))
        };
        let ((t0, v0), (t1, v1)) = (top(0), top(5));
        (v1 - v0) / (t1 - t0) / (G * n.z)
    };
    let (book, impulse) = (speed_after(coulomb(mu)), speed_after(Friction::impulse(mu).unwrap()));
    println!("book {book:.4}, impulse {impulse:.4}");
    assert!((book - (tan - mu / (1.0 + c_r))).abs() < 1e-12, "{book}");
    assert!((impulse - (tan - mu)).abs() < 1e-12, "{impulse}");
}

#[test]
fn r28_a_ball_that_turns_round_in_a_corner_does_not_sink_into_the_wall() {
    // Friction on the floor all but holds it against the wall: its last hops off the wall end near a standstill.
    let (radius, material) = (0.38303877251675755, rough(0.6863948689802742, coulomb(0.45962633463514024)));
    let run = Stage::new(3.0)
        .gravity([-2.514476796157906, 0.0, -5.29330608049208])
        .room(material, [2.0; 3])
        .ball(
            [1.1250836866115836, 0.5700844076883256, 1.4956390009895801],
            [3.975835440685539, 7.299773258437436, -4.248881078711003],
            radius,
        )
        .run();
    assert_eq!(run.outcome.motion, Motion::Resting);
    for segment in &run.trajectory.segments {
        for k in 0..=16 {
            let x = segment.step.at(segment.to * f64::from(k) / 16.0).position;
            assert!(x.coords.min() - radius >= -16.0 * U, "{:e} at {}", x.coords.min() - radius, segment.time);
        }
    }
}

#[test]
fn r28_friction_in_a_groove_stops_what_slides_up_it_and_drives_nothing() {
    // Slower than the two walls together would call standing (sqrt(2 (4 + 4) / 2) m/s), faster than each: it slides on until it stands.
    let up = |friction: Friction, pull: f64, walled: bool| {
        let m = rough(0.5, friction);
        let stage = Stage::new(4.0).gravity([-pull, -4.0, -4.0]).rest_length(0.5).floor(m).plane(
            "side",
            m,
            [0.0; 3],
            [0.0, 1.0, 0.0],
        );
        let stage = if walled { stage.plane("end", m, [0.0; 3], [1.0, 0.0, 0.0]) } else { stage };
        stage.ball([0.0; 3], [2.5, 0.0, 0.0], 0.0).run()
    };
    for friction in [coulomb(0.5), Friction::impulse(0.5).unwrap()] {
        for walled in [false, true] {
            // mu (N1 + N2) = 4 m/s^2 against a pull of 1: at -5 m/s^2 it stands after 0.5 s and 0.625 m, and is held.
            let run = up(friction, 1.0, walled);
            let rest = run.events(EventKind::Rest)[0];
            assert_eq!((rest.time, rest.position), (0.5, Point3::new(0.625, 0.0, 0.0)), "walled: {walled}");
            assert_eq!(run.outcome.state.position, rest.position);
        }
    }
    for friction in [coulomb(0.125), Friction::impulse(0.125).unwrap()] {
        // 1 m/s^2 against a pull of 3: up at -4 m/s^2 for 0.625 s, and down again at -2.
        let run = up(friction, 3.0, false);
        assert_eq!(run.at(0.625), Point3::new(0.78125, 0.0, 0.0));
        assert_eq!(run.at(1.625), Point3::new(-0.21875, 0.0, 0.0));
    }
    // What lets nothing slide stops it where it is.
    assert_eq!(up(Friction::linear(0.5).unwrap(), 1.0, false).outcome.state.position, Point3::origin());
}

#[test]
fn h29_a_ball_wider_than_its_corridor_of_polygons_goes_on_along_it_and_no_deeper_into_the_walls() {
    let wall = |x: f64| [[x, -50.0, -50.0], [x, 50.0, -50.0], [x, 50.0, 50.0], [x, -50.0, 50.0]];
    // Between planes it is refused. It overlaps both walls by as much; what it has across is lost between them at once, and nothing else.
    let floor = Stage::new(2.0).down(9.81).floor(smooth(0.5));
    for radius in [0.5, 0.500001, 0.6, 0.9] {
        let start = [0.5, 0.0, 2.0];
        let alone = floor.clone().ball(start, [0.0, 1.0, 0.0], radius).run();
        for across in [0.0, 0.3, -3.0, 1e-9] {
            let walls = floor.clone().polygon("west", smooth(0.5), &wall(0.0)).polygon("east", smooth(0.5), &wall(1.0));
            let run = walls.ball(start, [across, 1.0, 0.0], radius).run();
            for k in 0..=100 {
                let t = 0.02 * f64::from(k);
                let off = run.at(t) - alone.at(t);
                assert!(off.amax() <= touch_distance(52.0, 2.0), "r = {radius}, {across} across, after {t} s: {off}");
            }
        }
    }
}
