//! The ball and its state.

use crate::error::{ValueError, require, require_finite};
use nalgebra::{Point3, Vector3};

/// Position in m and velocity in m/s of a ball's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Centre, in m.
    pub position: Point3<f64>,
    /// Velocity, in m/s.
    pub velocity: Vector3<f64>,
}

/// A ball that does not rotate: where it starts, how fast, how large, how heavy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    start: State,
    radius: f64,
    mass: Option<f64>,
}

impl Ball {
    /// A ball with its centre at `position` (m), `velocity` (m/s), `radius` (m, 0 is a point) and `mass` (kg, needed only
    /// by effects that divide a force by it).
    pub fn new(
        position: Point3<f64>,
        velocity: Vector3<f64>,
        radius: f64,
        mass: Option<f64>,
    ) -> Result<Self, ValueError> {
        require_finite("position", &position.coords)?;
        require_finite("velocity", &velocity)?;
        require("radius", radius, "finite and >= 0, in m", radius.is_finite() && radius >= 0.0)?;
        if let Some(mass) = mass {
            require("mass", mass, "finite and > 0, in kg", mass.is_finite() && mass > 0.0)?;
        }
        Ok(Self { start: State { position, velocity }, radius, mass })
    }

    /// Where the ball starts, and how fast.
    pub fn start(&self) -> State {
        self.start
    }

    /// Radius in m; 0 is a point.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Mass in kg, if one was given.
    pub fn mass(&self) -> Option<f64> {
        self.mass
    }
}
