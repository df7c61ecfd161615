//! Integrators: each turns a state and a timestep into a path and the velocity along it.

pub mod adaptive;
pub mod euler;
pub mod exact;
pub mod rk4;

use crate::body::State;
use carom_geometry::clearance::MAX_DEGREE;
use carom_geometry::path::Path;
use nalgebra::Vector3;

/// A step: the path of the centre over f in [0, `to`], and the velocity along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// The centre's path; f = 1 is `seconds` after the start.
    pub path: Path,
    /// The velocity v(f) = v0 + v1 f + v2 f^2 ..., in m/s.
    pub velocity: [Vector3<f64>; MAX_DEGREE + 1],
    /// The time from f = 0 to f = 1, in s.
    pub seconds: f64,
    /// Where the step ends; 1 but for a flight that is exact for any length.
    pub to: f64,
}

impl Step {
    /// Position and velocity at `f`.
    pub fn at(&self, f: f64) -> State {
        let velocity = self.velocity.iter().rev().fold(Vector3::zeros(), |sum, v| sum * f + v);
        State { position: self.path.at(f), velocity }
    }

    /// The state at the end of the step.
    pub fn end(&self) -> State {
        self.at(self.to)
    }

    /// The time from the start to `f`, in s.
    pub fn time(&self, f: f64) -> f64 {
        f * self.seconds
    }
}
