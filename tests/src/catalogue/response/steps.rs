//! H24 and H25: time that does not advance, and timesteps of any length.

use super::check::Check;
use crate::catalogue::{Case, Figure};
use crate::stage::{Run, Stage, coulomb, rough, smooth};
use carom_dynamics::events::{Ending, EventKind, Motion};
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Method;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "H24",
        title: "bouncing until nothing is left, with a rest length of 5e-324 m",
        elsewhere: "`v *= e` never reaches 0 for e > 0.5: loops until v == 0 do not end; t + dt == t long before",
        bound: "ends at rest, at the time of the closed form to 1e-13",
        run: no_rest_length,
    },
    Case {
        id: "H24",
        title: "a corridor wider than the ball by 1 to 1e6 ulp, crossed at 1 to 1e6 m/s",
        elsewhere: "subnormal speeds and gaps loop for ever (parry #123), NaN does too (Jolt #1383)",
        bound: "every run ends, by a name, with at most 4 paths an event",
        run: tight_corridor,
    },
    Case {
        id: "H25",
        title: "the event list of a run that goes on for longer",
        elsewhere: "a cut at each frame: re-anchoring every 1/60 s costs 6 digits of energy",
        bound: "the same bits as far as both go",
        run: longer_runs,
    },
    Case {
        id: "H25",
        title: "timesteps of 5e-324 s and of 1e300 s",
        elsewhere: "t += dt never ends, or overflows",
        bound: "refused by name, or done in a step per event",
        run: extreme_steps,
    },
];

fn no_rest_length() -> Figure {
    let mut check = Check::new();
    let (mut worst, mut most) = (0.0, 0);
    for e in [0.1, 0.5, 0.6, 0.75, 0.9, 0.99, 0.999] {
        let (g, h) = (9.81, 2.0);
        let end = f64::sqrt(2.0 * h / g) * (1.0 + e) / (1.0 - e);
        let run = Stage::new(2.0 * end + 1.0)
            .down(g)
            .floor(smooth(e))
            .ball([0.0, 0.0, h], [0.0; 3], 0.0)
            .rest_length(5e-324)
            .run();
        let rest = run.events(EventKind::Rest);
        check.that(run.outcome.ending == Ending::Completed, || format!("e = {e}: {:?}", run.outcome.ending));
        check.that(rest.len() == 1, || format!("e = {e}: does not rest, {:?}", run.outcome));
        let Some(rest) = rest.first() else { continue };
        // (1 + e) / (1 - e) makes of one rounding of e many.
        worst = check.within(worst, (rest.time / end - 1.0).abs(), 1e-13, || format!("e = {e}: rest time"));
        check.that(run.outcome.state.position.z == 0.0, || format!("e = {e}: {:?}", run.outcome.state));
        most = most.max(run.impacts().len());
    }
    check.figure(format!("at most {most} impacts, rest time off by {worst:.1e}"))
}

fn tight_corridor() -> Figure {
    let mut check = Check::new();
    let (mut runs, mut most) = (0, 0);
    for ulps in [1.0, 16.0, 256.0, 4096.0, 1e6] {
        for speed in [1.0, 1e3, 1e6] {
            for e in [0.0, 0.5, 0.9, 1.0] {
                let r = 0.25;
                let gap = ulps * f64::EPSILON * r;
                // At e = 1 it crosses for ever: a few thousand times are enough.
                let duration = if e == 1.0 { 4096.0 * gap / speed } else { 1.0 };
                let run = Stage::new(duration)
                    .plane("left", smooth(e), [0.0; 3], [1.0, 0.0, 0.0])
                    .plane("right", smooth(e), [2.0 * r + gap, 0.0, 0.0], [-1.0, 0.0, 0.0])
                    .ball([r, 0.0, 0.0], [speed, 1.0, 0.0], r)
                    .run();
                let place = || format!("{ulps} ulp, {speed} m/s, e = {e}");
                check.that(run.outcome.ending == Ending::Completed, || format!("{}: {:?}", place(), run.outcome));
                let (events, paths) = (run.trajectory.events.len() as u64, run.outcome.counters.paths);
                check.that(paths <= 4 * events + 4, || format!("{}: {paths} paths, {events} events", place()));
                let x = run.outcome.state.position.x;
                // Not through: the position is that of the walls to its rounding.
                check.within(0.0, (r - x).max(x - r - gap), 4.0 * f64::EPSILON * r, || format!("{}: x", place()));
                let v = run.outcome.state.velocity.x.abs();
                check.that(v <= speed, || format!("{}: {v} m/s", place()));
                most = most.max(events);
                runs += 1;
            }
        }
    }
    check.figure(format!("{runs} runs end, after at most {most} events"))
}

