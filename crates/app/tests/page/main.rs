//! The page of `carom view` in a real browser: it shows what the program computed, and does what it is told.

mod browser;
mod controls;
mod numbers;

use std::path::PathBuf;
use std::process::Command;
use tempfile::TempDir;

/// The page of a scene, in a folder that goes when the test ends.
pub struct Page {
    folder: TempDir,
    scene: PathBuf,
}

impl Page {
    /// Of a scene that comes with the program.
    fn of(name: &str) -> Self {
        let scene = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
        let page = Self { folder: TempDir::new().expect("a temporary folder can be made"), scene };
        page.carom(&["view", "-o", "page.html"]);
        page
    }

    /// Where it is.
    fn path(&self) -> PathBuf {
        self.folder.path().join("page.html")
    }

    /// What the program prints when it is run here with a command, its options, and the scene.
    fn carom(&self, args: &[&str]) -> String {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carom"));
        let output = command.args(args).arg(&self.scene).current_dir(self.folder.path()).output().expect("it runs");
        assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    }
}
