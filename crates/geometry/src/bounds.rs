//! Axis-aligned boxes.

use nalgebra::{Point3, Vector3};

/// A closed axis-aligned box of points, in the unit of its points, usually m; possibly empty.
///
/// Its corners are those of the points it was made of, without rounding, so that [`contains`](Self::contains) and
/// [`intersects`](Self::intersects) are exact. Only [`inflate`](Self::inflate) rounds, and it rounds outwards.
///
/// ```
/// use carom_geometry::bounds::Aabb;
/// use carom_geometry::nalgebra::{Point3, Vector3};
///
/// let bounds = Aabb::of_points(&[Point3::origin(), Point3::new(2.0, 4.0, 6.0)]);
/// assert_eq!((bounds.extent(), bounds.centre()), (Vector3::new(2.0, 4.0, 6.0), Point3::new(1.0, 2.0, 3.0)));
/// assert!(bounds.inflate(1.0).contains(&Point3::new(-1.0, 0.0, 0.0)));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    min: Point3<f64>,
    max: Point3<f64>,
}

impl Aabb {
    /// The box without a point: the neutral element of [`union`](Self::union).
    pub fn empty() -> Self {
        let inf = f64::INFINITY;
        Self { min: Point3::new(inf, inf, inf), max: Point3::new(-inf, -inf, -inf) }
    }

