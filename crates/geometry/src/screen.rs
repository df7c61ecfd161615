//! Cheap certificates that a stretch of a path stays off a triangle: the plane of the face, and one that faces the path where it is near.
//!
//! Any plane with the triangle behind it will do, so the second may be found in a hurry: by plain arithmetic, and without a root. The two are
//! enough for most triangles that a tree of boxes lets through.

use crate::bounds::{amax, largest, least};
use crate::path::Path;
use crate::rounding::triple_product_bound;
use nalgebra::Vector3;

/// A stretch of a ball's path, seen from the start of the path.
#[derive(Debug, Clone, Copy, Default)]
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
        let [a, b, c] = heights(corners, normal);
        let (from, to) = (normal.dot(&self.from), normal.dot(&self.to));
        let bend = normal.dot(&self.bend);
        // From its front and from its back.
        let (highest, lowest) = (largest(largest(a, b), c), least(least(a, b), c));
        let above = least(from, to) - highest - largest(bend, 0.0);
        let below = lowest - largest(from, to) + least(bend, 0.0);
        largest(above, below) - self.further > self.reach
    }

    /// Whether the plane tells it that faces the stretch from the triangle's point that is nearest to it, or nearly so.
    #[inline]
    pub(crate) fn is_off_nearest(&self, corners: &[Vector3<f64>; 3]) -> bool {
        let [a, b, c] = corners;
        // Where the chord passes the middle of the triangle.
        let way = self.to - self.from;
        let (length, along) = (way.norm_squared(), ((a + b + c) * (1.0 / 3.0) - self.from).dot(&way));
        let near = if along <= 0.0 {
            self.from
        } else if along >= length {
            self.to
        } else {
            self.from + way * (along / length)
        };
        // Of any length: what it tells is measured in units of that.
        let across = near - closest(corners, &near);
        let highest = largest(largest(across.dot(a), across.dot(b)), across.dot(c));
        let lowest = least(across.dot(&self.from), across.dot(&self.to)) - largest(across.dot(&self.bend), 0.0);
        let (distance, reach) = (lowest - highest, self.reach + self.further);
        distance > 0.0 && distance * distance > reach * reach * across.norm_squared()
    }

    /// Whether a ball of `radius` seems to meet the inside of the triangle, if it comes to its plane at all: a guess, by its chord and from there
    /// by a step of Newton's method.
    #[inline]
    pub(crate) fn leads_into(&self, corners: &[Vector3<f64>; 3], normal: &Vector3<f64>, radius: f64) -> bool {
        let [a, b, c] = corners;
        let height = normal.dot(a);
        let (from, to) = (normal.dot(&self.from) - height, normal.dot(&self.to) - height);
        let side = if from < 0.0 { -1.0 } else { 1.0 };
        let (from, to) = (side * from - radius, side * to - radius);
        // Below the chord by this where the stretch is bent most.
        let bend = side * normal.dot(&self.bend);
        let below = |part: f64| 4.0 * (part * (1.0 - part));
        let part = if from <= 0.0 {
            0.0
        } else if to < from {
            let part = least(from / (from - to), 1.0);
            let (height, falls) =
                (from + (to - from) * part - bend * below(part), from - to + bend * (4.0 - 8.0 * part));
            if falls > 0.0 { largest(least(part + height / falls, 1.0), 0.0) } else { part }
        } else {
            1.0
        };
        let foot = self.from + (self.to - self.from) * part - self.bend * below(part);
        let turn = |p: &Vector3<f64>, q: &Vector3<f64>| (q - p).cross(&(foot - p)).dot(normal);
        let turns = [turn(a, b), turn(b, c), turn(c, a)];
        turns.iter().all(|t| *t >= 0.0) || turns.iter().all(|t| *t <= 0.0)
    }
}

/// The point of the triangle closest to `x`, as well as plain arithmetic tells (Ericson, Real-Time Collision Detection, 2005, section 5.1.5); not a number
/// for some triangles that have no area.
#[inline]
fn closest([a, b, c]: &[Vector3<f64>; 3], x: &Vector3<f64>) -> Vector3<f64> {
    let (ab, ac, ax) = (b - a, c - a, x - a);
    let (d1, d2) = (ab.dot(&ax), ac.dot(&ax));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bx = x - b;
    let (d3, d4) = (ab.dot(&bx), ac.dot(&bx));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let of_c = d1 * d4 - d3 * d2;
    if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cx = x - c;
    let (d5, d6) = (ab.dot(&cx), ac.dot(&cx));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let of_b = d5 * d2 - d1 * d6;
    if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let of_a = d3 * d6 - d5 * d4;
    if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let share = 1.0 / (of_a + of_b + of_c);
    a + ab * (of_b * share) + ac * (of_c * share)
}

/// The heights of the `corners` over the plane through the origin across `normal`.
#[inline]
pub(crate) fn heights([a, b, c]: &[Vector3<f64>; 3], normal: &Vector3<f64>) -> [f64; 3] {
    [normal.dot(a), normal.dot(b), normal.dot(c)]
}

/// Whether corners with these `heights` over a plane are all farther than `reach` from it, on one side.
#[inline]
pub(crate) fn is_off_plane(&[a, b, c]: &[f64; 3], reach: f64) -> bool {
    least(least(a, b), c) > reach || largest(largest(a, b), c) < -reach
}

/// Whether the origin is surely over or under the inside of the triangle with the `corners` and the unit `normal`. A normal of zero tells nothing.
#[inline]
pub(crate) fn is_over(corners: &[Vector3<f64>; 3], normal: &Vector3<f64>) -> bool {
    let [a, b, c] = corners;
    let bound = triple_product_bound(largest(largest(amax(a), amax(b)), amax(c)));
    let turn = |p: &Vector3<f64>, q: &Vector3<f64>| normal.dot(&p.cross(q));
    let (ab, bc, ca) = (turn(a, b), turn(b, c), turn(c, a));
    least(least(ab, bc), ca) > bound || largest(largest(ab, bc), ca) < -bound
}

#[cfg(test)]
mod tests;
