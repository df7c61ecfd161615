//! Tasks that are programs of the tests' own crate.

use crate::Result;
use crate::project::Project;
use std::process::ExitCode;

/// Runs `cargo run --package carom-tests` with these arguments in the root; its exit code is the task's.
pub fn run(arguments: &[&str]) -> Result<ExitCode> {
    let project = Project::find()?;
    let status = project.cargo(["run", "--quiet", "--package", "carom-tests"]).args(arguments).status()?;
    Ok(ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)))
}
