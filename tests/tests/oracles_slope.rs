//! Bouncing down a slope and sliding on it, against closed forms.

use carom_dynamics::events::{EventKind, Motion};
use carom_tests::oracle::{Table, U, Worst};
use carom_tests::stage::{Stage, coulomb, rough, smooth};
use nalgebra::Vector3;

/// A rest length that ends no motion a table can tell from another.
const LEAST_HOP: f64 = 1e-22;

/// A slope through the origin that falls towards +x: its normal, and the directions downhill and across.
struct Slope {
    normal: Vector3<f64>,
    down: Vector3<f64>,
    across: Vector3<f64>,
}

impl Slope {
    fn of_degrees(angle: f64) -> Self {
        let (sin, cos) = angle.to_radians().sin_cos();
        Self { normal: Vector3::new(sin, 0.0, cos), down: Vector3::new(cos, 0.0, -sin), across: Vector3::y() }
    }
}

#[test]
fn r12_bounces_down_a_slope() {
    let table = Table::read("incline_bounces");
    let (mut times, mut ranges) = (Worst::of("time since the first impact"), Worst::of("distance down the slope"));
    let mut speeds = Worst::of("speeds off and along the slope");
    for group in table.groups(4) {
        let [g, h, angle, e] = group[0].numbers(["g", "h_drop", "slope_deg", "e"]);
        let slope = Slope::of_degrees(angle);
        let last = group[group.len() - 1].number("t_since_first_impact");
        let stage = Stage::new(2.0 * last + 2.0).down(g).plane("slope", smooth(e), [0.0; 3], slope.normal).ball(
            [0.0, 0.0, h],
            [0.0; 3],
            0.0,
        );
        let impacts = stage.rest_length(1e-60).run().impacts();
        assert!(impacts.len() > group.len());
        for row in &group {
            let [k, t, range, vt, vn] =
                row.numbers(["k", "t_since_first_impact", "distance_down_slope", "vt_at_next_impact", "vn_out_k"]);
            let (first, before, here) = (&impacts[0], &impacts[k as usize - 1], &impacts[k as usize]);
            // Beyond the 4 roundings of a bounce: the angle and the components of the normal are rounded.
            let bound = 4.0 * (k + 2.0) * U;
            let place = || format!("slope {angle}, e = {e}, k = {k}");
            times.see(here.time - first.time, t, bound * here.time, place);
            ranges.see((here.position - first.position).dot(&slope.down), range, 2.0 * bound * range, place);
            speeds.see(here.velocity_in.dot(&slope.down), vt, bound * vt, place);
            // What leaves the slope is seen beside what goes along it.
            let beside = before.velocity.norm();
            speeds.see(before.velocity.dot(&slope.normal), vn, bound * vn + 2.0 * U * beside, place);
        }
    }
    Worst::settle_all([times, ranges, speeds]);
}

#[test]
fn r34_bouncing_down_a_smooth_slope_ends_in_sliding() {
    let table = Table::read("incline_zeno");
    let (mut ends, mut places) = (Worst::of("end of bouncing"), Worst::of("distance down the slope by then"));
    let mut speeds = Worst::of("speed of sliding then");
    for row in table.rows() {
        let [g, h, angle, e] = row.numbers(["g", "h_drop", "slope_deg", "e"]);
        let [t, distance, speed] = row.numbers(["t_bouncing_ends", "distance_bouncing_ends", "slide_speed_then"]);
        let slope = Slope::of_degrees(angle);
        let run = Stage::new(2.0 * t + 2.0)
            .down(g)
            .plane("slope", smooth(e), [0.0; 3], slope.normal)
            .ball([0.0, 0.0, h], [0.0; 3], 0.0)
            .run();
        assert_eq!(run.events(EventKind::Rest), []);
        assert_eq!(run.outcome.motion, Motion::Sliding);
        let (first, slide) = (run.impacts()[0], run.events(EventKind::Slide)[0]);
        let place = || format!("slope {angle}, e = {e}");
        ends.see(slide.time - first.time, t, 1e-13 * t, place);
        places.see((slide.position - first.position).dot(&slope.down), distance, 1e-13 * distance, place);
        speeds.see(slide.velocity.norm(), speed, 1e-13 * speed, place);
        // From there on it slides down as a parabola along the slope: nothing holds it.
        let (a, rest) = (g * angle.to_radians().sin(), 1.0);
        let expected = distance + speed * rest + 0.5 * a * rest * rest;
        let there = (run.at(slide.time + rest) - first.position).dot(&slope.down);
        places.see(there, expected, 1e-13 * expected, place);
    }
    Worst::settle_all([ends, places, speeds]);
}

