//! The orders of the methods, the chapter's Euler to the last digit, and what it does to the energy.

use carom_dynamics::effects::drag::Drag;
use carom_dynamics::energy::{kinetic, potential};
use carom_dynamics::scene::Method;
use carom_tests::oracle::{Table, U, Worst};
use carom_tests::stage::{Stage, smooth};
use nalgebra::Vector3;

const G: f64 = 9.81;

#[test]
fn r07_r08_r11_the_first_hit_of_the_chapters_euler() {
    let table = Table::read("euler_first_hit");
    let (mut times, mut speeds) = (Worst::of("Euler's time of impact"), Worst::of("Euler's speed at impact"));
    let (mut fractions, mut gains) = (Worst::of("f"), Worst::of("Euler's gain of energy"));
    let mut late = Worst::of("Euler's lateness");
    for row in table.rows() {
        let [y0, v0, h, step, f] = row.numbers(["y0", "v0", "h", "step_index_n", "f"]);
        let [t, v, gain, t_exact] = row.numbers(["t_hit_euler", "v_hit_euler", "rel_energy_gain", "t_hit_exact"]);
        let stage = Stage::new(2.0 * t).down(G).floor(smooth(1.0)).ball([0.0, 0.0, y0], [0.0, 0.0, v0], 0.0);
        let run = stage.method(Method::Euler { step: h }).run();
        let impact = run.impacts()[0];
        let cut = run.trajectory.segments[step as usize];
        let place = || format!("y0 = {y0}, h = {h}");
        // Every step rounds the height once more; the fall speed turns that into time.
        let rounding = 4.0 * U * (step + 1.0);
        let in_time = rounding * (y0 / v.abs() + t);
        times.see(impact.time, t, in_time, place);
        speeds.see(impact.velocity_in.z, v, rounding * (v.abs() + v0), place);
        fractions.see(cut.to, f, in_time / h, place);
        assert_eq!(cut.end, impact.time);
        let energy = 0.5 * v0 * v0 + G * y0;
        gains.see(kinetic(&cut.step.at(cut.to)) / energy - 1.0, gain, 4.0 * rounding, place);
        late.see(impact.time - t_exact, row.number("t_error"), in_time, place);
        // About half a step late, as the chapter's method must be.
        assert!((0.4..0.8).contains(&((impact.time - t_exact) / h)), "{}", place());
    }
    Worst::settle_all([times, speeds, fractions, gains, late]);
}

#[test]
fn r07_r26_eulers_errors_of_height_and_energy_are_known() {
    let (mut heights, mut gains) = (Worst::of("height above the parabola"), Worst::of("gain of energy"));
    let (h, v0) = (0.01, 3.0);
    for (method, sign) in [(Method::Euler { step: h }, 1.0), (Method::SemiImplicitEuler { step: h }, -1.0)] {
        let stage = Stage::new(2.0).down(G).ball([0.0, 0.0, 10.0], [1.0, 0.0, v0], 0.0);
        let run = stage.0.clone();
        let gravity = run.gravity;
        let run = stage.method(method).run();
        assert_eq!(run.trajectory.segments.len(), 200);
        for (n, segment) in run.trajectory.segments.iter().enumerate() {
            let t = n as f64 * h;
            let (before, after) = (segment.step.at(0.0), segment.step.at(segment.to));
            // Explicit: g t h / 2 too high; semi-implicit: as much too low.
            let exact = 10.0 + v0 * t - 0.5 * G * t * t;
            heights.see(before.position.z - exact, sign * 0.5 * G * t * h, 100.0 * U * 10.0, || format!("n = {n}"));
            // And g^2 h^2 / 2 per mass and step more (or less) energy.
            let gain = kinetic(&after) + potential(&after, gravity) - kinetic(&before) - potential(&before, gravity);
            gains.see(gain, sign * 0.5 * (G * h).powi(2), 400.0 * U * 100.0, || format!("n = {n}"));
        }
    }
    Worst::settle_all([heights, gains]);
}