fn longer_runs() -> Figure {
    let mut check = Check::new();
    let mut events = 0;
    let bits = |run: &Run| -> Vec<[u64; 7]> {
        let of = |e: &carom_dynamics::events::Event| {
            let (x, v) = (e.position, e.velocity);
            [e.time, x.x, x.y, x.z, v.x, v.y, v.z].map(f64::to_bits)
        };
        run.trajectory.events.iter().map(of).collect()
    };
    for (e, mu) in [(1.0, 0.0), (0.8, 0.2), (0.5, 0.6)] {
        let scene = |duration: f64| {
            Stage::new(duration)
                .down(9.81)
                .room(rough(e, coulomb(mu)), [3.0, 2.0, 2.5])
                .ball([0.7, 0.6, 1.9], [1.3, -2.1, 0.4], 0.1)
                .run()
        };
        let longest = bits(&scene(100.0));
        for duration in [1e-3, 0.1, 1.0, 3.0, 10.0, 99.0] {
            let short = bits(&scene(duration));
            let same = longest.get(..short.len()) == Some(short.as_slice());
            check.that(same, || format!("e = {e}: {duration} s is not the beginning of 100 s"));
            let cut = longest.partition_point(|row| f64::from_bits(row[0]) < duration);
            check.that(short.len() >= cut, || format!("e = {e}: {} of {cut} events in {duration} s", short.len()));
        }
        events += longest.len();
    }
    check.figure(format!("{events} events, 18 cuts"))
}

fn extreme_steps() -> Figure {
    let mut check = Check::new();
    let methods: [fn(f64) -> Method; 3] =
        [|step| Method::Euler { step }, |step| Method::SemiImplicitEuler { step }, |step| Method::Rk4 { step }];
    for method in methods {
        let stage = |step: f64| {
            Stage::new(3.0).down(9.81).floor(smooth(0.5)).ball([0.0, 0.0, 1.0], [0.0; 3], 0.1).method(method(step))
        };
        for step in [5e-324, 1e-300, 1e-20] {
            let refused = Plan::new(&stage(step).0).map_err(|e| e.to_string());
            let named = refused.as_ref().is_err_and(|e| e.starts_with("step is "));
            check.that(named, || format!("{:?}: {refused:?}", method(step)));
        }
        for step in [1e300, f64::MAX] {
            let run = stage(step).run();
            check.that(run.outcome.ending == Ending::Completed, || format!("{:?}: {:?}", method(step), run.outcome));
            let paths = run.outcome.counters.paths;
            check.that(paths <= 200, || format!("{:?}: {paths} paths", method(step)));
            let z = run.outcome.state.position.z;
            check.that(z >= 0.1, || format!("{:?}: ends at {z}", method(step)));
        }
    }
    // The exact flight knows no step; its longest is the duration.
    let run = Stage::new(1e300).down(9.81).floor(smooth(0.5)).ball([0.0, 0.0, 1.0], [0.0; 3], 0.1).run();
    check.that(run.outcome.motion == Motion::Resting, || format!("{:?}", run.outcome));
    check.figure("refused below a 1e10th of the duration; long ones end".to_owned())
}
