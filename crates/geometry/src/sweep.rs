//! A moving ball against a mesh: the first contact, and what is touched there.

mod search;
mod surroundings;
mod touch;

use crate::bounds::{amax, largest};
use crate::contact::MovingBall;
use crate::mesh::Mesh;
pub use surroundings::Surroundings;
pub use touch::Touch;

/// The first contact of a ball with a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstContact {
    /// Where on the path; never late.
    pub f: f64,
    /// The face; the lowest-numbered of those met at the same f.
    pub face: u32,
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
        self.first_contact_around(ball, to, free_until, &mut Surroundings::default(), work)
    }

    /// How far along an axis the mesh reaches from `x`.
    fn farthest_from(&self, x: &nalgebra::Point3<f64>) -> f64 {
        largest(amax(&(self.bounds().min() - x)), amax(&(self.bounds().max() - x)))
    }
}

#[cfg(test)]
mod tests;
