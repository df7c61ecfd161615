//! Motion in lasting contact: sliding on one surface, along a groove of two, or not at all.
//!
//! On a flat surface without friction, or where friction has nothing to turn, the path is a parabola or a straight line, exact to
//! the point where it stops. Elsewhere (across a slope, around an edge, in wind) the constrained motion is integrated by the adaptive
//! pair.

use crate::body::State;
use crate::contacts::{Contact, PerContact};
use crate::counters::Counters;
use crate::effects::friction::ContactFriction;
use crate::forces::Forces;
use crate::integrators::adaptive::Adaptive;
use crate::integrators::{Step, exact};
use crate::support::{Projection, project_offset};
use crate::tolerance::{parallel, rate_rounding};
use carom_geometry::rounding::{UNIT_ROUNDOFF, position_bound};
use carom_geometry::site::Bend;
use nalgebra::{Point3, Vector3};

/// A contact that may carry the ball.
#[derive(Debug, Clone, Copy)]
pub struct Carrier {
    /// The contact.
    pub contact: Contact,
    /// The shape that the centre follows on it.
    pub bend: Bend,
    /// Its friction.
    pub friction: ContactFriction,
    /// The distance between it and the centre, in m.
    pub radius: f64,
}

impl Carrier {
    /// The unit normal at `position`; of a point that lies on the border itself, though it is met as a ball, the one it came with.
    fn normal(&self, position: &Point3<f64>) -> Vector3<f64> {
        let away = self.bend.away_from(position).filter(|away| away.norm() >= 0.5 * self.radius);
        away.and_then(|away| away.try_normalize(0.0)).unwrap_or(self.contact.normal)
    }

    /// How fast the clearance would accelerate, in m/s^2, if a ball in `state`, which moves along it, were left to the acceleration `a`.
    pub fn lift(&self, a: &Vector3<f64>, state: &State) -> f64 {
        self.normal(&state.position).dot(a) + self.centripetal(&state.velocity)
    }

    /// The part of the acceleration towards it that is rounding: that of the `position`, seen from so near.
    fn noise(&self, position: &Point3<f64>) -> f64 {
        match self.bend {
            Bend::Flat => 0.0,
            _ => UNIT_ROUNDOFF * position.coords.amax() / self.radius,
        }
    }

    /// A [`lift`](Self::lift) under the acceleration `a` that is none, by rounding, in m/s^2: up to this a ball stays on it.
    pub fn neutral(&self, a: &Vector3<f64>, position: &Point3<f64>) -> f64 {
        let turned = match self.bend {
            Bend::Flat => 0.0,
            _ => position_bound(position.coords.amax()) / self.radius * a.norm(),
        };
        rate_rounding(a.norm()) + turned
    }

    /// The acceleration towards it, in m/s^2, that following its curve takes at `velocity`: v^2 / r across an edge.
    pub fn centripetal(&self, velocity: &Vector3<f64>) -> f64 {
        match self.bend {
            Bend::Flat => 0.0,
            bend => bend.across(velocity).norm_squared() / self.radius,
        }
    }
}

/// What carries the ball, and what is left to move it.
#[derive(Debug, Clone, Copy)]
pub struct Balance {
    /// The acceleration that the carriers leave, without friction, in m/s^2.
    pub free: Vector3<f64>,
    /// Greatest deceleration by friction, in m/s^2.
    pub friction: f64,
    /// Whether a carrier lets nothing slide.
    pub sticks: bool,
    /// The loads.
    pub loads: Projection,
    /// An acceleration that is none, by rounding, in m/s^2.
    pub rounding: f64,
}

impl Balance {
    /// Balances the acceleration `a` on `carriers` for a ball in `state`.
    pub fn of(a: &Vector3<f64>, carriers: &[Carrier], state: &State) -> Self {
        let normals: PerContact<Vector3<f64>> = carriers.iter().map(|c| c.normal(&state.position)).collect();
        let loads = project_offset(a, &normals, |i| carriers[i].centripetal(&state.velocity));
        let (mut friction, mut sticks) = (0.0, false);
        for (i, load) in loads.loads() {
            match carriers[i].friction {
                ContactFriction::Sliding(mu) => friction += mu * load,
                ContactFriction::Sticking => sticks = true,
            }
        }
        Self { free: loads.velocity, friction, sticks, loads, rounding: rate_rounding(a.norm()) }
    }

    /// Whether the ball, once it stands, stays: |F_t| <= mu |F_n|, compared by squares. No force rests on any surface.
    pub fn holds(&self) -> bool {
        let friction = self.friction + self.rounding;
        self.sticks || self.free.norm_squared() <= friction * friction
    }

