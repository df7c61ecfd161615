//! `cargo xtask peers` and `cargo xtask scaling`: building what measures, and running it.

use crate::Result;
use crate::project::Project;
use std::process::{Command, ExitCode};

/// Times the same work by Carom and by others; they are a workspace of their own, which nothing else builds.
pub fn peers() -> Result<ExitCode> {
    let project = Project::find()?;
    let mut command = project.cargo(["run", "--release", "--manifest-path", "peers/Cargo.toml"]);
    // Its own folder, whatever is set for ours: nothing is built twice by turns.
    run(command.env_remove("CARGO_TARGET_DIR"))
}

/// Times runs of growing size.
pub fn scaling() -> Result<ExitCode> {
    let project = Project::find()?;
    run(&mut project.cargo([
        "run",
        "--release",
        "--package",
        "carom-benches",
        "--features",
        "charts",
        "--bin",
        "scaling",
    ]))
}

fn run(command: &mut Command) -> Result<ExitCode> {
    Ok(if command.status()?.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
