//! The point of a triangle closest to a given one, for triangles of any shape and size.

use crate::bounds::{amax, largest};
use crate::normal::cross_compensated;
use crate::order::by_size;
use crate::rounding::{LEAST_SINE_SQUARED, NEEDLE_SINE_SQUARED, exponent, power_of_two, scale};
use nalgebra::{Point3, Vector3};

/// Which part of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// The inner of the triangle.
    Face,
    /// The edge from vertex i to vertex i + 1 (modulo 3), i in 0..3, without its ends.
    Edge(u8),
    /// The vertex i in 0..3.
    Vertex(u8),
}

/// The point of a triangle closest to a given point x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closest {
    /// The closest point, in the coordinates of the triangle.
    pub point: Point3<f64>,
    /// x - point, computed before `point` is rounded to its coordinates: its direction stays good when x is very near the triangle.
    pub offset: Vector3<f64>,
    /// Where on the triangle it lies. On the border between two features, rounding decides.
    pub feature: Feature,
}

/// The point of the triangle closest to `x`.
///
/// Any finite triangle will do: one without an area is the segment or the point that it covers. The answer is finite if `x` minus
/// each vertex is. Accuracy: a few u of the largest distance between `x` and a vertex, for needles as well, and u of the
/// coordinates of `point`; the offset is orthogonal to the face or edge to a few u *of itself*. Voronoi regions as in Ericson, Real-Time
/// Collision Detection (2005), section 5.1.5, from the vertex opposite to the longest edge.
pub fn closest_point(triangle: &[Point3<f64>; 3], x: &Point3<f64>) -> Closest {
    match to_unit_scale(triangle, x) {
        None => Frame::new(triangle).closest(x),
        Some((triangle_scaled, x_scaled, k)) => {
            let closest = Frame::new(&triangle_scaled).closest(&x_scaled);
            let offset = closest.offset.map(|c| scale(c, k));
            let point = match closest.feature {
                Feature::Vertex(i) => triangle[usize::from(i)],
                _ => closest.point.map(|c| scale(c, k)),
            };
            Closest { point, offset, ..closest }
        }
    }
}

/// Exponents of coordinate differences for which products of four neither overflow nor lose what matters.
const DIRECT_RANGE: std::ops::Range<i32> = -200..250;
/// The same range as numbers.
const LEAST_DIRECT: f64 = power_of_two(DIRECT_RANGE.start);
const LIMIT_OF_DIRECT: f64 = power_of_two(DIRECT_RANGE.end);

/// A triangle that is asked for more than one closest point: what depends on it alone is computed once.
pub(crate) struct Asked {
    corners: [Vector3<f64>; 3],
    /// Of the triangle, or of one of size 1 if that is not in [`DIRECT_RANGE`].
    frame: Frame,
    size: f64,
    in_range: bool,
}

impl Asked {
    /// The triangle with these `corners`.
    #[inline]
    pub(crate) fn new(corners: [Vector3<f64>; 3]) -> Self {
        let [a, b, c] = corners;
        let size = largest(amax(&(b - a)), amax(&(c - a)));
        let triangle = [Point3::from(a), Point3::from(b), Point3::from(c)];
        if (LEAST_DIRECT..LIMIT_OF_DIRECT).contains(&size) || size == 0.0 {
            return Self { corners, frame: Frame::new(&triangle), size, in_range: size > 0.0 };
        }
        let k = exponent(size);
        let frame = Frame::new(&triangle.map(|p| p.map(|c| scale(c, -k))));
        Self { corners, frame, size: scale(size, -k), in_range: false }
    }

    /// What [`closest_point`] says, bit for bit.
    #[inline]
    pub(crate) fn closest(&self, x: &Vector3<f64>) -> Closest {
        if self.in_range && largest(self.size, amax(&(x - self.corners[0]))) < LIMIT_OF_DIRECT {
            self.frame.closest(&Point3::from(*x))
        } else {
            closest_point(&self.corners.map(Point3::from), &Point3::from(*x))
        }
    }

