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
