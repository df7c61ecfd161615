//! What is kept of a ball while it is simulated: its rows, already in the form in which they are written.

use super::Format;
use super::rows::{EventRows, FrameRows};
use crate::cli::RunArgs;
use crate::error::AppError;
use carom_dynamics::events::Event;
use carom_dynamics::observer::{FrameSampler, Observer, Segment};
use carom_dynamics::scene::Scene;

/// More frames of one ball than this are taken for a slip: they stay in memory until the ball is done.
const FRAME_LIMIT: f64 = 1e8;

/// Which tables a run writes, and how.
pub struct Recording {
    /// The table of events, if it is wanted.
    pub events: Option<EventRows>,
    /// The table of frames, if it is wanted.
    pub frames: Option<FrameRows>,
    fps: f64,
    duration: f64,
}

impl Recording {
    /// As the command line asks for.
    pub fn new(args: &RunArgs, scene: &Scene) -> Result<Self, AppError> {
        if args.frames.is_some() && args.fps * scene.duration > FRAME_LIMIT {
            let (fps, duration) = (args.fps, scene.duration);
            return Err(AppError::Usage(format!("--fps {fps} makes too many frames in {duration} s; choose fewer")));
        }
        let events = args.events.as_deref().map(Format::of).transpose()?;
        let frames = args.frames.as_deref().map(Format::of).transpose()?;
        Ok(Self {
            events: events.map(|format| EventRows::new(format, scene)),
            frames: frames.map(|format| FrameRows::new(format, scene)),
            fps: args.fps,
            duration: scene.duration,
        })
    }

    /// The recorder of a ball.
    pub fn of(&self, ball: usize) -> Recorder<'_> {
        let events = self.events.as_ref().map(|table| EventRecorder { table, ball, rows: String::new() });
        let sampler = || FrameSampler::new(self.fps, self.duration);
        let frames = self.frames.as_ref();
        (events, frames.map(|table| FrameRecorder { table, ball, sampler: sampler(), written: 0, rows: String::new() }))
    }
}

/// Watches a ball.
pub type Recorder<'a> = (Option<EventRecorder<'a>>, Option<FrameRecorder<'a>>);

/// Writes the events of a ball.
pub struct EventRecorder<'a> {
    table: &'a EventRows,
    ball: usize,
    /// What is written so far.
    pub rows: String,
}

impl Observer for EventRecorder<'_> {
    fn event(&mut self, event: &Event) {
        self.table.push(&mut self.rows, self.ball, event);
    }

    fn segment(&mut self, _: &Segment) {}
}

/// Writes the frames of a ball.
pub struct FrameRecorder<'a> {
    table: &'a FrameRows,
    ball: usize,
    sampler: FrameSampler,
    written: usize,
    /// What is written so far.
    pub rows: String,
}

impl Observer for FrameRecorder<'_> {
    fn event(&mut self, _: &Event) {}

    fn segment(&mut self, segment: &Segment) {
        self.sampler.segment(segment);
        let frames = self.sampler.frames();
        for frame in &frames[self.written..] {
            self.table.push(&mut self.rows, self.ball, frame);
        }
        self.written = frames.len();
    }
}
