//! H30: air resistance that is stiff.

use super::check::Check;
use crate::catalogue::{Case, Figure};
use crate::stage::{Stage, smooth};
use carom_dynamics::effects::drag::Drag;
use carom_dynamics::events::Ending;
use carom_dynamics::scene::Method;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "H30",
        title: "fixed steps, linear drag with k h / m up to 1e300",
        elsewhere: "explicit Euler with k h / m > 2 explodes and gains energy",
        bound: "the speed falls at every step, or the run is ended as unstable before it gains any",
        run: fixed_steps,
    },
    Case {
        id: "H30",
        title: "the adaptive pair, linear drag with k / m up to 1e5 1/s",
        elsewhere: "the error estimate lets steps through at the limit of stability",
        bound: "the speed never grows; v and x of the closed form to the tolerance",
        run: adaptive,
    },
    Case {
        id: "H30",
        title: "bounces in stiff air: events on curved paths",
        elsewhere: "sampling for a sign change misses low hops",
        bound: "never below the floor, energy never up, rest within the time",
        run: bounces,
    },
];

/// A linear drag of `k` kg/s; panics if it is refused.
fn linear(k: f64) -> Drag {
    Drag::linear(k).unwrap_or_else(|e| panic!("{e}"))
}

fn fixed_steps() -> Figure {
    let mut check = Check::new();
    let (mut stable, mut refused) = (0, 0);
    let h = 1.0 / 64.0;
    let methods = [
        (Method::Euler { step: h }, 2.0),
        (Method::SemiImplicitEuler { step: h }, 2.0),
        // The real interval of stability of all Runge-Kutta methods with four stages and order four.
        (Method::Rk4 { step: h }, 2.785),
    ];
    for (method, limit) in methods {
        for z in [1e-12, 0.1, 1.0, 1.99, 2.5, 2.78, 2.79, 4.0, 1e3, 1e6, 1e12, 1e300] {
            let run = Stage::new(1.0).drag(linear(z / h)).thing([0.0; 3], [3.0, -4.0, 0.0], 0.1, Some(1.0));
            let run = run.method(method).run();
            let place = || format!("{method:?}, k h / m = {z}");
            let mut speed = 5.0;
            for segment in &run.trajectory.segments {
                let end = segment.step.end().velocity.norm();
                check.that(end <= speed, || format!("{}: {end} m/s after {speed} m/s", place()));
                speed = end;
            }
            let expected = if z <= limit { Ending::Completed } else { Ending::UnstableStep };
            check.that(run.outcome.ending == expected, || format!("{}: {:?}", place(), run.outcome.ending));
            match run.outcome.ending {
                Ending::Completed => stable += 1,
                _ => refused += 1,
            }
        }
    }
    check.figure(format!("{stable} runs slow down, {refused} are ended as unstable at 5 m/s"))
}

fn adaptive() -> Figure {
    let mut check = Check::new();
    let (mut worst, mut steps) = (0.0, 0);
    let (g, v0, duration) = (9.81, 3.0, 0.5);
    for rate in [1.0, 1e2, 1e4, 1e5] {
        for tolerance in [1e-4, 1e-6, 1e-9] {
            let run = Stage::new(duration)
                .down(g)
                .drag(linear(rate))
                .thing([0.0, 0.0, 5.0], [v0, 0.0, 0.0], 0.1, Some(1.0))
                .method(Method::Adaptive { tolerance })
                .run();
            let place = || format!("k / m = {rate}, tolerance {tolerance:e}");
            check.that(run.outcome.ending == Ending::Completed, || format!("{}: {:?}", place(), run.outcome.ending));
            let mut speed = v0;
            for segment in &run.trajectory.segments {
                let v = segment.step.end().velocity.x.abs();
                // At the limit of stability what is left may turn, but below what the tolerance sees.
                check.that(v <= speed.max(tolerance * v0), || format!("{}: {v:e} after {speed:e}", place()));
                speed = v;
            }
            // v = v0 e^-rt; x = v0 (1 - e^-rt) / r; the fall towards g / r alike.
            let kept = (-rate * duration).exp();
            let state = run.outcome.state;
            let errors = [
                (state.velocity.x - v0 * kept) / v0,
                (state.position.x - v0 * (1.0 - kept) / rate) * rate / v0,
                (state.velocity.z + g / rate * (1.0 - kept)) / v0,
            ];
            for error in errors {
                let share = error.abs() / tolerance;
                worst = check.within(worst, share, 1.0, || format!("{}: in tolerances", place()));
            }
            steps = steps.max(run.outcome.counters.paths);
        }
    }
    check.figure(format!("off by {worst:.2} tolerances at most, with up to {steps} steps (about k t / 3 m)"))
}

fn bounces() -> Figure {
    let mut check = Check::new();
    let (mut most, mut lowest) = (0, 0.0f64);
    for rate in [0.1, 10.0, 1e3, 1e4] {
        for e in [0.5, 1.0] {
            let (g, r, h) = (9.81, 0.1, 0.02);
            let run = Stage::new(4.0)
                .down(g)
                .drag(linear(rate))
                .floor(smooth(e))
                .thing([0.0, 0.0, r + h], [1.0, 0.0, -20.0], r, Some(1.0))
                .method(Method::Adaptive { tolerance: 1e-9 })
                .run();
            let place = || format!("k / m = {rate}, e = {e}");
            check.that(run.outcome.ending == Ending::Completed, || format!("{}: {:?}", place(), run.outcome.ending));
            let mut energy = f64::INFINITY;
            for segment in &run.trajectory.segments {
                for f in [0.0, 0.25, 0.5, 0.75, 1.0] {
                    let state = segment.step.at(f * segment.to);
                    lowest = lowest.min(state.position.z - r);
                    let now = 0.5 * state.velocity.norm_squared() + g * state.position.z;
                    // Of the adaptive pair's own error, which is of the speed.
                    check.that(now <= energy + 1e-8 * (now + 1.0), || {
                        format!("{}: energy {now} after {energy} at {} s", place(), segment.time)
                    });
                    energy = now;
                }
            }
            most = most.max(run.impacts().len());
        }
    }
    check.that(lowest >= -1e-14, || format!("{lowest:e} m below the floor"));
    check.figure(format!("at most {most} impacts, {:.1e} m below the floor", -lowest))
}
