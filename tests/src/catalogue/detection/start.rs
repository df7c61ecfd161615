//! H1 and H2: a ball that starts on a surface, or in it.

use super::super::{Bound, Case, Figure, Worst};
use crate::random::Random;
use crate::stage::{Run, Stage, smooth};
use carom_dynamics::events::{EventKind, Motion};
use carom_dynamics::scene::Method;
use carom_geometry::rounding::UNIT_ROUNDOFF;
use nalgebra::{Point3, Vector3};

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case {
            id: "H1",
            title: "start exactly on a plane, leaving",
            elsewhere: "SciML nudges by dt/100, a blind zone (DiffEqBase callbacks.jl); DynamicalBilliards takes no t <= sqrt(eps)",
            bound: "next event at 2 v_n/g_n to 4 u, never at 0; none if nothing pulls back",
            run: leaving_a_plane,
        },
        Case {
            id: "H1",
            title: "20 s of bouncing, c_r = 0.8, h = 1 m, every method",
            elsewhere: "the book's loop as published: 959 960 iterations of no length, every frame at its cap",
            bound: "no stretch of no length, no event twice at one (t, surface), bouncing ends (not under explicit Euler)",
            run: no_event_twice,
        },
        Case {
            id: "H1",
            title: "start exactly on a face, an edge, a vertex of a mesh, leaving",
            elsewhere: "DynamO waits until the overlap turns (stable_poly.hpp); others hit at t = 0",
            bound: "never at 0; back at 2 v_n/g_n to 64 u",
            run: leaving_a_mesh,
        },
        Case {
            id: "H2",
            title: "start overlapping a plane: approaching, receding, turning",
            elsewhere: "DynamO's three tests of plane_intersection.cpp; push-out elsewhere gains energy",
            bound: "approaching: one event at t = 0; receding: none; never deeper than at the start",
            run: overlapping_a_plane,
        },
        Case {
            id: "H2",
            title: "start overlapping a triangle, its edge, its vertex; centre on it",
            elsewhere: "PhysX #600: initial overlap not reported",
            bound: "approaching: one event at t = 0; receding: none; never deeper than at the start",
            run: overlapping_a_mesh,
        },
    ]
}

fn leaving_a_plane() -> Figure {
    let mut random = Random::new(0x11);
    let (mut bound, mut worst) = (Bound::default(), Worst::new());
    let count = 2000;
    for _ in 0..count {
        // Dyadic, so that the clearance is exactly 0.
        let (p, r) = ((random.within(-64.0, 64.0) * 64.0).floor() / 64.0, 2f64.powi(random.below(8) as i32 - 6));
        let (v, g) = (random.octave(-20, 20), random.octave(-10, 10));
        let drift = random.vector(3.0);
        let stage = |g: f64| {
            let stage = Stage::new(4.0 * v / g.abs()).gravity([0.25, -0.5, -g]);
            let stage = stage.plane("floor", smooth(0.5), [0.3, -0.7, p], [0.0, 0.0, 1.0]);
            stage.ball([0.1, 0.2, p + r], [drift.x, drift.y, v], r).run()
        };
        let (run, expected) = (stage(g), 2.0 * v / g);
        match run.trajectory.events.first() {
            Some(event) => {
                let error = (event.time - expected).abs() / expected / UNIT_ROUNDOFF;
                worst.of(error);
                bound.keep(event.time > 0.0 && error <= 4.0, || format!("v = {v}, g = {g}: t = {}", event.time));
            }
            None => bound.keep(false, || format!("v = {v}, g = {g}: no event")),
        }
        for g in [-g, -0.0] {
            let free = if g == 0.0 {
                let stage = Stage::new(1e6).plane("floor", smooth(0.5), [0.3, -0.7, p], [0.0, 0.0, 1.0]);
                stage.ball([0.1, 0.2, p + r], [drift.x, drift.y, v], r).run()
            } else {
                stage(g)
            };
            bound.keep(free.trajectory.events.is_empty(), || format!("v = {v}, g = {g}: an event without return"));
        }
    }
    bound.figure(format!("{count} starts: off by {:.2} u at worst, none at 0", worst.0))
}

/// What of an event does not depend on how the faces are numbered.
pub(super) type Bits = (f64, EventKind, Point3<f64>, Vector3<f64>, Vector3<f64>);

/// The events of a run as seen from `from`.
pub(super) fn bits_from(run: &Run, from: &Vector3<f64>) -> Vec<Bits> {
    run.trajectory.events.iter().map(|e| (e.time, e.kind, e.position - from, e.normal, e.velocity)).collect()
}

/// The events of a run.
pub(super) fn bits(run: &Run) -> Vec<Bits> {
    bits_from(run, &Vector3::zeros())
}

