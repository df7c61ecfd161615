//! Air resistance in a wind w: linear, F = -k (v - w), or quadratic, F = -1/2 rho C A |v - w| (v - w).
//!
//! Linear drag is the book's (chapter 2). The coefficient C of the quadratic law is a constant, or that of a smooth sphere, which
//! depends on the Reynolds number Re = rho |v - w| 2 r / mu.

use crate::body::{Body, State};
use crate::counters::Counters;
use crate::effects::Flow;
use crate::error::{ValueError, require, require_finite};
use crate::power::power;
use nalgebra::Vector3;

/// How the resistance grows with the speed relative to the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Law {
    /// F = -k (v - w), k in kg/s.
    Linear(f64),
    /// F = -1/2 rho C A |v - w| (v - w).
    Quadratic { coefficient: f64, density: f64 },
    /// The same with the C of each ball; holds rho in kg/m^3.
    OfBall(f64),
    /// The same with C of a smooth sphere at its Reynolds number.
    Sphere { density: f64, viscosity: f64 },
}

/// C Re of a smooth sphere where the flow creeps (Stokes).
const STOKES: f64 = 24.0;

/// C of a smooth sphere at the Reynolds number `re`, up to 10^6: data correlation of F. A. Morrison, *An Introduction to Fluid
/// Mechanics* (2013), chapter 8.
pub fn sphere_coefficient(re: f64) -> f64 {
    STOKES / re + beyond_stokes(re)
}

/// The same without the creeping flow's 24 / Re, which grows beyond all bounds as the ball stops.
fn beyond_stokes(re: f64) -> f64 {
    let (wake, crisis, turbulent) = (re / 5.0, re / 263_000.0, re / 1_000_000.0);
    // a^-7.94 / (1 + a^-8) = a^0.06 / (a^8 + 1), without a negative power of a small number.
    let eighth = {
        let square = crisis * crisis;
        let fourth = square * square;
        fourth * fourth
    };
    2.6 * wake / (1.0 + power(wake, 1.52))
        + 0.411 * power(crisis, 0.06) / (eighth + 1.0)
        + 0.25 * turbulent / (1.0 + turbulent)
}

/// Air resistance; wind is part of it, because without resistance wind does nothing.
///
/// ```
/// use carom_dynamics::effects::drag::Drag;
/// use carom_dynamics::nalgebra::Vector3;
///
/// // The book's linear law in a wind of 2 m/s, and the quadratic one of a sphere in air.
/// let book = Drag::linear(0.05)?.in_wind(Vector3::new(2.0, 0.0, 0.0))?;
/// let sphere = Drag::quadratic(0.47, 1.204)?;
/// assert_eq!((book.wind().x, book.is_linear(), sphere.is_linear()), (2.0, true, false));
/// # Ok::<(), carom_dynamics::error::ValueError>(())
/// ```
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
        Ok(Self { law: Law::Quadratic { coefficient, density }, wind: Vector3::zeros() })
    }

    /// The quadratic law with the drag coefficient of each ball, in still air of `density` rho in kg/m^3.
    pub fn of_ball(density: f64) -> Result<Self, ValueError> {
        let ok = density.is_finite() && density >= 0.0;
        require("air density", density, "finite and >= 0, in kg/m^3", ok)?;
        Ok(Self { law: Law::OfBall(density), wind: Vector3::zeros() })
    }

    /// The drag of a smooth sphere, whose coefficient follows from its speed, in still air of `density` rho in kg/m^3 and `viscosity` mu in
    /// Pa s; right up to a Reynolds number of 10^6. See [`sphere_coefficient`].
    pub fn sphere(density: f64, viscosity: f64) -> Result<Self, ValueError> {
        let ok = density.is_finite() && density >= 0.0;
        require("air density", density, "finite and >= 0, in kg/m^3", ok)?;
        require("air viscosity", viscosity, "finite and > 0, in Pa s", viscosity.is_finite() && viscosity > 0.0)?;
        Ok(Self { law: Law::Sphere { density, viscosity }, wind: Vector3::zeros() })
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

    /// The density of the air in kg/m^3, if the law names it.
    pub fn density(&self) -> Option<f64> {
        match self.law() {
            Law::Linear(_) => None,
            Law::Quadratic { density, .. } | Law::OfBall(density) | Law::Sphere { density, .. } => Some(density),
        }
    }

    /// Whether it resists nothing: then it is not even asked.
    pub fn is_none(&self) -> bool {
        match self.law {
            Law::Linear(k) => k == 0.0,
            Law::Quadratic { coefficient, density } => coefficient * density == 0.0,
            Law::OfBall(density) | Law::Sphere { density, .. } => density == 0.0,
        }
    }

    /// Whether it asks each ball for its drag coefficient.
    pub fn is_of_ball(&self) -> bool {
        matches!(self.law, Law::OfBall(_))
    }

    /// Whether its force is in proportion to the relative speed.
    pub fn is_linear(&self) -> bool {
        matches!(self.law, Law::Linear(_))
    }

    /// The force over the relative speed, in kg/s, on `body` at the relative speed `speed` (m/s).
    pub fn force_per_speed(&self, speed: f64, body: &Body) -> f64 {
        match self.law {
            Law::Linear(k) => k,
            Law::Quadratic { coefficient, density } => 0.5 * (coefficient * density) * body.area() * speed,
            Law::OfBall(density) => 0.5 * (body.drag * density) * body.area() * speed,
            Law::Sphere { density, viscosity } => {
                let re = density * speed * (2.0 * body.radius) / viscosity;
                let creeping = STOKES / 4.0 * std::f64::consts::PI * viscosity * body.radius;
                creeping + 0.5 * density * body.area() * speed * beyond_stokes(re)
            }
        }
    }
}

