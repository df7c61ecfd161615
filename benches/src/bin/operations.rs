//! Does every operation in its function, for callgrind to count, and prints how often a function does it.

use carom_benches::operations::{Bench, GEOMETRY, SCENES, TIMES};
use carom_benches::scenes::Result;

fn main() -> Result<()> {
    let bench = Bench::new()?;
    for (_, operation) in GEOMETRY.into_iter().chain(SCENES) {
        // The first time pays for what happens once.
        operation(&bench);
        counted(operation, &bench);
    }
    println!("{TIMES}");
    Ok(())
}

/// The one place from which the counted calls are made.
#[inline(never)]
fn counted(operation: fn(&Bench), bench: &Bench) {
    operation(bench);
}
