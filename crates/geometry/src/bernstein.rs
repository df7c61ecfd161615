//! The first entry of a cubic or quartic clearance: halved in Bernstein form until one falling root is left.
//!
//! All coefficients positive proves that there is none, halving is exact but for the rounding of averages, and on [0, 1] no basis
//! is better conditioned (R. T. Farouki, The Bernstein polynomial basis: a centennial retrospective, CAGD 29, 2012).

/// The degree that everything here has; lower ones have zeros at the top.
pub(crate) const DEGREE: usize = 4;

const BINOMIAL: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// A stretch of the clearance as Bernstein coefficients over [lo, lo + width].
#[derive(Clone, Copy)]
struct Piece {
    b: [f64; DEGREE + 1],
    lo: f64,
    width: f64,
}

/// What a piece says about the first entry.
enum Verdict {
    /// No entry: the clearance stays positive, or never falls.
    None,
    /// The piece begins <= 0 and falling.
    AtStart,
    /// Falls all the way, from above 0 to below it: one root.
    OneRoot,
    /// Halve it.
    Unknown,
}

impl Piece {
    fn of(coefficients: &[f64; DEGREE + 1], lo: f64, hi: f64) -> Self {
        let width = hi - lo;
        // Taylor coefficients at `lo`, in units of the width.
        let mut taylor = *coefficients;
        for k in 0..DEGREE {
            for i in (k..DEGREE).rev() {
                taylor[i] += lo * taylor[i + 1];
            }
        }
        let mut power = 1.0;
        for t in &mut taylor {
            *t *= power;
            power *= width;
        }
        let mut b = [0.0; DEGREE + 1];
        for (i, bi) in b.iter_mut().enumerate() {
            for k in (0..=i).rev() {
                *bi += BINOMIAL[i][k] / BINOMIAL[DEGREE][k] * taylor[k];
            }
        }
        Self { b, lo, width }
    }

    fn verdict(&self) -> Verdict {
        let b = &self.b;
        if b.iter().all(|&x| x > 0.0) || b.windows(2).all(|w| w[1] >= w[0]) {
            return Verdict::None;
        }
        if b[0] <= 0.0 && b[1] < b[0] {
            return Verdict::AtStart;
        }
        if b[0] > 0.0 && b[DEGREE] <= 0.0 && b.windows(2).all(|w| w[1] <= w[0]) {
            return Verdict::OneRoot;
        }
        Verdict::Unknown
    }

    /// The two halves; halving is exact up to the rounding of averages.
    fn halves(&self) -> (Self, Self) {
        let mut row = self.b;
        let (mut left, mut right) = (self.b, self.b);
        for k in 1..=DEGREE {
            for i in 0..=DEGREE - k {
                row[i] = 0.5 * (row[i] + row[i + 1]);
            }
            left[k] = row[0];
            right[DEGREE - k] = row[DEGREE - k];
        }
        let width = 0.5 * self.width;
        (Self { b: left, lo: self.lo, width }, Self { b: right, lo: self.lo + width, width })
    }

    /// c at `s` in [0, 1] of the piece (de Casteljau).
    fn at(&self, s: f64) -> f64 {
        let mut row = self.b;
        for k in 1..=DEGREE {
            for i in 0..=DEGREE - k {
                row[i] += s * (row[i + 1] - row[i]);
            }
        }
        row[0]
    }

    /// The root of a piece that falls from above 0 to below: regula falsi (Illinois) inside a bracket that halves at the
    /// latest every third round; the early side of the last bracket.
    fn only_root(&self) -> f64 {
        let (mut lo, mut hi) = (0.0, 1.0);
        let (mut at_lo, mut at_hi) = (self.b[0], self.b[DEGREE]);
        let mut rounds = 0;
        while at_hi < 0.0 && rounds < 200 {
            let middle = 0.5 * (lo + hi);
            if middle <= lo || middle >= hi {
                break;
            }
            let secant = lo + (hi - lo) * (at_lo / (at_lo - at_hi));
            let s = if rounds % 3 == 2 || !(secant > lo && secant < hi) { middle } else { secant };
            let value = self.at(s);
            if value > 0.0 {
                (lo, at_lo) = (s, value);
                at_hi *= 0.5;
            } else {
                (hi, at_hi) = (s, value);
                at_lo *= 0.5;
            }
            if value == 0.0 {
                lo = s;
                break;
            }
            rounds += 1;
        }
        let s = if at_hi == 0.0 { hi } else { lo };
        self.lo + self.width * s
    }
}

