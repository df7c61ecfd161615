//! Many balls on all cores: the same bytes for any number of threads.

use crate::events::Outcome;
use crate::observer::Observer;
use crate::plan::Plan;
use crate::simulate::simulate;
use rayon::prelude::*;
use std::ops::ControlFlow;
use thiserror::Error;

/// Balls simulated before their results are handed on, for each thread: what bounds the memory.
const BALLS_IN_FLIGHT: usize = 64;

/// The threads could not be started.
#[derive(Debug, Error)]
#[error("cannot start {threads} threads: {reason}")]
pub struct ThreadsError {
    /// How many were asked for.
    pub threads: usize,
    /// What the system says.
    pub reason: String,
}

/// Simulates every ball of `plan` on `threads` threads (all cores if none). `make` gives the observer of a ball by its
/// index; `sink` takes each back with the ball's outcome, on the calling thread and in the order of the balls, and may break
/// off. No more than a few dozen balls a thread are in memory at once.
pub fn run_balls<O: Observer + Send>(
    plan: &Plan,
    threads: Option<usize>,
    make: impl Fn(usize) -> O + Sync,
    mut sink: impl FnMut(usize, O, Outcome) -> ControlFlow<()>,
) -> Result<(), ThreadsError> {
    let wanted = threads.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(wanted)
        .build()
        .map_err(|e| ThreadsError { threads: wanted, reason: e.to_string() })?;
    let chunk = BALLS_IN_FLIGHT * pool.current_num_threads();
    for (k, balls) in plan.balls().chunks(chunk).enumerate() {
        let first = k * chunk;
        let results: Vec<(O, Outcome)> = pool.install(|| {
            let one = |(i, ball)| {
                let mut observer = make(first + i);
                let outcome = simulate(plan, ball, &mut observer);
                (observer, outcome)
            };
            balls.par_iter().enumerate().map(one).with_max_len(1).collect()
        });
        for (i, (observer, outcome)) in results.into_iter().enumerate() {
            if sink(first + i, observer, outcome).is_break() {
                return Ok(());
            }
        }
    }
    Ok(())
}