    /// In how many seconds friction stops a ball that moves with velocity `v` (m/s) on a plane, along whatever curve; none if it does not.
    ///
    /// With friction F and the free acceleration a, F |v| + a.v changes by the constant a^2 - F^2 per second: d|v|/dt = a.v/|v| - F and
    /// d(a.v)/dt = a^2 - F a.v/|v|.
    pub fn time_to_stop(&self, v: &Vector3<f64>) -> Option<f64> {
        let (friction, free) = (self.friction, self.free.norm());
        if self.sticks || v.norm() == 0.0 || friction - free <= self.rounding {
            return None;
        }
        Some((friction * v.norm() + self.free.dot(v)) / ((friction - free) * (friction + free)))
    }

    /// The acceleration of a ball that moves with velocity `v` (m/s): friction is against the motion. From a standstill it is against where the ball
    /// would set out to, and no more than what pulls it there: what is held stays.
    fn acceleration(&self, v: &Vector3<f64>) -> Vector3<f64> {
        match (v.try_normalize(0.0), self.free.try_normalize(0.0)) {
            (Some(direction), _) => self.free - direction * self.friction,
            (None, Some(direction)) => direction * (self.free.norm() - self.friction).max(0.0),
            (None, None) => Vector3::zeros(),
        }
    }
}

/// The state without what the rounding of a step has left of a motion into or out of `carriers`.
pub fn tangential(state: &State, carriers: &[Carrier]) -> State {
    let along = |v: Vector3<f64>, c: &Carrier| {
        let n = c.normal(&state.position);
        v - n * n.dot(&v)
    };
    State { velocity: carriers.iter().fold(state.velocity, along), ..*state }
}

/// Whether none of `carriers` is pressed by the acceleration `a` and the motion in `state`, by more than rounding.
pub fn is_lifted(a: &Vector3<f64>, carriers: &[Carrier], state: &State) -> bool {
    carriers.iter().all(|c| c.lift(a, state) >= c.neutral(a, &state.position))
}

/// A stretch of sliding.
#[derive(Debug, Clone, Copy)]
pub struct Slide {
    /// Its path.
    pub step: Step,
    /// Whether the ball stands at the end of it.
    pub stops: bool,
}

/// The motion of a ball in `state` on `carriers`, whose `balance` it is, for at most `remaining` seconds; `integrator` takes the motions that
/// have no closed form.
pub fn slide(
    integrator: &mut Adaptive,
    forces: &Forces,
    state: &State,
    carriers: &[Carrier],
    balance: &Balance,
    remaining: f64,
    counters: &mut Counters,
) -> Slide {
    counters.paths += 1;
    let flat = carriers.iter().all(|c| c.bend == Bend::Flat);
    let speed = state.velocity.norm();
    let straight = balance.friction == 0.0 || speed == 0.0 || parallel(&balance.free, &state.velocity);
    // Along a groove every motion is straight.
    if forces.are_constant() && flat && (straight || balance.loads.count() > 1) {
        let a = balance.acceleration(&state.velocity);
        let braking = state.velocity.try_normalize(0.0).map_or(0.0, |direction| -a.dot(&direction));
        if balance.friction > 0.0 && braking > 0.0 && speed / braking <= remaining {
            let mut step = exact::step(state, a, remaining);
            step.to = (speed / braking) / step.seconds;
            return Slide { step, stops: true };
        }
        return Slide { step: exact::step(state, a, remaining), stops: false };
    }
    let longest = carriers.iter().map(|c| longest_step(c, state, &balance.free)).fold(remaining, f64::min);
    let noise = carriers.iter().map(|c| c.noise(&state.position)).fold(0.0, f64::max);
    let step = integrator.step_over(noise, state, longest, |s, after| {
        let a = forces.acceleration_after(s, after, counters);
        // With what the carriers make of the motion itself: towards the centre of the curve.
        Balance::of(&a, carriers, s).acceleration(&s.velocity)
    });
    Slide { step, stops: false }
}

/// On a curve, the time in which the ball moves across it by no more than a sixteenth of the radius.
fn longest_step(carrier: &Carrier, state: &State, a: &Vector3<f64>) -> f64 {
    let across = |v: &Vector3<f64>| carrier.bend.across(v).norm();
    match carrier.bend {
        Bend::Flat => f64::INFINITY,
        _ => carrier.radius / (16.0 * (across(&state.velocity) + (across(a) * carrier.radius).sqrt())),
    }
}
