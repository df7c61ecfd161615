//! Real numbers with more than twice the digits of f64, for the reference: a thin cover of the crate `dashu-float`.

use dashu_float::{FBig, round::mode::HalfEven};
use nalgebra::{Point3, Vector3};
use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Binary digits of a number: f64 has 53.
pub const BITS: usize = 128;

/// A number of [`BITS`] binary digits and practically any exponent.
#[derive(Debug, Clone, PartialEq)]
pub struct Real(FBig<HalfEven, 2>);

/// A vector of them.
pub type Vector = [Real; 3];

impl Real {
    /// 0.
    pub fn zero() -> Self {
        Self::from(0.0)
    }

    /// pi, from its first 39 digits.
    pub fn pi() -> Self {
        let digits: u128 = 314_159_265_358_979_323_846_264_338_327_950_288_419;
        let power: u128 = 10_u128.pow(38);
        let exact = |n: u128| Self(FBig::from(n).with_precision(BITS).value());
        exact(digits) / exact(power)
    }

    /// The nearest f64.
    pub fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }

    /// The square root; of a number below 0 it is 0, because only rounding makes one.
    pub fn sqrt(&self) -> Self {
        if *self > Self::zero() { Self(self.0.sqrt()) } else { Self::zero() }
    }

    /// e to its power.
    pub fn exp(&self) -> Self {
        Self(self.0.exp())
    }

    /// It to the power `p`; 0 of what is not above 0.
    pub fn power(&self, p: &Self) -> Self {
        if *self > Self::zero() { Self(self.0.powf(&p.0)) } else { Self::zero() }
    }

    /// The least power of two above its absolute value, as an exponent; of 0, minus infinity.
    pub fn exponent(&self) -> f64 {
        let (digits, exponent) = (self.0.repr().digits(), self.0.repr().exponent());
        if self.is_zero() { f64::NEG_INFINITY } else { digits as f64 + exponent as f64 }
    }

    /// Whether it is 0.
    pub fn is_zero(&self) -> bool {
        self.0 == FBig::<HalfEven, 2>::ZERO
    }
}

/// What is not finite counts as 0; scenes have no such numbers.
impl From<f64> for Real {
    fn from(x: f64) -> Self {
        let finite = if x.is_finite() { x } else { 0.0 };
        Self(FBig::try_from(finite).unwrap_or(FBig::ZERO).with_precision(BITS).value())
    }
}

impl PartialOrd for Real {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

impl Neg for Real {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Neg for &Real {
    type Output = Real;
    fn neg(self) -> Real {
        Real(-self.0.clone())
    }
}

macro_rules! operator {
    ($trait:ident, $function:ident) => {
        impl $trait<&Real> for &Real {
            type Output = Real;
            fn $function(self, other: &Real) -> Real {
                Real((&self.0).$function(&other.0))
            }
        }
        impl $trait for Real {
            type Output = Real;
            fn $function(self, other: Real) -> Real {
                (&self).$function(&other)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);

/// A quotient by 0 is 0: whoever divides has ruled it out, and a reference does not panic.
impl Div<&Real> for &Real {
    type Output = Real;
    fn div(self, other: &Real) -> Real {
        if other.is_zero() { Real::zero() } else { Real((&self.0).div(&other.0)) }
    }
}

impl Div for Real {
    type Output = Real;
    fn div(self, other: Real) -> Real {
        &self / &other
    }
}

impl AddAssign<&Real> for Real {
    fn add_assign(&mut self, other: &Real) {
        *self = &*self + other;
    }
}

/// The vector of three f64.
pub fn vector(v: &Vector3<f64>) -> Vector {
    [Real::from(v.x), Real::from(v.y), Real::from(v.z)]
}

/// The coordinates of a point.
pub fn point(p: &Point3<f64>) -> Vector {
    vector(&p.coords)
}

/// The nearest vector of f64.
pub fn rounded(v: &Vector) -> Vector3<f64> {
    Vector3::new(v[0].to_f64(), v[1].to_f64(), v[2].to_f64())
}

/// a + b.
pub fn add(a: &Vector, b: &Vector) -> Vector {
    [&a[0] + &b[0], &a[1] + &b[1], &a[2] + &b[2]]
}

/// a - b.
pub fn sub(a: &Vector, b: &Vector) -> Vector {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

/// a s.
pub fn scale(a: &Vector, s: &Real) -> Vector {
    [&a[0] * s, &a[1] * s, &a[2] * s]
}

/// a . b.
pub fn dot(a: &Vector, b: &Vector) -> Real {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

/// |a|.
pub fn norm(a: &Vector) -> Real {
    dot(a, a).sqrt()
}

/// a x b.
pub fn cross(a: &Vector, b: &Vector) -> Vector {
    let part = |i: usize, j: usize| &(&a[i] * &b[j]) - &(&a[j] * &b[i]);
    [part(1, 2), part(2, 0), part(0, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_more_than_twice_the_digits_of_f64() {
        // (1 + 2^-100)^2 - 1 = 2^-99 + 2^-200.
        let tiny = Real::from(2f64.powi(-100));
        let x = &Real::from(1.0) + &tiny;
        assert_eq!((&(&x * &x) - &Real::from(1.0)).to_f64(), 2f64.powi(-99));
        // sqrt(2)^2 - 2 is rounding.
        let root = Real::from(2.0).sqrt();
        assert!((&(&root * &root) - &Real::from(2.0)).to_f64().abs() < 2f64.powi(-125));
        // pi less its f64 is the next 53 digits of it (OEIS A000796).
        assert_eq!((Real::pi() - Real::from(std::f64::consts::PI)).to_f64(), 1.2246467991473532e-16);
    }

    #[test]
    fn what_has_no_answer_does_not_panic() {
        assert!((Real::from(1.0) / Real::zero()).is_zero());
        assert!(Real::from(-1.0).sqrt().is_zero() && Real::from(f64::NAN).is_zero());
    }
}
