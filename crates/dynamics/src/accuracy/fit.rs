//! Convergence orders: the slope of the error over the step on logarithmic axes, where there is one.

use std::fmt;

/// Points that a line needs.
const LEAST_POINTS: usize = 4;

/// Points at the fine end that are taken: the order is what is left when the step goes to 0. Of steps that a method chooses by itself, which
/// jump, all.
const MOST_POINTS: usize = 5;

/// How far the points may scatter about their line, in octaves: with steps that are given, and with a method's own.
const SCATTER: [f64; 2] = [0.25, 2.0];

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

/// Fits the order through points (step, error, what rounding makes of it), the errors that mean nothing being infinite; whether the steps were
/// `given`, or are the method's own.
pub fn order(points: &[(f64, f64, f64)], given: bool) -> Order {
    let comparable: Vec<_> = points.iter().filter(|(h, e, _)| *h > 0.0 && e.is_finite()).collect();
    let mut usable: Vec<(f64, f64)> = comparable
        .iter()
        .filter(|(_, e, rounding)| *e > ABOVE_ROUNDING * rounding && *e > 0.0)
        .map(|(h, e, _)| (h.log2(), e.log2()))
        .collect();
    if usable.len() < LEAST_POINTS {
        return if comparable.len() >= LEAST_POINTS { Order::AtRounding } else { Order::TooFew };
    }
    usable.sort_by(|a, b| a.0.total_cmp(&b.0));
    if given {
        usable.truncate(MOST_POINTS);
    }
    let n = usable.len() as f64;
    let mean = usable.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let (mut xx, mut xy) = (0.0, 0.0);
    for (x, y) in &usable {
        xx += (x - mean.0) * (x - mean.0);
        xy += (x - mean.0) * (y - mean.1);
    }
    if xx == 0.0 {
        return Order::TooFew;
    }
    let slope = xy / xx;
    let scatter = usable.iter().map(|(x, y)| (y - mean.1 - slope * (x - mean.0)).abs()).fold(0.0, f64::max);
    match slope {
        slope if slope < LEAST_SLOPE => Order::NotConverging,
        slope if scatter <= SCATTER[usize::from(!given)] => Order::Fitted(slope),
        _ => Order::Scattered,
    }
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
            let fitted = order(&powers(p, 2f64.powi(-50)), true).value().unwrap();
            assert!((fitted - f64::from(p)).abs() < 0.05, "{p}: {fitted}");
        }
    }

    #[test]
    fn what_is_no_line_gets_none() {
        assert_eq!(order(&powers(4, 1.0), true), Order::NotConverging);
        assert_eq!(order(&powers(9, 2f64.powi(-50))[5..], true), Order::AtRounding);
        assert_eq!(order(&powers(1, 0.0)[..1], true), Order::TooFew);
        let mut wild = powers(1, 0.0);
        wild[6].1 *= 8.0;
        assert_eq!(order(&wild, true), Order::Scattered);
        wild.iter_mut().for_each(|p| p.1 = f64::INFINITY);
        assert_eq!(order(&wild, true), Order::TooFew);
    }
}
