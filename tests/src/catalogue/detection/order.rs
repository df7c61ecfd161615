//! H15 to H17: large balls, contacts behind the first root, and which of many hits comes first.

use super::super::{Bound, Case, Figure};
use super::rows::{Tally, rows};
use super::start::keep_events_apart;
use crate::random::Random;
use crate::stage::{Stage, smooth};
use carom_geometry::rounding::UNIT_ROUNDOFF;
use nalgebra::{Point3, Vector3};

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case {
            id: "H15",
            title: "a ball of 5 m over a triangle of 1 mm",
            elsewhere: "tests that ask for the centre's projection miss it",
            bound: "none missed, none late, none answered farther than 8 u L from touching",
            run: large_balls,
        },
        Case {
            id: "H16",
            title: "up and over: the first root lies beyond the edge, the second counts",
            elsewhere: "DynamO's parabola_rod tests the first root only: 23 of 25 such contacts missed",
            bound: "none missed, none late, none answered farther than 8 u L from touching",
            run: up_and_over,
        },
        Case {
            id: "H17",
            title: "fast, ordinary and tiny flights onto a triangle",
            elsewhere: "PhysX #505 and others lose the right one of several roots",
            bound: "none missed, none late, none answered farther than 8 u L from touching",
            run: ordinary_flights,
        },
        Case {
            id: "H17",
            title: "a graze of the floor's rim, then the wall",
            elsewhere: "PhysX #505: the graze is discarded after it was chosen, the wall is lost with it",
            bound: "the rim at 0.198237290593525 s, then the wall in time; nothing behind the wall",
            run: graze_then_wall,
        },
        Case {
            id: "H17",
            title: "receding from what is nearest, closing on what is next",
            elsewhere: "the nearest is chosen, found to recede, and the step goes on without the next",
            bound: "only the wall is answered, at its time to 4 u",
            run: receding_from_the_nearest,
        },
    ]
}

fn tally(categories: &[&str]) -> Figure {
    let mut bound = Bound::default();
    let tally = Tally::of(&rows(categories), 8.0, &mut bound);
    bound.keep(tally.missed.is_empty(), || format!("missed {:?}", tally.missed));
    bound.figure(tally.text())
}

fn large_balls() -> Figure {
    tally(&["radius_gt_feature"])
}

fn up_and_over() -> Figure {
    tally(&["rod_reentry"])
}

fn ordinary_flights() -> Figure {
    tally(&["line_random", "parabola_random", "fast", "aim_edge_vertex", "tiny_1e-9"])
}

fn graze_then_wall() -> Figure {
    let mut bound = Bound::default();
    let floor = [[-5.0, 0.0, -5.0], [-5.0, 0.0, 5.0], [0.0, 0.0, 5.0], [0.0, 0.0, -5.0]];
    let wall = [[1.0, -5.0, -5.0], [1.0, 5.0, -5.0], [1.0, 5.0, 5.0], [1.0, -5.0, 5.0]];
    let mut texts = Vec::new();
    for c_r in [0.0, 0.5, 1.0] {
        let stage = Stage::new(1.0).polygon("floor", smooth(c_r), &floor).polygon("wall", smooth(c_r), &wall);
        let (start, velocity, r) = (Point3::new(-0.78131, 0.3092001, 0.0), Vector3::new(4.0, -0.3, 0.0), 0.25);
        let run = stage.ball(start, velocity, r).run();
        let impacts = run.impacts();
        let Some([rim, hit]) = impacts.get(..2).and_then(|two| <[_; 2]>::try_from(two).ok()) else {
            bound.keep(false, || format!("c_r {c_r}: {} impacts", impacts.len()));
            continue;
        };
        bound.keep((rim.time - 0.198_237_290_593_525_24).abs() <= 64.0 * UNIT_ROUNDOFF, || {
            format!("c_r {c_r}: rim at {}", rim.time)
        });
        // Turned by the rim, it goes on to the wall in a straight line.
        let expected = rim.time + (1.0 - r - rim.position.x) / rim.velocity.x;
        bound.keep(hit.surface == 1 && (hit.time - expected).abs() <= 64.0 * UNIT_ROUNDOFF, || {
            format!("c_r {c_r}: then {hit:?}")
        });
        bound.keep(
            run.trajectory.segments.iter().all(|s| s.step.at(s.to).position.x <= 0.75 + 64.0 * UNIT_ROUNDOFF),
            || "through".into(),
        );
        texts.push(format!("{:.6}", hit.time));
        // An ulp higher it clears the rim by its touch, and the wall comes at 0.3828275.
        let stage = Stage::new(1.0).polygon("floor", smooth(c_r), &floor).polygon("wall", smooth(c_r), &wall);
        let run = stage.ball(start + Vector3::new(0.0, 2e-3, 0.0), velocity, r).run();
        let first = run.impacts().first().map(|e| (e.surface, e.time));
        let straight = (1.0 - r - start.x) / velocity.x;
        bound.keep(first.is_some_and(|(s, t)| s == 1 && (t - straight).abs() <= 4.0 * UNIT_ROUNDOFF), || {
            format!("above the rim: {first:?}")
        });
    }
    bound.figure(format!("rim, then wall at {} s for c_r 0, 1/2, 1", texts.join(", ")))
}

fn receding_from_the_nearest() -> Figure {
    let mut random = Random::new(0x175);
    let mut bound = Bound::default();
    let count = 300;
    for k in 0..count {
        let r = 0.5;
        // Touching or overlapping the floor, on the way up, and to the wall; as planes and as a mesh.
        let overlap = [0.0, 1e-12, 0.1, 0.3][k % 4];
        let (v, up) = (random.octave(-2, 4), random.octave(-2, 2));
        let stage = Stage::new(4.0 / v);
        let stage = if k % 2 == 0 {
            stage.floor(smooth(1.0)).plane("wall", smooth(1.0), [3.0, 0.0, 0.0], [-1.0, 0.0, 0.0])
        } else {
            let corner = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
            let vertices =
                vec![corner(-9.0, -9.0, 0.0), corner(9.0, -9.0, 0.0), corner(9.0, 9.0, 0.0), corner(-9.0, 9.0, 0.0)];
            let wall = [[3.0, -9.0, -9.0], [3.0, 9.0, -9.0], [3.0, 9.0, 9.0 + 9.0 * up], [3.0, -9.0, 9.0 + 9.0 * up]];
            stage.mesh("floor", smooth(1.0), vertices, vec![[0, 1, 2], [0, 2, 3]]).polygon("wall", smooth(1.0), &wall)
        };
        let run = stage.ball([0.0, 0.0, r - overlap], [v, 0.0, up * v], r).run();
        let what = format!("overlap {overlap:e}, v {v}, up {up}, mesh {}", k % 2);
        keep_events_apart(&mut bound, &run, &what);
        let events = &run.trajectory.events;
        bound.keep(events.len() == 1 && events[0].surface == 1, || format!("{what}: {} events", events.len()));
        let expected = 2.5 / v;
        let on_time = events.first().is_some_and(|e| (e.time - expected).abs() <= 4.0 * UNIT_ROUNDOFF * expected);
        bound.keep(on_time, || format!("{what}: {:?}", events.first().map(|e| e.time)));
    }
    bound.figure(format!("{count} starts: the wall alone is answered, in time"))
}
