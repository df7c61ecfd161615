//! The effects one by one: whether a scene has them, and the same scene with or without.

use crate::effects::buoyancy::Buoyancy;
use crate::effects::drag::Drag;
use crate::effects::friction::Friction;
use crate::effects::grip::Grip;
use crate::effects::magnus::Magnus;
use crate::effects::restitution::Restitution;
use crate::effects::spin_decay::SpinDecay;
use crate::plan::Plan;
use crate::scene::{Method, Scene};
use crate::surface::Material;
use crate::tolerance::RestThresholds;
use nalgebra::Vector3;

/// Air at 20 C and sea level: its density in kg/m^3.
pub const AIR_DENSITY: f64 = 1.204;
/// Its viscosity in Pa s (D. R. Lide, *CRC Handbook of Chemistry and Physics*).
pub const AIR_VISCOSITY: f64 = 18.25 / 1_000_000.0;
/// The lift coefficient over the spin parameter that is taken where a scene gives none: that of a baseball, see [`crate::effects::magnus`].
const LIFT: f64 = 1.0;
/// The time constant of spin in s that is taken where a scene gives none: that of a golf ball, see [`crate::effects::spin_decay`].
const SPIN_DECAY: f64 = 25.0;
/// A light air, in m/s: the wind that is taken where a scene gives none.
const LIGHT_AIR: f64 = 1.0;
/// The friction that is taken where a scene gives none: wood on wood, 0.25 to 0.5 (section 3.2.2 of the chapter).
const FRICTION: f64 = 0.3;
/// The closing speed in m/s above which restitution is taken to fall where a scene does not say.
const FALLS_ABOVE: f64 = 1.0;
/// The rolling resistance that is taken where a scene gives none.
const ROLLING: f64 = 0.01;
/// How much higher the rest speed is in the scene that the rest test is compared with: without any, bouncing would not end.
pub(super) const MORE_REST: f64 = 10.0;

/// An effect that a scene has or has not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Uniform gravity.
    Gravity,
    /// Air resistance.
    Drag,
    /// The wind in it.
    Wind,
    /// The Magnus force on a ball that spins.
    Magnus,
    /// The decay of the spin.
    SpinDecay,
    /// Buoyancy with added mass.
    Buoyancy,
    /// Restitution that falls with the speed.
    FallingRestitution,
    /// Friction at impacts.
    Friction,
    /// The impulse law of friction in place of the book's.
    ImpulseFriction,
    /// Grip and slip with spin in place of friction that knows of none.
    Grip,
    /// Rolling resistance.
    Rolling,
    /// The rest test.
    Rest,
}

