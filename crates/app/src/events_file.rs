//! Files of events, read: expected ones with their tolerances, and those of any engine.

use crate::error::AppError;
use csv::StringRecord;
use std::collections::BTreeMap;
use std::path::Path;

/// The columns of expected events.
const EXPECTED: [&str; 13] = ["ball", "kind", "n", "t", "x", "y", "z", "vx", "vy", "vz", "dt", "dx", "dv"];

/// What may be expected.
const KINDS: [&str; 6] = ["impact", "slide", "rest", "leave", "wake", "impacts"];

/// One target: the n-th event of a kind, or the number of impacts.
#[derive(Debug, Clone)]
pub struct Row {
    /// Where it stands in its file, from 1.
    pub line: u64,
    /// Whose it is, from 0.
    pub ball: u64,
    /// One of `impact`, `slide`, `rest`, `leave`, `wake`; or `impacts`, for their number.
    pub kind: String,
    /// Which of its kind, from 1; or how many there are.
    pub n: u64,
    /// When, in s; not compared if none.
    pub time: Option<f64>,
    /// Where the centre is, in m; coordinates that are none are not compared.
    pub place: [Option<f64>; 3],
    /// The velocity afterwards, in m/s.
    pub velocity: [Option<f64>; 3],
    /// How far the time (s), the place (m) and the velocity (m/s) may be off; what has none is not compared.
    pub tolerances: [Option<f64>; 3],
}

impl Row {
    /// The kind of event it is about.
    pub fn happens(&self) -> &str {
        if self.kind == "impacts" { "impact" } else { &self.kind }
    }
}

/// The targets of a file.
pub struct Expected {
    /// In the order of the file.
    pub rows: Vec<Row>,
}

/// One event of an engine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Happening {
    /// When, in s.
    pub time: Option<f64>,
    /// Where the centre is, in m, as far as the file tells.
    pub place: [Option<f64>; 3],
    /// The velocity afterwards, in m/s.
    pub velocity: [Option<f64>; 3],
}

/// The events of an engine by ball and kind, in the order of the file; those of one ball, one kind and one time are one.
pub struct Actual(BTreeMap<(u64, String), Vec<Happening>>);

impl Expected {
    /// Reads a file; a line that begins with `#` is a comment.
    pub fn read(path: &Path) -> Result<Self, AppError> {
        let table = Table::read(path)?;
        if let Some(missing) = EXPECTED.iter().find(|name| table.column(name).is_none()) {
            return Err(table.fault(1, format!("there is no column `{missing}`; needed are {}", EXPECTED.join(","))));
        }
        let rows: Result<Vec<Row>, AppError> = table.records.iter().map(|record| row(&table, record)).collect();
        let rows = rows?;
        if rows.is_empty() {
            return Err(table.fault(1, "it holds no targets".to_owned()));
        }
        Ok(Self { rows })
    }
}

fn row(table: &Table, record: &StringRecord) -> Result<Row, AppError> {
    let kind = table.text(record, "kind");
    if !KINDS.contains(&kind) {
        return Err(table.fault(line(record), format!("`{kind}` is no kind; there are {}", KINDS.join(", "))));
    }
    let tolerances = table.numbers(record, ["dt", "dx", "dv"])?;
    if let Some(negative) = tolerances.iter().flatten().find(|d| **d < 0.0) {
        return Err(table.fault(line(record), format!("a tolerance of {negative} is none; it must be >= 0")));
    }
    Ok(Row {
        line: line(record),
        ball: table.count(record, "ball")?,
        kind: kind.to_owned(),
        n: table.count(record, "n")?,
        time: table.numbers(record, ["t"])?[0],
        place: table.numbers(record, ["x", "y", "z"])?,
        velocity: table.numbers(record, ["vx", "vy", "vz"])?,
        tolerances,
    })
}

impl Actual {
    /// Reads a file with the columns `t`, `ball` and `kind`, and any of `x,y,z,vx,vy,vz`; other columns do not matter.
    pub fn read(path: &Path) -> Result<Self, AppError> {
        let table = Table::read(path)?;
        if let Some(missing) = ["t", "ball", "kind"].iter().find(|name| table.column(name).is_none()) {
            return Err(table.fault(1, format!("there is no column `{missing}`; needed are t, ball and kind")));
        }
        let mut all: BTreeMap<(u64, String), Vec<Happening>> = BTreeMap::new();
        for record in &table.records {
            let event = Happening {
                time: table.numbers(record, ["t"])?[0],
                place: table.numbers(record, ["x", "y", "z"])?,
                velocity: table.numbers(record, ["vx", "vy", "vz"])?,
            };
            let key = (table.count(record, "ball")?, table.text(record, "kind").to_owned());
            let events = all.entry(key).or_default();
            // An impact at several surfaces at once is one.
            match events.last_mut() {
                Some(last) if last.time == event.time => *last = event,
                _ => events.push(event),
            }
        }
        Ok(Self(all))
    }

    /// The events of a ball and a kind.
    pub fn of(&self, ball: u64, kind: &str) -> &[Happening] {
        self.0.get(&(ball, kind.to_owned())).map_or(&[], Vec::as_slice)
    }
}

/// A CSV file with a header; a line that begins with `#` is a comment.
pub struct Table {
    path: String,
    columns: StringRecord,
    /// The lines.
    pub records: Vec<StringRecord>,
}

/// The number of a line, from 1.
pub fn line(record: &StringRecord) -> u64 {
    record.position().map_or(1, csv::Position::line)
}

impl Table {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self, AppError> {
        let shown = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|source| AppError::Read { path: shown.clone(), source })?;
        let mut reader =
            csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(bytes.as_slice());
        let fault = |error: csv::Error| {
            let line = error.position().map_or(1, csv::Position::line);
            AppError::Events { path: shown.clone(), line, message: error.to_string() }
        };
        let columns = reader.headers().map_err(fault)?.clone();
        let records = reader.records().collect::<Result<_, _>>().map_err(fault)?;
        Ok(Self { path: shown, columns, records })
    }

    /// The place of the column of a name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }

    /// A cell; empty if there is none.
    pub fn text<'a>(&self, record: &'a StringRecord, name: &str) -> &'a str {
        self.column(name).and_then(|i| record.get(i)).unwrap_or_default()
    }

    /// Cells that are numbers, or empty.
    pub fn numbers<const N: usize>(
        &self,
        record: &StringRecord,
        names: [&str; N],
    ) -> Result<[Option<f64>; N], AppError> {
        let mut numbers = [None; N];
        for (number, name) in numbers.iter_mut().zip(names) {
            let text = self.text(record, name);
            if text.is_empty() {
                continue;
            }
            match text.parse::<f64>() {
                Ok(x) if x.is_finite() => *number = Some(x),
                _ => return Err(self.fault(line(record), format!("{name} = `{text}` is not a finite number"))),
            }
        }
        Ok(numbers)
    }

    /// A cell that is a whole number.
    pub fn count(&self, record: &StringRecord, name: &str) -> Result<u64, AppError> {
        let text = self.text(record, name);
        text.parse().map_err(|_| self.fault(line(record), format!("{name} = `{text}` is not a whole number")))
    }

    /// The error that something wrong in a line makes.
    pub fn fault(&self, line: u64, message: String) -> AppError {
        AppError::Events { path: self.path.clone(), line, message }
    }
}
