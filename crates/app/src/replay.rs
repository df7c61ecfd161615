//! A whole run in memory, for what shows it: the page, the model, the plot.

use crate::cli::SimulationArgs;
use crate::error::AppError;
use crate::scene::{self, Loaded};
use crate::summary::{Summary, Tally};
use crate::terminal::Progress;
use carom_dynamics::events::Outcome;
use carom_dynamics::observer::Trajectory;
use carom_dynamics::plan::Plan;
use carom_dynamics::run::run_balls;
use carom_dynamics::scene::Scene;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

/// More stretches of motion than this are more than a page or a model can show; they would take a gigabyte of memory.
const SEGMENT_LIMIT: usize = 3_000_000;

/// A scene and what became of it.
pub struct Replay {
    /// The scene.
    pub scene: Scene,
    /// The balls, in the order of the scene.
    pub balls: Vec<BallRun>,
    /// The run in numbers.
    pub summary: Summary,
}

/// What a ball did.
pub struct BallRun {
    /// Its events and its motion.
    pub trajectory: Trajectory,
    /// How it ended.
    pub outcome: Outcome,
}

impl Replay {
    /// Loads the scene at a path and simulates it.
    pub fn of(scene: &Path, how: &SimulationArgs) -> Result<Self, AppError> {
        let loaded = scene::load(scene, how.balls.as_deref())?;
        let plan = loaded.plan(how.quiet)?;
        Self::run(loaded, &plan, how)
    }

    fn run(loaded: Loaded, plan: &Plan, how: &SimulationArgs) -> Result<Self, AppError> {
        let start = Instant::now();
        let mut tally = Tally::new(&loaded.scene);
        let mut progress = Progress::new(loaded.scene.balls.len(), how.quiet);
        let (mut balls, mut segments) = (Vec::new(), 0);
        let threads = how.threads.map(NonZeroUsize::get);
        let simulated = run_balls(
            plan,
            threads,
            |_| Trajectory::default(),
            |ball, trajectory, outcome| {
                tally.add(ball, &outcome);
                progress.step();
                segments += trajectory.segments.len();
                balls.push(BallRun { trajectory, outcome });
                if segments > SEGMENT_LIMIT { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            },
        );
        progress.finish();
        simulated.map_err(|e| AppError::Internal(e.to_string()))?;
        let summary = tally.finish(start.elapsed());
        if segments > SEGMENT_LIMIT {
            let (shown, all) = (balls.len(), loaded.scene.balls.len());
            let message = format!(
                "the run has more than {SEGMENT_LIMIT} stretches of motion in the first {shown} of {all} balls, which is too \
                 much to show; take fewer balls (see --balls), a shorter duration or a longer step"
            );
            return Err(AppError::Usage(message));
        }
        Ok(Self { scene: loaded.scene, balls, summary })
    }

    /// The error that a run makes in which a guard ended balls, once its results are written.
    pub fn conclude(&self) -> Result<(), AppError> {
        self.summary.guarded().map_or(Ok(()), |message| Err(AppError::Guard(message)))
    }
}
