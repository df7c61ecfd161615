//! The measurements as text for the eye, and as CSV.

use carom_dynamics::accuracy::{Measurement, Parameter, Report, Variant};
use carom_dynamics::scene::Scene;
use std::fmt::Write;

/// A table whose columns line up.
struct Columns {
    rows: Vec<Vec<String>>,
}

impl Columns {
    fn new<const N: usize>(header: [&str; N]) -> Self {
        Self { rows: vec![header.iter().map(|s| (*s).to_owned()).collect()] }
    }

    fn push<const N: usize>(&mut self, row: [String; N]) {
        self.rows.push(row.into());
    }

    /// The first column to the left, the others to the right.
    fn text(&self) -> String {
        let count = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width =
            |k: usize| self.rows.iter().filter_map(|row| row.get(k)).map(|s| s.chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..count).map(width).collect();
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::new();
            for (k, cell) in row.iter().enumerate() {
                let width = widths[k];
                // A string takes everything that is written to it.
                let _ = if k == 0 { write!(line, "{cell:<width$}") } else { write!(line, "  {cell:>width$}") };
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }
}

/// The report for the terminal.
pub fn text(report: &Report, name: &str, scene: &Scene) -> String {
    let mut text = String::new();
    let balls = if report.balls == 1 { "1 ball".to_owned() } else { format!("{} balls", report.balls) };
    let _ = writeln!(
        text,
        "What accuracy costs: {name}, {balls}, {} s, {} impacts\nreference: {}, itself good to {:.0e} m\n\
         positions are compared up to {:.4} s; until then small differences grow up to {:.1}-fold",
        scene.duration, report.impacts, report.reference, report.reference_error, report.until, report.growth
    );
    let _ = writeln!(text, "\nErrors, at worst over balls and time\n\n{}", errors(report).text());
    let _ = writeln!(text, "Parts of the error of the positions, and the cost\n\n{}", costs(report).text());
    let _ = writeln!(text, "Orders of convergence, measured and by the textbook\n\n{}", orders(report).text());
    if let Some(laws) = laws(report) {
        let _ = writeln!(
            text,
            "Euler's laws, measured as a multiple of what they say: height + g t h/2, impact h/2 late, energy + m g^2 h^2/2 a step\n\n{}",
            laws.text()
        );
    }
    let _ = writeln!(text, "What each digit costs: no other is both cheaper and better\n\n{}", front(report).text());
    if !report.resolutions.is_empty() {
        let _ = writeln!(
            text,
            "Discretisation of the surfaces: the same scene on its meshes and on finer ones, beside the finest\n\n{}",
            resolutions(report).text()
        );
    }
    if let Some(ends) = ends(report) {
        let _ = writeln!(text, "At the end: what means something when positions do not\n\n{}", ends.text());
    }
    for remark in &report.remarks {
        let _ = writeln!(text, "note: {remark}");
    }
    text
}

/// A method with its step or tolerance, as a scene asks for it.
pub fn setting(m: &Measurement) -> String {
    match m.variant.parameter() {
        Parameter::Step => format!("{} with step {}", m.variant.name(), value(m)),
        Parameter::Tolerance => format!("{} with tolerance {}", m.variant.name(), value(m)),
        Parameter::None => m.variant.name().to_owned(),
    }
}

fn value(m: &Measurement) -> String {
    match m.variant.parameter() {
        // Steps are powers of two.
        Parameter::Step if m.value < 1.0 => format!("1/{}", 1.0 / m.value),
        Parameter::Step => format!("{}", m.value),
        Parameter::Tolerance => format!("{:.0e}", m.value),
        Parameter::None => "-".to_owned(),
    }
}

/// Nanoseconds for the eye.
pub fn time(ns: f64) -> String {
    match ns {
        ns if ns < 1e3 => format!("{ns:.0} ns"),
        ns if ns < 1e6 => format!("{:.1} us", ns / 1e3),
        ns => format!("{:.1} ms", ns / 1e6),
    }
}

fn error(x: f64) -> String {
    match x {
        0.0 => "0".to_owned(),
        x if x.is_finite() => format!("{x:.1e}"),
        _ => "ended".to_owned(),
    }
}

fn optional(x: Option<f64>) -> String {
    x.map_or("-".to_owned(), error)
}

fn errors(report: &Report) -> Columns {
    let mut table = Columns::new([
        "method",
        "step, s",
        "position, m",
        "in flight, m",
        "impact time, s",
        "missed",
        "invented",
        "energy, rel.",
        "penetration, m",
    ]);
    for m in report.measurements() {
        let e = &m.errors;
        table.push([
            m.variant.name().to_owned(),
            value(m),
            error(e.position),
            error(e.flight),
            optional(e.impact_time),
            e.missed.to_string(),
            e.invented.to_string(),
            error(e.energy),
            error(e.penetration),
        ]);
    }
    table
}

fn costs(report: &Report) -> Columns {
    let mut table = Columns::new([
        "method",
        "step, s",
        "integration",
        "determination",
        "rounding",
        "ns per s",
        "ns per impact",
        "work",
        "paths",
        "evaluations",
        "clearances",
        "faces",
        "rounds",
    ]);
    for m in report.measurements() {
        let c = &m.counters;
        let clock = |ns: Option<f64>| ns.map_or("-".to_owned(), |ns| format!("{ns:.0}"));
        table.push([
            m.variant.name().to_owned(),
            value(m),
            error(m.shares.integration),
            error(m.shares.determination),
            error(m.shares.rounding),
            clock(m.cost.map(|cost| cost.per_second)),
            clock(m.cost.and_then(|cost| cost.per_impact)),
            format!("{:.0}", m.work),
            c.paths.to_string(),
            c.accelerations.to_string(),
            c.clearances.to_string(),
            c.triangles.to_string(),
            c.rounds.to_string(),
        ]);
    }
    table
}

fn orders(report: &Report) -> Columns {
    let mut table = Columns::new(["method", "in flight", "textbook", "with bounces", "textbook", "what it is"]);
    for sweep in &report.sweeps {
        let theory = sweep.variant.textbook_orders();
        let order = |k: usize| theory.map_or("exact".to_owned(), |orders| orders[k].to_string());
        table.push([
            sweep.variant.name().to_owned(),
            sweep.flight_order.to_string(),
            order(0),
            sweep.order.to_string(),
            order(1),
            sweep.variant.description().to_owned(),
        ]);
    }
    table
}

fn laws(report: &Report) -> Option<Columns> {
    let mut table = Columns::new(["method", "step, s", "height", "impact", "energy"]);
    for m in report.measurements() {
        let Some(laws) = m.laws.filter(|_| m.variant != Variant::SlidesOwnF) else { continue };
        let late = laws.late.map_or("-".to_owned(), |late| format!("{late:.5}"));
        table.push([
            m.variant.name().to_owned(),
            value(m),
            format!("{:.5}", laws.height),
            late,
            format!("{:.5}", laws.energy),
        ]);
    }
    (table.rows.len() > 1).then_some(table)
}

fn front(report: &Report) -> Columns {
    let mut table = Columns::new(["method", "step, s", "position, m", "ns per s", "work"]);
    for m in report.front() {
        let clock = m.cost.map_or("-".to_owned(), |cost| format!("{:.0}", cost.per_second));
        table.push([m.variant.name().to_owned(), value(m), error(m.errors.position), clock, format!("{:.0}", m.work)]);
    }
    table
}

fn resolutions(report: &Report) -> Columns {
    let mut table = Columns::new(["faces", "first bounce, m", "position, m", "first impact, s"]);
    for r in &report.resolutions {
        table.push([r.faces.to_string(), error(r.first_bounce), error(r.position), optional(r.first_impact)]);
    }
    table
}

/// The reference beside the finest run of each method.
fn ends(report: &Report) -> Option<Columns> {
    let reference = report.ends?;
    let mut table = Columns::new(["method", "step, s", "impacts", "resting", "mean energy, J/kg", "spread, m"]);
    let cells = |e: &carom_dynamics::accuracy::Ends| {
        [e.impacts.to_string(), e.resting.to_string(), format!("{:.4}", e.energy), format!("{:.4}", e.spread)]
    };
    let [impacts, resting, energy, spread] = cells(&reference);
    table.push(["reference".to_owned(), String::new(), impacts, resting, energy, spread]);
    for m in report.sweeps.iter().filter_map(|sweep| sweep.measurements.last()) {
        let [impacts, resting, energy, spread] = cells(&m.ends);
        table.push([m.variant.name().to_owned(), value(m), impacts, resting, energy, spread]);
    }
    Some(table)
}

/// All measurements, their numbers so that they read back to the same bits; what is not there is empty.
pub fn csv(report: &Report) -> String {
    let mut text = String::from(
        "method,step,tolerance,position_error,flight_error,impact_time_error,first_impact_error,missed,invented,energy_error,\
         penetration,integration,determination,rounding,off_touch,effective_step,end_impacts,end_resting,end_energy,end_spread,work",
    );
    let names = report.measurements().next().map(|m| m.counters.named().map(|(name, _)| name));
    names.iter().flatten().for_each(|name| {
        let _ = write!(text, ",{name}");
    });
    text.push_str(",ns_per_second,ns_per_impact\n");
    for m in report.measurements() {
        let only =
            |parameter| if m.variant.parameter() == parameter { format!("{:?}", m.value) } else { String::new() };
        let optional = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:?}"));
        let name = m.variant.name();
        let (e, s) = (&m.errors, &m.shares);
        let _ = write!(
            text,
            "{name},{},{},{:?},{:?},{},{},{},{},{:?},{:?},{:?},{:?},{:?},{:?},{:.6e},{},{},{:?},{:?},{:?}",
            only(Parameter::Step),
            only(Parameter::Tolerance),
            e.position,
            e.flight,
            optional(e.impact_time),
            optional(e.first_impact),
            e.missed,
            e.invented,
            e.energy,
            e.penetration,
            s.integration,
            s.determination,
            s.rounding,
            e.off_touch,
            m.step,
            m.ends.impacts,
            m.ends.resting,
            m.ends.energy,
            m.ends.spread,
            m.work
        );
        for (_, count) in m.counters.named() {
            let _ = write!(text, ",{count}");
        }
        let per_impact = m.cost.and_then(|cost| cost.per_impact);
        let _ = writeln!(text, ",{},{}", optional(m.cost.map(|cost| cost.per_second)), optional(per_impact));
    }
    text
}
