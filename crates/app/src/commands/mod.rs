//! The commands, one file each.

pub mod accuracy;
pub mod balls;
pub mod check;
pub mod compare;
pub mod completions;
pub mod explain;
pub mod export;
pub mod init;
pub mod man;
pub mod materials;
pub mod plot;
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
