//! H26, H27 and H32: friction at its limit, sliding to a stop, rest at every scale, and contact that is lost.

use super::check::Check;
use crate::catalogue::{Case, Figure};
use crate::oracle::{Table, U};
use crate::stage::{Run, Stage, coulomb, rough, smooth};
use carom_dynamics::effects::drag::Drag;
use carom_dynamics::events::{EventKind, Motion};
use nalgebra::{Point3, Vector3};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "H26",
        title: "on a slope with mu = tan(theta) (1 +- 2^-40)",
        elsewhere: "rapier 0.36.1 creeps 9e-5 m in 10 s when it should stick",
        bound: "above and at tan: rest, moved by 0 m to the bit; below: v = g (sin - mu cos) t to 1e-12 g sin t",
        run: limit_of_friction,
    },
    Case {
        id: "H27",
        title: "sliding down, up and along to a stop",
        elsewhere: "friction overshoots the stop and drives the ball backwards",
        bound: "time and place of the stop to 1e-11; no speed is turned round by friction",
        run: to_a_stop,
    },
    Case {
        id: "H27",
        title: "sliding across a slope, no straight line",
        elsewhere: "friction along each axis instead of against the velocity",
        bound: "places and the stop of the closed form to 1e-11",
        run: across,
    },
    Case {
        id: "H32",
        title: "bouncing, sliding and rest of one scene at scales 2^-240 to 2^240",
        elsewhere: "thresholds in m/s and m: a small scene never moves, a large one never rests",
        bound: "the same events to the bit, scaled",
        run: every_scale,
    },
    Case {
        id: "H32",
        title: "a ball slides over the edge of a table",
        elsewhere: "it sticks to the edge, or leaves it at the end of a step",
        bound: "contact is lost at cos = 2/3 + v^2 / (3 g r), to 1e-9",
        run: over_an_edge,
    },
    Case {
        id: "H32",
        title: "a ball that slides down a slope is lifted by the wind",
        elsewhere: "contact is lost at the end of a step, or never",
        bound: "at the speed where the lift is the weight, to 1e-12, and at its time by an independent integration, to 1e-8",
        run: lifted_by_wind,
    },
];

fn limit_of_friction() -> Figure {
    let mut check = Check::new();
    let (mut worst, mut moved) = (0.0, 0.0);
    let g = 9.81;
    let least = 2f64.powi(-40);
    // Normals whose components are as good as exact: triples of Pythagoras.
    for (a, b, c) in [(3.0, 4.0, 5.0), (5.0, 12.0, 13.0), (8.0, 15.0, 17.0), (20.0, 21.0, 29.0)] {
        let (sin, cos, tan) = (a / c, b / c, a / b);
        let (normal, down) = (Vector3::new(sin, 0.0, cos), Vector3::new(cos, 0.0, -sin));
        for r in [0.0, 0.25] {
            for factor in [1.0 + least, 1.0, 1.0 - least, 1.0 - 1.0 / 1024.0] {
                let mu = tan * factor;
                let duration = 10.0;
                let run = Stage::new(duration)
                    .down(g)
                    .plane("slope", rough(0.5, coulomb(mu)), [0.0; 3], normal)
                    .ball(Point3::from(normal * r), [0.0; 3], r)
                    .run();
                let place = || format!("tan = {tan}, mu = tan * {factor}, r = {r}");
                let end = run.outcome.state;
                if factor >= 1.0 {
                    check.that(run.outcome.motion == Motion::Resting, || format!("{}: {:?}", place(), run.outcome));
                    let Some(rest) = run.trajectory.events.iter().find(|e| e.kind == EventKind::Rest) else {
                        check.that(false, || format!("{}: never rests", place()));
                        continue;
                    };
                    let away = (end.position - rest.position).norm();
                    moved = check.within(moved, away, 0.0, || format!("{}: creeps", place()));
                    // Until it is found to rest it may have moved by what its place is rounded to.
                    check.within(0.0, (end.position.coords - normal * r).norm(), 8.0 * U * r, || {
                        format!("{}: moved before it rests", place())
                    });
                } else {
                    check.that(run.outcome.motion == Motion::Sliding, || format!("{}: {:?}", place(), run.outcome));
                    let speed = g * (sin - mu * cos) * duration;
                    let error = (end.velocity.dot(&down) - speed).abs() / (g * sin * duration);
                    worst = check.within(worst, error, 1e-12, || format!("{}: speed", place()));
                }
            }
        }
    }
    check.figure(format!("rests move by {moved} m, speeds off by {worst:.1e} of g sin t"))
}

/// A slope through the origin that falls towards +x: normal, downhill, across.
fn slope(degrees: f64) -> [Vector3<f64>; 3] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [Vector3::new(sin, 0.0, cos), Vector3::new(cos, 0.0, -sin), Vector3::y()]
}

/// The least v.w between neighbouring velocities of the sliding stretches of a run, over |v|^2: negative where one was turned round.
fn turned(run: &Run) -> f64 {
    let sliding = run.trajectory.segments.iter().filter(|s| s.motion == Motion::Sliding);
    let ends = |s: &carom_dynamics::observer::Segment| (s.step.at(0.0).velocity, s.step.at(s.to).velocity);
    sliding.map(ends).map(|(v, w)| v.dot(&w) / v.norm_squared()).fold(f64::INFINITY, f64::min)
}

