//! The commands, one file each.

pub mod accuracy;
pub mod check;
pub mod completions;
pub mod export;
pub mod materials;
pub mod run;
pub mod schema;
pub mod view;

use crate::error::AppError;
use crate::output::target::Target;
use std::path::Path;

/// Prints `text` on standard output.
fn print(text: &str) -> Result<(), AppError> {
    let mut out = Target::open(Path::new("-"))?;
    out.write(text.as_bytes())?;
    out.finish()
}
