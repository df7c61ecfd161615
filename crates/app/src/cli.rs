//! The command line: commands, options and their help.

use crate::model::Keys;
use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use clap_complete::Shell;
use std::num::NonZeroUsize;
use std::path::PathBuf;

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  1  a file could not be read or written, or an internal error
  2  the command line is not valid
  3  the scene or mesh is not valid
  4  the run was ended by a guard (event budget, unresolved contact)
  5  a target was not met";

/// Bouncing balls that people can trust: exact collisions, named physics, the same bits on every machine.
///
/// A scene file says what moves, what it bounces on and which effects take part; `carom schema` describes its keys.
#[derive(Debug, Parser)]
#[command(name = "carom", version, after_help = EXIT_CODES, max_term_width = 100)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a first scene to change
    ///
    /// The scene is short and says what its keys mean. A file that is there already is not touched.
    Init(InitArgs),
    /// Simulate a scene
    ///
    /// Prints a short summary on standard error. Events, frames and a summary in JSON are written where asked for; a file
    /// appears only once it is complete.
    Run(RunArgs),
    /// Tell which effects a scene has, which it would need, what each changes and what it costs
    ///
    /// Each effect that is on is taken out, each that is off is put in with the data of the scene (and air at 20 C), and the first flights and
    /// impacts are compared with those of the scene as it is, and with a prediction by formula. What is off and would matter comes first.
    Explain(ExplainArgs),
    /// Show a scene: write a page that plays it in any browser
    ///
    /// Simulates the scene and writes one HTML file that needs nothing else, not even a network: surfaces and balls in 3-D, to
    /// turn, pause, scrub and follow, every impact with its data, energy over time.
    View(ViewArgs),
    /// Draw height, speed or energy over time, or the phase portrait
    ///
    /// Of a scene, or of a table of events that `carom run` or another program wrote. Between two events of a table the path is
    /// the cubic with their places and velocities, which for a flight under gravity is the exact one; a table says nothing of
    /// gravity, so heights are along z, and of energies there is the kinetic one.
    Plot(PlotArgs),
    /// Take a scene elsewhere: write a model with its motion, for programs of 3-D
    ///
    /// Simulates the scene and writes surfaces, balls and motion as glTF 2.0, one .glb file. Each event is a key with the velocities
    /// before and after it (CUBICSPLINE), so that a flight between two of them is the exact parabola; other motions
    /// are off by no more than single precision is.
    Export(ExportArgs),
    /// Measure what accuracy costs in time
    ///
    /// Runs the scene with every method over a sweep of steps or tolerances: the slides as published, each improvement to it, and the methods
    /// that a scene can ask for. Compares them with a reference in 128 bits, and prints errors, their parts, the
    /// orders of convergence, and the cost. The method that the scene names is not looked at.
    Accuracy(AccuracyArgs),
    /// List all that is wrong with a scene or a mesh
    ///
    /// A scene (.toml, .json) is read as `run` would read it, and the meshes it names are examined. A mesh (.obj, .stl, .ply)
    /// is examined for degenerate and duplicate faces, non-manifold and open edges, inconsistent winding and the like,
    /// each with its face numbers, which count from 0. Exit code 3 if there is an error; warnings alone are 0.
    Check(CheckArgs),
    /// Compare the events of any engine with expected ones
    ///
    /// EXPECTED is a CSV file of targets (the folder `conformance` has some, and tells the format), ACTUAL one of events as `run` writes
    /// it: the columns t, ball and kind, and any of x, y, z, vx, vy, vz. The n-th event of a kind is compared with the n-th; impacts of a
    /// ball at one time are one. Prints the worst deviations; exit code 5 if one is above its tolerance or an event is missing.
    Compare(CompareArgs),
    /// Print the JSON schema of scene files, for editors
    Schema,
    /// Print the balls that scenes can call by name, with the sources of what is known of them
    Balls(BallsArgs),
    /// Print tables of restitution and friction, with their sources
    Materials(MaterialsArgs),
    /// Print the completions of a shell
    Completions(CompletionsArgs),
    /// Print the manual page, or write those of all commands
    Man(ManArgs),
}

/// What `run` takes.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  carom run room.toml
  carom run room.toml --events events.csv --frames frames.csv --fps 30
  carom run room.toml --balls balls.csv --events - | head")]
