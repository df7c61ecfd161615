//! Signs of orientation determinants: a floating-point filter, then expansions, then rationals. Never wrong on finite input.

use crate::exact::{self, Exact, compare_zero, exact};
use crate::rounding::{exponent, orient2d_bound, orient3d_bound, orient3d_twofold_bound, scale, signed_distance_bound};
use crate::twofold::Twofold;
use nalgebra::{Point2, Point3, Vector3};
use robust::{Coord, Coord3D};
use std::cmp::Ordering;

/// A sign, decided exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sign {
    /// Below zero.
    Negative,
    /// Zero, exactly.
    Zero,
    /// Above zero.
    Positive,
}

impl Sign {
    /// The sign of `x`; of -0 and NaN it is `Zero`.
    pub fn of(x: f64) -> Self {
        if x > 0.0 {
            Self::Positive
        } else if x < 0.0 {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// The sign of the negated number.
    pub fn reverse(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }

    pub(crate) fn of_exact(x: &Exact) -> Self {
        match compare_zero(x) {
            Ordering::Less => Self::Negative,
            Ordering::Equal => Self::Zero,
            Ordering::Greater => Self::Positive,
        }
    }
}

/// Which arithmetic decided a sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Tier {
    /// Plain f64, beyond its error bound.
    Filter,
    /// Adaptive expansions of f64 (crate `robust`), after an exact scaling into the range where they are exact.
    Expansion,
    /// Rational numbers: some microseconds.
    Rational,
}

/// The sign of the determinant |b - a, c - a|: `Positive` if a, b, c turn counterclockwise, `Zero` if they lie on one line.
///
/// Exact for all finite coordinates. Swapping two arguments reverses it; rotating them keeps it. Coordinates that are not
/// finite give a meaningless sign, but no panic.
pub fn orient2d(a: &Point2<f64>, b: &Point2<f64>, c: &Point2<f64>) -> Sign {
    orient2d_with_tier(a, b, c).0
}

/// [`orient2d`], and which tier decided it.
pub fn orient2d_with_tier(a: &Point2<f64>, b: &Point2<f64>, c: &Point2<f64>) -> (Sign, Tier) {
    let left = (a.x - c.x) * (b.y - c.y);
    let right = (a.y - c.y) * (b.x - c.x);
    let det = left - right;
    if det.abs() > orient2d_bound(left.abs() + right.abs()) {
        return (Sign::of(det), Tier::Filter);
    }
    if let Some([ax, ay, bx, by, cx, cy]) = in_range([a.x, a.y, b.x, b.y, c.x, c.y], ORIENT2D_RANGE) {
        let at = |x, y| Coord { x, y };
        return (Sign::of(robust::orient2d(at(ax, ay), at(bx, by), at(cx, cy))), Tier::Expansion);
    }
    let d = |p: &Point2<f64>, i: usize| exact(p[i]) - exact(c[i]);
    (Sign::of_exact(&(d(a, 0) * d(b, 1) - d(a, 1) * d(b, 0))), Tier::Rational)
}

/// The sign of ((b - a) x (c - a)) . (d - a): `Positive` if d lies on the side of the plane through a, b, c to which the normal
/// (b - a) x (c - a) points, that is from where a, b, c turn counterclockwise; `Zero` if the four lie in one plane.
///
/// Exact for all finite coordinates. Swapping two arguments reverses it. Coordinates that are not finite give a
/// meaningless sign, but no panic.
pub fn orient3d(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>, d: &Point3<f64>) -> Sign {
    orient3d_with_tier(a, b, c, d).0
}

/// [`orient3d`], and which tier decided it.
pub fn orient3d_with_tier(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>, d: &Point3<f64>) -> (Sign, Tier) {
    let (det, bound) = orient3d_value(a, b, c, d);
    if det.abs() > bound {
        return (Sign::of(det), Tier::Filter);
    }
    let coordinates = [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z];
    if let Some([ax, ay, az, bx, by, bz, cx, cy, cz, dx, dy, dz]) = in_range(coordinates, ORIENT3D_RANGE) {
        let at = |x, y, z| Coord3D { x, y, z };
        // `robust` counts d below the plane as positive.
        let below = robust::orient3d(at(ax, ay, az), at(bx, by, bz), at(cx, cy, cz), at(dx, dy, dz));
        return (Sign::of(below).reverse(), Tier::Expansion);
    }
    (Sign::of_exact(&orient3d_exact(a, b, c, d)), Tier::Rational)
}

/// The determinant of [`orient3d`] in f64, and a bound on its error; the bound is infinite or NaN where it overflows.
pub(crate) fn orient3d_value(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>, d: &Point3<f64>) -> (f64, f64) {
    let (a, b, c) = (a - d, b - d, c - d);
    let minor = |p: &Vector3<f64>, q: &Vector3<f64>| {
        let (left, right) = (p.x * q.y, p.y * q.x);
        (left - right, left.abs() + right.abs())
    };
    let ((bc, bc_abs), (ca, ca_abs), (ab, ab_abs)) = (minor(&b, &c), minor(&c, &a), minor(&a, &b));
    let det = -(a.z * bc + b.z * ca + c.z * ab);
    let permanent = a.z.abs() * bc_abs + b.z.abs() * ca_abs + c.z.abs() * ab_abs;
    (det, orient3d_bound(permanent, a.z.abs() + b.z.abs() + c.z.abs()))
}

/// The determinants of [`orient3d`] of a triangle and each of `points` in f64, each with a bound on its error, as [`orient3d_value`] has them, but
/// as seen from the first corner: where the triangle is small beside its distance from the point, the bound is as well.
#[inline]
pub(crate) fn orient3d_values<const N: usize>(
    triangle: &[Point3<f64>; 3],
    points: [&Point3<f64>; N],
) -> [(f64, f64); N] {
    let [a, b, c] = triangle;
    let (b, c) = (b - a, c - a);
    let minor = |i: usize, j: usize| {
        let (left, right) = (b[i] * c[j], b[j] * c[i]);
        (left - right, left.abs() + right.abs())
    };
    let ((x, x_abs), (y, y_abs), (z, z_abs)) = (minor(1, 2), minor(2, 0), minor(0, 1));
    points.map(|p| {
        let d = p - a;
        let det = d.x * x + d.y * y + d.z * z;
        let permanent = d.x.abs() * x_abs + d.y.abs() * y_abs + d.z.abs() * z_abs;
        (det, orient3d_bound(permanent, d.x.abs() + d.y.abs() + d.z.abs()))
    })
}

/// The determinant of [`orient3d`] to about a rounding, and a bound on its error; no number where it overflows.
pub(crate) fn orient3d_twofold([a, b, c]: &[Point3<f64>; 3], p: &Point3<f64>) -> (f64, f64) {
    let from = |q: &Point3<f64>| [0, 1, 2].map(|i| Twofold::difference(q[i], a[i]));
    let (b, c, d) = (from(b), from(c), from(p));
    let minor = |i: usize, j: usize| b[i].times(c[j]).minus(b[j].times(c[i]));
    let sizes = |i: usize, j: usize| (b[i].0 * c[j].0).abs() + (b[j].0 * c[i].0).abs();
    let places = [(1, 2), (2, 0), (0, 1)];
    let [x, y, z] = [0, 1, 2].map(|k| d[k].times(minor(places[k].0, places[k].1)));
    let permanent: f64 = (0..3).map(|k| d[k].0.abs() * sizes(places[k].0, places[k].1)).sum();
    let value = x.plus(y).plus(z).0;
    (value, orient3d_twofold_bound(value, permanent, d.iter().map(|x| x.0.abs()).sum()))
}

/// The determinant of [`orient3d`], exactly.
pub(crate) fn orient3d_exact(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>, d: &Point3<f64>) -> Exact {
    let normal = exact::cross(&exact::difference(b, a), &exact::difference(c, a));
    exact::dot(&normal, &exact::difference(d, a))
}

/// The sign of `normal` . (`x` - `point`): on which side of a plane x lies. The normal need not have length 1.
///
/// Exact for all finite input. Reversing the normal reverses the sign.
pub fn side_of_plane(normal: &Vector3<f64>, point: &Point3<f64>, x: &Point3<f64>) -> Sign {
    side_of_plane_with_tier(normal, point, x).0
}

/// [`side_of_plane`], and which tier decided it (there is no tier of expansions).
pub fn side_of_plane_with_tier(normal: &Vector3<f64>, point: &Point3<f64>, x: &Point3<f64>) -> (Sign, Tier) {
    let d = x - point;
    let terms = normal.component_mul(&d);
    let value = terms.x + terms.y + terms.z;
    let magnitude = terms.x.abs() + terms.y.abs() + terms.z.abs();
    if value.abs() > signed_distance_bound(magnitude) {
        return (Sign::of(value), Tier::Filter);
    }
    // A difference of f64 has the right sign even where it is rounded, so one term alone is certain: planes across an axis.
    let mut alone = (0..3).filter(|&i| normal[i] != 0.0 && d[i] != 0.0);
    match (alone.next(), alone.next()) {
        (None, _) => (Sign::Zero, Tier::Filter),
        (Some(i), None) if normal[i] > 0.0 => (Sign::of(d[i]), Tier::Filter),
        (Some(i), None) => (Sign::of(d[i]).reverse(), Tier::Filter),
        _ => {
            let s = exact::dot(&exact::vector(normal), &exact::difference(x, point));
            (Sign::of_exact(&s), Tier::Rational)
        }
    }
}

/// Whether three points lie on one line, exactly: their projections along all three axes do.
pub fn collinear(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>) -> bool {
    (0..3).all(|i| {
        let flat = |p: &Point3<f64>| Point2::new(p[i], p[(i + 1) % 3]);
        orient2d(&flat(a), &flat(b), &flat(c)) == Sign::Zero
    })
}

/// Exponents between which `robust::orient2d` is exact: a coordinate of at least 2^low is a multiple of 2^(low - 52), so
/// every product is one of 2^(2 low - 104) and does not underflow; 2^(2 high + 4), a sum of products, does not overflow.
const ORIENT2D_RANGE: (i32, i32) = (-480, 480);

/// The same for `robust::orient3d`: multiples of 2^(3 low - 156), sums below 2^(3 high + 8).
const ORIENT3D_RANGE: (i32, i32) = (-300, 330);

/// The coordinates multiplied by one power of two, exactly, so that all that are not zero have exponents in `low..high`; none
/// if there is no such power, or if a coordinate is not finite.
fn in_range<const N: usize>(coordinates: [f64; N], (low, high): (i32, i32)) -> Option<[f64; N]> {
    let mut least = f64::INFINITY;
    let mut most = 0.0;
    for size in coordinates.map(f64::abs) {
        if !size.is_finite() {
            return None;
        }
        if size != 0.0 {
            least = f64::min(least, size);
        }
        most = f64::max(most, size);
    }
    if most == 0.0 {
        return Some(coordinates);
    }
    let (least, most) = (exponent(least), exponent(most));
    if low <= least && most < high {
        return Some(coordinates);
    }
    let k = high - 1 - most;
    (least + k >= low).then(|| coordinates.map(|x| scale(x, k)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::UNIT_ROUNDOFF;
    use proptest::prelude::*;

    fn exact2d(a: &Point2<f64>, b: &Point2<f64>, c: &Point2<f64>) -> Sign {
        let d = |p: &Point2<f64>, q: &Point2<f64>, i: usize| exact(p[i]) - exact(q[i]);
        Sign::of_exact(&(d(b, a, 0) * d(c, a, 1) - d(b, a, 1) * d(c, a, 0)))
    }

    #[test]
    fn subnormal_turn_is_clockwise() {
        // (0,0), (0,e), (e,0): the determinant is -e^2, which underflows.
        let e = f64::from_bits(1);
        let (o, y, x) = (Point2::new(0.0, 0.0), Point2::new(0.0, e), Point2::new(e, 0.0));
        assert_eq!(orient2d(&o, &y, &x), Sign::Negative);
        let lift = |p: &Point2<f64>| Point3::new(p.x, p.y, 0.0);
        assert_eq!(orient3d(&lift(&o), &lift(&y), &lift(&x), &Point3::new(0.0, 0.0, e)), Sign::Negative);
    }

    #[test]
    fn convention_is_the_right_hand_rule() {
        let (o, x, y) = (Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0));
        assert_eq!(orient3d(&o, &x, &y, &Point3::new(5.0, 5.0, 1e-9)), Sign::Positive);
        assert_eq!(orient2d(&o.xy(), &x.xy(), &y.xy()), Sign::Positive);
    }

    #[test]
    fn every_tier_decides() {
        let tier = |ax: f64, by: f64| {
            orient2d_with_tier(&Point2::new(ax, 0.0), &Point2::new(0.0, by), &Point2::new(ax / 2.0, by / 2.0)).1
        };
        assert_eq!(tier(1.0, 1.0), Tier::Expansion);
        assert_eq!(tier(2f64.powi(-1000), 2f64.powi(-1000)), Tier::Expansion);
        assert_eq!(tier(2f64.powi(1000), 2f64.powi(-1000)), Tier::Rational);
        let (o, x, y) = (Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0));
        assert_eq!(orient3d_with_tier(&o, &x, &y, &Point3::new(0.0, 0.0, 1.0)).1, Tier::Filter);
        assert_eq!(orient3d_with_tier(&o, &x, &y, &Point3::new(0.5, 0.5, 0.0)).1, Tier::Expansion);
        assert_eq!(orient3d_with_tier(&o, &x, &y, &Point3::new(1e300, 1e-300, 0.0)).1, Tier::Rational);
    }

    #[test]
    fn side_of_plane_is_exact_on_it() {
        let n = Vector3::new(0.1, 0.2, -0.3);
        let p = Point3::new(0.3, -0.7, 11.0);
        assert_eq!(side_of_plane_with_tier(&n, &p, &p), (Sign::Zero, Tier::Filter));
        // An ulp of x changes the sign, by less than the filter sees.
        let q = Point3::new(p.x + 3.0, p.y, p.z + 1.0);
        let s = exact::dot(&exact::vector(&n), &exact::difference(&q, &p));
        let (sign, tier) = side_of_plane_with_tier(&n, &p, &q);
        assert_eq!((sign, tier), (Sign::of_exact(&s), Tier::Rational));
        // Across an axis the filter decides whatever the size.
        let up = Vector3::new(0.0, 0.0, -1.0);
        let x = Point3::new(1e300, 7.0, f64::from_bits(1));
        assert_eq!(side_of_plane_with_tier(&up, &Point3::origin(), &x), (Sign::Negative, Tier::Filter));
    }

    #[test]
    fn not_finite_does_not_panic() {
        for bad in [f64::NAN, f64::INFINITY] {
            let p = Point3::new(bad, 0.0, bad);
            orient3d(&p, &p, &Point3::origin(), &p);
            orient2d(&p.xy(), &Point2::origin(), &p.xy());
            side_of_plane(&p.coords, &p, &Point3::origin());
        }
    }

    #[test]
    fn the_bound_of_a_determinant_is_that_of_its_permanent_and_its_column() {
        let p = Point3::<f64>::new;
        let (a, b, c, o) = (p(2.0, 3.0, 5.0), p(7.0, 11.0, 13.0), p(17.0, 19.0, 23.0), Point3::origin());
        // 5 (133 + 187) + 13 (51 + 38) + 23 (22 + 21), and the exact determinant.
        let exact = exact::nearest(&orient3d_exact(&a, &b, &c, &o));
        assert_eq!(orient3d_value(&a, &b, &c, &o), (exact, orient3d_bound(3746.0, 41.0)));
        let up = [2.0, 3.0, 5.0].map(|z| p(0.0, 0.0, z));
        assert_eq!(orient3d_value(&up[0], &up[1], &up[2], &o), (0.0, 12.0 * f64::MIN_POSITIVE));
    }

    #[test]
    fn the_twofold_determinant_is_within_its_bound_however_near_to_the_plane() {
        let t = [[0.1, 0.2, 0.3], [1.3, 0.7, -0.4], [-0.6, 0.9, 0.35]].map(Point3::from);
        let on = Point3::from((t[0].coords + t[1].coords + t[2].coords) / 3.0);
        let normal = (t[1] - t[0]).cross(&(t[2] - t[0]));
        let mut worst: f64 = 0.0;
        for (j, k) in (0..60).flat_map(|j| [-150, 0, 150].map(|k| (j, k))) {
            let [a, b, c, p] = [t[0], t[1], t[2], on + normal * scale(1.0, -j)].map(|q| q.map(|x| scale(x, k)));
            let (value, bound) = orient3d_twofold(&[a, b, c], &p);
            let off = exact::nearest(&(orient3d_exact(&a, &b, &c, &p) - exact(value))).abs();
            assert!(off <= bound, "off by {off:e}, not {bound:e}: 2^-{j} off the plane, scale 2^{k}");
            // 2^-45 off the plane, u^2 of the products is 2^-8 u of what is left of them.
            worst = worst.max(if j <= 45 { bound / value.abs() } else { 0.0 });
        }
        assert!(worst <= 4.0 * UNIT_ROUNDOFF, "known to {worst:e} of itself");
        // Beyond the range of f64 it is no number, and no bound holds.
        let far = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|v| Point3::from(v) * scale(1.0, 1000));
        let (value, bound) = orient3d_twofold(&far, &Point3::origin());
        assert!(value.is_nan() || bound.is_nan() || bound >= value.abs(), "{value} to {bound}");
    }

