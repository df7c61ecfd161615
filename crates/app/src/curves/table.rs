//! Curves of tables of events, as `carom run --events` and other programs write them.
//!
//! Between two events the path is the cubic that has both places and both velocities: under constant acceleration that is the exact parabola.
//! A table does not say where balls start, nor what gravity is, so curves begin with the first event, heights are along z, and there is no
//! potential energy.

use super::{Curve, POINTS, Sample};
use crate::error::AppError;
use crate::events_file::{Table, line};
use carom_dynamics::body::State;
use carom_geometry::path::Path as Cubic;
use nalgebra::{Point3, Vector3};
use std::collections::BTreeMap;
use std::path::Path;

/// The columns of numbers that are needed; others are passed over.
const NUMBERS: [&str; 10] = ["t", "x", "y", "z", "vx_in", "vy_in", "vz_in", "vx", "vy", "vz"];

/// An event.
struct Row {
    time: f64,
    is_impact: bool,
    position: Point3<f64>,
    before: Vector3<f64>,
    after: Vector3<f64>,
}

/// The curves of the balls in a table of events, a .csv.
pub fn read(path: &Path) -> Result<Vec<Curve>, AppError> {
    if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("csv")) {
        let shown = path.display();
        return Err(AppError::Usage(format!("{shown}: a scene ends in .toml or .json, a table of events in .csv")));
    }
    let table = Table::read(path)?;
    let mut needed = NUMBERS.iter().chain(&["ball", "kind"]);
    if let Some(missing) = needed.find(|name| table.column(name).is_none()) {
        let message = format!("there is no column `{missing}`; needed are ball, kind, {}", NUMBERS.join(", "));
        return Err(table.fault(1, message));
    }
    let mut balls: BTreeMap<u64, Vec<Row>> = BTreeMap::new();
    for record in &table.records {
        let cells = table.numbers(record, NUMBERS)?;
        if let Some(empty) = cells.iter().position(Option::is_none) {
            return Err(table.fault(line(record), format!("{} is empty", NUMBERS[empty])));
        }
        let [time, x, y, z, ax, ay, az, bx, by, bz] = cells.map(|cell| cell.unwrap_or_default());
        balls.entry(table.count(record, "ball")?).or_default().push(Row {
            time,
            is_impact: table.text(record, "kind") == "impact",
            position: Point3::new(x, y, z),
            before: Vector3::new(ax, ay, az),
            after: Vector3::new(bx, by, bz),
        });
    }
    Ok(balls.into_iter().map(|(ball, rows)| curve(ball as usize, rows)).collect())
}

fn curve(ball: usize, mut rows: Vec<Row>) -> Curve {
    rows.sort_by(|a, b| a.time.total_cmp(&b.time));
    let up = Vector3::z();
    let mut samples = Vec::new();
    for pair in rows.windows(2) {
        let [from, to] = [&pair[0], &pair[1]];
        let seconds = to.time - from.time;
        if !(seconds > 0.0 && seconds.is_finite()) {
            continue;
        }
        let (start, end) = (from.after * seconds, to.before * seconds);
        let way = to.position - from.position;
        let cubic = Cubic::from_terms(from.position, &[start, 3.0 * way - 2.0 * start - end, start + end - 2.0 * way]);
        for k in 0..=POINTS {
            let f = f64::from(k) / f64::from(POINTS);
            let state = State { position: cubic.at(f), velocity: cubic.derivative(f) / seconds };
            samples.push(Sample::of(from.time + f * seconds, &state, &up, None));
        }
    }
    Curve {
        ball,
        samples,
        impacts: rows.iter().filter(|row| row.is_impact).map(|row| [row.time, row.position.z]).collect(),
        settled: rows.last().map_or(0.0, |row| row.time),
    }
}
