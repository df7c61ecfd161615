//! The bounds that events carry, held against exact times: never less than the error, and not much more than rounding.

use carom_dynamics::body::Ball;
use carom_dynamics::effects::drag::Drag;
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::grip::Grip;
use carom_dynamics::events::{Bound, Ending, Event, EventKind};
use carom_geometry::rounding::{UNIT_ROUNDOFF, point_radius};
use carom_tests::data::{csv, number};
use carom_tests::oracle::{Table, Worst};
use carom_tests::stage::{Run, Stage, coulomb, rough, smooth};
use nalgebra::{Point3, Vector3};

#[test]
fn r26_impacts_on_a_plane_are_within_their_bounds() {
    let rows = csv("oracles/toi_quadratic.csv", "d0,vn,an,t_first_approaching_root,vn_at_hit");
    let mut times = Worst::of("times of impact on a plane");
    let mut places = Worst::of("places of impact on a plane");
    let mut silent = 0;
    for row in rows.iter().filter(|row| row[3] != "none") {
        let [d0, vn, an, t, speed] = [0, 1, 2, 3, 4].map(|i| number(&row[i]));
        // What the door refuses, or what is no scene: numbers at the ends of the range.
        if an.abs() > 1e100 || (0.0 < d0 && d0 < 1e-200) {
            continue;
        }
        let ball = ([0.0, 0.0, d0], [3.0, 0.0, vn]);
        let run = Stage::new(2.0 * t).gravity([0.0, 0.0, an]).floor(smooth(0.5)).ball(ball.0, ball.1, 0.0).run();
        let Some(impact) = run.impacts().first().copied() else {
            silent += 1;
            continue;
        };
        let bound = impact.bound.expect("an impact has a bound");
        times.see(impact.time, t, bound.time, || format!("{row:?}"));
        places.see(impact.position.z, 0.0, bound.position, || format!("{row:?}"));
        places.see(impact.position.x, 3.0 * t, bound.position, || format!("{row:?}"));
        let way = d0 + vn.abs() * t + 0.5 * an.abs() * t * t + 3.0 * t;
        let rounding = 1024.0 * UNIT_ROUNDOFF * way;
        let graze = speed * speed < 8.0 * an.abs() * rounding;
        assert!(graze || bound.time * speed.abs() <= rounding * (1.0 + speed.abs()), "{row:?}: {bound:?}");
    }
    // The one that touches without closing is no impact.
    assert!(silent <= 1, "{silent} rows without an impact");
    Worst::settle_all([times, places]);
}

#[test]
fn r26_impacts_at_edges_and_vertices_are_within_their_bounds_down_to_grazes() {
    let header = "radius,distance_along,offset_b,speed,result,t_hit,n_along,n_across";
    let rows = csv("oracles/toi_grazing.csv", header);
    let vertex = [Point3::origin(), Point3::new(1.0, -2.0, 0.5), Point3::new(2.0, -1.0, -0.25)];
    let edge = [Point3::new(0.0, 0.0, -1.0), Point3::new(0.0, 0.0, 1.0), Point3::new(1.0, -1.0, 0.0)];
    let mut times = Worst::of("times of impact at edges and vertices");
    let mut compared = 0;
    for row in rows.iter().filter(|row| row[4] == "hit") {
        let [radius, along, offset, speed, t] = [0, 1, 2, 3, 5].map(|i| number(&row[i]));
        for triangle in [&vertex, &edge] {
            let (x, v) = (Point3::new(-along, offset, 0.0), Vector3::new(speed, 0.0, 0.0));
            let stage = Stage::new(8.0).mesh("triangle", smooth(0.5), triangle.to_vec(), vec![[0, 1, 2]]);
            let run = stage.ball(x, v, radius).run();
            // The last few graze within rounding, where a miss is right as well.
            let Some(impact) = run.impacts().first().copied() else { continue };
            let bound = impact.bound.expect("an impact has a bound");
            times.see(impact.time, t, bound.time, || format!("{row:?}"));
            assert!(bound.time < 1e-5, "{row:?}: {bound:?}");
            compared += 1;
        }
    }
    assert!(compared >= 30, "only {compared} hits");
    times.settle();
}

