//! H21 to H23: restitution 0, restitution 1 a hundred thousand times, and the infinitely many bounces between.

use super::check::Check;
use crate::catalogue::{Case, Figure};
use crate::oracle::{Table, U};
use crate::stage::{Stage, coulomb, rough, smooth};
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::events::{Ending, Event, EventKind, Motion};
use carom_dynamics::observer::{Observer, Segment};
use carom_dynamics::simulate::simulate;
use nalgebra::{Point3, Vector3};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "H21",
        title: "restitution 0",
        elsewhere: "the contact fires again at the same instant",
        bound: "one impact, the normal speed 0 to the bit, then contact for good",
        run: no_restitution,
    },
    Case {
        id: "H22",
        title: "restitution 1, 1 000 000 bounces on a level floor",
        elsewhere: "energy grows with each bounce (Jolt #1286, rapier #97) or is lost (bullet3 #1530: 10 m to 4.5 m)",
        bound: "each impact the same speed to the bit; clock off by at most n u",
        run: level_bounces,
    },
    Case {
        id: "H22",
        title: "restitution 1, 100 000 bounces on each of four slanted planes",
        elsewhere: "a push-out of k ulp gains k g ulp(H) per bounce: 1.2e-4 per million at 1e6 m",
        bound: "normal speed off by at most 8 u after any number of bounces; weightless between two, by nothing",
        run: slanted_bounces,
    },
    Case {
        id: "H22",
        title: "restitution 1, 100 000 bounces in grooves",
        elsewhere: "the error of each reflection has one sign, and adds up",
        bound: "energy off by at most 4 n u after n bounces",
        run: grooves,
    },
    Case {
        id: "H22",
        title: "shallow, slow and weightless impacts, restitution 1",
        elsewhere: "restitution thresholds of 0.2 to 2 m/s: balls stick to walls (PhysX #351, box2d #501, bullet3 #3094)",
        bound: "v_n -> -v_n to the bit, down to 1e-300 m/s",
        run: no_threshold,
    },
    Case {
        id: "H22",
        title: "drop from 2 m with e = 0.3, 0.5, 0.8, 0.95",
        elsewhere: "apex at 1 % of the height, whatever e (rapier #974)",
        bound: "apex = e^2 h to 4 u per bounce",
        run: apex_after_drop,
    },
    Case {
        id: "H23",
        title: "infinitely many bounces in a finite time, e = 0.05 to 0.999",
        elsewhere: "through the floor (SciML #138, #696, OpenModelica PR #16009: to -0.96 m), or without end",
        bound: "at rest at sqrt(2h/g)(1+e)/(1-e) to 1e-13 and on the floor to the bit until 1e6 s",
        run: zeno,
    },
    Case {
        id: "H23",
        title: "infinitely many bounces down a slope",
        elsewhere: "sticks, or trembles down the slope",
        bound: "sliding begins at the time, place and speed of the closed form, to 1e-13",
        run: zeno_on_a_slope,
    },
];

fn no_restitution() -> Figure {
    let mut check = Check::new();
    let mut runs = 0;
    let slanted = Vector3::new(0.3, -0.5, 0.7).normalize();
    for (normal, friction) in [
        (Vector3::z(), Friction::None),
        (Vector3::z(), coulomb(0.3)),
        (slanted, Friction::None),
        (slanted, coulomb(5.0)),
        (-Vector3::x(), Friction::None),
    ] {
        for g in [0.0, 9.81] {
            let run = Stage::new(5.0)
                .down(g)
                .plane("plane", rough(0.0, friction), [0.0; 3], normal)
                .ball(Point3::from(normal), -2.0 * normal + Vector3::new(0.1, 0.2, 0.3), 0.25)
                .run();
            let place = || format!("normal {normal:?}, {friction:?}, g = {g}");
            let impacts = run.impacts();
            check.that(impacts.len() == 1, || format!("{}: {:?}", place(), run.kinds()));
            let Some(impact) = impacts.first() else { continue };
            let away = normal.dot(&impact.velocity).abs();
            let bound = if normal == slanted { 2.0 * U * impact.velocity_in.norm() } else { 0.0 };
            check.within(0.0, away, bound, || format!("{}: normal speed", place()));
            let times: Vec<_> = run.trajectory.events.iter().filter(|e| e.kind == EventKind::Impact).collect();
            check.that(times.len() == 1, || format!("{}: {times:?}", place()));
            let gap = normal.dot(&run.outcome.state.position.coords) - 0.25;
            check.within(0.0, -gap, 64.0 * U * 130.0, || format!("{}: sinks in", place()));
            // Pressed, it stays.
            if g > 0.0 && normal.z > 0.0 {
                check.within(0.0, gap.abs(), 64.0 * U * 130.0, || format!("{}: leaves", place()));
                check.that(run.outcome.motion != Motion::Flying, || format!("{}: flies", place()));
            }
            runs += 1;
        }
    }
    check.figure(format!("one impact in each of {runs} runs"))
}

