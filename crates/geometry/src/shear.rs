//! Shearing along the longest axis of a segment, which brings its line to one point of the plane across.

use crate::bounds::amax;
use nalgebra::Point3;

/// The shear that takes the line through two points to the axis along which they are farthest apart, and the first of them to the origin.
///
/// What it makes of a point are two coordinates across, in which the line is at (0, 0), and one along.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shear {
    /// The axis along which it shears; `(axis + 1) % 3` and `(axis + 2) % 3` are those across.
    pub(crate) axis: usize,
    /// The coordinates of the first point across and along.
    pub(crate) origin: [f64; 3],
    /// How far the line moves across for each unit along; NaN where it has no direction.
    pub(crate) slopes: [f64; 2],
    /// How far the second point is from the first along the axis.
    pub(crate) length: f64,
}

impl Shear {
    /// Along the line from `p0` to `p1`.
    pub(crate) fn new(p0: &Point3<f64>, p1: &Point3<f64>) -> Self {
        let d = p1 - p0;
        let most = amax(&d);
        let axis = if d.z.abs() == most {
            2
        } else if d.y.abs() == most {
            1
        } else {
            0
        };
        let along = |v: [f64; 3]| [v[(axis + 1) % 3], v[(axis + 2) % 3], v[axis]];
        let [next, last, length] = along(d.into());
        // A difference beyond the range of f64 has no slopes that are right to rounding.
        let long = if most.is_finite() { length } else { f64::NAN };
        Self { axis, origin: along(p0.coords.into()), slopes: [next / long, last / long], length }
    }

    /// A point across and along, given as one is seen along the axis [`AXIS`](Self::axis).
    #[inline(always)] // so that the places of the coordinates are in the instructions
    pub(crate) fn of<const AXIS: usize>(&self, v: &Point3<f64>) -> [f64; 3] {
        let along = v[AXIS] - self.origin[2];
        let across = |i: usize| v[(AXIS + 1 + i) % 3] - self.origin[i] - self.slopes[i] * along;
        [across(0), across(1), along]
    }
}
