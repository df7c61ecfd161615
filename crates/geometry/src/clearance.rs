//! The clearance along a path, and the first place where it is used up: collision determination.
//!
//! A plane turns a path into a polynomial c(f), the distance that is left between ball and plane. **A collision is the first
//! f at which c(f) <= 0 and c is falling.** For a straight path that is the chapter's f = d0 / (d0 - d1); a parabola has its
//! quadratic, solved without cancellation; degrees 3 and 4 are halved in Bernstein form until one falling root is left.
//! A ball that overlaps and separates is not an event, however deep: falling is part of the definition, so no tolerance
//! decides and no position has to be nudged (stable event detection: Bannerman, Strobl, Lue, J. Chem. Phys. 139, 2014).

use crate::bernstein;
use crate::rounding::{exponent, power_of_two, scale};

/// The highest degree of a path, and so of a clearance.
pub const MAX_DEGREE: usize = bernstein::DEGREE;

/// A clearance c(f) = c0 + c1 f + c2 f^2 + c3 f^3 + c4 f^4 in the unit of its coefficients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    c: [f64; MAX_DEGREE + 1],
}

/// Where a clearance is first <= 0 and falling.
///
/// ```
/// use carom_geometry::clearance::Entry;
/// use carom_geometry::nalgebra::{Point3, Vector3};
/// use carom_geometry::path::Path;
///
/// // 2 m above a floor, downwards by 4 m: there at the half of the way. Upwards: never.
/// let floor = Vector3::z();
/// let falling = Path::line(Point3::new(0.0, 0.0, 2.0), -4.0 * floor);
/// assert_eq!(falling.clearance(2.0, &floor).first_entry(0.0, 1.0), Entry::At { f: 0.5, rate: -4.0 });
/// let rising = Path::line(Point3::new(0.0, 0.0, 2.0), 4.0 * floor);
/// assert_eq!(rising.clearance(2.0, &floor).first_entry(0.0, 1.0), Entry::Never);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Entry {
    /// Nowhere in the interval.
    Never,
    /// At `f`, with slope `rate` = dc/df <= 0. A slope of 0 is a touch: `c` turns there.
    At {
        /// Where.
        f: f64,
        /// The slope there.
        rate: f64,
    },
}

impl Entry {
    /// Where, if anywhere.
    pub fn f(&self) -> Option<f64> {
        match *self {
            Entry::Never => None,
            Entry::At { f, .. } => Some(f),
        }
    }

    fn within(self, to: f64) -> Self {
        match self {
            Entry::At { f, .. } if f <= to => self,
            _ => Entry::Never,
        }
    }
}

impl Clearance {
    /// The clearance with these coefficients, c0 first.
    pub fn new(coefficients: [f64; MAX_DEGREE + 1]) -> Self {
        Self { c: coefficients }
    }

    /// What is left of it beyond `margin`.
    #[inline]
    pub(crate) fn beyond(&self, margin: f64) -> Self {
        let [c0, c1, c2, c3, c4] = self.c;
        Self { c: [c0 - margin, c1, c2, c3, c4] }
    }

    /// c(f).
    #[inline]
    pub fn at(&self, f: f64) -> f64 {
        self.c.iter().rev().fold(0.0, |sum, c| sum * f + c)
    }

    /// dc/df at `f`.
    #[inline]
    pub fn rate(&self, f: f64) -> f64 {
        let [_, c1, c2, c3, c4] = self.c;
        ((4.0 * c4 * f + 3.0 * c3) * f + 2.0 * c2) * f + c1
    }

    /// d^2c/df^2 at `f`.
    pub fn curvature(&self, f: f64) -> f64 {
        let [_, _, c2, c3, c4] = self.c;
        (12.0 * c4 * f + 6.0 * c3) * f + 2.0 * c2
    }

    /// From the other side: -c(f).
    pub fn opposite(&self) -> Self {
        Self { c: self.c.map(|c| -c) }
    }

    /// How the clearance may change over [0, `to`], `to` >= 0, but for rounding: it falls by no more than this, which is not positive.
    #[inline]
    pub fn fall(&self, to: f64) -> f64 {
        let falling = |c: f64| if c < 0.0 { c } else { 0.0 };
        let [_, c1, c2, c3, c4] = self.c;
        (((falling(c4) * to + falling(c3)) * to + falling(c2)) * to + falling(c1)) * to
    }