pub struct RunArgs {
    /// Write the events (impacts, slides, rests ...) to FILE: .csv, .jsonl or .parquet; `-` is standard output, as CSV
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub events: Option<PathBuf>,
    /// Write the balls at every frame to FILE: .csv, .jsonl or .parquet; `-` is standard output, as CSV
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub frames: Option<PathBuf>,
    /// Frames per second, also as a fraction: 24, 29.97 or 30000/1001
    #[arg(long, value_name = "N", default_value = "60", value_parser = frames_per_second)]
    pub fps: f64,
    /// Write the summary to FILE as JSON; `-` is standard output
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub summary: Option<PathBuf>,
    /// What to simulate.
    #[command(flatten)]
    pub input: SceneArgs,
}

/// A scene, and how to simulate it.
#[derive(Debug, Args)]
pub struct SceneArgs {
    /// The scene: a .toml or .json file
    #[arg(value_hint = ValueHint::FilePath)]
    pub scene: PathBuf,
    /// How to simulate it.
    #[command(flatten)]
    pub how: SimulationArgs,
}

/// What every command takes that simulates a scene.
#[derive(Debug, Args)]
pub struct SimulationArgs {
    /// Read the balls from FILE instead of the scene; `-` is standard input
    ///
    /// CSV with a header: x,y,z and any of vx,vy,vz,radius,mass, with the defaults of a scene.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub balls: Option<PathBuf>,
    /// Simulate with N threads; the output is the same bytes for any N [default: one per processor]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZeroUsize>,
    /// Print nothing but errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// What `explain` takes.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  carom explain room.toml
  carom explain room.toml --tolerance 0.001 --json")]
pub struct ExplainArgs {
    /// The scene: a .toml or .json file
    #[arg(value_hint = ValueHint::FilePath)]
    pub scene: PathBuf,
    /// The share of a time, a speed or a way by which an effect must change something to matter
    #[arg(long, value_name = "SHARE", default_value = "0.01", value_parser = positive)]
    pub tolerance: f64,
    /// Read the balls from FILE instead of the scene, as `run` does
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub balls: Option<PathBuf>,
    /// Print JSON, with all digits
    #[arg(long)]
    pub json: bool,
}

/// What `accuracy` takes.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  carom accuracy room.toml
  carom accuracy room.toml --csv accuracy.csv --plot accuracy.svg
  carom accuracy room.toml --target-error 1e-6")]
pub struct AccuracyArgs {
    /// The scene: a .toml or .json file
    #[arg(value_hint = ValueHint::FilePath)]
    pub scene: PathBuf,
    /// Name the cheapest method whose positions are right to E m, and verify it by a run; exit code 5 if there is none
    #[arg(long, value_name = "E", value_parser = positive)]
    pub target_error: Option<f64>,
    /// Write all measurements to FILE as CSV; `-` is standard output
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub csv: Option<PathBuf>,
    /// Draw the error over the cost to FILE as SVG; `-` is standard output
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,
    /// How many balls are measured: the first N of the scene
    #[arg(long, value_name = "N", default_value = "4")]
    pub balls: NonZeroUsize,
    /// How often the step is halved
    #[arg(long, value_name = "N", default_value = "8", value_parser = clap::value_parser!(u32).range(0..=20))]
    pub octaves: u32,
    /// How often the tolerance is divided by ten
    #[arg(long, value_name = "N", default_value = "10", value_parser = clap::value_parser!(u32).range(0..=11))]
    pub decades: u32,
    /// Timed runs of each method, of which the quickest counts; 0 counts the work only
    #[arg(long, value_name = "N", default_value = "5", value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub repeats: u32,
}

/// What `view` takes.
#[derive(Debug, Args)]
#[command(after_help = "Example:
  carom view room.toml -o room.html")]
pub struct ViewArgs {
    /// Write the page to FILE; `-` is standard output
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// What to simulate.
    #[command(flatten)]
    pub input: SceneArgs,
}

/// What `init` takes.
#[derive(Debug, Args)]
pub struct InitArgs {
    /// Where to write it, a .toml; `-` is standard output
    #[arg(value_name = "FILE", default_value = "scene.toml", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
}

/// What `plot` takes.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  carom plot room.toml -o height.svg
  carom plot room.toml -o energy.svg --show energy --ball 0
  carom plot events.csv -o phase.svg --show phase --ball 3 --to 20")]
pub struct PlotArgs {
    /// Write the chart to FILE as SVG; `-` is standard output
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// What to show
    #[arg(long, value_name = "WHAT", default_value = "height")]
    pub show: Quantity,
    /// Show these balls, counted from 0, such as 0,3 [default: the first ones]
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub ball: Vec<usize>,
    /// Begin at this time, in s
    #[arg(long, value_name = "TIME")]
    pub from: Option<f64>,
    /// End at this time, in s [default: when the balls have come to rest]
    #[arg(long, value_name = "TIME")]
    pub to: Option<f64>,
    /// A scene (.toml, .json) or a table of events (.csv)
    #[arg(value_name = "EVENTS-OR-SCENE", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// How to simulate a scene.
    #[command(flatten)]
    pub how: SimulationArgs,
}

/// What a chart shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Quantity {
    /// Height over time
    Height,
    /// Speed over time
    Speed,
    /// Energy per mass over time; of one ball, kinetic and potential as well
    Energy,
    /// Vertical velocity over height
    Phase,
}

