//! The fuzzer for long runs: `fuzz FROM COUNT` changes scene and mesh files by seed, has the program read and run them, and names each
//! seed that panics or takes long; `fuzz SEED show` prints the file of a seed.

use carom_tests::fuzz::{Fuzz, Tally};
use std::process::ExitCode;
use std::sync::{Arc, mpsc};
use std::time::Duration;

/// A file that takes longer hangs, and is left to itself.
const PATIENCE: Duration = Duration::from_secs(60);

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let folder = match tempfile::tempdir() {
        Ok(folder) => folder,
        Err(error) => {
            eprintln!("no temporary folder: {error}");
            return ExitCode::FAILURE;
        }
    };
    let fuzz = Arc::new(Fuzz::new(folder.path()));
    match &args[..] {
        [seed, show] if show == "show" && seed.parse::<u64>().is_ok() => {
            let (name, bytes) = fuzz.file(seed.parse().unwrap_or(0));
            println!("# {name}\n{}", String::from_utf8_lossy(&bytes));
            ExitCode::SUCCESS
        }
        [from, count] if let (Ok(from), Ok(count)) = (from.parse::<u64>(), count.parse::<u64>()) => {
            if all(&fuzz, from, count) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        _ => {
            eprintln!("fuzz FROM COUNT, or fuzz SEED show");
            ExitCode::from(2)
        }
    }
}

fn all(fuzz: &Arc<Fuzz>, from: u64, count: u64) -> bool {
    let (mut sum, mut bad) = (Tally::default(), Vec::new());
    for seed in from..from + count {
        let (send, receive) = mpsc::channel();
        let fuzz = Arc::clone(fuzz);
        std::thread::spawn(move || {
            let mut tally = Tally::default();
            fuzz.run(seed, &mut tally);
            let _ = send.send(tally);
        });
        match receive.recv_timeout(PATIENCE) {
            Ok(tally) => {
                sum.refused += tally.refused;
                sum.unplanned += tally.unplanned;
                sum.ran += tally.ran;
            }
            Err(mpsc::RecvTimeoutError::Timeout) => bad.push(format!("{seed} hangs")),
            Err(mpsc::RecvTimeoutError::Disconnected) => bad.push(format!("{seed} panics")),
        }
    }
    println!("{} refused, {} refused as a whole, {} valid; wrong: {bad:?}", sum.refused, sum.unplanned, sum.ran);
    bad.is_empty()
}
