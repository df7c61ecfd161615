//! Cheap certificates that a stretch of a path stays off a triangle: the plane of the face, and those through its edges.
//!
//! Any plane with the triangle behind it will do. These four need no closest point, no root and no quotient, and are enough for most
//! triangles that a tree of boxes lets through.

use crate::bounds::{largest, least};
use crate::path::Path;
use nalgebra::{Point3, Vector3};

/// A stretch of a ball's path, seen from the start of the path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    start: Point3<f64>,
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
        let (start, from, to) = (path.start(), path.displacement(from), path.displacement(to));
        Self { start, from, to, bend, further, reach }
    }

    /// The triangle as seen from the start of the path.
    #[inline]
    pub(crate) fn local(&self, triangle: &[Point3<f64>; 3]) -> [Vector3<f64>; 3] {
        triangle.map(|v| v - self.start)
    }

    /// Whether the ball is certain to touch nothing of the triangle with the `corners` [`local`](Self::local) and the unit `normal`.
    #[inline]
    pub(crate) fn is_free_of(&self, corners: &[Vector3<f64>; 3], normal: &Vector3<f64>) -> bool {
        let [a, b, c] = corners;
        let heights = corners.map(|v| normal.dot(&v));
        let (from, to) = (normal.dot(&self.from), normal.dot(&self.to));
        let bend = normal.dot(&self.bend);
        // The face, from its front and from its back.
        let (highest, lowest) =
            (heights.into_iter().fold(heights[0], largest), heights.into_iter().fold(heights[0], least));
        let above = least(from, to) - highest - largest(bend, 0.0);
        let below = lowest - largest(from, to) + least(bend, 0.0);
        if largest(above, below) - self.further > self.reach {
            return true;
        }
        [(a, b, c), (b, c, a), (c, a, b)].into_iter().any(|(p, q, opposite)| self.is_beyond(p, q, opposite, normal))
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

    /// Whether the ball stays beyond the edge from `p` to `q`, seen from the third corner.
    #[inline]
    fn is_beyond(&self, p: &Vector3<f64>, q: &Vector3<f64>, opposite: &Vector3<f64>, normal: &Vector3<f64>) -> bool {
        let mut outward = (q - p).cross(normal);
        // A normal that was declared need not go with the winding.
        if outward.dot(&(opposite - p)) > 0.0 {
            outward = -outward;
        }
        let (from, to) = (outward.dot(&self.from), outward.dot(&self.to));
        let distance = least(from, to) - outward.dot(p) - largest(outward.dot(&self.bend), 0.0);
        // All of these in units of the length of `outward`.
        let reach = self.reach + self.further;
        distance > 0.0 && distance * distance > reach * reach * outward.norm_squared()
    }
}

/// Whether all `corners` are farther than `reach` from the plane through the origin across `normal`, on one side of it.
#[inline]
pub(crate) fn is_off_plane(corners: &[Vector3<f64>; 3], normal: &Vector3<f64>, reach: f64) -> bool {
    let heights = corners.map(|v| normal.dot(&v));
    heights.iter().all(|&h| h > reach) || heights.iter().all(|&h| h < -reach)
}
