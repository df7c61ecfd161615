//! Exponentials, logarithms and powers of the four operations and square roots: the same bits on every machine, unlike a library's.

use std::f64::consts::{LN_2, LOG2_E, SQRT_2};

/// Terms of the series: what comes after them is below the unit roundoff of the first.
const TERMS: u32 = 20;

/// e^x, to a few units of roundoff of max(1, |x|); 0 where it is below the normal numbers.
pub fn exponential(x: f64) -> f64 {
    if x.is_nan() {
        return x;
    }
    let halves = (x * LOG2_E).round();
    if halves < f64::from(f64::MIN_EXP) {
        return 0.0;
    }
    if halves >= f64::from(f64::MAX_EXP) {
        return f64::INFINITY;
    }
    // What is left is at most ln 2 / 2: 20 terms of Taylor's series are enough.
    let rest = x - halves * LN_2;
    let series = (1..=TERMS).rev().fold(1.0, |sum, n| 1.0 + sum * rest / f64::from(n));
    series * two_to(halves as i64)
}

/// ln x of a normal x > 0, to a few units of roundoff of max(1, |ln x|); minus infinity below.
pub fn logarithm(x: f64) -> f64 {
    if !x.is_finite() || x < f64::MIN_POSITIVE {
        return if x == f64::INFINITY || x.is_nan() { x } else { f64::NEG_INFINITY };
    }
    let exponent = (x.to_bits() >> 52) as i64 - 1023;
    let mut m = x * two_to(-exponent / 2) * two_to(exponent / 2 - exponent);
    let mut exponent = exponent as f64;
    if m > SQRT_2 {
        m *= 0.5;
        exponent += 1.0;
    }
    // ln m = 2 artanh s, and |s| <= 0.172: every other term is 34 times smaller.
    let s = (m - 1.0) / (m + 1.0);
    let square = s * s;
    let series = (0..TERMS / 2).rev().fold(0.0, |sum, n| sum * square + 1.0 / f64::from(2 * n + 1));
    2.0 * s * series + exponent * LN_2
}

/// x^p of x >= 0: 0 to any power > 0 is 0.
pub fn power(x: f64, p: f64) -> f64 {
    exponential(p * logarithm(x))
}

/// 2^n in the range of the normal numbers.
fn two_to(n: i64) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_logarithms_and_powers_are_those_of_the_library() {
        let mut x = 2f64.powi(-40);
        while x < 2f64.powi(40) {
            let (e, l) = (exponential(-x), logarithm(x));
            // Below the normal numbers there is nothing.
            let right = if x < 708.0 { (-x).exp() } else { 0.0 };
            assert!((e - right).abs() <= 8.0 * f64::EPSILON * x.max(1.0) * right, "{x}: {e}");
            assert!((l - x.ln()).abs() <= 4.0 * f64::EPSILON * x.ln().abs().max(1.0), "{x}: {l}");
            for p in [0.25, 0.8, 1.52, -7.94] {
                let right = x.powf(p);
                assert!((power(x, p) - right).abs() <= 512.0 * f64::EPSILON * right, "{x}^{p}");
            }
            x *= 1.37;
        }
    }

    #[test]
    fn ends_of_the_range_are_numbers_where_there_are_numbers() {
        assert_eq!((exponential(0.0), exponential(-1e6), exponential(1e6)), (1.0, 0.0, f64::INFINITY));
        assert_eq!((exponential(f64::NEG_INFINITY), power(0.0, 1.5), power(0.0, -1.0)), (0.0, 0.0, f64::INFINITY));
        assert_eq!((logarithm(1.0), logarithm(0.0)), (0.0, f64::NEG_INFINITY));
        assert!(
            (logarithm(f64::MAX) - f64::MAX.ln()).abs() < 1e-12
                && (logarithm(f64::MIN_POSITIVE) - f64::MIN_POSITIVE.ln()).abs() < 1e-12
        );
        assert!(exponential(f64::NAN).is_nan() && logarithm(f64::NAN).is_nan());
    }
}
