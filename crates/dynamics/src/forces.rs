//! The acceleration of a ball in flight: a constant part, summed once, and the effects that change with its state.

use crate::body::{Ball, State};
use crate::counters::Counters;
use crate::effects::Flow;
use nalgebra::Vector3;
use std::sync::Arc;

/// What accelerates one ball.
#[derive(Debug, Clone, Copy)]
pub struct Forces<'a> {
    /// The part that never changes, in m/s^2.
    pub constant: Vector3<f64>,
    /// The effects that do.
    pub flows: &'a [Arc<dyn Flow>],
    /// The ball they act on.
    pub ball: &'a Ball,
}

impl Forces<'_> {
    /// Whether the acceleration is the same everywhere and always.
    pub fn are_constant(&self) -> bool {
        self.flows.is_empty()
    }

    /// The acceleration in m/s^2 in `state`.
    pub fn acceleration(&self, state: &State, counters: &mut Counters) -> Vector3<f64> {
        counters.accelerations += 1;
        self.flows.iter().fold(self.constant, |sum, flow| {
            flow.count(counters);
            sum + flow.acceleration(state, self.ball)
        })
    }
}
