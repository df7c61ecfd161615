//! A moving ball against a mesh: the first contact, what is touched there, and how far each face, edge and vertex carries.

mod bend;

use crate::bounds::Aabb;
use crate::bvh::FatSegment;
use crate::closest::{Feature, closest_point};
use crate::contact::{Contact, MovingBall, contact_from};
use crate::mesh::{Fold, Mesh};
use crate::rounding::{contact_doubt, position_bound};
pub use bend::Bend;
use nalgebra::{Point3, Vector3};
use std::cmp::Ordering;

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

/// The first contact of a ball with a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstContact {
    /// Where on the path; never late.
    pub f: f64,
    /// The face; the lowest-numbered of those met at the same f.
    pub face: u32,
}

/// What a ball touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// The place of the mesh.
    pub site: Site,
    /// Unit normal from the mesh to the centre of the ball.
    pub normal: Vector3<f64>,
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

/// What a query looked at.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Nodes of the tree.
    pub nodes: u64,
    /// Triangles that the tree let through.
    pub triangles: u64,
    /// Support planes tried on them.
    pub rounds: u64,
}

/// A path is cut no finer than into pieces whose sagitta is this share of the larger of the radius and a face's size.
const SAGITTA_SHARE: f64 = 0.25;

impl Mesh {
    /// The first f in [0, `to`] at which `ball` touches the mesh, closing in: never late, never missed, and the same bits as if every
    /// face had been asked. `free_until(face)` is an f before which the ball is known not to touch that face.
    pub fn first_contact(
        &self,
        ball: &MovingBall,
        to: f64,
        free_until: impl Fn(u32) -> f64,
        work: &mut Work,
    ) -> Option<FirstContact> {
        let start = ball.path.start();
        let corners = [self.bounds().min(), self.bounds().max()];
        let size = corners.map(|corner| (corner - start).amax()).into_iter().fold(ball.radius, f64::max);
        let sagitta_limit = SAGITTA_SHARE * ball.radius.max(self.face_size());
        let mut best: Option<FirstContact> = None;
        // Front to back: the stretch to look at next is the last of the stack.
        let mut stack = [(0.0, to); 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (from, end) = stack[depth];
            let chord = ball.path.chord(from, end);
            let (a, b) = (start + chord.from, start + chord.to);
            // What a contact in doubt may be off by counts as near, so that the boxes leave out no face that would report one.
            let reach = ball.path.reach(end);
            let margin = position_bound(a.coords.amax().max(b.coords.amax()).max(reach)) + contact_doubt(size + reach);
            let radius = ball.radius + chord.sagitta + margin;
            if !Aabb::of_points(&[a, b]).inflate(radius).intersects(self.bounds()) {
                continue;
            }
            let middle = 0.5 * (from + end);
            if chord.sagitta > sagitta_limit && depth + 2 <= stack.len() && middle > from && middle < end {
                stack[depth] = (middle, end);
                stack[depth + 1] = (from, middle);
                depth += 2;
                continue;
            }
            work.nodes += self.bvh().visit(&FatSegment { from: a, to: b, radius }, |face| {
                // Asked from the start of the path, not of the piece: the answer does not depend on the pieces.
                let limit = best.map_or(to, |found| found.f);
                let free = free_until(face);
                if free <= limit {
                    work.triangles += 1;
                    let contact = contact_from(ball, &self.triangle(face), free, limit, &mut work.rounds);
                    if let Contact::At { f, .. } = contact
                        && best.is_none_or(|found| (f.min(to), face) < (found.f, found.face))
                    {
                        best = Some(FirstContact { f: f.min(to), face });
                    }
                }
                best.map_or(f64::INFINITY, |found| (found.f - from) / (end - from))
            });
            if best.is_some_and(|found| found.f <= end) {
                break;
            }
        }
        best
    }

    /// What a ball of `radius` at `centre`, moving along `heading`, touches, to within `tolerance`, in the order of the sites.
    ///
    /// Where rounding decides between a face and its border, it is what the ball moves to.
    /// An edge counts only where none of its faces is touched itself, and a vertex only where none of its edges and faces is: so
    /// the inner edges of a flat or hollow surface do not show.
    pub fn touches(
        &self,
        centre: &Point3<f64>,
        heading: &Vector3<f64>,
        radius: f64,
        tolerance: f64,
        work: &mut Work,
    ) -> Vec<Touch> {
        let ahead = Point3::from(heading.try_normalize(0.0).unwrap_or_else(Vector3::zeros) * tolerance);
        let reach = radius + tolerance;
        let mut found: Vec<(Site, Vector3<f64>)> = Vec::new();
        let around = Aabb::of_points(&[*centre]).inflate(reach + position_bound(centre.coords.amax() + reach));
        work.nodes += self.bvh().visit_box(&around, |face| {
            work.triangles += 1;
            let local = self.triangle(face).map(|v| Point3::from(v - centre));
            let closest = closest_point(&local, &Point3::origin());
            if closest.offset.norm() <= reach {
                let site = match closest.feature {
                    // Rounding found the edge: in a fold that rises towards the ball, it is the face that is touched.
                    Feature::Edge(edge) if self.rises(face, edge, &closest.offset, radius - tolerance) => {
                        Site::Face(face)
                    }
                    Feature::Face => Site::Face(face),
                    // Face before edge before vertex.
                    feature => self.site(face, feature.min(closest_point(&local, &ahead).feature)),
                };
                found.push((site, closest.offset));
            }
        });
        // Of the offsets to an edge or a vertex from its faces, which differ by rounding, the same one in whatever order they come.
        let order = |a: &Vector3<f64>, b: &Vector3<f64>| {
            a.iter().zip(b.iter()).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
        };
        found.sort_by(|(a, u), (b, v)| a.cmp(b).then_with(|| order(u, v)));
        found.dedup_by_key(|(site, _)| *site);
        let hidden = |site: &Site| found.iter().any(|(other, _)| self.hides(other, site));
        found
            .iter()
            .filter(|(site, _)| !hidden(site))
            .filter_map(|&(site, away)| self.normal_at(site, &away).map(|normal| Touch { site, normal }))
            .collect()
    }

