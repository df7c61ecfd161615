//! What can be wrong with a scene.

use thiserror::Error;

/// A value that an effect, a ball or a method cannot have.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{name} is {value}, but must be {expected}")]
pub struct ValueError {
    /// What the value is of, such as `restitution`.
    pub name: &'static str,
    /// The refused value.
    pub value: f64,
    /// What would be right.
    pub expected: &'static str,
}

/// Refuses `value` unless `ok`.
pub(crate) fn require(name: &'static str, value: f64, expected: &'static str, ok: bool) -> Result<f64, ValueError> {
    if ok { Ok(value) } else { Err(ValueError { name, value, expected }) }
}

/// Refuses a vector with a component that is not finite.
pub(crate) fn require_finite(name: &'static str, v: &nalgebra::Vector3<f64>) -> Result<(), ValueError> {
    match v.iter().find(|c| !c.is_finite()) {
        Some(&value) => Err(ValueError { name, value, expected: "finite" }),
        None => Ok(()),
    }
}

/// Why a scene cannot be simulated.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// There is nothing to simulate.
    #[error("the scene has no balls; give at least one")]
    NoBalls,
    /// A value outside its range.
    #[error(transparent)]
    Value(#[from] ValueError),
    /// A value of one ball outside its range.
    #[error("ball {ball}: {source}")]
    Ball {
        /// Index of the ball in the scene, from 0.
        ball: usize,
        /// What is wrong with it.
        source: ValueError,
    },
    /// An effect divides a force by the mass, and the ball has none.
    #[error("ball {ball} has no mass, and {effect} needs one; give its mass in kg")]
    MassMissing {
        /// Index of the ball in the scene, from 0.
        ball: usize,
        /// The effect that needs it.
        effect: &'static str,
    },
    /// A law asks each ball for something of its own, and this one does not have it.
    #[error("ball {ball} has no {what} of its own, and {effect} asks for it")]
    OwnMissing {
        /// Index of the ball in the scene, from 0.
        ball: usize,
        /// What it does not have.
        what: &'static str,
        /// What asks for it.
        effect: &'static str,
    },
    /// An effect turns the ball, and the ball is a point.
    #[error("ball {ball} has radius 0, and {effect} turns balls about their centre; give it a radius in m")]
    RadiusMissing {
        /// Index of the ball in the scene, from 0.
        ball: usize,
        /// The effect that needs it.
        effect: &'static str,
    },
    /// The exact flight exists for constant acceleration only.
    #[error("the exact flight exists only under constant acceleration, and this scene has {effect}; use `adaptive`")]
    NoExactFlight {
        /// The effect that rules it out.
        effect: &'static str,
    },
    /// The ball is too small for f64 to represent it at its place.
    #[error(
        "ball {ball} has radius {radius} m, below {least} m, which is what f64 resolves {distance} m from the origin; move the scene nearer to the origin"
    )]
    RadiusBelowResolution {
        /// Index of the ball in the scene, from 0.
        ball: usize,
        /// Its radius in m.
        radius: f64,
        /// The least radius that works there, in m.
        least: f64,
        /// How far from the origin the scene reaches, in m.
        distance: f64,
    },
    /// A ball starts between two parallel planes, and is wider than the gap.
    #[error(
        "ball {ball} is {diameter} m wide and starts between `{}` and `{}`, which are {width} m apart; give it a smaller radius or move a plane",
        .surfaces[0], .surfaces[1]
    )]
    NoRoom {
        /// Index of the ball in the scene, from 0.
        ball: usize,
        /// The names of the two surfaces.
        surfaces: [String; 2],
        /// The width of the gap in m.
        width: f64,
        /// The diameter of the ball in m.
        diameter: f64,
    },
    /// A quantity that f64 cannot square, as the loop must.
    #[error("{what} is {value:e}, but must be {expected}; give the scene in other units")]
    OutOfRange {
        /// Which quantity, with its unit.
        what: &'static str,
        /// The refused value.
        value: f64,
        /// What would be right.
        expected: &'static str,
    },
}
