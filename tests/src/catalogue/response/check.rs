//! What a case finds: conditions that hold or not, and errors beside their bounds.

use crate::catalogue::Figure;

/// Gathers what a case finds; the figure tells the first thing that does not hold.
#[derive(Debug, Default)]
pub struct Check {
    broken: Option<String>,
    count: u64,
}

impl Check {
    /// Of nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// `holds`, or else `what` is the matter.
    pub fn that(&mut self, holds: bool, what: impl FnOnce() -> String) {
        self.count += 1;
        if !holds && self.broken.is_none() {
            self.broken = Some(what());
        }
    }

    /// `error` <= `bound`; an error that is not a number is above it. Gives back the larger of `error` and `worst`.
    pub fn within(&mut self, worst: f64, error: f64, bound: f64, what: impl FnOnce() -> String) -> f64 {
        self.that(error <= bound, || format!("{}: {error:.2e}, bound {bound:.2e}", what()));
        if error > worst { error } else { worst }
    }

    /// The figure, `text` unless something does not hold. Nothing checked is nothing held.
    pub fn figure(self, text: String) -> Figure {
        match self.broken {
            Some(broken) => Figure { text: format!("{broken} ({text})"), holds: false },
            None => Figure { text, holds: self.count > 0 },
        }
    }
}
