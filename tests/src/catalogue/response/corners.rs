//! H19: several surfaces hit at the same instant.

use super::check::Check;
use crate::catalogue::{Case, Figure};
use crate::oracle::U;
use crate::stage::{Stage, smooth};
use carom_dynamics::events::Ending;
use nalgebra::{Point3, Vector3};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "H19",
        title: "three walls of a cube at the same instant",
        elsewhere: "only the first two of n simultaneous events fire (SciML #516)",
        bound: "v -> -e v to the bit, three impacts, in each of the 6 orders of the walls",
        run: cube_corner,
    },
    Case {
        id: "H19",
        title: "three slanted planes at the same instant",
        elsewhere: "the answer depends on the order in which the contacts are listed",
        bound: "the same bits in all 6 orders, nothing left closing, no energy gained",
        run: slanted_corners,
    },
    Case {
        id: "H19",
        title: "into the corner of a table along its diagonal, a thousand times",
        elsewhere: "the second cushion is lost and the ball leaves the table (pooltool #217)",
        bound: "on the diagonal to the bit, and on the table",
        run: table_corner,
    },
];

/// The orders of three things.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

fn cube_corner() -> Figure {
    let mut check = Check::new();
    let v = Vector3::new(-1.0, -2.0, -4.0);
    // One corner of three walls, as planes and as squares.
    let wall = |stage: Stage, axis: usize, e: f64, square: bool| {
        let corner = |along: usize, across: usize| {
            let mut p = [0.0; 3];
            (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (8.0 * along as f64, 8.0 * across as f64);
            p
        };
        let mut normal = Vector3::zeros();
        normal[axis] = 1.0;
        match square {
            true => stage.polygon(
                ["x", "y", "z"][axis],
                smooth(e),
                &[corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)],
            ),
            false => stage.plane(["x", "y", "z"][axis], smooth(e), [0.0; 3], normal),
        }
    };
    for (e, r, square) in
        [(1.0, 0.5, false), (1.0, 0.0, false), (0.5, 0.5, false), (0.3, 0.0, false), (1.0, 0.5, true), (0.5, 0.5, true)]
    {
        for order in ORDERS {
            let stage = order.iter().fold(Stage::new(1.5), |stage, axis| wall(stage, *axis, e, square));
            let run = stage.ball(Point3::new(r, r, r) - v, v, r).run();
            let impacts = run.impacts();
            check.that(impacts.len() == 3, || format!("{} impacts, e = {e}, r = {r}", impacts.len()));
            let back = run.outcome.state.velocity;
            check.that(back == -e * v, || format!("{back:?} instead of {:?}, square: {square}", -e * v));
            check.that(impacts.iter().all(|i| i.time == 1.0), || format!("not at 1 s: {impacts:?}"));
        }
    }
    check.figure("-e v to the bit, 3 impacts at 1 s, 36 runs".to_owned())
}

fn slanted_corners() -> Figure {
    let mut check = Check::new();
    let (mut corners, mut gain) = (0, 0.0);
    let mut random = Random(7);
    while corners < 300 {
        let normals = [random.direction(), random.direction(), random.direction()];
        let v = random.direction();
        // A corner that v heads into, neither a needle nor flat: near-dependent normals have no order to depend on.
        let volume = normals[0].dot(&normals[1].cross(&normals[2])).abs();
        if volume < 0.05 || normals.iter().any(|n| n.dot(&v) > -0.05) {
            continue;
        }
        let e = [1.0, 0.9, 0.5, 0.0][corners % 4];
        let mut first = None;
        for order in ORDERS {
            let name = |i: usize| ["a", "b", "c"][i];
            let stage =
                order.iter().fold(Stage::new(2.0), |stage, &i| stage.plane(name(i), smooth(e), [0.0; 3], normals[i]));
            let run = stage.ball(Point3::from(-v), v, 0.0).run();
            let after = run.outcome.state.velocity;
            let closing = normals.iter().map(|n| -n.dot(&after)).fold(0.0, f64::max);
            check.that(run.outcome.ending == Ending::Completed, || format!("{:?}", run.outcome.ending));
            check.within(0.0, closing, 128.0 * U, || format!("still closing, corner {corners}, e = {e}"));
            gain = check.within(gain, after.norm() / v.norm() - 1.0, 4.0 * U, || format!("gain, corner {corners}"));
            let events: Vec<_> = run.trajectory.events.iter().map(|i| (i.time, i.normal, i.velocity)).collect();
            let first = first.get_or_insert_with(|| (after, events.clone()));
            check.that(*first == (after, events), || format!("corner {corners} depends on the order"));
        }
        corners += 1;
    }
    check.figure(format!("{corners} corners, greatest gain of speed {gain:.1e}"))
}

fn table_corner() -> Figure {
    let mut check = Check::new();
    let (size, r) = (4.5, 0.25);
    // From the middle to a corner and back takes two sides of the inner square: 4 m at 1 m/s along each axis.
    let run = Stage::new(4000.0)
        .plane("left", smooth(1.0), [0.0; 3], [1.0, 0.0, 0.0])
        .plane("right", smooth(1.0), [size, 0.0, 0.0], [-1.0, 0.0, 0.0])
        .plane("near", smooth(1.0), [0.0; 3], [0.0, 1.0, 0.0])
        .plane("far", smooth(1.0), [0.0, size, 0.0], [0.0, -1.0, 0.0])
        .ball([size / 2.0, size / 2.0, r], [1.0, 1.0, 0.0], r)
        .run();
    let impacts = run.impacts();
    check.that(impacts.len() == 2000, || format!("{} impacts", impacts.len()));
    for pair in impacts.chunks(2) {
        let [a, b] = [pair[0], pair[1]];
        check.that(a.time == b.time && a.surface != b.surface, || format!("one cushion only at {}", a.time));
        check.that(a.position.x == a.position.y && a.velocity.x == a.velocity.y, || format!("off the diagonal: {a:?}"));
        check.that((r..=size - r).contains(&a.position.x), || format!("off the table: {a:?}"));
    }
    check.figure(format!("{} corners, all on the diagonal to the bit", impacts.len() / 2))
}

/// A small generator of directions: the same on every machine.
struct Random(u64);

impl Random {
    /// Between -1 and 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A unit vector.
    fn direction(&mut self) -> Vector3<f64> {
        loop {
            let v = Vector3::new(self.next(), self.next(), self.next());
            if (0.01..=1.0).contains(&v.norm_squared()) {
                return v.normalize();
            }
        }
    }
}
