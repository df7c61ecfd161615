//! A segment against a triangle (R40 to R46), decided exactly on the original points and never on a rounded hit point.

mod sheared;

use crate::closest::Feature;
use crate::exact::{self, Exact, ExactVector};
use crate::predicates::{Sign, orient3d, orient3d_exact, orient3d_twofold, orient3d_values};
use crate::rounding::{SEGMENT_FRACTION_BOUND, UNIT_ROUNDOFF};
use nalgebra::Point3;
use sheared::Passage;
pub(crate) use sheared::Sheared;

/// Whether a segment meets a triangle, and where first.
///
/// ```
/// use carom_geometry::nalgebra::Point3;
/// use carom_geometry::segment::{SegmentHit, segment_hits_triangle};
/// use carom_geometry::triangle::Feature;
///
/// let triangle = [Point3::origin(), Point3::new(4.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0)];
/// let down = |x, y| segment_hits_triangle(&Point3::new(x, y, 1.0), &Point3::new(x, y, -1.0), &triangle);
/// assert!(matches!(down(1.0, 1.0), SegmentHit::Hit { feature: Feature::Face, coplanar: false, .. }));
/// assert!(matches!(down(1.0, 0.0), SegmentHit::Hit { feature: Feature::Edge(0), coplanar: false, .. }));
/// // Beside the edge by the least that can be told is beside it.
/// assert_eq!(down(1.0, -f64::MIN_POSITIVE), SegmentHit::Miss);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SegmentHit {
    /// They have no point in common.
    Miss,
    /// They have.
    Hit {
        /// The first common point is p0 + f (p1 - p0): in 0..=1, never above the exact f and below it by
        /// [`SEGMENT_FRACTION_BOUND`] at most; 0 and 1 are exact.
        f: f64,
        /// The part of the triangle that is met first.
        feature: Feature,
        /// Whether the segment lies in the plane of the triangle, so that it has no side from which it comes.
        coplanar: bool,
    },
}

/// Whether and where the closed segment from `p0` to `p1` meets the closed triangle.
///
/// Exact for all finite input: signs of orientation determinants of the five points decide. Since these reverse exactly when two points are
/// swapped, no segment passes between two triangles that share an edge or a vertex. A triangle without an area is
/// the segment or the point that it covers; so is a segment without a length.
pub fn segment_hits_triangle(p0: &Point3<f64>, p1: &Point3<f64>, triangle: &[Point3<f64>; 3]) -> SegmentHit {
    Sheared::new(p0, p1).hits(triangle.each_ref())
}

impl Sheared {
    /// [`segment_hits_triangle`], of a segment that is held against many.
    #[inline]
    pub(crate) fn hits(&self, corners: [&Point3<f64>; 3]) -> SegmentHit {
        self.hits_at(self.passage(corners), || corners.map(|v| *v))
    }

    /// The same of a triangle whose corners are given as they are sheared, with a bound for how they turn; it is `triangle`.
    #[inline]
    pub(crate) fn hits_sheared(
        &self,
        corners: &[[f64; 2]; 3],
        bound: f64,
        triangle: impl FnOnce() -> [Point3<f64>; 3],
    ) -> SegmentHit {
        self.hits_at(self.passage_of(corners, bound), triangle)
    }

    #[inline]
    fn hits_at(&self, passage: Passage, triangle: impl FnOnce() -> [Point3<f64>; 3]) -> SegmentHit {
        match passage {
            Passage::Outside => SegmentHit::Miss,
            Passage::Inside => self.crossing(&triangle(), |_, _| Some(Feature::Face)),
            Passage::Near => self.crossing(&triangle(), Self::feature),
        }
    }

