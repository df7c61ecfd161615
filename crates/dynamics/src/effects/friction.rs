//! Friction at an impact: what it takes off the tangential velocity v_t (section 3.2.2 of the chapter).

use crate::effects::grip::Grip;
use crate::error::{ValueError, require};
use crate::tolerance::LARGEST;
use nalgebra::Vector3;

/// The friction of a surface.
///
/// ```
/// use carom_dynamics::effects::friction::Friction;
/// use carom_dynamics::nalgebra::Vector3;
///
/// // 4 m/s along the surface, 2 m/s into it, restitution 1/2.
/// let after = |friction: Friction| friction.slow(Vector3::new(4.0, 0.0, 0.0), 2.0, 0.5).x;
/// assert_eq!(after(Friction::None), 4.0);
/// assert_eq!(after(Friction::linear(0.25)?), 3.0);
/// assert_eq!(after(Friction::coulomb(0.5)?), 4.0 - 0.5 * 2.0);
/// assert_eq!(after(Friction::impulse(0.5)?), 4.0 - 0.5 * (1.0 + 0.5) * 2.0);
/// // Never more than there is.
/// assert_eq!(after(Friction::coulomb(9.0)?), 0.0);
/// # Ok::<(), carom_dynamics::error::ValueError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Friction {
    /// None: v_t is kept.
    None,
    /// v_t+ = (1 - c_f) v_t-, with c_f in [0, 1].
    Linear(Coefficient),
    /// The book's Coulomb law: v_t+ = v_t- - min(mu |v_n-|, |v_t-|) v_t-/|v_t-|.
    Coulomb(Coefficient),
    /// The impulse law: as Coulomb, with mu (1 + c_r) |v_n-|, which is mu times the normal impulse per mass.
    Impulse(Coefficient),
    /// The impulse law at the point of contact, which turns the ball: see [`Grip`]. Velocity alone does not tell what it does.
    Grip(Grip),
}

/// A coefficient of friction within the range of its law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficient(f64);

impl Coefficient {
    /// The number.
    pub fn get(&self) -> f64 {
        self.0
    }
}

impl Friction {
    /// Linear friction with `c_f` in [0, 1].
    pub fn linear(c_f: f64) -> Result<Self, ValueError> {
        let c = require("linear friction", c_f, "between 0 and 1", (0.0..=1.0).contains(&c_f))?;
        Ok(Self::Linear(Coefficient(c)))
    }

    /// The book's Coulomb friction with `mu` >= 0.
    pub fn coulomb(mu: f64) -> Result<Self, ValueError> {
        let c = require("coulomb friction", mu, "finite and >= 0", mu.is_finite() && mu >= 0.0)?;
        Ok(Self::Coulomb(Coefficient(c)))
    }

    /// Impulse Coulomb friction with `mu` >= 0.
    pub fn impulse(mu: f64) -> Result<Self, ValueError> {
        let c = require("impulse friction", mu, "finite and >= 0", mu.is_finite() && mu >= 0.0)?;
        Ok(Self::Impulse(Coefficient(c)))
    }

    /// v_t+ of an impact: what is left of the tangential velocity `v_t` (m/s) when the normal closing speed is `closing` (m/s)
    /// and restitution is `c_r`. Never more than v_t, never reversed; v_t = 0 stays 0.
    pub fn slow(&self, v_t: Vector3<f64>, closing: f64, c_r: f64) -> Vector3<f64> {
        match *self {
            Friction::None | Friction::Grip(_) => v_t,
            Friction::Linear(c_f) => v_t * (1.0 - c_f.get()),
            Friction::Coulomb(mu) => less(v_t, mu.get() * closing),
            Friction::Impulse(mu) => less(v_t, mu.get() * (1.0 + c_r) * closing),
        }
    }

    /// v_t after all the impacts of a bouncing that ends: closing speeds `closing`, c_r `closing`, c_r^2 `closing` ... with
    /// c_r < 1 (a geometric series).
    pub fn slow_to_the_end(&self, v_t: Vector3<f64>, closing: f64, c_r: f64) -> Vector3<f64> {
        match *self {
            Friction::Linear(c_f) if c_f.get() > 0.0 => Vector3::zeros(),
            _ => self.slow(v_t, closing / (1.0 - c_r), c_r),
        }
    }