/// How many bounces a ball on an axis-aligned floor makes.
const MILLION: u64 = 1_000_000;

/// How many stand for a million elsewhere: the suite is to end in a minute.
const MANY: u64 = 100_000;

/// What stays of a long run: its impacts are looked at as they come.
struct Watch<F>(F);

impl<F: FnMut(&Event)> Observer for Watch<F> {
    fn event(&mut self, event: &Event) {
        (self.0)(event);
    }

    fn segment(&mut self, _: &Segment) {}
}

/// Runs the only ball of `stage` and shows its events to `look`.
fn watch(stage: &Stage, look: impl FnMut(&Event)) -> Ending {
    let plan = stage.plan();
    simulate(&plan, &plan.balls()[0], &mut Watch(look)).ending
}

fn level_bounces() -> Figure {
    let mut check = Check::new();
    let mut off = 0.0;
    for (g, h, r) in [(9.81, 2.0, 0.0), (9.81, 0.3, 0.1), (1.62, 1e-9, 0.0), (274.0, 1e6, 0.5)] {
        // The first impact to 50 digits is not needed: the period is twice the time of fall, to a few u.
        let period = 2.0 * f64::sqrt(2.0 * h / g);
        let stage = Stage::new(period * MILLION as f64).down(g).floor(smooth(1.0)).ball([0.0, 0.0, r + h], [0.0; 3], r);
        let (mut n, mut first, mut last) = (0u64, None, 0.0);
        let ending = watch(&stage, |event| {
            n += 1;
            let (t0, speed) = *first.get_or_insert((event.time, event.velocity.z));
            check.that(event.kind == EventKind::Impact, || format!("{event:?}"));
            check.that(event.velocity.z == speed, || format!("bounce {n}: {} after {speed}", event.velocity.z));
            check.that(event.position.z == r, || format!("bounce {n} at {}", event.position.z));
            last = event.time - t0 - (n - 1) as f64 * (2.0 * speed / g);
        });
        let (_, speed) = first.unwrap_or_default();
        check.that(ending == Ending::Completed && n == MILLION, || format!("{n} bounces, {ending:?}"));
        // The height that the speed stands for: r + h itself is rounded.
        let height = speed * speed / (2.0 * g);
        check.within(0.0, (height - h).abs(), 8.0 * U * (h + r), || "apex".to_owned());
        let bound = n as f64 * U * period * n as f64;
        off = check.within(off, last.abs() / (period * n as f64), bound / (period * n as f64), || "clock".to_owned());
    }
    check.figure(format!("{MILLION} equal speeds in each of 4 drops, clock off by {off:.1e} at most"))
}

/// Normals of planes in no special position.
const SLANTS: [[f64; 3]; 4] = [[0.3, -0.5, 0.7], [1.0, 2.0, 3.0], [1.0, 1.0, 1.0], [0.1, 0.2, -0.9]];