/// What `man` takes.
#[derive(Debug, Args)]
pub struct ManArgs {
    /// Write the pages of the program and of each command into FOLDER
    #[arg(long, short, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub output: Option<PathBuf>,
}

/// What `export` takes.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  carom export room.toml -o room.glb
  carom export room.toml -o room.glb --keys fps=30")]
pub struct ExportArgs {
    /// Write the model to FILE, a .glb; `-` is standard output
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// What the motion is given by: `events`, or `fps=N` for programs that ignore velocities
    ///
    /// `fps=N` is a position for every N-th of a second, and straight lines between them: a ball that turns more than half
    /// way round in that time then seems to turn otherwise.
    #[arg(long, value_name = "KEYS", default_value = "events", value_parser = keys)]
    pub keys: Keys,
    /// What to simulate.
    #[command(flatten)]
    pub input: SceneArgs,
}

/// What `check` takes.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// A scene (.toml, .json) or a mesh (.obj, .stl, .ply)
    #[arg(value_name = "SCENE-OR-MESH", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
}

/// What `compare` takes.
#[derive(Debug, Args)]
#[command(after_help = "Example:
  carom run conformance/scenes/corner.toml --events corner.csv
  carom compare conformance/expected/corner.csv corner.csv")]
pub struct CompareArgs {
    /// The targets: a .csv file with their tolerances
    #[arg(value_hint = ValueHint::FilePath)]
    pub expected: PathBuf,
    /// The events: a .csv file
    #[arg(value_hint = ValueHint::FilePath)]
    pub actual: PathBuf,
    /// Multiply every tolerance by FACTOR, for engines of less precision
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive)]
    pub loosen: f64,
}

/// What `balls` takes.
#[derive(Debug, Args)]
pub struct BallsArgs {
    /// Print JSON instead of a table
    #[arg(long)]
    pub json: bool,
}

/// What `materials` takes.
#[derive(Debug, Args)]
pub struct MaterialsArgs {
    /// Print JSON instead of tables
    #[arg(long)]
    pub json: bool,
}

/// What `completions` takes.
#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// The shell
    pub shell: Shell,
}

/// Reads a number of threads.
fn threads(word: &str) -> Result<NonZeroUsize, String> {
    word.parse().map_err(|_| "it must be a whole number from 1".to_owned())
}

/// Reads a finite number above 0.
fn positive(word: &str) -> Result<f64, String> {
    match word.trim().parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        Ok(_) => Err("it must be finite and > 0".to_owned()),
        Err(_) => Err(format!("`{word}` is not a number")),
    }
}

/// Reads `events` or `fps=N`.
fn keys(word: &str) -> Result<Keys, String> {
    match (word, word.strip_prefix("fps=")) {
        ("events", _) => Ok(Keys::Events),
        (_, Some(number)) => Ok(Keys::Frames { fps: frames_per_second(number)? }),
        _ => Err("keys are `events`, or `fps=N` such as fps=30".to_owned()),
    }
}

/// Reads `N` or `A/B`, finite and above 0.
fn frames_per_second(word: &str) -> Result<f64, String> {
    let number = |part: &str| part.trim().parse::<f64>().map_err(|_| format!("`{part}` is not a number"));
    let fps = match word.split_once('/') {
        Some((a, b)) => number(a)? / number(b)?,
        None => number(word)?,
    };
    if fps.is_finite() && fps > 0.0 { Ok(fps) } else { Err("frames per second must be finite and > 0".to_owned()) }
}
