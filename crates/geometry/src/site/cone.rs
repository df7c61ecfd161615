//! The directions in which a place of a mesh can touch a ball: its normal cone.

use super::Site;
use crate::bounds::{amax, largest};
use crate::mesh::Mesh;
use crate::rounding::cone_bound;
use nalgebra::Vector3;

impl Mesh {
    /// The unit normal of a ball that `site` touches, whose centre is `away` from there: the direction of `away`, but in the cone of those in which
    /// `site` is what of the mesh is nearest. None if `away` is zero.
    ///
    /// At an edge the cone lies between the normals of its faces, at a vertex between those of its edges. Where a ball is small beside the rounding
    /// of its place, or the mesh so flat that the cone is narrower than that rounding, `away` may lie outside; the normal is then that of the edge or
    /// face whose region it lies in, if that is no farther than rounding goes. The faces' own normals are good to the last bits, however small the ball.
    pub(crate) fn cone_normal(&self, site: Site, away: &Vector3<f64>) -> Option<Vector3<f64>> {
        match site {
            Site::Face(face) => self.facing(face, away),
            Site::Edge { face, edge } => self.edge_cone_normal(face, edge, away),
            Site::Vertex { vertex, .. } => {
                let mut most = (0.0, None);
                for &face in self.vertex_faces(vertex) {
                    for edge in 0..3u8 {
                        let [a, b] = self.edge_ends(face, edge);
                        let far = if a == vertex { b } else { a };
                        let along =
                            (self.vertices()[far as usize] - self.vertices()[vertex as usize]).try_normalize(0.0);
                        if let Some(along) = along.filter(|_| a == vertex || b == vertex)
                            && along.dot(away) > most.0
                        {
                            most = (along.dot(away), Some((face, edge, along)));
                        }
                    }
                }
                match most.1.filter(|_| most.0 <= self.cone_bound(away)) {
                    None => away.try_normalize(0.0),
                    Some((face, edge, along)) => self.edge_cone_normal(face, edge, &(away - along * along.dot(away))),
                }
            }
        }
    }

    /// The same at an edge, with `away` across it.
    fn edge_cone_normal(&self, face: u32, edge: u8, away: &Vector3<f64>) -> Option<Vector3<f64>> {
        let Site::Edge { face, edge } = self.edge_site(face, edge) else { return None };
        let ends = self.edge_ends(face, edge);
        let [a, b] = ends.map(|v| self.vertices()[v as usize]);
        // Of a small difference of places, rounding has left a part along the edge.
        let along = (b - a).try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let away = &(away - along * along.dot(away));
        let mut most = (0.0, None);
        for other in self.faces_at(Site::Edge { face, edge }) {
            let local = (0..3).find(|&i| self.edge_ends(other, i) == ends);
            let inwards = local.and_then(|i| self.out_of(other, i)).map_or(0.0, |outward| -outward.dot(away));
            if inwards > most.0 {
                most = (inwards, Some(other));
            }
        }
        match most.1.filter(|_| most.0 <= self.cone_bound(away)) {
            None => away.try_normalize(0.0),
            Some(face) => self.facing(face, away),
        }
    }

    /// How far rounding may put a ball outside of the region of what it touches.
    fn cone_bound(&self, away: &Vector3<f64>) -> f64 {
        let (low, high) = (self.bounds().min(), self.bounds().max());
        cone_bound(largest(amax(&low.coords), amax(&high.coords)) + amax(away))
    }

    /// The normal of `face` on the side to which `away` points.
    pub(crate) fn facing(&self, face: u32, away: &Vector3<f64>) -> Option<Vector3<f64>> {
        let n = self.normal(face)?.into_inner();
        Some(if n.dot(away) < 0.0 { -n } else { n })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    /// A roof along y, flat to 2^-20: its slopes fall towards -x and +x.
    fn roof() -> Mesh {
        let low = -(0.5f64.powi(20));
        let vertices =
            [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, low), (1.0, 0.0, low), (-1.0, 1.0, low), (1.0, 1.0, low)];
        let faces = vec![[0, 1, 2], [1, 4, 2], [0, 3, 1], [1, 3, 5]];
        Mesh::new(vertices.map(|(x, y, z)| Point3::new(x, y, z)).to_vec(), faces).unwrap()
    }

