//! `carom run`: simulates a scene and writes what happened.

use crate::cli::RunArgs;
use crate::error::AppError;
use crate::output::files::{Files, refuse_clashes};
use crate::output::recorder::Recording;
use crate::output::target::Demand;
use crate::scene;
use crate::summary::{Tally, line, points_note};
use crate::terminal::{Progress, say};
use carom_dynamics::run::run_balls;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::time::Instant;

/// Simulates the scene.
pub fn run(args: &RunArgs) -> Result<(), AppError> {
    refuse_clashes(args)?;
    let loaded = scene::load(&args.input.scene, args.input.how.balls.as_deref())?;
    let plan = loaded.plan(args.input.how.quiet)?;
    let recording = Recording::new(args, &loaded.scene)?;
    let mut files = Files::open(args, &recording, &loaded.scene)?;
    let start = Instant::now();
    let mut tally = Tally::new(&loaded.scene);
    let mut progress = Progress::new(loaded.scene.balls.len(), args.input.how.quiet);
    // Why the run was broken off: an output that cannot be written, or none that is read any more.
    let mut stopped = None;
    let threads = args.input.how.threads.map(NonZeroUsize::get);
    let simulated = run_balls(
        &plan,
        threads,
        |ball| recording.of(ball),
        |ball, recorder, outcome| {
            tally.add(ball, &outcome);
            progress.step();
            stopped = match files.write(&recorder) {
                Ok(Demand::Open) => return ControlFlow::Continue(()),
                Ok(Demand::Closed) => Some(Ok(())),
                Err(error) => Some(Err(error)),
            };
            ControlFlow::Break(())
        },
    );
    progress.finish();
    simulated.map_err(|e| AppError::Internal(e.to_string()))?;
    if let Some(result) = stopped {
        return result;
    }
    let summary = tally.finish(start.elapsed());
    files.finish(&summary.json())?;
    if !args.input.how.quiet {
        if let Some(choice) = &loaded.choice {
            say(&super::explain::chosen(choice));
        }
        say(&summary.text());
        points_note(&plan).inspect(|note| say(&line("points", note)));
    }
    summary.guarded().map_or(Ok(()), |message| Err(AppError::Guard(message)))
}