    /// Where the segment crosses the plane of the triangle, if `feature` says of what there it does.
    fn crossing(
        &self,
        triangle: &[Point3<f64>; 3],
        feature: impl FnOnce(&Self, &[Point3<f64>; 3]) -> Option<Feature>,
    ) -> SegmentHit {
        let ([a, b, c], [p0, p1]) = (triangle, self.ends());
        let heights = orient3d_values(triangle, [p0, p1]);
        let sign = |(value, bound): (f64, f64), p: &Point3<f64>| {
            if value.abs() > bound { Sign::of(value) } else { orient3d(a, b, c, p) }
        };
        let (s0, s1) = (sign(heights[0], p0), sign(heights[1], p1));
        match (s0, s1) {
            (Sign::Zero, Sign::Zero) => return coplanar(p0, p1, triangle),
            _ if s0 == s1 => return SegmentHit::Miss,
            _ => {}
        }
        let Some(feature) = feature(self, triangle) else { return SegmentHit::Miss };
        let f = match (s0, s1) {
            (Sign::Zero, _) => 0.0,
            (_, Sign::Zero) => 1.0,
            _ => fraction(p0, p1, triangle, heights),
        };
        SegmentHit::Hit { f, feature, coplanar: false }
    }

    /// What of the triangle the line meets that is not in its plane: it meets that in one point, inside if it passes all edges on one side.
    fn feature(&self, [a, b, c]: &[Point3<f64>; 3]) -> Option<Feature> {
        let [p0, p1] = self.ends();
        let sides = [orient3d(p0, p1, a, b), orient3d(p0, p1, b, c), orient3d(p0, p1, c, a)];
        let passes = sides.contains(&Sign::Positive) && sides.contains(&Sign::Negative);
        (!passes).then(|| feature(sides.map(|s| s == Sign::Zero)))
    }
}

/// The feature on which the edges marked `on` (edge i from vertex i to i + 1) meet.
fn feature(on: [bool; 3]) -> Feature {
    match on {
        [false, false, false] => Feature::Face,
        [true, false, false] => Feature::Edge(0),
        [false, true, false] => Feature::Edge(1),
        [false, false, true] => Feature::Edge(2),
        [true, _, true] => Feature::Vertex(0),
        [true, true, false] => Feature::Vertex(1),
        [false, true, true] => Feature::Vertex(2),
    }
}

/// f = d0 / (d0 - d1) (R8) of end points strictly on either side of the plane, rounded down.
///
/// `heights` are d0 and d1 in some unit, computed, each with a bound on its error.
fn fraction(p0: &Point3<f64>, p1: &Point3<f64>, triangle: &[Point3<f64>; 3], heights: [(f64, f64); 2]) -> f64 {
    let low = |[(d0, e0), (d1, e1)]: [(f64, f64); 2]| {
        let (d0, d1) = (d0.abs(), d1.abs());
        let whole = d0 + d1;
        // f grows with d0 and falls with d1, so this is below the exact one; 4 u for the four roundings.
        let low = (d0 - e0) / ((d0 - e0) + (d1 + e1)) * (1.0 - 4.0 * UNIT_ROUNDOFF);
        // Moving d0 by e0 and d1 by e1 moves f by (e0 + e1) / whole at most, and low is another rounding below.
        let near = 2.0 * (e0 + e1) <= (SEGMENT_FRACTION_BOUND - 8.0 * UNIT_ROUNDOFF) * whole;
        (e0 < d0 && whole.is_finite() && near).then_some(low)
    };
    let twofold = || low([p0, p1].map(|p| orient3d_twofold(triangle, p)));
    low(heights).or_else(twofold).unwrap_or_else(|| {
        let [a, b, c] = triangle;
        let (d0, d1) = (orient3d_exact(a, b, c, p0), orient3d_exact(a, b, c, p1));
        exact::round_down(&(&d0 / (&d0 - d1)))
    })
}

/// A linear function of f: value at 0, and slope.
type Linear = (Exact, Exact);