    #[test]
    fn each_tier_decides_what_the_one_before_cannot() {
        let (o, x, y) = (Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0));
        let spread = Point3::new(2f64.powi(-100), 0.5, 0.0);
        assert_eq!(orient3d_with_tier(&o, &x, &y, &spread), (Sign::Zero, Tier::Expansion));
        // n.x is 2.8e-17 in the unit of n and computed as 5.6e-17, on whichever axes, however small the normal.
        let (n, d) = (Vector3::new(0.1, -0.3, 0.2), Point3::new(3.0, 1.0, 0.0));
        for i in 0..3 {
            let turned = |v: [f64; 3]| [v[i], v[(i + 1) % 3], v[(i + 2) % 3]];
            let (d, n) = (Point3::from(turned(d.into())), Vector3::from(turned(n.into())));
            for k in [-200, 0, 200] {
                let n = n.map(|c| scale(c, k));
                assert_eq!(side_of_plane_with_tier(&n, &o, &d), (Sign::Positive, Tier::Rational), "axis {i}, 2^{k}");
                assert_eq!(side_of_plane_with_tier(&n, &o, &(o - n)), (Sign::Negative, Tier::Filter));
            }
        }
        for (n, sign) in [(2.0, Sign::Positive), (-2.0, Sign::Negative)] {
            let (n, d) = (Vector3::new(0.0, n, 0.0), Point3::new(1e300, f64::from_bits(1), 1.0));
            assert_eq!(side_of_plane_with_tier(&n.map(|c| scale(c, -1000)), &o, &d), (sign, Tier::Filter));
        }
    }

    /// A small multiple of a random power of two: collinear and coplanar points are common.
    fn coordinate() -> impl Strategy<Value = f64> {
        (-4i32..5, prop_oneof![Just(0i32), -1040i32..1000], 0u64..3)
            .prop_map(|(m, k, ulps)| f64::from_bits(scale(f64::from(m), k).to_bits() + ulps))
    }

    proptest! {
        #[test]
        fn swapping_reverses_and_tiers_agree(c in prop::array::uniform12(coordinate())) {
            let p: [Point3<f64>; 4] = std::array::from_fn(|i| Point3::new(c[3 * i], c[3 * i + 1], c[3 * i + 2]));
            let s = orient3d(&p[0], &p[1], &p[2], &p[3]);
            prop_assert_eq!(s, Sign::of_exact(&orient3d_exact(&p[0], &p[1], &p[2], &p[3])));
            prop_assert_eq!(s.reverse(), orient3d(&p[1], &p[0], &p[2], &p[3]));
            prop_assert_eq!(s.reverse(), orient3d(&p[0], &p[1], &p[3], &p[2]));
            let q = p.map(|p| p.xy());
            let s = orient2d(&q[0], &q[1], &q[2]);
            prop_assert_eq!(s, exact2d(&q[0], &q[1], &q[2]));
            prop_assert_eq!(s.reverse(), orient2d(&q[0], &q[2], &q[1]));
            let n = p[3].coords;
            let s = exact::dot(&exact::vector(&n), &exact::difference(&p[0], &p[1]));
            prop_assert_eq!(side_of_plane(&n, &p[1], &p[0]), Sign::of_exact(&s));
        }
    }
}