    /// The friction of lasting contact, which is the limit of ever more and ever smaller impacts.
    pub fn in_contact(&self) -> ContactFriction {
        match *self {
            // What stops every motion at once, as far as f64 can tell, is the limit: it sticks.
            Friction::Coulomb(mu) | Friction::Impulse(mu) if mu.get() > LARGEST => ContactFriction::Sticking,
            Friction::Coulomb(mu) | Friction::Impulse(mu) if mu.get() > 0.0 => ContactFriction::Sliding(mu.get()),
            Friction::Linear(c_f) if c_f.get() > 0.0 => ContactFriction::Sticking,
            // What grips lets roll.
            Friction::Grip(grip) => ContactFriction::Sliding(grip.rolling()),
            _ => ContactFriction::Sliding(0.0),
        }
    }
}

/// What friction does while contact lasts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactFriction {
    /// |F_t| = mu |F_n| against the motion; at most that at rest. 0 is a frictionless surface.
    Sliding(f64),
    /// Linear friction takes the share c_f of v_t at each of infinitely many impacts: nothing is left, and nothing moves. So it is where mu
    /// has no bound.
    Sticking,
}

/// `v` shortened by `amount`, at most to zero.
fn less(v: Vector3<f64>, amount: f64) -> Vector3<f64> {
    let speed = v.norm();
    if speed <= amount { Vector3::zeros() } else { v - v * (amount / speed) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn r19_linear_friction_keeps_one_minus_c_f() {
        let friction = Friction::linear(0.25).unwrap();
        assert_eq!(friction.slow(Vector3::new(4.0, -8.0, 0.0), 1.0, 0.5), Vector3::new(3.0, -6.0, 0.0));
        assert!(
            Friction::linear(1.5).is_err() && Friction::linear(-0.1).is_err() && Friction::linear(f64::NAN).is_err()
        );
    }

    #[test]
    fn r20_r22_coulomb_takes_momentum_in_proportion_to_the_normal_speed() {
        let friction = Friction::coulomb(0.5).unwrap();
        let v_t = Vector3::new(3.0, 4.0, 0.0);
        for closing in [1.0, 2.0, 4.0] {
            assert!((v_t.norm() - friction.slow(v_t, closing, 0.9).norm() - 0.5 * closing).abs() < 1e-15);
        }
    }

    #[test]
    fn r23_r24_coulomb_never_reverses_and_zero_stays_zero() {
        let friction = Friction::coulomb(0.5).unwrap();
        assert_eq!(friction.slow(Vector3::new(3.0, 4.0, 0.0), 10.0, 0.9), Vector3::zeros());
        assert_eq!(friction.slow(Vector3::new(3.0, 4.0, 0.0), 100.0, 0.9), Vector3::zeros());
        assert_eq!(friction.slow(Vector3::zeros(), 1.0, 0.9), Vector3::zeros());
    }

    #[test]
    fn r24_the_impulse_law_takes_one_plus_c_r_times_as_much() {
        let v_t = Vector3::new(8.0, 0.0, 0.0);
        let book = Friction::coulomb(0.25).unwrap().slow(v_t, 4.0, 0.5);
        let impulse = Friction::impulse(0.25).unwrap().slow(v_t, 4.0, 0.5);
        assert_eq!((book.x, impulse.x), (7.0, 6.5));
    }

    #[test]
    fn the_end_of_bouncing_is_the_sum_of_its_impacts() {
        for friction in [Friction::coulomb(0.02).unwrap(), Friction::impulse(0.02).unwrap(), Friction::None] {
            let (c_r, start) = (0.5, Vector3::new(1.0, 2.0, 0.0));
            let (mut v_t, mut closing) = (start, 3.0);
            for _ in 0..60 {
                v_t = friction.slow(v_t, closing, c_r);
                closing *= c_r;
            }
            assert!((friction.slow_to_the_end(start, 3.0, c_r) - v_t).norm() < 1e-14);
        }
    }
}