/// What no run may have: an impact repeated at one time on one surface, or one without closing speed.
pub(super) fn keep_events_apart(bound: &mut Bound, run: &Run, what: &str) {
    let impacts = run.impacts();
    for pair in impacts.windows(2) {
        let twice =
            pair[0].time == pair[1].time && pair[0].surface == pair[1].surface && pair[0].normal == pair[1].normal;
        bound.keep(!twice, || format!("{what}: twice at t = {}", pair[0].time));
    }
    for e in &impacts {
        let closing = e.normal.dot(&e.velocity_in);
        let rounding = 4.0 * UNIT_ROUNDOFF * e.velocity_in.norm();
        bound.keep(closing <= rounding || e.velocity == e.velocity_in, || {
            format!("{what}: answered at n.v = {closing:e}, t = {}", e.time)
        });
    }
}

fn no_event_twice() -> Figure {
    let mut bound = Bound::default();
    let step = 1.0 / 60.0;
    let methods = [
        ("exact", Method::Exact),
        ("Euler", Method::Euler { step }),
        ("semi-implicit", Method::SemiImplicitEuler { step }),
        ("RK4", Method::Rk4 { step }),
        ("adaptive", Method::Adaptive { tolerance: 1e-9 }),
    ];
    let mut counts = Vec::new();
    for (name, method) in methods {
        let stage = Stage::new(20.0).down(9.81).floor(smooth(0.8)).method(method);
        let run = stage.ball([0.0, 0.0, 1.0], [0.5, 0.0, 0.0], 0.0).run();
        keep_events_apart(&mut bound, &run, name);
        let idle = run.trajectory.segments.iter().filter(|s| s.end <= s.time).count();
        bound.keep(idle == 0, || format!("{name}: {idle} stretches of no length"));
        // Explicit Euler gains g^2 h^2 / 2 a step: against that c_r = 0.8 keeps it hopping for ever.
        let rests = run.outcome.motion == Motion::Sliding && run.outcome.state.velocity.z == 0.0;
        bound.keep(rests != (name == "Euler"), || {
            format!("{name}: {:?} with {:?}", run.outcome.motion, run.outcome.state)
        });
        counts.push(format!("{} {name}", run.impacts().len()));
    }
    bound.figure(format!("impacts: {}; none twice", counts.join(", ")))
}

/// A square of two triangles around the origin, its diagonal through it.
fn square() -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let corner = |x: f64, y: f64| Point3::new(x, y, 0.0);
    (vec![corner(-8.0, -8.0), corner(8.0, -8.0), corner(8.0, 8.0), corner(-8.0, 8.0)], vec![[0, 1, 2], [0, 2, 3]])
}

fn leaving_a_mesh() -> Figure {
    let mut random = Random::new(0x12);
    let (mut bound, mut worst) = (Bound::default(), Worst::new());
    // On a face, on the flat diagonal, on a side and on a corner.
    let places = [("face", [2.0, 0.5]), ("diagonal", [1.0, 1.0]), ("side", [8.0, 1.0]), ("corner", [8.0, 8.0])];
    let count = 200;
    for k in 0..count {
        let (place, [x, y]) = places[k % 4];
        let (v, g) = (random.octave(-6, 6), random.octave(-4, 4));
        let r = 2f64.powi(-(random.below(6) as i32));
        let (vertices, faces) = square();
        let stage = Stage::new(3.0 * v / g).down(g).mesh("square", smooth(0.5), vertices, faces);
        let run = stage.ball([x, y, r], [0.0, 0.0, v], r).run();
        let Some(event) = run.impacts().first().copied() else {
            bound.keep(false, || format!("{place}: no event"));
            continue;
        };
        let expected = 2.0 * v / g;
        let error = (event.time - expected).abs() / expected / UNIT_ROUNDOFF;
        // The rounding of positions of the size of the square, over the closing speed.
        let allowed = 64.0 * (1.0 + 8.0 / (v * expected));
        worst.of(error / allowed * 64.0);
        bound.keep(error <= allowed && run.trajectory.events[0].time > 0.0, || {
            format!("{place}, v = {v}, g = {g}, r = {r}: t = {} of {expected}", run.trajectory.events[0].time)
        });
    }
    bound.figure(format!("{count} starts: off by {:.1} u of position at worst, none at 0", worst.0))
}

/// The least clearance seen at 64 places of every segment, and whether separation only grows after the first event.
fn depths(run: &Run, clearance: impl Fn(&Point3<f64>) -> f64) -> Vec<f64> {
    let segments = run.trajectory.segments.iter();
    segments
        .flat_map(|s| (0..=64).map(move |k| s.step.at(s.to * f64::from(k) / 64.0).position))
        .map(|x| clearance(&x))
        .collect()
}

