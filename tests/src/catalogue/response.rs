//! Hard cases of response and time: corners, wedges, restitution at its ends, time that stands still, sliding, drag.

mod bounces;
mod check;
mod corners;
mod drag;
mod edges;
mod sliding;
mod steps;
mod wedges;

use super::Case;

/// The cases H19 to H30 and H32.
pub fn cases() -> Vec<Case> {
    [corners::CASES, wedges::CASES, bounces::CASES, steps::CASES, sliding::CASES, edges::CASES, drag::CASES].concat()
}
