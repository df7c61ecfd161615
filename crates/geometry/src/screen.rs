//! Cheap certificates that a stretch of a path stays off a triangle: the plane of the face, and those through its edges.
//!
//! Any plane with the triangle behind it will do. These four need no closest point, no root and no quotient, and are enough for most
//! triangles that a tree of boxes lets through.

use crate::bounds::{largest, least};
use crate::path::Path;
use nalgebra::Vector3;

/// A stretch of a ball's path, seen from the start of the path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    from: Vector3<f64>,
    to: Vector3<f64>,
    /// What the path bends by: along a normal n, it is below its chord by n.bend at most if n.bend > 0, and never otherwise.
    bend: Vector3<f64>,
    /// How much farther than the bend says the path may be below the chord.
    further: f64,
    /// The distance that is no contact even in doubt.
    reach: f64,
}

impl Stretch {
    /// `path` over [`from`, `to`] for a ball that touches nothing farther off than `reach`.
    pub(crate) fn new(path: &Path, from: f64, to: f64, reach: f64) -> Self {
        let half = 0.5 * (to - from);
        let (bend, further) = match path.terms() {
            [] | [_] => (Vector3::zeros(), 0.0),
            // A parabola c2 f^2 is below its chord by c2 (to - from)^2 / 4 in the middle.
            [_, quadratic] => (quadratic * (half * half), 0.0),
            _ => (Vector3::zeros(), path.chord(from, to).sagitta),
        };
        let (from, to) = (path.displacement(from), path.displacement(to));
        Self { from, to, bend, further, reach }
    }

    /// Whether the plane of the face tells that the ball touches nothing of the triangle with the `corners`, seen from the start of the
    /// path, and the unit `normal`. A normal of zero tells nothing.
    #[inline]
    pub(crate) fn is_off_face(&self, corners: &[Vector3<f64>; 3], normal: &Vector3<f64>) -> bool {
        let [a, b, c] = corners;
        let heights = [normal.dot(a), normal.dot(b), normal.dot(c)];
        let (from, to) = (normal.dot(&self.from), normal.dot(&self.to));
        let bend = normal.dot(&self.bend);
        // From its front and from its back.
        let (highest, lowest) =
            (largest(largest(heights[0], heights[1]), heights[2]), least(least(heights[0], heights[1]), heights[2]));
        let above = least(from, to) - highest - largest(bend, 0.0);
        let below = lowest - largest(from, to) + least(bend, 0.0);
        largest(above, below) - self.further > self.reach
    }

    /// Whether one of the planes through the edges tells it.
    #[inline]
    pub(crate) fn is_off_edges(&self, corners: &[Vector3<f64>; 3], normal: &Vector3<f64>) -> bool {
        let [a, b, c] = corners;
        self.is_beyond(a, b, c, normal) || self.is_beyond(b, c, a, normal) || self.is_beyond(c, a, b, normal)
    }

    /// Whether the ball stays on the side of the edge from `p` to `q` that the third corner is not on.
    #[inline]
    fn is_beyond(&self, p: &Vector3<f64>, q: &Vector3<f64>, opposite: &Vector3<f64>, normal: &Vector3<f64>) -> bool {
        let across = (q - p).cross(normal);
        let height = across.dot(p);
        let (from, to) = (across.dot(&self.from) - height, across.dot(&self.to) - height);
        // Seen along `across` or against it, whichever way the ball is: a normal that was declared need not go with the winding.
        let side = if from > 0.0 && to > 0.0 {
            1.0
        } else if from < 0.0 && to < 0.0 {
            -1.0
        } else {
            return false;
        };
        if side * across.dot(&(opposite - p)) > 0.0 {
            return false;
        }
        let distance = least(side * from, side * to) - largest(side * across.dot(&self.bend), 0.0);
        // All of these in units of the length of `across`.
        let reach = self.reach + self.further;
        distance > 0.0 && distance * distance > reach * reach * across.norm_squared()
    }

    /// Whether a ball of `radius` seems to meet the inside of the triangle, if it comes to its plane at all: a guess, for which its chord will do.
    #[inline]
    pub(crate) fn leads_into(&self, corners: &[Vector3<f64>; 3], normal: &Vector3<f64>, radius: f64) -> bool {
        let [a, b, c] = corners;
        let height = normal.dot(a);
        let (from, to) = (normal.dot(&self.from) - height, normal.dot(&self.to) - height);
        let side = if from < 0.0 { -1.0 } else { 1.0 };
        let (from, to) = (side * from - radius, side * to - radius);
        let part = if from <= 0.0 {
            0.0
        } else if to < from {
            least(from / (from - to), 1.0)
        } else {
            1.0
        };
        let foot = self.from + (self.to - self.from) * part;
        let turn = |p: &Vector3<f64>, q: &Vector3<f64>| (q - p).cross(&(foot - p)).dot(normal);
        let turns = [turn(a, b), turn(b, c), turn(c, a)];
        turns.iter().all(|t| *t >= 0.0) || turns.iter().all(|t| *t <= 0.0)
    }
}

/// Whether all `corners` are farther than `reach` from the plane through the origin across `normal`, on one side of it.
#[inline]
pub(crate) fn is_off_plane(corners: &[Vector3<f64>; 3], normal: &Vector3<f64>, reach: f64) -> bool {
    let [a, b, c] = corners;
    let (a, b, c) = (normal.dot(a), normal.dot(b), normal.dot(c));
    least(least(a, b), c) > reach || largest(largest(a, b), c) < -reach
}

#[cfg(test)]
mod tests;
