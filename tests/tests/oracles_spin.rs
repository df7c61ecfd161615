//! Bounces with spin and rolling, against closed forms.

use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::grip::Grip;
use carom_dynamics::error::SceneError;
use carom_dynamics::events::{EventKind, Motion};
use carom_dynamics::plan::Plan;
use carom_dynamics::surface::Material;
use carom_tests::oracle::{Table, U, Worst};
use carom_tests::stage::{Run, Stage, rough, smooth};
use nalgebra::Vector3;

/// A material that grips.
fn gripping(c_r: f64, mu: f64, e_x: f64, c_rr: f64) -> Material {
    let grip = Grip::new(mu).and_then(|grip| grip.with_tangential(e_x)).and_then(|grip| grip.with_rolling(c_rr));
    rough(c_r, Friction::Grip(grip.unwrap()))
}

const RADIUS: f64 = 0.5;

/// The spin about y that `r_omega` of a table is: a ball that rolls along x turns about y.
fn about_y(r_omega: f64) -> Vector3<f64> {
    Vector3::new(0.0, r_omega / RADIUS, 0.0)
}

#[test]
fn bounces_with_spin_grip_or_slip() {
    let table = Table::read("spin_bounce");
    let (mut velocities, mut spins) = (Worst::of("velocity"), Worst::of("r omega"));
    for row in table.rows() {
        let [alpha, e, e_x, mu, vx, vy, r_omega] = row.numbers(["alpha", "e", "e_x", "mu", "vx", "vy", "r_omega"]);
        let [vx_out, vy_out, r_omega_out] = row.numbers(["vx_out", "vy_out", "r_omega_out"]);
        let mut stage = Stage::new(0.5).floor(gripping(e, mu, e_x, 0.0));
        stage = stage.thing([0.0, 0.0, RADIUS - 0.125 * vy], [vx, 0.0, vy], RADIUS, None).spinning(about_y(r_omega));
        stage.0.balls[0] = stage.0.balls[0].with_inertia(alpha).unwrap();
        let run = stage.run();
        let impact = run.impacts()[0];
        let size = vx.abs() + vy.abs() + r_omega.abs();
        let place = || format!("{} alpha {alpha} e {e} e_x {e_x} mu {mu}: {vx} {vy} {r_omega}", row.text("regime"));
        velocities.see(impact.velocity.x, vx_out, 16.0 * U * size, place);
        velocities.see(impact.velocity.z, vy_out, 16.0 * U * size, place);
        spins.see(impact.spin.unwrap().y * RADIUS, r_omega_out, 32.0 * U * size, place);
        let energy = |v: Vector3<f64>, w: Vector3<f64>| v.norm_squared() + alpha * (RADIUS * w).norm_squared();
        let ratio = energy(impact.velocity, impact.spin.unwrap()) / energy(impact.velocity_in, about_y(r_omega));
        assert!(ratio <= 1.0 + 16.0 * U, "{}: energy {ratio}", place());
    }
    Worst::settle_all([velocities, spins]);
}

/// A ball on a floor that it slips on, until it rolls, until it stops.
#[test]
fn a_sliding_ball_begins_to_roll_and_rolling_resistance_stops_it() {
    let table = Table::read("slide_to_roll");
    let (mut times, mut places, mut speeds) = (Worst::of("time"), Worst::of("place"), Worst::of("speed"));
    for row in table.rows() {
        let [alpha, mu, v0, r_omega0, c_rr, g] = row.numbers(["alpha", "mu", "v0", "r_omega0", "c_rr", "g"]);
        let [t_slip, v_roll, x_slip] = row.numbers(["t_slip_ends", "v_roll", "x_slip"]);
        let [t_stop, x_roll] = row.numbers(["t_roll_stop", "x_roll"]);
        let mut stage =
            Stage::new(t_slip + t_stop + 1.0).down(g).floor(gripping(0.5, mu, 0.0, c_rr)).rest_length(1e-14);
        stage = stage.thing([0.0, 0.0, RADIUS], [v0, 0.0, 0.0], RADIUS, None).spinning(about_y(r_omega0));
        stage.0.balls[0] = stage.0.balls[0].with_inertia(alpha).unwrap();
        let run = stage.run();
        let kinds = [EventKind::Slide, EventKind::Roll, EventKind::Rest];
        assert_eq!(run.kinds(), kinds, "{v0} {r_omega0}");
        let (roll, rest) = (run.trajectory.events[1], run.trajectory.events[2]);
        let place = || format!("v0 = {v0}, r omega0 = {r_omega0}");
        times.see(roll.time, t_slip, 32.0 * U * t_slip, place);
        places.see(roll.position.x, x_slip, 64.0 * U * (x_slip.abs() + v0 * t_slip), place);
        speeds.see(roll.velocity.x, v_roll, 64.0 * U * (v0.abs() + r_omega0.abs()), place);
        speeds.see(roll.spin.unwrap().y * RADIUS, v_roll, 64.0 * U * (v0.abs() + r_omega0.abs()), place);
        // The rest speed of 1e-14 m is 4e-7 m/s.
        times.see(rest.time - roll.time, t_stop, 1e-6 * t_stop, place);
        places.see(rest.position.x - roll.position.x, x_roll, 1e-9 * x_roll.abs(), place);
        assert_eq!((run.outcome.motion, run.outcome.spin), (Motion::Resting, Some(Vector3::zeros())));
    }
    Worst::settle_all([times, places, speeds]);
}

