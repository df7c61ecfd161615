//! What an effect will change, told without simulating it: to first order in its own size.
//!
//! In flight an effect adds the acceleration da to what the ball does without it. Along the flight without it, da makes dv(T) = int da dt and
//! dx(T) = int (T - t) da dt, the landing later by dt = -n.dx / n.v, and the speed there different by v.(dv + a dt) / |v|. For simple
//! flights these are the rules of thumb: with the drag length l = 2 m / (rho C A), a fall from H takes (1/6) H/l longer, H/l being g H / vt^2, and
//! ends H/2l slower; a throw over s ends s/l slower, is blown aside by the wind w by (w/v)(s/2l) of its length, and lifted by the Magnus force by
//! (C_L/C)(s/2l); buoyancy makes a fall 0.75 rho V / m longer. What is neglected is of second order: of 10 %, about 1 % is left out.

use super::flight::Flight;
use crate::counters::Counters;
use crate::plan::Plan;
use nalgebra::Vector3;

/// A small change of a flight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    /// Of the velocity, in m/s.
    pub velocity: Vector3<f64>,
    /// Of the position, in m.
    pub position: Vector3<f64>,
    /// The time integral of the acceleration that makes it, however directed, in m/s.
    pub push: f64,
}

/// What the effects that `with` has and `without` has not make of `flight` of ball number `ball` in the time until `until` (s).
pub(super) fn change(without: &Plan, with: &Plan, ball: usize, flight: &Flight, until: f64) -> Change {
    let mut counters = Counters::default();
    let (before, after) = (&without.balls()[ball], &with.balls()[ball]);
    let (without, with) = (without.forces(before), with.forces(after));
    let none = Change { velocity: Vector3::zeros(), position: Vector3::zeros(), push: 0.0 };
    flight.samples(until).fold(none, |sum, (time, state, weight)| {
        let a = with.acceleration_after(&state, time, &mut counters);
        let a = (a - without.acceleration_after(&state, time, &mut counters)) * weight;
        Change { velocity: sum.velocity + a, position: sum.position + a * (until - time), push: sum.push + a.norm() }
    })
}

/// What a change does to a landing: its time in s, its speed in m/s, its place in m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Landing {
    pub later: f64,
    pub faster: f64,
    pub aside: Vector3<f64>,
}

/// The landing with `change`, on a surface of normal `n`, with the velocity `v` and the acceleration `a` that there are without it.
pub(super) fn landing(change: &Change, n: &Vector3<f64>, v: &Vector3<f64>, a: &Vector3<f64>) -> Landing {
    let later = -n.dot(&change.position) / n.dot(v);
    let faster = v.dot(&(change.velocity + a * later)) / v.norm();
    Landing { later, faster, aside: change.position + v * later }
}
