//! Triangles (R47): normal, barycentric coordinates, and the closest point to a given one.

use crate::error::TriangleError;
use crate::normal::{cross_compensated, vector_area};
use crate::plane::Plane;
use crate::rounding::{NEEDLE_SINE_SQUARED, exponent, scale};
use nalgebra::{Point3, UnitVector3, Vector3};

/// A triangle with an area: three finite vertices that do not lie on one line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    vertices: [Point3<f64>; 3],
    normal: UnitVector3<f64>,
    area: f64,
}

impl Triangle {
    /// The triangle of `vertices`; refused if one is not finite, or if they lie on one line, which is decided exactly.
    pub fn new(vertices: [Point3<f64>; 3]) -> Result<Self, TriangleError> {
        if let Some(vertex) = vertices.iter().position(|p| p.iter().any(|c| !c.is_finite())) {
            return Err(TriangleError::NotFinite { vertex, point: vertices[vertex] });
        }
        let area = vector_area(&vertices).ok_or(TriangleError::ZeroArea { vertices })?;
        Ok(Self { vertices, normal: area.normal, area: area.area })
    }

    /// The vertices.
    pub fn vertices(&self) -> &[Point3<f64>; 3] {
        &self.vertices
    }

    /// The unit normal (p1 - p0) x (p2 - p0) / |...| (R39), within [`NORMAL_BOUND`](crate::rounding::NORMAL_BOUND) of the exact one
    /// however thin the triangle.
    pub fn normal(&self) -> UnitVector3<f64> {
        self.normal
    }

    /// The area, to some roundings; infinite or zero where it is beyond what f64 can represent.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The plane through the first vertex across [`normal`](Self::normal).
    pub fn plane(&self) -> Plane {
        Plane::from_parts(self.vertices[0], self.normal)
    }

    /// The barycentric coordinates (w0, w1, w2) of the projection of `x` onto the plane: it is w0 p0 + w1 p1 + w2 p2, and w0 + w1 +
    /// w2 = 1 to rounding. All are >= 0 within the triangle; w_i = 0 on the edge opposite to vertex i.
    ///
    /// w_i is the signed area of x with that edge over the area of the triangle: the ratio of two determinants of the inside
    /// test (R44 to R46).
    pub fn barycentric(&self, x: &Point3<f64>) -> [f64; 3] {
        let (vertices, x) = to_unit_scale(&self.vertices, x).map_or((self.vertices, *x), |(v, x, _)| (v, x));
        let n = Frame::new(&vertices).normal;
        let twice_area = n.norm_squared();
        std::array::from_fn(|i| {
            let (b, c) = (vertices[(i + 1) % 3], vertices[(i + 2) % 3]);
            n.dot(&(b - x).cross(&(c - x))) / twice_area
        })
    }
}

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
/// Any finite triangle will do: one without an area is the segment or the point that it covers. The answer is finite if the differences
/// of the coordinates are. Accuracy: a few u of the largest distance between `x` and a vertex, for needles as well, and u of the
/// coordinates of `point`; the offset is orthogonal to the face or edge to a few u *of itself*. Voronoi regions as in Ericson, Real-Time
/// Collision Detection (2005), section 5.1.5, from the vertex opposite to the longest edge.
pub fn closest_point(triangle: &[Point3<f64>; 3], x: &Point3<f64>) -> Closest {
    match to_unit_scale(triangle, x) {
        None => closest_in_range(triangle, x),
        Some((triangle_scaled, x_scaled, k)) => {
            let closest = closest_in_range(&triangle_scaled, &x_scaled);
            let offset = closest.offset.map(|c| scale(c, k));
            let point = match closest.feature {
                Feature::Vertex(i) => triangle[usize::from(i)],
                _ => x - offset,
            };
            Closest { point, offset, ..closest }
        }
    }
}

/// Exponents of coordinate differences for which products of four neither overflow nor lose what matters.
const DIRECT_RANGE: std::ops::Range<i32> = -200..250;

/// The triangle and the point relative to the first vertex, scaled by 2^-k to a size of about 1; none if there is no need.
fn to_unit_scale(triangle: &[Point3<f64>; 3], x: &Point3<f64>) -> Option<([Point3<f64>; 3], Point3<f64>, i32)> {
    let origin = triangle[0];
    let edges = (triangle[1] - origin).amax().max((triangle[2] - origin).amax());
    let most = edges.max((x - origin).amax());
    if DIRECT_RANGE.contains(&exponent(most)) && (DIRECT_RANGE.contains(&exponent(edges)) || edges == 0.0)
        || most == 0.0
    {
        return None;
    }
    // The triangle decides: a point too far off for it is seen at the edge of the range, in its direction.
    let k = exponent(if edges > 0.0 { edges } else { most }).max(exponent(most) - DIRECT_RANGE.end + 1);
    let near = |p: &Point3<f64>| Point3::from((p - origin).map(|c| scale(c, -k)));
    Some((triangle.each_ref().map(near), near(x), k))
}

