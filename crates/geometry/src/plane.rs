//! Planes: signed distance, sides, and the clearance of a ball (R4 to R6).

use crate::error::PlaneError;
use crate::normal::{unit, unit_normal};
use crate::predicates::{Sign, side_of_plane};
use crate::rounding::{exponent, scale, signed_distance_bound};
use nalgebra::{Point3, UnitVector3, Vector3};

/// A side of a plane: the one its normal points to is the positive one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// n.(x - p) > 0.
    Positive,
    /// n.(x - p) < 0.
    Negative,
}

impl Side {
    /// 1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }
}

/// An infinite plane: the points x with n.(x - p) = 0 (R4), n of length 1 to rounding.
///
/// The plane *is* the stored p and n; every answer, exact or bounded, is about them.
///
/// ```
/// use carom_geometry::nalgebra::{Point3, Vector3};
/// use carom_geometry::plane::{Plane, Side};
///
/// // From a point and a normal of any length; also from A, B, C, D, or through three points.
/// let floor = Plane::from_point_normal(Point3::origin(), Vector3::new(0.0, 0.0, 5.0))?;
/// assert_eq!(floor.signed_distance(&Point3::new(7.0, 0.0, -2.0)), -2.0);
/// // Sides are exact, however close the point is.
/// assert_eq!(floor.side_of(&Point3::new(1.0, 1.0, f64::MIN_POSITIVE)), Some(Side::Positive));
/// // The room that a ball has: the distance on its side, less its radius.
/// assert_eq!(floor.clearance(&Point3::new(0.0, 0.0, 2.0), 0.5, Side::Positive), 1.5);
/// # Ok::<(), carom_geometry::error::PlaneError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    point: Point3<f64>,
    normal: UnitVector3<f64>,
}

impl Plane {
    /// The plane through `point` across `normal`, which is normalised: of any size, but finite and not zero.
    ///
    /// A normal of length 1 to rounding is kept bit for bit, and one along an axis becomes exactly that axis.
    pub fn from_point_normal(point: Point3<f64>, normal: Vector3<f64>) -> Result<Self, PlaneError> {
        require_finite(["point x", "point y", "point z"], point.into())?;
        require_finite(["normal x", "normal y", "normal z"], normal.into())?;
        let normal = unit(&normal).ok_or(PlaneError::ZeroNormal)?;
        Ok(Self { point, normal })
    }

    /// The plane A x + B y + C z + D = 0 (R4), with the normal (A, B, C) / |(A, B, C)|.
    ///
    /// Its point is the one nearest to the origin, rounded: off the plane by a few u of its distance from the origin at
    /// most, and by one rounding if (A, B, C) lies along an axis.
    pub fn from_coefficients(a: f64, b: f64, c: f64, d: f64) -> Result<Self, PlaneError> {
        require_finite(["coefficient A", "coefficient B", "coefficient C"], [a, b, c])?;
        require_finite(["coefficient D"], [d])?;
        let v = Vector3::new(a, b, c);
        let normal = unit(&v).ok_or(PlaneError::ZeroNormal)?;
        let k = exponent(v.amax());
        let length = v.map(|x| scale(x, -k)).norm();
        let distance = scale(-d / length, -k);
        // Adding 0 turns -0 into 0.
        let point = Point3::from(normal.into_inner() * distance).map(|c| c + 0.0);
        if !distance.is_finite() {
            return Err(PlaneError::OutOfRange { offset: d, length: v.amax() });
        }
        Ok(Self { point, normal })
    }

    /// The plane through three points, with the normal (p1 - p0) x (p2 - p0) / |...| (R39) and the point p0.
    ///
    /// The normal is accurate however thin the triangle is ([`unit_normal`]). Points on one line, decided exactly, are refused.
    pub fn through(p0: Point3<f64>, p1: Point3<f64>, p2: Point3<f64>) -> Result<Self, PlaneError> {
        for p in [p0, p1, p2] {
            require_finite(["point x", "point y", "point z"], p.into())?;
        }
        let points = [p0, p1, p2];
        let normal = unit_normal(&points).ok_or(PlaneError::Collinear { points })?;
        Ok(Self { point: p0, normal })
    }

