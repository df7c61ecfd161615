//! The path of a moving point: a curve over f in [0, 1].
//!
//! Straight under Euler's method, a parabola under constant acceleration, a cubic or quartic under a Runge-Kutta method with
//! its dense output. The curve is kept as its start and its Taylor terms there, which for a line and a parabola are exact; the
//! Bézier control points, which bound it, are made where they are needed.

use crate::bounds::{Aabb, amax};
use crate::clearance::{Clearance, MAX_DEGREE};
use nalgebra::{Point3, Vector3};

/// A path p(f) = start + t1 f + t2 f^2 + t3 f^3 + t4 f^4, f in [0, 1].
///
/// ```
/// use carom_geometry::nalgebra::{Point3, Vector3};
/// use carom_geometry::path::Path;
///
/// // A second of flight under g = 10 m/s^2, thrown upwards at 5 m/s: the terms of f and of f^2, which is g / 2.
/// let path = Path::parabola(Point3::origin(), Vector3::new(3.0, 0.0, 5.0), Vector3::new(0.0, 0.0, -5.0));
/// assert_eq!(path.at(0.5), Point3::new(1.5, 0.0, 1.25));
/// assert_eq!(path.derivative(0.5).z, 0.0);
/// // The box of its way, with the rounding of every point on it.
/// assert!(path.bounds(0.0, 1.0).contains(&path.at(0.3)));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Path {
    start: Point3<f64>,
    terms: [Vector3<f64>; MAX_DEGREE],
    /// The largest |component| of each term.
    sizes: [f64; MAX_DEGREE],
    degree: usize,
}

impl Path {
    /// The straight path from `start` to `start + displacement`.
    pub fn line(start: Point3<f64>, displacement: Vector3<f64>) -> Self {
        Self::from_terms(start, &[displacement])
    }

    /// The parabola start + linear f + quadratic f^2: for velocity v, acceleration a and duration h, `linear` is v h and
    /// `quadratic` a h^2 / 2.
    #[inline]
    pub fn parabola(start: Point3<f64>, linear: Vector3<f64>, quadratic: Vector3<f64>) -> Self {
        let zero = Vector3::zeros();
        Self {
            start,
            terms: [linear, quadratic, zero, zero],
            sizes: [amax(&linear), amax(&quadratic), 0.0, 0.0],
            degree: 2,
        }
    }

    /// The path with up to four Taylor terms at its start; terms beyond the fourth are not taken.
    pub fn from_terms(start: Point3<f64>, terms: &[Vector3<f64>]) -> Self {
        let mut all = [Vector3::zeros(); MAX_DEGREE];
        let mut sizes = [0.0; MAX_DEGREE];
        let mut degree = 0;
        for (k, term) in terms.iter().take(MAX_DEGREE).enumerate() {
            (all[k], sizes[k]) = (*term, amax(term));
            degree = k + 1;
        }
        Self { start, terms: all, sizes, degree }
    }

    /// p(0).
    #[inline]
    pub fn start(&self) -> Point3<f64> {
        self.start
    }

    /// How many Taylor terms the path has.
    #[inline]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The Taylor terms at the start, as many as the degree.
    #[inline]
    pub fn terms(&self) -> &[Vector3<f64>] {
        &self.terms[..self.degree]
    }

    /// p(f) - p(0). Small displacements are accurate wherever the path is: they know nothing of the start.
    #[inline]
    pub fn displacement(&self, f: f64) -> Vector3<f64> {
        if self.degree <= 2 {
            // What most paths are: the same sum, without a loop.
            let [linear, quadratic, ..] = self.terms;
            return (quadratic * f + linear) * f;
        }
        self.terms().iter().rev().fold(Vector3::zeros(), |sum, term| (sum + term) * f)
    }

    /// p(f).
    pub fn at(&self, f: f64) -> Point3<f64> {
        self.start + self.displacement(f)
    }

