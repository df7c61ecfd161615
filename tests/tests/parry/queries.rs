//! Planes, normals, distances, segments and polygons against parry3d.

use crate::{Tally, oracle};
use carom_geometry::inside::Location;
use carom_geometry::mesh::Mesh;
use carom_geometry::normal::unit_normal;
use carom_geometry::plane::{Plane, Side};
use carom_geometry::polygon::Polygon;
use carom_geometry::rounding::{NORMAL_BOUND, SEGMENT_FRACTION_BOUND, UNIT_ROUNDOFF, position_bound};
use carom_geometry::segment::{SegmentHit, segment_hits_triangle};
use carom_geometry::triangle::closest_point;
use carom_tests::random::Random;
use carom_tests::{exact, obj};
use nalgebra::{Point2, Point3, Vector3};

pub const BUNNY: &str = include_str!("../../../crates/app/scenes/meshes/low_poly_bunny.obj");

#[test]
fn r05_signed_distances_and_sides_of_planes() {
    const CASES: u32 = 200_000;
    let mut random = Random::new(1);
    let mut tally = Tally::default();
    for _ in 0..CASES {
        let size = random.octave(-20, 20);
        let (point, x) = (random.point(size), random.point(size));
        let plane = Plane::from_point_normal(point, random.vector(1.0)).unwrap();
        let (ours, theirs) = (plane.signed_distance(&x), oracle::signed_distance(&point, &plane.normal(), &x));
        let allowed = 2.0 * plane.distance_bound(&x);
        let same_side = plane.side_of(&x).map_or(0.0, Side::sign) == theirs.signum();
        if same_side && tally.agree_within((ours - theirs).abs(), allowed) {
            continue;
        }
        let n = plane.normal().into_inner();
        let height =
            exact::dot(&exact::point(&Point3::from(n)), &exact::minus(&exact::point(&x), &exact::point(&point)));
        let error = exact::nearest(&(height - exact::exact(ours))).abs();
        let right = error <= plane.distance_bound(&x);
        tally.explain("a point on the plane to rounding", right && ours.abs() <= allowed, ours.abs(), || {
            format!("{plane:?} {x}")
        });
    }
    tally.finish("signed distances", CASES);
}

#[test]
fn r39_normals_of_triangles() {
    const CASES: u32 = 100_000;
    let mut random = Random::new(2);
    let mut tally = Tally::default();
    for _ in 0..CASES {
        let triangle = random.triangle(1.0);
        let (ours, theirs) = (unit_normal(&triangle).unwrap().into_inner(), oracle::normal(&triangle));
        let difference = theirs.map_or(f64::INFINITY, |n| (n - ours).amax());
        if tally.agree_within(difference, 2.0 * NORMAL_BOUND) {
            continue;
        }
        // A plain cross product loses u / sine.
        let [a, b, c] = triangle;
        let (ab, ac) = (b - a, c - a);
        let sine = ab.cross(&ac).norm() / (ab.norm() * ac.norm());
        let t = triangle.each_ref().map(exact::point);
        let n = exact::cross(&exact::minus(&t[1], &t[0]), &exact::minus(&t[2], &t[0])).map(|c| exact::nearest(&c));
        let right = (Vector3::from(n).normalize() - ours).amax() <= 2.0 * NORMAL_BOUND;
        tally.explain("a needle, where parry loses u / sine", right && sine < 0.1, difference, || {
            format!("{triangle:?}")
        });
    }
    tally.finish("normals", CASES);
}

#[test]
fn r47_distances_from_triangles() {
    const CASES: u32 = 300_000;
    let mut random = Random::new(3);
    let mut tally = Tally::default();
    for _ in 0..CASES {
        let triangle = random.triangle(1.0);
        let x = random.in_triangle(&triangle) + random.vector(1.0) * random.octave(-20, 2);
        let (ours, theirs) = (closest_point(&triangle, &x).offset.norm(), oracle::distance(&triangle, &x));
        let allowed = 2.0 * position_bound(1.0 + x.coords.amax());
        if tally.agree_within((ours - theirs).abs(), allowed) {
            continue;
        }
        let want = exact::clearance(&triangle, &exact::point(&x), 0.0);
        let [a, b, c] = triangle;
        let edges = [b - a, c - b, a - c].map(|e| e.norm());
        let thin = (b - a).cross(&(c - a)).norm() / edges.iter().fold(0.0, |m, e| f64::max(m, e * e));
        let right = (ours - want).abs() <= allowed;
        tally.explain(
            "a needle, in which parry misjudges the place",
            right && thin < 0.1,
            (ours - theirs).abs(),
            || format!("{triangle:?} {x}: {ours} {theirs} {want}"),
        );
    }
    tally.finish("distances", CASES);
}

#[test]
fn r41_r46_segments_against_triangles() {
    const CASES: u32 = 300_000;
    let mut random = Random::new(4);
    let (mut tally, mut hits) = (Tally::default(), 0);
    for _ in 0..CASES {
        let triangle = random.triangle(1.0);
        let from = random.point(2.0);
        let to = from + (random.in_triangle(&triangle) + random.vector(0.5) - from) * random.within(0.5, 2.0);
        let theirs = oracle::segment(&triangle, &from, &to);
        let ours = match segment_hits_triangle(&from, &to, &triangle) {
            SegmentHit::Hit { f, .. } => Some(f),
            SegmentHit::Miss => None,
        };
        hits += u32::from(ours.is_some());
        compare_segments(&mut tally, &triangle, &from, &to, ours, theirs);
    }
    println!("{hits} segments hit");
    tally.finish("segments against triangles", CASES);
}

