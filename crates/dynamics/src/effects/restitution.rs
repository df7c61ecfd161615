//! Restitution: v_n+ = -c_r v_n- (equation of section 3.2.1 of the chapter), with a c_r that is constant or falls with the speed.
//!
//! Above a closing speed at which the bodies begin to yield, c_r falls as v^(-1/4): K. L. Johnson, *Contact Mechanics* (1985), chapter 11,
//! for a fully plastic impact. The fourth root is two square roots.

use crate::body::Ball;
use crate::error::{ValueError, require};

/// The coefficient of restitution c_r, in [0, 1].
///
/// ```
/// use carom_dynamics::effects::restitution::Restitution;
///
/// assert_eq!(Restitution::new(0.5)?.rebound(8.0), 4.0);
/// // Of bodies that yield above 1 m/s: 16 times as fast, half the coefficient.
/// let yielding = Restitution::falling(0.5, 1.0)?;
/// assert_eq!((yielding.at(1.0), yielding.at(16.0)), (0.5, 0.25));
/// # Ok::<(), carom_dynamics::error::ValueError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Restitution {
    c_r: f64,
    /// The closing speed in m/s above which it falls.
    falls_above: f64,
    /// Whether the ball's own takes its place.
    of_ball: bool,
}

impl Restitution {
    /// `c_r` in [0, 1] at every speed: 0 sticks, 1 loses nothing.
    pub fn new(c_r: f64) -> Result<Self, ValueError> {
        let c_r = require("restitution", c_r, "between 0 and 1", (0.0..=1.0).contains(&c_r))?;
        Ok(Self { c_r, falls_above: f64::INFINITY, of_ball: false })
    }

    /// That of each ball, which must have one. Until the plan has put it in, this is 1.
    pub fn of_ball() -> Self {
        Self { c_r: 1.0, falls_above: f64::INFINITY, of_ball: true }
    }

    /// Whether each ball's own is asked for.
    pub fn is_of_ball(&self) -> bool {
        self.of_ball
    }

    /// This, or that of `ball` if it is asked for and there is one.
    pub(crate) fn for_ball(&self, ball: &Ball) -> Self {
        match ball.restitution() {
            Some(c_r) if self.of_ball => Self { c_r, falls_above: f64::INFINITY, of_ball: false },
            _ => *self,
        }
    }

    /// `c_r` up to the closing speed `speed` in m/s, and c_r (speed / v)^(1/4) at a closing speed v above it.
    pub fn falling(c_r: f64, speed: f64) -> Result<Self, ValueError> {
        let constant = Self::new(c_r)?;
        let ok = speed.is_finite() && speed > 0.0;
        let falls_above = require("the speed above which restitution falls", speed, "finite and > 0, in m/s", ok)?;
        Ok(Self { falls_above, ..constant })
    }

    /// c_r of slow impacts: the largest.
    pub fn coefficient(&self) -> f64 {
        self.c_r
    }

    /// Whether it falls with the speed, and above which closing speed (m/s).
    pub fn falls_above(&self) -> Option<f64> {
        self.falls_above.is_finite().then_some(self.falls_above)
    }

    /// c_r at the closing speed `closing` >= 0, in m/s.
    pub fn at(&self, closing: f64) -> f64 {
        if closing <= self.falls_above { self.c_r } else { self.c_r * (self.falls_above / closing).sqrt().sqrt() }
    }

    /// The normal speed after an impact with closing speed `closing` > 0, both in m/s.
    pub fn rebound(&self, closing: f64) -> f64 {
        self.at(closing) * closing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn restitution_falls_with_the_fourth_root_of_the_speed_above_where_it_begins_to() {
        let steel = Restitution::falling(0.75, 0.5).unwrap();
        assert_eq!((steel.at(0.0), steel.at(0.25), steel.at(0.5)), (0.75, 0.75, 0.75));
        assert_eq!((steel.at(8.0), steel.rebound(8.0)), (0.375, 3.0));
        assert!(Restitution::falling(0.5, 0.0).is_err() && Restitution::falling(1.5, 1.0).is_err());
        assert_eq!(Restitution::new(0.75).unwrap().at(1e300), 0.75);
    }
}
