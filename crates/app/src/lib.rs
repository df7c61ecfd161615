//! Bouncing-ball simulation from the command line: scene files in, events, frames and summaries out.
//!
//! The program is thin: what a ball does is told by `carom-dynamics`, and where surfaces are by `carom-geometry`.

mod balls;
mod cli;
mod commands;
mod error;
mod mesh_file;
mod output;
mod presets;
mod scene;
mod summary;
mod terminal;

use clap::Parser;
use cli::{Cli, Command};
use std::process::ExitCode;

/// Runs the program with the arguments of the process, and says how it ended: `carom --help` lists the exit codes.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let result = match &cli.command {
        Command::Run(args) => commands::run::run(args),
        Command::Check(args) => commands::check::check(args),
        Command::Schema => commands::schema::schema(),
        Command::Balls(args) => commands::balls::balls(args),
        Command::Materials(args) => commands::materials::materials(args),
        Command::Completions(args) => commands::completions::completions(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal::say(&error.render(terminal::styled()));
            error.exit_code()
        }
    }
}
