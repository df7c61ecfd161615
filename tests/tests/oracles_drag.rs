//! Flights with drag that end in impacts, against closed forms, by the adaptive pair at all its tolerances and by Runge-Kutta.

use carom_dynamics::effects::drag::Drag;
use carom_dynamics::scene::Method;
use carom_tests::oracle::{Table, U, Worst};
use carom_tests::stage::{Stage, smooth};
use nalgebra::Point3;

const TOLERANCES: [f64; 9] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];

/// Errors of whole runs in units of the tolerance of a step: a run is tens of steps, and an impact keeps what went before.
const OF_TOLERANCE: f64 = 8.0;

/// What rounding leaves at the finest tolerances, in u.
const ROUNDING: f64 = 64.0 * U;

fn adaptive(tolerance: f64) -> Method {
    Method::Adaptive { tolerance }
}

#[test]
fn r08_impacts_in_linear_drag() {
    let table = Table::read("linear_drag_impact");
    let (mut times, mut speeds) = (Worst::of("time of impact"), Worst::of("speed at impact"));
    for row in table.rows() {
        let [y0, vy0, g, k, wind] = row.numbers(["y0", "vy0", "g", "k_per_s", "wind_y"]);
        let [t, v] = row.numbers(["t_impact", "vy_impact"]);
        let drag = Drag::linear(k).unwrap().in_wind([0.0, 0.0, wind].into()).unwrap();
        let stage = Stage::new(2.0 * t).down(g).drag(drag).floor(smooth(0.5));
        let stage = stage.thing([0.0, 0.0, y0], [0.0, 0.0, vy0], 0.0, Some(1.0));
        for tolerance in TOLERANCES {
            let impact = stage.clone().method(adaptive(tolerance)).run().impacts()[0];
            let place = || format!("k = {k}, y0 = {y0}, tolerance {tolerance:e}");
            let bound = OF_TOLERANCE * tolerance + ROUNDING;
            times.see(impact.time, t, bound * t, place);
            speeds.see(impact.velocity_in.z, v, bound * v.abs(), place);
        }
        // Runge-Kutta with steps of which hundreds fit into the flight and tens into the time of the drag.
        let step = (t / 256.0).min(0.02 / k);
        let impact = stage.method(Method::Rk4 { step }).run().impacts()[0];
        let place = || format!("k = {k}, y0 = {y0}, rk4 with h = {step:e}");
        times.see(impact.time, t, 1e-9 * t, place);
        speeds.see(impact.velocity_in.z, v, 1e-9 * v.abs(), place);
    }
    Worst::settle_all([times, speeds]);
}

#[test]
fn r08_bounces_in_linear_drag_and_wind() {
    let table = Table::read("linear_drag_bounces");
    let (mut times, mut places) = (Worst::of("time of impact"), Worst::of("place of impact"));
    let mut speeds = Worst::of("velocity at impact");
    for group in table.groups(6) {
        let [y0, vx0, g, k, wind, e] = group[0].numbers(["y0", "vx0", "g", "k_per_s", "wind_x", "e"]);
        let last = group[group.len() - 1].number("t_impact");
        let drag = Drag::linear(k).unwrap().in_wind([wind, 0.0, 0.0].into()).unwrap();
        let stage = Stage::new(1.01 * last).down(g).drag(drag).floor(smooth(e)).rest_length(1e-20);
        let stage = stage.thing([0.0, 0.0, y0], [vx0, 0.0, 0.0], 0.0, Some(1.0));
        let methods = TOLERANCES.map(|tolerance| (adaptive(tolerance), OF_TOLERANCE * tolerance + ROUNDING));
        let rk4 = (Method::Rk4 { step: last / 65536.0 }, 1e-10);
        for (method, relative) in methods.into_iter().chain([rk4]) {
            let impacts = stage.clone().method(method).run().impacts();
            for (row, impact) in group.iter().zip(&impacts) {
                let [n, t, x, vy, vx] = row.numbers(["n", "t_impact", "x_impact", "vy_in", "vx_at_impact"]);
                let bound = n * relative;
                let place = || format!("k = {k}, wind {wind}, n = {n}, {method:?}");
                times.see(impact.time, t, bound * t, place);
                places.see(impact.position.x, x, bound * (x.abs() + t * (vx0.abs() + wind.abs())), place);
                // The tolerance is relative to the whole motion, also where little of it is vertical.
                let whole = vy.abs() + vx0.abs() + wind.abs();
                speeds.see(impact.velocity_in.z, vy, bound * whole, place);
                speeds.see(impact.velocity_in.x, vx, bound * whole, place);
            }
            assert!(impacts.len() >= group.len(), "{} of {} impacts, {method:?}", impacts.len(), group.len());
        }
    }
    Worst::settle_all([times, places, speeds]);
}

/// Quadratic drag with which a ball of `radius` and 1 kg has the drag length m / (1/2 rho C A) = `length`.
fn drag_of_length(length: f64, radius: f64) -> Drag {
    let area = std::f64::consts::PI * radius * radius;
    Drag::quadratic(2.0 / (length * area), 1.0).unwrap()
}

