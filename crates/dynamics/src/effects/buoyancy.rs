//! Buoyancy, and the air that an accelerating ball takes along: (m + C_a rho V) dv/dt = (m - rho V) g + other forces.
//!
//! Archimedes' force is that on the displaced air; the added mass of a sphere is C_a = 1/2 of it (G. G. Stokes, 1843; L. D. Landau, E. M.
//! Lifshitz, *Fluid Mechanics*). Both are constant, so that a flight without other effects stays an exact parabola. An
//! impact is too short for the air: it is answered with the mass alone.

use crate::body::Ball;
use crate::error::{ValueError, require};
use nalgebra::Vector3;

/// The added mass of a sphere, in units of the mass of the displaced air.
pub const ADDED_MASS: f64 = 0.5;

/// Buoyancy in air, or another fluid, with added mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Buoyancy {
    density: f64,
}

impl Buoyancy {
    /// In a fluid of `density` in kg/m^3.
    pub fn new(density: f64) -> Result<Self, ValueError> {
        let ok = density.is_finite() && density >= 0.0;
        require("air density", density, "finite and >= 0, in kg/m^3", ok).map(|density| Self { density })
    }

    /// Whether it does nothing.
    pub fn is_none(&self) -> bool {
        self.density == 0.0
    }

    /// The density of the fluid in kg/m^3.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// The mass in kg of the fluid that `ball` displaces.
    pub fn displaced(&self, ball: &Ball) -> f64 {
        self.density * ball.volume()
    }

    /// What a force on `ball` of `mass` (kg) is divided by, in kg.
    pub fn inertia(&self, ball: &Ball, mass: f64) -> f64 {
        mass + ADDED_MASS * self.displaced(ball)
    }

    /// The acceleration in m/s^2 that is left of gravity `g` for `ball` of `mass` (kg).
    pub fn weight(&self, g: &Vector3<f64>, ball: &Ball, mass: f64) -> Vector3<f64> {
        g * ((mass - self.displaced(ball)) / self.inertia(ball, mass))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn a_ball_as_light_as_the_air_hovers_and_one_of_nothing_rises_at_2_g() {
        let ball = Ball::new(Point3::origin(), Vector3::zeros(), 0.5, None).unwrap();
        let air = Buoyancy::new(1.25).unwrap();
        let g = Vector3::new(0.0, 0.0, -9.81);
        let displaced = air.displaced(&ball);
        assert_eq!(air.weight(&g, &ball, displaced), Vector3::zeros() * -1.0);
        assert!((air.weight(&g, &ball, 0.0) + 2.0 * g).norm() < 1e-15);
        assert!((displaced - 1.25 * std::f64::consts::PI / 6.0).abs() < 1e-15);
        assert!(Buoyancy::new(-1.0).is_err() && Buoyancy::new(0.0).unwrap().is_none());
    }
}
