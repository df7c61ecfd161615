//! `cargo xtask certification`: what certification costs.

use crate::Result;
use crate::kept::Kept;
use crate::project::Project;
use std::process::ExitCode;

/// What was measured last.
pub const TABLE: Kept = Kept { file: "tests/data/certification.md", rows: 6, command: "certification" };

/// Measures, prints and keeps the table.
pub fn run() -> Result<ExitCode> {
    let project = Project::find()?;
    let program = ["run", "--quiet", "--release", "--package", "carom-tests", "--bin", "certification"];
    TABLE.measure(&project, &mut project.cargo(program))
}