    /// The first f in [`from`, `to`] where the clearance is <= 0 and falling.
    ///
    /// Lines and parabolas are solved in closed form, to a few units of roundoff; higher degrees to the last bit of f that
    /// the rounded coefficients determine, on the early side. A parabola that touches 0 from above without crossing is
    /// reported as a touch (`rate` 0).
    #[inline(always)] // so that the entry is not copied
    pub fn first_entry(&self, from: f64, to: f64) -> Entry {
        if from > to {
            return Entry::Never;
        }
        let [c0, c1, c2, c3, c4] = self.c;
        if c3 != 0.0 || c4 != 0.0 {
            return match bernstein::first_entry(&self.c, from, to) {
                Some(f) => Entry::At { f, rate: self.rate(f).min(0.0) },
                None => Entry::Never,
            };
        }
        let local = if from == 0.0 {
            quadratic_entry(c0, c1, c2)
        } else {
            quadratic_entry((c2 * from + c1) * from + c0, 2.0 * c2 * from + c1, c2)
        };
        match local {
            Entry::At { f, rate } => Entry::At { f: from + f, rate }.within(to),
            Entry::Never => Entry::Never,
        }
    }
}

/// The first f >= 0 where c + b f + a f^2 is <= 0 and falling.
#[inline(always)] // so that the entry is not copied
fn quadratic_entry(c: f64, b: f64, a: f64) -> Entry {
    if c <= 0.0 {
        if b < 0.0 {
            return Entry::At { f: 0.0, rate: b };
        }
        if a >= 0.0 {
            return Entry::Never; // separating for ever
        }
        if c == 0.0 {
            // Back on the plane it left: the return is algebraic, so that e = 1 loses nothing.
            return Entry::At { f: b / -a, rate: -b };
        }
        let d = discriminant(c, b, a);
        if d.value <= 0.0 {
            return Entry::At { f: b / (-2.0 * a), rate: 0.0 }; // turns before it is free
        }
        let root = d.sqrt();
        return Entry::At { f: (b + root) / (-2.0 * a), rate: -root };
    }
    if b >= 0.0 && a >= 0.0 {
        return Entry::Never;
    }
    if a == 0.0 {
        return Entry::At { f: c / -b, rate: b }; // the chapter's d0 / (d0 - d1)
    }
    let d = discriminant(c, b, a);
    if d.value < 0.0 {
        return Entry::Never;
    }
    let root = d.sqrt();
    let f = if b < 0.0 { 2.0 * c / (root - b) } else { (b + root) / (-2.0 * a) };
    Entry::At { f, rate: -root }
}

/// b^2 - 4 a c, as `value` times 4^`exponent`.
struct Discriminant {
    value: f64,
    exponent: i32,
}

impl Discriminant {
    fn sqrt(&self) -> f64 {
        let root = self.value.sqrt();
        if self.exponent == 0 { root } else { scale(root, self.exponent) }
    }
}

/// Sums of products of which no more is lost to underflow than 2^-150 of them, and nothing to overflow.
const PLAIN: std::ops::RangeInclusive<f64> = power_of_two(-924)..=power_of_two(1020);

/// b^2 - 4 a c without cancellation (Kahan) and without over- or underflow.
#[inline]
fn discriminant(c: f64, b: f64, a: f64) -> Discriminant {
    // Where nothing cancels, the plain formula is as good, unless it is so small or large that its products may be out of range.
    let product = 4.0 * a * c;
    let plain = b * b - product;
    if product <= 0.0 && PLAIN.contains(&plain) {
        return Discriminant { value: plain, exponent: 0 };
    }
    // Products of numbers in this range neither overflow nor lose bits to underflow.
    const SAFE: std::ops::RangeInclusive<f64> = 1.0e-135..=1.0e150;
    let safe = |x: f64| x == 0.0 || SAFE.contains(&x.abs());
    if safe(a) && safe(b) && safe(c) {
        return Discriminant { value: difference_of_products(b, b, 4.0 * a, c), exponent: 0 };
    }
    // Scale f so that a and c are of one size, then everything to about 1: all exact.
    let (ea, eb, ec) = (exponent(a), exponent(b), exponent(c));
    let half = (ea + ec).div_euclid(2);
    let e = if b == 0.0 { half } else { eb.max(half) };
    // b / 2^e, and a c / 4^e split over both factors.
    let b = scale(b, -e);
    let a = scale(a, -ea);
    let c = scale(scale(c, -ec), (ea + ec - 2 * e).max(-1000));
    Discriminant { value: difference_of_products(b, b, 4.0 * a, c), exponent: e }
}

