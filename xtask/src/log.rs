//! The log of one step: the commands it ran, what they said, and what the step itself has to say.

use crate::Result;
use crate::project::show;
use std::fs::{self, File};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Lines of a failed log that are shown; the file has all of them.
const SHOWN: usize = 400;

/// A log on disk, written as the commands speak.
pub struct Log {
    file: File,
    path: PathBuf,
    shown: String,
}

impl Log {
    /// An empty log at `path`, in place of an older one.
    pub fn create(path: &Path) -> Result<Self> {
        fs::create_dir_all(path.parent().ok_or("a log needs a folder")?)?;
        Ok(Self { file: File::create(path)?, path: path.to_path_buf(), shown: String::new() })
    }

    /// Adds a line.
    pub fn line(&mut self, text: &str) -> Result<()> {
        Ok(writeln!(self.file, "{text}")?)
    }

    /// Runs a command with both of its outputs in the log, in the order they come; says whether it ended well.
    pub fn run(&mut self, command: &mut Command) -> Result<bool> {
        let shown = show(command);
        self.line(&format!("$ {shown}"))?;
        let start = Instant::now();
        let status = command
            .stdin(Stdio::null())
            .stdout(self.file.try_clone()?)
            .stderr(self.file.try_clone()?)
            .status()
            .map_err(|error| format!("{shown}: {error}"))?;
        // The copies of the handle share one position on Unix; on Windows ours may have stayed behind.
        self.file.seek(SeekFrom::End(0))?;
        self.line(&format!("({status}, {:.1} s)\n", start.elapsed().as_secs_f64()))?;
        Ok(status.success())
    }

    /// As [`Self::run`], and what it prints on standard output is for the person who waits as well.
    pub fn run_shown(&mut self, command: &mut Command) -> Result<bool> {
        let shown = show(command);
        self.line(&format!("$ {shown}"))?;
        let stderr = self.file.try_clone()?;
        let output = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(stderr)
            .output()
            .map_err(|error| format!("{shown}: {error}"))?;
        self.file.seek(SeekFrom::End(0))?;
        let text = String::from_utf8_lossy(&output.stdout);
        self.line(&text)?;
        self.shown += &text;
        Ok(output.status.success())
    }

    /// What the step has to show even if all is well.
    pub fn shown(&self) -> &str {
        &self.shown
    }

    /// What to show of a failed step: everything but the lines about what went well, from the end.
    pub fn digest(&self) -> Result<String> {
        // Tests may print bytes that are no text.
        let text = String::from_utf8_lossy(&fs::read(&self.path)?).into_owned();
        let lines: Vec<&str> = text.lines().filter(|line| !went_well(line)).collect();
        let hidden = lines.len().saturating_sub(SHOWN);
        let mut digest = String::new();
        if hidden > 0 {
            digest += &format!("[{hidden} lines before these are in {}]\n", self.path.display());
        }
        digest += &lines[hidden..].join("\n");
        Ok(digest)
    }
}

fn went_well(line: &str) -> bool {
    let word = line.split_whitespace().next().unwrap_or_default();
    let progress =
        ["Compiling", "Checking", "Documenting", "Downloading", "Downloaded", "Running", "Finished", "Locking"];
    (line.starts_with("test ") && line.ends_with(" ... ok")) || (line.starts_with(' ') && progress.contains(&word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digest_leaves_out_what_went_well() {
        assert!(went_well("test plane::tests::r05 ... ok"));
        assert!(went_well("   Compiling carom v0.1.0"));
        assert!(!went_well("test plane::tests::r05 ... FAILED"));
        assert!(!went_well("Compiling the list of balls failed"));
        assert!(!went_well("warning: unused variable"));
    }
}