fn slanted_bounces() -> Figure {
    let mut check = Check::new();
    let mut worst = 0.0;
    for slant in SLANTS {
        let n = Vector3::from(slant).normalize();
        let stage = Stage::new(2.0 * MANY as f64).gravity(-9.81 * n).plane("slope", smooth(1.0), [0.0; 3], slant).ball(
            Point3::from(2.0 * n),
            [0.3, 0.2, 0.1],
            0.0,
        );
        let mut first = None;
        let mut bounces = 0;
        watch(&stage, |event| {
            bounces += 1;
            let speed = n.dot(&event.velocity);
            let change = (speed / *first.get_or_insert(speed) - 1.0).abs();
            // Not of the ball's speed but of what is left of it along the normal: three products and two sums.
            worst = check.within(worst, change, 8.0 * U, || format!("{slant:?}, bounce {bounces}"));
        });
        check.that(bounces > MANY, || format!("{bounces} bounces"));
        // Between two such walls, weightless.
        let run = Stage::new(MANY as f64 / 10.0)
            .plane("a", smooth(1.0), [0.0; 3], slant)
            .plane("b", smooth(1.0), Point3::from(n), slant)
            .ball(Point3::from(0.5 * n), n, 0.0)
            .run();
        let (v, hits) = (run.outcome.state.velocity, run.impacts().len());
        check.that((v == n || v == -n) && hits as u64 == MANY / 10, || format!("{slant:?}: {v:?} after {hits} hits"));
    }
    check.figure(format!("normal speed off by {worst:.1e} at most, nothing between two walls"))
}

fn grooves() -> Figure {
    let mut check = Check::new();
    let (mut worst, mut bounces) = (0.0, 0);
    let grooves = [
        ([[1.0, 0.2, 2.0], [-1.5, 0.1, 1.0]], [0.1, 0.0, 3.0]),
        ([[1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]], [0.3, 0.0, 2.0]),
        ([[0.3, 0.7, 1.0], [-0.2, -0.9, 1.1]], [-0.1, 0.2, 1.0]),
    ];
    for (normals, start) in grooves {
        let g = 9.81;
        let stage = Stage::new(0.25 * MANY as f64)
            .down(g)
            .plane("a", smooth(1.0), [0.0; 3], normals[0])
            .plane("b", smooth(1.0), [0.0; 3], normals[1])
            .ball(start, [0.0; 3], 0.1);
        let energy = |e: &Event| (g * (e.position.z - start[2]) + 0.5 * e.velocity.norm_squared()) / (g * start[2]);
        let (mut n, mut off, mut fastest) = (0u64, 0.0, 1.0f64);
        let ending = watch(&stage, |event| {
            n += 1;
            // A groove that falls lets the ball gain what it is measured against.
            fastest = fastest.max(0.5 * event.velocity.norm_squared() / (g * start[2]));
            off = f64::abs(energy(event)) / fastest;
            check.within(0.0, off, 4.0 * n as f64 * U, || format!("energy after {n} bounces"));
        });
        check.that(ending == Ending::Completed, || format!("{ending:?}"));
        bounces += n;
        worst = f64::max(worst, off);
    }
    check.figure(format!("{bounces} bounces in 3 grooves, off by {worst:.1e} at the end"))
}

fn no_threshold() -> Figure {
    let mut check = Check::new();
    let mut runs = 0;
    for speed in [1.0f64, 0.1, 1e-3, 1e-9, 1e-30, 1e-300] {
        for along in [0.0, 1.0, 1e3] {
            // 1 m from the wall in the time that takes.
            let distance = if along == 0.0 { 1.0 } else { speed.min(1.0) };
            let run = Stage::new(1.5 * distance / speed)
                .plane("wall", smooth(1.0), [0.0; 3], [-1.0, 0.0, 0.0])
                .ball([-distance, 0.0, 0.0], [speed, along, 0.0], 0.0)
                .run();
            let impacts = run.impacts();
            check.that(impacts.len() == 1, || format!("{speed:e} beside {along}: {:?}", run.kinds()));
            let v = run.outcome.state.velocity;
            check.that(v == Vector3::new(-speed, along, 0.0), || format!("{speed:e} beside {along}: {v:?}"));
            runs += 1;
        }
    }
    check.figure(format!("reflected to the bit in {runs} runs"))
}

