//! What accuracy costs: every method over a sweep of steps or tolerances, against a reference in more than twice the digits.
//!
//! [`measure()`] runs a scene with the slides' method as published, with each improvement to it one at a time, and with the methods of this crate;
//! it compares positions at fixed times, impact times, numbers of impacts, energy and penetration with a reference that shares no code with
//! what it judges, takes the error apart (R26), fits orders of convergence, and counts and times the work.
//! [`choose`] answers the question behind it: the cheapest method that is good enough.

mod candidate;
mod compare;
mod conclude;
mod course;
mod fit;
mod measure;
mod real;
mod record;
mod report;
mod resistance;
mod resolution;
mod settle;
mod stage;
mod taylor;
pub mod textbook;
mod variant;
mod world;

pub use compare::{Ends, Errors, EulerLaws, Shares};
pub use course::Reach;
pub use fit::Order;
pub use measure::{Effort, choose, measure};
pub use report::{Cost, Measurement, ReferenceKind, Remark, Report, Resolution, Sweep, work};
pub use resolution::Original;
pub use variant::{Approach, Parameter, Variant};

#[cfg(test)]
mod tests;
