//! Four vertices (R38): a polygon if they lie in one plane, else two triangles.

use crate::error::PolygonError;
use crate::exact;
use crate::normal::unit;
use crate::polygon::Polygon;
use crate::rounding::{exponent, scale};
use crate::triangle::Triangle;
use nalgebra::Point3;

/// What four vertices make.
///
/// ```
/// use carom_geometry::nalgebra::Point3;
/// use carom_geometry::quad::Quad;
///
/// let corners = |z| [Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(1.0, 1.0, z), Point3::new(0.0, 1.0, 0.0)];
/// assert!(matches!(Quad::new(corners(0.0))?, Quad::Planar(square) if square.area() == 1.0));
/// assert!(matches!(Quad::new(corners(0.5))?, Quad::Split { .. }));
/// # Ok::<(), carom_geometry::error::PolygonError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Quad {
    /// They lie in one plane to rounding.
    Planar(Polygon),
    /// They do not.
    Split {
        /// The halves, on either side of the shorter diagonal (of equals, the one from vertex 0), turning as the vertices do.
        triangles: [Triangle; 2],
        /// The distance between the two diagonals' lines: the thickness of the thinnest slab across (p2 - p0) x (p3 - p1) that holds all four.
        off_plane: f64,
    },
}

impl Quad {
    /// The quadrilateral of four vertices in order around it.
    ///
    /// Planar is what [`Polygon::new`] takes for planar; what it refuses for another reason is refused. The halves of one that is not
    /// planar always have an area: with three vertices on one line, all four lie in a plane.
    pub fn new(vertices: [Point3<f64>; 4]) -> Result<Self, PolygonError> {
        match Polygon::new(vertices.to_vec()) {
            Ok(polygon) => Ok(Self::Planar(polygon)),
            Err(PolygonError::NotPlanar { .. }) => Self::split(vertices),
            Err(other) => Err(other),
        }
    }

    fn split([p0, p1, p2, p3]: [Point3<f64>; 4]) -> Result<Self, PolygonError> {
        let length_squared = |p: &Point3<f64>, q: &Point3<f64>| {
            let d = exact::difference(q, p);
            exact::dot(&d, &d)
        };
        let halves = if length_squared(&p0, &p2) <= length_squared(&p1, &p3) {
            [[p0, p1, p2], [p0, p2, p3]]
        } else {
            [[p0, p1, p3], [p1, p2, p3]]
        };
        let [first, second] = halves.map(Triangle::new);
        Ok(Self::Split { triangles: [first?, second?], off_plane: diagonal_distance(&[p0, p1, p2, p3]) })
    }
}

/// |n.(p1 - p0)| with n the unit vector across both diagonals; 0 if these are parallel.
fn diagonal_distance(vertices: &[Point3<f64>; 4]) -> f64 {
    let k = exponent(vertices.iter().fold(0.0, |most, v| f64::max(most, v.coords.amax())));
    let [p0, p1, p2, p3] = vertices.map(|v| v.map(|c| scale(c, -k)));
    unit(&(p2 - p0).cross(&(p3 - p1))).map_or(0.0, |n| scale(n.dot(&(p1 - p0)).abs(), k))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::UNIT_ROUNDOFF;

    fn saddle(lift: f64) -> [Point3<f64>; 4] {
        [
            Point3::new(0.0, 0.0, 0.0),
            Point3::new(2.0, 0.0, lift),
            Point3::new(2.0, 2.0, 0.0),
            Point3::new(0.0, 2.0, lift),
        ]
    }

    #[test]
    fn r38_four_vertices_off_one_plane_are_two_triangles() {
        let Ok(Quad::Split { triangles, off_plane }) = Quad::new(saddle(0.5)) else { panic!("not split") };
        // The diagonals are equally long: the one from vertex 0 splits.
        let v = saddle(0.5);
        assert_eq!(triangles.map(|t| *t.vertices()), [[v[0], v[1], v[2]], [v[0], v[2], v[3]]]);
        assert!((off_plane - 0.5).abs() <= 4.0 * UNIT_ROUNDOFF);
        assert!(triangles.iter().all(|t| t.normal().z > 0.0));
        // A shorter diagonal from vertex 1.
        let mut v = saddle(0.5);
        v[2] = Point3::new(3.0, 3.0, 0.0);
        let Ok(Quad::Split { triangles, .. }) = Quad::new(v) else { panic!("not split") };
        assert_eq!(triangles.map(|t| *t.vertices()), [[v[0], v[1], v[3]], [v[1], v[2], v[3]]]);
    }

    #[test]
    fn r38_four_vertices_in_one_plane_are_a_polygon() {
        assert!(matches!(Quad::new(saddle(0.0)), Ok(Quad::Planar(_))));
        assert!(matches!(Quad::new(saddle(UNIT_ROUNDOFF)), Ok(Quad::Planar(p)) if p.off_plane() > 0.0));
        assert!(matches!(Quad::new(saddle(1e-9)), Ok(Quad::Split { .. })));
        let [a, b, c, d] = saddle(0.0);
        assert!(matches!(Quad::new([a, c, b, d]), Err(PolygonError::EdgesCross { .. })));
    }

    #[test]
    fn r38_three_of_four_on_one_line_are_planar() {
        let [a, b, ..] = saddle(0.0);
        let quad = [a, b, Point3::new(1.0, 0.0, 0.0), Point3::new(1.0, 1.0, 1.0)];
        // Planar, so it is the polygon that is refused: its first two edges overlap.
        assert!(matches!(Quad::new(quad), Err(PolygonError::EdgesCross { first: 0, second: 1 })));
    }
}
