//! The modelling thresholds, each with its unit, what follows from it, and what breaks if it changes.

use crate::error::{ValueError, require};

/// When bouncing ends and when a ball is at rest: the thresholds e1, e2, e3 of the chapter's rest test.
///
/// The fourth part of the test, |F_t| <= mu |F_n|, has no threshold of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RestThresholds {
    /// One length in m from which the others follow: a hop lower than this is no hop.
    Length(f64),
    /// The book's own: speed e1 in m/s, distance e2 in m, force per mass e3 in m/s^2.
    Book {
        /// e1 in m/s.
        speed: f64,
        /// e2 in m.
        distance: f64,
        /// e3 in m/s^2: how strongly the surface may be left and still count as pressed.
        force: f64,
    },
}

impl RestThresholds {
    /// One length in m, > 0.
    pub fn length(length: f64) -> Result<Self, ValueError> {
        require("rest length", length, "a finite length > 0 in m", length.is_finite() && length > 0.0).map(Self::Length)
    }

    /// The book's three thresholds, each finite and >= 0.
    pub fn book(speed: f64, distance: f64, force: f64) -> Result<Self, ValueError> {
        let ok = |x: f64| x.is_finite() && x >= 0.0;
        require("rest speed", speed, "finite and >= 0, in m/s", ok(speed))?;
        require("rest distance", distance, "finite and >= 0, in m", ok(distance))?;
        require("rest force", force, "finite and >= 0, in m/s^2", ok(force))?;
        Ok(Self::Book { speed, distance, force })
    }
}
