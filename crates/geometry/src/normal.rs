//! Unit vectors and the normal of a loop of points, accurate for needles and at every scale.

use crate::exact::{self, Exact, ExactVector, exact};
use crate::rounding::{UNIT_LENGTH_BOUND, VECTOR_AREA_BOUND, exponent, scale, vector_area_bound};
use crate::twofold::{two_difference, two_product};
use nalgebra::{Point3, UnitVector3, Vector3};

/// `v` divided by its length, whatever its size; none if it is zero or not finite.
///
/// A vector that already is of length 1 to rounding is kept bit for bit, and one along an axis gives exactly that axis.
pub fn unit(v: &Vector3<f64>) -> Option<UnitVector3<f64>> {
    let most = v.amax();
    if !v.iter().all(|c| c.is_finite()) || most == 0.0 {
        return None;
    }
    if (v.norm_squared() - 1.0).abs() <= UNIT_LENGTH_BOUND {
        return Some(UnitVector3::new_unchecked(*v));
    }
    // A power of two first, so that squares neither overflow nor vanish.
    let near_one = v.map(|c| scale(c, -exponent(most)));
    Some(UnitVector3::new_unchecked(near_one / near_one.norm()))
}

/// The unit normal of a closed loop of points: the direction of its vector area, half the sum of p_i x p_(i+1) (Newell). For three points
/// that is (p1 - p0) x (p2 - p0), the R39 normal.
///
/// Each component is within [`NORMAL_BOUND`](crate::rounding::NORMAL_BOUND) of the exact one, however thin the loop: what f64
/// cannot do is done in rationals. None if the vector area is exactly zero (all points on one line, or a figure of eight with equal lobes) or a
/// coordinate is not finite.
pub fn unit_normal(points: &[Point3<f64>]) -> Option<UnitVector3<f64>> {
    vector_area(points).map(|a| a.normal)
}

/// Half the sum of p_i x p_(i+1): direction and length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VectorArea {
    /// Direction.
    pub normal: UnitVector3<f64>,
    /// Length: the area if the loop is planar and simple.
    pub area: f64,
}

/// The vector area of a loop, or none if it is exactly zero or not finite.
pub(crate) fn vector_area(points: &[Point3<f64>]) -> Option<VectorArea> {
    let (origin, rest) = points.split_first()?;
    if points.iter().any(|p| p.iter().any(|c| !c.is_finite())) {
        return None;
    }
    rounded_vector_area(origin, rest).or_else(|| exact_vector_area(origin, rest))
}

/// The vector area in f64, or none if its error could be too large.
fn rounded_vector_area(origin: &Point3<f64>, rest: &[Point3<f64>]) -> Option<VectorArea> {
    let extent = rest.iter().fold(0.0, |m, p| f64::max(m, (p - origin).amax()));
    if extent == 0.0 || !extent.is_finite() {
        return None;
    }
    let k = exponent(extent);
    let edge = |p: &Point3<f64>| (p - origin).map(|c| scale(c, -k));
    let (mut twice, mut magnitude) = (Vector3::zeros(), Vector3::zeros());
    for pair in rest.windows(2) {
        let (a, b) = (edge(&pair[0]), edge(&pair[1]));
        twice += a.cross(&b);
        let (a, b) = (a.abs(), b.abs());
        magnitude += Vector3::new(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x);
    }
    let error = magnitude.map(|m| vector_area_bound(m, rest.len())).norm();
    let length = twice.norm();
    if error > VECTOR_AREA_BOUND * length {
        return None;
    }
    unit(&twice).map(|normal| VectorArea { normal, area: scale(scale(length / 2.0, k), k) })
}

/// The vector area in rationals, rounded once.
fn exact_vector_area(origin: &Point3<f64>, rest: &[Point3<f64>]) -> Option<VectorArea> {
    let edges: Vec<ExactVector> = rest.iter().map(|p| exact::difference(p, origin)).collect();
    let zero = || std::array::from_fn(|_| Exact::ZERO);
    let twice = edges.windows(2).fold(zero(), |s, e| exact::sum(&s, &exact::cross(&e[0], &e[1])));
    let size = |x: &Exact| if *x < Exact::ZERO { -x } else { x.clone() };
    let most = twice.iter().map(size).max().filter(|m| !m.is_zero())?;
    // Ratios are within f64 where the components themselves may not be.
    let direction = Vector3::from_iterator(twice.iter().map(|c| exact::nearest(&(c / &most))));
    let area = exact::nearest(&(most / exact(2.0))) * direction.norm();
    unit(&direction).map(|normal| VectorArea { normal, area })
}

