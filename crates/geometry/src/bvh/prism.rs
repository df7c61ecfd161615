//! What a query can reach, as a box in coordinates that are sheared along it.

use super::FatSegment;
use crate::bounds::{Aabb, largest, least};
use crate::rounding::{gamma, prism_bound, sheared_bound};
use crate::shear::Shear;

/// A box in sheared coordinates that holds all that a query can reach, with room for the rounding of the coordinates that are held against it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prism {
    /// The shear, of slope 0 where it has no direction.
    pub(super) shear: Shear,
    /// The sides of the box, across and along.
    pub(super) least: [f64; 3],
    pub(super) most: [f64; 3],
    /// A bound on the error of how two of the points turn about the line.
    pub(super) turn_bound: f64,
}

impl Prism {
    /// Around a fat segment, of which `shear` is the shear, for points in `bounds`.
    #[inline]
    pub(super) fn around(segment: &FatSegment, shear: &Shear, bounds: &Aabb) -> Self {
        let FatSegment { from, to, radius } = segment;
        // How far points can be from the start, summed over the axes; NaN or infinite where something is not finite.
        let reach = |i: usize| largest((bounds.min()[i] - from[i]).abs(), (bounds.max()[i] - from[i]).abs());
        let size = reach(0) + reach(1) + reach(2);
        let ends = (to.x - from.x) + (to.y - from.y) + (to.z - from.z) + radius;
        let bound = prism_bound(size) + 0.0 * ends;
        let slopes = shear.slopes.map(|slope| if slope.is_nan() { 0.0 } else { slope });
        let radius = largest(*radius, 0.0);
        let wide = |slope: f64| radius * (1.0 + slope * slope).sqrt() * (1.0 + gamma(8)) + bound;
        let ([u, v], w) = (slopes.map(wide), radius + bound);
        let ends = [least(shear.length, 0.0), largest(shear.length, 0.0)].map(|end| end * (1.0 + gamma(4)));
        let prism = Self {
            shear: Shear { slopes, ..*shear },
            least: [-u, -v, ends[0] - w],
            most: [u, v, ends[1] + w],
            turn_bound: sheared_bound(size, size),
        };
        if bound.is_finite() {
            prism
        } else {
            Self { least: [f64::NEG_INFINITY; 3], most: [f64::INFINITY; 3], ..prism }
        }
    }

    /// The coordinate `i` of the point that becomes the origin, of a shear along `axis`.
    #[inline(always)] // so that the axis is in the instructions
    pub(super) fn origin(&self, i: usize, axis: usize) -> f64 {
        self.shear.origin[(i + 5 - axis) % 3]
    }

    /// A box, in which there is nothing to shear and nothing to round.
    pub(super) fn of_box(query: &Aabb) -> Self {
        Self {
            shear: Shear { axis: 2, origin: [0.0; 3], slopes: [0.0; 2], length: 0.0 },
            least: query.min().coords.into(),
            most: query.max().coords.into(),
            turn_bound: 0.0,
        }
    }
}
