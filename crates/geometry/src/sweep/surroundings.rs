//! What a ball has seen of a mesh, kept from one search to the next.

use super::Work;
use crate::bounds::Aabb;
use crate::closest::Asked;
use crate::mesh::Mesh;
use crate::rounding::{contact_doubt, position_bound};
use crate::screen::{heights, is_off_plane};
use nalgebra::{Point3, Vector3};
use smallvec::SmallVec;

/// What one ball has seen of one mesh: it changes no answer, only what has to be looked at again.
///
/// The last hops of a ball are short, and all near one place: the faces there are found once. And what a ball touches where its flight ends
/// is among what the search along that flight could not rule out.
#[derive(Debug, Clone, Default)]
pub struct Surroundings {
    /// No coordinate, radius or way that goes into the tolerance of [`touches_at`](Mesh::touches_at) is larger in sum; 0 if it is not going to be asked.
    extent: f64,
    neighbourhood: Option<Neighbourhood>,
    pub(super) left: Left,
    /// Empty between searches: their room is kept.
    pub(super) put_off: PutOff,
}

/// All faces that a ball may touch while its centre is within `reach` of `centre`.
#[derive(Debug, Clone)]
struct Neighbourhood {
    centre: Point3<f64>,
    radius: f64,
    reach: f64,
    /// What counts as touching there.
    margin: f64,
    faces: SmallVec<[u32; 16]>,
}

/// The faces that a search has not ruled out where it ended.
#[derive(Debug, Clone, Default)]
pub(super) struct Left {
    /// The part of the path of which that is true.
    pub from: f64,
    pub to: f64,
    /// All others are farther from the ball there than its radius and this.
    pub within: f64,
    /// Each with the f from which on it is ruled out after all.
    pub faces: SmallVec<[(u32, f64); 8]>,
}

/// Faces that a search puts off.
#[derive(Debug, Clone, Default)]
pub(super) struct PutOff {
    /// Those behind what the ball holds to, all through the piece.
    pub hidden: Vec<u32>,
    /// Those that the ball does not seem to hit inside: looked at again when the one is known that it does hit.
    pub later: Vec<u32>,
}

/// By how much a neighbourhood is larger than what the flight at hand needs: the hops that follow are shorter, but not in the same place.
const AHEAD: f64 = 4.0;

/// A neighbourhood reaches no farther than this share of the larger of the radius and a face's size: in a larger one, the tree finds
/// less to look at.
const LARGEST: f64 = 0.5;

impl Surroundings {
    /// Nothing yet. `extent` is more than the sum of what goes into the tolerance of [`touches_at`](Mesh::touches_at), but for the ways that are
    /// flown: of the largest coordinates, in the unit of the mesh.
    pub fn new(extent: f64) -> Self {
        Self { extent, ..Self::default() }
    }

    /// The distance at which [`left_at`](Self::left_at) has to know what is near, after ways of up to `reach`.
    pub(super) fn within(&self, reach: f64) -> f64 {
        if self.extent > 0.0 {
            contact_doubt(self.extent + 2.0 * reach) + position_bound(self.extent + reach)
        } else {
            0.0
        }
    }

    /// The faces that are left where the ball is at `f`, if those within `distance` of touching it are known.
    pub(super) fn left_at(&self, f: f64, distance: f64) -> Option<impl Iterator<Item = u32>> {
        let Left { from, to, within, faces } = &self.left;
        let is_known = *from <= f && f <= *to && distance <= *within;
        is_known.then(|| faces.iter().filter(move |(_, off_from)| *off_from > f).map(|(face, _)| *face))
    }

    /// All faces that a ball of `radius` may touch, to within `margin`, on a way of `length` from `start`, and some more; none if that is so long
    /// that they are better searched for.
    pub(super) fn faces(
        &mut self,
        mesh: &Mesh,
        start: &Point3<f64>,
        radius: f64,
        length: f64,
        margin: f64,
        work: &mut Work,
    ) -> Option<&[u32]> {
        let reaches = |n: &Neighbourhood| {
            n.radius == radius && (start - n.centre).norm() + length <= n.reach && margin <= n.margin
        };
        if !self.neighbourhood.as_ref().is_some_and(reaches) {
            let reach = AHEAD * length;
            if reach.is_nan() || reach > LARGEST * radius.max(mesh.face_size()) {
                return None;
            }
            let margin = 2.0 * margin;
            let faces = mesh.faces_within(start, radius + reach + margin, work);
            self.neighbourhood = Some(Neighbourhood { centre: *start, radius, reach, margin, faces });
        }
        self.neighbourhood.as_ref().map(|n| n.faces.as_slice())
    }
}

impl Mesh {
    /// The faces within `distance` of `centre`, but for rounding.
    fn faces_within(&self, centre: &Point3<f64>, distance: f64, work: &mut Work) -> SmallVec<[u32; 16]> {
        let mut faces = SmallVec::new();
        let around = Aabb::of_points(&[*centre]).inflate(distance + position_bound(centre.coords.amax() + distance));
        work.nodes += self.bvh().visit_box(&around, |face| {
            work.triangles += 1;
            let corners = self.triangle_from(face, centre);
            if !is_off_plane(&heights(&corners, self.plain_normal(face)), distance)
                && Asked::new(corners).closest(&Vector3::zeros()).offset.norm() <= distance
            {
                faces.push(face);
            }
        });
        faces
    }
}
