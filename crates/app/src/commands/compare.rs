//! `carom compare`: holds the events of any engine against expected ones.

use super::print;
use crate::cli::CompareArgs;
use crate::error::AppError;
use crate::events_file::{Actual, Expected, Happening, Row};
use std::fmt::Write;

/// Deviations that are told one by one; the rest is counted.
const TOLD: usize = 10;

/// The largest deviation of one quantity as a part of its tolerance.
struct Worst {
    what: &'static str,
    unit: &'static str,
    compared: usize,
    /// Deviation, tolerance, their ratio, and where; of the largest ratio.
    largest: Option<(f64, f64, f64, String)>,
}

impl Worst {
    fn of(what: &'static str, unit: &'static str) -> Self {
        Self { what, unit, compared: 0, largest: None }
    }

    /// Takes a deviation in; says whether it is within its tolerance.
    fn see(&mut self, deviation: f64, tolerance: f64, place: &str) -> bool {
        self.compared += 1;
        let ratio = match deviation / tolerance {
            _ if deviation == 0.0 => 0.0,
            ratio if ratio.is_nan() => f64::INFINITY,
            ratio => ratio,
        };
        if self.largest.as_ref().is_none_or(|(_, _, largest, _)| ratio > *largest) {
            self.largest = Some((deviation, tolerance, ratio, place.to_owned()));
        }
        ratio <= 1.0
    }
}

/// Compares two files and prints the worst deviations.
pub fn compare(args: &CompareArgs) -> Result<(), AppError> {
    let expected = Expected::read(&args.expected)?;
    let actual = Actual::read(&args.actual)?;
    let mut worst = [Worst::of("time", "s"), Worst::of("place", "m"), Worst::of("velocity", "m/s")];
    let (mut failures, mut failed) = (Vec::new(), 0);
    for row in &expected.rows {
        let before = failures.len();
        let place = format!("line {}: {} {} of ball {}", row.line, row.kind, row.n, row.ball);
        let all = actual.of(row.ball, row.happens());
        if row.kind == "impacts" {
            if all.len() as u64 != row.n {
                failures.push(format!("line {}: ball {} has {} impacts, not {}", row.line, row.ball, all.len(), row.n));
            }
        } else {
            match usize::try_from(row.n).ok().and_then(|n| all.get(n.checked_sub(1)?)) {
                None => failures.push(format!("{place} is missing: there are {}", all.len())),
                Some(event) => judge(args.loosen, row, event, &place, &mut worst, &mut failures),
            }
        }
        failed += usize::from(failures.len() > before);
    }
    print(&table(&worst, expected.rows.len()))?;
    if failures.is_empty() {
        return Ok(());
    }
    let mut message = format!("{failed} of {} targets are not met", expected.rows.len());
    failures.iter().take(TOLD).for_each(|failure| write!(message, "\n  {failure}").unwrap_or_default());
    if failures.len() > TOLD {
        write!(message, "\n  and {} more", failures.len() - TOLD).unwrap_or_default();
    }
    Err(AppError::Target(message))
}

fn judge(loosen: f64, row: &Row, event: &Happening, place: &str, worst: &mut [Worst; 3], wrong: &mut Vec<String>) {
    let off = |a: &[Option<f64>; 3], b: &[Option<f64>; 3]| {
        let square = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
            (Some(a), Some(b)) => (a - b) * (a - b),
            // What is expected and was not given is not met.
            (Some(_), None) => f64::NAN,
            (None, _) => 0.0,
        };
        a.iter().zip(b).map(square).sum::<f64>().sqrt()
    };
    let pairs = [
        (off(&[row.time, None, None], &[event.time, None, None]), row.tolerances[0]),
        (off(&row.place, &event.place), row.tolerances[1]),
        (off(&row.velocity, &event.velocity), row.tolerances[2]),
    ];
    for ((deviation, tolerance), worst) in pairs.into_iter().zip(worst) {
        let Some(tolerance) = tolerance else { continue };
        let tolerance = loosen * tolerance;
        if !worst.see(deviation, tolerance, place) {
            wrong.push(format!("{}: {} off by {deviation:e} {}, allowed {tolerance:e}", place, worst.what, worst.unit));
        }
    }
}

fn table(worst: &[Worst], rows: usize) -> String {
    let mut text = format!(
        "{rows} targets\n{:<10} {:>8} {:>12} {:>12} {:>10}  where\n",
        "", "compared", "worst", "allowed", "share"
    );
    for w in worst {
        let (deviation, tolerance, ratio, place) = match &w.largest {
            Some((deviation, tolerance, ratio, place)) => {
                (format!("{deviation:.2e}"), format!("{tolerance:.2e}"), format!("{ratio:.3}"), place.as_str())
            }
            None => Default::default(),
        };
        let name = format!("{}, {}", w.what, w.unit);
        let line = format!("{name:<13} {:>5} {deviation:>12} {tolerance:>12} {ratio:>10}  {place}", w.compared);
        text += line.trim_end();
        text.push('\n');
    }
    text
}
