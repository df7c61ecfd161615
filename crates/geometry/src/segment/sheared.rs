//! A cheap certificate that the line of a segment passes a triangle, or passes through it, for many triangles.

use crate::bounds::{largest, least};
use crate::rounding::sheared_bound;
use crate::shear::Shear;
use nalgebra::Point3;

/// A segment, and the shear along its longest axis that brings its line to one point of the plane across: there, a side of a triangle is passed
/// on the side on which it turns about that point (Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection").
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sheared {
    ends: [Point3<f64>; 2],
    shear: Shear,
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
        Self { ends: [*p0, *p1], shear: Shear::new(p0, p1) }
    }

    /// The shear.
    pub(crate) fn shear(&self) -> &Shear {
        &self.shear
    }

    /// From where to where it runs.
    pub(super) fn ends(&self) -> [&Point3<f64>; 2] {
        self.ends.each_ref()
    }

    /// Where its line passes a triangle.
    #[inline]
    pub(super) fn passage(&self, corners: [&Point3<f64>; 3]) -> Passage {
        let [a, b, c] = match self.shear.axis {
            0 => corners.map(|v| self.shear.of::<0>(v)),
            1 => corners.map(|v| self.shear.of::<1>(v)),
            _ => corners.map(|v| self.shear.of::<2>(v)),
        };
        let most = |i: usize| largest(largest(a[i].abs(), b[i].abs()), c[i].abs());
        let bound = sheared_bound(largest(most(0), most(1)), most(2));
        self.passage_of(&[a, b, c].map(|[next, last, _]| [next, last]), bound)
    }

    /// Where its line passes a triangle, given how its corners are sheared and a [`sheared_bound`] for them.
    #[inline]
    pub(super) fn passage_of(&self, [a, b, c]: &[[f64; 2]; 3], bound: f64) -> Passage {
        // NaN without a direction.
        let bound = bound + 0.0 * self.shear.slopes[0];
        let turn = |a: &[f64; 2], b: &[f64; 2]| a[0] * b[1] - a[1] * b[0];
        let (ab, bc, ca) = (turn(a, b), turn(b, c), turn(c, a));
        // All are NaN where there is no direction, and no comparison is true; where one alone is, it overflowed, and so did the bound.
        let (least, most) = (least(least(ab, bc), ca), largest(largest(ab, bc), ca));
        if (least < -bound) & (most > bound) {
            Passage::Outside
        } else if (least > bound) | (most < -bound) {
            Passage::Inside
        } else {
            Passage::Near
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predicates::{Sign, orient3d};
    use crate::rounding::scale;
    use proptest::prelude::*;

    fn passage(p: &[Point3<f64>; 5]) -> Passage {
        Sheared::new(&p[0], &p[1]).passage([&p[2], &p[3], &p[4]])
    }

    /// What the exact signs say.
    fn exactly(p: &[Point3<f64>; 5]) -> Passage {
        let sides = [(2, 3), (3, 4), (4, 2)].map(|(i, j)| orient3d(&p[0], &p[1], &p[i], &p[j]));
        match (sides.contains(&Sign::Negative), sides.contains(&Sign::Positive), sides.contains(&Sign::Zero)) {
            (true, true, _) => Passage::Outside,
            (_, _, true) => Passage::Near,
            _ => Passage::Inside,
        }
    }

    #[test]
    fn r46_what_is_certain_is_so_along_every_axis_and_at_every_scale() {
        let p = Point3::<f64>::new;
        let points = |x: f64, y: f64| {
            [p(x, y, 3.0), p(x + 0.5, y - 0.25, -1.0), p(0.0, 0.0, 0.0), p(4.0, 0.5, 0.0), p(-0.5, 4.0, 1.0)]
        };
        for (x, y, k) in [(1.0, 1.0), (-1.0, 5.0), (3.0, 3.0), (-3.0, 1.0)]
            .iter()
            .flat_map(|&(x, y)| [-300, 0, 300].map(|k| (x, y, k)))
        {
            for turn in 0..3 {
                let turned = points(x, y).map(|v| Point3::from([0, 1, 2].map(|i| scale(v[(i + turn) % 3], k))));
                let found = passage(&turned);
                assert!(found == exactly(&turned) && found != Passage::Near, "{x} {y}: {found:?}");
                assert_eq!(passage(&[turned[1], turned[0], turned[3], turned[2], turned[4]]), found);
            }
        }
        let on_an_edge = [p(2.0, 0.0, 3.0), p(2.0, 0.0, -1.0), p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(0.0, 4.0, 0.0)];
        assert_eq!(passage(&on_an_edge), Passage::Near);
    }

    #[test]
    fn without_a_direction_or_beyond_the_range_of_f64_nothing_is_certain() {
        let p = Point3::<f64>::new;
        let triangle = [p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(0.0, 4.0, 0.0)];
        let with = |from, to, [a, b, c]: [Point3<f64>; 3]| passage(&[from, to, a, b, c]);
        let (above, most) = (p(1.0, 1.0, 1.0), f64::MAX);
        assert_eq!(with(above, above, triangle), Passage::Near);
        assert_eq!(with(p(1.0, 1.0, most), p(1.0, 1.0, -most), triangle), Passage::Near);
        let huge = triangle.map(|v| v * scale(1.0, 515));
        assert_eq!(with(above, p(1.0, 1.0, -1.0), huge), Passage::Near);
        let far = [p(-most, 0.0, most), p(most, -most, most), p(most, most, most)];
        assert_eq!(with(p(-most, 1.0, -most), p(-most, 1.0, 0.0), far), Passage::Near);
    }

    fn point() -> impl Strategy<Value = Point3<f64>> {
        let coordinate = || {
            (-4i32..5, 0u64..3, prop_oneof![Just(0i32), -40..40i32])
                .prop_map(|(c, ulps, k)| scale(f64::from_bits((f64::from(c) / 3.0).to_bits() + ulps), k))
        };
        [coordinate(), coordinate(), coordinate()].prop_map(Point3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn what_is_certain_is_what_the_exact_signs_say(p in [point(), point(), point(), point(), point()]) {
            let found = passage(&p);
            prop_assert!(found == Passage::Near || found == exactly(&p), "{found:?}");
        }
    }
}