/// (b - origin) x (c - origin) to about one rounding of its length even where the edges are nearly parallel.
///
/// Edges are taken with the rounding errors of their subtractions and products in twice the working precision, so that
/// cancellation costs its digits twice before it is noticed: relative error of about u + u^2 |b - origin| |c - origin| / |result|. Without
/// overflow or underflow, that is for coordinates scaled to moderate size.
pub(crate) fn cross_compensated(origin: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>) -> Vector3<f64> {
    let edge = |p: &Point3<f64>| {
        let parts: [(f64, f64); 3] = std::array::from_fn(|i| two_difference(p[i], origin[i]));
        parts
    };
    let (b, c) = (edge(b), edge(c));
    Vector3::from_fn(|i, _| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (left, left_tail) = two_product(b[j].0, c[k].0);
        let (right, right_tail) = two_product(b[k].0, c[j].0);
        let (head, tail) = two_difference(left, right);
        let mixed = (b[j].0 * c[k].1 + b[j].1 * c[k].0) - (b[k].0 * c[j].1 + b[k].1 * c[j].0);
        head + (tail + (left_tail - right_tail) + mixed)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::{NORMAL_BOUND, UNIT_ROUNDOFF};

    #[test]
    fn unit_keeps_axes_and_unit_vectors_bit_for_bit() {
        for k in [-1000, -3, 0, 5, 1000] {
            let v = Vector3::new(0.0, 0.0, -scale(1.0, k));
            assert_eq!(unit(&v).unwrap().into_inner(), Vector3::new(0.0, 0.0, -1.0));
        }
        assert_eq!(unit(&Vector3::new(0.0, 3e200, 0.0)).unwrap().into_inner(), Vector3::y());
        for v in
            [Vector3::new(1e200, -2e200, 0.3e200), Vector3::new(1e-200, 2e-200, 7e-201), Vector3::new(0.1, 0.7, -5.0)]
        {
            let once = unit(&v).unwrap();
            assert!((once.norm_squared() - 1.0).abs() <= UNIT_LENGTH_BOUND);
            assert_eq!(unit(&once).unwrap(), once);
        }
        assert!(unit(&Vector3::zeros()).is_none());
        assert!(unit(&Vector3::new(f64::NAN, 1.0, 0.0)).is_none());
        assert!(unit(&Vector3::new(f64::INFINITY, 1.0, 0.0)).is_none());
    }

    /// Needles: height / length down to what f64 can represent.
    fn needles() -> impl Iterator<Item = [Point3<f64>; 3]> {
        (0..52).map(|k| {
            let h = scale(1.0, -k);
            [Point3::new(0.1, 0.2, 0.3), Point3::new(1.3, 0.7, -0.4), Point3::new(0.7, 0.45 + h, -0.05 - 0.3 * h)]
        })
    }

    #[test]
    fn r39_normal_of_needles_is_within_its_bound() {
        let mut worst: f64 = 0.0;
        for t in needles() {
            let got = unit_normal(&t).unwrap();
            let want = exact_vector_area(&t[0], &t[1..]).unwrap();
            worst = worst.max((got.into_inner() - want.normal.into_inner()).amax());
            let area = vector_area(&t).unwrap().area;
            assert!((area - want.area).abs() <= NORMAL_BOUND * want.area, "area {area:e} of {t:?}");
        }
        assert!(worst <= NORMAL_BOUND, "worst error {} u", worst / UNIT_ROUNDOFF);
    }

    #[test]
    fn compensated_cross_product_of_needles() {
        let mut worst: f64 = 0.0;
        for t in needles() {
            let got = cross_compensated(&t[0], &t[1], &t[2]);
            let want = exact::cross(&exact::difference(&t[1], &t[0]), &exact::difference(&t[2], &t[0]));
            let want = Vector3::from_fn(|i, _| exact::nearest(&want[i]));
            worst = worst.max((got - want).norm() / want.norm());
            for k in [-200, 200] {
                let [a, b, c] = t.map(|p| p.map(|x| scale(x, k)));
                assert_eq!(cross_compensated(&a, &b, &c), got.map(|x| scale(x, 2 * k)), "2^{k}");
            }
        }
        assert!(worst <= NORMAL_BOUND, "worst relative error {} u", worst / UNIT_ROUNDOFF);
    }

    #[test]
    fn vector_area_spans_the_whole_range() {
        let t = |s: f64, h: f64| [Point3::origin(), Point3::new(s, 0.0, 0.0), Point3::new(0.0, h, 0.0)];
        for (s, h, area) in
            [(1e300, 1e-300, 0.5), (1e-200, 1e-200, 0.0), (1e200, 1e200, f64::INFINITY), (3.0, 4.0, 6.0)]
        {
            let a = vector_area(&t(s, h)).unwrap();
            assert_eq!(a.normal.into_inner(), Vector3::z());
            assert!(a.area == area || (a.area - area).abs() <= NORMAL_BOUND * area, "{} for {s}, {h}", a.area);
        }
        assert!(vector_area(&t(f64::MAX, 0.0)).is_none());
    }

    #[test]
    fn r39_needles_across_an_axis_have_their_sign_and_their_area() {
        // What magnitude the products have is seen in one component only, and it decides whether f64 will do.
        for (axis, k) in (0..3).flat_map(|axis| (8..50).map(move |k| (axis, k))) {
            let across = |x: f64, y: f64| {
                let mut p = Point3::origin();
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (x, y);
                p
            };
            let t = [Point3::origin(), across(1.3, 0.000_17), across(0.7, 0.7 * 0.000_17 / 1.3 + scale(0.000_1, -k))];
            for t in [t, [t[0], t[2], t[1]]] {
                let (got, want) = (vector_area(&t).unwrap(), exact_vector_area(&t[0], &t[1..]).unwrap());
                assert_eq!(got.normal, want.normal, "{t:?}");
                assert_eq!(want.normal.abs(), Vector3::ith(axis, 1.0));
                assert!((got.area - want.area).abs() <= NORMAL_BOUND * want.area, "area {:e} of {t:?}", got.area);
            }
        }
    }
}
