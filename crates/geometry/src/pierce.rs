//! A segment against a mesh: the first face it meets, decided exactly.

use crate::bvh::FatSegment;
use crate::closest::Feature;
use crate::mesh::Mesh;
use crate::rounding::SEGMENT_FRACTION_BOUND;
use crate::segment::{SegmentHit, Sheared};
use crate::sweep::Work;
use nalgebra::Point3;

/// The first face of a mesh that a segment meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pierced {
    /// Where on the segment, from 0 to 1: never above the exact place, and below it by [`SEGMENT_FRACTION_BOUND`] at most.
    pub f: f64,
    /// The face; of several whose f is the same, the lowest-numbered.
    pub face: u32,
    /// What of the face is met.
    pub feature: Feature,
}

impl Mesh {
    /// The first face that the closed segment from `from` to `to` meets; whether there is one is decided exactly, so that no segment
    /// passes between faces that share an edge or a vertex. The points are finite.
    pub fn first_pierced(&self, from: &Point3<f64>, to: &Point3<f64>, work: &mut Work) -> Option<Pierced> {
        let mut best: Option<Pierced> = None;
        let sheared = Sheared::new(from, to);
        let segment = FatSegment { from: *from, to: *to, radius: 0.0 };
        work.nodes += self.bvh().look_along(&segment, sheared.shear(), |seen| {
            work.triangles += 1;
            let face = seen.item;
            let hit = match &seen.corners {
                Some(known) => sheared.hits_sheared(&known.sheared(), known.turn_bound, || known.points()),
                None => sheared.hits(self.corners(face)),
            };
            if let SegmentHit::Hit { f, feature, .. } = hit
                && best.is_none_or(|found| (f, face) < (found.f, found.face))
            {
                best = Some(Pierced { f, face, feature });
            }
            // The exact place of the one that was found.
            best.map_or(f64::INFINITY, |found| found.f + SEGMENT_FRACTION_BOUND)
        });
        best
    }
}
