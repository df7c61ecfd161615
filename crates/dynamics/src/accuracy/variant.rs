//! The methods under test: the slides as published, and each improvement to it, one at a time.

use super::textbook::{Determination, Textbook};
use crate::integrators::Stepping;
use crate::scene::Method;

/// A method under test, but for its step or tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variant {
    /// The slides as published: Euler, linear f, plain inside test.
    Slides,
    /// The slides with f on the path's own curve. Euler's path is straight, so that this changes nothing but rounding: it pays with
    /// Runge and Kutta.
    SlidesOwnF,
    /// Euler with certified collisions: f rounded to the safe side, contacts remembered, no through. From here on it is the solver of this
    /// crate.
    Euler,
    /// The velocity first, then the position.
    SemiImplicitEuler,
    /// Runge and Kutta's method in the loop of the slides: f as if the path were straight.
    Rk4LinearF,
    /// Runge and Kutta's method with f on its own curve.
    Rk4,
    /// The formula of Dormand and Prince's pair with steps that are given, in the loop of the slides, f on its own curve: it shows the order that
    /// steps of its own choice, which jump, hide.
    DormandPrince,
    /// Dormand and Prince's pair.
    Adaptive,
    /// The exact flight.
    Exact,
}

/// What a variant is asked with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// A timestep in s.
    Step,
    /// A relative error allowed per step.
    Tolerance,
    /// Nothing.
    None,
}

/// What is run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Approach {
    /// The slides' method or a variant of it.
    Textbook(Textbook),
    /// A method of this crate.
    Method(Method),
}

impl Variant {
    /// All, in the order of care.
    pub const ALL: [Self; 9] = [
        Self::Slides,
        Self::SlidesOwnF,
        Self::Euler,
        Self::SemiImplicitEuler,
        Self::Rk4LinearF,
        Self::Rk4,
        Self::DormandPrince,
        Self::Adaptive,
        Self::Exact,
    ];

    /// Its name; that of the integrator in a scene, if a scene can ask for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slides => "slides",
            Self::SlidesOwnF => "slides+own-f",
            Self::Euler => "euler",
            Self::SemiImplicitEuler => "semi-implicit-euler",
            Self::Rk4LinearF => "rk4+linear-f",
            Self::Rk4 => "rk4",
            Self::DormandPrince => "dormand-prince",
            Self::Adaptive => "adaptive",
            Self::Exact => "exact",
        }
    }

    /// What it is, in a line.
    pub fn description(self) -> &'static str {
        match self {
            Self::Slides => "as published: Euler, linear f, plain inside test",
            Self::SlidesOwnF => "the slides with f on the path's own curve",
            Self::Euler => "the slides with robust predicates",
            Self::SemiImplicitEuler => "the same, velocity before position",
            Self::Rk4LinearF => "Runge-Kutta in the slides' loop, linear f",
            Self::Rk4 => "Runge-Kutta, f on its own curve, robust",
            Self::DormandPrince => "the pair's formula in the slides' loop, given steps",
            Self::Adaptive => "Dormand-Prince 5(4), steps by itself",
            Self::Exact => "parabolas in closed form",
        }
    }

    /// What it is asked with.
    pub fn parameter(self) -> Parameter {
        match self {
            Self::Adaptive => Parameter::Tolerance,
            Self::Exact => Parameter::None,
            _ => Parameter::Step,
        }
    }

    /// The order that theory gives it in flight, and once it has bounced; none for the exact flight.
    ///
    /// A linear f is off by O(h^2) of the step on a curve, which is all that is left of a higher order.
    pub fn textbook_orders(self) -> Option<[u32; 2]> {
        match self {
            Self::Slides | Self::SlidesOwnF | Self::Euler | Self::SemiImplicitEuler => Some([1, 1]),
            Self::Rk4LinearF => Some([4, 2]),
            Self::Rk4 => Some([4, 4]),
            Self::DormandPrince | Self::Adaptive => Some([5, 5]),
            Self::Exact => None,
        }
    }

    /// What is run with the step or tolerance `value`.
    pub fn with(self, value: f64) -> Approach {
        let textbook = |stepping, determination| Approach::Textbook(Textbook { stepping, step: value, determination });
        match self {
            Self::Slides => textbook(Stepping::Euler, Determination::Linear),
            Self::SlidesOwnF => textbook(Stepping::Euler, Determination::OwnCurve),
            Self::Euler => Approach::Method(Method::Euler { step: value }),
            Self::SemiImplicitEuler => Approach::Method(Method::SemiImplicitEuler { step: value }),
            Self::Rk4LinearF => textbook(Stepping::Rk4, Determination::Linear),
            Self::Rk4 => Approach::Method(Method::Rk4 { step: value }),
            Self::DormandPrince => textbook(Stepping::DormandPrince, Determination::OwnCurve),
            Self::Adaptive => Approach::Method(Method::Adaptive { tolerance: value }),
            Self::Exact => Approach::Method(Method::Exact),
        }
    }

    /// The variant of the same flight whose collisions are certified: against it, determination is told from integration.
    pub fn twin(self) -> Self {
        match self {
            Self::Slides | Self::SlidesOwnF => Self::Euler,
            Self::Rk4LinearF => Self::Rk4,
            other => other,
        }
    }
}
