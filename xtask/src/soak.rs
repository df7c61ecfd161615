//! `cargo xtask soak`: the soak, in its release build.

use crate::Result;
use crate::project::Project;
use std::process::ExitCode;

/// Runs the soak with these arguments; its exit code is the task's.
pub fn run(arguments: &[&str]) -> Result<ExitCode> {
    let project = Project::find()?;
    let soak = ["run", "--quiet", "--release", "--package", "carom-tests", "--bin", "soak", "--"];
    let status = project.cargo(soak).args(arguments).status()?;
    Ok(ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)))
}
