//! What is kept of a ball while it is simulated: its rows, as far as they can be made ready for their file already.

use super::Form;
use super::rows::{EventRows, FrameRows};
use crate::cli::RunArgs;
use crate::error::AppError;
use carom_dynamics::events::Event;
use carom_dynamics::observer::{Frame, FrameSampler, Observer, Segment};
use carom_dynamics::scene::Scene;

/// More frames of one ball than this are taken for a slip: they stay in memory until the ball is done.
const FRAME_LIMIT: f64 = 1e8;

/// Which tables a run writes, and how.
pub struct Recording {
    /// The table of events, if it is wanted.
    pub events: Option<Form<EventRows>>,
    /// The table of frames, if it is wanted.
    pub frames: Option<Form<FrameRows>>,
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
        let events = args.events.as_deref().map(Form::of).transpose()?;
        let frames = args.frames.as_deref().map(Form::of).transpose()?;
        Ok(Self {
            events: events.map(|form| form.map(|format| EventRows::new(format, scene))),
            frames: frames.map(|form| form.map(|format| FrameRows::new(format, scene))),
            fps: args.fps,
            duration: scene.duration,
        })
    }

    /// The recorder of a ball.
    pub fn of(&self, ball: usize) -> Recorder<'_> {
        let sampler = || FrameSampler::new(self.fps, self.duration);
        Recorder {
            ball,
            events: self.events.as_ref().map(|form| EventRecorder { ball, rows: Rows::of(form) }),
            frames: self.frames.as_ref().map(|form| FrameRecorder {
                ball,
                sampler: sampler(),
                written: 0,
                rows: Rows::of(form),
            }),
        }
    }
}

/// Rows of a table by some `R`, of some `T`.
pub enum Rows<'a, R, T> {
    /// As they are written, and by what.
    Text(&'a R, String),
    /// As they are, for columns to be made of them.
    Items(Vec<T>),
}

impl<'a, R, T> Rows<'a, R, T> {
    fn of(form: &'a Form<R>) -> Self {
        match form {
            Form::Rows(table) => Self::Text(table, String::new()),
            Form::Columns => Self::Items(Vec::new()),
        }
    }
}

/// Watches a ball.
pub struct Recorder<'a> {
    /// Which one.
    pub ball: usize,
    /// Its events, if they are wanted.
    pub events: Option<EventRecorder<'a>>,
    /// Its frames, if they are wanted.
    pub frames: Option<FrameRecorder<'a>>,
}

impl Observer for Recorder<'_> {
    fn event(&mut self, event: &Event) {
        self.events.event(event);
    }

    fn segment(&mut self, segment: &Segment) {
        self.frames.segment(segment);
    }
}

/// Writes the events of a ball.
pub struct EventRecorder<'a> {
    ball: usize,
    /// What is written so far.
    pub rows: Rows<'a, EventRows, Event>,
}

impl Observer for EventRecorder<'_> {
    fn event(&mut self, event: &Event) {
        match &mut self.rows {
            Rows::Text(table, text) => table.push(text, self.ball, event),
            Rows::Items(events) => events.push(*event),
        }
    }

    fn segment(&mut self, _: &Segment) {}
}

/// Writes the frames of a ball.
pub struct FrameRecorder<'a> {
    ball: usize,
    sampler: FrameSampler,
    written: usize,
    /// What is written so far.
    pub rows: Rows<'a, FrameRows, Frame>,
}

impl Observer for FrameRecorder<'_> {
    fn event(&mut self, _: &Event) {}

    fn segment(&mut self, segment: &Segment) {
        self.sampler.segment(segment);
        let frames = &self.sampler.frames()[self.written..];
        self.written += frames.len();
        match &mut self.rows {
            Rows::Text(table, text) => frames.iter().for_each(|frame| table.push(text, self.ball, frame)),
            Rows::Items(items) => items.extend(frames),
        }
    }
}
