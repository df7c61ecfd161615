//! What is wanted: the surfaces, the balls, the effects and the method.

use crate::body::Ball;
use crate::effects::buoyancy::Buoyancy;
use crate::effects::drag::Drag;
use crate::effects::friction::Friction;
use crate::effects::gravity::Gravity;
use crate::effects::magnus::Magnus;
use crate::effects::spin_decay::SpinDecay;
use crate::surface::Surface;
use crate::tolerance::RestThresholds;
use nalgebra::Vector3;

/// How flights are computed.
///
/// ```
/// use carom_dynamics::body::Ball;
/// use carom_dynamics::effects::gravity::Gravity;
/// use carom_dynamics::nalgebra::{Point3, Vector3};
/// use carom_dynamics::plan::Plan;
/// use carom_dynamics::scene::{Method, Scene};
/// use carom_dynamics::simulate::simulate;
///
/// // The chapter's Euler method falls too far by g h t / 2, whatever else is right.
/// let fall = |method| {
///     let gravity = Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0))?);
///     let balls = vec![Ball::new(Point3::origin(), Vector3::zeros(), 0.0, None)?];
///     let plan = Plan::new(&Scene { gravity, balls, method: Some(method), ..Scene::lasting(1.0) })?;
///     Ok::<f64, Box<dyn std::error::Error>>(simulate(&plan, &plan.balls()[0], &mut ()).state.position.z)
/// };
/// assert_eq!(fall(Method::Exact)?, -4.0);
/// assert_eq!(fall(Method::Euler { step: 0.125 })?, -4.0 + 8.0 * 0.125 / 2.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Exact parabolas and straight lines; only under constant acceleration.
    Exact,
    /// Explicit Euler, the chapter's: order 1.
    Euler {
        /// h in s.
        step: f64,
    },
    /// Semi-implicit (symplectic) Euler: order 1.
    SemiImplicitEuler {
        /// h in s.
        step: f64,
    },
    /// The classical Runge-Kutta method: order 4.
    Rk4 {
        /// h in s.
        step: f64,
    },
    /// Dormand and Prince's embedded pair of orders 5 and 4, its steps chosen by itself.
    Adaptive {
        /// Error allowed per step, relative to the size of the motion.
        tolerance: f64,
    },
}

/// A scene: plain data, checked when a plan is made of it.
///
/// ```
/// use carom_dynamics::body::Ball;
/// use carom_dynamics::effects::{drag::Drag, friction::Friction, gravity::Gravity, restitution::Restitution};
/// use carom_dynamics::geometry::plane::Plane;
/// use carom_dynamics::nalgebra::{Point3, Vector3};
/// use carom_dynamics::scene::{Method, Scene};
/// use carom_dynamics::surface::{Material, Shape, Surface};
///
/// let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
/// let clay = Material { restitution: Restitution::new(0.75)?, friction: Friction::coulomb(0.6)? };
/// let scene = Scene {
///     gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -9.81))?),
///     drag: Some(Drag::linear(0.05)?.in_wind(Vector3::new(2.0, 0.0, 0.0))?),
///     surfaces: vec![Surface { name: "floor".into(), material: clay, shape: Shape::Plane(floor) }],
///     balls: vec![Ball::new(Point3::new(0.0, 0.0, 1.0), Vector3::x(), 0.033, Some(0.058))?],
///     // If not given: exact where the acceleration is constant, else adaptive.
///     method: Some(Method::Rk4 { step: 0.01 }),
///     ..Scene::lasting(3.0)
/// };
/// assert!(!scene.spins());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Scene {
    /// For how long to simulate, in s, > 0.
    pub duration: f64,
    /// Gravity, if any.
    pub gravity: Option<Gravity>,
    /// Air resistance, if any.
    pub drag: Option<Drag>,
    /// The Magnus force on balls that spin, if any.
    pub magnus: Option<Magnus>,
    /// The decay of spin in the air, if any.
    pub spin_decay: Option<SpinDecay>,
    /// Buoyancy with added mass, if any.
    pub buoyancy: Option<Buoyancy>,
    /// What the balls bounce on. The order does not matter.
    pub surfaces: Vec<Surface>,
    /// The balls; each moves on its own.
    pub balls: Vec<Ball>,
    /// Thresholds of the rest test; from the size of the scene if none.
    pub rest: Option<RestThresholds>,
    /// The method; exact where the acceleration is constant, else adaptive, if none.
    pub method: Option<Method>,
}

impl Scene {
    /// Whether balls turn in it: one spins at the start, or a surface makes them.
    pub fn spins(&self) -> bool {
        self.grips() || self.balls.iter().any(|ball| ball.spin() != Vector3::zeros())
    }

    /// Whether a surface turns the balls.
    pub fn grips(&self) -> bool {
        self.surfaces.iter().any(|s| matches!(s.material.friction, Friction::Grip(_)))
    }

    /// An empty scene of `duration` seconds, to fill in: no gravity, no air, no surfaces, no
    /// balls.
    pub fn lasting(duration: f64) -> Self {
        Self {
            duration,
            gravity: None,
            drag: None,
            magnus: None,
            spin_decay: None,
            buoyancy: None,
            surfaces: Vec::new(),
            balls: Vec::new(),
            rest: None,
            method: None,
        }
    }
}