fn to_a_stop() -> Figure {
    let mut check = Check::new();
    let (mut worst, mut rows) = (0.0, 0);
    for row in Table::read("slope_slide_1d").rows() {
        let [g, degrees, mu, v0] = row.numbers(["g", "slope_deg", "mu", "v0"]);
        let [t, distance, back] = row.numbers(["t_stop_or_turn", "distance", "return_speed_at_start_0_if_stuck"]);
        let [normal, down, _] = slope(degrees);
        let heading = if row.text("dir") == "up" { -down } else { down };
        let run = Stage::new(4.0 * t + 4.0)
            .down(g)
            .plane("slope", rough(0.5, coulomb(mu)), [0.0; 3], normal)
            .ball([0.0; 3], heading * v0, 0.0)
            .run();
        let place = || format!("slope {degrees}, mu = {mu}, {}", row.text("dir"));
        let reached = run.at(t).coords.dot(&heading);
        worst = check.within(worst, (reached / distance - 1.0).abs(), 1e-11, || format!("{}: place", place()));
        if back == 0.0 {
            let rest = run.events(EventKind::Rest);
            check.that(rest.len() == 1, || format!("{}: {:?}", place(), run.kinds()));
            let Some(rest) = rest.first() else { continue };
            worst = check.within(worst, (rest.time / t - 1.0).abs(), 1e-11, || format!("{}: time", place()));
            check.that(run.outcome.state.position == rest.position, || format!("{}: creeps", place()));
            // Zero, but for rounding: stops.
            check.that(turned(&run) >= -4.0 * U, || format!("{}: turned by friction", place()));
        }
        rows += 1;
    }
    check.figure(format!("{rows} slopes, off by {worst:.1e} at most"))
}

fn across() -> Figure {
    let mut check = Check::new();
    let (mut worst, mut stops) = (0.0, 0.0);
    for group in Table::read("slope_slide_2d").groups(6) {
        let [g, degrees, mu, v0, from_downhill] =
            group[0].numbers(["g", "slope_deg", "mu", "v0", "psi0_deg_from_downhill"]);
        let [normal, down, across] = slope(degrees);
        let (sin, cos) = from_downhill.to_radians().sin_cos();
        let last = group[group.len() - 1].number("t");
        let run = Stage::new(10.0 * last)
            .down(g)
            .plane("slope", rough(0.5, coulomb(mu)), [0.0; 3], normal)
            .ball([0.0; 3], (down * cos + across * sin) * v0, 0.0)
            // Slow is not still yet.
            .rest_length(1e-24)
            .run();
        let place = |t: f64| format!("slope {degrees}, mu = {mu}, t = {t}");
        for row in &group {
            let [t, s, q] = row.numbers(["t", "s_down", "q_across"]);
            let x = run.at(t).coords;
            let error = (x.dot(&down) - s).hypot(x.dot(&across) - q) / s.hypot(q);
            worst = check.within(worst, error, 1e-11, || place(t));
        }
        if let Ok(t_stop) = group[0].text("t_stop").parse::<f64>() {
            let rest = run.events(EventKind::Rest);
            check.that(rest.len() == 1, || format!("{}: {:?}", place(t_stop), run.kinds()));
            let error = rest.first().map_or(f64::NAN, |rest| (rest.time / t_stop - 1.0).abs());
            stops = check.within(stops, error, 1e-11, || format!("{}: stop", place(t_stop)));
        }
    }
    check.figure(format!("places off by {worst:.1e}, stops by {stops:.1e} at most"))
}

fn every_scale() -> Figure {
    let mut check = Check::new();
    let scene = |k: i32, m: i32| {
        let (length, time) = (2f64.powi(k), 2f64.powi(m));
        let speed = 2f64.powi(k - m);
        let corner = |x: f64, y: f64, z: f64| [x * length, y * length, z * length];
        Stage::new(6.0 * time)
            .gravity(Vector3::new(0.1, -0.2, -9.81) * (speed / time))
            .polygon(
                "floor",
                rough(0.7, coulomb(0.4)),
                &[corner(-9.0, -9.0, 0.0), corner(9.0, -9.0, 0.0), corner(9.0, 9.0, 0.0), corner(-9.0, 9.0, 0.0)],
            )
            .plane("wall", rough(0.5, coulomb(0.2)), corner(1.5, 0.0, 0.0), [-1.0, 0.0, 0.25])
            .ball(corner(0.3, 0.2, 1.1), Vector3::new(2.0, 0.7, 0.3) * speed, 0.125 * length)
            .run()
    };
    let right = scene(0, 0);
    check.that(right.outcome.motion == Motion::Resting, || format!("{:?}", right.outcome));
    let scales = [(-240, 0), (-100, 30), (-30, -20), (1, 0), (40, 40), (100, -50), (240, 100)];
    for (k, m) in scales {
        let run = scene(k, m);
        check.that(run.kinds() == right.kinds(), || format!("2^{k} m, 2^{m} s: {:?}", run.kinds()));
        let (length, time) = (2f64.powi(k), 2f64.powi(m));
        for (a, b) in run.trajectory.events.iter().zip(&right.trajectory.events) {
            let same = a.time == b.time * time
                && a.position.coords == b.position.coords * length
                && a.velocity == b.velocity * 2f64.powi(k - m);
            check.that(same, || format!("2^{k} m, 2^{m} s: {a:?} instead of {b:?}"));
        }
    }
    check.figure(format!("{} events to rest, the same at {} scales", right.trajectory.events.len(), scales.len()))
}