    /// dp/df at `f`.
    pub fn derivative(&self, f: f64) -> Vector3<f64> {
        if self.degree <= 2 {
            let [linear, quadratic, ..] = self.terms;
            return quadratic * 2.0 * f + linear;
        }
        let mut sum = Vector3::zeros();
        for (k, term) in self.terms().iter().enumerate().rev() {
            sum = sum * f + term * (k + 1) as f64;
        }
        sum
    }

    /// d^2p/df^2 at `f`.
    pub fn second_derivative(&self, f: f64) -> Vector3<f64> {
        let [_, quadratic, cubic, quartic] = self.terms;
        if self.degree <= 2 {
            return quadratic * 2.0;
        }
        (quartic * 12.0 * f + cubic * 6.0) * f + quadratic * 2.0
    }

    /// The distance along `normal` that is left at f when it is `gap` at f = 0: one dot product for each term.
    #[inline]
    pub fn clearance(&self, gap: f64, normal: &Vector3<f64>) -> Clearance {
        // Terms beyond the degree are zero, and so are their products.
        let [linear, quadratic, cubic, quartic] = &self.terms;
        let further = |term: &Vector3<f64>| if self.degree <= 2 { 0.0 } else { normal.dot(term) };
        Clearance::new([gap, normal.dot(linear), normal.dot(quadratic), further(cubic), further(quartic)])
    }

    /// No point of the path up to `f` is farther from the start than this, along any axis: the scale of its rounding errors.
    #[inline]
    pub fn reach(&self, f: f64) -> f64 {
        let [linear, quadratic, cubic, quartic] = self.sizes;
        // The zeros of a lower degree leave the sum as it is.
        if self.degree <= 2 {
            (quadratic * f + linear) * f
        } else {
            (((quartic * f + cubic) * f + quadratic) * f + linear) * f
        }
    }

    /// A straight stand-in for the path over [from, to], as seen from the start of the path, and how far from it the path may be.
    pub fn chord(&self, from: f64, to: f64) -> Chord {
        let (a, b) = (self.displacement(from), self.displacement(to));
        let half = 0.5 * (to - from);
        if self.degree <= 2 {
            // The parabola is between the chord and the chord moved by the bend in its middle: half way between the two it is half as far.
            let bend = self.terms[1] * (half * half * 0.5);
            return Chord { from: a - bend, to: b - bend, sagitta: length(&bend) };
        }
        // |p - chord| <= max |p''| (to - from)^2 / 8, and |p''| <= sum k (k-1) |t_k| f^(k-2).
        // All by 1/16, so that the factors up to 12 do not take a path out of the range of f64.
        let (mut bend, mut power) = (0.0, 1.0);
        for (k, term) in self.terms().iter().enumerate().skip(1) {
            bend += ((k + 1) * k) as f64 * length(&(term * 0.0625)) * power;
            power *= to;
        }
        Chord { from: a, to: b, sagitta: 8.0 * half * half * bend }
    }

    /// A box around the stretch of the path over [from, to].
    pub fn bounds(&self, from: f64, to: f64) -> Aabb {
        let chord = self.chord(from, to);
        Aabb::of_points(&[self.start + chord.from, self.start + chord.to]).inflate(chord.sagitta)
    }
}

/// The length of `v`, or more where its square is beyond the range of f64.
fn length(v: &Vector3<f64>) -> f64 {
    let square = v.norm_squared();
    if square.is_finite() { square.sqrt() } else { 2.0 * v.amax() }
}

