//! `carom completions`: what a shell needs to complete the command line.

use super::print;
use crate::cli::{Cli, CompletionsArgs};
use crate::error::AppError;
use clap::CommandFactory;

/// Prints the completions of a shell.
pub fn completions(args: &CompletionsArgs) -> Result<(), AppError> {
    // Into memory first: the generator panics where it cannot write.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "carom", &mut script);
    print(&String::from_utf8_lossy(&script))
}