#[test]
fn r08_bounces_in_quadratic_drag() {
    let table = Table::read("quad_drag_vertical");
    let (mut times, mut speeds) = (Worst::of("time of impact"), Worst::of("speeds in and out"));
    let mut heights = Worst::of("apex");
    let r = 0.125;
    for group in table.groups(4) {
        let [g, vt, h0, e] = group[0].numbers(["g", "v_terminal", "h0", "e"]);
        let last = group[group.len() - 1].number("t_apex");
        // At the terminal speed drag is g: the drag length is vt^2 / g.
        let air = Stage::new(1.01 * last).down(g).drag(drag_of_length(vt * vt / g, r)).rest_length(1e-20);
        let air = air.thing([0.0, 0.0, h0 + r], [0.0; 3], r, Some(1.0));
        // On an edge and on a tip, a ball from straight above does what it does on a floor.
        let of_triangle = |corners: [[f64; 3]; 3]| {
            air.clone().mesh("triangle", smooth(e), corners.map(Point3::from).to_vec(), vec![[0, 1, 2]])
        };
        let edge = of_triangle([[0.0, -4.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, -4.0]]);
        let tip = of_triangle([[0.0, 0.0, 0.0], [1.0, 0.5, -4.0], [-1.0, 0.5, -4.0]]);
        let grounds = [(air.clone().floor(smooth(e)), "floor"), (edge, "edge"), (tip, "tip")];
        for ((stage, ground), tolerance) in grounds.iter().flat_map(|ground| TOLERANCES.map(|t| (ground, t))) {
            let run = stage.clone().method(adaptive(tolerance)).run();
            let impacts = run.impacts();
            for (row, impact) in group.iter().zip(&impacts) {
                let [n, t, v_in, v_out] = row.numbers(["n", "t_impact", "v_in", "v_out"]);
                let [height, t_apex] = row.numbers(["apex_height", "t_apex"]);
                let bound = n * (OF_TOLERANCE * tolerance + ROUNDING);
                let place = || format!("{ground}, vt = {vt}, h0 = {h0}, n = {n}, tolerance {tolerance:e}");
                times.see(impact.time, t, bound * t, place);
                // Where a step ends within a hop, the centre's height is rounded: r u high, worth r u g / v of speed.
                let centre = 4.0 * U * r * g / v_in;
                speeds.see(-impact.velocity_in.z, v_in, bound * v_in + centre, place);
                speeds.see(impact.velocity.z, v_out, bound * v_out + centre, place);
                heights.see(run.at(t_apex).z - r, height, bound * h0, place);
            }
            assert!(impacts.len() >= group.len(), "{} impacts at {tolerance:e}", impacts.len());
        }
    }
    Worst::settle_all([times, speeds, heights]);
}

#[test]
fn r08_a_flight_in_quadratic_drag_alone() {
    let table = Table::read("quad_drag_no_gravity");
    let (mut places, mut speeds) = (Worst::of("distance"), Worst::of("speed"));
    for row in table.rows() {
        let [v0, length, t, x, v] = row.numbers(["v0", "drag_length_l", "t", "x", "v"]);
        let stage = Stage::new(t).drag(drag_of_length(length, 0.125));
        let stage = stage.thing([0.0; 3], [0.6 * v0, 0.0, 0.8 * v0], 0.125, Some(1.0));
        for tolerance in TOLERANCES {
            let end = stage.clone().method(adaptive(tolerance)).run().outcome.state;
            let bound = OF_TOLERANCE * tolerance + ROUNDING;
            let place = || format!("v0 = {v0}, l = {length}, t = {t}, tolerance {tolerance:e}");
            places.see(end.position.coords.norm(), x, bound * x, place);
            speeds.see(end.velocity.norm(), v, bound * v, place);
        }
    }
    Worst::settle_all([places, speeds]);
}

#[test]
fn r18_balls_rebound_as_their_rules_say() {
    let table = Table::read("ball_specs");
    let (mut drag, mut vacuum) = (Worst::of("rebound with drag"), Worst::of("rebound without"));
    let g = 9.81;
    for row in table.rows() {
        let [drop, mass_lo, mass_hi, thin, thick] = row.numbers(["drop_m", "mass_lo", "mass_hi", "diam_lo", "diam_hi"]);
        let vt = row.number("v_terminal");
        let (r, m) = (0.25 * (thin + thick), 0.5 * (mass_lo + mass_hi));
        // m g = 1/2 rho C A vt^2.
        let air = Drag::quadratic(2.0 * m * g / (std::f64::consts::PI * r * r * vt * vt), 1.0).unwrap();
        let at_top = row.text("rebound_read_at") == "top";
        // Read at the top, a rebound holds a diameter: the lowest that is allowed, the thickest ball's.
        for (reading, diameter, e_vacuum, e_drag) in
            [("rebound_lo", thick, "e_lo_vac", "e_lo_drag"), ("rebound_hi", thin, "e_hi_vac", "e_hi_drag")]
        {
            let rebound = row.number(reading) - if at_top { diameter } else { 0.0 };
            let fall =
                |e: f64| Stage::new(4.0).down(g).floor(smooth(e)).thing([0.0, 0.0, drop + r], [0.0; 3], r, Some(m));
            let place = || format!("{}, {reading}", row.text("ball"));
            for (worst, stage) in [
                (&mut vacuum, fall(row.number(e_vacuum))),
                (&mut drag, fall(row.number(e_drag)).drag(air).method(adaptive(1e-12))),
            ] {
                let run = stage.run();
                let hit = run.impacts()[0].time;
                // The highest point after the first impact, by its segments' paths.
                let after = run.trajectory.segments.iter().filter(|s| s.time >= hit);
                let apex = after.flat_map(|s| (0..=512).map(|i| s.step.path.at(s.to * f64::from(i) / 512.0).z - r));
                // The table holds 12 digits, and samples miss the top of a hop by 1 / 512^2 of it at most.
                worst.see(apex.fold(0.0, f64::max), rebound, 4e-6 * rebound, place);
            }
        }
    }
    Worst::settle_all([drag, vacuum]);
}
