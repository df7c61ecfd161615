//! Uniform gravity: a = g.

use crate::error::{ValueError, require_finite};
use nalgebra::Vector3;

/// A uniform acceleration in m/s^2, the same everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity(Vector3<f64>);

impl Gravity {
    /// Gravity `g` in m/s^2, such as (0, 0, -9.81).
    pub fn uniform(g: Vector3<f64>) -> Result<Self, ValueError> {
        require_finite("gravity", &g)?;
        Ok(Self(g))
    }

    /// The acceleration in m/s^2.
    pub fn acceleration(&self) -> Vector3<f64> {
        self.0
    }
}
