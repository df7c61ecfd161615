//! A cheap certificate that the line of a segment passes a triangle, or passes through it, for many triangles.

use crate::bounds::{amax, largest};
use crate::rounding::sheared_bound;
use nalgebra::Point3;

/// A segment, and the shear along its longest axis that brings its line to one point of the plane across: there, a side of a triangle is passed
/// on the side on which it turns about that point (Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection").
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sheared {
    ends: [Point3<f64>; 2],
    /// The axis along which it is longest, last, after the two others.
    axes: [usize; 3],
    /// By how much a point moves along the others for each unit along the last; NaN where it has no direction.
    slopes: [f64; 2],
}

/// Where the line of a segment passes a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Passage {
    /// Beside it, for certain.
    Outside,
    /// Through its inner, for certain; the triangle then has an area, and the line is not in its plane.
    Inside,
    /// As near to an edge as rounding cannot tell.
    Near,
}

impl Sheared {
    /// The segment from `p0` to `p1`.
    pub(crate) fn new(p0: &Point3<f64>, p1: &Point3<f64>) -> Self {
        let d = p1 - p0;
        let most = amax(&d);
        let axes = if d.z.abs() == most {
            [0, 1, 2]
        } else if d.y.abs() == most {
            [2, 0, 1]
        } else {
            [1, 2, 0]
        };
        // A difference beyond the range of f64 has no slopes that are right to rounding.
        let length = if most.is_finite() { d[axes[2]] } else { f64::NAN };
        Self { ends: [*p0, *p1], axes, slopes: [d[axes[0]] / length, d[axes[1]] / length] }
    }

    /// From where to where it runs.
    pub(super) fn ends(&self) -> [&Point3<f64>; 2] {
        self.ends.each_ref()
    }

    /// Where its line passes a triangle.
    #[inline]
    pub(super) fn passage(&self, triangle: &[Point3<f64>; 3]) -> Passage {
        let (p, [i, j, k], [to_i, to_j]) = (&self.ends[0], self.axes, self.slopes);
        let sheared = |v: &Point3<f64>| {
            let z = v[k] - p[k];
            [v[i] - p[i] - to_i * z, v[j] - p[j] - to_j * z, z]
        };
        let [a, b, c] = triangle.each_ref().map(sheared);
        let most = |i: usize| largest(largest(a[i].abs(), b[i].abs()), c[i].abs());
        let bound = sheared_bound(largest(most(0), most(1)), most(2));
        let turn = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[1] - a[1] * b[0];
        let turns = [turn(&a, &b), turn(&b, &c), turn(&c, &a)];
        // No comparison with a NaN is true.
        let (left, right) = (turns.map(|t| t > bound), turns.map(|t| t < -bound));
        let (any, all) = (|of: [bool; 3]| of[0] | of[1] | of[2], |of: [bool; 3]| of[0] & of[1] & of[2]);
        if any(left) & any(right) {
            Passage::Outside
        } else if all(left) | all(right) {
            Passage::Inside
        } else {
            Passage::Near
        }
    }
}
