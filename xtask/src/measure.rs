//! `cargo xtask peers` and `cargo xtask scaling`: building what measures, running it, and keeping what it says.

use crate::Result;
use crate::kept::Kept;
use crate::project::Project;
use std::process::ExitCode;

/// What the same work takes others, as measured last.
pub const PEERS: Kept = Kept { file: "benches/peers.md", rows: 13, command: "peers" };

/// How time and memory grow, as measured last.
pub const SCALING: Kept = Kept { file: "benches/scaling.md", rows: 7, command: "scaling" };

/// The chart of it.
const CHART: &str = "docs/scaling.svg";

/// Times the same work by Carom and by others; they are a workspace of their own, which nothing else builds.
pub fn peers() -> Result<ExitCode> {
    let project = Project::find()?;
    let mut command = project.cargo(["run", "--release", "--manifest-path", "peers/Cargo.toml"]);
    // Its own folder, whatever is set for ours: nothing is built twice by turns.
    PEERS.measure(&project, command.env_remove("CARGO_TARGET_DIR"))
}

/// Times runs of growing size.
pub fn scaling() -> Result<ExitCode> {
    let project = Project::find()?;
    let program =
        ["run", "--release", "--package", "carom-benches", "--features", "charts", "--bin", "scaling", "--", CHART];
    SCALING.measure(&project, &mut project.cargo(program))
}
