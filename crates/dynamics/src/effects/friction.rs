//! Friction at an impact: what it takes off the tangential velocity v_t (section 3.2.2 of the chapter).

use crate::error::{ValueError, require};

/// The friction of a surface.
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
}
