//! Bouncing-ball dynamics: flights, the earliest collision, the response, sliding and rest.
//!
//! Data flows one way: [`Scene`](scene::Scene) (what is wanted) to [`Plan`](plan::Plan) (what will be evaluated) to
//! events, frames and counters. The crate reads no files and prints nothing.

// In dependency order: a module imports only from those above it.
pub mod error;
pub mod tolerance;
pub mod counters;
pub mod body;
pub mod effects;
pub mod forces;
pub mod surface;
pub mod scene;
pub mod integrators;
pub mod plan;
pub mod contacts;
pub mod clock;
pub mod events;
pub mod energy;
pub mod collision;
pub mod support;
pub mod response;
pub mod sliding;
pub mod observer;
pub mod simulate;
pub mod run;
