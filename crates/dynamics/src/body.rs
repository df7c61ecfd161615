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

/// The moment of inertia of a solid sphere about its centre, in units of m r^2.
pub const SOLID_SPHERE: f64 = 0.4;

/// A ball: where it starts, how fast, how large, how heavy; and what only some effects ask for, its spin and how its mass lies.
///
/// ```
/// use carom_dynamics::body::Ball;
/// use carom_dynamics::nalgebra::{Point3, Vector3};
///
/// // A tennis ball 1 m up, at 20 m/s with topspin: its mass is needed only by effects that divide a force by it.
/// let ball = Ball::new(Point3::new(0.0, 0.0, 1.0), Vector3::new(20.0, 0.0, 0.0), 0.0335, Some(0.0577))?;
/// let ball = ball.spinning(Vector3::new(0.0, 200.0, 0.0))?.with_drag(0.55)?;
/// assert_eq!((ball.radius(), ball.spin().y), (0.0335, 200.0));
/// // What cannot be is refused, and the error says what could.
/// let error = Ball::new(Point3::origin(), Vector3::zeros(), -1.0, None).unwrap_err();
/// assert_eq!(error.to_string(), "radius is -1, but must be finite and >= 0, in m");
/// # Ok::<(), carom_dynamics::error::ValueError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    start: State,
    radius: f64,
    mass: Option<f64>,
    spin: Vector3<f64>,
    inertia: f64,
    drag: Option<f64>,
    restitution: Option<f64>,
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
        require("radius", radius, "finite and >= 0, in m", radius.is_finite() && radius >= 0.0)?;
        if let Some(mass) = mass {
            require("mass", mass, "finite and > 0, in kg", mass.is_finite() && mass > 0.0)?;
        }
        let (spin, inertia) = (Vector3::zeros(), SOLID_SPHERE);
        let start = State { position: Point3::origin(), velocity: Vector3::zeros() };
        Self { start, radius, mass, spin, inertia, drag: None, restitution: None }.starting(position, velocity)
    }

    /// The same with the angular velocity `spin` in rad/s, right-handed.
    pub fn spinning(self, spin: Vector3<f64>) -> Result<Self, ValueError> {
        require_finite("spin", &spin)?;
        Ok(Self { spin, ..self })
    }

    /// The same with the moment of inertia `alpha` m r^2: [`SOLID_SPHERE`] if not given, 2/3 for a thin shell.
    pub fn with_inertia(self, alpha: f64) -> Result<Self, ValueError> {
        let inertia = require("inertia", alpha, "above 0, and 1 at most", alpha > 0.0 && alpha <= 1.0)?;
        Ok(Self { inertia, ..self })
    }

    /// The same with a drag coefficient of its own, which a drag law may ask for.
    pub fn with_drag(self, coefficient: f64) -> Result<Self, ValueError> {
        let ok = coefficient.is_finite() && coefficient >= 0.0;
        require("drag", coefficient, "finite and >= 0", ok)?;
        Ok(Self { drag: Some(coefficient), ..self })
    }

    /// The same with a coefficient of restitution of its own, in [0, 1], which a surface may ask for.
    pub fn with_restitution(self, c_r: f64) -> Result<Self, ValueError> {
        require("restitution", c_r, "between 0 and 1", (0.0..=1.0).contains(&c_r))?;
        Ok(Self { restitution: Some(c_r), ..self })
    }

    /// The same with another start: its centre at `position` (m), with `velocity` (m/s).
    pub fn starting(self, position: Point3<f64>, velocity: Vector3<f64>) -> Result<Self, ValueError> {
        require_finite("position", &position.coords)?;
        require_finite("velocity", &velocity)?;
        Ok(Self { start: State { position, velocity }, ..self })
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

    /// The angular velocity at the start, in rad/s.
    pub fn spin(&self) -> Vector3<f64> {
        self.spin
    }

    /// The moment of inertia in units of m r^2.
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// Its own drag coefficient, if it has one.
    pub fn drag(&self) -> Option<f64> {
        self.drag
    }

    /// Its own coefficient of restitution, if it has one.
    pub fn restitution(&self) -> Option<f64> {
        self.restitution
    }

    /// Its volume in m^3.
    pub fn volume(&self) -> f64 {
        4.0 / 3.0 * std::f64::consts::PI * self.radius * self.radius * self.radius
    }
}

/// A ball as the effects on its flight see it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Radius in m.
    pub radius: f64,
    /// What a force is divided by to be an acceleration, in kg: the mass, and what it takes along of the air.
    pub inertia: f64,
    /// Its own drag coefficient.
    pub drag: f64,
    /// Angular velocity in rad/s.
    pub spin: Vector3<f64>,
}

impl Body {
    /// The cross section, pi r^2, in m^2.
    pub fn area(&self) -> f64 {
        std::f64::consts::PI * self.radius * self.radius
    }
}
