//! The project's own tasks: `cargo xtask help` lists them.
//!
//! This crate has no dependencies on purpose: it builds in a second on a fresh clone, and no feature of another crate
//! can make cargo rebuild it while it runs.

mod project;
mod log;
mod blocks;
mod commands;
mod picture;
mod accuracy;
mod kept;
mod certification;
mod conformance;
mod measure;
mod readme;
mod instructions;
mod tests_bin;
mod steps;
mod verify;

use std::process::ExitCode;

/// What a task gives: an error is a sentence for the person who ran it.
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// The tasks, as the README may name them.
const TASKS: [&str; 10] = [
    "verify",
    "readme",
    "picture",
    "accuracy",
    "certification",
    "soak",
    "conformance",
    "instructions",
    "peers",
    "scaling",
];

const HELP: &str = "\
Usage: cargo xtask TASK

Tasks:
  verify                      every check of the project; what the continuous integration runs
  verify --only STEP[,STEP]   only these steps
  verify --list               the steps, and what each checks
  readme                      rewrites the generated blocks of README.md
  picture                     takes the README's picture anew, by Chromium
  accuracy                    measures what accuracy costs in three scenes; plots, tables, README
  certification               measures what certification costs, per query and per bounce; table
  conformance                 writes the folder conformance: scenes with the events they must have
  soak --bounces N            bounces balls N times (1e8 say) in scenes of every kind and reports escapes, gains and stalls
  soak --shots M              shoots M points and M balls from inside closed meshes at their edges and vertices
  instructions                counts the instructions of a dozen operations and compares them with those kept
  instructions --update       keeps them
  peers                       builds rapier3d and parry3d, times the same work by them and by Carom, and prints ratios
  peers conformance           lets rapier3d and Carom play the conformance pack; table, README
  scaling                     times runs of growing size and fits exponents

Exit code: 0 all is well; 1 a step failed; 2 usage.";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let done = match args[..] {
        ["verify"] => verify::run(&verify::all()),
        ["verify", "--list"] => verify::list(),
        ["verify", "--only", names] => match verify::named(names) {
            Ok(steps) => verify::run(&steps),
            Err(error) => return usage(&error.to_string()),
        },
        ["readme"] => readme::rewrite(),
        ["picture"] => picture::take(),
        ["accuracy"] => accuracy::run(),
        ["certification"] => certification::run(),
        ["instructions"] => instructions::run(false),
        ["instructions", "--update"] => instructions::run(true),
        ["peers"] => measure::peers(),
        ["peers", "conformance"] => conformance::engines(),
        ["scaling"] => measure::scaling(),
        ["conformance"] => tests_bin::run(&["--bin", "conformance", "--", "conformance"]),
        ["soak", ref rest @ ..] => tests_bin::run(&[&["--release", "--bin", "soak", "--"], rest].concat()),
        ["help" | "--help" | "-h"] => {
            println!("{HELP}");
            Ok(ExitCode::SUCCESS)
        }
        [] => return usage("which task?"),
        _ => return usage(&format!("not a task: {}", args.join(" "))),
    };
    done.unwrap_or_else(|error| {
        eprintln!("error: {error}");
        ExitCode::FAILURE
    })
}

fn usage(error: &str) -> ExitCode {
    eprintln!("error: {error}\n\n{HELP}");
    ExitCode::from(2)
}
