//! Air resistance in a wind w: linear, F = -k (v - w), or quadratic, F = -1/2 rho C A |v - w| (v - w).

use crate::error::{ValueError, require, require_finite};
use nalgebra::Vector3;

/// How the resistance grows with the speed relative to the air.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    /// F = -k (v - w), k in kg/s.
    Linear(f64),
    /// F = -1/2 rho C A |v - w| (v - w); holds C rho in kg/m^3.
    Quadratic(f64),
}

/// Air resistance; wind is part of it, because without resistance wind does nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag {
    law: Law,
    wind: Vector3<f64>,
}

impl Drag {
    /// The book's law: F = -k (v - w) with `k` in kg/s, in still air.
    pub fn linear(k: f64) -> Result<Self, ValueError> {
        let k = require("linear drag", k, "finite and >= 0, in kg/s", k.is_finite() && k >= 0.0)?;
        Ok(Self { law: Law::Linear(k), wind: Vector3::zeros() })
    }

    /// F = -1/2 rho C A |v - w| (v - w) with drag `coefficient` C (no unit), air `density` rho in kg/m^3 and A = pi r^2, in
    /// still air.
    pub fn quadratic(coefficient: f64, density: f64) -> Result<Self, ValueError> {
        let ok = |x: f64| x.is_finite() && x >= 0.0;
        require("drag coefficient", coefficient, "finite and >= 0", ok(coefficient))?;
        require("air density", density, "finite and >= 0, in kg/m^3", ok(density))?;
        Ok(Self { law: Law::Quadratic(coefficient * density), wind: Vector3::zeros() })
    }

    /// The same in a wind `w` in m/s.
    pub fn in_wind(self, wind: Vector3<f64>) -> Result<Self, ValueError> {
        require_finite("wind", &wind)?;
        Ok(Self { wind, ..self })
    }

    /// The wind in m/s.
    pub fn wind(&self) -> Vector3<f64> {
        self.wind
    }

    /// The acceleration in m/s^2 at `velocity` (m/s) of a ball of `radius` (m) and `mass` (kg).
    pub fn acceleration(&self, velocity: &Vector3<f64>, radius: f64, mass: f64) -> Vector3<f64> {
        let relative = velocity - self.wind;
        let per_speed = match self.law {
            Law::Linear(k) => k / mass,
            Law::Quadratic(c_rho) => {
                0.5 * c_rho * std::f64::consts::PI * radius * radius * relative.norm() / mass
            }
        };
        -relative * per_speed
    }
}
