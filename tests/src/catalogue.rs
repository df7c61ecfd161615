//! The catalogue of hard cases: what breaks simulators elsewhere, run here, with our figure and the bound it must keep.

pub mod detection;
pub mod response;

/// A hard case.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// The row of the catalogue, `H1` to `H32`; a row may have several cases.
    pub id: &'static str,
    /// What is hard about it.
    pub title: &'static str,
    /// What happens elsewhere, with the thread that tells.
    pub elsewhere: &'static str,
    /// What our figure must keep.
    pub bound: &'static str,
    /// Runs it.
    pub run: fn() -> Figure,
}

/// What a case came to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// The figure in words; if the bound is broken, by what.
    pub text: String,
    /// Whether the bound is kept.
    pub holds: bool,
}

/// Every case, in the order of the rows.
pub fn all() -> Vec<Case> {
    let mut cases: Vec<Case> = detection::cases().into_iter().chain(response::cases()).collect();
    cases.sort_by_key(|case| case.id[1..].parse::<u32>().unwrap_or(u32::MAX));
    cases
}

/// Runs every case.
pub fn run() -> Vec<(Case, Figure)> {
    all().into_iter().map(|case| (case, (case.run)())).collect()
}

/// The results as a table in Markdown: the case, what breaks elsewhere, our figure, the bound.
pub fn table_of(results: &[(Case, Figure)]) -> String {
    let mut table = String::from("| | case | elsewhere | ours | bound |\n|---|---|---|---|---|\n");
    for (case, figure) in results {
        let mark = if figure.holds { "" } else { "**BROKEN** " };
        let cells = [case.id, case.title, case.elsewhere, &format!("{mark}{}", figure.text), case.bound];
        let cells = cells.map(|cell| cell.replace('|', "\\|"));
        table.push_str(&format!("| {} |\n", cells.join(" | ")));
    }
    table
}

/// Runs every case and gives the table.
pub fn table() -> String {
    table_of(&run())
}

/// Collects what breaks a bound while a case runs.
#[derive(Debug, Default)]
pub(crate) struct Bound {
    broken: Vec<String>,
}

impl Bound {
    /// Notes `what` unless `ok`.
    pub fn keep(&mut self, ok: bool, what: impl FnOnce() -> String) {
        if !ok {
            self.broken.push(what());
        }
    }

    /// The figure: `text`, and the first that broke the bound, if any did.
    pub fn figure(self, text: String) -> Figure {
        match self.broken.first() {
            None => Figure { text, holds: true },
            Some(first) => {
                Figure { text: format!("{text}; {} broken, first: {first}", self.broken.len()), holds: false }
            }
        }
    }
}

/// The largest of some numbers, and NaN if one of them is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Worst(pub f64);

impl Worst {
    /// Of none yet.
    pub fn new() -> Self {
        Self(f64::NEG_INFINITY)
    }

    /// Takes `x` in.
    pub fn of(&mut self, x: f64) {
        if x.is_nan() || x > self.0 {
            self.0 = x;
        }
    }
}
