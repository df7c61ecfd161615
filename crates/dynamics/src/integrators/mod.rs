//! Integrators: each turns a state and a timestep into a path and the velocity along it.

pub mod adaptive;
pub mod damped;
pub mod euler;
pub mod exact;
pub mod rk4;

use crate::body::State;
use crate::counters::Counters;
use crate::forces::Forces;
use adaptive::Adaptive;
use carom_geometry::clearance::MAX_DEGREE;
use carom_geometry::path::Path;
use damped::Damped;
use nalgebra::Vector3;

/// A step: the path of the centre over f in [0, `to`], and the velocity along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// The centre's path; f = 1 is `seconds` after the start.
    pub path: Path,
    /// The velocity v(f) = v0 + v1 f + v2 f^2 ..., in m/s; of a path with two terms at most, it has two as well.
    pub velocity: [Vector3<f64>; MAX_DEGREE + 1],
    /// The time from f = 0 to f = 1, in s.
    pub seconds: f64,
    /// Where the step ends; 1 but for a flight that is exact for any length.
    pub to: f64,
    /// Whether the velocity is the derivative of the path to the last bit: what is computed of the one is then true of the other.
    pub exact: bool,
}

/// The methods with a fixed timestep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stepping {
    /// The chapter's explicit Euler.
    Euler,
    /// Semi-implicit Euler.
    SemiImplicitEuler,
    /// Runge-Kutta of order 4.
    Rk4,
    /// The fifth-order formula of Dormand and Prince's pair.
    DormandPrince,
}

/// A method at work on one ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Integrator {
    /// Exact under constant acceleration, in steps of any length.
    Exact,
    /// A fixed timestep h, in s.
    Stepping(Stepping, f64),
    /// A step of its own choice.
    Adaptive(Adaptive),
    /// The same in linear drag, whose flights have a closed form.
    Damped(Damped),
}

impl Integrator {
    /// The timestep h in s, if it is fixed.
    pub fn timestep(&self) -> Option<f64> {
        match self {
            Integrator::Stepping(_, h) => Some(*h),
            Integrator::Exact | Integrator::Adaptive(_) | Integrator::Damped(_) => None,
        }
    }

    /// The path of `timestep` seconds from `state`; the adaptive pair may give a shorter one.
    ///
    /// A ball that leaves something tangentially (`tangential`) begins with the velocity it has, also under the semi-implicit method:
    /// with the new one it would set out into what it leaves.
    pub fn step(
        &mut self,
        forces: &Forces,
        state: &State,
        timestep: f64,
        tangential: bool,
        counters: &mut Counters,
    ) -> Step {
        counters.paths += 1;
        match self {
            Integrator::Exact => exact::step(state, forces.acceleration(state, counters), timestep),
            Integrator::Stepping(Stepping::Euler, _) => {
                euler::explicit(state, forces.acceleration(state, counters), timestep)
            }
            Integrator::Stepping(Stepping::SemiImplicitEuler, _) if tangential => {
                euler::explicit(state, forces.acceleration(state, counters), timestep)
            }
            Integrator::Stepping(Stepping::SemiImplicitEuler, _) => {
                euler::semi_implicit(state, forces.acceleration(state, counters), timestep)
            }
            Integrator::Stepping(Stepping::Rk4, _) => rk4::step(forces, state, timestep, counters),
            Integrator::Stepping(Stepping::DormandPrince, _) => {
                adaptive::step(state, timestep, |s, after| forces.acceleration_after(s, after, counters))
            }
            Integrator::Damped(flight) => {
                flight.step(state, timestep, &forces.acceleration(state, counters), &forces.constant)
            }
            Integrator::Adaptive(pair) => {
                pair.step(state, timestep, |s, after| forces.acceleration_after(s, after, counters))
            }
        }
    }
}

impl Step {
    /// Position and velocity at `f`.
    #[inline]
    pub fn at(&self, f: f64) -> State {
        let [v0, v1, v2, v3, v4] = &self.velocity;
        let further = if self.path.degree() <= 2 { Vector3::zeros() } else { (v4 * f + v3) * f + v2 };
        let velocity = (further * f + v1) * f + v0;
        State { position: self.path.at(f), velocity }
    }

    /// The state at the end of the step.
    #[inline]
    pub fn end(&self) -> State {
        self.at(self.to)
    }

    /// Whether the path, the velocity and their reach over the whole step are finite: what is no number in any of their terms is none at the end.
    #[inline]
    pub fn is_finite(&self) -> bool {
        let State { position, velocity } = self.end();
        // A maximum passes over what is no number; a sum does not, not even of infinities that differ in sign.
        (position.coords.sum() + velocity.sum() + self.path.reach(self.to) + self.seconds).is_finite()
    }

    /// The time from the start to `f`, in s.
    pub fn time(&self, f: f64) -> f64 {
        f * self.seconds
    }
}
