//! Rotations, of the four operations and square roots: the same bits on every machine, unlike a library's sine.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Half an angle up to this is what the series is for.
const SMALL: f64 = 0.25;

/// Terms of the series: for angles that small, what comes after them is below the unit roundoff.
const TERMS: u32 = 8;

/// The rotation by `turn`: about its direction, by its length in rad, to a few units of roundoff of max(1, its length). None at all where it is not
/// finite.
///
/// It is the exponential of half of `turn` as a quaternion: that of a small share of it by Taylor's series, squared as often as the share was halved.
///
/// ```
/// use carom_dynamics::rotation::rotation;
/// use nalgebra::Vector3;
///
/// // A quarter turn about z takes x to y.
/// let quarter = rotation(&Vector3::new(0.0, 0.0, std::f64::consts::FRAC_PI_2));
/// assert!((quarter * Vector3::x() - Vector3::y()).norm() < 1e-15);
/// ```
pub fn rotation(turn: &Vector3<f64>) -> UnitQuaternion<f64> {
    if !turn.norm_squared().is_finite() {
        return UnitQuaternion::identity();
    }
    let (mut half, mut halvings) = (0.5 * turn, 0);
    while half.norm_squared() > SMALL * SMALL {
        half *= 0.5;
        halvings += 1;
    }
    let square = half.norm_squared();
    // 1 - x^2 / (m (m + 1)) (1 - ...): cosine from m = 1, sine over its angle from m = 2.
    let series = |first: u32| {
        let factor = |k: u32| f64::from(first + 2 * k) * f64::from(first + 2 * k + 1);
        (0..TERMS).rev().fold(1.0, |sum, k| 1.0 - sum * square / factor(k))
    };
    let mut q = Quaternion::from_parts(series(1), half * series(2));
    for _ in 0..halvings {
        q *= q;
    }
    UnitQuaternion::new_normalize(q)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_those_of_the_library() {
        let axis = Vector3::new(2.0, -3.0, 6.0) / 7.0;
        let mut angle = 2f64.powi(-40);
        while angle < 2f64.powi(12) {
            let (q, right) = (rotation(&(angle * axis)), (0.5 * angle).sin_cos());
            // The sign counts too: it is the exponential, and not only the same rotation.
            let off = (q.imag() - axis * right.0).norm().max((q.w - right.1).abs());
            assert!(off <= 8.0 * f64::EPSILON * angle.max(1.0), "{angle}: {off:e}");
            angle *= 1.37;
        }
    }

    #[test]
    fn nothing_turns_nothing() {
        assert_eq!(rotation(&Vector3::zeros()), UnitQuaternion::identity());
        assert_eq!(rotation(&Vector3::new(f64::NAN, 0.0, 1.0)), UnitQuaternion::identity());
        assert_eq!(rotation(&Vector3::new(1e200, 0.0, 0.0)), UnitQuaternion::identity());
    }
}
