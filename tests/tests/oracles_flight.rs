//! Flights with the Magnus force, decaying spin, buoyancy and a sphere's own drag, against references and closed forms.

use carom_dynamics::effects::drag::{Drag, sphere_coefficient};
use carom_dynamics::effects::magnus::Magnus;
use carom_dynamics::effects::restitution::Restitution;
use carom_dynamics::scene::Method;
use carom_dynamics::surface::Material;
use carom_tests::oracle::{Table, U, Worst};
use carom_tests::stage::{Stage, smooth};
use nalgebra::Vector3;

const TOLERANCES: [f64; 9] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];

/// Errors of whole flights in units of the tolerance of a step.
const OF_TOLERANCE: f64 = 8.0;

/// What rounding leaves at the finest tolerances, in u.
const ROUNDING: f64 = 64.0 * U;

#[test]
fn flights_with_drag_spin_and_wind() {
    let table = Table::read("flight_reference");
    let (mut places, mut velocities) = (Worst::of("place"), Worst::of("velocity"));
    for row in table.rows() {
        let [m, d, c, k, rho, g, t] = row.numbers(["m", "diameter", "Cd", "CL_over_S", "rho", "g", "t"]);
        let wind = row.numbers(["wind_x", "wind_y", "wind_z"]).into();
        let v0 = Vector3::from(row.numbers(["vx0", "vy0", "vz0"]));
        let stage = Stage::new(t)
            .gravity([0.0, -g, 0.0])
            .drag(Drag::quadratic(c, rho).unwrap().in_wind(wind).unwrap())
            .magnus(Magnus::new(k, rho).unwrap().in_wind(wind).unwrap())
            .thing(row.numbers(["x0", "y0", "z0"]), v0, 0.5 * d, Some(m))
            .spinning(row.numbers(["wx", "wy", "wz"]));
        let (x, v) = (Vector3::from(row.numbers(["x", "y", "z"])), Vector3::from(row.numbers(["vx", "vy", "vz"])));
        let reach = v0.norm() * t;
        let rk4 = (Method::Rk4 { step: t / 4096.0 }, 1e-11);
        let pairs = TOLERANCES.map(|tolerance| (Method::Adaptive { tolerance }, OF_TOLERANCE * tolerance + ROUNDING));
        for (method, bound) in pairs.into_iter().chain([rk4]) {
            let state = stage.clone().method(method).run().outcome.state;
            let place = || format!("{}, wind {wind:?}, t = {t}, {method:?}", row.text("name"));
            places.see((state.position.coords - x).norm(), 0.0, bound * reach, place);
            velocities.see((state.velocity - v).norm(), 0.0, bound * v0.norm().max(v.norm()), place);
        }
    }
    Worst::settle_all([places, velocities]);
}

/// Without other forces the Magnus force turns the velocity at the rate c omega(t), and omega = omega0 e^(-t / tau).
#[test]
fn decaying_spin_turns_a_flight_less_and_less() {
    let (rho, k, r, m, tau, spin, v0, t) = (1.25, 0.8, 0.1, 0.05, 0.4, 60.0, 12.0, 1.0);
    let c = 0.5 * rho * k * std::f64::consts::PI * r * r * r / m;
    let angle = c * spin * tau * (1.0 - (-t / tau).exp());
    let right = Vector3::new(v0 * angle.cos(), v0 * angle.sin(), 0.0);
    assert!(angle > 0.5, "{angle}");
    let stage = Stage::new(t).magnus(Magnus::new(k, rho).unwrap()).spin_decay(tau);
    let stage = stage.thing([0.0; 3], [v0, 0.0, 0.0], r, Some(m)).spinning([0.0, 0.0, spin]);
    let mut worst = Worst::of("velocity after turning");
    let rk4 = (Method::Rk4 { step: t / 1024.0 }, 1e-11);
    let pairs = TOLERANCES.map(|tolerance| (Method::Adaptive { tolerance }, OF_TOLERANCE * tolerance + ROUNDING));
    for (method, bound) in pairs.into_iter().chain([rk4]) {
        let run = stage.clone().method(method).run();
        worst.see((run.outcome.state.velocity - right).norm(), 0.0, bound * v0, || format!("{method:?}"));
        assert!(run.outcome.counters.magnus > 0 && run.outcome.counters.drag == 0);
    }
    worst.settle();
}

