//! Charts as SVG: lines and marks over linear or logarithmic axes, for people, in light and in dark.
//!
//! A chart stands alone: it has a title and a description for screen readers, names its series where they are and not in a legend, tells
//! them apart by mark and dash as well as by colour, and follows the reader's light or dark scheme. The same chart is the
//! same bytes everywhere.
//!
//! It is drawn on the elements of the crate `svg`. The chart libraries at hand leave out one or another of these: direct
//! labels, marks other than dots, a description, a dark scheme, or a program that needs no browser engine to write the file.

mod draw;
mod labels;
mod look;
mod scale;

/// A chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What it shows, in a line.
    pub title: String,
    /// What a person would see in it, in a few sentences, for whoever cannot.
    pub description: String,
    /// The axis to the right.
    pub x: Axis,
    /// The axis upwards.
    pub y: Axis,
    /// What is drawn, in this order.
    pub series: Vec<Series>,
    /// Lines of one value.
    pub rules: Vec<Rule>,
    /// Whether a unit is as long upwards as to the right: for places, both axes being linear.
    pub equal: bool,
    /// Width and height, in pixels of a screen at 100 %; it can be shown at any size.
    pub size: [u32; 2],
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// How values become lengths.
    pub scale: Scale,
}

/// How the values of an axis become lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// In proportion to the difference.
    Linear,
    /// In proportion to the logarithm; values that are not above 0 are not drawn.
    Log,
}

/// Points that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name, which is drawn beside it; empty for none.
    pub name: String,
    /// Which colour, mark and dash it has; there are 8, and they repeat. The same number looks the same in every chart.
    pub look: usize,
    /// The points in order. A line is broken where a coordinate is not finite.
    pub points: Vec<[f64; 2]>,
    /// What is drawn of it.
    pub drawn: Drawn,
}

/// What is drawn of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drawn {
    /// A mark at each point.
    Marks,
    /// A line through the points.
    Line,
    /// Both.
    Both,
}

/// A line across the chart where one coordinate has one value.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Which coordinate.
    pub across: Across,
    /// Its value.
    pub value: f64,
    /// What it is.
    pub label: String,
}

/// Which coordinate a rule fixes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
    /// A vertical line.
    X,
    /// A horizontal line.
    Y,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log }
    }
}

impl Series {
    /// A line with a mark at each of `points`.
    pub fn new(name: impl Into<String>, look: usize, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), look, points, drawn: Drawn::Both }
    }

    /// The same series, drawn differently.
    pub fn drawn(self, drawn: Drawn) -> Self {
        Self { drawn, ..self }
    }
}

impl Chart {
    /// An empty chart of a usual size.
    pub fn new(title: impl Into<String>, description: impl Into<String>, x: Axis, y: Axis) -> Self {
        let (title, description) = (title.into(), description.into());
        Self { title, description, x, y, series: Vec::new(), rules: Vec::new(), equal: false, size: [800, 560] }
    }

    /// The chart as an SVG document.
    pub fn svg(&self) -> String {
        draw::svg(self)
    }
}

#[cfg(test)]
mod tests;