    /// The least box with all of `points`; empty without any. A NaN coordinate is ignored.
    pub fn of_points<'a>(points: impl IntoIterator<Item = &'a Point3<f64>>) -> Self {
        // `f64::min` and `max` leave a NaN out; nalgebra's `inf` and `sup` promise nothing about it.
        points.into_iter().fold(Self::empty(), |b, p| Self {
            min: b.min.coords.zip_map(&p.coords, f64::min).into(),
            max: b.max.coords.zip_map(&p.coords, f64::max).into(),
        })
    }

    /// The corner with the least coordinates; all +infinity for the empty box.
    pub fn min(&self) -> &Point3<f64> {
        &self.min
    }

    /// The corner with the largest coordinates; all -infinity for the empty box.
    pub fn max(&self) -> &Point3<f64> {
        &self.max
    }

    /// Whether there is no point in the box.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|i| self.min[i] > self.max[i])
    }

    /// The least box with both `self` and `other`.
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// The box moved outwards by `r` >= 0 on every side, each coordinate rounded outwards: every point within `r` of
    /// the box is in it. Empty stays empty, and `r` = 0 changes nothing.
    pub fn inflate(&self, r: f64) -> Self {
        if self.is_empty() || r == 0.0 {
            return *self;
        }
        Self { min: self.min.map(|c| (c - r).next_down()), max: self.max.map(|c| (c + r).next_up()) }
    }

    /// Whether `x` is in the closed box.
    pub fn contains(&self, x: &Point3<f64>) -> bool {
        (0..3).all(|i| self.min[i] <= x[i] && x[i] <= self.max[i])
    }

    /// Whether the two closed boxes have a point in common; touching counts, and nothing meets an empty box.
    pub fn intersects(&self, other: &Self) -> bool {
        (0..3).all(|i| self.min[i].max(other.min[i]) <= self.max[i].min(other.max[i]))
    }

    /// Whether the ray from `x` along `direction`, of any length, meets the closed box; with no direction, whether `x` is in it.
    /// Computed in plain f64: at a graze either answer may come.
    pub fn is_ahead(&self, x: &Point3<f64>, direction: &Vector3<f64>) -> bool {
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for i in 0..3 {
            if direction[i] == 0.0 {
                // The ray never leaves this slab, or never is in it.
                if !(self.min[i] <= x[i] && x[i] <= self.max[i]) {
                    return false;
                }
                continue;
            }
            let [a, b] = [self.min[i], self.max[i]].map(|side| (side - x[i]) / direction[i]);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter <= leave && !self.is_empty()
    }

    /// Whether the box is certain to have no point within `radius` of the segment from `a` to `b`, but for the rounding of a sum.
    #[inline]
    pub(crate) fn is_off(&self, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> bool {
        (0..3).any(|i| least(a[i], b[i]) - radius > self.max[i] || largest(a[i], b[i]) + radius < self.min[i])
    }

    /// The lengths of the sides; zero for an empty box, infinite where f64 has no such length.
    pub fn extent(&self) -> Vector3<f64> {
        if self.is_empty() { Vector3::zeros() } else { self.max - self.min }
    }

    /// The middle of the box; the origin for an empty one. Does not overflow.
    pub fn centre(&self) -> Point3<f64> {
        if self.is_empty() { Point3::origin() } else { self.min.map(|c| c / 2.0) + self.max.coords / 2.0 }
    }
}

/// The smaller of two numbers, neither of them NaN: one instruction, where `f64::min` takes five.
#[inline]
pub(crate) fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger of two numbers, neither of them NaN.
#[inline]
pub(crate) fn largest(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The largest |component| of a vector, none of them NaN.
#[inline]
pub fn amax(v: &Vector3<f64>) -> f64 {
    largest(largest(v.x.abs(), v.y.abs()), v.z.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit() -> Aabb {
        Aabb::of_points(&[Point3::new(1.0, 0.0, 1.0), Point3::new(0.0, 1.0, 0.0)])
    }

    #[test]
    fn corners_are_those_of_the_points() {
        assert_eq!((*unit().min(), *unit().max()), (Point3::origin(), Point3::new(1.0, 1.0, 1.0)));
        assert_eq!(unit().extent(), Vector3::new(1.0, 1.0, 1.0));
        assert_eq!(unit().centre(), Point3::new(0.5, 0.5, 0.5));
        let nan = Point3::new(f64::NAN, 7.0, f64::NAN);
        let with = Aabb::of_points(&[nan, Point3::origin(), nan]);
        assert_eq!((*with.min(), *with.max()), (Point3::origin(), Point3::new(0.0, 7.0, 0.0)));
    }

    #[test]
    fn the_empty_box_is_neutral_and_meets_nothing() {
        let empty = Aabb::of_points(&[]);
        assert!(empty.is_empty() && empty.inflate(1.0).is_empty() && !unit().is_empty());
        assert_eq!(empty.union(&unit()), unit());
        assert!(!empty.intersects(&unit()) && !unit().intersects(&empty) && !empty.intersects(&empty));
        assert!(!empty.contains(&Point3::origin()));
        assert_eq!((empty.extent(), empty.centre()), (Vector3::zeros(), Point3::origin()));
    }

    #[test]
    fn touching_counts_to_the_last_bit() {
        let corner = Point3::new(1.0, 1.0, 1.0);
        let beyond = Point3::new(1.0_f64.next_up(), 1.0, 1.0);
        assert!(unit().contains(&corner) && unit().intersects(&Aabb::of_points(&[corner])));
        assert!(!unit().contains(&beyond) && !unit().intersects(&Aabb::of_points(&[beyond])));
    }

    #[test]
    fn ahead_is_what_a_ray_meets() {
        let down = Vector3::new(0.0, 0.0, -2.0);
        for (x, y, z, ahead) in [
            (0.5, 0.5, 9.0, true),
            (0.5, 0.5, 0.5, true),
            (0.5, 0.5, -0.1, false),
            (1.5, 0.5, 9.0, false),
            (1.0, 0.0, 1.0, true),
        ] {
            assert_eq!(unit().is_ahead(&Point3::new(x, y, z), &down), ahead, "({x}, {y}, {z})");
        }
        let from = Point3::new(-1.0, -1.0, -1.0);
        assert!(unit().is_ahead(&from, &Vector3::new(1.0, 1.0, 1.0)) && !unit().is_ahead(&from, &-Vector3::x()));
        assert!(!unit().is_ahead(&from, &Vector3::new(1.0, 3.0, 1.0)) && !unit().is_ahead(&from, &Vector3::zeros()));
        assert!(unit().is_ahead(&Point3::new(-1.0, -4.0, -1.0), &Vector3::new(1.0, 3.0, 1.0)));
        assert!(unit().is_ahead(&unit().centre(), &Vector3::zeros()));
        assert!(!Aabb::empty().is_ahead(&from, &Vector3::new(1.0, 1.0, 1.0)));
    }

    #[test]
    fn inflation_rounds_outwards() {
        let b = Aabb::of_points(&[Point3::new(1.0, 1e300, 5e-324)]);
        // Each of these radii is lost when it is added to 1 or to 1e300.
        for r in [5e-324, 1e-17, 0.1] {
            let big = b.inflate(r);
            for i in 0..3 {
                assert!(big.min()[i] < b.min()[i] && b.max()[i] < big.max()[i], "axis {i}, r {r}");
            }
        }
        assert_eq!(b.inflate(0.0), b);
    }

    #[test]
    fn the_largest_boxes_have_a_centre() {
        let b = Aabb::of_points(&[Point3::new(-f64::MAX, 0.0, f64::MAX), Point3::new(f64::MAX, 0.0, f64::MAX)]);
        assert_eq!(b.centre(), Point3::new(0.0, 0.0, f64::MAX));
    }
}
