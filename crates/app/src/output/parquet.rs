//! Events and frames as Parquet: the columns of the other forms, with types.

use super::rows::{event_columns, frame_columns, kind_name, motion_name};
use super::target::{Demand, Target};
use crate::error::AppError;
use carom_dynamics::events::Event;
use carom_dynamics::observer::Frame;
use carom_dynamics::scene::Scene;
use nalgebra::Vector3;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use std::io;
use std::sync::Arc;

/// Rows that are kept until they are written as one group.
const GROUP: usize = 1 << 17;

/// A column of a group.
enum Column {
    Number(Vec<f64>),
    Count(Vec<i64>),
    /// Of values that may be absent: those that are not, and for each row 1 if it is there, else 0.
    Optional(Vec<i64>, Vec<i16>),
    Word(Vec<ByteArray>),
}

/// A table that is being written.
pub struct Table {
    writer: SerializedFileWriter<Target>,
    shown: String,
    columns: Vec<Column>,
    rows: usize,
    /// The names of the surfaces.
    surfaces: Vec<ByteArray>,
    /// Whether angular velocities are told.
    spins: bool,
}

impl Table {
    /// A table of the events of a scene.
    pub fn events(target: Target, scene: &Scene) -> Result<Self, AppError> {
        Self::new(target, "events", event_columns(scene), scene)
    }

    /// A table of the frames of a scene.
    pub fn frames(target: Target, scene: &Scene) -> Result<Self, AppError> {
        Self::new(target, "frames", frame_columns(scene), scene)
    }

    fn new(target: Target, name: &str, names: &[&str], scene: &Scene) -> Result<Self, AppError> {
        let shown = target.shown().to_owned();
        let (mut schema, mut columns) = (format!("message {name} {{"), Vec::new());
        let mut properties = WriterProperties::builder()
            .set_created_by(concat!("carom ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_dictionary_enabled(false);
        for &column in names {
            let (kind, values) = match column {
                "ball" => ("required int64", Column::Count(Vec::new())),
                "face" => ("optional int64", Column::Optional(Vec::new(), Vec::new())),
                "kind" | "surface" | "state" => ("required binary", Column::Word(Vec::new())),
                _ => ("required double", Column::Number(Vec::new())),
            };
            let annotation = if matches!(values, Column::Word(_)) { " (STRING)" } else { "" };
            schema += &format!(" {kind} {column}{annotation};");
            // What takes few values is kept as numbers of them.
            properties = properties.set_column_dictionary_enabled(column.into(), !matches!(values, Column::Number(_)));
            columns.push(values);
        }
        let make = || {
            let schema = Arc::new(parse_message_type(&(schema + " }"))?);
            SerializedFileWriter::new(target, schema, Arc::new(properties.build()))
        };
        let writer = make().map_err(|error| refused(&shown, error))?;
        let surfaces = scene.surfaces.iter().map(|surface| ByteArray::from(surface.name.as_str())).collect();
        Ok(Self { writer, shown, columns, rows: 0, surfaces, spins: scene.spins() })
    }

    /// Appends the events of a ball.
    pub fn push_events(&mut self, ball: usize, events: &[Event]) -> Result<Demand, AppError> {
        for event in events {
            let surface = self.surfaces.get(event.surface).cloned().unwrap_or_default();
            let spins = self.spins;
            let mut row = self.row();
            row.number(event.time);
            row.count(ball as i64);
            row.word(kind_name(event.kind).into());
            row.word(surface);
            row.optional(event.face.map(i64::from));
            for v in [&event.position.coords, &event.normal, &event.velocity_in, &event.velocity] {
                v.iter().for_each(|&x| row.number(x));
            }
            row.spin(event.spin, spins);
            self.end_row()?;
        }
        Ok(Demand::Open)
    }

    /// Appends the frames of a ball.
    pub fn push_frames(&mut self, ball: usize, frames: &[Frame]) -> Result<Demand, AppError> {
        for frame in frames {
            let spins = self.spins;
            let mut row = self.row();
            row.number(frame.time);
            row.count(ball as i64);
            for v in [&frame.state.position.coords, &frame.state.velocity] {
                v.iter().for_each(|&x| row.number(x));
            }
            row.word(motion_name(frame.motion).into());
            row.spin(frame.spin, spins);
            self.end_row()?;
        }
        Ok(Demand::Open)
    }

    fn row(&mut self) -> Row<'_> {
        Row(self.columns.iter_mut())
    }

    fn end_row(&mut self) -> Result<(), AppError> {
        self.rows += 1;
        if self.rows < GROUP { Ok(()) } else { self.write_group() }
    }

    fn write_group(&mut self) -> Result<(), AppError> {
        self.rows = 0;
        let written = write_group(&mut self.writer, &mut self.columns);
        written.map_err(|error| refused(&self.shown, error))
    }

    /// Writes what is left; gives back where it went.
    pub fn finish(mut self) -> Result<Target, AppError> {
        if self.rows > 0 {
            self.write_group()?;
        }
        self.writer.into_inner().map_err(|error| refused(&self.shown, error))
    }
}

fn write_group(writer: &mut SerializedFileWriter<Target>, columns: &mut [Column]) -> Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    for column in columns {
        let Some(mut out) = group.next_column()? else { break };
        match column {
            Column::Number(values) => {
                out.typed::<DoubleType>().write_batch(values, None, None)?;
                values.clear();
            }
            Column::Count(values) => {
                out.typed::<Int64Type>().write_batch(values, None, None)?;
                values.clear();
            }
            Column::Optional(values, there) => {
                out.typed::<Int64Type>().write_batch(values, Some(there), None)?;
                values.clear();
                there.clear();
            }
            Column::Word(values) => {
                out.typed::<ByteArrayType>().write_batch(values, None, None)?;
                values.clear();
            }
        }
        out.close()?;
    }
    group.close()?;
    Ok(())
}

fn refused(path: &str, error: ParquetError) -> AppError {
    let source = match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        error => io::Error::other(error),
    };
    AppError::Write { path: path.to_owned(), source }
}

/// The columns that a row has still to be put into; one of another type than the value is passed over, which no table does.
struct Row<'a>(std::slice::IterMut<'a, Column>);

impl Row<'_> {
    fn number(&mut self, x: f64) {
        if let Some(Column::Number(values)) = self.0.next() {
            values.push(x);
        }
    }

    /// 0 of a ball that does not turn beside others that do.
    fn spin(&mut self, spin: Option<Vector3<f64>>, is_told: bool) {
        if is_told {
            spin.unwrap_or_else(Vector3::zeros).iter().for_each(|&x| self.number(x));
        }
    }

    fn count(&mut self, n: i64) {
        if let Some(Column::Count(values)) = self.0.next() {
            values.push(n);
        }
    }

    fn optional(&mut self, n: Option<i64>) {
        if let Some(Column::Optional(values, there)) = self.0.next() {
            values.extend(n);
            there.push(i16::from(n.is_some()));
        }
    }

    fn word(&mut self, word: ByteArray) {
        if let Some(Column::Word(values)) = self.0.next() {
            values.push(word);
        }
    }
}
