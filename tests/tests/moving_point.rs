//! A moving point against a polygon, as the chapter has it: plane, time, place, and whether that is inside.

use carom_geometry::clearance::Entry;
use carom_geometry::contact::MovingBall;
use carom_geometry::inside::Location;
use carom_geometry::mesh::Mesh;
use carom_geometry::path::Path;
use carom_geometry::plane::Side;
use carom_geometry::polygon::Polygon;
use carom_geometry::rounding::{UNIT_ROUNDOFF, point_radius};
use carom_geometry::segment::{SegmentHit, segment_hits_triangle};
use carom_geometry::sweep::Work;
use carom_tests::random::Random;
use nalgebra::{Point3, Vector3};

/// An L in the plane z = x / 2 - y / 4, all in numbers that f64 has.
fn ell() -> Polygon {
    let lift = |[x, y]: [f64; 2]| Point3::new(x, y, 0.5 * x - 0.25 * y);
    let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
    Polygon::new(corners.map(lift).to_vec()).unwrap()
}

/// The chapter's t_hit = ((p - p_i).n) / (v_i.n), none if the point moves along the plane.
fn t_hit(polygon: &Polygon, start: &Point3<f64>, velocity: &Vector3<f64>) -> Option<f64> {
    let (p, n) = (polygon.vertices()[0], polygon.normal());
    let towards = velocity.dot(&n);
    (towards != 0.0).then(|| (p - start).dot(&n) / towards)
}

#[test]
fn r35_a_moving_point_meets_a_polygon_and_finds_its_normal() {
    let polygon = ell();
    let mesh = Mesh::from_polygon(&polygon);
    let mut random = Random::new(1);
    let (mut hits, mut beside) = (0, 0);
    for _ in 0..20_000 {
        let (start, velocity) = (random.point(5.0), random.vector(6.0));
        let path = Path::line(start, velocity);
        // The textbook's way: plane, place, projection, determinants.
        let side = polygon.plane().side_of(&start).unwrap();
        let n = polygon.normal().into_inner() * side.sign();
        let gap = polygon.plane().clearance(&start, 0.0, side);
        let entry = path.clearance(gap, &n).first_entry(0.0, 1.0);
        let textbook = entry.f().filter(|f| polygon.locate(&path.at(*f)) == Location::Inside);
        // Exactly, on the triangles; and as the loop does it, with the least ball.
        let triangles = (0..mesh.faces().len() as u32).map(|face| mesh.triangle(face));
        let exact = triangles
            .filter_map(|t| match segment_hits_triangle(&start, &path.at(1.0), &t) {
                SegmentHit::Hit { f, .. } => Some(f),
                SegmentHit::Miss => None,
            })
            .reduce(f64::min);
        let radius = point_radius(10.0);
        let ball = MovingBall { path: &path, radius, holds: &[] };
        let swept = mesh.first_contact(&ball, 1.0, |_| 0.0, &mut Work::default());
        assert_eq!(textbook.is_some(), exact.is_some(), "{start} {velocity}");
        assert_eq!(swept.is_some(), exact.is_some(), "{start} {velocity}");
        beside += u32::from(entry.f().is_some() && exact.is_none());
        let (Some(textbook), Some(exact), Some(swept)) = (textbook, exact, swept) else { continue };
        let closing = -n.dot(&velocity);
        assert!((textbook - exact).abs() * closing <= 512.0 * UNIT_ROUNDOFF * 10.0);
        assert!(swept.f <= exact && (exact - swept.f) * closing <= 1.01 * radius + 512.0 * UNIT_ROUNDOFF * 10.0);
        // The normal there faces the point.
        let touches =
            mesh.touches(&path.at(swept.f), &nalgebra::Vector3::zeros(), radius, radius, &mut Work::default());
        assert!(!touches.is_empty());
        assert!(touches.iter().all(|touch| (touch.normal - n).norm() <= 1e-3), "{touches:?} {n}");
        hits += 1;
    }
    println!("{hits} points meet the polygon, {beside} pass its plane beside it");
    assert!(hits > 200 && beside > 500);
}

