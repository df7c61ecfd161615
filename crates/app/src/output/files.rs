//! The outputs of a run: all of them are complete in the end, or none is there.

use super::recorder::{Recorder, Recording, Rows};
use super::rows::{EventRows, FrameRows};
use super::target::{Demand, Target, is_stdout};
use super::{Form, parquet};
use crate::cli::RunArgs;
use crate::error::AppError;
use carom_dynamics::scene::Scene;
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
    events: Option<Sheet>,
    frames: Option<Sheet>,
    summary: Option<Target>,
}

/// A table that is being written.
enum Sheet {
    Rows(Target),
    Columns(Box<parquet::Table>),
}

impl Files {
    /// Opens what the command line asks for, so that a place where nothing can be written is known before the run.
    pub fn open(args: &RunArgs, recording: &Recording, scene: &Scene) -> Result<Self, AppError> {
        let open = |path: &Option<PathBuf>| path.as_deref().map(Target::open).transpose();
        let [events, frames, summary] = [open(&args.events)?, open(&args.frames)?, open(&args.summary)?];
        clear_when_interrupted([&events, &frames, &summary])?;
        let events = events.zip(recording.events.as_ref()).map(|(target, form)| Sheet::events(target, form, scene));
        let frames = frames.zip(recording.frames.as_ref()).map(|(target, form)| Sheet::frames(target, form, scene));
        Ok(Self { events: events.transpose()?, frames: frames.transpose()?, summary })
    }

    /// Writes the rows of a ball. There is no more demand when nobody reads the only output any more.
    pub fn write(&mut self, recorder: &Recorder<'_>) -> Result<Demand, AppError> {
        let mut demand = Vec::with_capacity(2);
        if let Some((sheet, events)) = self.events.as_mut().zip(recorder.events.as_ref()) {
            demand.push(match (sheet, &events.rows) {
                (Sheet::Rows(target), Rows::Text(_, text)) => target.write(text.as_bytes())?,
                (Sheet::Columns(table), Rows::Items(events)) => table.push_events(recorder.ball, events)?,
                _ => Demand::Open,
            });
        }
        if let Some((sheet, frames)) = self.frames.as_mut().zip(recorder.frames.as_ref()) {
            demand.push(match (sheet, &frames.rows) {
                (Sheet::Rows(target), Rows::Text(_, text)) => target.write(text.as_bytes())?,
                (Sheet::Columns(table), Rows::Items(frames)) => table.push_frames(recorder.ball, frames)?,
                _ => Demand::Open,
            });
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
        // All are written to their end before the first gets its name.
        let tables: Vec<Target> = [events, frames].into_iter().flatten().map(Sheet::end).collect::<Result<_, _>>()?;
        tables.into_iter().chain(last).try_for_each(Target::finish)
    }
}

impl Sheet {
    fn events(mut target: Target, form: &Form<EventRows>, scene: &Scene) -> Result<Self, AppError> {
        match form {
            Form::Rows(table) => {
                target.write(table.header().as_bytes())?;
                Ok(Self::Rows(target))
            }
            Form::Columns => parquet::Table::events(target, scene).map(Box::new).map(Self::Columns),
        }
    }

    fn frames(mut target: Target, form: &Form<FrameRows>, scene: &Scene) -> Result<Self, AppError> {
        match form {
            Form::Rows(table) => {
                target.write(table.header().as_bytes())?;
                Ok(Self::Rows(target))
            }
            Form::Columns => parquet::Table::frames(target, scene).map(Box::new).map(Self::Columns),
        }
    }

    /// Writes what is left; gives back where it went.
    fn end(self) -> Result<Target, AppError> {
        match self {
            Self::Rows(target) => Ok(target),
            Self::Columns(table) => table.finish(),
        }
    }
}

/// Makes an interrupt take the unfinished files away before the program ends.
fn clear_when_interrupted(targets: [&Option<Target>; 3]) -> Result<(), AppError> {
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