    /// Whether the triangle's own plane is what is nearest to `x`, seen along its normal: false where that is in doubt.
    #[inline]
    pub(crate) fn is_under(&self, x: &Vector3<f64>) -> bool {
        self.in_range
            && largest(self.size, amax(&(x - self.corners[0]))) < LIMIT_OF_DIRECT
            && self.frame.is_under(&Point3::from(*x))
    }

    /// The corners of the triangle.
    #[inline]
    pub(crate) fn corners(&self) -> &[Vector3<f64>; 3] {
        &self.corners
    }

    /// The unit normal, to a few roundings and on either side; none without an area that f64 can tell.
    pub(crate) fn normal(&self) -> Option<Vector3<f64>> {
        let (square, side) = (self.frame.normal.norm_squared(), self.size * self.size);
        (square > side * LEAST_SINE_SQUARED * side).then(|| self.frame.normal / square.sqrt())
    }
}

/// The triangle and the point scaled by 2^-k to a size of about 1; none if there is no need.
pub(crate) fn to_unit_scale(
    triangle: &[Point3<f64>; 3],
    x: &Point3<f64>,
) -> Option<([Point3<f64>; 3], Point3<f64>, i32)> {
    let origin = triangle[0];
    let edges = amax(&(triangle[1] - origin)).max(amax(&(triangle[2] - origin)));
    let most = edges.max(amax(&(x - origin)));
    if DIRECT_RANGE.contains(&exponent(most)) && (DIRECT_RANGE.contains(&exponent(edges)) || edges == 0.0)
        || most == 0.0
    {
        return None;
    }
    // The triangle decides, unless the point is so far off that the triangle looks like a point.
    let k = exponent(if edges > 0.0 { edges } else { most }).max(exponent(most) - DIRECT_RANGE.end + 1);
    let near = |p: &Point3<f64>| p.map(|c| scale(c, -k));
    Some((triangle.each_ref().map(near), near(x), k))
}

/// A triangle seen from the vertex opposite to its longest edge.
pub(crate) struct Frame {
    /// Index of that vertex.
    first: u8,
    /// The vertices from there.
    vertices: [Point3<f64>; 3],
    /// Edges to the second and third vertex.
    ab: Vector3<f64>,
    ac: Vector3<f64>,
    /// ab x ac.
    pub(crate) normal: Vector3<f64>,
    /// Whether a plain cross product would lose too much of that.
    is_needle: bool,
}

impl Frame {
    #[inline]
    pub(crate) fn new(t: &[Point3<f64>; 3]) -> Self {
        let [t0, t1, t2] = *t;
        // Edge i runs from vertex i to i + 1 and is opposite to vertex i + 2.
        let edges = [t1 - t0, t2 - t1, t0 - t2];
        let squares = edges.map(|e| e.norm_squared());
        let (first, vertices, ab, ac, product) = if squares[1] >= squares[0] && squares[1] >= squares[2] {
            (0, [t0, t1, t2], edges[0], -edges[2], squares[0] * squares[2])
        } else if squares[2] >= squares[0] {
            (1, [t1, t2, t0], edges[1], -edges[0], squares[1] * squares[0])
        } else {
            (2, [t2, t0, t1], edges[2], -edges[1], squares[2] * squares[1])
        };
        let mut normal = ab.cross(&ac);
        let is_needle = normal.norm_squared() < NEEDLE_SINE_SQUARED * product;
        if is_needle {
            let [a, b, c] = &vertices;
            normal = cross_compensated(a, b, c);
        }
        Self { first, vertices, ab, ac, normal, is_needle }
    }

    fn vertex(&self, i: u8) -> Feature {
        Feature::Vertex((self.first + i) % 3)
    }

    fn edge(&self, i: u8) -> Feature {
        Feature::Edge((self.first + i) % 3)
    }

    /// How far the foot of a point is inside of each edge, from the point's place as seen from each vertex.
    ///
    /// Triple products, not the differences of products d1 d4 - d3 d2 ... that they equal: those lose the height of a needle.
    #[inline]
    fn insides(&self, [ap, bp, cp]: &[Vector3<f64>; 3]) -> [f64; 3] {
        let inside = |p: &Vector3<f64>, q: &Vector3<f64>| self.normal.dot(&p.cross(q));
        [inside(&self.ab, ap), inside(ap, &self.ac), inside(bp, cp)]
    }

