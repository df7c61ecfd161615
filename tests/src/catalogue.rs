//! The catalogue of hard cases: what breaks elsewhere, what comes out here, and the bound it must keep.

pub mod response;

/// One hard case.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Its row of the catalogue, such as "H1".
    pub id: &'static str,
    /// What it is.
    pub title: &'static str,
    /// What breaks elsewhere, in a line.
    pub elsewhere: &'static str,
    /// What must hold.
    pub bound: &'static str,
    /// Runs it.
    pub run: fn() -> Figure,
}

/// What came of a case.
#[derive(Debug, Clone)]
pub struct Figure {
    /// The figure.
    pub text: String,
    /// Whether it keeps the bound.
    pub holds: bool,
}

/// Every case, in the order of the catalogue.
pub fn all() -> Vec<Case> {
    response::cases()
}
