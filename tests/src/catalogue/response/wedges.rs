//! H20 and H29: wedges, to the exact number of hits and into collapse; corridors as wide as the ball.

use super::check::Check;
use crate::catalogue::{Case, Figure};
use crate::oracle::{Table, U};
use crate::stage::{Run, Stage, smooth};
use carom_dynamics::error::SceneError;
use carom_dynamics::events::{Ending, Motion};
use carom_dynamics::plan::Plan;
use nalgebra::{Point3, Vector3};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "H20",
        title: "thin wedges tan(phi) = 10^-k, e = 1",
        elsewhere: "stepping engines lose hits as soon as several fall into one step",
        bound: "the digits of pi: 3, 31, 314, 3141, 31415 hits",
        run: thin_wedges,
    },
    Case {
        id: "H20",
        title: "acute wedges with e < 1, above the angle of inelastic collapse",
        elsewhere: "hits within the time tolerance are swallowed or repeated",
        bound: "the number of hits of the two-plane velocity map",
        run: above_collapse,
    },
    Case {
        id: "H20",
        title: "inelastic collapse: infinitely many hits in a finite time",
        elsewhere: "no time-stepping loop ends: 2513 hits until the speed underflows",
        bound: "ends; outside neither plane; keeps at most the speed of the underflow of the map",
        run: collapse,
    },
    Case {
        id: "H29",
        title: "a corridor exactly as wide as the ball",
        elsewhere: "walls answer each other for ever at dt = 0",
        bound: "slides along it as if it were alone, to the bit",
        run: fitting_corridor,
    },
    Case {
        id: "H29",
        title: "a corridor narrower than the ball",
        elsewhere: "walls push the ball to and fro at dt = 0, or squeeze it out",
        bound: "refused by name down to the rounding of its width; a ball that overlaps one wall, or both of a wedge, is not",
        run: narrow_corridor,
    },
    Case {
        id: "H29",
        title: "a ball rolls into a wedge until it is stuck",
        elsewhere: "ping-pong between the walls without end",
        bound: "ends carried, within 256 events, not through a wall",
        run: narrowing_wedge,
    },
];

fn thin_wedges() -> Figure {
    let mut check = Check::new();
    let mut counts = Vec::new();
    for row in Table::read("thin_wedge_counts").rows() {
        let [m, x0, y0, speed, total, last] = row.numbers(["M", "x0", "y0", "speed", "hits_total", "t_last_hit"]);
        // One more decimal takes ten times as long.
        if total > 1e5 {
            continue;
        }
        let run = Stage::new(4.0 * last)
            .plane("A", smooth(1.0), [0.0; 3], [0.0, 1.0, 0.0])
            .plane("B", smooth(1.0), [0.0; 3], [1.0, -m, 0.0])
            .ball([x0, y0, 0.0], [-speed, 0.0, 0.0], 0.0)
            .run();
        let hits = run.impacts().len();
        check.that(hits as f64 == total, || format!("{hits} hits instead of {total}"));
        let energy = run.outcome.state.velocity.norm() / speed - 1.0;
        check.within(0.0, energy.abs(), 4.0 * U * total, || "energy".to_owned());
        counts.push(hits.to_string());
    }
    check.that(counts.len() == 5, || "wedges are missing".to_owned());
    check.figure(format!("{} hits", counts.join(", ")))
}

/// A wedge with its edge along z: one side is y = 0, the other at `angle` from it; the normals point inwards.
#[derive(Clone, Copy)]
struct Wedge([Vector3<f64>; 2]);

impl Wedge {
    fn of(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self([Vector3::y(), Vector3::new(sin, -cos, 0.0)])
    }

    fn stage(&self, duration: f64, e: f64) -> Stage {
        let [lower, upper] = self.0;
        Stage::new(duration).plane("lower", smooth(e), [0.0; 3], lower).plane("upper", smooth(e), [0.0; 3], upper)
    }

    /// How many hits a point makes that comes in with `v` and first meets the upper side; none if there are more than
    /// `most`. From a point of one side, the other is hit if and only if the velocity points at it: positions do not matter.
    fn hits(&self, mut v: Vector3<f64>, e: f64, most: usize) -> Option<usize> {
        let mut side = 1;
        for hits in 0..most {
            let n = self.0[side];
            let rate = n.dot(&v);
            if rate >= 0.0 {
                return Some(hits);
            }
            v -= n * ((1.0 + e) * rate);
            side = 1 - side;
        }
        None
    }
}

