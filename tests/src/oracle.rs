//! Tables of closed forms, read by the names of their columns, and the worst error of a test beside its bound.

use crate::data;

/// u, the unit roundoff of f64.
pub const U: f64 = 1.0 / (1u64 << 53) as f64;

/// A table of `tests/data/oracles`.
#[derive(Debug)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// A row of a table.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a> {
    table: &'a Table,
    cells: &'a [String],
}

impl Table {
    /// The table `name`, without its folder and ending.
    pub fn read(name: &str) -> Self {
        let path = format!("oracles/{name}.csv");
        let text = data::read(&path);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let cells = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
        let columns = cells(reader.headers().unwrap_or_else(|e| panic!("{path}: {e}")));
        let rows: Vec<_> = reader.records().map(|r| cells(&r.unwrap_or_else(|e| panic!("{path}: {e}")))).collect();
        assert!(!rows.is_empty(), "{path} has no rows");
        Self { columns, rows }
    }

    /// All rows.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { table: self, cells })
    }

    /// The rows in runs that agree in the first `keys` columns.
    pub fn groups(&self, keys: usize) -> Vec<Vec<Row<'_>>> {
        let mut groups: Vec<Vec<Row>> = Vec::new();
        for row in self.rows() {
            match groups.last_mut() {
                Some(group) if group[0].cells[..keys] == row.cells[..keys] => group.push(row),
                _ => groups.push(vec![row]),
            }
        }
        groups
    }
}

impl<'a> Row<'a> {
    /// The text in `column`; panics if there is no such column.
    pub fn text(&self, column: &str) -> &'a str {
        let place = self.table.columns.iter().position(|name| name == column);
        &self.cells[place.unwrap_or_else(|| panic!("no column {column} in {:?}", self.table.columns))]
    }

    /// The number in `column`; panics if it is none.
    pub fn number(&self, column: &str) -> f64 {
        data::number(self.text(column))
    }

    /// The numbers in several columns.
    pub fn numbers<const N: usize>(&self, columns: [&str; N]) -> [f64; N] {
        columns.map(|column| self.number(column))
    }
}

/// The worst error of many, each measured against a bound of its own.
#[derive(Debug)]
pub struct Worst {
    what: &'static str,
    count: u64,
    /// The worst error over its bound.
    ratio: f64,
    at: String,
}

impl Worst {
    /// Of nothing yet.
    pub fn of(what: &'static str) -> Self {
        Self { what, count: 0, ratio: 0.0, at: "none".to_owned() }
    }

    /// Compares `value` with what it should be; `place` says where, if it is the worst so far.
    pub fn see(&mut self, value: f64, right: f64, bound: f64, place: impl Fn() -> String) {
        self.count += 1;
        let error = (value - right).abs();
        let ratio = if error == 0.0 { 0.0 } else { error / bound };
        // An error that is not a number is the worst.
        let ratio = if ratio.is_nan() { f64::INFINITY } else { ratio };
        if ratio > self.ratio {
            self.ratio = ratio;
            self.at = format!("{value:e}, should be {right:e}, off by {error:.1e} of {bound:.1e}, {}", place());
        }
    }

    /// Prints the worst, and fails if it is above its bound or if nothing was compared.
    #[track_caller]
    pub fn settle(self) {
        println!("{}: {} compared, worst error {:.2} of its bound: {}", self.what, self.count, self.ratio, self.at);
        assert!(self.count > 0, "{}: nothing was compared", self.what);
        assert!(self.ratio <= 1.0, "{}: {}", self.what, self.at);
    }

    /// Settles several.
    #[track_caller]
    pub fn settle_all<const N: usize>(all: [Self; N]) {
        for worst in all {
            worst.settle();
        }
    }
}