    /// A plane of parts that are known to be finite.
    pub(crate) fn from_parts(point: Point3<f64>, normal: UnitVector3<f64>) -> Self {
        Self { point, normal }
    }

    /// A point of the plane.
    pub fn point(&self) -> Point3<f64> {
        self.point
    }

    /// The unit normal.
    pub fn normal(&self) -> UnitVector3<f64> {
        self.normal
    }

    /// (A, B, C, D) with (A, B, C) the unit normal and D = -n.p, rounded.
    pub fn coefficients(&self) -> [f64; 4] {
        [self.normal.x, self.normal.y, self.normal.z, -self.normal.dot(&self.point.coords)]
    }

    /// d = n.(x - p) (R5), in the unit of the coordinates: positive where the normal points to.
    ///
    /// Rounded: off by [`distance_bound`](Self::distance_bound) at most. Finite for coordinates below 2^1021.
    pub fn signed_distance(&self, x: &Point3<f64>) -> f64 {
        self.normal.dot(&(x - self.point))
    }

    /// How far [`signed_distance`](Self::signed_distance) may be from n.(x - p) of the stored n and p.
    pub fn distance_bound(&self, x: &Point3<f64>) -> f64 {
        let terms = self.normal.component_mul(&(x - self.point)).abs();
        signed_distance_bound(terms.x + terms.y + terms.z)
    }

    /// The side on which `x` lies, exactly; none on the plane.
    pub fn side_of(&self, x: &Point3<f64>) -> Option<Side> {
        match side_of_plane(&self.normal, &self.point, x) {
            Sign::Positive => Some(Side::Positive),
            Sign::Zero => None,
            Sign::Negative => Some(Side::Negative),
        }
    }

    /// How far a ball of `radius` with its centre at `x` is from touching, seen from `side`: positive while it is free, zero
    /// when it touches, negative when it overlaps the plane or is beyond it.
    ///
    /// On the positive side this is d - r; on the negative side it is -(d + r), the slides' d + r (R6) with the sign turned, so that
    /// free is positive on both. The side is decided once and remembered: |d| - r would count a ball that has passed
    /// the plane as free again.
    pub fn clearance(&self, x: &Point3<f64>, radius: f64, side: Side) -> f64 {
        side.sign() * self.signed_distance(x) - radius
    }
}