/// The segment in the plane of the triangle, or of a triangle without one: the first f at which all conditions hold.
fn coplanar(p0: &Point3<f64>, p1: &Point3<f64>, triangle: &[Point3<f64>; 3]) -> SegmentHit {
    let [a, b, c] = triangle;
    let n = exact::cross(&exact::difference(b, a), &exact::difference(c, a));
    let step = exact::difference(p1, p0);
    if exact::is_zero(&n) {
        return on_line(p0, &step, triangle);
    }
    // The side of each edge on which p0 + f step lies, positive inside.
    let sides: [Linear; 3] = std::array::from_fn(|i| {
        let inward = exact::cross(&n, &exact::difference(&triangle[(i + 1) % 3], &triangle[i]));
        (exact::dot(&inward, &exact::difference(p0, &triangle[i])), exact::dot(&inward, &step))
    });
    match first(&[], &sides) {
        None => SegmentHit::Miss,
        Some(f) => {
            let feature = feature(sides.each_ref().map(|side| at(side, &f).is_zero()));
            SegmentHit::Hit { f: exact::round_down(&f), feature, coplanar: true }
        }
    }
}

/// The segment against a triangle whose vertices lie on one line.
fn on_line(p0: &Point3<f64>, step: &ExactVector, triangle: &[Point3<f64>; 3]) -> SegmentHit {
    // The edge that covers the others.
    let length = |i: usize| {
        let e = exact::difference(&triangle[(i + 1) % 3], &triangle[i]);
        exact::dot(&e, &e)
    };
    let lengths = [length(0), length(1), length(2)];
    let longest = (1..3).fold(0, |best, i| if lengths[i] > lengths[best] { i } else { best });
    let (q, r) = (longest, (longest + 1) % 3);
    let (edge, start) = (exact::difference(&triangle[r], &triangle[q]), exact::difference(p0, &triangle[q]));
    // On the line of the edge; of an edge without a length, at its point.
    let (offset, slope) = if exact::is_zero(&edge) {
        (start.clone(), step.clone())
    } else {
        (exact::cross(&edge, &start), exact::cross(&edge, step))
    };
    let equalities: Vec<Linear> = offset.into_iter().zip(slope).collect();
    let along = (exact::dot(&edge, &start), exact::dot(&edge, step));
    let before_end = (&lengths[longest] - &along.0, -&along.1);
    let Some(f) = first(&equalities, &[along.clone(), before_end.clone()]) else { return SegmentHit::Miss };
    let feature = match (at(&along, &f).is_zero(), at(&before_end, &f).is_zero()) {
        (true, _) => Feature::Vertex(q as u8),
        (_, true) => Feature::Vertex(r as u8),
        _ => Feature::Edge(q as u8),
    };
    SegmentHit::Hit { f: exact::round_down(&f), feature, coplanar: true }
}

fn at((offset, slope): &Linear, f: &Exact) -> Exact {
    offset + slope * f
}

