//! The closest point against exact arithmetic, for triangles of every kind.

use super::*;
use crate::exact::{Exact, ExactVector, cross, difference, dot, nearest};
use crate::rounding::UNIT_ROUNDOFF;
use proptest::prelude::*;

/// The squared distance from x to the triangle, exactly: the least over vertices, edges and the face.
fn exact_distance_squared(t: &[Point3<f64>; 3], x: &Point3<f64>) -> Exact {
    let zero = Exact::ZERO;
    let mut best: Option<Exact> = None;
    let mut offer = |d: Exact| {
        if best.as_ref().is_none_or(|b| d < *b) {
            best = Some(d);
        }
    };
    let square = |v: &ExactVector| dot(v, v);
    for i in 0..3 {
        let (a, b) = (&t[i], &t[(i + 1) % 3]);
        let (p, e) = (difference(x, a), difference(b, a));
        offer(square(&p));
        let (along, length) = (dot(&p, &e), square(&e));
        if along > zero && along < length {
            offer(square(&p) - &along * &along / length);
        }
    }
    let n = cross(&difference(&t[1], &t[0]), &difference(&t[2], &t[0]));
    let within = (0..3).all(|i| {
        let (a, b) = (&t[i], &t[(i + 1) % 3]);
        dot(&n, &cross(&difference(b, a), &difference(x, a))) >= zero
    });
    if within && square(&n) > zero {
        let d = dot(&n, &difference(x, &t[0]));
        offer(&d * &d / square(&n));
    }
    best.unwrap_or(zero)
}

/// The error of distance and place of the closest point, in u of the largest distance between x and a vertex (and the size of coordinates).
fn errors(t: &[Point3<f64>; 3], x: &Point3<f64>) -> (f64, f64) {
    let closest = closest_point(t, x);
    assert!(closest.point.iter().chain(closest.offset.iter()).all(|c| c.is_finite()), "{closest:?} of {t:?} to {x:?}");
    let want = nearest(&exact_distance_squared(t, x)).sqrt();
    let reach = t.iter().fold(0.0, |m, v| f64::max(m, (x - v).norm()));
    let coordinates = t.iter().fold(x.coords.amax(), |m, v| m.max(v.coords.amax()));
    let far = (closest.offset.norm() - want).abs() / (UNIT_ROUNDOFF * reach.max(f64::MIN_POSITIVE));
    // The point itself lies in the triangle.
    let off = nearest(&exact_distance_squared(t, &closest.point)).sqrt();
    (far, off / (UNIT_ROUNDOFF * (reach + coordinates).max(f64::MIN_POSITIVE)))
}

#[test]
fn closest_point_names_every_feature() {
    let t = [Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0)];
    for (x, feature, point) in [
        ((1.0, 1.0, 5.0), Feature::Face, (1.0, 1.0, 0.0)),
        ((2.0, -3.0, 1.0), Feature::Edge(0), (2.0, 0.0, 0.0)),
        ((4.0, 4.0, -1.0), Feature::Edge(1), (2.0, 2.0, 0.0)),
        ((-2.0, 3.0, 0.0), Feature::Edge(2), (0.0, 3.0, 0.0)),
        ((-1.0, -1.0, 2.0), Feature::Vertex(0), (0.0, 0.0, 0.0)),
        ((7.0, 1.0, 0.0), Feature::Vertex(1), (4.0, 0.0, 0.0)),
        ((1.0, 9.0, 0.0), Feature::Vertex(2), (0.0, 4.0, 0.0)),
    ] {
        for turn in 0..3u8 {
            for k in [-1000, -300, 0, 300, 1000] {
                let big = |(x, y, z): (f64, f64, f64)| Point3::new(scale(x, k), scale(y, k), scale(z, k));
                let turned = std::array::from_fn(|i| t[(i + usize::from(turn)) % 3].map(|c| scale(c, k)));
                let closest = closest_point(&turned, &big(x));
                let expected = match feature {
                    Feature::Face => Feature::Face,
                    Feature::Edge(i) => Feature::Edge((i + 3 - turn) % 3),
                    Feature::Vertex(i) => Feature::Vertex((i + 3 - turn) % 3),
                };
                assert_eq!((closest.feature, closest.point), (expected, big(point)), "2^{k}, from vertex {turn}");
            }
        }
    }
}

