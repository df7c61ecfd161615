//! Faces of more than three corners, made triangles.

use carom_geometry::error::PolygonError;
use carom_geometry::normal::unit_normal;
use carom_geometry::polygon::Polygon;
use carom_geometry::projection::DominantAxis;
use carom_geometry::quad::Quad;
use nalgebra::Point3;

/// The triangles of the face with these `corners`, which are in range; or why it has none.
///
/// A triangle stays as it is. Four corners in a plane are a polygon, else two triangles on either side of the shorter diagonal. More are
/// a polygon, in a plane or seen along the dominant axis of its normal. A face whose corners are on one line becomes
/// triangles without area, which the mesh doctor names.
pub(super) fn polygonize(vertices: &[Point3<f64>], corners: &[u32]) -> Result<Vec<[u32; 3]>, String> {
    match *corners {
        [] | [_] | [_, _] => return Err(format!("a face needs three corners or more, but has {}", corners.len())),
        [a, b, c] => return Ok(vec![[a, b, c]]),
        _ => {}
    }
    let place = |corner: u32| vertices[corner as usize];
    // A corner given twice in a row adds nothing.
    let mut ring: Vec<u32> = corners.to_vec();
    ring.dedup_by_key(|corner| place(*corner));
    while ring.len() > 1 && ring.first().map(|c| place(*c)) == ring.last().map(|c| place(*c)) {
        ring.pop();
    }
    let points: Vec<Point3<f64>> = ring.iter().map(|&corner| place(corner)).collect();
    let triangles = match points[..] {
        [] | [_] | [_, _] => return Ok(vec![[corners[0], corners[1], corners[2]]]),
        [_, _, _] => Ok(vec![[0, 1, 2]]),
        [a, b, c, d] => quad([a, b, c, d]),
        _ => polygon(&points),
    };
    match triangles {
        Ok(triangles) => Ok(triangles.into_iter().map(|t| t.map(|i| ring[i])).collect()),
        Err(PolygonError::Collinear) => Ok(ring.windows(2).skip(1).map(|pair| [ring[0], pair[0], pair[1]]).collect()),
        Err(error) => Err(format!("the face is no simple polygon: {error}")),
    }
}

fn quad(points: [Point3<f64>; 4]) -> Result<Vec<[usize; 3]>, PolygonError> {
    Ok(match Quad::new(points)? {
        Quad::Planar(polygon) => polygon.triangulate(),
        Quad::Split { triangles, .. } => {
            let index = |p: &Point3<f64>| points.iter().position(|q| q == p).unwrap_or(0);
            triangles.iter().map(|t| t.vertices().each_ref().map(index)).collect()
        }
    })
}

fn polygon(points: &[Point3<f64>]) -> Result<Vec<[usize; 3]>, PolygonError> {
    match Polygon::new(points.to_vec()) {
        Err(PolygonError::NotPlanar { .. }) => {
            let normal = unit_normal(points).ok_or(PolygonError::Collinear)?;
            let axis = DominantAxis::of(&normal).index();
            let mut flat = points.to_vec();
            flat.iter_mut().for_each(|p| p[axis] = 0.0);
            Ok(Polygon::new(flat)?.triangulate())
        }
        polygon => Ok(polygon?.triangulate()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> f64 {
        let corner = |i: u32| vertices[i as usize];
        let twice = |t: &[u32; 3]| (corner(t[1]) - corner(t[0])).cross(&(corner(t[2]) - corner(t[0]))).norm();
        triangles.iter().map(twice).sum::<f64>() / 2.0
    }

    fn points(list: &[[f64; 3]]) -> Vec<Point3<f64>> {
        list.iter().copied().map(Point3::from).collect()
    }

    #[test]
    fn r38_four_corners_off_a_plane_split_along_the_shorter_diagonal() {
        let vertices = points(&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.5], [3.0, 3.0, 0.0], [0.0, 2.0, 0.5]]);
        assert_eq!(polygonize(&vertices, &[0, 1, 2, 3]), Ok(vec![[0, 1, 3], [1, 2, 3]]));
    }

    #[test]
    fn r37_a_concave_face_is_covered_once() {
        let ell = [[0., 0., 1.], [4., 0., 1.], [4., 1., 1.], [1., 1., 1.], [1., 3., 1.], [0., 3., 1.]];
        let vertices = points(&ell);
        let triangles = polygonize(&vertices, &[0, 1, 2, 3, 4, 5]).expect("a simple polygon");
        assert_eq!((triangles.len(), area(&vertices, &triangles)), (4, 6.0));
        // Slightly off its plane, as files with few digits have it: still the same triangles.
        let mut bent = vertices.clone();
        bent[3].z += 1e-5;
        assert_eq!(polygonize(&bent, &[0, 1, 2, 3, 4, 5]), Ok(triangles));
    }

    #[test]
    fn corners_given_twice_and_corners_on_a_line_stay_for_the_doctor() {
        let vertices = points(&[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [2., 0., 0.], [3., 0., 0.]]);
        assert_eq!(polygonize(&vertices, &[0, 1, 2, 2]), Ok(vec![[0, 1, 2]]));
        assert_eq!(polygonize(&vertices, &[0, 1, 2, 0]), Ok(vec![[0, 1, 2]]));
        assert_eq!(polygonize(&vertices, &[0, 1, 3, 4]), Ok(vec![[0, 1, 3], [0, 3, 4]]));
        assert_eq!(polygonize(&vertices, &[0, 0, 0, 0]), Ok(vec![[0, 0, 0]]));
    }

    #[test]
    fn r37_a_bow_tie_is_refused() {
        let vertices = points(&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]]);
        let refusal = polygonize(&vertices, &[0, 1, 2, 3]);
        assert!(refusal.is_err_and(|message| message.contains("edges 1 and 3")));
    }
}