/// A triangle seen from the vertex opposite to its longest edge.
struct Frame {
    /// Index of that vertex.
    first: u8,
    /// The vertices from there.
    vertices: [Point3<f64>; 3],
    /// Edges to the second and third vertex.
    ab: Vector3<f64>,
    ac: Vector3<f64>,
    /// ab x ac.
    normal: Vector3<f64>,
}

impl Frame {
    fn new(t: &[Point3<f64>; 3]) -> Self {
        let squares = [t[1] - t[0], t[2] - t[1], t[0] - t[2]].map(|e| e.norm_squared());
        // Edge i runs from vertex i to i + 1 and is opposite to vertex i + 2.
        let first = if squares[1] >= squares[0] && squares[1] >= squares[2] {
            0
        } else if squares[2] >= squares[0] {
            1
        } else {
            2
        };
        let vertices = [t[first], t[(first + 1) % 3], t[(first + 2) % 3]];
        let [a, b, c] = vertices;
        let (ab, ac) = (b - a, c - a);
        let mut normal = ab.cross(&ac);
        if normal.norm_squared() < NEEDLE_SINE_SQUARED * squares[first] * squares[(first + 2) % 3] {
            normal = cross_compensated(&a, &b, &c);
        }
        Self { first: first as u8, vertices, ab, ac, normal }
    }

    fn vertex(&self, i: u8) -> Feature {
        Feature::Vertex((self.first + i) % 3)
    }

    fn edge(&self, i: u8) -> Feature {
        Feature::Edge((self.first + i) % 3)
    }
}

fn closest_in_range(triangle: &[Point3<f64>; 3], x: &Point3<f64>) -> Closest {
    let frame = Frame::new(triangle);
    let ([a, b, c], ab, ac) = (frame.vertices, frame.ab, frame.ac);
    let at = |point: Point3<f64>, offset, feature| Closest { point, offset, feature };

    let ap = x - a;
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return at(a, ap, frame.vertex(0));
    }
    let bp = x - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return at(b, bp, frame.vertex(1));
    }
    let cp = x - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return at(c, cp, frame.vertex(2));
    }
    // Triple products, not the differences of products d1 d4 - d3 d2 ... that they equal: those lose the height of a needle.
    let n = frame.normal;
    let inside = |p: &Vector3<f64>, q: &Vector3<f64>| n.dot(&p.cross(q));
    let along = |origin: &Point3<f64>, p: &Vector3<f64>, edge: &Vector3<f64>, part: f64, feature| {
        let offset = p - edge * part;
        // Once more, for what rounding left along the edge.
        let rest = edge.dot(&offset) / edge.norm_squared();
        let (point, offset) = (origin + edge * (part + rest), offset - edge * rest);
        at(point, offset, feature)
    };
    let (vc, vb, va) = (inside(&ab, &ap), inside(&ap, &ac), inside(&bp, &cp));
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3 {
        return along(&a, &ap, &ab, d1 / (d1 - d3), frame.edge(0));
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6 {
        return along(&a, &ap, &ac, d2 / (d2 - d6), frame.edge(2));
    }
    let (beyond_b, beyond_c) = (d4 - d3, d5 - d6);
    if va <= 0.0 && beyond_b >= 0.0 && beyond_c >= 0.0 && beyond_b + beyond_c > 0.0 {
        return along(&b, &bp, &(c - b), beyond_b / (beyond_b + beyond_c), frame.edge(1));
    }
    let area_squared = n.norm_squared();
    if area_squared > 0.0 {
        let offset = n * (n.dot(&ap) / area_squared);
        return at(x - offset, offset, Feature::Face);
    }
    // No area, and rounding put x past every segment: the nearest vertex.
    let nearer = |p: &Vector3<f64>, q: &Vector3<f64>| p.norm_squared() <= q.norm_squared();
    if nearer(&ap, &bp) && nearer(&ap, &cp) {
        at(a, ap, frame.vertex(0))
    } else if nearer(&bp, &cp) {
        at(b, bp, frame.vertex(1))
    } else {
        at(c, cp, frame.vertex(2))
    }
}
