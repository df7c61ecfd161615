//! What other engines got wrong, as far as it is geometry: the cases of `engine_regressions.csv`, each under its id.

use carom_geometry::clearance::Clearance;
use carom_geometry::closest::{Feature, closest_point};
use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::mesh::Mesh;
use carom_geometry::path::Path;
use carom_geometry::predicates::{Sign, orient2d};
use carom_geometry::rounding::{UNIT_ROUNDOFF, contact_bound, contact_doubt};
use carom_geometry::segment::{SegmentHit, segment_hits_triangle};
use carom_geometry::sweep::Work;
use carom_tests::data::{csv, number, read};
use carom_tests::obj;
use carom_tests::random::Random;
use nalgebra::{Point2, Point3, Vector3};
use std::collections::BTreeSet;

const GEOMETRY: [&str; 19] = [
    "parry123",
    "parry19",
    "parry35",
    "parry242",
    "parry_fuzz",
    "parry429",
    "parry444",
    "parry171",
    "parry310",
    "physx597",
    "physx505",
    "physx600",
    "physx501",
    "jolt886",
    "jolt1383",
    "dynbill173",
    "adaptive4",
    "oblik2146",
    "vkcts446",
];

/// The cases that need a response, a rest or an integrator.
const DYNAMICS: [&str; 15] = [
    "physx351",
    "jolt1286",
    "jolt1155",
    "rapier97",
    "rapier974",
    "rapier95",
    "rapier993",
    "bullet1530",
    "bullet3094",
    "box2d501",
    "pooltool217",
    "sciml138",
    "sciml696",
    "sciml516",
    "om16009",
];

#[test]
fn every_case_is_here_or_is_dynamics() {
    let text = read("geometry-cases/engine_regressions.csv");
    let ids: BTreeSet<&str> = text.lines().skip(1).filter_map(|line| line.split(',').next()).collect();
    assert_eq!(ids, GEOMETRY.into_iter().chain(DYNAMICS).collect());
    let tests = include_str!("engine_regressions.rs");
    for id in GEOMETRY {
        assert!(tests.contains(&format!("\nfn {id}_")), "{id} has no test");
    }
}

fn p(x: f64, y: f64, z: f64) -> Point3<f64> {
    Point3::new(x, y, z)
}

fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

/// The first contact of a ball that flies straight for a time of `to`.
fn cast(start: Point3<f64>, velocity: Vector3<f64>, radius: f64, to: f64, triangle: &[Point3<f64>; 3]) -> Contact {
    let path = Path::line(start, velocity);
    first_contact(&MovingBall { path: &path, radius, holds: &[] }, triangle, 0.0, to, &mut 0)
}

/// The time of the contact; fails on a miss.
#[track_caller]
fn time(contact: Contact) -> f64 {
    match contact {
        Contact::At { f, .. } => f,
        Contact::Miss => panic!("missed"),
    }
}

/// Two triangles over a square in the plane z = 0, with the diagonal from (-half, -half) to (half, half).
fn square(half: f64) -> [[Point3<f64>; 3]; 2] {
    let [a, b, c, d] = [p(-half, -half, 0.0), p(half, -half, 0.0), p(half, half, 0.0), p(-half, half, 0.0)];
    [[a, b, c], [a, c, d]]
}

fn hit(from: Point3<f64>, to: Point3<f64>, triangle: &[Point3<f64>; 3]) -> Option<(f64, Feature)> {
    match segment_hits_triangle(&from, &to, triangle) {
        SegmentHit::Hit { f, feature, .. } => Some((f, feature)),
        SegmentHit::Miss => None,
    }
}

#[test]
fn parry123_a_subnormal_velocity_ends_in_a_miss() {
    let triangle = [p(12.0, 5.0, 0.0), p(11.0, 5.0, 0.0), p(11.0, 6.0, 0.0)];
    assert_eq!(cast(Point3::origin(), v(0.0, 6.925e-42, 0.0), 0.375, f64::MAX, &triangle), Contact::Miss);
    assert_eq!(cast(Point3::origin(), v(0.0, f64::from_bits(7), 0.0), 0.375, f64::MAX, &triangle), Contact::Miss);
}