/// The angle below which a wedge with restitution `e` collapses: cos = 2 sqrt(e) / (1 + e).
fn collapse_angle(e: f64) -> f64 {
    (2.0 * e.sqrt() / (1.0 + e)).acos()
}

fn above_collapse() -> Figure {
    let mut check = Check::new();
    let mut counts = Vec::new();
    for (e, excess) in [(0.5, 1.01), (0.5, 1.001), (0.8, 1.01), (0.95, 1.05), (0.2, 1.1), (0.01, 1.001)] {
        let angle = excess * collapse_angle(e);
        let wedge = Wedge::of(angle);
        let v = Vector3::new(-1.0, 0.01, 0.0);
        let expected = wedge.hits(v, e, 10_000);
        let run = wedge.stage(1e9, e).ball([1.0, 0.5 * angle, 0.0], v, 0.0).run();
        let hits = run.impacts().len();
        check.that(expected == Some(hits), || format!("e = {e}, {excess} of the angle: {hits}, not {expected:?}"));
        counts.push(hits.to_string());
    }
    check.figure(format!("{} hits", counts.join(", ")))
}

fn collapse() -> Figure {
    let mut check = Check::new();
    let (mut most, mut fastest) = (0, 0.0);
    for (e, share) in [(0.5, 0.99), (0.5, 0.5), (0.5, 0.01), (0.9, 0.99), (0.9, 0.3), (0.1, 0.9), (0.0, 0.5)] {
        for r in [0.0, 0.01] {
            let wedge = Wedge::of(share * collapse_angle(e));
            let angle = share * collapse_angle(e);
            // In the middle of the wedge, half a metre beyond where the ball fits.
            let middle = Vector3::new((angle / 2.0).cos(), (angle / 2.0).sin(), 0.0);
            let start = middle * (0.5 + r / (angle / 2.0).sin());
            let v = Vector3::new(-1.0, 0.01, 0.0);
            let run = wedge.stage(1e6, e).ball(Point3::from(start), v, r).run();
            let place = || format!("e = {e}, {share} of the angle, r = {r}");
            check.that(run.outcome.ending == Ending::Completed, || format!("{}: {:?}", place(), run.outcome.ending));
            let outside = overlap(&run, &wedge, r);
            check.within(0.0, outside, 64.0 * U * start.norm(), || format!("{}: overlap", place()));
            let speed = run.outcome.state.velocity.norm();
            fastest = check.within(fastest, speed, 0.0, || format!("{}: speed", place()));
            most = most.max(run.impacts().len());
        }
    }
    check.figure(format!("ends after at most {most} impacts with at most {fastest:.1e} of the speed"))
}

/// How far a ball of radius `r` was beyond a side of the wedge at any event or at the end.
fn overlap(run: &Run, wedge: &Wedge, r: f64) -> f64 {
    let places = run.trajectory.events.iter().map(|e| e.position).chain([run.outcome.state.position]);
    places.flat_map(|x| wedge.0.map(|n| r - n.dot(&x.coords))).fold(0.0, f64::max)
}

fn fitting_corridor() -> Figure {
    let mut check = Check::new();
    let r = 0.25;
    for (e, across) in [(1.0, 0.0), (0.5, 0.0), (0.5, 3.0), (1.0, 3.0), (0.0, 0.125)] {
        let corridor = |width: f64| {
            Stage::new(8.0)
                .plane("left", smooth(e), [0.0; 3], [1.0, 0.0, 0.0])
                .plane("right", smooth(e), [width, 0.0, 0.0], [-1.0, 0.0, 0.0])
                .ball([r, 0.0, 0.0], [across, 2.0, 0.5], r)
        };
        let run = corridor(2.0 * r).run();
        let place = || format!("e = {e}, {across} m/s across");
        check.that(run.outcome.ending == Ending::Completed, || format!("{}: {:?}", place(), run.outcome.ending));
        check.that(run.trajectory.events.len() <= 4, || format!("{}: {:?}", place(), run.kinds()));
        let end = run.outcome.state;
        check.that(end.position == Point3::new(r, 16.0, 4.0), || format!("{}: {end:?}", place()));
        check.that(end.velocity == Vector3::new(0.0, 2.0, 0.5), || format!("{}: {end:?}", place()));
    }
    check.figure("slides 16 m at 2 m/s, whatever it had across".to_owned())
}