/// Errors at the first impact of a fall in linear drag and wind, and at a later time: time, speed, place; place.
fn errors(method: Method) -> [f64; 4] {
    let (k, wind, y0, v) = (0.5, 4.0, 2.54, Vector3::new(-3.0, 0.0, 0.0));
    let table = Table::read("linear_drag_impact");
    let row = table.rows().find(|row| row.numbers(["y0", "vy0", "k_per_s"]) == [y0, 0.0, k]).unwrap();
    let [t, vz] = row.numbers(["t_impact", "vy_impact"]);
    let drag = Drag::linear(k).unwrap().in_wind(Vector3::new(wind, 0.0, 0.0)).unwrap();
    let stage = Stage::new(1.0).down(G).drag(drag).floor(smooth(0.75)).method(method);
    let run = stage.thing([0.0, 0.0, y0], v, 0.0, Some(1.0)).run();
    let impact = run.impacts()[0];
    // Across, v - w dies away as e^(-k t).
    let x_at = |t: f64| wind * t + (v.x - wind) * -(-k * t).exp_m1() / k;
    // After the impact, with u = 1 - e^(-k s) : z = (v + g/k) u / k - g s / k.
    let s = 1.0 - t;
    let z_end = (0.75 * -vz + G / k) * -(-k * s).exp_m1() / k - G * s / k;
    let end = run.outcome.state.position;
    let away = ((end.x - x_at(1.0)).powi(2) + (end.z - z_end).powi(2)).sqrt();
    [(impact.time - t).abs(), (impact.velocity_in.z - vz).abs(), (impact.position.x - x_at(t)).abs(), away]
}

#[test]
fn r26_the_order_of_each_method_with_an_impact_on_the_way() {
    type Stepping = fn(f64) -> Method;
    let methods: [(&str, f64, f64, Stepping); 3] = [
        ("euler", 1.0, 1.0 / 32.0, |step| Method::Euler { step }),
        ("semi-implicit-euler", 1.0, 1.0 / 32.0, |step| Method::SemiImplicitEuler { step }),
        ("rk4", 4.0, 1.0 / 4.0, |step| Method::Rk4 { step }),
    ];
    for (name, order, step, method) in methods {
        // The slope over five octaves; single steps scatter with where in a step the impact falls.
        let (coarse, fine) = (errors(method(step)), errors(method(step / 32.0)));
        for (what, (coarse, fine)) in ["time", "speed", "place", "end"].iter().zip(coarse.iter().zip(fine)) {
            let slope = (coarse / fine).log2() / 5.0;
            println!("{name}: {what} of order {slope:.2}, from {coarse:.1e} to {fine:.1e}");
            assert!((slope - order).abs() < 0.15 * order, "{name}: {what} is of order {slope}");
        }
    }
}

#[test]
fn r26_the_adaptive_pair_follows_its_tolerance() {
    let mut last = f64::INFINITY;
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
        let worst = errors(Method::Adaptive { tolerance }).into_iter().fold(0.0, f64::max);
        println!("adaptive at {tolerance:e}: {worst:.1e}");
        assert!(worst <= 16.0 * tolerance + 64.0 * U, "{tolerance:e}: {worst:e}");
        // Below the tolerance it is a matter of where in a step the impact falls.
        assert!(worst <= last.max(tolerance), "{tolerance:e}: {worst:e} after {last:e}");
        last = worst;
    }
}

#[test]
fn r26_in_vacuum_all_but_eulers_methods_are_exact_to_rounding() {
    let mut worst = Worst::of("fall in vacuum");
    let right = (2.0 * 2.0 / G).sqrt();
    for method in [Method::Exact, Method::Rk4 { step: 0.0625 }, Method::Adaptive { tolerance: 1e-6 }] {
        let stage = Stage::new(1.0).down(G).floor(smooth(1.0)).ball([0.0, 0.0, 2.0], [1.0, 0.0, 0.0], 0.0);
        let impact = stage.method(method).run().impacts()[0];
        worst.see(impact.time, right, 16.0 * U * right, || format!("{method:?}"));
        worst.see(impact.velocity_in.z, -G * right, 16.0 * U * G * right, || format!("{method:?}"));
    }
    worst.settle();
}

#[test]
fn r10_steps_end_at_n_h_also_after_impacts() {
    // A nominal 3 s at h = 0.1 with many hits: the published loop, which does not reset its timestep, makes 3.27 s of it
    for method in [Method::Euler { step: 0.1 }, Method::SemiImplicitEuler { step: 0.1 }, Method::Rk4 { step: 0.1 }] {
        let stage = Stage::new(3.0).down(G).room(smooth(1.0), [99.0, 99.0, 2.0]);
        let stage = stage.ball([9.0, 9.0, 1.0], [1.0, 0.0, -7.0], 0.0);
        let run = stage.method(method).run();
        let impacts = run.impacts().len();
        assert!(impacts >= 8, "{impacts} impacts");
        assert_eq!(run.outcome.time, 3.0, "{method:?}");
        let ends: Vec<f64> = run.trajectory.segments.iter().map(|s| s.time).chain([3.0]).collect();
        for n in 0..=30 {
            // 30 times 0.1 is an ulp more than 3, and the run ends at 3.
            let t = (f64::from(n) * 0.1).min(3.0);
            assert!(ends.contains(&t), "no step ends at {t}, {method:?}");
        }
        // 30 steps, and one piece more for each impact.
        assert_eq!(run.trajectory.segments.len(), 30 + impacts, "{method:?}");
    }
}