#[test]
fn parry19_a_ball_meets_a_segment() {
    let (a, b) = (p(1.0, -1.0, 0.0), p(1.0, 1.0, 0.0));
    for segment in [[a, b, b], [a, a, b], [a, p(1.0, 0.25, 0.0), b]] {
        let t = time(cast(Point3::origin(), v(1.0, 0.0, 0.0), 0.5, 2.0, &segment));
        assert!(t <= 0.5 && 0.5 - t <= contact_doubt(3.0), "{t}");
    }
}

#[test]
fn parry35_two_balls_meet_when_their_gap_is_used_up() {
    // Radii of 0.5 each, centres 10 apart, at 10 m/s: as one ball of radius 1 and a point.
    assert_eq!(Clearance::new([10.0 - 1.0, -10.0, 0.0, 0.0, 0.0]).first_entry(0.0, 1.0).f(), Some(0.9));
    let point = [p(10.0, 0.0, 0.0); 3];
    let t = time(cast(Point3::origin(), v(10.0, 0.0, 0.0), 1.0, 1.0, &point));
    assert!(t <= 0.9 && (0.9 - t) * 10.0 <= contact_doubt(20.0), "{t}");
}

/// The cube [-1, 1]^3: twelve triangles with their normals outwards.
fn cube() -> Vec<[Point3<f64>; 3]> {
    let corner =
        |k: u32| p(2.0 * f64::from(k & 1) - 1.0, 2.0 * f64::from(k >> 1 & 1) - 1.0, 2.0 * f64::from(k >> 2) - 1.0);
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    squares.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(corner)).collect()
}