/// The only event of a kind, and its bound.
fn only(run: &Run, kind: EventKind) -> (Event, Bound) {
    let [event] = run.events(kind)[..] else { panic!("{:?}", run.kinds()) };
    (event, event.bound.unwrap_or_else(|| panic!("no bound: {event:?}")))
}

#[test]
fn r26_the_ends_of_sliding_are_within_their_bounds() {
    let mut times = Worst::of("times at the ends of sliding");
    let mut places = Worst::of("places at the ends of sliding");
    let mut see = |(event, bound): (Event, Bound), t: f64, x: f64, v: f64, place: &str| {
        // What the closed form itself is rounded by.
        let rounding = 8.0 * UNIT_ROUNDOFF;
        times.see(event.time, t, bound.time + rounding * t, || place.to_owned());
        places.see(event.position.x, x, bound.position + rounding * x, || place.to_owned());
        assert!(bound.time <= 1024.0 * UNIT_ROUNDOFF * (t + 1.0 / v), "{place}: {bound:?}");
        assert!(bound.position <= 1024.0 * UNIT_ROUNDOFF * (x + 64.0), "{place}: {bound:?}");
    };
    for (v, mu, g) in [(0.7, 0.3, 9.81), (12.3, 0.05, 1.62), (1e-3, 0.9, 24.79), (3.0, 0.5, 8.0)] {
        // To a stop, in v / mu g on v^2 / 2 mu g.
        let (t, x) = (v / (mu * g), v * v / (2.0 * (mu * g)));
        let run = Stage::new(2.0 * t).down(g).floor(rough(0.5, coulomb(mu))).ball([0.0; 3], [v, 0.0, 0.0], 0.0).run();
        see(only(&run, EventKind::Rest), t, x, v, &format!("stop from {v} under {mu} of {g}"));
        // Over the edge of a table, on half of that way: in t / (2 + sqrt 2), and without friction at v.
        let edge = 0.5 * x;
        let table = [[edge, -1.0, 0.0], [edge, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]];
        for (friction, t) in [(coulomb(mu), t / (2.0 + 2f64.sqrt())), (Friction::None, edge / v)] {
            let run = Stage::new(2.0 * t).down(g).polygon("table", rough(0.5, friction), &table);
            let run = run.ball([0.0; 3], [v, 0.0, 0.0], 0.0).run();
            see(only(&run, EventKind::Leave), t, edge, v, &format!("off the table from {v} under {friction:?} of {g}"));
        }
    }
    let table = Table::read("slide_to_roll");
    for row in table.rows() {
        let [alpha, mu, v0, r_omega0, g] = row.numbers(["alpha", "mu", "v0", "r_omega0", "g"]);
        let [t, x] = row.numbers(["t_slip_ends", "x_slip"]);
        let grips = rough(0.5, Friction::Grip(Grip::new(mu).unwrap()));
        let ball = Ball::new(Point3::new(0.0, 0.0, 0.1), Vector3::new(v0, 0.0, 0.0), 0.1, None).unwrap();
        let ball = ball.spinning(Vector3::y() * (r_omega0 / 0.1)).unwrap().with_inertia(alpha).unwrap();
        let mut stage = Stage::new(2.0 * t).down(g).floor(grips);
        stage.0.balls.push(ball);
        see(only(&stage.run(), EventKind::Roll), t, x, v0.max(1.0), &format!("rolls from {v0} and {r_omega0}"));
    }
    Worst::settle_all([times, places]);
}

#[test]
fn r26_the_end_of_bouncing_is_within_its_bound_and_the_rounding_of_its_hops() {
    let mut times = Worst::of("times at which bouncing ends");
    for (h, e, g) in [(2.0f64, 0.5, 9.81), (0.3, 0.8, 1.62), (1.0, 0.25, 8.0)] {
        // sqrt(2 h / g) (1 + e) / (1 - e), of hops that each keep a few units of the time that went before.
        let t = (2.0 * h / g).sqrt() * (1.0 + e) / (1.0 - e);
        let run = Stage::new(2.0 * t).down(g).floor(smooth(e)).ball([0.0, 0.0, h], [1.0, 0.0, 0.0], 0.0).run();
        let (slide, bound) = only(&run, EventKind::Slide);
        let hops = run.impacts().len() as f64;
        times.see(slide.time, t, bound.time + 8.0 * hops * UNIT_ROUNDOFF * t, || format!("{h} m, {e}, {g}"));
        assert!(bound.time <= 64.0 * UNIT_ROUNDOFF * t, "{bound:?}");
    }
    times.settle();
    // Without bouncing it is the impact itself, and its bound.
    let run = Stage::new(2.0).down(8.0).floor(smooth(0.0)).ball([0.0, 0.0, 4.0], [1.0, 0.0, 0.0], 0.0).run();
    let [impact, slide] = run.trajectory.events[..] else { panic!("{:?}", run.kinds()) };
    assert_eq!((slide.kind, slide.time, slide.bound), (EventKind::Slide, impact.time, impact.bound));
}