/// (m + rho V / 2) a = (m - rho V) g, and the flight stays an exact parabola.
#[test]
fn a_ball_in_water_falls_as_its_weight_and_the_water_it_takes_along_say() {
    let (r, g) = (0.05f64, 9.81f64);
    let mut worst = Worst::of("time of a fall, or rise, through water");
    for density in [7850.0f64, 2000.0, 1001.0, 500.0, 1e-6] {
        let volume = 4.0 / 3.0 * std::f64::consts::PI * r * r * r;
        let a = g * (density - 1000.0) / (density + 500.0);
        let h = 1.5;
        let t = (2.0 * h / a.abs()).sqrt();
        let wall = if a > 0.0 { [0.0, 0.0, -h - r] } else { [0.0, 0.0, h + r] };
        let stage = Stage::new(2.0 * t).down(g).buoyancy(1000.0).plane("wall", smooth(0.5), wall, [0.0, 0.0, 1.0]);
        let run = stage.thing([0.0; 3], [0.0; 3], r, Some(density * volume)).run();
        // Near the density of water the difference of the two keeps fewer digits.
        let lost = (density + 1000.0) / (density - 1000.0).abs();
        worst.see(run.impacts()[0].time, t, 16.0 * U * lost * t, || format!("density {density}"));
        assert!(run.trajectory.segments.iter().all(|s| s.step.exact), "an exact flight");
        assert_eq!(run.outcome.counters.drag + run.outcome.counters.magnus, 0);
    }
    worst.settle();
}

#[test]
fn a_smooth_sphere_ends_at_the_speed_at_which_its_drag_carries_it() {
    let (rho, mu, g) = (1.204, 1.825e-5, 9.81);
    let mut worst = Worst::of("terminal speed");
    // A grain of sand, a hailstone, a table tennis ball.
    for (r, m, seconds) in [(1e-4, 1.1e-8, 4.0), (5e-3, 4.8e-4, 30.0), (0.02, 0.0027, 12.0)] {
        let stage = Stage::new(seconds).down(g).drag(Drag::sphere(rho, mu).unwrap());
        let v = stage.thing([0.0; 3], [0.0; 3], r, Some(m)).run().outcome.state.velocity.norm();
        let force = 0.5 * rho * sphere_coefficient(rho * v * 2.0 * r / mu) * std::f64::consts::PI * r * r * v * v;
        worst.see(force, m * g, 1e-6 * m * g, || format!("r = {r}, {v} m/s"));
    }
    worst.settle();
}

#[test]
fn restitution_that_falls_with_the_speed_gives_each_impact_its_own() {
    let (c_r, begins, g) = (0.9, 1.5, 9.81);
    let material = Material { restitution: Restitution::falling(c_r, begins).unwrap(), ..smooth(c_r) };
    let run = Stage::new(20.0).down(g).floor(material).thing([0.0, 0.0, 20.1], [0.0; 3], 0.1, None).run();
    let mut worst = Worst::of("speed after an impact");
    let mut closing = (2.0 * g * 20.0f64).sqrt();
    let impacts = run.impacts();
    let fast = impacts.iter().filter(|e| -e.velocity_in.z > begins).count();
    assert!(fast > 5 && impacts.len() > fast + 10, "{fast} of {}", impacts.len());
    for (n, impact) in (1..).zip(impacts) {
        let right = closing * c_r * (begins / closing).powf(0.25).min(1.0);
        worst.see(impact.velocity.z, right, 8.0 * f64::from(n) * U * right, || format!("impact {n}"));
        closing = right;
    }
    worst.settle();
}