/// The first f in [`from`, `to`] at which the polynomial with these `coefficients` (of f^0 first) is <= 0 and falling: pieces front to
/// back, each ruled out, solved, or halved.
///
/// The pieces are those of [`from`, 1] wherever in it the search ends, so that what is found has the same bits for every `to`.
pub(crate) fn first_entry(coefficients: &[f64; DEGREE + 1], from: f64, to: f64) -> Option<f64> {
    // Each halving pushes one piece, and after 60 a piece is narrower than the spacing of f.
    let whole = Piece::of(coefficients, from, to.max(1.0));
    if !whole.b.iter().all(|b| b.is_finite()) {
        return Some(from); // no comparison would ever rule a piece out: on the safe side, a hit
    }
    let mut stack = [whole; 64];
    let mut depth = 1;
    while depth > 0 {
        depth -= 1;
        let piece = stack[depth];
        if piece.lo > to {
            break;
        }
        let f = match piece.verdict() {
            Verdict::None => continue,
            Verdict::AtStart => piece.lo,
            Verdict::OneRoot => piece.only_root(),
            Verdict::Unknown => {
                if piece.lo + 0.5 * piece.width > piece.lo && depth + 2 <= stack.len() {
                    let (left, right) = piece.halves();
                    stack[depth] = right;
                    stack[depth + 1] = left;
                    depth += 2;
                    continue;
                }
                piece.lo // undecided at the resolution of f: on the safe side, a hit
            }
        };
        return (f <= to).then_some(f);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_of_a_falling_piece_is_on_its_early_side() {
        for c in [[0.3, -1.1, 0.7, -0.45, -0.9], [0.1, 0.0, 0.0, -0.7, -0.3], [1.0, -0.3, -0.7, -0.2, -0.1]] {
            let piece = Piece::of(&c, 0.0, 1.0);
            assert!(matches!(piece.verdict(), Verdict::OneRoot), "{c:?}");
            let root = piece.only_root();
            assert!(piece.at(root) >= 0.0 && piece.at(root.next_up().next_up()) < 0.0, "{root} of {c:?}");
        }
    }

    #[test]
    fn an_entry_at_either_end_of_the_search_is_found() {
        assert_eq!(first_entry(&[1.0, 0.0, 0.0, -1.0, 0.0], 0.0, 1.0), Some(1.0));
        let falling = [0.3, -1.1, 0.7, 0.45, -0.9];
        assert_eq!(first_entry(&falling, 0.5, 0.5), Some(0.5), "below 0 and falling: now");
    }

    #[test]
    fn what_starts_level_below_zero_and_rises_enters_where_it_falls_back() {
        let c = [-0.1, 0.0, 0.0, 4.0, -4.5];
        let f = first_entry(&c, 0.0, 1.0).unwrap();
        let at = |f: f64| c.iter().rev().fold(0.0, |sum, c| sum * f + c);
        assert!(f > 0.5 && at(f).abs() < 1e-14, "{f}");
    }

    #[test]
    fn the_first_of_three_roots_is_found_where_a_secant_would_find_the_last() {
        // (f - 0.1)(f - 0.2)(f - 0.9)(f - 1.5)
        let f = first_entry(&[0.027, -0.453, 2.09, -2.7, 1.0], 0.0, 1.0).unwrap();
        assert!((f - 0.1).abs() < 1e-14, "{f}");
    }

    #[test]
    fn an_entry_far_below_the_resolution_of_the_whole_is_told_from_the_start() {
        // -(f - 2^-42)(f - 2^-40): begins below 0 and rises.
        let (early, late) = (2f64.powi(-42), 2f64.powi(-40));
        let f = first_entry(&[-early * late, early + late, -1.0, 2f64.powi(-60), 0.0], 0.0, 1.0).unwrap();
        assert!((f / late - 1.0).abs() < 1e-9, "{f:e}");
    }
}