/// A straight stand-in for a stretch of a path, relative to the start of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chord {
    /// Where it begins.
    pub from: Vector3<f64>,
    /// Where it ends.
    pub to: Vector3<f64>,
    /// How far the path may be from it.
    pub sagitta: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quartic() -> Path {
        let v = |x, y, z| Vector3::new(x, y, z);
        Path::from_terms(
            Point3::new(1.0, -2.0, 0.5),
            &[v(1.0, 2.0, 3.0), v(-4.0, 0.5, 1.0), v(2.0, 2.0, -8.0), v(0.25, -1.0, 4.0)],
        )
    }

    #[test]
    fn r07_a_straight_path_joins_the_positions_before_and_after_the_step() {
        let path = Path::line(Point3::new(1.0, 2.0, 3.0), Vector3::new(0.5, -1.0, 4.0));
        assert_eq!(path.at(0.0), Point3::new(1.0, 2.0, 3.0));
        assert_eq!(path.at(0.5), Point3::new(1.25, 1.5, 5.0));
        assert_eq!(path.at(1.0), Point3::new(1.5, 1.0, 7.0));
    }

    #[test]
    fn the_derivative_is_that_of_the_path() {
        let (path, f, step) = (quartic(), 0.375, 2f64.powi(-20));
        let slope = (path.displacement(f + step) - path.displacement(f - step)) / (2.0 * step);
        assert!((slope - path.derivative(f)).amax() < 1e-9);
        let bend = (path.derivative(f + step) - path.derivative(f - step)) / (2.0 * step);
        assert!((bend - path.second_derivative(f)).amax() < 1e-9);
        let parabola = Path::parabola(Point3::origin(), Vector3::x(), Vector3::new(0.0, 3.0, -5.0));
        assert_eq!(parabola.derivative(0.5), Vector3::new(1.0, 3.0, -5.0));
        assert_eq!(parabola.second_derivative(0.5), Vector3::new(0.0, 6.0, -10.0));
    }

    #[test]
    fn the_clearance_is_the_distance_from_the_plane_along_the_path() {
        let (path, n) = (quartic(), Vector3::new(0.6, 0.0, 0.8));
        let clearance = path.clearance(2.0, &n);
        for i in 0..=8 {
            let f = f64::from(i) / 8.0;
            assert!((clearance.at(f) - (2.0 + n.dot(&path.displacement(f)))).abs() < 1e-14);
            assert!((clearance.rate(f) - n.dot(&path.derivative(f))).abs() < 1e-13);
        }
    }

    #[test]
    fn h18_the_sagitta_is_a_number_as_long_as_the_path_is() {
        let path =
            Path::parabola(Point3::origin(), Vector3::zeros(), Vector3::new(f64::MAX / 4.0, f64::MAX / 4.0, 0.0));
        let (whole, half) = (path.chord(0.0, 1.0).sagitta, path.chord(0.0, 0.5).sagitta);
        assert!(whole.is_finite() && half == whole / 4.0, "{whole:e} {half:e}");
        assert!(whole >= 0.17 * (f64::MAX / 4.0), "an eighth of the length of the term");
    }

    #[test]
    fn the_sagitta_bounds_the_path() {
        let path = quartic();
        for (from, to) in [(0.0, 1.0), (0.25, 0.5), (0.9, 1.0)] {
            let chord = path.chord(from, to);
            for i in 0..=64 {
                let s = f64::from(i) / 64.0;
                let on_path = path.displacement(from + s * (to - from));
                let on_chord = chord.from + (chord.to - chord.from) * s;
                assert!((on_path - on_chord).norm() <= chord.sagitta * (1.0 + 1e-12));
            }
        }
    }

    #[test]
    fn the_sagitta_bounds_each_power_where_it_bends_most() {
        for (k, size) in (1..4).flat_map(|k| [1.0, 1e6].map(|size| (k, size))) {
            let mut terms = [Vector3::zeros(); MAX_DEGREE];
            terms[k] = Vector3::x() * size;
            let path = Path::from_terms(Point3::origin(), &terms);
            let (from, to) = (0.9, 1.0);
            let chord = path.chord(from, to);
            let off = path.displacement(0.95).x - (chord.from.x + chord.to.x) / 2.0;
            assert!(
                off.abs() <= chord.sagitta * (1.0 + 1e-12) && chord.sagitta < 1.2 * off.abs(),
                "f^{}: {off:e}",
                k + 1
            );
        }
    }

    #[test]
    fn a_box_around_a_straight_stretch_is_that_of_its_ends() {
        let path = Path::line(Point3::new(1.0, 2.0, 3.0), Vector3::new(2.0, -1.0, 4.0));
        assert_eq!(path.bounds(0.5, 1.0), Aabb::of_points(&[Point3::new(2.0, 1.5, 5.0), Point3::new(3.0, 1.0, 7.0)]));
    }
}
