//! The directions in which a place of a mesh can touch a ball: its normal cone.

use super::Site;
use crate::mesh::Mesh;
use nalgebra::Vector3;

impl Mesh {
    /// The unit normal of a ball that `site` touches, whose centre is `away` from there: the direction of `away`, but in the cone of those in which
    /// `site` is what of the mesh is nearest. None if `away` is zero.
    ///
    /// At an edge the cone lies between the normals of its faces, at a vertex between those of its edges. Where a ball is small beside the rounding
    /// of its place, or the mesh so flat that the cone is narrower than that rounding, `away` may lie outside; the normal is then that of the edge or
    /// face whose region it lies in. The faces' own normals are good to the last bits, however small the ball.
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
                match most.1 {
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
        match most.1 {
            None => away.try_normalize(0.0),
            Some(face) => self.facing(face, away),
        }
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
        // Beside the ridge: across it.
        assert_eq!(m.cone_normal(end, &Vector3::new(0.0, 0.3, 0.4)), Some(Vector3::z()));
        let slope = m.cone_normal(end, &Vector3::new(0.3, 0.3, 0.4)).unwrap();
        assert_eq!(slope.z.signum(), 1.0);
        assert!(slope == m.normal(2).unwrap().into_inner() || slope == -m.normal(2).unwrap().into_inner());
    }
}