    #[test]
    fn a_normal_lies_between_those_of_its_faces_whatever_the_rounding_of_the_place() {
        let m = roof();
        let ridge = m.site(0, crate::closest::Feature::Edge(0));
        let normals = [0, 2].map(|face| m.normal(face).unwrap().into_inner());
        let normals = normals.map(|n| if n.z < 0.0 { -n } else { n });
        let least = 0.5f64.powi(52);
        // Within the cone, as it is; beyond it on either side, the normal of the face there.
        let inside = Vector3::new(0.25 * 0.5f64.powi(20), 0.0, 1.0);
        assert_eq!(m.cone_normal(ridge, &(inside * least)), inside.try_normalize(0.0));
        // What rounding has left along the ridge is none of it.
        let slanted = m.cone_normal(ridge, &((inside + Vector3::y() * 0.25) * least)).unwrap();
        assert!((slanted - inside.normalize()).norm() <= 1e-15, "{slanted}");
        for (x, face) in [(-0.5, 0), (0.5, 1)] {
            let away = Vector3::new(x * 0.5f64.powi(14), 0.0, 1.0) * least;
            assert_eq!(m.cone_normal(ridge, &away), Some(normals[face]), "{x}");
        }
        // From below the fold is hollow, and nearest is a face always.
        let below = m.cone_normal(ridge, &Vector3::new(0.0, 0.0, -least)).unwrap();
        assert!(normals.contains(&-below));
        assert_eq!(m.cone_normal(ridge, &Vector3::zeros()), None);
    }

    #[test]
    fn the_normal_at_the_end_of_a_ridge_keeps_to_the_ridge_and_its_slopes() {
        let m = roof();
        let end = Site::Vertex { vertex: 0, face: 0 };
        let before = Vector3::new(0.0, -0.3, 0.4);
        assert_eq!(m.cone_normal(end, &before), Some(Vector3::new(0.0, -0.6, 0.8)));
        // Beside it by rounding, across the ridge or over a slope; beside it by more than that, as it is.
        let least = 0.5f64.powi(48);
        assert_eq!(m.cone_normal(end, &(Vector3::new(0.0, 0.3, 0.4) * least)), Some(Vector3::z()));
        let slope = m.cone_normal(end, &(Vector3::new(0.3, 0.3, 0.4) * least)).unwrap();
        assert!(slope.z > 0.0 && [1.0, -1.0].map(|side| m.normal(2).unwrap().into_inner() * side).contains(&slope));
        assert_eq!(m.cone_normal(end, &Vector3::new(0.0, 0.3, 0.4)), Some(Vector3::new(0.0, 0.6, 0.8)));
    }

    #[test]
    fn beside_the_cone_of_a_tip_the_normal_is_that_of_the_next_face_or_edge_however_it_is_turned() {
        let rim = [[1.0, 0.25], [0.5, 1.0], [-0.75, 0.75], [-1.0, -0.5], [0.25, -1.0]];
        // With the tip first and last among the coordinates along every axis.
        for axis in 0..3 {
            for side in [1.0, -1.0] {
                let turned = |p: [f64; 3]| Vector3::from([0, 1, 2].map(|i| side * p[(i + axis) % 3]));
                let tip = Vector3::new(3.0, -2.0, 5.0);
                let at = |p: [f64; 3]| Point3::from(tip + turned(p));
                let vertices: Vec<_> = rim.iter().map(|&[x, y]| at([x, y, -0.5])).chain([at([0.0; 3])]).collect();
                let m = Mesh::new(vertices.clone(), (0..5).map(|i| [5, i, (i + 1) % 5]).collect()).unwrap();
                let site = Site::Vertex { vertex: 5, face: 0 };
                let up = turned([0.0, 0.0, 1.0]);
                let (small, beside) = (0.5f64.powi(52), 0.5f64.powi(6));
                let normals: Vec<_> = (0..5).map(|face| m.facing(face, &up).unwrap()).collect();
                for face in 0..5 {
                    let next = (face + 1) % 5;
                    let [left, right] = [face, next].map(|i| (vertices[i] - vertices[5]).normalize());
                    // Over the face between two edges: its own, to the bit.
                    let away = normals[face] + (left + right) * beside;
                    assert_eq!(m.cone_normal(site, &(away * small)), Some(normals[face]), "face {face}, axis {axis}");
                    // Over the edge: what is across it.
                    let across = (normals[face] + normals[next]).normalize();
                    let found = m.cone_normal(site, &((across + right * beside) * small)).unwrap();
                    assert!((found - across).norm() <= 1e-14, "edge {next}, axis {axis}: {found}, not {across}");
                }
                // Within: as it is.
                assert_eq!(m.cone_normal(site, &(up * small)), Some(up));
            }
        }
    }
}
