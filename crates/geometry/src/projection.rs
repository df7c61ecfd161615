//! Projection along the dominant axis of a normal (R43): the coordinate with the largest |n_i| is dropped.

use nalgebra::{Point2, Point3, Vector3};

/// The axis along which a polygon is seen at its largest.
///
/// ```
/// use carom_geometry::nalgebra::{Point2, Point3, Vector3};
/// use carom_geometry::projection::DominantAxis;
///
/// // A plane that faces along y is looked at from there: what is left of (x, y, z) is (z, x).
/// let axis = DominantAxis::of(&Vector3::new(0.1, -0.9, 0.3));
/// assert_eq!(axis, DominantAxis::Y);
/// assert_eq!(axis.project(&Point3::new(1.0, 2.0, 3.0)), Point2::new(3.0, 1.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DominantAxis {
    /// Drop x, keep (y, z).
    X,
    /// Drop y, keep (z, x).
    Y,
    /// Drop z, keep (x, y).
    Z,
}

impl DominantAxis {
    /// The axis of the largest |n_i|; of equals, the first.
    pub fn of(normal: &Vector3<f64>) -> Self {
        let [x, y, z] = [normal.x.abs(), normal.y.abs(), normal.z.abs()];
        if x >= y && x >= z {
            Self::X
        } else if y >= z {
            Self::Y
        } else {
            Self::Z
        }
    }

    /// The index of the dropped coordinate.
    pub fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Z => 2,
        }
    }

    /// The other two coordinates in cyclic order, bit for bit.
    ///
    /// What turns counterclockwise seen against the normal does so in the projection too if the dropped component of the normal is
    /// positive; if it is negative, the projection is a mirror image and every orientation is reversed.
    pub fn project(self, p: &Point3<f64>) -> Point2<f64> {
        match self {
            Self::X => Point2::new(p.y, p.z),
            Self::Y => Point2::new(p.z, p.x),
            Self::Z => Point2::new(p.x, p.y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predicates::{Sign, orient2d};

    #[test]
    fn r43_drops_the_largest_component_and_keeps_the_cyclic_order() {
        let p = Point3::new(1.0, 2.0, 3.0);
        for (n, axis, q) in [
            (Vector3::new(-3.0, 2.0, 1.0), DominantAxis::X, Point2::new(2.0, 3.0)),
            (Vector3::new(1.0, -3.0, 2.0), DominantAxis::Y, Point2::new(3.0, 1.0)),
            (Vector3::new(1.0, 2.0, 3.0), DominantAxis::Z, Point2::new(1.0, 2.0)),
            (Vector3::new(1.0, 1.0, 1.0), DominantAxis::X, Point2::new(2.0, 3.0)),
            (Vector3::new(0.0, 1.0, -1.0), DominantAxis::Y, Point2::new(3.0, 1.0)),
        ] {
            assert_eq!(DominantAxis::of(&n), axis, "of {n:?}");
            assert_eq!(axis.project(&p), q);
            assert_eq!(axis.index(), n.iamax().min(axis.index()));
        }
    }

    #[test]
    fn r43_orientation_follows_the_sign_of_the_dropped_component() {
        let (a, b, c) = (Point3::new(0.0, 0.0, 0.0), Point3::new(2.0, 0.3, 0.1), Point3::new(0.2, 2.0, -0.4));
        let turned = |p: &Point3<f64>, k: usize| Point3::new(p[k % 3], p[(k + 1) % 3], p[(k + 2) % 3]);
        for k in 0..3 {
            let [a, b, c] = [&a, &b, &c].map(|p| turned(p, k));
            for (b, c) in [(b, c), (c, b)] {
                let n = (b - a).cross(&(c - a));
                let axis = DominantAxis::of(&n);
                let expected = Sign::of(n[axis.index()]);
                assert_eq!(orient2d(&axis.project(&a), &axis.project(&b), &axis.project(&c)), expected);
            }
        }
    }
}