#[test]
fn closest_point_of_triangles_without_an_area_is_that_of_their_segment() {
    let (a, b, m) = (Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0));
    for t in [[a, m, b], [m, a, b], [a, b, m], [a, a, b], [a, b, a], [b, a, a], [a, b, b]] {
        let closest = closest_point(&t, &Point3::new(3.0, 2.0, 1.0));
        assert_eq!((closest.point, closest.offset), (Point3::new(3.0, 0.0, 0.0), Vector3::new(0.0, 2.0, 1.0)), "{t:?}");
        assert_eq!(closest_point(&t, &Point3::new(9.0, 2.0, 1.0)).point, b);
        assert_eq!(closest_point(&t, &Point3::new(-9.0, 2.0, 1.0)).point, a);
    }
    let closest = closest_point(&[m; 3], &Point3::new(9.0, 2.0, 1.0));
    assert_eq!((closest.point, closest.feature), (m, Feature::Vertex(0)));
}

#[test]
fn closest_point_far_beyond_the_range_of_products_stays_finite() {
    let t = [Point3::origin(), Point3::new(1e-90, 0.0, 0.0), Point3::new(0.0, 1e-90, 0.0)];
    for x in [Point3::new(1e-91, 1e-91, 1e90), Point3::new(1e150, 1e150, 1e-150), Point3::new(2e-91, 3e-91, 0.0)] {
        let closest = closest_point(&t, &x);
        assert!(closest.point.coords.amax() <= 1e-90, "{closest:?}");
        assert!((closest.offset - x.coords).amax() <= 2e-90);
    }
}

#[test]
fn closest_point_of_needles_keeps_its_accuracy() {
    let mut worst = (0.0f64, 0.0f64);
    for k in 0..60 {
        let h = scale(1.0, -k);
        let t = [Point3::new(0.1, 0.2, 0.3), Point3::new(1.3, 0.7, -0.4), Point3::new(0.7, 0.45 + h, -0.05 - 0.3 * h)];
        for i in -2..12 {
            for (away, j) in [(0.5, 0), (1e-3, 1), (1e-9, 2), (h, 0), (0.3 * h, 1), (0.0, 2)] {
                let mut x = t[0] + (t[1] - t[0]) * (f64::from(i) / 10.0);
                x[j] += away;
                let (far, off) = errors(&t, &x);
                worst = (worst.0.max(far), worst.1.max(off));
            }
        }
    }
    println!("needles: distance off by {} u, point by {} u at worst", worst.0, worst.1);
    assert!(worst.0 <= CLOSEST_BOUND && worst.1 <= CLOSEST_BOUND, "{worst:?}");
}

#[test]
fn closest_point_of_a_triangle_like_a_point_from_afar_still_names_the_face() {
    let t = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)].map(|(x, y)| Point3::new(scale(x, -400), scale(y, -400), 0.0));
    let over = Point3::new(scale(1.0, -400), scale(1.0, -400), 1.0);
    let closest = closest_point(&t, &over);
    assert_eq!((closest.feature, closest.offset), (Feature::Face, Vector3::z()));
}

#[test]
fn closest_vertex_is_the_vertex_bit_for_bit() {
    let least = f64::from_bits(1);
    let t = [(0.0, least), (1e300, 0.0), (0.0, 1e300)].map(|(x, y)| Point3::new(x, y, least));
    assert_eq!(closest_point(&t, &Point3::new(-1e300, -1e300, 0.0)).point, t[0]);
}

/// "A few u": what the tests hold `closest_point` to.
const CLOSEST_BOUND: f64 = 16.0;

fn point() -> impl Strategy<Value = Point3<f64>> {
    let coordinate = || prop_oneof![-1.0f64..1.0, (-4i32..5).prop_map(|c| f64::from(c) / 4.0)];
    [coordinate(), coordinate(), coordinate()].prop_map(Point3::from)
}

proptest! {
    #[test]
    fn closest_point_is_closest(t in [point(), point(), point()], x in point(), k in -900i32..900, flat in 0u32..60) {
        let scaled = |p: Point3<f64>| Point3::new(p.x, p.y, scale(p.z, -(flat as i32))).map(|c| scale(c, k));
        let (t, x) = (t.map(scaled), scaled(x));
        let (far, off) = errors(&t.map(|p| p.map(|c| scale(c, -k))), &x.map(|c| scale(c, -k)));
        prop_assert!(far <= CLOSEST_BOUND && off <= CLOSEST_BOUND, "off by {far} u, {off} u");
        // Scaling by a power of two changes nothing.
        let (here, there) = (closest_point(&t.map(|p| p.map(|c| scale(c, -k))), &x.map(|c| scale(c, -k))), closest_point(&t, &x));
        prop_assert_eq!(here.feature, there.feature);
        prop_assert_eq!(here.offset.map(|c| scale(c, k)), there.offset);
        prop_assert_eq!(here.point.map(|c| scale(c, k)), there.point);
    }
}