    /// Whether the fold at `edge` of `face` is hollow on the side that `away` points to, and `away` at least `height` above the face.
    fn rises(&self, face: u32, edge: u8, away: &Vector3<f64>, height: f64) -> bool {
        let fold = self.fold(face, edge.into());
        let Some(above) = self.normal(face).map(|n| n.dot(away)) else { return false };
        above.abs() >= height && (if above > 0.0 { fold } else { fold.from_back() }) == Fold::Concave
    }

    /// The one name of what is touched at a feature of `face`.
    fn site(&self, face: u32, feature: Feature) -> Site {
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

    /// The ends of an edge, the one with the lower coordinates first: the same bits from whichever face it is seen, and however that is
    /// wound.
    fn edge_ends(&self, face: u32, edge: u8) -> [u32; 2] {
        let corners = self.faces()[face as usize];
        let [a, b] = [corners[edge as usize], corners[(edge as usize + 1) % 3]];
        let at = |v: u32| self.vertices()[v as usize];
        if at(a).coords.as_slice() <= at(b).coords.as_slice() { [a, b] } else { [b, a] }
    }

    /// Whether `site` is a part of the border of `other`, which is touched itself.
    fn hides(&self, other: &Site, site: &Site) -> bool {
        match (*other, *site) {
            (Site::Face(f), Site::Edge { face, edge }) => {
                let [a, b] = self.edge_ends(face, edge);
                let corners = self.faces()[f as usize];
                corners.contains(&a) && corners.contains(&b)
            }
            (Site::Face(f), Site::Vertex { vertex, .. }) => self.faces()[f as usize].contains(&vertex),
            (Site::Edge { face, edge }, Site::Vertex { vertex, .. }) => self.edge_ends(face, edge).contains(&vertex),
            _ => false,
        }
    }

    /// The normal at a touched site: the face's own on a face and on a flat edge, else from the touched point to the centre.
    fn normal_at(&self, site: Site, away: &Vector3<f64>) -> Option<Vector3<f64>> {
        let facing = |face: u32| {
            let n = self.normal(face)?.into_inner();
            Some(if n.dot(away) < 0.0 { -n } else { n })
        };
        match site {
            Site::Face(face) => facing(face),
            Site::Edge { face, edge } if self.fold(face, edge.into()) == Fold::Flat => facing(face),
            _ => away.try_normalize(0.0).or_else(|| facing(site.face())),
        }
    }

    /// The bounds of the region in which `site` is what of the mesh is nearest to a ball beside it.
    pub fn region(&self, site: Site) -> Vec<RegionBound> {
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
                let mut bounds = Vec::new();
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
                let mut bounds: Vec<RegionBound> = Vec::new();
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

    /// The faces that `site` is, or that meet in it.
    pub fn faces_at(&self, site: Site) -> Vec<u32> {
        match site {
            Site::Face(face) => vec![face],
            Site::Edge { face, edge } => std::iter::once(face).chain(self.neighbours(face, edge.into())).collect(),
            Site::Vertex { vertex, .. } => self.vertex_faces(vertex).to_vec(),
        }
    }

    /// About the length of a side of a face, from the size of the mesh and the number of faces.
    fn face_size(&self) -> f64 {
        self.bounds().extent().amax() / (self.faces().len() as f64).sqrt()
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

    /// A point of `site`.
    pub fn anchor(&self, site: Site) -> Point3<f64> {
        match site {
            Site::Face(face) => self.triangle(face)[0],
            Site::Edge { face, edge } => self.triangle(face)[edge as usize],
            Site::Vertex { vertex, .. } => self.vertices()[vertex as usize],
        }
    }

    /// Where `site` is nearest to `centre`, taken as an infinite plane or line, and the unit normal from there to `centre`.
    /// None where the centre lies on it.
    pub fn foot(&self, site: Site, centre: &Point3<f64>) -> Option<(Point3<f64>, Vector3<f64>)> {
        let Some(away) = self.bend(site).away_from(centre) else {
            let face = site.face();
            // From the lowest of its vertices: the same bits with whichever of them the face begins.
            let [a, b, c] = self.faces()[face as usize];
            let (n, point) = (self.normal(face)?.into_inner(), self.vertices()[a.min(b).min(c) as usize]);
            let height = n.dot(&(centre - point));
            return Some((centre - n * height, if height < 0.0 { -n } else { n }));
        };
        away.try_normalize(0.0).map(|n| (centre - away, n))
    }
}
