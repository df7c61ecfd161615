//! The Magnus force on a spinning ball in a wind w: F = 1/2 rho A C_L |v - w|^2 along omega x (v - w).
//!
//! The lift coefficient is C_L = K S in proportion to the spin parameter S = r |omega| / |v - w|, so that F = 1/2 rho A K r omega x (v - w):
//! no direction is undefined, and a ball at rest in the air feels none. On baseballs C_L is about S, K = 1, up to S = 0.3 (A. M. Nathan, *The
//! effect of spin on the flight of a baseball*, Am. J. Phys. 76 (2008) 119); it grows more slowly beyond, which the law does not know.

use crate::body::{Body, State};
use crate::counters::Counters;
use crate::effects::Flow;
use crate::error::{ValueError, require, require_finite};
use nalgebra::Vector3;

/// The Magnus force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Magnus {
    /// K rho in kg/m^3.
    k_rho: f64,
    wind: Vector3<f64>,
}

impl Magnus {
    /// With the lift coefficient `per_spin` times S, in still air of `density` in kg/m^3.
    pub fn new(per_spin: f64, density: f64) -> Result<Self, ValueError> {
        let ok = |x: f64| x.is_finite() && x >= 0.0;
        require("lift coefficient", per_spin, "finite and >= 0", ok(per_spin))?;
        require("air density", density, "finite and >= 0, in kg/m^3", ok(density))?;
        Ok(Self { k_rho: per_spin * density, wind: Vector3::zeros() })
    }

    /// The same in a wind `w` in m/s.
    pub fn in_wind(self, wind: Vector3<f64>) -> Result<Self, ValueError> {
        require_finite("wind", &wind)?;
        Ok(Self { wind, ..self })
    }

    /// K rho in kg/m^3, and the wind in m/s.
    pub(crate) fn parts(&self) -> (f64, Vector3<f64>) {
        (self.k_rho, self.wind)
    }

    /// Whether it does nothing, however fast a ball spins.
    pub fn is_none(&self) -> bool {
        self.k_rho == 0.0
    }
}

impl Flow for Magnus {
    fn name(&self) -> &'static str {
        "the Magnus force"
    }

    fn acceleration(&self, state: &State, body: &Body) -> Vector3<f64> {
        let relative = state.velocity - self.wind;
        body.spin.cross(&relative) * (0.5 * self.k_rho * body.area() * body.radius / body.inertia)
    }

    fn calms_to(&self) -> Option<Vector3<f64>> {
        None
    }

    fn count(&self, counters: &mut Counters) {
        counters.magnus += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn backspin_lifts_in_proportion_to_spin_and_speed_and_does_no_work() {
        let magnus = Magnus::new(0.5, 1.25).unwrap().in_wind(Vector3::new(-2.0, 0.0, 0.0)).unwrap();
        let body = Body { radius: 0.5, inertia: 2.0, drag: 0.0, spin: Vector3::new(0.0, -10.0, 0.0) };
        let state = State { position: Point3::origin(), velocity: Vector3::new(6.0, 0.0, 0.0) };
        let a = magnus.acceleration(&state, &body);
        // 1/2 rho A C_L u^2 / m with C_L = K r omega / u.
        let right = 0.5 * 1.25 * std::f64::consts::PI * 0.25 * (0.5 * 0.5 * 10.0 / 8.0) * 64.0 / 2.0;
        assert!((a.z / right - 1.0).abs() < 1e-15 && a.x == 0.0 && a.y == 0.0, "{a}");
    }

    #[test]
    fn values_that_mean_nothing_are_refused() {
        assert!(Magnus::new(-1.0, 1.0).is_err() && Magnus::new(1.0, f64::INFINITY).is_err());
        assert!(Magnus::new(0.0, 1.0).unwrap().is_none());
    }
}
