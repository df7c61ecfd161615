//! The tree's own coordinates, and queries in them with room for every rounding.

use super::FatSegment;
use crate::bounds::{Aabb, largest};
use crate::rounding::{UNIT_ROUNDOFF, UNIT_ROUNDOFF_F32, gamma, segment_bound, segment_bound_f32};

/// A margin beyond this is so much larger than the tree, which has a half extent of 1, that no box can be told apart.
const HOPELESS: f64 = 1048576.0;
/// Ends within this many half extents need no clipping before they become f32.
const NEAR: f64 = 4.0;
/// Components of a direction below 2^-60 are taken as this: it moves the segment by far less than what
/// [`segment_bound_f32`] leaves over, and there is no division by zero, no infinity and no NaN.
const LEAST_STEP: f32 = 1.0 / (1u64 << 60) as f32;

/// The map from the caller's coordinates to the tree's: x * scale - centre. Boxes of the tree come to lie in [-1, 1].
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    /// A power of two; 0 if everything is at one point.
    scale: f64,
    /// The middle of everything, already scaled. Any value would be right.
    centre: [f64; 3],
}

/// A fat segment in the tree's coordinates: the part that is near the tree, from `start` to `end` in the caller's s.
#[derive(Debug, Clone, Copy)]
pub(super) struct LocalSegment {
    start: f64,
    end: f64,
    /// For each axis: whether the planes with the lower coordinates are met first, and the points from which the near and the far one are
    /// measured.
    pub(super) forward: [bool; 3],
    pub(super) near_from: [f32; 3],
    pub(super) far_from: [f32; 3],
    pub(super) inverse: [f32; 3],
}

impl Frame {
    pub(super) fn of(bounds: &Aabb) -> Self {
        if bounds.is_empty() {
            return Self { scale: 0.0, centre: [0.0; 3] };
        }
        let half = (0..3).fold(0.0, |h: f64, i| h.max(bounds.max()[i] / 2.0 - bounds.min()[i] / 2.0));
        let scale = scale_to_one(half);
        let centre = [0, 1, 2].map(|i| bounds.min()[i] * scale / 2.0 + bounds.max()[i] * scale / 2.0);
        Self { scale, centre }
    }

    /// x * scale is exact or lost in the margin; the difference has one rounding.
    fn local(&self, x: &nalgebra::Point3<f64>) -> [f64; 3] {
        [0, 1, 2].map(|i| x[i] * self.scale - self.centre[i])
    }

    /// A box of the tree in f32, rounded outwards from `local`, whose own rounding the queries' margins cover.
    pub(super) fn item_box(&self, b: &Aabb) -> ([f32; 3], [f32; 3]) {
        (self.local(b.min()).map(round_down), self.local(b.max()).map(round_up))
    }

    /// The box of a query in f32, with a margin for the rounding of `local` on both sides. Beyond 2 nothing is lost.
    pub(super) fn outer_box(&self, b: &Aabb) -> ([f32; 3], [f32; 3]) {
        let margin = |v: f64| segment_bound(v.abs() + 1.0);
        let lo = self.local(b.min()).map(|v| v.clamp(-2.0, 2.0)).map(|v| round_down(v - margin(v)));
        let hi = self.local(b.max()).map(|v| v.clamp(-2.0, 2.0)).map(|v| round_up(v + margin(v)));
        (lo, hi)
    }

    /// The query, or `None` if it is certain to miss everything.
    #[inline]
    pub(super) fn segment(&self, query: &FatSegment, bounds: &Aabb) -> Option<LocalSegment> {
        let FatSegment { from, to, radius } = query;
        let (a, b) = (self.local(from), self.local(to));
        let reach = largest_of(&a, &b);
        // Zero, unless one of them is not finite.
        let zero = (0.0 * from.x + 0.0 * from.y + 0.0 * from.z) + (0.0 * to.x + 0.0 * to.y + 0.0 * to.z) + 0.0 * radius;
        let wide = largest(*radius, 0.0) * self.scale + segment_bound(reach);
        // Not finite is not near.
        let is_near = (reach <= NEAR) & (wide <= HOPELESS) & (zero == 0.0);
        let part = if is_near {
            Part { start: 0.0, end: 1.0, a, b, radius: wide }
        } else {
            self.far_segment(a, b, reach, wide, zero == 0.0, bounds)?
        };
        Some(LocalSegment::new(&part))
    }

