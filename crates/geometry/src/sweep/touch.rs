//! What a ball touches where it is: faces, and the edges and vertices that no touched face hides.

use super::{Surroundings, Work};
use crate::bounds::{Aabb, amax, largest};
use crate::closest::{Asked, Feature};
use crate::mesh::{Fold, Mesh};
use crate::order::by_size;
use crate::rounding::{hold_bound, position_bound, screen_bound};
use crate::screen::{heights, is_off_plane, is_over};
use crate::site::Site;
use nalgebra::{Point3, Vector3};
use smallvec::SmallVec;

/// What a ball touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// The place of the mesh.
    pub site: Site,
    /// Unit normal from the mesh to the centre of the ball.
    pub normal: Vector3<f64>,
}

/// The nearest places of the faces asked so far, as far as the ball touches them.
struct Touching<'a> {
    mesh: &'a Mesh,
    centre: &'a Point3<f64>,
    heading: &'a Vector3<f64>,
    radius: f64,
    tolerance: f64,
    doubt: f64,
    found: SmallVec<[(Site, Vector3<f64>); 4]>,
}

impl Mesh {
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
    ) -> SmallVec<[Touch; 4]> {
        let mut touching = Touching::new(self, centre, heading, radius, tolerance);
        let reach = radius + tolerance;
        let around = Aabb::of_points(&[*centre]).inflate(reach + position_bound(centre.coords.amax() + reach));
        work.nodes += self.bvh().visit_box(&around, |face| {
            work.triangles += 1;
            touching.ask(face);
        });
        touching.conclude()
    }

    /// [`touches`](Self::touches) of the ball of the last [`first_contact_around`](Self::first_contact_around), where it is at `f` of its path:
    /// the same, from what that search has seen, if that is enough.
    #[expect(clippy::too_many_arguments, reason = "those of `touches`, and where it is known from")]
    pub fn touches_at(
        &self,
        f: f64,
        around: &Surroundings,
        centre: &Point3<f64>,
        heading: &Vector3<f64>,
        radius: f64,
        tolerance: f64,
        work: &mut Work,
    ) -> SmallVec<[Touch; 4]> {
        let Some(faces) = around.left_at(f, tolerance + position_bound(amax(&centre.coords))) else {
            return self.touches(centre, heading, radius, tolerance, work);
        };
        let mut touching = Touching::new(self, centre, heading, radius, tolerance);
        for face in faces {
            work.triangles += 1;
            touching.ask(face);
        }
        touching.conclude()
    }

    /// What of `face` is nearest to `centre`, whatever else is, and the direction from there: what a search that reports the face has seen.
    /// None where the centre lies on it.
    pub fn nearest_of(&self, face: u32, centre: &Point3<f64>) -> Option<Touch> {
        let closest = Asked::new(self.triangle_from(face, centre)).closest(&Vector3::zeros());
        let site = self.site(face, closest.feature);
        let normal = match site {
            Site::Face(face) => self.facing(face, &closest.offset),
            _ => closest.offset.try_normalize(0.0),
        };
        normal.map(|normal| Touch { site, normal })
    }

    /// Whether the fold at `edge` of `face` is hollow on the side that `away` points to, and `away` at least `height` above the face.
    fn rises(&self, face: u32, edge: u8, away: &Vector3<f64>, height: f64) -> bool {
        let fold = self.fold(face, edge.into());
        let Some(above) = self.normal(face).map(|n| n.dot(away)) else { return false };
        above.abs() >= height && (if above > 0.0 { fold } else { fold.from_back() }) == Fold::Concave
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

    /// The normal at a touched site: the face's own on a face and on a flat edge, else from the touched point to the centre, within the cone of what
    /// is nearest there.
    fn normal_at(&self, site: Site, away: &Vector3<f64>) -> Option<Vector3<f64>> {
        match site {
            Site::Edge { face, edge } if self.fold(face, edge.into()) == Fold::Flat => self.facing(face, away),
            _ => self.cone_normal(site, away).or_else(|| self.facing(site.face(), away)),
        }
    }
}

impl<'a> Touching<'a> {
    fn new(mesh: &'a Mesh, centre: &'a Point3<f64>, heading: &'a Vector3<f64>, radius: f64, tolerance: f64) -> Self {
        let doubt = screen_bound(mesh.farthest_from(centre).max(radius + tolerance));
        Self { mesh, centre, heading, radius, tolerance, doubt, found: SmallVec::new() }
    }

    /// Notes what of `face` is touched, if anything is.
    fn ask(&mut self, face: u32) {
        let (mesh, reach) = (self.mesh, self.radius + self.tolerance);
        let corners = mesh.triangle_from(face, self.centre);
        let normal = mesh.plain_normal(face);
        let heights = heights(&corners, normal);
        if is_off_plane(&heights, reach + self.doubt) {
            return;
        }
        // Where the normal is the face's own, and not shared or declared, and rounding does not decide.
        let [height, b, c] = heights;
        let bound = hold_bound(largest(largest(amax(&corners[0]), amax(&corners[1])), amax(&corners[2])));
        if largest((b - height).abs(), (c - height).abs()) <= bound
            && height.abs() + 2.0 * bound <= reach
            && is_over(&corners, normal)
        {
            self.found.push((Site::Face(face), normal * -height));
            return;
        }
        let asked = Asked::new(corners);
        let closest = asked.closest(&Vector3::zeros());
        if closest.offset.norm() > reach {
            return;
        }
        let site = match closest.feature {
            // Rounding found the edge: in a fold that rises towards the ball, it is the face that is touched.
            Feature::Edge(edge) if mesh.rises(face, edge, &closest.offset, self.radius - self.tolerance) => {
                Site::Face(face)
            }
            Feature::Face => Site::Face(face),
            // Face before edge before vertex.
            feature => {
                let ahead = self.heading.try_normalize(0.0).unwrap_or_else(Vector3::zeros) * self.tolerance;
                mesh.site(face, feature.min(asked.closest(&ahead).feature))
            }
        };
        self.found.push((site, closest.offset));
    }

    /// What is touched, in the order of the sites.
    fn conclude(self) -> SmallVec<[Touch; 4]> {
        let Self { mesh, mut found, .. } = self;
        if found.len() > 1 {
            // Of the offsets to an edge or a vertex from its faces, which differ by rounding, the same one in whatever order they come.
            found.sort_by(|(a, u), (b, v)| a.cmp(b).then_with(|| by_size(u, v)));
            found.dedup_by_key(|(site, _)| *site);
        }
        let touch = |&(site, away): &(Site, _)| mesh.normal_at(site, &away).map(|normal| Touch { site, normal });
        if let [alone] = found.as_slice() {
            return touch(alone).into_iter().collect();
        }
        let hidden = |site: &Site| found.iter().any(|(other, _)| mesh.hides(other, site));
        found.iter().filter(|(site, _)| !hidden(site)).filter_map(touch).collect()
    }
}
