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

    /// What of the triangle is closest to `x`, as [`closest`](Self::closest) says: but on the border between two features, rounding may decide otherwise.
    #[inline]
    pub(crate) fn nearest(&self, x: &Vector3<f64>) -> Feature {
        if self.in_range && largest(self.size, amax(&(x - self.corners[0]))) < LIMIT_OF_DIRECT {
            self.frame.nearest(&Point3::from(*x))
        } else {
            self.closest(x).feature
        }
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

    /// How far the foot of a point is inside of each edge, from the point's place as seen from each vertex.
    ///
    /// Triple products, not the differences of products d1 d4 - d3 d2 ... that they equal: those lose the height of a needle.
    #[inline]
    fn insides(&self, [ap, bp, cp]: &[Vector3<f64>; 3]) -> [f64; 3] {
        let inside = |p: &Vector3<f64>, q: &Vector3<f64>| self.normal.dot(&p.cross(q));
        [inside(&self.ab, ap), inside(ap, &self.ac), inside(bp, cp)]
    }

    /// What of the triangle is closest to the point that is seen like this from each vertex, counted from the first one here.
    #[inline]
    fn region(&self, [ap, bp, cp]: &[Vector3<f64>; 3], insides: impl FnOnce() -> [f64; 3]) -> Feature {
        let (ab, ac) = (self.ab, self.ac);
        let (d1, d2) = (ab.dot(ap), ac.dot(ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return Feature::Vertex(0);
        }
        let (d3, d4) = (ab.dot(bp), ac.dot(bp));
        if d3 >= 0.0 && d4 <= d3 {
            return Feature::Vertex(1);
        }
        let (d5, d6) = (ab.dot(cp), ac.dot(cp));
        if d6 >= 0.0 && d5 <= d6 {
            return Feature::Vertex(2);
        }
        let [vc, vb, va] = insides();
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3 {
            return Feature::Edge(0);
        }
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6 {
            return Feature::Edge(2);
        }
        let (beyond_b, beyond_c) = (d4 - d3, d5 - d6);
        if va <= 0.0 && beyond_b >= 0.0 && beyond_c >= 0.0 && beyond_b + beyond_c > 0.0 {
            return Feature::Edge(1);
        }
        Feature::Face
    }

    /// A feature, counted from the first vertex, as the triangle counts them.
    #[inline]
    fn of_triangle(&self, feature: Feature) -> Feature {
        match feature {
            Feature::Face => Feature::Face,
            Feature::Edge(i) => Feature::Edge((self.first + i) % 3),
            Feature::Vertex(i) => Feature::Vertex((self.first + i) % 3),
        }
    }

    /// What of the triangle is closest to `x`, except for one without an area.
    #[inline]
    fn nearest(&self, x: &Point3<f64>) -> Feature {
        let seen = self.vertices.map(|v| x - v);
        let insides = self.insides(&seen);
        // Of a needle, the triple products do not tell what is beyond its ends.
        if !self.is_needle && insides.iter().all(|inside| *inside > 0.0) {
            return Feature::Face;
        }
        self.of_triangle(self.region(&seen, || insides))
    }

    /// The closest point, of a triangle and a point in [`DIRECT_RANGE`].
    fn closest(&self, x: &Point3<f64>) -> Closest {
        let vertices = &self.vertices;
        let seen = vertices.map(|v| x - v);
        let at = |point: Point3<f64>, offset, feature| Closest { point, offset, feature: self.of_triangle(feature) };
        match self.region(&seen, || self.insides(&seen)) {
            Feature::Vertex(i) => at(vertices[usize::from(i)], seen[usize::from(i)], Feature::Vertex(i)),
            Feature::Edge(i) => {
                let vertex = |i: u8| &vertices[usize::from(i)].coords;
                let foot = Foot::on(ends_of_edge(i, vertex).map(vertex), &x.coords);
                at(foot.point.into(), foot.offset, Feature::Edge(i))
            }
            Feature::Face => {
                let (n, [ap, bp, cp]) = (self.normal, &seen);
                let area_squared = n.norm_squared();
                if area_squared > 0.0 {
                    let offset = n * (n.dot(ap) / area_squared);
                    return at(x - offset, offset, Feature::Face);
                }
                // No area, and rounding put x past every segment: the nearest vertex.
                let nearer = |p: &Vector3<f64>, q: &Vector3<f64>| p.norm_squared() <= q.norm_squared();
                let [a, b, c] = *vertices;
                if nearer(ap, bp) && nearer(ap, cp) {
                    at(a, *ap, Feature::Vertex(0))
                } else if nearer(bp, cp) {
                    at(b, *bp, Feature::Vertex(1))
                } else {
                    at(c, *cp, Feature::Vertex(2))
                }
            }
        }
    }
}

/// The point of a line that is nearest to x.
pub(crate) struct Foot {
    pub(crate) point: Vector3<f64>,
    /// x - `point`, orthogonal to the line to a few units of itself.
    pub(crate) offset: Vector3<f64>,
    /// How far it is from the one end to the other: in [0, 1] between them.
    pub(crate) part: f64,
}

impl Foot {
    /// On the line through two points: which is the first makes a difference to the rounding.
    #[inline]
    pub(crate) fn on([from, to]: [&Vector3<f64>; 2], x: &Vector3<f64>) -> Self {
        let (edge, offset) = (to - from, x - from);
        let length = edge.norm_squared();
        if length == 0.0 {
            return Self { point: *from, offset, part: 0.0 };
        }
        let part = edge.dot(&offset) / length;
        let offset = offset - edge * part;
        // Once more, for what rounding left along the edge.
        let rest = edge.dot(&offset) / length;
        Self { point: from + edge * (part + rest), offset: offset - edge * rest, part: part + rest }
    }
}

/// Which are the ends of edge `i` of a triangle with these corners, first the one that is by size: in the same direction from each face that has the edge.
#[inline]
pub(crate) fn ends_of_edge<'a>(i: u8, corner: impl Fn(u8) -> &'a Vector3<f64>) -> [u8; 2] {
    let j = (i + 1) % 3;
    if by_size(corner(i), corner(j)).is_le() { [i, j] } else { [j, i] }
}

#[cfg(test)]
mod tests;