/// `triangle` is the one that decides f where both hit.
fn compare_segments(
    tally: &mut Tally,
    triangle: &[Point3<f64>; 3],
    from: &Point3<f64>,
    to: &Point3<f64>,
    ours: Option<f64>,
    theirs: Option<f64>,
) {
    let [a, b, c] = triangle;
    let (n, step) = ((b - a).cross(&(c - a)), to - from);
    match (ours, theirs) {
        (None, None) => tally.agree(),
        (Some(ours), Some(theirs)) => {
            // Parry's f is (a - from).n / step.n, each with some roundings of the product of lengths; ours may be early.
            let reach = (b - a).norm() * (c - a).norm() * ((from - a).norm() + step.norm());
            let allowed = SEGMENT_FRACTION_BOUND + 16.0 * UNIT_ROUNDOFF * reach / n.dot(&step).abs();
            if !tally.agree_within((ours - theirs).abs(), allowed) {
                tally.explain("nothing", false, (ours - theirs).abs(), || format!("{triangle:?} {from} {to}"));
            }
        }
        _ => {
            let right = exact::segment_meets(triangle, from, to) == ours.is_some();
            let near = closest_point(triangle, &(from + step * ours.or(theirs).unwrap_or(0.0))).point;
            let at_end = ours.or(theirs).is_some_and(|f| f == 0.0 || 1.0 - f <= position_bound(1.0));
            let edges = [(a, b), (b, c), (c, a)].map(|(p, q)| closest_point(&[*p, *q, *q], &near).offset.norm());
            let at_edge = edges.iter().any(|d| *d <= 64.0 * position_bound(1.0));
            tally.explain("an edge or an end met to rounding", right && (at_end || at_edge), 0.0, || {
                format!("{triangle:?} {from} {to}: {ours:?} {theirs:?}")
            });
        }
    }
}

#[test]
fn r46_segments_against_a_mesh() {
    const CASES: u32 = 15_000;
    let (vertices, faces) = obj::read(BUNNY);
    let theirs = oracle::Mesh::new(&vertices, &faces);
    let ours = Mesh::new(vertices, faces).unwrap();
    let (centre, size) = (ours.bounds().centre(), ours.bounds().extent().amax());
    let mut random = Random::new(5);
    let (mut tally, mut hits) = (Tally::default(), 0);
    for _ in 0..CASES {
        let from = centre + random.vector(size);
        let to = from + (centre + random.vector(0.6 * size) - from) * random.within(0.5, 2.0);
        let met = (0..ours.faces().len() as u32).filter_map(|face| {
            match segment_hits_triangle(&from, &to, &ours.triangle(face)) {
                SegmentHit::Hit { f, .. } => Some((f, face)),
                SegmentHit::Miss => None,
            }
        });
        let first = met.min_by(|a, b| a.0.total_cmp(&b.0));
        hits += u32::from(first.is_some());
        let triangle = ours.triangle(first.map_or(0, |(_, face)| face));
        compare_segments(&mut tally, &triangle, &from, &to, first.map(|(f, _)| f), theirs.segment(&from, &to));
    }
    println!("{hits} segments hit the mesh");
    tally.finish("segments against a mesh", CASES);
}

#[test]
fn r35_r37_points_in_polygons() {
    const POLYGONS: u32 = 1500;
    const POINTS: u32 = 100;
    let mut random = Random::new(6);
    let (mut tally, mut inside, mut concave) = (Tally::default(), 0, 0);
    for _ in 0..POLYGONS {
        // Around the origin in the plane z = s x + t y, steeper than which another axis would be dropped.
        let (s, t) = (random.within(-0.7, 0.7), random.within(-0.7, 0.7));
        let lift = |p: &Point2<f64>| Point3::new(p.x, p.y, s * p.x + t * p.y);
        let corners = 3 + random.below(10);
        let flat: Vec<Point2<f64>> = (0..corners)
            .map(|k| {
                let angle = (k as f64 + random.within(0.1, 0.9)) / corners as f64 * std::f64::consts::TAU;
                Point2::new(angle.cos(), angle.sin()) * random.within(0.2, 1.0)
            })
            .collect();
        let polygon = Polygon::new(flat.iter().map(lift).collect()).unwrap();
        concave += u32::from(!polygon.is_convex());
        for _ in 0..POINTS {
            let x = Point2::new(random.within(-1.0, 1.0), random.within(-1.0, 1.0));
            let ours = polygon.locate(&lift(&x));
            inside += u32::from(ours == Location::Inside);
            match (ours, oracle::in_polygon(&flat, &x)) {
                (Location::Inside, true) | (Location::Outside, false) => tally.agree(),
                (_, theirs) => tally.explain("nothing", false, 0.0, || format!("{flat:?} {x}: {ours:?} {theirs}")),
            }
        }
    }
    println!("{concave} of {POLYGONS} polygons are concave, {inside} points inside");
    tally.finish("points in polygons", POLYGONS * POINTS);
}