/// a b - c d with an error of at most 1.5 units in the last place (Jeannerod, Louvet, Muller 2013).
fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let (ab, cd) = (a * b, c * d);
    let difference = ab - cd;
    if difference.abs() >= 0.5 * ab.abs() {
        return difference; // nothing cancelled
    }
    // Rare, so the price of a software fma does not matter; it rounds the same on every machine.
    let error = (-c).mul_add(d, cd);
    a.mul_add(b, -cd) + error
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::UNIT_ROUNDOFF;

    fn entry(c: [f64; 5], from: f64, to: f64) -> Option<(f64, f64)> {
        match Clearance::new(c).first_entry(from, to) {
            Entry::Never => None,
            Entry::At { f, rate } => Some((f, rate)),
        }
    }

    #[test]
    fn r03_a_sign_change_in_one_dimension_is_a_collision() {
        // y - b goes from 2 to -1: the barrier is crossed. From 2 to 1 it is not.
        assert!(entry([2.0, -3.0, 0.0, 0.0, 0.0], 0.0, 1.0).is_some());
        assert!(entry([2.0, -1.0, 0.0, 0.0, 0.0], 0.0, 1.0).is_none());
    }

    #[test]
    fn r08_f_is_d0_over_d0_minus_d1() {
        let (d0, d1) = (0.75, -0.5);
        assert_eq!(entry([d0, d1 - d0, 0.0, 0.0, 0.0], 0.0, 1.0), Some((d0 / (d0 - d1), d1 - d0)));
    }

    #[test]
    fn r08_zero_over_zero_and_starts_inside_have_an_answer() {
        assert_eq!(entry([0.0; 5], 0.0, 1.0), None, "in contact for ever, never closing");
        assert_eq!(entry([-1.0, -2.0, 0.0, 0.0, 0.0], 0.0, 1.0), Some((0.0, -2.0)), "inside and closing: now");
        assert_eq!(entry([-1.0, 2.0, 0.0, 0.0, 0.0], 0.0, 1.0), None, "inside and separating: never");
    }

    #[test]
    fn r09_contact_is_clearance_used_up_and_closing() {
        // On the plane, leaving under gravity: the next contact is the return, algebraically.
        assert_eq!(entry([0.0, 3.0, -4.0, 0.0, 0.0], 0.0, 1.0), Some((0.75, -3.0)));
        // Overlapping, separating, but turning before it is free: there.
        assert_eq!(entry([-1.0, 1.0, -1.0, 0.0, 0.0], 0.0, 1.0), Some((0.5, 0.0)));
    }

    #[test]
    fn no_clearance_falls_farther_than_it_may() {
        for c in [[5.0, -1.0, 0.5, -2.0, 0.25], [0.0, 1.0, -3.0, 1.0, -1.0], [1.0, 2.0, 3.0, 4.0, 5.0]] {
            let clearance = Clearance::new(c);
            for f in (0..=16).map(|i| f64::from(i) / 16.0) {
                assert!(clearance.at(f) - c[0] >= clearance.fall(f), "{c:?} at {f}");
            }
        }
        assert_eq!(Clearance::new([1.0, -2.0, -3.0, 4.0, 5.0]).fall(0.5), -1.75);
        assert_eq!(Clearance::new([1.0, 2.0, 3.0, 4.0, 5.0]).fall(1.0), 0.0);
    }

    #[test]
    fn quadratic_roots_do_not_cancel() {
        // v = 1e4, h = 1e-9: the textbook formula returns 0.
        let (h, v, g) = (1e-9, -1e4, -9.81);
        let (f, _) = entry([h, v, 0.5 * g, 0.0, 0.0], 0.0, 1.0).unwrap();
        let exact = 1e-13; // h/|v| (1 - g h / (2 v^2)): the correction is 5e-17 relative
        assert!((f - exact).abs() <= 4.0 * UNIT_ROUNDOFF * exact, "{f:e}");
    }

    #[test]
    fn a_double_root_is_decided_by_the_exact_discriminant() {
        let touch = entry([0.25, -1.0, 1.0, 0.0, 0.0], 0.0, 1.0);
        assert_eq!(touch, Some((0.5, 0.0)));
        assert_eq!(entry([0.25 + UNIT_ROUNDOFF, -1.0, 1.0, 0.0, 0.0], 0.0, 1.0), None);
        assert!(entry([0.25 - UNIT_ROUNDOFF / 2.0, -1.0, 1.0, 0.0, 0.0], 0.0, 1.0).unwrap().1 < 0.0);
    }

    #[test]
    fn scaling_by_powers_of_two_changes_nothing() {
        let (f0, rate0) = entry([1.5, 0.3, -4.7, 0.0, 0.0], 0.0, 1.0).unwrap();
        for k in [-900, -600, -300, 300, 600, 1000] {
            let s = |x: f64| scale(x, k);
            let (f, rate) = entry([s(1.5), s(0.3), s(-4.7), 0.0, 0.0], 0.0, 1.0).unwrap();
            assert_eq!((f, rate), (f0, s(rate0)), "2^{k}");
        }
    }

    #[test]
    fn a_quartic_finds_its_first_falling_root() {
        // (f - 0.2)(f - 0.4)(f - 0.6)(f - 0.8): falls through 0.2 and 0.6.
        let c = [0.0384, -0.4, 1.4, -2.0, 1.0];
        let (f, rate) = entry(c, 0.0, 1.0).unwrap();
        assert!((f - 0.2).abs() < 64.0 * UNIT_ROUNDOFF && rate < 0.0, "{f}");
        let (f, _) = entry(c, 0.3, 1.0).unwrap();
        assert!((f - 0.6).abs() < 64.0 * UNIT_ROUNDOFF, "started overlapping, rising: {f}");
        assert_eq!(entry(c, 0.65, 0.79).map(|e| e.0), Some(0.65), "overlapping and falling: now");
        assert_eq!(entry(c, 0.73, 1.0), None, "only rises from here");
    }

    #[test]
    fn what_is_found_has_the_same_bits_wherever_the_search_ends() {
        let quartic = Clearance::new([0.3, -1.1, 0.7, 0.45, -0.9]);
        let f = quartic.first_entry(0.0, 1.0).f().unwrap();
        for to in [f, f.next_up(), 0.5, 0.75, 0.9] {
            assert_eq!(quartic.first_entry(0.0, to).f(), (f <= to).then_some(f), "to {to}");
        }
        assert_eq!(quartic.first_entry(0.0, f.next_down()), Entry::Never);
    }

    #[test]
    fn a_higher_degree_with_no_higher_terms_agrees_with_the_closed_form() {
        for (c, b, a) in [(1.0, 0.5, -3.0), (1.0, -2.5, 0.3), (0.0, 1.0, -2.0), (1.0, 1.0, 1.0), (-0.1, 0.5, 2.0)] {
            let exact = quadratic_entry(c, b, a).within(1.0).f();
            let halved = bernstein::first_entry(&[c, b, a, 0.0, 0.0], 0.0, 1.0);
            match (exact, halved) {
                (Some(x), Some(y)) => assert!((x - y).abs() <= 16.0 * UNIT_ROUNDOFF, "{x} {y}"),
                (x, y) => assert_eq!(x, y),
            }
        }
    }

    #[test]
    fn value_rate_and_curvature_are_those_of_the_polynomial() {
        // 1 + 2 f + 3 f^2 + 4 f^3 + 5 f^4 at 2.
        let c = Clearance::new([1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!((c.at(2.0), c.rate(2.0), c.curvature(2.0)), (129.0, 222.0, 294.0));
    }

    #[test]
    fn what_overlaps_and_separates_enters_where_it_comes_back() {
        // -(4 f - 1)(f - 1): free from 1/4 on; and -4 f^2 + 2 f - 1, which turns at 1/4 before it is free.
        assert_eq!(entry([-1.0, 5.0, -4.0, 0.0, 0.0], 0.0, 1.0), Some((1.0, -3.0)));
        assert_eq!(entry([-1.0, 2.0, -4.0, 0.0, 0.0], 0.0, 1.0), Some((0.25, 0.0)));
        assert_eq!(entry([-1.0, -2.0, 0.0, 0.0, 0.0], 0.5, 0.5), Some((0.5, -2.0)), "an interval of one f");
        assert_eq!(entry([1.0, -2.0, 0.0, 0.0, 0.0], 0.0, 0.25), None, "later than asked");
    }

    #[test]
    fn a_discriminant_loses_neither_digits_nor_its_range() {
        let s = |k| 2f64.powi(k);
        // The roots 1 and 1 + 2^-29: b^2 needs 60 bits. And a c = 1 - 2^-60.
        assert_eq!(entry([1.0 + s(-29), -2.0 - s(-29), 1.0, 0.0, 0.0], 0.0, 1.0), Some((1.0, -s(-29))));
        let (_, rate) = entry([1.0 - s(-30), -2.0, 1.0 + s(-30), 0.0, 0.0], 0.0, 1.0).unwrap();
        assert_eq!(rate, -s(-29));
        assert_eq!(entry([1.0, -s(600), 1.0, 0.0, 0.0], 0.0, 1.0), Some((s(-600), -s(600))));
    }
}
