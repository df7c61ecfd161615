//! Writes the folder `conformance`: `conformance FOLDER`.

use carom_tests::conformance;
use std::path::Path;
use std::process::ExitCode;
use std::{fs, io};

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [folder] = &args[..] else {
        eprintln!("conformance FOLDER");
        return ExitCode::from(2);
    };
    match write(Path::new(folder)) {
        Ok(count) => {
            println!("{count} files in {folder}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{folder}: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Empties the folder and writes it anew.
fn write(folder: &Path) -> io::Result<usize> {
    let files = conformance::files();
    for part in ["scenes", "expected"] {
        let part = folder.join(part);
        if part.exists() {
            fs::remove_dir_all(&part)?;
        }
        fs::create_dir_all(&part)?;
    }
    for (path, text) in &files {
        fs::write(folder.join(path), text)?;
    }
    Ok(files.len())
}
