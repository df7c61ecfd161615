//! Tables that are measured by a command and kept in a file, of which the README shows a copy.

use crate::Result;
use crate::project::{Project, output};
use std::fs;
use std::process::{Command, ExitCode};

/// A table, and where it is kept.
pub struct Kept {
    /// The file, from the root of the project.
    pub file: &'static str,
    /// How many rows it has at least.
    pub rows: usize,
    /// What writes it anew.
    pub command: &'static str,
}

impl Kept {
    /// Runs the program that measures, prints what it says and keeps it.
    pub fn measure(&self, project: &Project, program: &mut Command) -> Result<ExitCode> {
        let (table, _) = output(program)?;
        print!("{table}");
        fs::write(project.root().join(self.file), table)?;
        Ok(ExitCode::SUCCESS)
    }

    /// The table that was kept; times are those of one machine, so its shape is all that can be checked.
    pub fn block(&self, project: &Project) -> Result<String> {
        let table = project.read(self.file)?;
        let cells = |line: &str| line.matches(" | ").count();
        let mut lines = table.lines();
        let header = lines.next().map(cells);
        let rows = lines.skip(1).filter(|line| Some(cells(line)) == header).count();
        if rows < self.rows {
            return Err(format!("{} has {rows} rows; `cargo xtask {}` writes it anew", self.file, self.command).into());
        }
        Ok(table)
    }
}
