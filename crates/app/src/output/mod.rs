//! Where results go, and in which form.

pub mod files;
#[cfg_attr(not(feature = "parquet"), path = "no_parquet.rs")]
mod parquet;
pub mod recorder;
pub mod rows;
pub mod target;

use crate::error::AppError;
use std::path::Path;

/// The form of rows of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated values with a header.
    Csv,
    /// One JSON object a line.
    JsonLines,
}

/// The form of a table of results: rows of text by some `R`, or columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form<R> {
    /// Row by row.
    Rows(R),
    /// Column by column, in Parquet.
    Columns,
}

impl<R> Form<R> {
    /// The same form, its rows by what `make` makes.
    pub fn map<S>(self, make: impl FnOnce(R) -> S) -> Form<S> {
        match self {
            Form::Rows(rows) => Form::Rows(make(rows)),
            Form::Columns => Form::Columns,
        }
    }
}

impl Form<Format> {
    /// The form that the extension of `path` names; CSV on standard output.
    pub fn of(path: &Path) -> Result<Self, AppError> {
        let refused = |why: &str| AppError::Usage(format!("{}: {why}", path.display()));
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            _ if target::is_stdout(path) => Ok(Self::Rows(Format::Csv)),
            Some("csv") => Ok(Self::Rows(Format::Csv)),
            Some("jsonl") => Ok(Self::Rows(Format::JsonLines)),
            Some("parquet") => Ok(Self::Columns),
            _ => Err(refused("the form follows from the extension: .csv, .jsonl or .parquet")),
        }
    }
}
