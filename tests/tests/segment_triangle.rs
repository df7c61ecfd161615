//! Segments against triangles: 1885 hard cases with exact answers, and no gap between neighbours.

use carom_geometry::rounding::SEGMENT_FRACTION_BOUND;
use carom_geometry::segment::{SegmentHit, segment_hits_triangle};
use carom_tests::data::{csv, feature_name, number};
use carom_tests::nasty;
use nalgebra::Point3;

const HEADER: &str =
    "id,category,p0x,p0y,p0z,p1x,p1y,p1z,ax,ay,az,bx,by,bz,cx,cy,cz,exact_label,toi_lo,toi_hi,feature,contact";

#[test]
fn r44_hard_cases_have_the_exact_answer() {
    let rows = csv("geometry-cases/segment_vs_triangle_hard_exact.csv", HEADER);
    assert_eq!(rows.len(), 1885);
    let (mut hits, mut earliest, mut features) = (0, 0.0f64, 0);
    for row in &rows {
        let point = |i: usize| Point3::new(number(&row[i]), number(&row[i + 1]), number(&row[i + 2]));
        let triangle = [point(8), point(11), point(14)];
        match (segment_hits_triangle(&point(2), &point(5), &triangle), row[17].as_str()) {
            (SegmentHit::Miss, "0") => {}
            (SegmentHit::Hit { f, feature, coplanar }, "1") => {
                hits += 1;
                let (low, high) = (number(&row[18]), number(&row[19]));
                assert!(f <= high, "case {}: f = {f:e} is late, above {high:e}", row[0]);
                assert!(low - f <= SEGMENT_FRACTION_BOUND, "case {}: f = {f:e} is early, below {low:e}", row[0]);
                earliest = earliest.max(low - f);
                match row[21].as_str() {
                    "start_on" => assert_eq!(f, 0.0, "case {}", row[0]),
                    "end_on" => assert_eq!(f, 1.0, "case {}", row[0]),
                    "coplanar" => assert!(coplanar, "case {}", row[0]),
                    "cross" => assert!(!coplanar, "case {}", row[0]),
                    other => panic!("unknown contact {other}"),
                }
                features += usize::from(feature_name(feature) == row[20]);
            }
            (got, expected) => panic!("case {}: {got:?}, but the exact label is {expected}", row[0]),
        }
    }
    println!("{hits} hits, f early by {:e} at worst, {features} features as named", earliest);
    assert_eq!(hits, 939);
    assert_eq!(features, hits);
}

#[test]
fn r44_no_segment_passes_between_the_faces_of_a_closed_fan() {
    // A fan of slivers around the origin: aimed at its spokes and its hub, every segment meets a face.
    let rim: Vec<Point3<f64>> = (0..12)
        .map(|k| {
            let angle = f64::from(k) / 12.0 * std::f64::consts::TAU;
            Point3::new(0.1 + angle.cos(), 0.2 + angle.sin(), 0.3 * (3.0 * angle).sin())
        })
        .collect();
    let hub = Point3::new(0.1, 0.2, 0.7);
    let fan: Vec<[Point3<f64>; 3]> = (0..12).map(|k| [hub, rim[k], rim[(k + 1) % 12]]).collect();
    let start = Point3::new(0.37, -0.11, 5.0);
    let (mut aimed, mut several) = (0, 0);
    for spoke in &rim {
        for k in 0..8 {
            let target = hub + (spoke - hub) * (f64::from(k) / 8.0);
            for target in nasty::neighbours3(target, 1) {
                let end = start + (target - start) * 2.0;
                let hits = fan.iter().filter(|t| segment_hits_triangle(&start, &end, t) != SegmentHit::Miss).count();
                assert!(hits > 0, "through the fan at {target:?}");
                aimed += 1;
                several += usize::from(hits > 1);
            }
        }
    }
    assert_eq!(aimed, 12 * 8 * 27);
    println!("{aimed} segments aimed at shared edges, {several} met more than one face");
}

#[test]
fn r47_no_segment_passes_between_a_sliver_and_its_neighbours() {
    let start = Point3::new(0.37, -0.11, 5.0);
    let (mut aimed, mut in_sliver) = (0, 0);
    for sliver in nasty::slivers() {
        let centre = Point3::from(sliver.iter().map(|p| p.coords).sum::<nalgebra::Vector3<f64>>() / 3.0);
        // Every edge has a neighbour on its other side, large but not coplanar with the sliver.
        let neighbours = (0..3).map(|i| {
            let (a, b) = (sliver[i], sliver[(i + 1) % 3]);
            let normal = nalgebra::Vector3::new(0.3, 0.7, 0.9);
            let out = (b - a).cross(&normal);
            let out = out * (out.dot(&(nalgebra::center(&a, &b) - centre))).signum();
            [b, a, nalgebra::center(&a, &b) + out * 4.0]
        });
        let faces: Vec<_> = std::iter::once(sliver).chain(neighbours).collect();
        for target in nasty::planted(&sliver).into_iter().skip(3) {
            for target in nasty::neighbours3(target, 1) {
                let end = start + (target - start) * 2.0;
                let hit = |t: &[Point3<f64>; 3]| segment_hits_triangle(&start, &end, t) != SegmentHit::Miss;
                assert!(faces.iter().any(hit), "through {sliver:?} at {target:?}");
                aimed += 1;
                in_sliver += usize::from(hit(&sliver));
            }
        }
    }
    println!("{aimed} segments aimed at slivers, {in_sliver} met them, the others a neighbour");
    assert!(in_sliver > 0 && in_sliver < aimed);
}
