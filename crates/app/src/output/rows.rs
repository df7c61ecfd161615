//! Events and frames as rows of CSV or JSON, their numbers so that they read back to the same bits.

use super::Format;
use carom_dynamics::events::{Event, EventKind, Motion};
use carom_dynamics::observer::Frame;
use carom_dynamics::scene::Scene;
use nalgebra::Vector3;
use std::fmt::{self, Write};

/// The last three only for scenes in which balls turn.
const EVENT_COLUMNS: [&str; 20] = [
    "t", "ball", "kind", "surface", "face", "x", "y", "z", "nx", "ny", "nz", "vx_in", "vy_in", "vz_in", "vx", "vy",
    "vz", "wx", "wy", "wz",
];

/// The last three only for scenes in which balls turn.
const FRAME_COLUMNS: [&str; 12] = ["t", "ball", "x", "y", "z", "vx", "vy", "vz", "state", "wx", "wy", "wz"];

/// The columns of a table of events, without those of spin where there is none.
pub fn event_columns(scene: &Scene) -> &'static [&'static str] {
    &EVENT_COLUMNS[..EVENT_COLUMNS.len() - if scene.spins() { 0 } else { 3 }]
}

/// The columns of a table of frames, without those of spin where there is none.
pub fn frame_columns(scene: &Scene) -> &'static [&'static str] {
    &FRAME_COLUMNS[..FRAME_COLUMNS.len() - if scene.spins() { 0 } else { 3 }]
}

/// Writes events.
pub struct EventRows {
    format: Format,
    /// The names of the surfaces, quoted as the format wants it.
    surfaces: Vec<String>,
    columns: &'static [&'static str],
}

impl EventRows {
    /// For a scene.
    pub fn new(format: Format, scene: &Scene) -> Self {
        let surfaces = scene.surfaces.iter().map(|s| quoted(&s.name, format)).collect();
        Self { format, surfaces, columns: event_columns(scene) }
    }

    /// What comes before the first row.
    pub fn header(&self) -> String {
        header(self.format, self.columns)
    }

    /// Appends a row.
    pub fn push(&self, rows: &mut String, ball: usize, event: &Event) {
        let mut row = Row::new(rows, self.format, self.columns);
        row.number(event.time);
        row.plain(ball);
        row.word(kind_name(event.kind));
        row.plain(self.surfaces.get(event.surface).map_or("", String::as_str));
        row.optional(event.face);
        row.vector(event.position.coords.as_ref());
        row.vector(event.normal.as_ref());
        row.vector(event.velocity_in.as_ref());
        row.vector(event.velocity.as_ref());
        row.spin(event.spin, self.columns.len() == EVENT_COLUMNS.len());
        row.end();
    }
}

/// Writes frames.
pub struct FrameRows {
    format: Format,
    columns: &'static [&'static str],
}

impl FrameRows {
    /// For a scene.
    pub fn new(format: Format, scene: &Scene) -> Self {
        Self { format, columns: frame_columns(scene) }
    }

    /// What comes before the first row.
    pub fn header(&self) -> String {
        header(self.format, self.columns)
    }

    /// Appends a row.
    pub fn push(&self, rows: &mut String, ball: usize, frame: &Frame) {
        let Frame { time, state, motion, spin } = frame;
        let mut row = Row::new(rows, self.format, self.columns);
        row.number(*time);
        row.plain(ball);
        row.vector(state.position.coords.as_ref());
        row.vector(state.velocity.as_ref());
        row.word(motion_name(*motion));
        row.spin(*spin, self.columns.len() == FRAME_COLUMNS.len());
        row.end();
    }
}

/// The name of a kind of event in tables and pages.
pub fn kind_name(kind: EventKind) -> &'static str {
    match kind {
        EventKind::Impact => "impact",
        EventKind::Slide => "slide",
        EventKind::Roll => "roll",
        EventKind::Rest => "rest",
        EventKind::Leave => "leave",
        EventKind::Wake => "wake",
        EventKind::EventBudget => "event-budget",
        EventKind::UnresolvedContact => "unresolved-contact",
        EventKind::UnstableStep => "unstable-step",
        EventKind::StepBudget => "step-budget",
        EventKind::Diverged => "diverged",
        _ => "other",
    }
}

/// The name of a motion in frames and summaries.
pub fn motion_name(motion: Motion) -> &'static str {
    match motion {
        Motion::Flying => "flying",
        Motion::Sliding => "sliding",
        Motion::Rolling => "rolling",
        Motion::Resting => "resting",
    }
}

fn header(format: Format, columns: &[&str]) -> String {
    match format {
        Format::Csv => columns.join(",") + "\n",
        Format::JsonLines => String::new(),
    }
}

/// `name` as a field of its own, with quotes where the format needs them.
fn quoted(name: &str, format: Format) -> String {
    match format {
        Format::JsonLines => serde_json::Value::from(name).to_string(),
        Format::Csv => {
            let mut writer = csv::WriterBuilder::new().terminator(csv::Terminator::Any(b'\n')).from_writer(Vec::new());
            let written = writer.write_record([name]).ok().and_then(|()| writer.into_inner().ok());
            let field = written.and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_default();
            field.strip_suffix('\n').unwrap_or(&field).to_owned()
        }
    }
}

/// A row that is being written.
struct Row<'a> {
    out: &'a mut String,
    format: Format,
    columns: std::slice::Iter<'static, &'static str>,
    first: bool,
}

impl<'a> Row<'a> {
    fn new(out: &'a mut String, format: Format, columns: &'static [&'static str]) -> Self {
        if format == Format::JsonLines {
            out.push('{');
        }
        Self { out, format, columns: columns.iter(), first: true }
    }

    fn next(&mut self) {
        if !std::mem::take(&mut self.first) {
            self.out.push(',');
        }
        let column = self.columns.next();
        if self.format == Format::JsonLines {
            self.push(format_args!("\"{}\":", column.unwrap_or(&"")));
        }
    }

    /// A string takes everything that is written to it.
    fn push(&mut self, what: fmt::Arguments<'_>) {
        let _ = self.out.write_fmt(what);
    }

    /// The shortest decimal that reads back to the same bits, with an exponent where that is shorter; -0.0 keeps its sign.
    fn number(&mut self, x: f64) {
        self.next();
        match self.format {
            // JSON has no number for what is not finite.
            Format::JsonLines if !x.is_finite() => self.out.push_str("null"),
            _ => self.push(format_args!("{x:?}")),
        }
    }

    fn vector(&mut self, v: &[f64; 3]) {
        v.iter().for_each(|&x| self.number(x));
    }

    /// The angular velocity where the table has it: 0 of a ball that does not turn beside others that do.
    fn spin(&mut self, spin: Option<Vector3<f64>>, is_told: bool) {
        if is_told {
            self.vector(spin.unwrap_or_else(Vector3::zeros).as_ref());
        }
    }

    fn plain(&mut self, what: impl fmt::Display) {
        self.next();
        self.push(format_args!("{what}"));
    }

    fn word(&mut self, word: &str) {
        self.next();
        match self.format {
            Format::Csv => self.out.push_str(word),
            Format::JsonLines => self.push(format_args!("\"{word}\"")),
        }
    }

    fn optional(&mut self, number: Option<u32>) {
        self.next();
        match (number, self.format) {
            (Some(n), _) => self.push(format_args!("{n}")),
            (None, Format::Csv) => {}
            (None, Format::JsonLines) => self.out.push_str("null"),
        }
    }

    fn end(self) {
        self.out.push_str(if self.format == Format::JsonLines { "}\n" } else { "\n" });
    }
}
