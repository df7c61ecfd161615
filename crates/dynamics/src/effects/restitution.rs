//! Restitution: v_n+ = -c_r v_n- (equation of section 3.2.1 of the chapter).

use crate::error::{ValueError, require};

/// The coefficient of restitution c_r, in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Restitution(f64);

impl Restitution {
    /// `c_r` in [0, 1]: 0 sticks, 1 loses nothing.
    pub fn new(c_r: f64) -> Result<Self, ValueError> {
        require("restitution", c_r, "between 0 and 1", (0.0..=1.0).contains(&c_r)).map(Self)
    }

    /// c_r.
    pub fn coefficient(&self) -> f64 {
        self.0
    }

    /// The normal speed after an impact with closing speed `closing` > 0, both in m/s.
    pub fn rebound(&self, closing: f64) -> f64 {
        self.0 * closing
    }
}