impl Effect {
    /// All of them, flights first.
    pub const ALL: [Self; 12] = [
        Self::Gravity,
        Self::Drag,
        Self::Wind,
        Self::Magnus,
        Self::SpinDecay,
        Self::Buoyancy,
        Self::FallingRestitution,
        Self::Friction,
        Self::ImpulseFriction,
        Self::Grip,
        Self::Rolling,
        Self::Rest,
    ];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gravity => "gravity",
            Self::Drag => "drag",
            Self::Wind => "wind",
            Self::Magnus => "Magnus force",
            Self::SpinDecay => "spin decay",
            Self::Buoyancy => "buoyancy",
            Self::FallingRestitution => "restitution falling with speed",
            Self::Friction => "friction",
            Self::ImpulseFriction => "impulse law of friction",
            Self::Grip => "grip and slip with spin",
            Self::Rolling => "rolling resistance",
            Self::Rest => "rest",
        }
    }

    /// Whether it bends flights; else it answers contacts.
    pub fn is_of_flight(self) -> bool {
        use Effect::{Buoyancy, Drag, Gravity, Magnus, SpinDecay, Wind};
        matches!(self, Gravity | Drag | Wind | Magnus | SpinDecay | Buoyancy)
    }

    /// Whether `scene` has it, and it does something there.
    pub fn is_on(self, scene: &Scene) -> bool {
        let spins = scene.spins();
        let has = |wanted: fn(&Material) -> bool| scene.surfaces.iter().any(|s| wanted(&s.material));
        match self {
            Self::Gravity => scene.gravity.is_some_and(|g| g.acceleration() != Vector3::zeros()),
            Self::Drag => scene.drag.is_some_and(|drag| !drag.is_none()),
            Self::Wind => scene.drag.is_some_and(|drag| !drag.is_none() && drag.wind() != Vector3::zeros()),
            Self::Magnus => spins && scene.magnus.is_some_and(|magnus| !magnus.is_none()),
            Self::SpinDecay => spins && scene.spin_decay.is_some(),
            Self::Buoyancy => scene.buoyancy.is_some_and(|buoyancy| !buoyancy.is_none()),
            Self::FallingRestitution => has(|m| m.restitution.falls_above().is_some()),
            Self::Friction => has(|m| m.friction != Friction::None),
            Self::ImpulseFriction => has(|m| matches!(m.friction, Friction::Impulse(_))),
            Self::Grip => scene.grips(),
            Self::Rolling => has(|m| matches!(m.friction, Friction::Grip(grip) if grip.rolling() > 0.0)),
            Self::Rest => !scene.surfaces.is_empty(),
        }
    }

    /// Whether nothing in a scene without it tells how strong it is, so that a guess must: then it is not called for, only possible.
    pub fn is_guessed(self) -> bool {
        use Effect::{FallingRestitution, Friction, Grip, ImpulseFriction, Rolling, SpinDecay, Wind};
        matches!(self, Wind | SpinDecay | FallingRestitution | Friction | ImpulseFriction | Grip | Rolling)
    }

    /// The same scene without the effect if it has it, else with it; and in words what was taken to be so for that. If that would be the same
    /// scene, or cannot be told, why.
    pub fn switched(self, scene: &Scene) -> Result<(Scene, &'static str), &'static str> {
        let mut other = scene.clone();
        let assumed = if self.is_on(scene) { self.take_out(&mut other)? } else { self.put_in(&mut other)? };
        if matches!(other.method, Some(Method::Exact)) {
            // Where the acceleration changes, there is no exact flight.
            other.method = None;
        }
        Ok((other, assumed))
    }

    fn take_out(self, scene: &mut Scene) -> Result<&'static str, &'static str> {
        let calm = |drag: Drag| drag.in_wind(Vector3::zeros()).ok();
        match self {
            Self::Gravity => scene.gravity = None,
            Self::Drag => scene.drag = None,
            Self::Wind => {
                scene.drag = scene.drag.and_then(calm);
                scene.magnus = scene.magnus.and_then(|magnus| magnus.in_wind(Vector3::zeros()).ok());
            }
            Self::Magnus => scene.magnus = None,
            Self::SpinDecay => scene.spin_decay = None,
            Self::Buoyancy => scene.buoyancy = None,
            Self::FallingRestitution => {
                change(scene, |m| {
                    m.restitution = Restitution::new(m.restitution.coefficient()).unwrap_or(m.restitution)
                });
            }
            Self::Friction => change(scene, |m| m.friction = Friction::None),
            Self::ImpulseFriction => change(scene, |m| {
                if let Friction::Impulse(mu) = m.friction {
                    m.friction = Friction::Coulomb(mu);
                }
            }),
            Self::Grip => change(scene, |m| {
                if let Friction::Grip(grip) = m.friction {
                    m.friction = Friction::impulse(grip.friction()).unwrap_or(m.friction);
                }
            }),
            Self::Rolling => roll(scene, 0.0),
            Self::Rest => {
                let rest = Plan::new(scene).map_err(|_| "the scene cannot be planned")?.rest();
                scene.rest = Some(match rest {
                    RestThresholds::Length(length) => RestThresholds::Length(length * MORE_REST * MORE_REST),
                    RestThresholds::Book { speed, distance, force } => {
                        RestThresholds::Book { speed: speed * MORE_REST, distance, force }
                    }
                });
                return Ok("against a rest speed ten times as high");
            }
        }
        Ok("")
    }

    fn put_in(self, scene: &mut Scene) -> Result<&'static str, &'static str> {
        let lacking = |lacks: fn(&crate::body::Ball) -> bool| scene.balls.iter().any(lacks);
        let spins = scene.spins();
        if matches!(self, Self::Drag | Self::Magnus | Self::Buoyancy) {
            if lacking(|ball| ball.mass().is_none()) {
                return Err("the balls have no mass, without which it cannot be told");
            }
            if lacking(|ball| ball.radius() == 0.0) {
                return Err("the balls are points: the air passes them by");
            }
        }
        if matches!(self, Self::Magnus | Self::SpinDecay) && !spins {
            return Err("no ball spins");
        }
        let refused = "its values are refused";
        let density = scene.drag.and_then(|drag| drag.density()).unwrap_or(AIR_DENSITY);
        match self {
            Self::Gravity => return Err("the scene has none, and which one it should be nothing tells"),
            Self::Drag => {
                let own = scene.balls.iter().all(|ball| ball.drag().is_some());
                let law = if own { Drag::of_ball(AIR_DENSITY) } else { Drag::sphere(AIR_DENSITY, AIR_VISCOSITY) };
                scene.drag = Some(law.map_err(|_| refused)?);
                return Ok(if own {
                    "with the balls' own coefficients in air at 20 C"
                } else {
                    "of smooth spheres in air at 20 C"
                });
            }
            Self::Wind => {
                let drag = scene.drag.filter(|drag| !drag.is_none()).ok_or("without drag, wind does nothing")?;
                let up = scene.gravity.map_or(Vector3::z(), |g| g.acceleration());
                let across = up.cross(&Vector3::y()).try_normalize(0.0).unwrap_or_else(Vector3::x);
                scene.drag = Some(drag.in_wind(across * LIGHT_AIR).map_err(|_| refused)?);
                return Ok("of 1 m/s, a light air, at right angles to gravity");
            }
            Self::Magnus => {
                let magnus = Magnus::new(LIFT, density).map_err(|_| refused)?;
                let wind = scene.drag.map_or(Vector3::zeros(), |drag| drag.wind());
                scene.magnus = Some(magnus.in_wind(wind).map_err(|_| refused)?);
                return Ok("with the lift coefficient of a baseball, C_L = S");
            }
            Self::SpinDecay => {
                if !Self::Magnus.is_on(scene) {
                    return Err("nothing asks for the spin in flight");
                }
                scene.spin_decay = Some(SpinDecay::new(SPIN_DECAY).map_err(|_| refused)?);
                return Ok("with the time constant of a golf ball, 25 s");
            }
            Self::Buoyancy => {
                if !Self::Gravity.is_on(scene) {
                    return Err("without gravity nothing floats");
                }
                scene.buoyancy = Some(Buoyancy::new(density).map_err(|_| refused)?);
                return Ok("in air at 20 C, or of the density that the drag has");
            }
            _ if scene.surfaces.is_empty() => return Err("there is nothing to bounce on"),
            Self::FallingRestitution => {
                if scene.surfaces.iter().all(|s| s.material.restitution.is_of_ball()) {
                    return Err("restitution is each ball's own, fitted at the speed of its rule");
                }
                change(scene, |m| {
                    let falling = Restitution::falling(m.restitution.coefficient(), FALLS_ABOVE);
                    m.restitution = falling.ok().filter(|_| !m.restitution.is_of_ball()).unwrap_or(m.restitution);
                });
                return Ok("as v^(-1/4) above 1 m/s, if the bodies yield there");
            }
            Self::Friction => {
                let coulomb = Friction::coulomb(FRICTION).map_err(|_| refused)?;
                change(scene, |m| m.friction = coulomb);
                return Ok("with mu = 0.3, as wood on wood");
            }
            Self::ImpulseFriction => {
                if !scene.surfaces.iter().any(|s| matches!(s.material.friction, Friction::Coulomb(_))) {
                    return Err("no surface has the book's friction, whose place it would take");
                }
                change(scene, |m| {
                    if let Friction::Coulomb(mu) = m.friction {
                        m.friction = Friction::Impulse(mu);
                    }
                });
            }
            Self::Grip => {
                if scene.balls.iter().any(|ball| ball.radius() == 0.0) {
                    return Err("the balls are points, which do not turn");
                }
                let rubs = |m: &Material| matches!(m.friction, Friction::Coulomb(_) | Friction::Impulse(_));
                if !scene.surfaces.iter().any(|s| rubs(&s.material)) {
                    return Err("without Coulomb's friction nothing turns a ball");
                }
                change(scene, |m| {
                    if let Friction::Coulomb(mu) | Friction::Impulse(mu) = m.friction {
                        m.friction = Grip::new(mu.get()).map_or(m.friction, Friction::Grip);
                    }
                });
                return Ok("with the mu of the scene and no tangential restitution");
            }
            Self::Rolling => {
                if !Self::Grip.is_on(scene) {
                    return Err("nothing rolls");
                }
                roll(scene, ROLLING);
                return Ok("with c_rr = 0.01");
            }
            Self::Rest => return Err("there is nothing to rest on"),
        }
        Ok("")
    }
}

/// Gives what grips the rolling resistance `c_rr`.
fn roll(scene: &mut Scene, c_rr: f64) {
    change(scene, |m| {
        if let Friction::Grip(grip) = m.friction {
            m.friction = grip.with_rolling(c_rr).map_or(m.friction, Friction::Grip);
        }
    });
}

/// Changes the material of every surface.
fn change(scene: &mut Scene, with: impl Fn(&mut Material)) {
    scene.surfaces.iter_mut().for_each(|surface| with(&mut surface.material));
}
