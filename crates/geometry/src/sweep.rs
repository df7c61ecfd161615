//! A moving ball against a mesh: the first contact, and what is touched there.

use crate::bounds::{Aabb, amax, largest, least};
use crate::bvh::FatSegment;
use crate::closest::{Asked, Feature};
use crate::contact::{Contact, MovingBall, contact_from};
use crate::mesh::{Fold, Mesh};
use crate::rounding::{contact_doubt, position_bound, screen_bound};
use crate::screen::{Stretch, is_off_plane};
use crate::site::Site;
use nalgebra::{Point3, Vector3};
use smallvec::SmallVec;
use std::cmp::Ordering;

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

/// A little later than 1: where a path is back where it was, with room for rounding and for a surface that falls away.
const JUST_AFTER: f64 = 1.0 + 1.0 / 64.0;

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
        let size = self.farthest_from(&start).max(ball.radius);
        let sagitta_limit = SAGITTA_SHARE * ball.radius.max(self.face_size());
        let doubt = screen_bound(size + ball.path.reach(to));
        // Front to back: the stretch to look at next is the last of the stack. What the ball leaves it often comes back to: a first cut
        // just after that.
        let mut best = self.where_it_left(ball, to, &free_until, work);
        let last = best.map_or(to, |found| found.f);
        let mut stack = [(0.0, last); 64];
        let mut depth = 1;
        let back = ball.holds.iter().map(|hold| hold.until).fold(f64::INFINITY, least) * JUST_AFTER;
        if back > 0.0 && back < last {
            stack[0].0 = back;
            stack[1] = (0.0, back);
            depth = 2;
        }
        while depth > 0 {
            depth -= 1;
            let (from, end) = stack[depth];
            let chord = ball.path.chord(from, end);
            let (a, b) = (start + chord.from, start + chord.to);
            // What a contact in doubt may be off by counts as near, so that the boxes leave out no face that would report one.
            let reach = ball.path.reach(end);
            let margin =
                position_bound(largest(largest(amax(&a.coords), amax(&b.coords)), reach)) + contact_doubt(size + reach);
            let radius = ball.radius + chord.sagitta + margin;
            // The margin has room for the rounding of this as well.
            if self.bounds().is_off(&a, &b, radius) {
                continue;
            }
            let middle = 0.5 * (from + end);
            if chord.sagitta > sagitta_limit && depth + 2 <= stack.len() && middle > from && middle < end {
                stack[depth] = (middle, end);
                stack[depth + 1] = (from, middle);
                depth += 2;
                continue;
            }
            let mut limit = end;
            let mut stretch = Stretch::new(ball.path, from, limit, ball.radius + doubt);
            work.nodes += self.bvh().visit(&FatSegment { from: a, to: b, radius }, |face| {
                if best.is_some_and(|found| found.face == face) {
                    return (limit - from) / (end - from);
                }
                work.triangles += 1;
                let triangle = self.triangle(face);
                // Asked from the start of the path, not of the piece: the answer does not depend on the pieces.
                let free = ball.held_off(&triangle, free_until(face));
                if free > limit
                    || self.plain_normal(face).is_some_and(|n| stretch.is_free_of(&stretch.local(&triangle), n))
                {
                    return (limit - from) / (end - from);
                }
                let asked = ball.asked(&triangle);
                work.rounds += u64::from(limit < end);
                if !(limit < end && ball.stays_off(&asked, free, limit, ball.radius + doubt))
                    && let Contact::At { f, .. } = contact_from(ball, &asked, free, limit, &mut work.rounds)
                    && best.is_none_or(|found| (f.min(to), face) < (found.f, found.face))
                {
                    best = Some(FirstContact { f: f.min(to), face });
                    if f < limit {
                        limit = f;
                        stretch = Stretch::new(ball.path, from, limit, ball.radius + doubt);
                    }
                }
                (limit - from) / (end - from)
            });
            if best.is_some_and(|found| found.f <= end) {
                break;
            }
        }
        best
    }

    /// The first contact with a face that the ball leaves by a short hop: most such hops end there.
    fn where_it_left(
        &self,
        ball: &MovingBall,
        to: f64,
        free_until: &impl Fn(u32) -> f64,
        work: &mut Work,
    ) -> Option<FirstContact> {
        let hold = ball.holds.iter().min_by(|a, b| a.until.total_cmp(&b.until))?;
        let face = hold.face?;
        if !(hold.until > 0.0 && hold.until <= to && ball.path.reach(hold.until) <= self.face_size()) {
            return None;
        }
        work.triangles += 1;
        let triangle = self.triangle(face);
        let free = ball.held_off(&triangle, free_until(face));
        match contact_from(ball, &ball.asked(&triangle), free, to, &mut work.rounds) {
            Contact::At { f, .. } => Some(FirstContact { f: f.min(to), face }),
            Contact::Miss => None,
        }
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
    ) -> SmallVec<[Touch; 4]> {
        let ahead = Point3::from(heading.try_normalize(0.0).unwrap_or_else(Vector3::zeros) * tolerance);
        let reach = radius + tolerance;
        let mut found: SmallVec<[(Site, Vector3<f64>); 8]> = SmallVec::new();
        let doubt = screen_bound(self.farthest_from(centre).max(reach));
        let around = Aabb::of_points(&[*centre]).inflate(reach + position_bound(centre.coords.amax() + reach));
        work.nodes += self.bvh().visit_box(&around, |face| {
            work.triangles += 1;
            let local = self.triangle(face).map(|v| v - centre);
            if self.plain_normal(face).is_some_and(|n| is_off_plane(&local, n, reach + doubt)) {
                return;
            }
            let asked = Asked::new(&local.map(Point3::from));
            let closest = asked.closest(&Point3::origin());
            if closest.offset.norm() <= reach {
                let site = match closest.feature {
                    // Rounding found the edge: in a fold that rises towards the ball, it is the face that is touched.
                    Feature::Edge(edge) if self.rises(face, edge, &closest.offset, radius - tolerance) => {
                        Site::Face(face)
                    }
                    Feature::Face => Site::Face(face),
                    // Face before edge before vertex.
                    feature => self.site(face, feature.min(asked.closest(&ahead).feature)),
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

    /// How far along an axis the mesh reaches from `x`.
    fn farthest_from(&self, x: &Point3<f64>) -> f64 {
        (self.bounds().min() - x).amax().max((self.bounds().max() - x).amax())
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

    /// The normal at a touched site: the face's own on a face and on a flat edge, else from the touched point to the centre.
    fn normal_at(&self, site: Site, away: &Vector3<f64>) -> Option<Vector3<f64>> {
        match site {
            Site::Edge { face, edge } if self.fold(face, edge.into()) == Fold::Flat => self.facing(face, away),
            _ => self.cone_normal(site, away).or_else(|| self.facing(site.face(), away)),
        }
    }

    /// About the length of a side of a face, from the size of the mesh and the number of faces.
    fn face_size(&self) -> f64 {
        self.bounds().extent().amax() / (self.faces().len() as f64).sqrt()
    }
}

#[cfg(test)]
mod tests;