fn over_an_edge() -> Figure {
    let mut check = Check::new();
    let mut worst = 0.0;
    let g = 9.81;
    for (r, v) in [(0.5, 0.5), (0.5, 1.0), (0.5, 2.0), (0.02, 0.1), (3.0, 1.0), (0.5, 2.3)] {
        let size = 8.0 * r;
        let run = Stage::new(4.0 * r / v + 4.0)
            .down(g)
            .polygon(
                "table",
                smooth(0.5),
                &[[-size, -size, 0.0], [0.0, -size, 0.0], [0.0, size, 0.0], [-size, size, 0.0]],
            )
            .ball([-r, 0.0, r], [v, 0.25 * r, 0.0], r)
            .run();
        let place = || format!("r = {r}, v = {v}");
        let kinds = run.kinds();
        check.that(kinds == [EventKind::Slide, EventKind::Leave], || format!("{}: {kinds:?}", place()));
        let Some(leave) = run.events(EventKind::Leave).first().copied() else { continue };
        let cos = leave.position.z / leave.position.x.hypot(leave.position.z);
        // Faster than sqrt(g r) it flies off the edge at once.
        let expected = (2.0 / 3.0 + v * v / (3.0 * g * r)).min(1.0);
        worst = check.within(worst, (cos - expected).abs(), 1e-9, || format!("{}: cos", place()));
    }
    check.figure(format!("cos off by {worst:.1e} at most"))
}

fn lifted_by_wind() -> Figure {
    let mut check = Check::new();
    let (mut worst_speed, mut worst_time) = (0.0, 0.0);
    let g = 9.81;
    // Quadratic drag with 1/2 rho C A / m = c per metre, and a wind of `up` m/s away from the slope: the lift is c |v - w| up, the
    // weight on the slope g cos. Sliding down, the ball gets faster until the one is the other.
    for (degrees, up, c) in [(30.0, 3.0, 0.88), (60.0, 2.0, 0.8), (45.0, 4.0, 0.36)] {
        let (r, mass) = (0.1, 1.0);
        let [normal, down, _] = slope(degrees);
        let area = std::f64::consts::PI * r * r;
        let drag = Drag::quadratic(2.0 * c * mass / area, 1.0).and_then(|drag| drag.in_wind(normal * up));
        let drag = drag.unwrap_or_else(|e| panic!("{e}"));
        let (along, onto) = (g * normal.x, g * normal.z);
        // Where the lift is the weight.
        let relative = onto / (c * up);
        let speed = (relative * relative - up * up).sqrt();
        // dv/dt = g sin - c |v - w| v by small steps of Runge and Kutta, the last of them cut by Newton's method.
        let rate = |v: f64| along - c * v.hypot(up) * v;
        let (mut t, mut v) = (0.0, 0.0);
        let step = 1.0 / 65536.0;
        check.that(rate(speed) > 0.0, || format!("slope {degrees}: never as fast as that"));
        if rate(speed) <= 0.0 {
            continue;
        }
        while v < speed && t < 20.0 {
            let k1 = rate(v);
            let k2 = rate(v + 0.5 * step * k1);
            let k3 = rate(v + 0.5 * step * k2);
            let k4 = rate(v + step * k3);
            v += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            t += step;
        }
        t -= (v - speed) / rate(v);
        let run = Stage::new(t + 1.0)
            .down(g)
            .drag(drag)
            .plane("slope", smooth(0.5), [0.0; 3], normal)
            .thing(Point3::from(normal * r), [0.0; 3], r, Some(mass))
            .run();
        let place = || format!("slope {degrees}, wind {up}");
        let leaves = run.events(EventKind::Leave);
        check.that(leaves.len() == 1, || format!("{}: {:?}, speed {speed}, t {t}", place(), run.kinds()));
        let Some(leave) = leaves.first() else { continue };
        let off = (leave.velocity.dot(&down) / speed - 1.0).abs();
        worst_speed = check.within(worst_speed, off, 1e-12, || format!("{}: speed", place()));
        worst_time = check.within(worst_time, (leave.time / t - 1.0).abs(), 1e-8, || format!("{}: time", place()));
        let height = normal.dot(&run.outcome.state.position.coords) - r;
        check.that(height > 0.0, || format!("{}: is not lifted: {height:e}", place()));
    }
    check.figure(format!("speed off by {worst_speed:.1e}, time by {worst_time:.1e} at most"))
}
