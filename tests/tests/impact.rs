//! The loop of the chapter, row by row: an instant, three stages, the earliest f, sub-steps, and nothing not asked for.

use carom_dynamics::body::Ball;
use carom_dynamics::clock::Clock;
use carom_dynamics::collision::{Obstacles, Returns};
use carom_dynamics::contacts::Contacts;
use carom_dynamics::counters::Counters;
use carom_dynamics::effects::drag::Drag;
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::events::Motion;
use carom_dynamics::integrators::euler;
use carom_dynamics::response::respond;
use carom_dynamics::scene::Method;
use carom_dynamics::surface::Shape;
use carom_dynamics::tolerance::touch_distance;
use carom_geometry::plane::Side;
use carom_tests::oracle::U;
use carom_tests::stage::{Stage, coulomb, rough, smooth};
use nalgebra::{Point3, Vector3};

/// A ball thrown into a room with friction, which bounces and comes to rest.
fn thrown() -> Stage {
    Stage::new(20.0).down(9.81).room(rough(0.7, coulomb(0.3)), [3.0, 2.0, 2.5]).ball(
        [1.0, 0.5, 1.5],
        [4.0, 2.0, 1.0],
        0.1,
    )
}

#[test]
fn r01_an_impact_takes_no_time() {
    let run = thrown().run();
    let impacts = run.impacts();
    assert!(impacts.len() > 20);
    for (a, b) in run.trajectory.segments.iter().zip(&run.trajectory.segments[1..]) {
        // The next stretch begins at the instant at which the last one ended.
        assert_eq!(a.end, b.time);
    }
    // One instant, two velocities: the stretch before ends with the one, the stretch after begins with the other.
    for e in impacts.iter().filter(|e| (e.velocity - e.velocity_in).norm() > 1e-3) {
        let ending = run.trajectory.segments.iter().rev().find(|s| s.time < e.time).unwrap();
        assert!((ending.step.at(ending.to).velocity - e.velocity_in).norm() <= 64.0 * U * 10.0, "{e:?}");
    }
}

#[test]
fn r02_detection_determination_and_response_one_after_the_other() {
    let stage = Stage::new(1.0).down(8.0).floor(smooth(0.5)).ball([0.0, 0.0, 1.25], [1.0, 0.0, -3.0], 0.25);
    let stage = stage.method(Method::Euler { step: 0.5 });
    let (plan, mut counters) = (stage.plan(), Counters::default());
    let start = plan.balls()[0].start();
    let Shape::Plane(floor) = stage.0.surfaces[0].shape.clone() else { panic!("a plane") };
    let step = euler::explicit(&start, plan.constant_acceleration(&plan.balls()[0]), 0.5);

    // Detection: the clearance changes its sign.
    let [before, after] = [start, step.end()].map(|s| floor.clearance(&s.position, 0.25, Side::Positive));
    assert_eq!((before, after), (1.0, -0.5));

    // Determination: when, and where.
    let mut obstacles = Obstacles::new(&plan, 0.25, &start, &plan.constant_acceleration(&plan.balls()[0]));
    let none = Contacts::new();
    let mut returns = Returns::new();
    obstacles.returns(&step, &none, &mut returns, &mut counters);
    let hit = obstacles.earliest(&step, &none, &returns, &mut counters).unwrap();
    assert_eq!((hit.f, hit.surface), (before / (before - after), 0));
    let there = step.at(hit.f);
    let mut touched = Contacts::new();
    let tolerance = touch_distance(1.25, 1.5);
    obstacles.touching(&there, tolerance, None, &mut touched, &mut counters);
    assert_eq!(touched.len(), 1);

    // Response: which velocity.
    let answer = respond(there.velocity, &mut touched, |_| &stage.0.surfaces[0].material, &mut counters);
    let event = stage.run().impacts()[0];
    assert_eq!((event.time, event.position), (step.time(hit.f), there.position));
    assert_eq!((event.velocity_in, event.velocity), (there.velocity, answer));
}

