//! What the program writes for other programs, read back by readers that it does not write with.

mod glb;
mod parquet;

use std::path::PathBuf;
use std::process::Command;
use tempfile::TempDir;

/// A scene that comes with the program, and a folder for what is made of it.
pub struct Job {
    folder: TempDir,
    scene: PathBuf,
}

impl Job {
    /// On a scene that comes with the program.
    fn on(name: &str) -> Self {
        let scene = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
        Self { folder: TempDir::new().expect("a temporary folder can be made"), scene }
    }

    /// What the program prints when it runs here.
    fn carom(&self, args: &[&str]) -> String {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carom"));
        let output = command.args(args).arg(&self.scene).current_dir(self.folder.path()).output().expect("it runs");
        assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    }

    /// The rows of a table that it prints, without the header.
    fn table(&self, args: &[&str]) -> Vec<Vec<String>> {
        let rows = self.carom(args);
        rows.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
    }

    /// A file that it wrote.
    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.folder.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("{cell}"))
}
