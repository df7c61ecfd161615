//! The outputs of a run: all of them are complete in the end, or none is there.

use super::recorder::{Recorder, Recording};
use super::target::{Demand, Target, is_stdout};
use crate::cli::RunArgs;
use crate::error::AppError;
use std::path::{Path, PathBuf};

/// The exit code of a program that was interrupted, by custom of the shells: 128 + SIGINT.
const INTERRUPTED: i32 = 130;

/// Refuses outputs that would be written into each other.
pub fn refuse_clashes(args: &RunArgs) -> Result<(), AppError> {
    let outputs = [("--events", &args.events), ("--frames", &args.frames), ("--summary", &args.summary)];
    let outputs: Vec<(&str, &Path)> =
        outputs.iter().filter_map(|(name, path)| Some((*name, path.as_deref()?))).collect();
    for (i, (name, path)) in outputs.iter().enumerate() {
        if let Some((other, _)) = outputs[..i].iter().find(|(_, p)| p == path) {
            let place = if is_stdout(path) { "standard output".to_owned() } else { path.display().to_string() };
            return Err(AppError::Usage(format!("{other} and {name} cannot both go to {place}")));
        }
    }
    Ok(())
}

/// The open outputs.
pub struct Files {
    events: Option<Target>,
    frames: Option<Target>,
    summary: Option<Target>,
}

impl Files {
    /// Opens what the command line asks for, so that a place where nothing can be written is known before the run.
    pub fn open(args: &RunArgs, recording: &Recording) -> Result<Self, AppError> {
        let open = |path: &Option<PathBuf>| path.as_deref().map(Target::open).transpose();
        let mut files =
            Self { events: open(&args.events)?, frames: open(&args.frames)?, summary: open(&args.summary)? };
        files.clear_when_interrupted()?;
        if let Some((target, table)) = files.events.as_mut().zip(recording.events.as_ref()) {
            target.write(table.header().as_bytes())?;
        }
        if let Some((target, table)) = files.frames.as_mut().zip(recording.frames.as_ref()) {
            target.write(table.header().as_bytes())?;
        }
        Ok(files)
    }

    /// Makes an interrupt take the unfinished files away before the program ends.
    fn clear_when_interrupted(&self) -> Result<(), AppError> {
        let targets = [&self.events, &self.frames, &self.summary];
        let unfinished: Vec<PathBuf> =
            targets.into_iter().flatten().filter_map(Target::temporary).map(Path::to_owned).collect();
        let clear = move || {
            for path in &unfinished {
                // One that has its name by now is finished, and no longer there.
                let _ = std::fs::remove_file(path);
            }
            std::process::exit(INTERRUPTED);
        };
        ctrlc::set_handler(clear).map_err(|e| AppError::Internal(format!("cannot watch for interrupts: {e}")))
    }

    /// Writes the rows of a ball. There is no more demand when nobody reads the only output any more.
    pub fn write(&mut self, (events, frames): &Recorder<'_>) -> Result<Demand, AppError> {
        let mut demand = Vec::with_capacity(2);
        if let Some((target, recorder)) = self.events.as_mut().zip(events.as_ref()) {
            demand.push(target.write(recorder.rows.as_bytes())?);
        }
        if let Some((target, recorder)) = self.frames.as_mut().zip(frames.as_ref()) {
            demand.push(target.write(recorder.rows.as_bytes())?);
        }
        let unwanted = self.summary.is_none() && !demand.is_empty() && demand.iter().all(|d| *d == Demand::Closed);
        Ok(if unwanted { Demand::Closed } else { Demand::Open })
    }

    /// Completes the outputs: only now do they appear under their names.
    pub fn finish(self, summary: &str) -> Result<(), AppError> {
        let Self { events, frames, summary: mut last } = self;
        if let Some(target) = &mut last {
            target.write(summary.as_bytes())?;
        }
        [events, frames, last].into_iter().flatten().try_for_each(Target::finish)
    }
}