    /// The part of a query that is near the tree, of one of which not all is.
    #[cold]
    fn far_segment(
        &self,
        a: [f64; 3],
        b: [f64; 3],
        reach: f64,
        radius: f64,
        is_finite: bool,
        bounds: &Aabb,
    ) -> Option<Part> {
        let all = Part { start: 0.0, end: 1.0, a: [0.0; 3], b: [0.0; 3], radius: NEAR };
        if !is_finite {
            return (!bounds.is_empty()).then_some(all);
        }
        // Also true where `reach` or the radius is no longer finite.
        if !(radius <= HOPELESS && reach <= HOPELESS / UNIT_ROUNDOFF) {
            return Some(all);
        }
        // Boxes of the tree lie within NEAR at every scale.
        let limit = NEAR + radius;
        let off = |i: usize| (a[i] > limit) & (b[i] > limit) | (a[i] < -limit) & (b[i] < -limit);
        if off(0) | off(1) | off(2) {
            return None;
        }
        let d = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let (s0, s1) = clip(&a, &d, (1.0 + radius) * (1.0 + gamma(2)))?;
        let at = |s: f64| [0, 1, 2].map(|i| a[i] + s * d[i]);
        Some(Part { start: s0, end: s1, a: at(s0), b: at(s1), radius })
    }
}

/// What is looked at of a query: from `a` at s = `start` to `b` at s = `end`.
struct Part {
    start: f64,
    end: f64,
    a: [f64; 3],
    b: [f64; 3],
    radius: f64,
}

/// The largest |coordinate| of two points.
#[inline(always)]
fn largest_of(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let of = |i: usize| largest(a[i].abs(), b[i].abs());
    largest(largest(of(0), of(1)), of(2))
}

/// The power of two that brings `half` into [1/2, 1), or as near as f64 has one; 0 for 0.
fn scale_to_one(half: f64) -> f64 {
    if half == 0.0 {
        return 0.0;
    }
    let exponent = ((half.to_bits() >> 52) & 0x7ff) as i64;
    // Biased: half is in [2^(e-1023), 2^(e-1022)), so that the scale's own exponent is 1022 - e + 1023, at least 1.
    f64::from_bits(((2045 - exponent.max(1)).max(1) as u64) << 52)
}

/// The part of [0, 1] where a + s d is in [-bound, bound]^3, rounded outwards; `None` if there is none.
fn clip(a: &[f64; 3], d: &[f64; 3], bound: f64) -> Option<(f64, f64)> {
    let (mut s0, mut s1) = (0.0_f64, 1.0_f64);
    for i in 0..3 {
        if d[i] == 0.0 {
            if a[i].abs() > bound {
                return None;
            }
            continue;
        }
        let (t, w) = ((-bound - a[i]) / d[i], (bound - a[i]) / d[i]);
        // Two roundings each, of relative size; what lies beyond [-1, 2] does not count.
        let (near, far) = (t.min(w).clamp(-1.0, 2.0), t.max(w).clamp(-1.0, 2.0));
        s0 = s0.max(near - gamma(4) * near.abs());
        s1 = s1.min(far + gamma(4) * far.abs());
    }
    (s0 <= s1).then_some((s0, s1))
}

impl LocalSegment {
    #[inline]
    fn new(&Part { start, end, ref a, ref b, radius }: &Part) -> Self {
        let radius = above(radius + segment_bound_f32(largest_of(a, b), radius));
        let mut local =
            Self { start, end, forward: [true; 3], near_from: [0.0; 3], far_from: [0.0; 3], inverse: [0.0; 3] };
        for i in 0..3 {
            let (from, to) = (a[i] as f32, b[i] as f32);
            let step = to - from;
            let forward = step >= 0.0;
            let (direction, size) = if forward { (1.0, step) } else { (-1.0, -step) };
            let outwards = direction * radius;
            local.forward[i] = forward;
            local.near_from[i] = from + outwards;
            local.far_from[i] = from - outwards;
            local.inverse[i] = direction / if size > LEAST_STEP { size } else { LEAST_STEP };
        }
        local
    }

    /// The caller's limit of s as one of this part, rounded up.
    pub(super) fn local_limit(&self, s: f64) -> f32 {
        if s >= self.end || s.is_nan() {
            return 1.0;
        }
        if s < self.start {
            return -1.0;
        }
        // start <= s < end, so that the length is not 0; three roundings.
        above((s - self.start) / (self.end - self.start) * (1.0 + gamma(4)))
    }
}

