//! How a ball turns: rotations of the four operations and square roots, the same bits on every machine, unlike a library's sine.

use crate::effects::spin_decay::SpinDecay;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Half an angle up to this is what the series is for.
const SMALL: f64 = 0.25;

/// Terms of the series: for angles that small, what comes after them is below the unit roundoff.
const TERMS: u32 = 8;

/// More steps than this do not follow an axis any better than the eye does.
const MOST_STEPS: f64 = 4096.0;

/// The rotation by `turn`: about its direction, by its length in rad, to a few units of roundoff of max(1, its length). None at all where it is not
/// finite.
///
/// It is the exponential of half of `turn` as a quaternion: that of a small share of it by Taylor's series, squared as often as the share was halved.
///
/// ```
/// use carom_dynamics::nalgebra::Vector3;
/// use carom_dynamics::turning::rotation;
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

/// The angular velocity during a stretch of motion: it decays, or changes evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turning {
    /// At the start, in rad/s.
    pub from: Vector3<f64>,
    /// At the end, in rad/s, but for its decay.
    pub to: Vector3<f64>,
    /// How it decays, if it does.
    pub decay: Option<SpinDecay>,
}

impl Turning {
    /// The angular velocity in rad/s after `seconds` of the `whole` (s).
    pub fn at(&self, seconds: f64, whole: f64) -> Vector3<f64> {
        match self.decay {
            Some(decay) => decay.after(&self.from, seconds),
            None if self.from == self.to || whole <= 0.0 => self.to,
            None => self.from + (self.to - self.from) * (seconds / whole).clamp(0.0, 1.0),
        }
    }

    /// How the ball has turned after `seconds` of the `whole` (s), in the axes of the scene.
    ///
    /// Exact where the axis stands still, as it does in flight and where a ball slips or rolls straight on. An axis that turns evenly is followed in
    /// steps of less than half a radian by the first two terms of Magnus's series (W. Magnus, *On the exponential solution of differential
    /// equations for a linear operator*, 1954): the mean of the angular velocity, and (end x start) t^2 / 12.
    pub fn rotation(&self, seconds: f64, whole: f64) -> UnitQuaternion<f64> {
        if let Some(decay) = self.decay {
            return rotation(&(self.from * decay.lasting(seconds)));
        }
        let now = self.at(seconds, whole);
        let steps = Self::steps(&self.from, &now, seconds);
        let step = seconds / f64::from(steps);
        let at = |k: u32| self.from + (now - self.from) * (f64::from(k) / f64::from(steps));
        (0..steps).fold(UnitQuaternion::identity(), |turned, k| {
            let (before, after) = (at(k), at(k + 1));
            let turn = (before + after) * (0.5 * step) + after.cross(&before) * (step * step / 12.0);
            rotation(&turn) * turned
        })
    }

    /// In how many steps an axis is followed that turns from one angular velocity to the other: one where it does not.
    fn steps(from: &Vector3<f64>, to: &Vector3<f64>, seconds: f64) -> u32 {
        let turn = from.norm().max(to.norm()) * seconds;
        let twist = from.cross(to).norm() * seconds * seconds;
        // Of a twist that is small, the series leaves its share of the square of the turn.
        (8.0 * twist.sqrt()).min(2.0 * turn).ceil().clamp(1.0, MOST_STEPS) as u32
    }
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

    #[test]
    fn an_axis_that_turns_is_followed() {
        let (from, to) = (Vector3::new(-60.0, -60.0, 0.0), Vector3::new(-17.0, 18.0, 5.0));
        let turning = Turning { from, to, decay: None };
        // By brute force: a million steps about the axis in the middle of each.
        const STEPS: u32 = 1 << 20;
        let step = 0.5 / f64::from(STEPS);
        let turn = |q, k: u32| rotation(&(turning.at((f64::from(k) + 0.5) * step, 0.5) * step)) * q;
        let right = (0..STEPS).fold(UnitQuaternion::identity(), turn);
        assert!(turning.rotation(0.5, 0.5).angle_to(&right) < 1e-3);
        // In two parts it is the same.
        let rest = Turning { from: turning.at(0.2, 0.5), ..turning };
        let parts = rest.rotation(0.3, 0.3) * turning.rotation(0.2, 0.5);
        assert!(parts.angle_to(&right) < 1e-3);
    }

    #[test]
    fn an_axis_that_stands_still_is_exact() {
        let turning = Turning { from: Vector3::new(0.0, 10.0, 0.0), to: Vector3::new(0.0, 30.0, 0.0), decay: None };
        let right = rotation(&Vector3::new(0.0, 40.0, 0.0));
        assert!(turning.rotation(2.0, 2.0).angle_to(&right) < 1e-13);
    }
}
