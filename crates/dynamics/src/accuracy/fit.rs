//! Convergence orders: the slope of the error over the step on logarithmic axes, where there is one.

use std::fmt;

/// Points that a line needs.
const LEAST_POINTS: usize = 4;

/// Points at the fine end that are taken: the order is what is left when the step goes to 0. Of steps that jump, all.
const MOST_POINTS: usize = 5;

/// What is known of how the error depends on the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Law {
    /// Steps that are given, in one flight: C h^p (1 + c h), from where the next term hardly counts.
    Smooth,
    /// Steps that are given, with bounces: C h^p about.
    Even,
    /// Steps that a method chooses by itself, by halves and doubles, or errors that depend on where in a step the impacts lie: C h^p within a band.
    Band,
}

impl Law {
    /// How far the points may scatter about it, in octaves.
    fn scatter(self) -> f64 {
        match self {
            Self::Smooth | Self::Even => 0.25,
            Self::Band => 2.0,
        }
    }
}

/// An error this many times that of rounding is the method's.
const ABOVE_ROUNDING: f64 = 64.0;

/// An order, or why there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Order {
    /// The slope of the line.
    Fitted(f64),
    /// The error is rounding at almost every step.
    AtRounding,
    /// There are not enough comparable runs.
    TooFew,
    /// The points lie on no line.
    Scattered,
    /// A smaller step does not make a smaller error.
    NotConverging,
}

/// A slope below this is none.
const LEAST_SLOPE: f64 = 0.25;

impl Order {
    /// The slope, if there is one.
    pub fn value(self) -> Option<f64> {
        match self {
            Self::Fitted(order) => Some(order),
            _ => None,
        }
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fitted(order) => write!(f, "{order:.2}"),
            Self::AtRounding => f.write_str("rounding"),
            Self::TooFew => f.write_str("too few"),
            Self::Scattered => f.write_str("scattered"),
            Self::NotConverging => f.write_str("none"),
        }
    }
}

/// Fits the order through points (step, error, what rounding makes of it), the errors that mean nothing being infinite.
pub(super) fn order(points: &[(f64, f64, f64)], law: Law) -> Order {
    let comparable: Vec<_> = points.iter().filter(|(h, e, _)| *h > 0.0 && e.is_finite()).collect();
    let mut usable: Vec<(f64, f64)> = comparable
        .iter()
        .filter(|(_, e, rounding)| *e > ABOVE_ROUNDING * rounding && *e > 0.0)
        .map(|(h, e, _)| (*h, e.log2()))
        .collect();
    if usable.len() < LEAST_POINTS {
        return if comparable.len() >= LEAST_POINTS { Order::AtRounding } else { Order::TooFew };
    }
    usable.sort_by(|a, b| a.0.total_cmp(&b.0));
    if law != Law::Band {
        usable.truncate(MOST_POINTS);
    }
    // log e = log C + p log h, and log(1 + c h) = c h about: what is not the order is taken out of both sides before the slope.
    let mut x = centred(usable.iter().map(|(h, _)| h.log2()).collect());
    let mut y = centred(usable.iter().map(|(_, e)| *e).collect());
    if law == Law::Smooth {
        let h = centred(usable.iter().map(|(h, _)| h / usable[0].0).collect());
        without(&mut x, &h);
        without(&mut y, &h);
    }
    let Some(slope) = without(&mut y, &x) else { return Order::TooFew };
    let scatter = y.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    match slope {
        slope if slope < LEAST_SLOPE => Order::NotConverging,
        slope if scatter <= law.scatter() => Order::Fitted(slope),
        _ => Order::Scattered,
    }
}

/// The values less their mean.
fn centred(mut values: Vec<f64>) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter_mut().for_each(|v| *v -= mean);
    values
}

/// Takes out of `y` its multiple of `x` by least squares, and says how much that was; nothing if `x` is 0.
fn without(y: &mut [f64], x: &[f64]) -> Option<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let square = dot(x, x);
    let slope = (square > 0.0).then(|| dot(x, y) / square)?;
    y.iter_mut().zip(x).for_each(|(y, x)| *y -= slope * x);
    Some(slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn powers(order: i32, floor: f64) -> Vec<(f64, f64, f64)> {
        let h = |k: i32| 2f64.powi(-k);
        (3..12).map(|k| (h(k), (3.0 * h(k).powi(order) * (1.0 + h(k))).max(floor), 2f64.powi(-50))).collect()
    }

    #[test]
    fn an_order_is_the_slope_at_the_fine_end_above_rounding() {
        for p in [1, 2, 4, 5] {
            let fitted = order(&powers(p, 2f64.powi(-50)), Law::Even).value().unwrap();
            assert!((fitted - f64::from(p)).abs() < 0.05, "{p}: {fitted}");
        }
    }

    #[test]
    fn what_grows_with_the_step_beside_the_order_is_not_the_order() {
        for p in [1, 4, 5] {
            let far: Vec<_> =
                powers(p, 0.0).into_iter().take(5).map(|(h, e, r)| (h, e / (1.0 + h) * (1.0 + 3.0 * h), r)).collect();
            let [smooth, even] =
                [Law::Smooth, Law::Even].map(|law| (order(&far, law).value().unwrap() - f64::from(p)).abs());
            assert!(smooth < 0.02 && even > 0.1, "{p}: {smooth} {even}");
        }
    }

    #[test]
    fn what_is_no_line_gets_none() {
        for law in [Law::Smooth, Law::Even] {
            assert_eq!(order(&powers(4, 1.0), law), Order::NotConverging);
            assert_eq!(order(&powers(9, 2f64.powi(-50))[5..], law), Order::AtRounding);
            assert_eq!(order(&powers(1, 0.0)[..1], law), Order::TooFew);
            let mut wild = powers(1, 0.0);
            wild[6].1 *= 8.0;
            assert_eq!(order(&wild, law), Order::Scattered);
            wild.iter_mut().for_each(|p| p.1 = f64::INFINITY);
            assert_eq!(order(&wild, law), Order::TooFew);
        }
    }
}
