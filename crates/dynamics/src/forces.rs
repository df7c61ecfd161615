//! The acceleration of a ball in flight: a constant part, summed once, and the effects that change with its state.

use crate::body::{Ball, Body, State};
use crate::counters::Counters;
use crate::effects::Flow;
use crate::effects::spin_decay::SpinDecay;
use nalgebra::Vector3;
use std::sync::Arc;

/// What accelerates one ball.
#[derive(Debug, Clone, Copy)]
pub struct Forces<'a> {
    /// The part that never changes, in m/s^2.
    pub constant: Vector3<f64>,
    /// The effects that do.
    pub flows: &'a [Arc<dyn Flow>],
    /// The ball they act on, as it was at the start.
    pub ball: &'a Ball,
    /// The ball as they see it now.
    pub body: Body,
    /// How its spin decays.
    pub decay: Option<SpinDecay>,
}

impl Forces<'_> {
    /// Whether the acceleration is the same everywhere and always.
    pub fn are_constant(&self) -> bool {
        self.flows.is_empty()
    }

    /// The acceleration in m/s^2 in `state`.
    pub fn acceleration(&self, state: &State, counters: &mut Counters) -> Vector3<f64> {
        sum(self.constant, self.flows, state, &self.body, counters)
    }

    /// The acceleration in m/s^2 in `state`, `after` seconds from now.
    pub fn acceleration_after(&self, state: &State, after: f64, counters: &mut Counters) -> Vector3<f64> {
        let Some(decay) = self.decay else { return self.acceleration(state, counters) };
        let body = Body { spin: decay.after(&self.body.spin, after), ..self.body };
        sum(self.constant, self.flows, state, &body, counters)
    }

    /// The same on a ball that rolls: its spin makes it 1 + alpha times as inert.
    pub fn of_rolling(&self) -> Self {
        let more = 1.0 + self.ball.inertia();
        Self { constant: self.constant / more, body: Body { inertia: self.body.inertia * more, ..self.body }, ..*self }
    }
}

fn sum(
    constant: Vector3<f64>,
    flows: &[Arc<dyn Flow>],
    state: &State,
    body: &Body,
    counters: &mut Counters,
) -> Vector3<f64> {
    counters.accelerations += 1;
    flows.iter().fold(constant, |sum, flow| {
        flow.count(counters);
        sum + flow.acceleration(state, body)
    })
}