#[test]
fn parry242_a_ray_into_a_cube_comes_from_outside_and_does_not_meet_it_on_the_way_back() {
    let (cube, mut random, mut hits) = (cube(), Random::new(242), 0);
    for _ in 0..1000 {
        let start = p(0.0, 0.0, 0.0) + random.vector(1.0).normalize() * 4.0;
        let to = start + (random.point(1.1) - start) * 2.0;
        let Some((f, face)) = cube
            .iter()
            .enumerate()
            .filter_map(|(i, t)| Some((hit(start, to, t)?.0, i)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
        else {
            continue;
        };
        hits += 1;
        let [a, b, c] = cube[face];
        let normal = (b - a).cross(&(c - a)).normalize();
        let place = start + (to - start) * f;
        let is_inside = |x: Point3<f64>| x.coords.amax() < 1.0;
        assert!(!is_inside(place + normal * 0.001) && is_inside(place - normal * 0.001), "{start} {to}");
        let back = (place + normal * 0.001, place + normal * 5.0);
        assert!(cube.iter().all(|t| hit(back.0, back.1, t).is_none()), "{start} {to}");
    }
    assert!(hits > 500);
}

#[test]
fn parry_fuzz_rays_across_a_corner_meet_the_front() {
    // The sides x = 1 and y = 1 of the square [1, 2]^2, upright.
    let upright = |x0: f64, y0: f64, x1: f64, y1: f64| {
        let [a, b, c, d] = [p(x0, y0, -1.0), p(x1, y1, -1.0), p(x1, y1, 1.0), p(x0, y0, 1.0)];
        [[a, b, c], [a, c, d]]
    };
    let [left, bottom, right, top] = [
        upright(1.0, 1.0, 1.0, 2.0),
        upright(1.0, 1.0, 2.0, 1.0),
        upright(2.0, 1.0, 2.0, 2.0),
        upright(1.0, 2.0, 2.0, 2.0),
    ];
    for i in 0..10_000 {
        let start = p(3.0, 1.0 + f64::from(i) * 1e-4, 0.0);
        let to = start + (p(0.0, 2.0, 0.0) - start) * 3.0;
        let first = |sides: &[[[Point3<f64>; 3]; 2]]| {
            sides.iter().flatten().filter_map(|t| Some(hit(start, to, t)?.0)).reduce(f64::min)
        };
        // From (3, 1) to (3, 2) towards (0, 2): the side x = 2 is always met first, between a third of the way and the corner.
        let (front, all) = (first(&[right]), first(&[left, bottom, right, top]));
        assert!(front.is_some() && front == all, "i = {i}");
        assert!(front.is_some_and(|f| (f * 9.0 - 1.0).abs() <= 256.0 * UNIT_ROUNDOFF * 9.0), "{front:?}");
    }
}

#[test]
fn parry429_the_time_does_not_depend_on_the_size_of_the_face() {
    let (radius, height, speed) = (0.5166, 7.25, 3.0);
    let want = (height - radius) / speed;
    for k in 0..13 {
        let half = 5.0 * 10f64.powi(k);
        let faces = square(half);
        for (x, y) in [(0.0, 0.0), (0.3, 0.1), (-1.7, 2.9)] {
            let contacts = faces.iter().map(|face| cast(p(x, y, height), v(0.0, 0.0, -speed), radius, 100.0, face));
            let first = contacts.filter(|contact| *contact != Contact::Miss).map(time).fold(f64::INFINITY, f64::min);
            // Beside the diagonal the other face may be met in doubt, as an edge, and doubt grows with the numbers.
            let alone = f64::abs(x - y) > 2.0 * radius;
            let doubt = if alone { 4.0 * UNIT_ROUNDOFF * want } else { contact_doubt(half + 20.0) / speed };
            assert!(
                first - want <= 4.0 * UNIT_ROUNDOFF * want && want - first <= doubt,
                "5e{k} m: {first} instead of {want}"
            );
        }
    }
}

#[test]
fn parry444_no_ray_gets_out_of_the_bunny() {
    let (vertices, faces) = obj::read(include_str!("../../crates/app/scenes/meshes/low_poly_bunny.obj"));
    let mesh = Mesh::new(vertices, faces).unwrap();
    let triangles: Vec<_> = (0..mesh.faces().len() as u32).map(|face| mesh.triangle(face)).collect();
    let inside = mesh.bounds().centre();
    let crossings = |to: &Point3<f64>| triangles.iter().filter(|t| hit(inside, *to, t).is_some()).count();
    // An odd number of crossings on a way out in general position: the point is inside.
    assert_eq!(crossings(&(inside + v(13.1, 7.3, -29.7))) % 2, 1);
    // At every vertex and at points of every edge.
    let ends = |edge: carom_geometry::mesh::Edge| edge.vertices.map(|i| mesh.vertices()[i as usize]);
    let on_edges = mesh.edges().flat_map(|edge| (1..4).map(move |k| (edge, f64::from(k) / 4.0)));
    let targets = mesh.vertices().iter().copied().chain(on_edges.map(|(edge, s)| {
        let [a, b] = ends(edge);
        a + (b - a) * s
    }));
    let mut rays = 0;
    for target in targets {
        assert!(crossings(&(inside + (target - inside) * 100.0)) > 0, "out through {target}");
        rays += 1;
    }
    assert_eq!(rays, 348 + 2 + 3 * 1044);
}

#[test]
fn parry171_a_ray_that_touches_a_ridge_meets_its_edge() {
    let (a, b) = (p(0.0, -1.0, 1.0), p(0.0, 1.0, 1.0));
    let roof = [[a, b, p(-1.0, 0.0, 0.0)], [b, a, p(1.0, 0.0, 0.0)]];
    for slope in roof {
        assert!(matches!(hit(p(-3.0, 0.25, 1.0), p(3.0, 0.25, 1.0), &slope), Some((f, Feature::Edge(0))) if f <= 0.5));
    }
    let above = 1f64.next_up();
    assert!(roof.iter().all(|slope| hit(p(-3.0, 0.25, above), p(3.0, 0.25, above), slope).is_none()));
}

#[test]
fn parry310_a_triangle_with_two_equal_corners_gives_numbers() {
    let triangle = [p(40.0, 0.0, 0.0), p(0.0, 80.0, 0.0), p(0.0, 80.0, 0.0)];
    for x in [p(0.0, 0.0, 0.0), p(20.0, 40.0, 0.0), p(0.0, 80.0, 0.0), p(20.0, 40.0, 3.0)] {
        let closest = closest_point(&triangle, &x);
        assert!(closest.point.iter().chain(closest.offset.iter()).all(|c| c.is_finite()), "{closest:?}");
    }
    let t = time(cast(p(20.0, 40.0, 3.0), v(0.0, 0.0, -1.0), 0.5, 10.0, &triangle));
    assert!(t <= 2.5 && 2.5 - t <= contact_doubt(100.0), "{t}");
    assert_eq!(hit(p(20.0, 40.0, 3.0), p(20.0, 40.0, -1.0), &triangle).map(|(f, _)| f), Some(0.75));
}

/// The rows of a category of the exact table, as contact and exact bracket.
fn exact_cases(category: &str) -> Vec<(Contact, Option<(f64, f64)>)> {
    let text = read("geometry-cases/ball_vs_triangle_exact.csv");
    let rows = csv("geometry-cases/ball_vs_triangle_exact.csv", text.lines().next().unwrap_or_default());
    let of_category = rows.iter().filter(|row| row[1] == category);
    let case = |row: &Vec<String>| {
        let n = |i: usize| number(&row[i]);
        let triangle = [p(n(12), n(13), n(14)), p(n(15), n(16), n(17)), p(n(18), n(19), n(20))];
        let contact = cast(p(n(2), n(3), n(4)), v(n(5), n(6), n(7)), n(11), n(21), &triangle);
        (contact, (row[23] == "1").then(|| (n(24), n(25))))
    };
    of_category.map(case).collect()
}

#[test]
fn physx597_a_ball_meets_the_edge() {
    let [(contact, Some((low, high)))] = exact_cases("physx597")[..] else { panic!("one hit") };
    assert!(matches!(contact, Contact::At { feature: Feature::Edge(1), .. }));
    // To the rounding of coordinates of 80 m that move by 0.15 m a second.
    let late = (time(contact) - high) * 0.15;
    assert!(late <= contact_bound(81.0) && low - time(contact) <= 1e-12, "{contact:?}");
}

#[test]
fn physx505_a_graze_hides_no_wall_behind_it() {
    let (start, velocity, radius) = (p(-0.78131, 0.3092001, 0.0), v(4.0, -0.3, 0.0), 0.25);
    let floor = [p(0.0, 0.0, -5.0), p(0.0, 0.0, 5.0), p(-9.0, 0.0, 0.0)];
    let wall = [p(1.0, -9.0, -9.0), p(1.0, 9.0, 0.0), p(1.0, -9.0, 9.0)];
    let graze = time(cast(start, velocity, radius, 1.0, &floor));
    assert!((graze - 0.198237290593525).abs() <= 1e-12, "{graze}");
    let stop = time(cast(start, velocity, radius, 1.0, &wall));
    assert!((stop - 0.3828275).abs() <= 4.0 * UNIT_ROUNDOFF, "{stop}");
    for (contact, exact) in exact_cases("physx505") {
        assert_eq!(contact != Contact::Miss, exact.is_some(), "{contact:?}");
    }
}

#[test]
fn physx600_an_overlap_at_the_start_is_reported_as_touching() {
    let faces = vec![p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 0.0, -1.0)];
    let mesh = Mesh::new(faces, vec![[0, 1, 2]]).unwrap();
    let touches = mesh.touches(&Point3::origin(), &nalgebra::Vector3::zeros(), 0.3, 0.0, &mut Work::default());
    assert_eq!(touches.len(), 1);
    // It is no collision, as the ball is on its way out.
    assert_eq!(cast(Point3::origin(), v(-1.0, 0.0, 0.0), 0.3, 1.0, &mesh.triangle(0)), Contact::Miss);
}

#[test]
fn physx501_a_ridge_met_from_above_is_met_at_the_same_time_when_tilted() {
    let time_at = |tilt: f64| {
        let tilt = tilt.to_radians();
        let turn = |x: f64, y: f64, z: f64| p(x * tilt.cos() - z * tilt.sin(), y, x * tilt.sin() + z * tilt.cos());
        let (a, b) = (turn(0.0, -1.0, 0.0), turn(0.0, 1.0, 0.0));
        let slopes = [[a, b, turn(-1.0, 0.0, -1.0)], [b, a, turn(1.0, 0.0, -1.0)]];
        slopes.iter().map(|slope| time(cast(p(0.0, 0.0, 3.0), v(0.0, 0.0, -1.0), 0.5, 9.0, slope))).fold(9.0, f64::min)
    };
    for tilt in [0.0, 0.01, 1.0] {
        assert!(time_at(tilt) <= 2.5 && 2.5 - time_at(tilt) <= contact_doubt(8.0), "{tilt} degrees: {}", time_at(tilt));
    }
}

#[test]
fn jolt886_a_ball_passes_a_needle() {
    let [(contact, None)] = exact_cases("jolt886")[..] else { panic!("one miss") };
    assert_eq!(contact, Contact::Miss);
}

#[test]
fn jolt1383_what_is_not_a_number_ends() {
    let triangle = square(1.0)[0];
    for bad in [f64::NAN, f64::INFINITY] {
        for velocity in [v(bad, 0.0, -1.0), v(0.0, 0.0, bad), v(bad, bad, bad)] {
            if let Contact::At { f, .. } = cast(p(0.0, 0.0, 3.0), velocity, 0.5, 1.0, &triangle) {
                assert!((0.0..=1.0).contains(&f), "{f}");
            }
        }
    }
}

#[test]
fn dynbill173_a_point_where_two_ends_meet_is_hit() {
    let (left, right) = (
        [p(-1.0, 0.0, 0.3), p(0.1, 0.7, 0.2), p(-0.5, 1.0, 0.1)],
        [p(0.1, 0.7, 0.2), p(1.2, 0.4, 0.3), p(0.6, 1.3, 0.7)],
    );
    let (start, shared) = (p(0.3, -2.0, 1.7), left[1]);
    // The target is the shared corner itself, the end of the way: both are hit, whatever the rounding of a longer way.
    for triangle in [&left, &right] {
        assert!(matches!(hit(start, shared, triangle), Some((1.0, Feature::Vertex(_)))));
        let radius = 1e-9;
        assert!(matches!(cast(start, shared - start, radius, 2.0, triangle), Contact::At { f, .. } if f <= 1.0));
    }
}

#[test]
fn adaptive4_a_subnormal_turn_has_a_sign() {
    let e = f64::from_bits(1);
    assert_eq!(orient2d(&Point2::new(0.0, 0.0), &Point2::new(0.0, e), &Point2::new(e, 0.0)), Sign::Negative);
}

#[test]
fn oblik2146_a_ray_meets_the_shared_diagonal() {
    let (start, direction) = (p(0.0, 0.0, 10.0), v(0.30458447, 0.30458447, -0.9024725));
    for half in square(5.0) {
        let Some((f, feature)) = hit(start, start + direction * 20.0, &half) else { panic!("{half:?} is missed") };
        assert!(matches!(feature, Feature::Edge(_)), "{feature:?}");
        let place = start + direction * (20.0 * f);
        assert!((place - p(3.375, 3.375, 0.0)).amax() <= 1e-6, "{place}");
    }
}

#[test]
fn vkcts446_a_shared_edge_is_hit_whatever_the_winding() {
    let (a, b) = (p(1.0, 0.0, -1.0), p(0.0, 1.0, -1.0));
    let start = p(f64::from(f32::from_bits(0x3f70_8000)), f64::from(f32::from_bits(0x3d78_0000)), 0.0);
    for triangle in
        [[p(0.0, 0.0, -1.0), a, b], [p(0.0, 0.0, -1.0), b, a], [p(1.0, 1.0, -1.0), a, b], [p(1.0, 1.0, -1.0), b, a]]
    {
        assert!(matches!(hit(start, start - Vector3::z() * 2.0, &triangle), Some((_, Feature::Edge(1)))));
    }
}