#[test]
fn r26_what_no_equation_was_solved_for_has_no_bound() {
    // Around the edge of a table and off it where nothing presses it any more, on an integrated way.
    let table = [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]];
    let stage = Stage::new(2.0).down(10.0).polygon("table", smooth(0.5), &table);
    let run = stage.ball([-0.5, 0.0, 0.5], [1.0, 0.0, 0.0], 0.5).run();
    assert_eq!(run.kinds(), [EventKind::Slide, EventKind::Leave]);
    let [slide, leave] = [run.trajectory.events[0], run.trajectory.events[1]];
    // It begins where it is laid; it is round by arccos((2 g r + v^2) / 3 g r) = arccos(11 / 15).
    assert_eq!((slide.time, slide.bound.map(|bound| bound.time)), (0.0, Some(0.0)));
    assert!((leave.normal.z - 11.0 / 15.0).abs() < 1e-9 && leave.bound.is_none(), "{leave:?}");
    // To rest in the air, at the end of a step by which it is slow enough; and where a guard ends it.
    let air = Stage::new(100.0).down(10.0).drag(Drag::linear(1.0).unwrap()).floor(rough(0.0, coulomb(0.25)));
    let run = air.thing([0.0; 3], [1.0, 0.0, 0.0], 0.0, Some(1.0)).run();
    let rest = run.events(EventKind::Rest);
    assert!(rest.len() == 1 && rest[0].bound.is_none(), "{:?}", run.kinds());
}

#[test]
fn r15_a_point_that_starts_on_a_table_lies_on_it_however_that_is_wound() {
    let corners = [[0.5, -1.0, 0.0], [0.5, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]];
    let wound = [corners, [corners[3], corners[2], corners[1], corners[0]]];
    for table in wound {
        for friction in [Friction::None, coulomb(0.25)] {
            for v in [[0.0, 0.0, 0.0], [1.9, 0.0, 0.0], [3.0, 0.1, 0.0], [-12.3, 0.5, 0.0]] {
                let stage = Stage::new(2.0).down(9.81).polygon("table", rough(0.5, friction), &table);
                let run = stage.ball([0.0; 3], v, 0.0).run();
                let name = format!("{v:?} under {friction:?}: {:?}", run.kinds());
                assert_eq!(run.outcome.ending, Ending::Completed, "{name}");
                let event = run.trajectory.events.first().unwrap_or_else(|| panic!("{name}"));
                assert_eq!((event.time, event.normal), (0.0, Vector3::z()), "{name}");
                assert!(event.position.coords.norm() <= point_radius(2.0), "{name}: {}", event.position);
                let leaves = v[0] != 0.0;
                assert_eq!(run.events(EventKind::Leave).len(), usize::from(leaves), "{name}");
                let falls = run.outcome.state.position.z < -1.0;
                assert_eq!(falls, leaves, "{name}: {}", run.outcome.state.position);
            }
        }
        // What moves through it from there does, and what moves off it is not held.
        for (g, v, z) in [(0.0, -1.0, -2.0), (0.0, 1.0, 2.0), (1.0, -1.0, -4.0)] {
            let stage = Stage::new(2.0).down(g).polygon("table", smooth(0.5), &table);
            let run = stage.ball([0.0; 3], [0.0, 0.0, v], 0.0).run();
            assert!((run.outcome.state.position.z - z).abs() <= 2.0 * point_radius(2.0) && run.kinds().is_empty());
        }
    }
}