fn on_a_slope(tan: f64, material: Material, seconds: f64) -> Run {
    let n = Vector3::new(tan, 0.0, 1.0).normalize();
    let stage = Stage::new(seconds).down(9.81).plane("slope", material, [0.0; 3], n).rest_length(1e-12);
    stage.thing(nalgebra::Point3::from(n * 0.1), [0.0; 3], 0.1, None).run()
}

/// A ball rolls down a slope with g sin / (1 + alpha) as long as mu >= tan alpha / (1 + alpha); a steeper one it slips down with g (sin - mu cos).
#[test]
fn a_ball_rolls_down_a_gentle_slope_and_slips_down_a_steep_one() {
    let (mu, alpha, g) = (0.2, 0.4, 9.81);
    let limit = mu * (1.0 + alpha) / alpha;
    for (tan, rolls) in [(0.2, true), (0.9 * limit, true), (1.1 * limit, false), (2.0 * limit, false)] {
        let run = on_a_slope(tan, gripping(0.5, mu, 0.0, 0.0), 1.0);
        let angle = f64::atan(tan);
        let (sin, cos) = (angle.sin(), angle.cos());
        let a = if rolls { g * sin / (1.0 + alpha) } else { g * (sin - mu * cos) };
        let v = run.outcome.state.velocity.norm();
        assert!((v / a - 1.0).abs() < 1e-12, "tan {tan}: {v} m/s, should be {a}");
        assert_eq!(run.outcome.motion, if rolls { Motion::Rolling } else { Motion::Sliding }, "tan {tan}");
        let turn = 0.1 * run.outcome.spin.unwrap().norm();
        let right = if rolls { a } else { mu * g * cos / alpha };
        assert!((turn / right - 1.0).abs() < 1e-12, "tan {tan}: r omega = {turn}, should be {right}");
    }
    let held = on_a_slope(0.05, gripping(0.5, 0.2, 0.0, 0.051), 1.0);
    assert_eq!((held.outcome.motion, held.outcome.state.velocity), (Motion::Resting, Vector3::zeros()));
}

/// Slipping that turns: a ball thrown along a floor with sidespin ends rolling with (v0 + alpha r omega x n) / (1 + alpha), whatever its way.
#[test]
fn a_ball_with_side_spin_ends_rolling_with_what_its_momentum_about_the_floor_says() {
    let stage = Stage::new(4.0).down(9.81).floor(gripping(0.0, 0.3, 0.0, 0.0)).rest_length(1e-12);
    let spin = Vector3::new(12.0, -20.0, 9.0);
    let v0 = Vector3::new(3.0, 1.0, 0.0);
    let run = stage.thing([0.0, 0.0, 0.5], v0, RADIUS, None).spinning(spin).run();
    let right = (v0 + 0.4 * RADIUS * spin.cross(&Vector3::z())) / 1.4;
    assert!((run.outcome.state.velocity - right).norm() < 1e-12, "{} {right}", run.outcome.state.velocity);
    assert_eq!(run.outcome.motion, Motion::Rolling);
    assert_eq!(run.outcome.spin.unwrap().z, 9.0, "nothing brakes what turns about the normal");
}

#[test]
fn a_superball_between_floor_and_ceiling_comes_back() {
    // Garwin: thrown under a table, it returns.
    let stage = Stage::new(2.0).floor(gripping(1.0, 100.0, 1.0, 0.0));
    let stage = stage.plane("table", gripping(1.0, 100.0, 1.0, 0.0), [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    let run = stage.thing([0.0, 0.0, 0.3], [4.0, 0.0, -2.0], 0.05, None).run();
    let third = run.impacts()[2];
    assert!(third.velocity.x < 0.0, "{third:?}");
    let energy = |v: Vector3<f64>, w: Vector3<f64>| v.norm_squared() + 0.4 * (0.05 * w).norm_squared();
    for impact in run.impacts() {
        assert!((energy(impact.velocity, impact.spin.unwrap()) / 20.0 - 1.0).abs() < 1e-13);
    }
}

#[test]
fn a_surface_without_friction_leaves_the_spin_alone_and_one_without_grip_knows_of_none() {
    let throw = |material: Material| {
        let stage = Stage::new(3.0).down(9.81).floor(material).rest_length(1e-6);
        stage.thing([0.0, 0.0, 1.0], [2.0, 0.0, 0.0], 0.1, None)
    };
    let plain = throw(smooth(0.7)).run();
    assert!(plain.outcome.spin.is_none() && plain.trajectory.events.iter().all(|e| e.spin.is_none()));
    let spinning = throw(smooth(0.7)).spinning([5.0, 6.0, 7.0]).run();
    assert_eq!(plain.outcome.state, spinning.outcome.state);
    assert_eq!(spinning.outcome.spin, Some(Vector3::new(5.0, 6.0, 7.0)));
    // A grip of no friction is none.
    let slippery = throw(gripping(0.7, 0.0, 0.0, 0.0)).spinning([5.0, 6.0, 7.0]).run();
    assert_eq!(plain.outcome.state.position.x, slippery.outcome.state.position.x);
}

#[test]
fn a_point_cannot_be_turned() {
    let stage = Stage::new(1.0).down(9.81).floor(gripping(0.5, 0.5, 0.0, 0.0)).ball([0.0, 0.0, 1.0], [0.0; 3], 0.0);
    let error = Plan::new(&stage.0).expect_err("a point does not turn");
    assert_eq!(error, SceneError::RadiusMissing { ball: 0, effect: "grip" });
}