/// The least f in [0, 1] at which all `equalities` are zero and no function of `positive` is below.
fn first(equalities: &[Linear], positive: &[Linear]) -> Option<Exact> {
    let (mut low, mut high) = (Exact::ZERO, Exact::ONE);
    let both_ways = equalities.iter().flat_map(|(o, s)| [(o.clone(), s.clone()), (-o, -s)]);
    for (offset, slope) in positive.iter().cloned().chain(both_ways) {
        if slope.is_zero() {
            if offset < Exact::ZERO {
                return None;
            }
            continue;
        }
        let root = -offset / &slope;
        if slope > Exact::ZERO {
            low = low.max(root);
        } else {
            high = high.min(root);
        }
    }
    (low <= high).then_some(low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::scale;
    use proptest::prelude::*;

    fn p(x: f64, y: f64, z: f64) -> Point3<f64> {
        Point3::new(x, y, z)
    }

    fn triangle() -> [Point3<f64>; 3] {
        [p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(0.0, 4.0, 0.0)]
    }

    fn hit(f: f64, feature: Feature, coplanar: bool) -> SegmentHit {
        SegmentHit::Hit { f, feature, coplanar }
    }

    #[test]
    fn r46_transversal_segments_meet_face_edge_and_vertex() {
        let down = |x: f64, y: f64| segment_hits_triangle(&p(x, y, 3.0), &p(x, y, -1.0), &triangle());
        let f = |h: SegmentHit| match h {
            SegmentHit::Hit { f, .. } => f,
            SegmentHit::Miss => f64::NAN,
        };
        for (x, y, feature) in [
            (1.0, 1.0, Feature::Face),
            (2.0, 0.0, Feature::Edge(0)),
            (2.0, 2.0, Feature::Edge(1)),
            (0.0, 1.0, Feature::Edge(2)),
            (0.0, 0.0, Feature::Vertex(0)),
            (4.0, 0.0, Feature::Vertex(1)),
            (0.0, 4.0, Feature::Vertex(2)),
        ] {
            let h = down(x, y);
            assert!(matches!(h, SegmentHit::Hit { feature: found, coplanar: false, .. } if found == feature), "{h:?}");
            assert!(f(h) <= 0.75 && f(h) >= 0.75 - SEGMENT_FRACTION_BOUND);
        }
        assert_eq!(down(2.0, 2f64.next_up()), SegmentHit::Miss);
        assert_eq!(down(-f64::from_bits(1), 1.0), SegmentHit::Miss);
        assert_eq!(
            segment_hits_triangle(&p(1.0, 1.0, 3.0), &p(1.0, 1.0, 0.0), &triangle()),
            hit(1.0, Feature::Face, false)
        );
        assert_eq!(
            segment_hits_triangle(&p(1.0, 1.0, 0.0), &p(1.0, 1.0, 3.0), &triangle()),
            hit(0.0, Feature::Face, false)
        );
    }

    #[test]
    fn coplanar_segments_meet_the_first_edge() {
        let t = triangle();
        let go = |a: Point3<f64>, b: Point3<f64>| segment_hits_triangle(&a, &b, &t);
        assert_eq!(go(p(-1.0, 1.0, 0.0), p(3.0, 1.0, 0.0)), hit(0.25, Feature::Edge(2), true));
        assert_eq!(go(p(1.0, 1.0, 0.0), p(3.0, 1.0, 0.0)), hit(0.0, Feature::Face, true));
        assert_eq!(go(p(-4.0, 0.0, 0.0), p(4.0, 0.0, 0.0)), hit(0.5, Feature::Vertex(0), true));
        assert_eq!(go(p(5.0, 5.0, 0.0), p(3.0, 3.0, 0.0)), SegmentHit::Miss);
        assert_eq!(go(p(8.0, 0.0, 0.0), p(0.0, 8.0, 0.0)), SegmentHit::Miss);
        // A point.
        assert_eq!(go(p(1.0, 1.0, 0.0), p(1.0, 1.0, 0.0)), hit(0.0, Feature::Face, true));
        assert_eq!(go(p(1.0, 1.0, 1.0), p(1.0, 1.0, 1.0)), SegmentHit::Miss);
        assert_eq!(go(p(4.0, 1.0, 0.0), p(4.0, 1.0, 0.0)), SegmentHit::Miss);
    }

    #[test]
    fn r47_a_triangle_without_an_area_is_its_segment() {
        let (a, b, m) = (p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(1.0, 0.0, 0.0));
        for t in [[a, m, b], [m, a, b], [a, b, m], [a, a, b], [b, b, a]] {
            let go = |x: Point3<f64>, y: Point3<f64>| segment_hits_triangle(&x, &y, &t);
            assert!(matches!(
                go(p(3.0, 0.0, 1.0), p(3.0, 0.0, -1.0)),
                SegmentHit::Hit { f: 0.5, feature: Feature::Edge(_), .. }
            ));
            assert!(matches!(
                go(p(-4.0, 0.0, 0.0), p(4.0, 0.0, 0.0)),
                SegmentHit::Hit { f: 0.5, feature: Feature::Vertex(_), .. }
            ));
            assert_eq!(go(p(5.0, 0.0, 1.0), p(5.0, 0.0, -1.0)), SegmentHit::Miss);
            assert_eq!(go(p(3.0, 1.0, 1.0), p(3.0, 1.0, -1.0)), SegmentHit::Miss);
            assert_eq!(go(p(5.0, 0.0, 0.0), p(6.0, 0.0, 0.0)), SegmentHit::Miss);
        }
        assert_eq!(
            segment_hits_triangle(&p(1.0, 0.0, -1.0), &p(1.0, 0.0, 3.0), &[m; 3]),
            hit(0.25, Feature::Vertex(0), true)
        );
        assert_eq!(segment_hits_triangle(&p(1.0, 0.0, -1.0), &p(1.0, 1.0, 3.0), &[m; 3]), SegmentHit::Miss);
    }

    #[test]
    fn r08_f_of_a_plane_nearly_touched_is_within_its_bound_at_every_scale() {
        let t = [p(0.1, 0.2, 0.3), p(1.3, 0.7, -0.4), p(-0.6, 0.9, 0.35)];
        let normal = (t[1] - t[0]).cross(&(t[2] - t[0])).normalize();
        let on = Point3::from((t[0].coords + t[1].coords + t[2].coords) / 3.0);
        for (above, below) in (20..56).flat_map(|j| [(j, 0), (j, j), (0, j)]) {
            let ends = [on + normal * scale(1.0, -above), on - normal * scale(1.0, -below)];
            for k in [-200, -100, 0, 100, 200] {
                let big = |q: Point3<f64>| q.map(|c| scale(c, k));
                let (t, p0, p1) = (t.map(big), big(ends[0]), big(ends[1]));
                let SegmentHit::Hit { f, .. } = segment_hits_triangle(&p0, &p1, &t) else { continue };
                let [d0, d1] = [&p0, &p1].map(|q| orient3d_exact(&t[0], &t[1], &t[2], q));
                let want = &d0 / (&d0 - d1);
                let early = exact::nearest(&(want - exact::exact(f)));
                let right = f >= 0.0 && (0.0..=SEGMENT_FRACTION_BOUND).contains(&early);
                assert!(right, "f {f:e} early by {early:e}: 2^-{above} above, 2^-{below} below, scale 2^{k}");
            }
        }
    }

    fn coordinate() -> impl Strategy<Value = f64> {
        (-4i32..5, -1i64..2).prop_map(|(c, ulp)| {
            let x = f64::from(c) / 3.0;
            if ulp > 0 {
                x.next_up()
            } else if ulp < 0 {
                x.next_down()
            } else {
                x
            }
        })
    }

    fn point() -> impl Strategy<Value = Point3<f64>> {
        [coordinate(), coordinate(), coordinate()].prop_map(Point3::from)
    }

    proptest! {
        #[test]
        fn fraction_is_below_the_exact_one_and_near_it(t in [point(), point(), point()], p0 in point(), p1 in point()) {
            let [a, b, c] = &t;
            let (d0, d1) = (orient3d_exact(a, b, c, &p0), orient3d_exact(a, b, c, &p1));
            let zero = Exact::ZERO;
            if (d0 > zero && d1 < zero) || (d0 < zero && d1 > zero) {
                let want = &d0 / (&d0 - d1);
                let early = exact::nearest(&(want - exact::exact(fraction(&p0, &p1, &t, orient3d_values(&t, [&p0, &p1])))));
                prop_assert!((0.0..=SEGMENT_FRACTION_BOUND).contains(&early), "early by {early:e}");
            }
        }

        #[test]
        fn the_order_of_vertices_does_not_matter(t in [point(), point(), point()], p0 in point(), p1 in point()) {
            let hits = |h| matches!(h, SegmentHit::Hit { .. });
            let first = segment_hits_triangle(&p0, &p1, &t);
            for other in [[t[1], t[2], t[0]], [t[2], t[1], t[0]]] {
                prop_assert_eq!(hits(first), hits(segment_hits_triangle(&p0, &p1, &other)));
            }
            prop_assert_eq!(hits(first), hits(segment_hits_triangle(&p1, &p0, &t)));
        }
    }
}
