//! The effects, one file each: what bends a flight (gravity, buoyancy, drag and wind, the Magnus force and the decay of the spin it
//! needs) and what answers a contact (restitution, friction, and the grip that turns a ball).

pub mod buoyancy;
pub mod drag;
pub mod friction;
pub mod gravity;
pub mod grip;
pub mod magnus;
pub mod restitution;
pub mod spin_decay;

use crate::body::{Body, State};
use crate::counters::Counters;
use nalgebra::Vector3;

/// An effect on the flight whose acceleration changes with the ball's state. (What does not change is summed once, by the
/// plan.)
pub trait Flow: std::fmt::Debug + Send + Sync {
    /// What to call it in messages.
    fn name(&self) -> &'static str;

    /// Its share of the acceleration of `body` in `state`, in m/s^2.
    fn acceleration(&self, state: &State, body: &Body) -> Vector3<f64>;

    /// The velocity in m/s towards which it drives a ball, and never away from it; none if it is no resistance.
    fn calms_to(&self) -> Option<Vector3<f64>>;

    /// The rate in 1/s, if its acceleration of `body` is always that times the velocity that is left to where it calms to.
    fn rate(&self, _body: &Body) -> Option<f64> {
        None
    }

    /// Adds one evaluation to its count.
    fn count(&self, counters: &mut Counters);
}