fn narrow_corridor() -> Figure {
    let mut check = Check::new();
    let (r, far) = (0.25, 8.0);
    let mut narrowest = f64::INFINITY;
    // From half of the ball to less than rounding, and nothing.
    let lacks: Vec<f64> = (2..=48).map(|k| 0.5f64.powi(k)).chain([0.0]).collect();
    for (axis, (k, lack)) in (0..3).flat_map(|axis| lacks.iter().enumerate().map(move |lack| (axis, lack))) {
        let unit = |i: usize| Vector3::from_fn(|j, _| f64::from(u8::from(i % 3 == j)));
        // A third direction, so that no normal is an axis.
        let normal = (unit(axis) + unit(axis + 1) * 0.5).normalize();
        let width = 2.0 * r - lack;
        let place = |share: f64| Point3::from(unit(axis + 2) * far + normal * (share * width));
        let stage = Stage::new(1.0)
            .plane("left", smooth(0.5), place(0.0), normal)
            .plane("right", smooth(0.5), place(1.0), if k.is_multiple_of(2) { -normal } else { normal })
            .ball(place(0.5), [0.25, 0.5, 1.0], r);
        let refused = Plan::new(&stage.0);
        // 64 u of the largest coordinate count as contact; what is beyond twice that is refused.
        let named =
            matches!(&refused, Err(SceneError::NoRoom { ball: 0, surfaces, .. }) if *surfaces == ["left", "right"]);
        if *lack > 128.0 * U * (far + 1.0) {
            check.that(named, || format!("{width} m: {refused:?}"));
            narrowest = narrowest.min(*lack);
        } else {
            check.that(refused.is_ok() || named, || format!("{width} m: {refused:?}"));
            check.that(*lack > 0.0 || refused.is_ok(), || format!("{width} m: {refused:?}"));
        }
    }
    let one = Stage::new(1.0).floor(smooth(0.5)).ball([0.0, 0.0, 0.5 * r], [0.0; 3], r);
    check.that(Plan::new(&one.0).is_ok(), || "overlapping one wall is refused".to_owned());
    let wedge = Wedge::of(0.1).stage(1.0, 0.5).ball([1.0, 0.05, 0.0], [0.0; 3], r);
    check.that(Plan::new(&wedge.0).is_ok(), || "overlapping both walls of a wedge is refused".to_owned());
    check.figure(format!("refused where {narrowest:.1e} m are lacking of 0.5 m"))
}

fn narrowing_wedge() -> Figure {
    let mut check = Check::new();
    let mut most = 0;
    let wedges = [(1.0f64, 0.5), (1.0, 0.9), (10.0, 0.5), (0.01, 0.0), (30.0, 0.3), (89.0, 0.7)];
    for ((degrees, e), across) in wedges.into_iter().flat_map(|w| [(w, 0.0), (w, 0.25)]) {
        let wedge = Wedge::of(degrees.to_radians());
        let half = 0.5 * degrees.to_radians();
        let r = 0.125;
        let reach = r / half.sin();
        let (x, y) = ((reach + 1.0) * half.cos(), (reach + 1.0) * half.sin());
        // Gravity along the middle of the wedge, towards its edge.
        let run = wedge
            .stage(20.0, e)
            .gravity([-9.81 * half.cos(), -9.81 * half.sin(), 0.0])
            .ball([x, y, 0.0], [across * half.sin(), -across * half.cos(), 1.0], r)
            .run();
        let place = || format!("{degrees} degrees, e = {e}, {across} m/s across");
        check.that(run.outcome.ending == Ending::Completed, || format!("{}: {:?}", place(), run.outcome.ending));
        check.that(run.outcome.motion != Motion::Flying, || format!("{}: flies at the end", place()));
        check.within(0.0, overlap(&run, &wedge, r), 64.0 * U * (reach + 20.0), || format!("{}: overlap", place()));
        most = most.max(run.trajectory.events.len());
    }
    check.that(most <= 256, || format!("{most} events"));
    check.figure(format!("at most {most} events"))
}
