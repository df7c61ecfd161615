//! Sums and products in twice the precision of f64: a rounded value and what it lacks.
//!
//! T. J. Dekker, Numer. Math. 18 (1971); D. E. Knuth, *The Art of Computer Programming* 2, 4.2.2. Without overflow; what underflows is left out.

/// The sum of both, the second at most a rounding of the first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Twofold(pub(crate) f64, pub(crate) f64);

impl Twofold {
    /// a - b, exactly.
    #[inline]
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        let (value, rest) = two_difference(a, b);
        Self(value, rest)
    }

    /// The product, to 9 u^2 of it.
    #[inline]
    pub(crate) fn times(self, other: Self) -> Self {
        let (value, rest) = two_product(self.0, other.0);
        Self::ordered(value, rest + (self.0 * other.1 + self.1 * other.0))
    }

    /// The difference, to 3 u^2 of the sum of the sizes of both.
    #[inline]
    pub(crate) fn minus(self, other: Self) -> Self {
        let (value, rest) = two_difference(self.0, other.0);
        Self::ordered(value, rest + (self.1 - other.1))
    }

    /// The sum, to as much.
    #[inline]
    pub(crate) fn plus(self, other: Self) -> Self {
        self.minus(Self(-other.0, -other.1))
    }

    /// value + rest, exactly, where the rest is the smaller.
    #[inline]
    fn ordered(value: f64, rest: f64) -> Self {
        let sum = value + rest;
        Self(sum, rest - (sum - value))
    }
}

/// a - b as a rounded value and its exact error (Knuth).
#[inline]
pub(crate) fn two_difference(a: f64, b: f64) -> (f64, f64) {
    let x = a - b;
    let b_part = a - x;
    let a_part = x + b_part;
    (x, (a - a_part) + (b_part - b))
}

/// a b as a rounded value and its exact error (Dekker), by splitting each factor into halves of 26 bits.
#[inline]
pub(crate) fn two_product(a: f64, b: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let halves = |x: f64| {
        let c = SPLITTER * x;
        let high = c - (c - x);
        (high, x - high)
    };
    let x = a * b;
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    (x, al * bl - (((x - ah * bh) - al * bh) - ah * bl))
}
