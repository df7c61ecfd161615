//! Air resistance in a wind w: linear, F = -k (v - w), or quadratic, F = -1/2 rho C A |v - w| (v - w).

use crate::body::{Ball, State};
use crate::counters::Counters;
use crate::effects::Flow;
use crate::error::{ValueError, require, require_finite};
use nalgebra::Vector3;

/// How the resistance grows with the speed relative to the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Law {
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

    pub(crate) fn law(&self) -> Law {
        self.law
    }

    /// The wind in m/s.
    pub fn wind(&self) -> Vector3<f64> {
        self.wind
    }
}

impl Flow for Drag {
    fn name(&self) -> &'static str {
        "drag"
    }

    fn acceleration(&self, state: &State, ball: &Ball) -> Vector3<f64> {
        let relative = state.velocity - self.wind;
        let force_per_speed = match self.law {
            Law::Linear(k) => k,
            Law::Quadratic(c_rho) => {
                let area = std::f64::consts::PI * ball.radius() * ball.radius();
                0.5 * c_rho * area * relative.norm()
            }
        };
        // The plan refuses drag on a ball without a mass.
        relative * (-force_per_speed / ball.mass().unwrap_or(f64::INFINITY))
    }

    fn calms_to(&self) -> Option<Vector3<f64>> {
        Some(self.wind)
    }

    fn count(&self, counters: &mut Counters) {
        counters.drag += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    fn ball() -> Ball {
        Ball::new(Point3::origin(), Vector3::zeros(), 0.5, Some(2.0)).unwrap()
    }

    fn moving(velocity: Vector3<f64>) -> State {
        State { position: Point3::origin(), velocity }
    }

    #[test]
    fn linear_drag_is_k_over_m_times_the_relative_velocity() {
        let drag = Drag::linear(3.0).unwrap().in_wind(Vector3::new(1.0, 0.0, 0.0)).unwrap();
        let a = drag.acceleration(&moving(Vector3::new(5.0, 2.0, 0.0)), &ball());
        assert_eq!(a, Vector3::new(-6.0, -3.0, 0.0));
    }

    #[test]
    fn quadratic_drag_grows_with_the_square_of_the_relative_speed() {
        let drag = Drag::quadratic(0.5, 1.2).unwrap();
        let slow = drag.acceleration(&moving(Vector3::new(0.0, 0.0, 2.0)), &ball());
        let fast = drag.acceleration(&moving(Vector3::new(0.0, 0.0, 4.0)), &ball());
        assert_eq!(fast, 4.0 * slow);
        let area = std::f64::consts::PI * 0.25;
        assert!((slow.z + 0.5 * 1.2 * 0.5 * area * 4.0 / 2.0).abs() < 1e-15);
    }

    #[test]
    fn values_that_mean_nothing_are_refused() {
        assert!(Drag::linear(-1.0).is_err());
        assert!(Drag::quadratic(f64::NAN, 1.0).is_err());
        assert!(Drag::linear(1.0).unwrap().in_wind(Vector3::new(f64::INFINITY, 0.0, 0.0)).is_err());
    }
}