fn apex_after_drop() -> Figure {
    let mut check = Check::new();
    let mut worst = 0.0;
    for e in [0.3, 0.5, 0.8, 0.95] {
        let run = Stage::new(3.0).down(9.81).floor(smooth(e)).ball([0.0, 0.0, 2.0], [0.0; 3], 0.0).run();
        for (n, pair) in run.impacts().windows(2).take(8).enumerate() {
            let middle = 0.5 * (pair[0].time + pair[1].time);
            let Some((top, _)) = run.trajectory.at(middle) else { continue };
            let expected = 2.0 * e.powi(2 * (n as i32 + 1));
            let bound = 8.0 * (n as f64 + 2.0) * U;
            worst = check
                .within(worst, (top.position.z / expected - 1.0).abs(), bound, || format!("e = {e}, apex {}", n + 1));
        }
    }
    check.figure(format!("worst {worst:.1e}"))
}

fn zeno() -> Figure {
    let mut check = Check::new();
    let (mut worst, mut most) = (0.0, 0);
    for row in Table::read("bounce_zeno").rows() {
        let [g, h, e, end] = row.numbers(["g", "h0", "e", "t_zeno"]);
        let run = Stage::new(1e6).down(g).floor(smooth(e)).ball([0.0, 0.0, h], [0.0; 3], 0.0).run();
        let place = || format!("e = {e}, h = {h}");
        let rest = run.events(EventKind::Rest);
        check.that(rest.len() == 1, || format!("{}: {:?}", place(), run.outcome));
        let Some(rest) = rest.first() else { continue };
        worst = check.within(worst, (rest.time / end - 1.0).abs(), 1e-13, || format!("{}: rest time", place()));
        check.that(run.outcome.state.position.z == 0.0, || format!("{}: {:?}", place(), run.outcome.state));
        let lowest = run.trajectory.events.iter().map(|e| e.position.z).fold(0.0, f64::min);
        check.that(lowest >= 0.0, || format!("{}: {lowest:e} below the floor", place()));
        // Between the events too: the flights are convex from above, their ends are events.
        for k in 0..200 {
            let t = end * f64::from(k) / 150.0;
            let z = run.at(t).z;
            check.that(z >= -16.0 * U * h, || format!("{}: {z:e} at {t} s", place()));
        }
        most = most.max(run.impacts().len());
    }
    check.figure(format!("rest time off by {worst:.1e}, at most {most} impacts"))
}

fn zeno_on_a_slope() -> Figure {
    let mut check = Check::new();
    let mut worst = 0.0;
    for row in Table::read("incline_zeno").rows() {
        let [g, h, angle, e] = row.numbers(["g", "h_drop", "slope_deg", "e"]);
        let [end, distance, speed] = row.numbers(["t_bouncing_ends", "distance_bouncing_ends", "slide_speed_then"]);
        let (sin, cos) = angle.to_radians().sin_cos();
        let (normal, down) = (Vector3::new(sin, 0.0, cos), Vector3::new(cos, 0.0, -sin));
        let run = Stage::new(2.0 * end + 2.0)
            .down(g)
            .plane("slope", smooth(e), [0.0; 3], normal)
            .ball([0.0, 0.0, h], [0.0; 3], 0.0)
            .run();
        let place = || format!("slope {angle}, e = {e}");
        let (impacts, slides) = (run.impacts(), run.events(EventKind::Slide));
        check.that(slides.len() == 1 && run.outcome.motion == Motion::Sliding, || format!("{}: {slides:?}", place()));
        let (Some(first), Some(slide)) = (impacts.first(), slides.first()) else { continue };
        let found = [
            ((slide.time - first.time) / end, "time"),
            ((slide.position - first.position).dot(&down) / distance, "place"),
            (slide.velocity.norm() / speed, "speed"),
        ];
        for (ratio, what) in found {
            worst = check.within(worst, (ratio - 1.0).abs(), 1e-13, || format!("{}: {what}", place()));
        }
    }
    check.figure(format!("off by {worst:.1e} at most"))
}
