//! Exact rational arithmetic on f64, for the decisions that rounding cannot make.

use dashu_ratio::Relaxed;
use nalgebra::{Point3, Vector3};
use std::cmp::Ordering;

/// An exact number. `Relaxed` only strips common factors of two, which is all there is between products of f64.
pub(crate) type Exact = Relaxed;

/// An exact vector.
pub(crate) type ExactVector = [Exact; 3];

/// `x` exactly; zero if it is not finite, which callers exclude.
pub(crate) fn exact(x: f64) -> Exact {
    Exact::try_from(x).unwrap_or(Exact::ZERO)
}

/// How `x` compares to zero.
pub(crate) fn compare_zero(x: &Exact) -> Ordering {
    x.cmp(&Exact::ZERO)
}

/// a - b.
pub(crate) fn difference(a: &Point3<f64>, b: &Point3<f64>) -> ExactVector {
    std::array::from_fn(|i| exact(a[i]) - exact(b[i]))
}

/// A vector.
pub(crate) fn vector(v: &Vector3<f64>) -> ExactVector {
    std::array::from_fn(|i| exact(v[i]))
}

/// a x b.
pub(crate) fn cross(a: &ExactVector, b: &ExactVector) -> ExactVector {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &a[j] * &b[k] - &a[k] * &b[j]
    })
}

/// a + b.
pub(crate) fn sum(a: &ExactVector, b: &ExactVector) -> ExactVector {
    std::array::from_fn(|i| &a[i] + &b[i])
}

/// a . b.
pub(crate) fn dot(a: &ExactVector, b: &ExactVector) -> Exact {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// Whether every component is zero.
pub(crate) fn is_zero(v: &ExactVector) -> bool {
    v.iter().all(Exact::is_zero)
}

/// The nearest f64.
pub(crate) fn nearest(x: &Exact) -> f64 {
    x.to_f64().value()
}

/// The largest f64 that is not above `x`, for x in [0, 1].
pub(crate) fn round_down(x: &Exact) -> f64 {
    let near = nearest(x);
    if exact(near) > *x { near.next_down() } else { near }
}
