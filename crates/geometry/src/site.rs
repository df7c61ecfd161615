//! The places of a mesh, its faces, edges and vertices, and how far each carries a ball.

mod cone;

use crate::closest::Feature;
use crate::mesh::{Fold, Mesh};
use crate::order::by_size;
use nalgebra::{Point3, Vector3};
use smallvec::{SmallVec, smallvec};

/// A place of a mesh: a face, an edge or a vertex. Each edge and vertex has one name, whichever face it was found by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Site {
    /// A face, by its number.
    Face(u32),
    /// Edge `edge` (from corner `edge` to the next) of the lowest-numbered face that has it.
    Edge {
        /// The face.
        face: u32,
        /// 0, 1 or 2.
        edge: u8,
    },
    /// A vertex, by its number, and the lowest-numbered face at it.
    Vertex {
        /// The vertex.
        vertex: u32,
        /// The face.
        face: u32,
    },
}

impl Site {
    /// The face, or for an edge or a vertex the lowest-numbered face that has it.
    pub fn face(&self) -> u32 {
        match *self {
            Site::Face(face) | Site::Edge { face, .. } | Site::Vertex { face, .. } => face,
        }
    }
}

/// A bound of the region that belongs to a place: where the ball crosses it, another place carries on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegionBound {
    /// Unit normal out of the region.
    pub outward: Vector3<f64>,
    /// A point of the bounding plane.
    pub point: Point3<f64>,
    /// The place on the other side.
    pub next: Site,
}

impl Mesh {
    /// The one name of what is touched at a feature of `face`.
    pub(crate) fn site(&self, face: u32, feature: Feature) -> Site {
        match feature {
            Feature::Edge(edge) if self.fold(face, edge.into()) != Fold::Flat => self.edge_site(face, edge),
            Feature::Vertex(corner) if !self.is_level(self.faces()[face as usize][corner as usize]) => {
                self.vertex_site(self.faces()[face as usize][corner as usize])
            }
            // A border inside a plane is none.
            Feature::Face | Feature::Edge(_) | Feature::Vertex(_) => Site::Face(face),
        }
    }

    fn edge_site(&self, face: u32, edge: u8) -> Site {
        let (face, side) = self.edge(face, edge.into()).owner;
        Site::Edge { face, edge: side as u8 }
    }

    fn vertex_site(&self, vertex: u32) -> Site {
        Site::Vertex { vertex, face: self.vertex_faces(vertex).first().copied().unwrap_or(0) }
    }

    /// The ends of an edge, in the order of [`by_size`]: the same bits from whichever face it is seen, and however that is wound.
    pub(crate) fn edge_ends(&self, face: u32, edge: u8) -> [u32; 2] {
        let corners = self.faces()[face as usize];
        let [a, b] = [corners[edge as usize], corners[(edge as usize + 1) % 3]];
        let at = |v: u32| self.vertices()[v as usize];
        if by_size(&at(a).coords, &at(b).coords).is_le() { [a, b] } else { [b, a] }
    }

    /// The faces that `site` is, or that meet in it.
    pub fn faces_at(&self, site: Site) -> SmallVec<[u32; 8]> {
        match site {
            Site::Face(face) => smallvec![face],
            Site::Edge { face, edge } => std::iter::once(face).chain(self.neighbours(face, edge.into())).collect(),
            Site::Vertex { vertex, .. } => self.vertex_faces(vertex).into(),
        }
    }

    /// Whether `face` is one of [`faces_at`](Self::faces_at) `site`.
    pub fn is_at(&self, face: u32, site: Site) -> bool {
        match site {
            Site::Face(own) => face == own,
            Site::Edge { face: own, edge } => {
                face == own || self.neighbours(own, edge.into()).any(|other| other == face)
            }
            Site::Vertex { vertex, .. } => self.faces()[face as usize].contains(&vertex),
        }
    }

    /// The bounds of the region in which `site` is what of the mesh is nearest to a ball beside it.
    pub fn region(&self, site: Site) -> SmallVec<[RegionBound; 8]> {
        let vertex = |v: u32| self.vertices()[v as usize];
        match site {
            Site::Face(face) => (0..3u8)
                .filter_map(|edge| {
                    let outward = self.out_of(face, edge)?;
                    let flat = self.fold(face, edge.into()) == Fold::Flat;
                    let next = match self.neighbours(face, edge.into()).next() {
                        Some(other) if flat => Site::Face(other),
                        _ => self.edge_site(face, edge),
                    };
                    Some(RegionBound { outward, point: vertex(self.edge_ends(face, edge)[0]), next })
                })
                .collect(),
            Site::Edge { face, edge } => {
                let [a, b] = self.edge_ends(face, edge);
                let mut bounds = SmallVec::new();
                if let Some(along) = (vertex(b) - vertex(a)).try_normalize(0.0) {
                    bounds.push(RegionBound { outward: -along, point: vertex(a), next: self.vertex_site(a) });
                    bounds.push(RegionBound { outward: along, point: vertex(b), next: self.vertex_site(b) });
                }
                for other in self.faces_at(site) {
                    let local = (0..3).find(|&i| self.edge_ends(other, i) == [a, b]);
                    if let Some(outward) = local.and_then(|i| self.out_of(other, i)) {
                        bounds.push(RegionBound { outward: -outward, point: vertex(a), next: Site::Face(other) });
                    }
                }
                bounds
            }
            Site::Vertex { vertex: v, .. } => {
                let mut bounds: SmallVec<[RegionBound; 8]> = SmallVec::new();
                for &face in self.vertex_faces(v) {
                    for edge in 0..3u8 {
                        let [a, b] = self.edge_ends(face, edge);
                        let far = if a == v { b } else { a };
                        let next = self.edge_site(face, edge);
                        if (a == v || b == v)
                            && bounds.iter().all(|bound| bound.next != next)
                            && let Some(outward) = (vertex(far) - vertex(v)).try_normalize(0.0)
                        {
                            bounds.push(RegionBound { outward, point: vertex(v), next });
                        }
                    }
                }

                bounds
            }
        }
    }