#[test]
fn r40_the_plane_of_a_polygon_holds_its_vertices() {
    let polygon = ell();
    let [a, b, c, d] = polygon.plane().coefficients();
    assert!((Vector3::new(a, b, c).norm() - 1.0).abs() <= 4.0 * UNIT_ROUNDOFF);
    for v in polygon.vertices() {
        let value = a * v.x + b * v.y + c * v.z + d;
        assert!(value.abs() <= 16.0 * UNIT_ROUNDOFF * 4.0, "{v}: {value:e}");
        assert!(polygon.plane().signed_distance(v).abs() <= polygon.plane().distance_bound(v));
    }
    // z above the plane z = x/2 - y/4, measured along n = (-2, 1, 4) / sqrt(21).
    let height = polygon.plane().signed_distance(&Point3::new(1.0, 2.0, 21.0));
    assert!((height - 4.0 * 21f64.sqrt()).abs() <= 16.0 * UNIT_ROUNDOFF * 21.0, "{height}");
}

#[test]
fn r41_t_hit_is_where_the_clearance_is_used_up_and_lies_in_the_step() {
    let polygon = ell();
    let (start, velocity) = (Point3::new(0.5, 0.5, 3.125), Vector3::new(0.0, 0.0, -2.0));
    // 3 above the polygon at 2 m/s.
    assert_eq!(t_hit(&polygon, &start, &velocity).map(|t| (t * 16.0).round() / 16.0), Some(1.5));
    let gap = polygon.plane().clearance(&start, 0.0, Side::Positive);
    let n = polygon.normal();
    for (h, hits) in [(1.0, false), (1.75, true), (4.0, true)] {
        let entry = Path::line(start, velocity * h).clearance(gap, &n).first_entry(0.0, 1.0);
        assert_eq!(entry.f().is_some(), hits, "h = {h}");
        if let (Some(f), Some(t)) = (entry.f(), t_hit(&polygon, &start, &velocity)) {
            assert!((f * h - t).abs() <= 8.0 * UNIT_ROUNDOFF * t, "f h = {}, t = {t}", f * h);
        }
    }
    // Away from the plane and along it there is none.
    for v in [-velocity, Vector3::new(2.0, 0.0, 1.0)] {
        assert_eq!(Path::line(start, v).clearance(gap, &n).first_entry(0.0, 1.0), Entry::Never);
    }
    // The ends of the step. A contact at its start is one only while closing; one at its end belongs to the next step if `to` is the
    // last number below 1, which makes the interval the chapter's half-open one.
    let floor = |gap: f64, rate: f64, to: f64| {
        Path::line(Point3::origin(), Vector3::z() * rate).clearance(gap, &Vector3::z()).first_entry(0.0, to).f()
    };
    assert_eq!(floor(0.0, -2.0, 1.0), Some(0.0));
    assert_eq!(floor(0.0, 2.0, 1.0), None);
    assert_eq!(floor(2.0, -2.0, 1.0), Some(1.0));
    assert_eq!(floor(2.0, -2.0, 1f64.next_down()), None);
}

#[test]
fn r42_x_hit_is_the_start_moved_by_t_hit_times_the_velocity() {
    let polygon = ell();
    let mut random = Random::new(2);
    let mut hits = 0;
    for _ in 0..2000 {
        let (start, velocity) = (random.point(5.0), random.vector(6.0));
        let side = polygon.plane().side_of(&start).unwrap();
        let gap = polygon.plane().clearance(&start, 0.0, side);
        let path = Path::line(start, velocity);
        let Some(f) = path.clearance(gap, &(polygon.normal().into_inner() * side.sign())).first_entry(0.0, 1.0).f()
        else {
            continue;
        };
        let t = t_hit(&polygon, &start, &velocity).unwrap();
        let x_hit = start + velocity * t;
        assert!((path.at(f) - x_hit).norm() <= 16.0 * UNIT_ROUNDOFF * (velocity.norm() * t + 10.0));
        assert!(polygon.plane().signed_distance(&path.at(f)).abs() <= 32.0 * UNIT_ROUNDOFF * 20.0);
        hits += 1;
    }
    assert!(hits > 200);
}