    /// Whether `x` is over the inside of the triangle, to the rounding of its distances from the vertices. Of a needle, the triple products do not
    /// tell what is beyond its ends.
    #[inline]
    fn is_under(&self, x: &Point3<f64>) -> bool {
        if self.is_needle {
            return self.closest(x).feature == Feature::Face;
        }
        self.insides(&self.vertices.map(|v| x - v)).iter().all(|inside| *inside > 0.0)
    }

    /// The closest point, of a triangle and a point in [`DIRECT_RANGE`].
    fn closest(&self, x: &Point3<f64>) -> Closest {
        let ([a, b, c], ab, ac) = (self.vertices, self.ab, self.ac);
        let at = |point: Point3<f64>, offset, feature| Closest { point, offset, feature };

        let ap = x - a;
        let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return at(a, ap, self.vertex(0));
        }
        let bp = x - b;
        let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
        if d3 >= 0.0 && d4 <= d3 {
            return at(b, bp, self.vertex(1));
        }
        let cp = x - c;
        let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
        if d6 >= 0.0 && d5 <= d6 {
            return at(c, cp, self.vertex(2));
        }
        // From the end that is first by size and without the third vertex: the same bits from each face that has the edge.
        let along = |p: &Point3<f64>, q: &Point3<f64>, feature| {
            let (from, to) = if by_size(&p.coords, &q.coords).is_le() { (p, q) } else { (q, p) };
            let (edge, offset) = (to - from, x - from);
            let length = edge.norm_squared();
            if length == 0.0 {
                return at(*from, offset, feature);
            }
            let part = edge.dot(&offset) / length;
            let offset = offset - edge * part;
            // Once more, for what rounding left along the edge.
            let rest = edge.dot(&offset) / length;
            at(from + edge * (part + rest), offset - edge * rest, feature)
        };
        let [vc, vb, va] = self.insides(&[ap, bp, cp]);
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3 {
            return along(&a, &b, self.edge(0));
        }
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6 {
            return along(&a, &c, self.edge(2));
        }
        let (beyond_b, beyond_c) = (d4 - d3, d5 - d6);
        if va <= 0.0 && beyond_b >= 0.0 && beyond_c >= 0.0 && beyond_b + beyond_c > 0.0 {
            return along(&b, &c, self.edge(1));
        }
        let n = self.normal;
        let area_squared = n.norm_squared();
        if area_squared > 0.0 {
            let offset = n * (n.dot(&ap) / area_squared);
            return at(x - offset, offset, Feature::Face);
        }
        // No area, and rounding put x past every segment: the nearest vertex.
        let nearer = |p: &Vector3<f64>, q: &Vector3<f64>| p.norm_squared() <= q.norm_squared();
        if nearer(&ap, &bp) && nearer(&ap, &cp) {
            at(a, ap, self.vertex(0))
        } else if nearer(&bp, &cp) {
            at(b, bp, self.vertex(1))
        } else {
            at(c, cp, self.vertex(2))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Exact, ExactVector, cross, difference, dot, nearest};
    use crate::rounding::UNIT_ROUNDOFF;
    use proptest::prelude::*;

    /// The squared distance from x to the triangle, exactly: the least over vertices, edges and the face.
    fn exact_distance_squared(t: &[Point3<f64>; 3], x: &Point3<f64>) -> Exact {
        let zero = Exact::ZERO;
        let mut best: Option<Exact> = None;
        let mut offer = |d: Exact| {
            if best.as_ref().is_none_or(|b| d < *b) {
                best = Some(d);
            }
        };
        let square = |v: &ExactVector| dot(v, v);
        for i in 0..3 {
            let (a, b) = (&t[i], &t[(i + 1) % 3]);
            let (p, e) = (difference(x, a), difference(b, a));
            offer(square(&p));
            let (along, length) = (dot(&p, &e), square(&e));
            if along > zero && along < length {
                offer(square(&p) - &along * &along / length);
            }
        }
        let n = cross(&difference(&t[1], &t[0]), &difference(&t[2], &t[0]));
        let within = (0..3).all(|i| {
            let (a, b) = (&t[i], &t[(i + 1) % 3]);
            dot(&n, &cross(&difference(b, a), &difference(x, a))) >= zero
        });
        if within && square(&n) > zero {
            let d = dot(&n, &difference(x, &t[0]));
            offer(&d * &d / square(&n));
        }
        best.unwrap_or(zero)
    }