    /// The unit vector in the plane of `face` that leads out of it across `edge`.
    fn out_of(&self, face: u32, edge: u8) -> Option<Vector3<f64>> {
        let [a, b] = self.edge_ends(face, edge).map(|v| self.vertices()[v as usize]);
        let opposite = self.triangle(face)[(edge as usize + 2) % 3];
        let normal = self.normal(face)?.into_inner();
        let outward = (b - a).cross(&normal).try_normalize(0.0)?;
        // The normal of a face declared planar need not go with its winding.
        Some(if outward.dot(&(opposite - a)) > 0.0 { -outward } else { outward })
    }

    /// How `site` curves: the directions in which the surface a ball rolls over it on is straight. A face is flat, across an edge and
    /// around a vertex the centre moves on a circle of the ball's radius.
    pub fn bend(&self, site: Site) -> Bend {
        match site {
            Site::Face(_) => Bend::Flat,
            Site::Edge { face, edge } if self.fold(face, edge.into()) == Fold::Flat => Bend::Flat,
            Site::Edge { face, edge } => {
                let [a, b] = self.edge_ends(face, edge).map(|v| self.vertices()[v as usize]);
                match (b - a).try_normalize(0.0) {
                    Some(along) => Bend::Around { point: a, along },
                    None => Bend::About { point: a },
                }
            }
            Site::Vertex { vertex, .. } => Bend::About { point: self.vertices()[vertex as usize] },
        }
    }

    /// A point of `site`: the same with whichever vertex a face begins, and whichever face an edge is named by.
    pub fn anchor(&self, site: Site) -> Point3<f64> {
        match site {
            Site::Face(face) => self.vertices()[self.lowest_vertex(face) as usize],
            Site::Edge { face, edge } => self.vertices()[self.edge_ends(face, edge)[0] as usize],
            Site::Vertex { vertex, .. } => self.vertices()[vertex as usize],
        }
    }

    fn lowest_vertex(&self, face: u32) -> u32 {
        let [a, b, c] = self.faces()[face as usize];
        a.min(b).min(c)
    }

    /// Where `site` is nearest to `centre`, taken as an infinite plane or line, and the unit normal from there to `centre`.
    /// None where the centre lies on it. At an edge or vertex the normal is in the cone of those that a ball nearest to it can have.
    pub fn foot(&self, site: Site, centre: &Point3<f64>) -> Option<(Point3<f64>, Vector3<f64>)> {
        let Some(away) = self.bend(site).away_from(centre) else {
            let face = site.face();
            let (n, point) = (self.normal(face)?.into_inner(), self.anchor(site));
            let height = n.dot(&(centre - point));
            return Some((centre - n * height, if height < 0.0 { -n } else { n }));
        };
        self.cone_normal(site, &away).map(|n| (centre - away, n))
    }
}

/// The shape that the centre of a ball follows while it moves on a place of a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bend {
    /// A plane.
    Flat,
    /// A cylinder around an edge.
    Around {
        /// A point of the edge.
        point: Point3<f64>,
        /// The unit direction of the edge.
        along: Vector3<f64>,
    },
    /// A sphere about a vertex.
    About {
        /// The vertex.
        point: Point3<f64>,
    },
}

impl Bend {
    /// From the edge or vertex to `centre`, at right angles to the edge; none on a plane.
    pub fn away_from(&self, centre: &Point3<f64>) -> Option<Vector3<f64>> {
        match self {
            Bend::Flat => None,
            // Of the small difference of two places, rounding has left a part along the edge: for a small ball, as much as it moves across.
            Bend::Around { point, .. } => Some(self.across(&self.across(&(centre - point)))),
            Bend::About { point } => Some(centre - point),
        }
    }

    /// The part of `v` that follows the curve: across an edge, all of it about a vertex, none on a plane.
    pub fn across(&self, v: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Bend::Flat => Vector3::zeros(),
            Bend::Around { along, .. } => v - along * along.dot(v),
            Bend::About { .. } => *v,
        }
    }
}

#[cfg(test)]
mod tests;
