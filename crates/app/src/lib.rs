//! Bouncing-ball simulation from the command line: scene files in, events, frames and summaries out.
//!
//! The program is thin: what a ball does is told by [`carom_dynamics`], and where surfaces are by [`carom_geometry`]; whoever writes a program
//! of their own begins there. This crate is the command `carom`, which explains itself with `--help`, a [`guide`] through the
//! chapter that it is built from, [charts](plot), and two readers of files:
//!
//! ```no_run
//! use carom_dynamics::{observer::Trajectory, plan::Plan, simulate::simulate};
//!
//! let scene = carom::read_scene("room.toml".as_ref())?;
//! let plan = Plan::new(&scene)?;
//! let mut run = Trajectory::default();
//! simulate(&plan, &plan.balls()[0], &mut run);
//! println!("{} events", run.events.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The feature `parquet`, on by default, lets events and frames be written as Parquet.

mod balls;
mod cli;
mod commands;
mod curves;
mod error;
mod events_file;
pub mod guide;
mod mesh_file;
mod model;
mod output;
pub mod plot;
mod presets;
mod replay;
mod scene;
mod stage;
mod summary;
mod terminal;
mod view;

use carom_dynamics::scene::Scene;
use carom_geometry::mesh::Mesh;
use clap::Parser;
use cli::{Cli, Command};
use mesh_file::RawMesh;
use std::path::Path;
use std::process::ExitCode;

/// Runs the program with the arguments of the process, and says how it ended: `carom --help` lists the exit codes.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let result = match &cli.command {
        Command::Init(args) => commands::init::init(args),
        Command::Run(args) => commands::run::run(args),
        Command::Explain(args) => commands::explain::explain(args),
        Command::Accuracy(args) => commands::accuracy::accuracy(args),
        Command::View(args) => commands::view::view(args),
        Command::Plot(args) => commands::plot::plot(args),
        Command::Export(args) => commands::export::export(args),
        Command::Check(args) => commands::check::check(args),
        Command::Compare(args) => commands::compare::compare(args),
        Command::Schema => commands::schema::schema(),
        Command::Balls(args) => commands::balls::balls(args),
        Command::Materials(args) => commands::materials::materials(args),
        Command::Completions(args) => commands::completions::completions(args),
        Command::Man(args) => commands::man::man(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal::say(&error.render(terminal::styled()));
            error.exit_code()
        }
    }
}

/// The scene in the file at `path`, TOML or JSON by its extension, with the meshes it names read; in SI units.
///
/// Fails with all that is wrong with the file, in the words that `carom check` shows.
pub fn read_scene(path: &Path) -> Result<Scene, String> {
    scene::load(path, None).map(|loaded| loaded.scene).map_err(|error| error.render(false))
}

/// The mesh in the file at `path`: OBJ, STL or PLY by its extension, in the unit of the file.
///
/// Fails with what is wrong, and in which line.
pub fn read_mesh(path: &Path) -> Result<Mesh, String> {
    let RawMesh { vertices, faces } = mesh_file::read(path).map_err(|error| error.to_string())?;
    Mesh::new(vertices, faces).map_err(|error| format!("{}: {error}", path.display()))
}