    /// The error of distance and place of the closest point, in u of the largest distance between x and a vertex (and the size of coordinates).
    fn errors(t: &[Point3<f64>; 3], x: &Point3<f64>) -> (f64, f64) {
        let closest = closest_point(t, x);
        assert!(
            closest.point.iter().chain(closest.offset.iter()).all(|c| c.is_finite()),
            "{closest:?} of {t:?} to {x:?}"
        );
        let want = nearest(&exact_distance_squared(t, x)).sqrt();
        let reach = t.iter().fold(0.0, |m, v| f64::max(m, (x - v).norm()));
        let coordinates = t.iter().fold(x.coords.amax(), |m, v| m.max(v.coords.amax()));
        let far = (closest.offset.norm() - want).abs() / (UNIT_ROUNDOFF * reach.max(f64::MIN_POSITIVE));
        // The point itself lies in the triangle.
        let off = nearest(&exact_distance_squared(t, &closest.point)).sqrt();
        (far, off / (UNIT_ROUNDOFF * (reach + coordinates).max(f64::MIN_POSITIVE)))
    }

    #[test]
    fn closest_point_names_every_feature() {
        let t = [Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0)];
        for (x, feature, point) in [
            ((1.0, 1.0, 5.0), Feature::Face, (1.0, 1.0, 0.0)),
            ((2.0, -3.0, 1.0), Feature::Edge(0), (2.0, 0.0, 0.0)),
            ((4.0, 4.0, -1.0), Feature::Edge(1), (2.0, 2.0, 0.0)),
            ((-2.0, 3.0, 0.0), Feature::Edge(2), (0.0, 3.0, 0.0)),
            ((-1.0, -1.0, 2.0), Feature::Vertex(0), (0.0, 0.0, 0.0)),
            ((7.0, 1.0, 0.0), Feature::Vertex(1), (4.0, 0.0, 0.0)),
            ((1.0, 9.0, 0.0), Feature::Vertex(2), (0.0, 4.0, 0.0)),
        ] {
            for turn in 0..3u8 {
                for k in [-1000, -300, 0, 300, 1000] {
                    let big = |(x, y, z): (f64, f64, f64)| Point3::new(scale(x, k), scale(y, k), scale(z, k));
                    let turned = std::array::from_fn(|i| t[(i + usize::from(turn)) % 3].map(|c| scale(c, k)));
                    let closest = closest_point(&turned, &big(x));
                    let expected = match feature {
                        Feature::Face => Feature::Face,
                        Feature::Edge(i) => Feature::Edge((i + 3 - turn) % 3),
                        Feature::Vertex(i) => Feature::Vertex((i + 3 - turn) % 3),
                    };
                    assert_eq!((closest.feature, closest.point), (expected, big(point)), "2^{k}, from vertex {turn}");
                }
            }
        }
    }

    #[test]
    fn closest_point_of_triangles_without_an_area_is_that_of_their_segment() {
        let (a, b, m) = (Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0));
        for t in [[a, m, b], [m, a, b], [a, b, m], [a, a, b], [a, b, a], [b, a, a], [a, b, b]] {
            let closest = closest_point(&t, &Point3::new(3.0, 2.0, 1.0));
            assert_eq!(
                (closest.point, closest.offset),
                (Point3::new(3.0, 0.0, 0.0), Vector3::new(0.0, 2.0, 1.0)),
                "{t:?}"
            );
            assert_eq!(closest_point(&t, &Point3::new(9.0, 2.0, 1.0)).point, b);
            assert_eq!(closest_point(&t, &Point3::new(-9.0, 2.0, 1.0)).point, a);
        }
        let closest = closest_point(&[m; 3], &Point3::new(9.0, 2.0, 1.0));
        assert_eq!((closest.point, closest.feature), (m, Feature::Vertex(0)));
    }

    #[test]
    fn closest_point_far_beyond_the_range_of_products_stays_finite() {
        let t = [Point3::origin(), Point3::new(1e-90, 0.0, 0.0), Point3::new(0.0, 1e-90, 0.0)];
        for x in [Point3::new(1e-91, 1e-91, 1e90), Point3::new(1e150, 1e150, 1e-150), Point3::new(2e-91, 3e-91, 0.0)] {
            let closest = closest_point(&t, &x);
            assert!(closest.point.coords.amax() <= 1e-90, "{closest:?}");
            assert!((closest.offset - x.coords).amax() <= 2e-90);
        }
    }

    #[test]
    fn closest_point_of_needles_keeps_its_accuracy() {
        let mut worst = (0.0f64, 0.0f64);
        for k in 0..60 {
            let h = scale(1.0, -k);
            let t =
                [Point3::new(0.1, 0.2, 0.3), Point3::new(1.3, 0.7, -0.4), Point3::new(0.7, 0.45 + h, -0.05 - 0.3 * h)];
            for i in -2..12 {
                for (away, j) in [(0.5, 0), (1e-3, 1), (1e-9, 2), (h, 0), (0.3 * h, 1), (0.0, 2)] {
                    let mut x = t[0] + (t[1] - t[0]) * (f64::from(i) / 10.0);
                    x[j] += away;
                    let (far, off) = errors(&t, &x);
                    worst = (worst.0.max(far), worst.1.max(off));
                }
            }
        }
        println!("needles: distance off by {} u, point by {} u at worst", worst.0, worst.1);
        assert!(worst.0 <= CLOSEST_BOUND && worst.1 <= CLOSEST_BOUND, "{worst:?}");
    }

    #[test]
    fn closest_point_of_a_triangle_like_a_point_from_afar_still_names_the_face() {
        let t = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)].map(|(x, y)| Point3::new(scale(x, -400), scale(y, -400), 0.0));
        let over = Point3::new(scale(1.0, -400), scale(1.0, -400), 1.0);
        let closest = closest_point(&t, &over);
        assert_eq!((closest.feature, closest.offset), (Feature::Face, Vector3::z()));
    }

    #[test]
    fn closest_vertex_is_the_vertex_bit_for_bit() {
        let least = f64::from_bits(1);
        let t = [(0.0, least), (1e300, 0.0), (0.0, 1e300)].map(|(x, y)| Point3::new(x, y, least));
        assert_eq!(closest_point(&t, &Point3::new(-1e300, -1e300, 0.0)).point, t[0]);
    }

    /// "A few u": what the tests hold `closest_point` to.
    const CLOSEST_BOUND: f64 = 16.0;

    fn point() -> impl Strategy<Value = Point3<f64>> {
        let coordinate = || prop_oneof![-1.0f64..1.0, (-4i32..5).prop_map(|c| f64::from(c) / 4.0)];
        [coordinate(), coordinate(), coordinate()].prop_map(Point3::from)
    }

    proptest! {
        #[test]
        fn closest_point_is_closest(t in [point(), point(), point()], x in point(), k in -900i32..900, flat in 0u32..60) {
            let scaled = |p: Point3<f64>| Point3::new(p.x, p.y, scale(p.z, -(flat as i32))).map(|c| scale(c, k));
            let (t, x) = (t.map(scaled), scaled(x));
            let (far, off) = errors(&t.map(|p| p.map(|c| scale(c, -k))), &x.map(|c| scale(c, -k)));
            prop_assert!(far <= CLOSEST_BOUND && off <= CLOSEST_BOUND, "off by {far} u, {off} u");
            // Scaling by a power of two changes nothing.
            let (here, there) = (closest_point(&t.map(|p| p.map(|c| scale(c, -k))), &x.map(|c| scale(c, -k))), closest_point(&t, &x));
            prop_assert_eq!(here.feature, there.feature);
            prop_assert_eq!(here.offset.map(|c| scale(c, k)), there.offset);
            prop_assert_eq!(here.point.map(|c| scale(c, k)), there.point);
        }
    }
}
