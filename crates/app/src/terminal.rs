//! Standard error: what the user reads while results go elsewhere.

use anstream::{AutoStream, ColorChoice};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// How long a run takes before it is a long one.
const PATIENCE: Duration = Duration::from_secs(1);

/// Whether messages may have colours: a terminal that has them, and no NO_COLOR.
pub fn styled() -> bool {
    AutoStream::choice(&io::stderr()) != ColorChoice::Never
}

/// Writes a message and ends its line. A standard error that nobody reads is no reason to fail.
pub fn say(message: &str) {
    let _ = writeln!(io::stderr().lock(), "{message}");
}

/// A bar that shows how far a long run has come, where standard error is a terminal.
pub struct Progress {
    bar: ProgressBar,
    /// When it appears, if at all.
    appears: Option<Instant>,
    done: u64,
}

impl Progress {
    /// Of a run of `balls`.
    pub fn new(balls: usize, quiet: bool) -> Self {
        // Hidden until the run has turned out to be long.
        let bar = ProgressBar::with_draw_target(Some(balls as u64), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} balls, {eta} left");
        let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        let wanted = !quiet && io::stderr().is_terminal();
        Self { bar, appears: wanted.then(|| Instant::now() + PATIENCE), done: 0 }
    }

    /// One more ball is done.
    pub fn step(&mut self) {
        self.done += 1;
        if self.appears.is_some_and(|at| Instant::now() >= at) {
            self.appears = None;
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_position(self.done);
    }

    /// The run is over: the bar goes.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}