fn require_finite<const N: usize>(names: [&'static str; N], values: [f64; N]) -> Result<(), PlaneError> {
    match names.into_iter().zip(values).find(|(_, v)| !v.is_finite()) {
        Some((name, value)) => Err(PlaneError::NotFinite { name, value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact;
    use crate::rounding::UNIT_ROUNDOFF;
    use proptest::prelude::*;

    #[test]
    fn r04_three_constructors_give_one_plane() {
        // 2x - 3y + 6z - 14 = 0: |(2, -3, 6)| = 7, nearest point (4, -6, 12)/7.
        let a = Plane::from_coefficients(2.0, -3.0, 6.0, -14.0).unwrap();
        let b = Plane::from_point_normal(Point3::new(7.0, 0.0, 0.0), Vector3::new(2e150, -3e150, 6e150)).unwrap();
        let c = Plane::through(Point3::new(7.0, 0.0, 0.0), Point3::new(1.0, 0.0, 2.0), Point3::new(4.0, -2.0, 0.0))
            .unwrap();
        let n = Vector3::new(2.0, -3.0, 6.0) / 7.0;
        for plane in [a, b, c] {
            let sign = plane.normal().dot(&n).signum();
            assert!((plane.normal().into_inner() * sign - n).amax() <= 4.0 * UNIT_ROUNDOFF);
            assert!((plane.coefficients()[3] * sign + 2.0).abs() <= 16.0 * UNIT_ROUNDOFF);
            assert!((plane.signed_distance(&Point3::origin()) * sign + 2.0).abs() <= 16.0 * UNIT_ROUNDOFF);
        }
        assert!((a.point() - Point3::new(4.0, -6.0, 12.0) / 7.0 * 1.0).amax() <= 8.0 * UNIT_ROUNDOFF);
    }

    #[test]
    fn r04_axis_planes_are_exact_at_every_size() {
        for (c, d, z) in [(1.0, -0.5, 0.5), (-2.0, 1.0, 0.5), (1e-200, -3e-200, 3e-200 / 1e-200), (-4e200, 8e200, 2.0)]
        {
            let plane = Plane::from_coefficients(0.0, 0.0, c, d).unwrap();
            assert_eq!(plane.normal().into_inner(), Vector3::new(0.0, 0.0, f64::signum(c)));
            assert_eq!(plane.point(), Point3::new(0.0, 0.0, z));
            assert!(plane.point().iter().all(|c| c.is_sign_positive()), "no negative zero");
        }
        let up = Plane::from_point_normal(Point3::origin(), Vector3::new(0.0, 0.0, 1e-320)).unwrap();
        assert_eq!(up.normal().into_inner(), Vector3::z());
    }

    #[test]
    fn r04_refuses_what_is_no_plane() {
        let o = Point3::origin();
        assert_eq!(Plane::from_point_normal(o, Vector3::zeros()), Err(PlaneError::ZeroNormal));
        assert_eq!(Plane::from_coefficients(0.0, -0.0, 0.0, 1.0), Err(PlaneError::ZeroNormal));
        let bad = f64::INFINITY;
        assert_eq!(
            Plane::from_coefficients(0.0, 1.0, 0.0, bad),
            Err(PlaneError::NotFinite { name: "coefficient D", value: bad })
        );
        assert!(Plane::from_point_normal(Point3::new(0.0, f64::NAN, 0.0), Vector3::x()).is_err());
        assert!(matches!(Plane::from_coefficients(1e-200, 0.0, 0.0, 1e200), Err(PlaneError::OutOfRange { .. })));
        let (p, q) = (Point3::new(0.1, 0.1, 0.1), Point3::new(0.3, 0.3, 0.3));
        assert!(matches!(Plane::through(o, p, q), Err(PlaneError::Collinear { .. })));
        assert!(Plane::through(o, p, Point3::new(0.3, 0.3, 0.3f64.next_up())).is_ok());
    }

    #[test]
    fn r06_clearance_is_d_minus_r_above_and_turned_d_plus_r_below() {
        let plane = Plane::from_point_normal(Point3::new(0.0, 0.0, 1.0), Vector3::z()).unwrap();
        let at = |z: f64| Point3::new(3.0, -2.0, z);
        assert_eq!(plane.clearance(&at(1.5), 0.25, Side::Positive), 0.25);
        assert_eq!(plane.clearance(&at(0.5), 0.25, Side::Negative), 0.25);
        // Through the plane: not free again.
        assert_eq!(plane.clearance(&at(0.5), 0.25, Side::Positive), -0.75);
        assert_eq!(plane.side_of(&at(1.0)), None);
        assert_eq!(plane.side_of(&at(1f64.next_up())), Some(Side::Positive));
        assert_eq!(plane.side_of(&at(1f64.next_down())), Some(Side::Negative));
    }

    proptest! {
        #[test]
        fn r05_signed_distance_is_within_its_bound(c in prop::array::uniform9(-1e3f64..1e3), k in -300i32..300, near in any::<bool>()) {
            let c = c.map(|x| scale(x, k));
            let plane = Plane::from_point_normal(Point3::new(c[0], c[1], c[2]), Vector3::new(c[3], c[4], c[5])).unwrap();
            let mut x = Point3::new(c[6], c[7], c[8]);
            if near {
                x -= plane.normal().into_inner() * plane.signed_distance(&x);
            }
            let d = exact::dot(&exact::vector(&plane.normal()), &exact::difference(&x, &plane.point()));
            let error = exact::nearest(&(exact::exact(plane.signed_distance(&x)) - &d)).abs();
            prop_assert!(error <= plane.distance_bound(&x), "{error:e} above {:e}", plane.distance_bound(&x));
            prop_assert_eq!(plane.side_of(&x).map_or(Sign::Zero, |s| Sign::of(s.sign())), Sign::of_exact(&d));
        }
    }
}
