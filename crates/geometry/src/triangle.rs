//! Triangles (R47): normal, area, plane and barycentric coordinates.

pub use crate::closest::{Closest, Feature, closest_point};
use crate::closest::{Frame, to_unit_scale};
use crate::error::TriangleError;
use crate::normal::vector_area;
use crate::plane::Plane;
use nalgebra::{Point3, UnitVector3};

/// A triangle with an area: three finite vertices that do not lie on one line.
///
/// ```
/// use carom_geometry::nalgebra::Point3;
/// use carom_geometry::triangle::{Feature, Triangle, closest_point};
///
/// let corners = [Point3::origin(), Point3::new(4.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0)];
/// let triangle = Triangle::new(corners)?;
/// assert_eq!(triangle.area(), 8.0);
/// assert_eq!(triangle.barycentric(&Point3::new(1.0, 1.0, 0.0)), [0.5, 0.25, 0.25]);
/// // What of it is nearest to a point: here edge 1, from corner 1 to corner 2.
/// let nearest = closest_point(&corners, &Point3::new(3.0, 3.0, 1.0));
/// assert_eq!((nearest.point, nearest.feature), (Point3::new(2.0, 2.0, 0.0), Feature::Edge(1)));
/// # Ok::<(), carom_geometry::error::TriangleError>(())
/// ```
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::UNIT_ROUNDOFF;
    use nalgebra::Vector3;

    #[test]
    fn r47_zero_area_is_refused_exactly() {
        let (a, b) = (Point3::new(0.1, 0.2, 0.3), Point3::new(1.1, -0.4, 0.7));
        assert!(matches!(Triangle::new([a, b, a]), Err(TriangleError::ZeroArea { .. })));
        let third = |k: f64| Point3::new(k, k, k);
        assert!(matches!(Triangle::new([third(0.1), third(0.3), third(0.7)]), Err(TriangleError::ZeroArea { .. })));
        let sliver = [third(0.1), third(0.3), Point3::new(0.7, 0.7, 0.7f64.next_up())];
        assert!(Triangle::new(sliver).is_ok());
        let bad = Point3::new(0.0, f64::NAN, 0.0);
        assert!(matches!(Triangle::new([a, bad, b]), Err(TriangleError::NotFinite { vertex: 1, .. })));
    }

    #[test]
    fn r47_normal_area_and_plane_of_a_known_triangle() {
        let t = Triangle::new([Point3::new(1.0, 0.0, 2.0), Point3::new(4.0, 0.0, 2.0), Point3::new(1.0, 4.0, 2.0)])
            .unwrap();
        assert_eq!(t.normal().into_inner(), Vector3::z());
        assert_eq!(t.area(), 6.0);
        assert_eq!(t.plane().signed_distance(&Point3::new(9.0, 9.0, 5.0)), 3.0);
    }

    #[test]
    fn r47_barycentric_is_the_ratio_of_the_r44_determinants() {
        use crate::inside::edge_determinant;
        let t = Triangle::new([Point3::new(0.3, -1.0, 0.5), Point3::new(2.0, 0.25, 0.5), Point3::new(-0.5, 3.0, 0.5)])
            .unwrap();
        let v = t.vertices().map(|p| p.xy());
        for x in [Point3::new(0.5, 0.5, 0.5), Point3::new(1.0, 1.0, 0.5), Point3::new(-3.0, 1.0, 7.0)] {
            let w = t.barycentric(&x);
            let whole = edge_determinant(&v[0], &v[1], &v[2]);
            for i in 0..3 {
                let ratio = edge_determinant(&v[(i + 1) % 3], &v[(i + 2) % 3], &x.xy()) / whole;
                assert!((w[i] - ratio).abs() <= 32.0 * UNIT_ROUNDOFF * w[i].abs().max(1.0), "{} against {ratio}", w[i]);
            }
            assert!((w.iter().sum::<f64>() - 1.0).abs() <= 32.0 * UNIT_ROUNDOFF);
        }
    }
}
