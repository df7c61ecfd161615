//! `cargo xtask certification`: what certification costs, measured here and kept in a file of which the README shows a copy.

use crate::Result;
use crate::project::{Project, output};
use std::fs;
use std::process::ExitCode;

/// What was measured last.
const KEPT: &str = "tests/data/certification.md";

/// Measures, prints and keeps the table.
pub fn run() -> Result<ExitCode> {
    let project = Project::find()?;
    let program = ["run", "--quiet", "--release", "--package", "carom-tests", "--bin", "certification"];
    let (table, _) = output(&mut project.cargo(program))?;
    print!("{table}");
    fs::write(project.root().join(KEPT), table)?;
    Ok(ExitCode::SUCCESS)
}

/// The table that was kept; times are those of one machine, so its shape is all that can be checked.
pub fn block(project: &Project) -> Result<String> {
    let table = project.read(KEPT)?;
    let cells = |line: &str| line.matches(" | ").count();
    let mut lines = table.lines();
    let header = lines.next().map(cells);
    let rows = lines.skip(1).filter(|line| Some(cells(line)) == header).count();
    if rows < 6 {
        return Err(format!("{KEPT} has {rows} rows; `cargo xtask certification` writes it anew").into());
    }
    Ok(table)
}