#[test]
fn r20_sliding_straight_down_and_up_a_slope() {
    let table = Table::read("slope_slide_1d");
    let (mut times, mut places) = (Worst::of("time to the stop"), Worst::of("distance to the stop"));
    let mut returns = Worst::of("return to the start");
    for row in table.rows() {
        let [g, angle, mu, v0] = row.numbers(["g", "slope_deg", "mu", "v0"]);
        let [t, distance, speed_back] = row.numbers(["t_stop_or_turn", "distance", "return_speed_at_start_0_if_stuck"]);
        let slope = Slope::of_degrees(angle);
        let heading = if row.text("dir") == "up" { -slope.down } else { slope.down };
        let run = Stage::new(4.0 * t + 4.0)
            .down(g)
            .plane("slope", rough(0.5, coulomb(mu)), [0.0; 3], slope.normal)
            .ball([0.0; 3], heading * v0, 0.0)
            .run();
        let place = || format!("slope {angle}, mu = {mu}, {}", row.text("dir"));
        // What is left of a braking ends at a difference: its conditioning is in the deceleration.
        let bound = 1e-11;
        if speed_back == 0.0 {
            let rest = run.events(EventKind::Rest);
            assert_eq!(rest.len(), 1, "{}: {:?}", place(), run.kinds());
            times.see(rest[0].time, t, bound * t, place);
            places.see(rest[0].position.coords.dot(&heading), distance, bound * distance, place);
            assert_eq!(run.outcome.state.position, rest[0].position, "{}", place());
        } else {
            assert_eq!(run.outcome.motion, Motion::Sliding, "{}", place());
            places.see(run.at(t).coords.dot(&heading), distance, bound * distance, place);
            let back = t + 2.0 * distance / speed_back;
            returns.see(run.at(back).coords.dot(&heading), 0.0, bound * distance, place);
            returns.see(run.velocity_at(back).norm(), speed_back, bound * speed_back, place);
        }
    }
    Worst::settle_all([times, places, returns]);
}

#[test]
fn r20_sliding_across_a_slope_turns_downhill() {
    let table = Table::read("slope_slide_2d");
    let (mut places, mut speeds) = (Worst::of("place"), Worst::of("velocity"));
    let mut stops = Worst::of("time to the stop");
    for group in table.groups(6) {
        let [g, angle, mu, v0, from_downhill] =
            group[0].numbers(["g", "slope_deg", "mu", "v0", "psi0_deg_from_downhill"]);
        let slope = Slope::of_degrees(angle);
        let (sin, cos) = from_downhill.to_radians().sin_cos();
        let v = (slope.down * cos + slope.across * sin) * v0;
        let last = group[group.len() - 1].number("t");
        let run = Stage::new(10.0 * last)
            .down(g)
            .plane("slope", rough(0.5, coulomb(mu)), [0.0; 3], slope.normal)
            .ball([0.0; 3], v, 0.0)
            .rest_length(LEAST_HOP)
            .run();
        let place = |t: f64| format!("slope {angle}, mu = {mu}, psi0 = {from_downhill}, t = {t}");
        for row in &group {
            let [t, down, across, v_down, v_across] = row.numbers(["t", "s_down", "q_across", "v_down", "v_across"]);
            let (x, v) = (run.at(t).coords, run.velocity_at(t));
            let scale = down.hypot(across);
            places.see(x.dot(&slope.down), down, 1e-11 * scale, || place(t));
            places.see(x.dot(&slope.across), across, 1e-11 * scale, || place(t));
            speeds.see(v.dot(&slope.down), v_down, 1e-11 * v0, || place(t));
            speeds.see(v.dot(&slope.across), v_across, 1e-11 * v0, || place(t));
        }
        match group[0].text("t_stop") {
            "never" | "none" | "inf" => assert_eq!(run.events(EventKind::Rest), []),
            t_stop => {
                let right = carom_tests::data::number(t_stop);
                let rest = run.events(EventKind::Rest);
                assert_eq!(rest.len(), 1, "{}: {:?}", place(right), run.kinds());
                stops.see(rest[0].time, right, 1e-11 * right, || place(right));
            }
        }
    }
    Worst::settle_all([places, speeds, stops]);
}

#[test]
fn h27_where_friction_is_the_slope_itself_what_slides_across_it_ends_up_straight_down() {
    // mu = tan(theta) to the bit, on the slope of 3, 4 and 5: speed and speed downhill are v0 (1 + cos psi0) together, for ever, so that in the end
    // each is half of that.
    let (normal, down, across) = (Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.8, 0.0, -0.6), Vector3::y());
    for degrees in [30.0f64, 90.0, 120.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let stage = Stage::new(200.0).down(10.0).plane("slope", rough(0.5, coulomb(0.75)), [0.0; 3], normal);
        let run = stage.ball([0.0; 3], (down * cos + across * sin) * 2.0, 0.0).rest_length(LEAST_HOP).run();
        let sum = 2.0 * (1.0 + cos);
        for k in 0..=100 {
            let v = run.velocity_at(2.0 * f64::from(k));
            assert!((v.norm() + v.dot(&down) - sum).abs() <= 1e-9 * sum, "{degrees} degrees: {v} after {} s", 2 * k);
        }
        let end = run.outcome.state.velocity;
        assert!((end - down * (0.5 * sum)).norm() <= 1e-9 * sum, "{degrees} degrees: {end}");
    }
}
