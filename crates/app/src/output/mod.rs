//! Where results go, and in which form.

pub mod files;
pub mod recorder;
pub mod rows;
pub mod target;

use crate::error::AppError;
use std::path::Path;

/// The form of a table of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated values with a header.
    Csv,
    /// One JSON object a line.
    JsonLines,
}

impl Format {
    /// The form that the extension of `path` names; CSV on standard output.
    pub fn of(path: &Path) -> Result<Self, AppError> {
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            _ if target::is_stdout(path) => Ok(Self::Csv),
            Some("csv") => Ok(Self::Csv),
            Some("jsonl") => Ok(Self::JsonLines),
            _ => {
                Err(AppError::Usage(format!("{}: the form follows from the extension, .csv or .jsonl", path.display())))
            }
        }
    }
}