#[test]
fn r03_in_one_dimension_the_sign_of_y_minus_b_decides() {
    // A barrier at b = 1; y = 1.4 t; steps of 0.1 s end at 0.98 and 1.12, so f = 0.02 / 0.14 = 1/7.
    let stage = Stage::new(2.0).plane("barrier", smooth(0.5), [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
    let run = stage.ball([0.0; 3], [0.0, 1.4, 0.0], 0.0).method(Method::Euler { step: 0.1 }).run();
    let [impact] = run.impacts()[..] else { panic!("one impact") };
    assert!((run.trajectory.segments[7].to - 1.0 / 7.0).abs() <= 64.0 * U, "{}", run.trajectory.segments[7].to);
    assert!((impact.time - 5.0 / 7.0).abs() <= 8.0 * U);
    assert_eq!((impact.velocity_in.y, impact.velocity.y), (1.4, -0.7));
}

#[test]
fn r06_each_side_keeps_its_ball() {
    let stage = Stage::new(5.0).floor(smooth(1.0));
    for side in [1.0, -1.0] {
        let run = stage.clone().ball([0.0, 0.0, 2.0 * side], [0.0, 0.0, -side], 0.5).gravity([0.0, 0.0, -side]).run();
        assert!(run.impacts().len() > 1);
        for k in 0..=500 {
            let z = run.at(0.01 * f64::from(k)).z * side;
            assert!(z >= 0.5 - 4.0 * U, "{z} on side {side}");
        }
    }
}

#[test]
fn r09_overlapping_and_leaving_is_no_event_and_overlapping_and_closing_is_one_now() {
    for (v, impacts) in [(1.0, 0), (0.0, 0), (-1.0, 1)] {
        let run = Stage::new(1.0).floor(smooth(0.5)).ball([0.0, 0.0, 0.4], [0.0, 0.0, v], 0.5).run();
        let seen = run.impacts();
        assert_eq!(seen.len(), impacts, "{seen:?}");
        assert!(seen.iter().all(|e| e.time == 0.0 && e.velocity.z == 0.5), "{seen:?}");
    }
}

#[test]
fn r10_every_loop_is_bounded_and_says_so() {
    // A ball between walls nearer to each other than its diameter: no time can pass.
    let wall = |x: f64| [[x, -9.0, -9.0], [x, 9.0, -9.0], [x, 9.0, 9.0], [x, -9.0, 9.0]];
    let stage = Stage::new(1.0).polygon("left", smooth(1.0), &wall(0.0)).polygon("right", smooth(1.0), &wall(0.5));
    let outcome = stage.ball([0.25, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5).run().outcome;
    assert!(outcome.time <= 1.0 && outcome.state.position.coords.norm().is_finite(), "{outcome:?}");
    assert!(outcome.counters.paths < 100_000, "{outcome:?}");
}

#[test]
fn r10_time_is_n_h_and_no_running_sum() {
    let stage = Stage::new(1000.0).method(Method::Euler { step: 0.1 }).ball([0.0; 3], [1.0, 0.0, 0.0], 0.0);
    let run = stage.run();
    assert_eq!(run.trajectory.segments.len(), 10_000);
    for (n, segment) in run.trajectory.segments.iter().enumerate() {
        assert_eq!(segment.time, n as f64 * 0.1);
    }
    // The clock between loses nothing either.
    let mut clock = Clock::start();
    (0..1000).for_each(|_| clock.advance(0.1));
    assert!((clock.now() - 100.0).abs() <= 2.0 * U * 100.0);
}

#[test]
fn r11_f_is_a_part_of_the_sub_step() {
    // Two hits in one step of 1 s between walls 0.5 m apart: after the first, f is a part of what remains.
    let run = Stage::new(1.0)
        .plane("left", smooth(1.0), [0.0; 3], [1.0, 0.0, 0.0])
        .plane("right", smooth(1.0), [0.5, 0.0, 0.0], [-1.0, 0.0, 0.0])
        .ball([0.25, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0)
        .method(Method::Euler { step: 1.0 })
        .run();
    let pieces: Vec<_> = run.trajectory.segments.iter().map(|s| (s.time, s.step.seconds, s.to)).collect();
    assert_eq!(pieces.len(), 3);
    assert_eq!(pieces[0], (0.0, 1.0, 0.25));
    assert_eq!((pieces[1].0, pieces[1].1), (0.25, 0.75));
    assert!((pieces[1].2 - 0.5 / 0.75).abs() <= 2.0 * U);
    assert_eq!(pieces[2], (0.75, 0.25, 1.0));
    assert_eq!(run.outcome.state.position.x, 0.25);
}

#[test]
fn r12_of_several_planes_in_one_step_the_first_is_answered() {
    let stage = Stage::new(1.0)
        .plane("far", smooth(0.5), [4.0, 0.0, 0.0], [-1.0, 0.0, 0.0])
        .plane("near", smooth(0.5), [2.0, 0.0, 0.0], [-1.0, 0.0, 0.0])
        .plane("between", smooth(0.5), [3.0, 0.0, 0.0], [-1.0, 0.0, 0.0])
        .ball([0.0; 3], [8.0, 0.0, 0.0], 0.0);
    for method in [Method::Exact, Method::Euler { step: 1.0 }] {
        let [impact] = stage.clone().method(method).run().impacts()[..] else { panic!("one impact") };
        assert_eq!((impact.surface, impact.time, impact.velocity.x), (1, 0.25, -4.0));
    }
}

#[test]
fn r13_by_default_nothing_happens_that_the_chapter_does_not_have() {
    let plain = Stage::new(3.0).down(9.81).floor(smooth(0.8)).ball([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.1);
    let right = plain.run();
    assert_eq!((right.outcome.counters.drag, right.outcome.counters.friction), (0, 0));
    // A ball of any mass, and friction that is none: the same bits.
    let mut heavy = plain.clone();
    heavy.0.balls.clear();
    let heavy = heavy.thing([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.1, Some(7.0)).run();
    assert_eq!(heavy.trajectory, right.trajectory);
    for none in [coulomb(0.0), Friction::linear(0.0).unwrap(), Friction::impulse(0.0).unwrap()] {
        let mut stage = plain.clone();
        stage.0.surfaces[0].material.friction = none;
        assert_eq!(stage.run().trajectory.events, right.trajectory.events);
    }
    // Drag that is none changes the method, and the result by rounding only.
    let mut still = plain.clone().drag(Drag::linear(0.0).unwrap());
    still.0.balls.clear();
    let still = still.thing([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.1, Some(7.0)).run();
    assert_eq!(still.impacts().len(), right.impacts().len());
    for (a, b) in still.impacts().iter().zip(right.impacts()) {
        assert!((a.time - b.time).abs() <= 1e-12 * b.time && (a.velocity - b.velocity).norm() <= 1e-12);
    }
}

#[test]
fn r15_an_impact_moves_nothing() {
    let run = thrown().run();
    assert!(run.outcome.counters.corrections > 0, "corrections are counted");
    for (a, b) in run.trajectory.segments.iter().zip(&run.trajectory.segments[1..]) {
        let (from, to) = (a.step.at(a.to).position, b.step.at(0.0).position);
        // A correction is no longer than the rounding of a position.
        let bound = touch_distance(3.0, (a.step.at(0.0).position - from).norm());
        assert!((to - from).norm() <= bound, "{:e} at {}", (to - from).norm(), b.time);
    }
}

#[test]
fn r16_r25_the_velocity_is_split_and_put_together_on_an_oblique_plane() {
    let n = Vector3::new(2.0, -3.0, 6.0) / 7.0;
    let (c_r, mu) = (0.75, 0.25);
    for v in [[1.0, 2.0, -3.0], [-4.0, 0.5, 0.0], [0.1, 0.2, -8.0]].map(Vector3::from) {
        let material = rough(c_r, coulomb(mu));
        let stage = Stage::new(0.5).plane("oblique", material, [0.0; 3], n).ball(Point3::from(-v * 0.25), v, 0.0);
        let [impact] = stage.run().impacts()[..] else { panic!("one impact") };
        let v_n = n * n.dot(&v);
        let v_t = v - v_n;
        let slowed = v_t - v_t.normalize() * (mu * v_n.norm()).min(v_t.norm());
        assert!((impact.velocity - (slowed - v_n * c_r)).norm() <= 16.0 * U * v.norm(), "{impact:?}");
    }
}

#[test]
fn r27_time_place_and_distance_of_a_hit_are_within_their_bounds() {
    // In dyadic numbers the answer is known: the ball falls 2 m in 0.5 s.
    for (far, slack) in [(0.0, 0.0), (1.0, 1.0), (1e3, 1.0), (1e6, 1.0)] {
        let normal = Vector3::new(0.6, 0.0, 0.8);
        let shift = Vector3::new(far, -far, far);
        let start = Point3::origin() + shift + normal * 2.25;
        let stage =
            Stage::new(1.0).gravity(normal * -16.0).plane("floor", smooth(0.5), Point3::origin() + shift, normal);
        let impact = stage.ball(start, [0.0; 3], 0.25).run().impacts()[0];
        let bound = touch_distance(far + 2.25, 2.0);
        let distance = normal.dot(&(impact.position - (Point3::origin() + shift))) - 0.25;
        assert!(distance.abs() <= bound, "{distance:e} at {far}");
        // A place that is off by the bound is a time that is off by it over the speed.
        let late = (impact.time - 0.5).abs();
        assert!(late <= bound / 8.0 * slack + 4.0 * U, "{late:e} at {far}");
    }
}

#[test]
fn r28_a_hit_position_below_the_plane_does_not_let_the_ball_through() {
    // Every start a few ulps above, on, or below the floor, falling: the ball stays above.
    for k in -8i64..=8 {
        for exponent in [-200, -50, -10, 0, 10, 50, 200] {
            let size = 2f64.powi(exponent);
            let z = 0.25 * size + k as f64 * size * U;
            let stage =
                Stage::new(4.0).down(size).floor(smooth(0.5)).ball([0.0, 0.0, z], [0.0, 0.0, -size], 0.25 * size);
            let run = stage.run();
            assert!((1..200).contains(&run.impacts().len()), "{} impacts", run.impacts().len());
            assert_eq!(run.outcome.motion, Motion::Resting);
            for i in 0..=64 {
                let z = run.at(f64::from(i) / 16.0).z;
                assert!(z >= 0.25 * size - 64.0 * U * size, "{z:e} in a scene of {size:e}, k = {k}");
            }
        }
    }
}

#[test]
fn r28_never_through_a_thin_wall_at_any_speed() {
    let square = [[1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0]];
    for radius in [0.0, 1e-3, 0.5] {
        for decade in 0..=15 {
            let speed = 10f64.powi(10 * decade);
            for method in [Method::Exact, Method::Euler { step: 1.0 / 60.0 }] {
                let stage = Stage::new(2.0).polygon("wall", smooth(0.5), &square).method(method);
                let run = stage.ball([0.0; 3], [speed, 0.0, 0.0], radius).run();
                let [impact] = run.impacts()[..] else { panic!("{} impacts at {speed:e}", run.impacts().len()) };
                assert!((impact.velocity.x + 0.5 * speed).abs() <= 4.0 * U * speed);
                assert!(run.outcome.state.position.x < 1.0, "{:?}", run.outcome);
            }
        }
    }
}

#[test]
fn r18_a_ball_is_refused_where_f64_does_not_resolve_it() {
    let stage =
        Stage::new(1.0).plane("far", smooth(0.5), [1e8, 0.0, 0.0], [-1.0, 0.0, 0.0]).ball([0.0; 3], [0.0; 3], 1e-9);
    let error = carom_dynamics::plan::Plan::new(&stage.0).unwrap_err().to_string();
    assert!(error.contains("1e8") || error.contains("100000000"), "{error}");
    assert!(Ball::new(Point3::origin(), Vector3::zeros(), -1.0, None).is_err());
}