impl Flow for Drag {
    fn name(&self) -> &'static str {
        "drag"
    }

    fn acceleration(&self, state: &State, body: &Body) -> Vector3<f64> {
        let relative = state.velocity - self.wind;
        relative * (-self.force_per_speed(relative.norm(), body) / body.inertia)
    }

    fn calms_to(&self) -> Option<Vector3<f64>> {
        Some(self.wind)
    }

    fn rate(&self, body: &Body) -> Option<f64> {
        match self.law {
            Law::Linear(k) => Some(k / body.inertia),
            _ => None,
        }
    }

    fn count(&self, counters: &mut Counters) {
        counters.drag += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    const BODY: Body = Body { radius: 0.5, inertia: 2.0, drag: 0.5, spin: Vector3::new(0.0, 0.0, 0.0) };

    fn moving(velocity: Vector3<f64>) -> State {
        State { position: Point3::origin(), velocity }
    }

    #[test]
    fn linear_drag_is_k_over_m_times_the_relative_velocity() {
        let drag = Drag::linear(3.0).unwrap().in_wind(Vector3::new(1.0, 0.0, 0.0)).unwrap();
        let a = drag.acceleration(&moving(Vector3::new(5.0, 2.0, 0.0)), &BODY);
        assert_eq!(a, Vector3::new(-6.0, -3.0, 0.0));
    }

    #[test]
    fn quadratic_drag_grows_with_the_square_of_the_relative_speed() {
        let drag = Drag::quadratic(0.5, 1.2).unwrap();
        let slow = drag.acceleration(&moving(Vector3::new(0.0, 0.0, 2.0)), &BODY);
        let fast = drag.acceleration(&moving(Vector3::new(0.0, 0.0, 4.0)), &BODY);
        assert_eq!(fast, 4.0 * slow);
        let area = std::f64::consts::PI * 0.25;
        assert!((slow.z + 0.5 * 1.2 * 0.5 * area * 4.0 / 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_creeping_sphere_feels_the_drag_of_stokes_and_a_standing_one_none() {
        let viscosity = 1e3;
        let drag = Drag::sphere(1.2, viscosity).unwrap();
        let stokes = 6.0 * std::f64::consts::PI * viscosity * BODY.radius;
        let force = -drag.acceleration(&moving(Vector3::new(1e-9, 0.0, 0.0)), &BODY).x * BODY.inertia;
        assert!((force / (stokes * 1e-9) - 1.0).abs() < 1e-9);
        assert_eq!(drag.acceleration(&moving(Vector3::zeros()), &BODY), Vector3::zeros());
    }

    #[test]
    fn the_coefficient_of_a_sphere_is_that_of_the_correlation_and_of_the_measured_curve() {
        // As the book has it, with the library's powers.
        let book = |re: f64| {
            let (a, b, c): (f64, f64, f64) = (re / 5.0, re / 2.63e5, re / 1e6);
            24.0 / re
                + 2.6 * a / (1.0 + a.powf(1.52))
                + 0.411 * b.powf(-7.94) / (1.0 + b.powf(-8.0))
                + 0.25 * c / (1.0 + c)
        };
        for k in 0..=36 {
            let re = 10f64.powf(-3.0 + 0.25 * f64::from(k));
            assert!((sphere_coefficient(re) / book(re) - 1.0).abs() < 1e-12, "{re}");
        }
        // Schlichting's curve: 0.4 to 0.5 over the plateau, and the crisis near 3e5.
        assert!((0.35..0.5).contains(&sphere_coefficient(1e4)) && (0.4..0.55).contains(&sphere_coefficient(1e5)));
        assert!(sphere_coefficient(4e5) < 0.2);
    }

    #[test]
    fn values_that_mean_nothing_are_refused() {
        assert!(Drag::linear(-1.0).is_err());
        assert!(Drag::quadratic(f64::NAN, 1.0).is_err());
        assert!(Drag::sphere(1.2, 0.0).is_err() && Drag::sphere(-1.2, 1.0).is_err());
        assert!(Drag::linear(1.0).unwrap().in_wind(Vector3::new(f64::INFINITY, 0.0, 0.0)).is_err());
    }
}
