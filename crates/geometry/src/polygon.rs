//! Simple planar polygons, convex or concave (R35 to R39): checked once, when they are made.

use crate::error::PolygonError;
use crate::inside::{Location, locate_convex, locate_simple};
use crate::normal::vector_area;
use crate::plane::Plane;
use crate::predicates::{Sign, collinear};
use crate::projection::DominantAxis;
use crate::rounding::{exponent, planarity_bound, scale};
use crate::simple::{clip_ears, first_crossing, orientation, turns};
use nalgebra::{Point2, Point3, UnitVector3};

/// A simple polygon: at least three vertices in order around it, in one plane to rounding, whose edges meet only at the vertices between
/// them. Edge i runs from vertex i to the next.
///
/// ```
/// use carom_geometry::inside::Location;
/// use carom_geometry::nalgebra::Point3;
/// use carom_geometry::polygon::Polygon;
///
/// let corners = |xy: &[(f64, f64)]| xy.iter().map(|&(x, y)| Point3::new(x, y, 1.0)).collect();
/// let l = Polygon::new(corners(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]))?;
/// assert_eq!((l.area(), l.is_convex(), l.reflex_vertices()), (3.0, false, &[3][..]));
/// assert_eq!(l.locate(&Point3::new(0.5, 1.5, 1.0)), Location::Inside);
/// assert_eq!(l.locate(&Point3::new(1.5, 1.5, 1.0)), Location::Outside);
/// assert_eq!(l.locate(&Point3::new(1.5, 0.0, 1.0)), Location::OnEdge(0));
///
/// // What is no simple polygon is refused, with what is wrong and where.
/// let bow_tie = Polygon::new(corners(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]));
/// assert!(bow_tie.is_err_and(|error| error.to_string().contains("edge")));
/// # Ok::<(), carom_geometry::error::PolygonError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    vertices: Vec<Point3<f64>>,
    plane: Plane,
    area: f64,
    off_plane: f64,
    axis: DominantAxis,
    flat: Vec<Point2<f64>>,
    reflex: Vec<usize>,
}

impl Polygon {
    /// The polygon of `vertices`, in either order around it; the normal follows from the order by the right-hand rule.
    ///
    /// Refused, with the place of the fault: fewer than three vertices, coordinates that are not finite, equal consecutive vertices, vertices on
    /// one line, a vertex farther off the plane than rounded coordinates explain
    /// ([`planarity_bound`]), and edges that cross, touch or overlap (decided exactly in the projection along the dominant
    /// axis). Vertices on a straight edge are fine. Every pair of edges is looked at: meant for up to some hundred vertices.
    pub fn new(vertices: Vec<Point3<f64>>) -> Result<Self, PolygonError> {
        check_vertices(&vertices)?;
        let span = spanning_triangle(&vertices).ok_or(PolygonError::Collinear)?;
        let near_normal = check_planarity(&vertices, &span)?;
        // A figure of eight may have no area at all, so what crosses is found before the area is asked for.
        let mut axis = DominantAxis::of(&near_normal);
        let mut flat = project(&vertices, axis)?;
        let area = vector_area(&vertices).ok_or(PolygonError::Collinear)?;
        if DominantAxis::of(&area.normal) != axis {
            axis = DominantAxis::of(&area.normal);
            flat = project(&vertices, axis)?;
        }
        let plane = Plane::from_parts(vertices[0], area.normal);
        let off_plane = vertices.iter().fold(0.0, |most, v| f64::max(most, plane.signed_distance(v).abs()));
        let against = orientation(&flat).reverse();
        let reflex = turns(&flat).enumerate().filter(|(_, s)| *s == against).map(|(i, _)| i).collect();
        Ok(Self { vertices, plane, area: area.area, off_plane, axis, flat, reflex })
    }

    /// The vertices, as given.
    pub fn vertices(&self) -> &[Point3<f64>] {
        &self.vertices
    }

    /// The unit normal: the direction of the vector area, half the sum of p_i x p_(i+1) (Newell).
    ///
    /// It equals (p1 - p0) x (p3 - p0) / |...| (R39), with p3 the last vertex, wherever p0 is convex; at a reflex p0 that one points the wrong
    /// way, and on a straight edge it does not exist.
    pub fn normal(&self) -> UnitVector3<f64> {
        self.plane.normal()
    }

    /// The plane through the first vertex across the normal.
    pub fn plane(&self) -> Plane {
        self.plane
    }

