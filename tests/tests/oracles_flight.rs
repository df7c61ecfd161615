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
