//! The catalogue of hard cases as a table: `catalogue` runs every case and prints what breaks elsewhere, our figure and the bound; it fails
//! if a bound is broken.

use carom_tests::catalogue;
use std::process::ExitCode;

fn main() -> ExitCode {
    let results = catalogue::run();
    print!("{}", catalogue::table_of(&results));
    let broken = results.iter().filter(|(_, figure)| !figure.holds).count();
    println!("{} cases, {broken} broken", results.len());
    if broken == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
