//! Lists of balls in CSV: `x,y,z`, and any of `vx,vy,vz,radius,mass`.

use crate::error::AppError;
use crate::scene::problem::{Problem, choose};
use carom_dynamics::body::Ball;
use nalgebra::{Point3, Vector3};
use std::io::Read;
use std::path::Path;

/// The columns that a list may have.
const COLUMNS: [&str; 8] = ["x", "y", "z", "vx", "vy", "vz", "radius", "mass"];

/// The columns that it must have.
const NEEDED: usize = 3;

/// Balls from a list, each with its line.
pub struct BallList {
    /// The balls.
    pub balls: Vec<Ball>,
    path: String,
    lines: Vec<u64>,
}

impl BallList {
    /// The error that a fault of one ball makes.
    pub fn refuse(&self, ball: usize, problem: &Problem) -> AppError {
        AppError::Balls {
            path: self.path.clone(),
            line: self.lines.get(ball).copied().unwrap_or(1),
            message: problem.message().to_owned(),
            help: None,
        }
    }
}

/// Reads the list at `path`; `-` is standard input.
pub fn read(path: &Path) -> Result<BallList, AppError> {
    let (shown, bytes) = if path == Path::new("-") {
        let mut bytes = Vec::new();
        let read = std::io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes);
        ("standard input".to_owned(), read)
    } else {
        (path.display().to_string(), std::fs::read(path))
    };
    let bytes = bytes.map_err(|source| AppError::Read { path: shown.clone(), source })?;
    parse(&bytes, shown)
}

fn parse(bytes: &[u8], path: String) -> Result<BallList, AppError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let fault =
        |line: u64, message: String, help: Option<String>| AppError::Balls { path: path.clone(), line, message, help };
    let broken = |e: csv::Error| fault(e.position().map_or(1, csv::Position::line), csv_message(&e), None);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let columns =
        columns(reader.headers().map_err(broken)?).map_err(|(message, help)| fault(1, message, Some(help)))?;
    let (mut balls, mut lines) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(1, csv::Position::line);
        let mut values = [None; COLUMNS.len()];
        for (word, &column) in record.iter().zip(&columns) {
            values[column] = match word.parse::<f64>() {
                _ if word.is_empty() && column >= NEEDED => None,
                Ok(x) if x.is_finite() => Some(x),
                Ok(_) => return Err(fault(line, format!("{} is `{word}`, but must be finite", COLUMNS[column]), None)),
                Err(_) => {
                    return Err(fault(line, format!("{} is `{word}`, which is not a number", COLUMNS[column]), None));
                }
            };
        }
        let [x, y, z, vx, vy, vz, radius, mass] = values;
        let or_zero = |v: Option<f64>| v.unwrap_or(0.0);
        let position = Point3::new(or_zero(x), or_zero(y), or_zero(z));
        let velocity = Vector3::new(or_zero(vx), or_zero(vy), or_zero(vz));
        let ball = Ball::new(position, velocity, or_zero(radius), mass);
        balls.push(ball.map_err(|e| fault(line, e.to_string(), None))?);
        lines.push(line);
    }
    Ok(BallList { balls, path, lines })
}

/// For each column of the list, which of `COLUMNS` it is; or what is wrong with the header, and what would be right.
fn columns(header: &csv::StringRecord) -> Result<Vec<usize>, (String, String)> {
    let mut columns = Vec::with_capacity(header.len());
    for name in header {
        let Some(column) = COLUMNS.iter().position(|c| *c == name) else {
            return Err((format!("unknown column `{name}`"), choose(name, "valid columns", COLUMNS)));
        };
        if columns.contains(&column) {
            return Err((format!("the column `{name}` is given twice"), "leave one out".to_owned()));
        }
        columns.push(column);
    }
    match (0..NEEDED).find(|needed| !columns.contains(needed)) {
        Some(missing) => Err((
            format!("the column `{}` is missing", COLUMNS[missing]),
            "the first line names the columns: x,y,z and any of vx,vy,vz,radius,mass".to_owned(),
        )),
        None => Ok(columns),
    }
}

fn csv_message(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("the line has {len} values, but the header has {expected_len} columns")
        }
        csv::ErrorKind::Utf8 { .. } => "the line is not UTF-8 text".to_owned(),
        _ => error.to_string(),
    }
}
