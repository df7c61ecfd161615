//! The bounds that impacts carry, held against exact times: never less than the error, and not much more than rounding.

use carom_geometry::rounding::UNIT_ROUNDOFF;
use carom_tests::data::{csv, number};
use carom_tests::oracle::Worst;
use carom_tests::stage::{Stage, smooth};
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