/// Starts overlapping: the first event, how many there are, and that it never gets deeper.
fn keep_overlap(bound: &mut Bound, run: &Run, approaching: bool, depths: &[f64], what: &str) {
    let impacts = run.impacts();
    if approaching {
        bound.keep(impacts.first().is_some_and(|e| e.time == 0.0), || format!("{what}: no event at 0"));
        let at_zero = impacts.iter().filter(|e| e.time == 0.0).count();
        bound.keep(at_zero == 1, || format!("{what}: {at_zero} events at 0"));
    } else {
        bound.keep(impacts.iter().all(|e| e.time > 0.0), || format!("{what}: an event at 0"));
    }
    let deepest = depths.iter().copied().fold(f64::INFINITY, f64::min);
    let rounding = 64.0 * UNIT_ROUNDOFF;
    bound.keep(depths.first().is_some_and(|d| deepest >= d - rounding), || {
        format!("{what}: from {:?} to {deepest:e}", depths.first())
    });
}

fn overlapping_a_plane() -> Figure {
    let mut bound = Bound::default();
    let mut runs = 0;
    for depth in [1e-8, 1e-3, 0.1, 0.45, 0.6] {
        for c_r in [0.0, 0.5, 1.0] {
            for v in [-1.0, -0.02, 0.02, 1.0] {
                for g in [0.0, 9.81] {
                    let stage = Stage::new(2.0).down(g).floor(smooth(c_r)).plane(
                        "roof",
                        smooth(1.0),
                        [0.0, 0.0, 60.0],
                        [0.0, 0.0, 1.0],
                    );
                    // 0.6 deep, the centre is beyond the plane: then that is its side, and it overlaps it from below.
                    let (z, side) = if depth < 0.5 { (0.5 - depth, 1.0) } else { (0.5 - depth, -1.0) };
                    let run = stage.ball([0.0, 0.0, z], [0.3, 0.0, v * side], 0.5).run();
                    let what = format!("depth {depth}, c_r {c_r}, v {v}, g {g}");
                    let depths = depths(&run, |x| side * x.z - 0.5);
                    keep_overlap(&mut bound, &run, v < 0.0, &depths, &what);
                    keep_events_apart(&mut bound, &run, &what);
                    if g == 0.0 {
                        let apart = depths.windows(2).all(|w| w[1] >= w[0]);
                        bound.keep(apart, || format!("{what}: approaches again"));
                        let expected = usize::from(v < 0.0);
                        let hits = run.impacts().iter().filter(|e| e.surface == 0).count();
                        bound.keep(hits == expected, || format!("{what}: {hits} impacts"));
                    }
                    runs += 1;
                }
            }
        }
    }
    // DynamO's: free and approaching, overlapping and approaching, overlapping and receding; 1e-8 of the radius.
    for (z, v, expected) in [(1.0 + 1e-8, -1.0, Some(false)), (1.0 - 1e-8, -1.0, Some(true)), (1.0 - 1e-8, 1.0, None)] {
        let run = Stage::new(1.0).floor(smooth(1.0)).ball([0.0, 0.0, z], [0.0, 0.0, v], 1.0).run();
        let found = run.impacts().first().map(|e| e.time == 0.0);
        bound.keep(found == expected, || format!("z = {z}, v = {v}: {found:?}"));
        runs += 1;
    }
    bound.figure(format!("{runs} starts as they should be"))
}

fn overlapping_a_mesh() -> Figure {
    let mut bound = Bound::default();
    let mut runs = 0;
    let places = [("face", [2.0, 0.5]), ("diagonal", [1.0, 1.0]), ("side", [8.0, 1.0]), ("corner", [8.0, 8.0])];
    for (place, [x, y]) in places {
        for z in [0.5 - 1e-8, 0.499, 0.25, 1e-3, 1e-300, 0.0] {
            for v in [-1.0, 1.0] {
                for g in [0.0, 9.81] {
                    let (vertices, faces) = square();
                    let stage = Stage::new(2.0).down(g).mesh("square", smooth(0.5), vertices, faces);
                    let run = stage.ball([x, y, z], [0.0, 0.0, v], 0.5).run();
                    let what = format!("{place}, z {z:e}, v {v}, g {g}");
                    // With the centre in the face, to what a square does not lose, both directions lead out.
                    let within = z < 1e-200;
                    let side = if within { v } else { 1.0 };
                    let depths = depths(&run, |x| side * x.z - 0.5);
                    keep_overlap(&mut bound, &run, v < 0.0 && !within, &depths, &what);
                    keep_events_apart(&mut bound, &run, &what);
                    if g == 0.0 {
                        let expected = usize::from(v < 0.0 && !within);
                        let hits = run.events(EventKind::Impact).len();
                        bound.keep(hits == expected, || format!("{what}: {hits} impacts"));
                    }
                    runs += 1;
                }
            }
        }
    }
    bound.figure(format!("{runs} starts as they should be"))
}