    /// The area.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// How far the vertex farthest off the plane is, as computed.
    pub fn off_plane(&self) -> f64 {
        self.off_plane
    }

    /// The axis along which the polygon is projected.
    pub fn axis(&self) -> DominantAxis {
        self.axis
    }

    /// Whether no vertex is reflex.
    pub fn is_convex(&self) -> bool {
        self.reflex.is_empty()
    }

    /// The indices of the vertices with an inner angle above 180 degrees, decided exactly.
    pub fn reflex_vertices(&self) -> &[usize] {
        &self.reflex
    }

    /// Where `x` lies when both are projected along the dominant axis (R43 to R46); exact.
    ///
    /// A point of the plane that was rounded need not lie where the exact one does: this is the polygon's own question about a point, and no way to
    /// decide whether a moving point hits it.
    pub fn locate(&self, x: &Point3<f64>) -> Location {
        let x = self.axis.project(x);
        if self.is_convex() { locate_convex(&self.flat, &x) } else { locate_simple(&self.flat, &x) }
    }

    /// Triangles that cover the polygon and share no inner point (R47): indices of vertices, turning as the polygon does. n - 2 of them, each with an
    /// area, by ear clipping with exact decisions: the same answer on every machine.
    pub fn triangulate(&self) -> Vec<[usize; 3]> {
        clip_ears(&self.flat)
    }
}

fn check_vertices(vertices: &[Point3<f64>]) -> Result<(), PolygonError> {
    let count = vertices.len();
    if count < 3 {
        return Err(PolygonError::TooFewVertices { count });
    }
    if let Some(vertex) = vertices.iter().position(|p| p.iter().any(|c| !c.is_finite())) {
        return Err(PolygonError::NotFinite { vertex, point: vertices[vertex] });
    }
    match (0..count).find(|&i| vertices[i] == vertices[(i + 1) % count]) {
        Some(vertex) => {
            Err(PolygonError::RepeatedVertex { vertex, next: (vertex + 1) % count, point: vertices[vertex] })
        }
        None => Ok(()),
    }
}

/// Three vertices that span the plane: the largest triangle of the fan around vertex 0 or, if that has none, any; none if all vertices
/// lie on one line.
fn spanning_triangle(vertices: &[Point3<f64>]) -> Option<[Point3<f64>; 3]> {
    let origin = vertices[0];
    let near_one = unit_scale(vertices);
    let size = |i: usize| vector_area(&[near_one[0], near_one[i], near_one[i + 1]]).map(|a| (i, a.area));
    let fan = (1..vertices.len() - 1).filter_map(size).max_by(|p, q| p.1.total_cmp(&q.1).then(q.0.cmp(&p.0)));
    if let Some((i, _)) = fan {
        return Some([origin, vertices[i], vertices[i + 1]]);
    }
    // Every second vertex may be the same one.
    let pairs = (1..vertices.len()).flat_map(|i| (i + 1..vertices.len()).map(move |j| (i, j)));
    pairs.map(|(i, j)| [origin, vertices[i], vertices[j]]).find(|[a, b, c]| !collinear(a, b, c))
}

/// The vertices scaled to a size of about 1 by a power of two.
fn unit_scale(vertices: &[Point3<f64>]) -> Vec<Point3<f64>> {
    let k = exponent(vertices.iter().fold(0.0, |most, v| f64::max(most, v.coords.amax())));
    vertices.iter().map(|v| v.map(|c| scale(c, -k))).collect()
}

/// The normal of the spanning triangle, if all vertices lie in its plane to rounding.
fn check_planarity(vertices: &[Point3<f64>], span: &[Point3<f64>; 3]) -> Result<UnitVector3<f64>, PolygonError> {
    let size = vertices.iter().fold(0.0, |most, v| f64::max(most, v.coords.amax()));
    let k = exponent(size);
    let near_one = |p: &Point3<f64>| p.map(|c| scale(c, -k));
    let [a, b, c] = span.each_ref().map(near_one);
    let area = vector_area(&[a, b, c]).ok_or(PolygonError::Collinear)?;
    let plane = Plane::from_parts(a, area.normal);
    let perimeter = (b - a).norm() + (c - b).norm() + (a - c).norm();
    let diameter = vertices.iter().fold(0.0, |most, v| f64::max(most, (near_one(v) - a).norm()));
    let bound = planarity_bound(scale(size, -k), diameter, perimeter, area.area);
    let distances = vertices.iter().map(|v| plane.signed_distance(&near_one(v)).abs()).enumerate();
    match distances.max_by(|p, q| p.1.total_cmp(&q.1)) {
        Some((vertex, distance)) if distance > bound => {
            Err(PolygonError::NotPlanar { vertex, distance: scale(distance, k), bound: scale(bound, k) })
        }
        _ => Ok(area.normal),
    }
}