/// v = w + g / k + (v0 - w - g / k) e^(-k t), with k from nothing to 10^12 per second: the explicit methods would need a step for each of these.
#[test]
fn h30_linear_drag_of_any_strength_is_its_closed_form_in_few_steps() {
    let (mut speeds, mut places, mut steps) = (Worst::of("velocity"), Worst::of("place"), 0);
    let (g, t) = (9.81, 1.5);
    let (v0, wind) = (Vector3::new(3.0, 0.0, 4.0), Vector3::new(0.0, 2.0, 0.0));
    for exponent in -12..=12 {
        let k = 10f64.powi(exponent);
        for (down, wind) in [(g, Vector3::zeros()), (0.0, Vector3::zeros()), (g, wind)] {
            let drag = Drag::linear(k).unwrap().in_wind(wind).unwrap();
            let run = Stage::new(t).down(down).drag(drag).thing([0.0; 3], v0, 0.1, Some(1.0)).run();
            // By series where e^-z - 1 has no digits.
            let z = k * t;
            let one = if z < 1e-3 { 1.0 - z / 2.0 + z * z / 6.0 } else { -(-z).exp_m1() / z };
            let two = if z < 1e-3 { 0.5 - z / 6.0 + z * z / 24.0 } else { (1.0 - one) / z };
            let a = Vector3::new(0.0, 0.0, -down) - (v0 - wind) * k;
            let (v, x) = (v0 + a * (t * one), v0 * t + a * (t * t * two));
            let state = run.outcome.state;
            let place = || format!("k = {k:e}, g = {down}, wind {wind:?}");
            // The closed form for reference loses what v0 and its decay have in common.
            let size = v0.norm() + down * t;
            speeds.see((state.velocity - v).norm(), 0.0, 1e-8 * size, place);
            places.see((state.position.coords - x).norm(), 0.0, 1e-8 * size * t, place);
            let mut speed = (v0 - wind).norm() + down * t;
            for segment in &run.trajectory.segments {
                let now = (segment.step.end().velocity - wind).norm();
                assert!(now <= speed + 1e-12, "{}: {now} after {speed}", place());
                speed = if down == 0.0 { now } else { speed };
            }
            steps = steps.max(run.outcome.counters.paths);
        }
    }
    println!("at most {steps} steps");
    // Without gravity and wind it is slowed down to nothing, 5e-324 m/s: 745 times by 1/e, in steps of 0.04 k / m.
    assert!(steps < 20_000, "{steps}");
    Worst::settle_all([speeds, places]);
}

#[test]
fn h30_a_ball_sinks_to_the_floor_through_the_stiffest_air_and_gains_no_energy() {
    for k in [1e3, 1e6, 1e9, 1e12] {
        // It sinks with g / k, 1 mm deep in 100 s for 10^6.
        let (g, seconds) = (9.81, 100.0);
        let depth = 0.5 * seconds * g / k;
        let stage = Stage::new(seconds).down(g).drag(Drag::linear(k).unwrap()).floor(smooth(0.8));
        let run = stage.thing([0.0, 0.0, 0.1 + depth], [1.0, 0.0, 0.0], 0.1, Some(1.0)).run();
        let mut energy = f64::INFINITY;
        for segment in &run.trajectory.segments {
            for f in [0.0, 0.5, 1.0] {
                let state = segment.step.at(f * segment.to);
                let now = 0.5 * state.velocity.norm_squared() + g * (state.position.z - 0.1);
                assert!(now <= energy + 1e-9 * (now.abs() + g * depth) + 1e-15, "k = {k:e}: {now} after {energy}");
                assert!(state.position.z >= 0.1 - 1e-14, "k = {k:e}: {}", state.position.z);
                energy = now;
            }
        }
        let landed = run.trajectory.events.first().map(|event| event.time);
        assert!(landed.is_some_and(|t| (t - 50.0).abs() < 1.0), "k = {k:e}: {landed:?}");
        assert!(run.outcome.counters.paths < 20_000, "{}", run.outcome.counters.paths);
    }
}