/// An f32 above `v`, which is not below 0, by three roundings at most: in two steps that do not depend on `v`.
#[inline]
fn above(v: f64) -> f32 {
    v as f32 * (1.0 + 2.0 * UNIT_ROUNDOFF_F32 as f32) + f32::MIN_POSITIVE
}

/// The largest f32 that is not above `v`.
fn round_down(v: f64) -> f32 {
    let near = v as f32;
    if f64::from(near) > v { near.next_down() } else { near }
}

/// The least f32 that is not below `v`.
fn round_up(v: f64) -> f32 {
    -round_down(-v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn f32_is_rounded_outwards() {
        for v in [0.1, -0.1, 1.0, -1.0, 0.0, 1e-50, -1e-50, 1.0 + 1e-12] {
            assert!(f64::from(round_down(v)) <= v && v <= f64::from(round_up(v)), "{v}");
            assert!(round_up(v) <= round_down(v).next_up(), "{v}");
        }
    }

    #[test]
    fn the_scale_is_a_power_of_two_that_brings_half_to_one() {
        for k in -1020..=1021 {
            let half = 1.5 * 2.0_f64.powi(k);
            assert_eq!(half * scale_to_one(half), 0.75, "2^{k}");
        }
        assert_eq!(scale_to_one(0.0), 0.0);
        assert!(f64::MAX * scale_to_one(f64::MAX) <= 4.0);
        assert!(scale_to_one(5e-324).is_finite());
    }

    #[test]
    fn clipping_keeps_what_is_inside() {
        assert_eq!(clip(&[0.0; 3], &[0.0; 3], 1.0), Some((0.0, 1.0)));
        assert_eq!(clip(&[2.0, 0.0, 0.0], &[0.0; 3], 1.0), None);
        let (s0, s1) = clip(&[-5.0, 0.0, 0.0], &[10.0, 0.0, 0.0], 1.0).unwrap();
        assert!(s0 <= 0.4 && 0.6 <= s1 && s1 - s0 < 0.2 + 1e-14);
        assert_eq!(clip(&[-5.0, -5.0, 0.0], &[10.0, 2.0, 0.0], 1.0), None);
    }

    #[test]
    fn everything_comes_to_lie_within_one() {
        let bounds = Aabb::of_points(&[Point3::new(-5.0, -7.0, -6.0), Point3::new(3.0, 2.0, -1.0)]);
        let (lo, hi) = Frame::of(&bounds).item_box(&bounds);
        assert!(lo.iter().chain(&hi).all(|c| c.abs() <= 1.0), "{lo:?} {hi:?}");
        assert!((0..3).any(|i| hi[i] - lo[i] > 1.0), "and not in a small part of it");
    }

    #[test]
    fn a_query_is_larger_than_its_box_even_where_f32_has_its_sides() {
        let frame = Frame::of(&Aabb::of_points(&[Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0)]));
        for c in [-0.5, 0.0, 0.5] {
            let point = Point3::new(c, c, c);
            let ((lo, hi), (least, most)) =
                (frame.outer_box(&Aabb::of_points(&[point])), frame.item_box(&Aabb::of_points(&[point])));
            assert!((0..3).all(|i| lo[i] < least[i] && most[i] < hi[i]), "{c}: {lo:?} {hi:?}");
        }
    }

    #[test]
    fn a_limit_in_the_part_is_the_caller_s_and_not_below_it() {
        let part = LocalSegment::new(&Part { start: 0.25, end: 0.75, a: [0.0; 3], b: [0.5; 3], radius: 0.0 });
        for (s, limit) in [(0.375, 0.25f32), (0.5, 0.5), (0.625, 0.75)] {
            assert!((limit.next_up()..=limit.next_up().next_up()).contains(&part.local_limit(s)), "{s}");
        }
        assert_eq!([0.75, 9.0, f64::INFINITY, f64::NAN].map(|s| part.local_limit(s)), [1.0; 4]);
        assert!(part.local_limit(0.25) >= 0.0, "what is entered at the start is still of interest");
        assert_eq!([0.2, -1.0].map(|s| part.local_limit(s)), [-1.0; 2]);
    }
}