/// The projection along `axis`, if no edges cross in it.
fn project(vertices: &[Point3<f64>], axis: DominantAxis) -> Result<Vec<Point2<f64>>, PolygonError> {
    let flat: Vec<_> = vertices.iter().map(|v| axis.project(v)).collect();
    match first_crossing(&flat) {
        Some((first, second)) => Err(PolygonError::EdgesCross { first, second }),
        None if orientation(&flat) == Sign::Zero => Err(PolygonError::Collinear),
        None => Ok(flat),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::NORMAL_BOUND;
    use nalgebra::{Rotation3, Vector3};
    use proptest::prelude::*;

    fn flat<const N: usize>(p: [(f64, f64); N]) -> Vec<Point3<f64>> {
        p.map(|(x, y)| Point3::new(x, y, 0.5)).to_vec()
    }

    fn ell() -> Vec<Point3<f64>> {
        flat([(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)])
    }

    #[test]
    fn r36_what_is_wrong_and_where() {
        let err = |v: Vec<Point3<f64>>| Polygon::new(v).unwrap_err();
        assert_eq!(err(flat([(0.0, 0.0), (1.0, 0.0)])), PolygonError::TooFewVertices { count: 2 });
        assert!(matches!(
            err(flat([(0.0, 0.0), (1.0, f64::NAN), (1.0, 1.0)])),
            PolygonError::NotFinite { vertex: 1, .. }
        ));
        let repeated = flat([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)]);
        assert!(matches!(err(repeated), PolygonError::RepeatedVertex { vertex: 3, next: 0, .. }));
        assert_eq!(err(flat([(0.1, 0.1), (0.3, 0.3), (0.7, 0.7)])), PolygonError::Collinear);
        let mut off = flat([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.5), (0.0, 1.0)]);
        off[3].z += 1e-9;
        assert!(
            matches!(err(off), PolygonError::NotPlanar { vertex: 3, distance, bound } if distance > 0.9e-9 && bound < 1e-13)
        );
    }

    #[test]
    fn r37_star_and_bow_tie_are_refused_with_their_edges() {
        let bow_tie = flat([(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert_eq!(Polygon::new(bow_tie), Err(PolygonError::EdgesCross { first: 0, second: 2 }));
        let lopsided = flat([(0.0, 0.0), (1.0, 1.0), (1.0, 0.25), (0.0, 1.0)]);
        assert_eq!(Polygon::new(lopsided), Err(PolygonError::EdgesCross { first: 0, second: 2 }));
        let star = (0..5).map(|k| {
            let angle = f64::from(2 * k) / 5.0 * std::f64::consts::TAU;
            Point3::new(angle.cos(), 0.25 * angle.cos() + 0.5 * angle.sin(), angle.sin())
        });
        assert_eq!(Polygon::new(star.collect()), Err(PolygonError::EdgesCross { first: 0, second: 2 }));
        let back_and_forth = flat([(0.0, 0.0), (1.0, 0.0), (0.0, 0.0), (1.0, 1.0)]);
        assert!(matches!(Polygon::new(back_and_forth), Err(PolygonError::EdgesCross { .. })));
    }

    #[test]
    fn r37_concave_polygons_work() {
        let polygon = Polygon::new(ell()).unwrap();
        assert!(!polygon.is_convex());
        assert_eq!(polygon.reflex_vertices(), [3]);
        assert_eq!((polygon.area(), polygon.normal().into_inner(), polygon.off_plane()), (6.0, Vector3::z(), 0.0));
        for (x, y, place) in [
            (0.5, 2.0, Location::Inside),
            (3.0, 2.0, Location::Outside),
            (1.0, 1.0, Location::OnVertex(3)),
            (1.0, 2.0, Location::OnEdge(3)),
            (1f64.next_up(), 1f64.next_up(), Location::Outside),
            (1f64.next_down(), 1f64.next_up(), Location::Inside),
        ] {
            assert_eq!(polygon.locate(&Point3::new(x, y, 9.0)), place, "({x}, {y})");
        }
        for start in 0..6 {
            let mut from_there = ell();
            from_there.rotate_left(start);
            assert_eq!(Polygon::new(from_there).unwrap().reflex_vertices(), [(3 + 6 - start) % 6], "from {start}");
        }
        assert!(Polygon::new(flat([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])).unwrap().is_convex());
        let mut reversed = ell();
        reversed.reverse();
        let reversed = Polygon::new(reversed).unwrap();
        assert_eq!(reversed.normal().into_inner(), -Vector3::z());
        assert_eq!(reversed.reflex_vertices(), [2]);
    }

    #[test]
    fn r39_newell_is_the_slides_normal_except_at_a_reflex_or_flat_vertex() {
        let slides = |v: &[Point3<f64>]| (v[1] - v[0]).cross(&(v[v.len() - 1] - v[0]));
        let turn = Rotation3::from_euler_angles(0.3, -1.1, 2.0);
        for start in 0..6 {
            let mut vertices: Vec<_> = ell().iter().map(|p| turn * p).collect();
            vertices.rotate_left(start);
            let newell = Polygon::new(vertices.clone()).unwrap().normal().into_inner();
            let sign = if start == 3 { -1.0 } else { 1.0 };
            assert!((newell - slides(&vertices).normalize() * sign).amax() <= NORMAL_BOUND, "from vertex {start}");
        }
        let flat_corner = flat([(1.0, 0.0), (2.0, 0.0), (1.0, 2.0), (0.0, 0.0)]);
        assert_eq!(slides(&flat_corner), Vector3::zeros());
        assert_eq!(Polygon::new(flat_corner).unwrap().normal().into_inner(), Vector3::z());
    }

    #[test]
    fn r47_triangles_cover_the_polygon() {
        let polygon = Polygon::new(ell()).unwrap();
        let v = polygon.vertices();
        let areas: Vec<f64> = polygon
            .triangulate()
            .iter()
            .map(|t| (v[t[1]] - v[t[0]]).cross(&(v[t[2]] - v[t[0]])).dot(&polygon.normal()) / 2.0)
            .collect();
        assert!(areas.len() == 4 && areas.iter().all(|a| *a > 0.0) && areas.iter().sum::<f64>() == 6.0, "{areas:?}");
    }

    #[test]
    fn r36_the_plane_is_that_of_the_largest_triangle_and_so_is_its_bound() {
        for k in [-600, 0, 600] {
            let big = |v: Vec<Point3<f64>>| v.into_iter().map(|p| p.map(|c| scale(c, k))).collect::<Vec<_>>();
            // Vertices 0, 1 and 2 are a triangle so thin that next to nothing would be off its plane.
            let mut thin_first = flat([(0.0, 0.0), (1.0, 0.0), (2.0, 1e-9), (2.0, 2.0), (0.0, 2.0)]);
            thin_first[4].z += 1e-9;
            assert!(matches!(Polygon::new(big(thin_first)), Err(PolygonError::NotPlanar { .. })), "2^{k}");
            // The legs 4 and 3 of a right triangle: perimeter 12, area 6, diameter 5.
            let [x, y, z, w] = [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 3.0, 0.0), (3.0, 3.5, 0.5)];
            let right = [x, y, z, w].map(|(x, y, z)| Point3::new(x, y, z)).to_vec();
            let (distance, bound) = (scale(0.5, k), scale(planarity_bound(4.0, 5.0, 12.0, 6.0), k));
            assert_eq!(Polygon::new(big(right)), Err(PolygonError::NotPlanar { vertex: 3, distance, bound }));
        }
    }

    proptest! {
        #[test]
        fn r36_rotated_and_moved_polygons_are_planar(
            angles in prop::array::uniform3(-3.0f64..3.0), at in prop::array::uniform3(-1.0f64..1.0), far in 0i32..40, k in -900i32..900,
        ) {
            let turn = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
            let place = |p: &Point3<f64>| (turn * p + Vector3::from(at) * scale(1.0, far)).map(|c| scale(c, k));
            let polygon = Polygon::new(ell().iter().map(place).collect());
            prop_assert!(polygon.is_ok(), "{polygon:?}");
            prop_assert_eq!(polygon.map(|p| p.reflex_vertices().to_vec()), Ok(vec![3]));
        }
    }
}
