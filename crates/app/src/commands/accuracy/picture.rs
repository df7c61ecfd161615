//! The work-precision plot: error over cost, both logarithmic, one line a method.

use crate::plot::{Across, Axis, Chart, Drawn, Rule, Series};
use carom_dynamics::accuracy::{Measurement, Report, Sweep, Variant};
use std::fmt::Write;

/// An error of 0 is drawn here, in m: below the rounding of anything in a scene of metres.
const NOTHING: f64 = 1e-18;

/// The plot of a report on the scene `name`, with a line at the target if there is one.
pub fn chart(report: &Report, name: &str, target: Option<f64>) -> Chart {
    let timed = report.measurements().all(|m| m.cost.is_some());
    let cost = if timed { "time for a second of one ball, ns" } else { "work for a second of one ball, nominal ns" };
    let title = format!("What accuracy costs: {name}");
    let (x, y) = (Axis::log(cost), Axis::log("largest error of a position, m"));
    let mut chart = Chart::new(title, description(report, name, timed), x, y);
    for sweep in &report.sweeps {
        let look = Variant::ALL.iter().position(|v| *v == sweep.variant).unwrap_or(0);
        let points = sweep.measurements.iter().map(|m| [price(m), m.errors.position.max(NOTHING)]);
        let series = Series::new(sweep.variant.name(), look, points.collect());
        let drawn = if series.points.len() > 1 { Drawn::Both } else { Drawn::Marks };
        chart.series.push(series.drawn(drawn));
    }
    if let Some(value) = target {
        chart.rules.push(Rule { across: Across::Y, value, label: format!("target {value:e} m") });
    }
    chart
}

fn price(m: &Measurement) -> f64 {
    m.cost.map_or(m.work, |cost| cost.per_second)
}

/// What the picture shows, in words.
fn description(report: &Report, name: &str, timed: bool) -> String {
    let what = if timed { "time" } else { "counted work" };
    let mut text = format!(
        "Logarithmic plot of the largest error of a position over {what}, scene {name}. Lower is better, left is cheaper."
    );
    let span = |sweep: &Sweep| {
        let errors = sweep.measurements.iter().map(|m| m.errors.position);
        let (least, most) = errors.fold((f64::INFINITY, 0.0_f64), |(a, b), e| (a.min(e), b.max(e)));
        (least, most)
    };
    for sweep in &report.sweeps {
        let (least, most) = span(sweep);
        // A string takes everything that is written to it.
        let _ = write!(text, " {}: error {least:.0e} to {most:.0e} m", sweep.variant.name());
        if let Some(order) = sweep.order.value() {
            let _ = write!(text, ", order {order:.1}");
        }
        text.push('.');
    }
    text
}
