//! The decay of spin in the air: omega(t) = omega(0) e^(-t / tau).
//!
//! The torque of the air is taken in proportion to the spin, so that a ball loses the same share of it in every second: 3.3 to 4 % on golf
//! balls, which is tau of 25 to 30 s (D. Tutelman, *Spin Decay for a Ball in Flight*, 2016). How tau depends on the ball and its speed: A. M.
//! Nathan, *The Effect of Spin-Down on the Flight of a Baseball* (2008), from measurements by A. J. Smits and D. R. Smith, *A new aerodynamic
//! model of a golf ball in flight*, Science and Golf II (1994).

use crate::error::{ValueError, require};
use crate::power::exponential;
use nalgebra::Vector3;

/// The loss of spin in flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpinDecay(f64);

impl SpinDecay {
    /// With the time constant `tau` in s, in which the spin falls to 1/e.
    pub fn new(tau: f64) -> Result<Self, ValueError> {
        require("spin decay", tau, "finite and > 0, in s", tau.is_finite() && tau > 0.0).map(Self)
    }

    /// tau in s.
    pub fn time_constant(&self) -> f64 {
        self.0
    }

    /// What is left of `spin` (rad/s) after `seconds` >= 0.
    pub fn after(&self, spin: &Vector3<f64>, seconds: f64) -> Vector3<f64> {
        spin * exponential(-seconds / self.0)
    }

    /// How long the spin of the start would turn the ball as far as it does in `seconds` >= 0, decaying: tau (1 - e^(-t / tau)), in s.
    pub fn lasting(&self, seconds: f64) -> f64 {
        self.0 * (1.0 - exponential(-seconds / self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_time_constant_leaves_1_over_e() {
        let decay = SpinDecay::new(25.0).unwrap();
        let spin = Vector3::new(0.0, -300.0, 4.0);
        assert_eq!(decay.after(&spin, 0.0), spin);
        assert_eq!(decay.lasting(0.0), 0.0);
        // In all it turns as far as in one time constant without decay.
        assert_eq!(decay.lasting(1e6), 25.0);
        assert!((decay.after(&spin, 50.0) - spin * (-2f64).exp()).norm() < 1e-12);
        assert!(SpinDecay::new(0.0).is_err() && SpinDecay::new(f64::NAN).is_err());
    }
}
