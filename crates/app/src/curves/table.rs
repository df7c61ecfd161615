//! Tables of events, as `carom run --events` and other programs write them, into curves.
//!
//! Between two events the path is the cubic that has both places and both velocities: under constant acceleration that is the exact parabola.
//! A table does not say where balls start, nor what gravity is, so curves begin with the first event, heights are along z, and there is no
//! potential energy.

use super::{Curve, POINTS, Sample};
use crate::error::AppError;
use carom_dynamics::body::State;
use carom_geometry::path::Path as Cubic;
use nalgebra::{Point3, Vector3};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The columns that are needed, of those of a table of events; others are passed over.
#[derive(Debug, Clone, Deserialize)]
struct Row {
    t: f64,
    ball: usize,
    kind: String,
    x: f64,
    y: f64,
    z: f64,
    vx_in: f64,
    vy_in: f64,
    vz_in: f64,
    vx: f64,
    vy: f64,
    vz: f64,
}

impl Row {
    fn position(&self) -> Point3<f64> {
        Point3::new(self.x, self.y, self.z)
    }

    fn before(&self) -> Vector3<f64> {
        Vector3::new(self.vx_in, self.vy_in, self.vz_in)
    }

    fn after(&self) -> Vector3<f64> {
        Vector3::new(self.vx, self.vy, self.vz)
    }
}

/// The curves of the balls in a table of events, .csv or .jsonl.
pub fn read(path: &Path) -> Result<Vec<Curve>, AppError> {
    let shown = path.display().to_string();
    let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    let is_json = match extension.as_deref() {
        Some("jsonl") => true,
        Some("csv") => false,
        _ => {
            let message = format!("{shown}: a scene ends in .toml or .json, a table of events in .csv or .jsonl");
            return Err(AppError::Usage(message));
        }
    };
    let text = std::fs::read_to_string(path).map_err(|source| AppError::Read { path: shown.clone(), source })?;
    let rows = if is_json { json_rows(&text) } else { csv_rows(&text) };
    let rows = rows.map_err(|(line, message)| AppError::Events { path: shown, line, message })?;
    let mut balls: BTreeMap<usize, Vec<Row>> = BTreeMap::new();
    rows.into_iter().for_each(|row| balls.entry(row.ball).or_default().push(row));
    Ok(balls.into_iter().map(|(ball, rows)| curve(ball, rows)).collect())
}

/// Rows, or a line and what is wrong with it.
type Rows = Result<Vec<Row>, (u64, String)>;

fn csv_rows(text: &str) -> Rows {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for row in reader.deserialize() {
        rows.push(row.map_err(|error: csv::Error| {
            let message = match error.kind() {
                csv::ErrorKind::Deserialize { err, .. } => err.to_string(),
                _ => error.to_string(),
            };
            (error.position().map_or(1, csv::Position::line), message)
        })?);
    }
    Ok(rows)
}

fn json_rows(text: &str) -> Rows {
    let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    lines.map(|(n, line)| serde_json::from_str(line).map_err(|error| (n, error.to_string()))).collect()
}

fn curve(ball: usize, mut rows: Vec<Row>) -> Curve {
    rows.sort_by(|a, b| a.t.total_cmp(&b.t));
    let up = Vector3::z();
    let mut samples = Vec::new();
    for pair in rows.windows(2) {
        let [from, to] = [&pair[0], &pair[1]];
        let seconds = to.t - from.t;
        if !(seconds > 0.0 && seconds.is_finite()) {
            continue;
        }
        let (start, end) = (from.after() * seconds, to.before() * seconds);
        let way = to.position() - from.position();
        let cubic =
            Cubic::from_terms(from.position(), &[start, 3.0 * way - 2.0 * start - end, start + end - 2.0 * way]);
        for k in 0..=POINTS {
            let f = f64::from(k) / f64::from(POINTS);
            let state = State { position: cubic.at(f), velocity: cubic.derivative(f) / seconds };
            samples.push(Sample::of(from.t + f * seconds, &state, &up, None));
        }
    }
    Curve {
        ball,
        samples,
        impacts: rows.iter().filter(|row| row.kind == "impact").map(|row| [row.t, row.z]).collect(),
        settled: rows.last().map_or(0.0, |row| row.t),
    }
}
