//! From a chart to the elements of its picture.

use super::labels::{self, Area, Place};
use super::look::{self, TEXT, TITLE};
use super::scale::Ruler;
use super::{Across, Chart, Drawn, Series};
use std::fmt::Write;
use svg::Document;
use svg::node::element::{Description, Group, Path, Rectangle, Style, Text, Title};

/// Space for the numbers and the label of an axis, and beyond its ends, in pixels.
const LEFT: f64 = 76.0;
const RIGHT: f64 = 20.0;
const BELOW: f64 = 56.0;
const ABOVE: f64 = 20.0;

/// Width of the sample before a name, in pixels.
const SAMPLE: f64 = 38.0;

/// A chart with its axes laid out.
struct Layout<'a> {
    chart: &'a Chart,
    x: Ruler,
    y: Ruler,
    frame: Area,
    /// The title in lines.
    title: Vec<String>,
}

/// The chart as an SVG document.
pub fn svg(chart: &Chart) -> String {
    let layout = Layout::new(chart);
    let [width, height] = chart.size;
    let whole = || Rectangle::new().set("width", width).set("height", height).set("class", "paper");
    let document = Document::new()
        .set("viewBox", (0, 0, width, height))
        .set("width", width)
        .set("height", height)
        .set("class", "carom-chart")
        .set("role", "img")
        .set("aria-label", chart.title.as_str())
        .add(Title::new(chart.title.as_str()))
        .add(Description::new().add(svg::node::Text::new(chart.description.as_str())))
        .add(Style::new(look::css()))
        .add(whole())
        .add(layout.heading())
        .add(layout.axes())
        .add(layout.rules());
    let document = chart.series.iter().fold(document, |document, series| document.add(layout.series(series)));
    format!("{}\n", document.add(layout.names()))
}

impl<'a> Layout<'a> {
    fn new(chart: &'a Chart) -> Self {
        let [width, height] = chart.size.map(f64::from);
        let title = lines(&chart.title, width - 2.0 * RIGHT);
        let top = ABOVE + 1.4 * TITLE * title.len() as f64;
        let frame = Area { x: [LEFT, width - RIGHT], y: [top, height - BELOW] };
        let ruled = |across| chart.rules.iter().filter(move |r| r.across == across).map(|r| r.value);
        let points = || chart.series.iter().flat_map(|s| &s.points);
        let xs = points().map(|p| p[0]).chain(ruled(Across::X));
        let ys = points().map(|p| p[1]).chain(ruled(Across::Y));
        let mut x = Ruler::new(chart.x.scale, xs, frame.x[0], frame.x[1]);
        let mut y = Ruler::new(chart.y.scale, ys, frame.y[1], frame.y[0]);
        if chart.equal {
            let density = x.density().min(y.density());
            x.widen_to(density);
            y.widen_to(density);
        }
        Self { chart, x, y, frame, title }
    }

    fn heading(&self) -> Group {
        self.title.iter().enumerate().fold(Group::new(), |group, (k, line)| {
            group.add(text(line, RIGHT, ABOVE + (0.6 + 1.4 * k as f64) * TITLE, "start").set("class", "title"))
        })
    }

    fn axes(&self) -> Group {
        let Area { x: [left, right], y: [top, bottom] } = self.frame;
        let (mut grid, mut numbers) = (String::new(), Group::new());
        for tick in self.x.ticks() {
            let _ = write!(grid, "M{:.1} {top:.1}V{bottom:.1}", tick.at);
            numbers = numbers.add(text(&tick.label, tick.at, bottom + 1.5 * TEXT, "middle"));
        }
        for tick in self.y.ticks() {
            let _ = write!(grid, "M{left:.1} {:.1}H{right:.1}", tick.at);
            numbers = numbers.add(text(&tick.label, left - 8.0, tick.at + 0.35 * TEXT, "end"));
        }
        let edge = Rectangle::new()
            .set("class", "frame")
            .set("x", left)
            .set("y", top)
            .set("width", right - left)
            .set("height", bottom - top);
        let (across, up) = (0.5 * (left + right), 0.5 * (top + bottom));
        let label = text(&self.chart.y.label, 0.0, 0.0, "middle");
        Group::new()
            .add(Path::new().set("class", "grid").set("d", grid))
            .add(edge)
            .add(numbers)
            .add(text(&self.chart.x.label, across, bottom + 3.3 * TEXT, "middle"))
            .add(label.set("transform", format!("translate({:.1} {up:.1}) rotate(-90)", 1.4 * TEXT)))
    }

    fn rules(&self) -> Group {
        let Area { x: [left, right], y: [top, bottom] } = self.frame;
        self.chart.rules.iter().fold(Group::new(), |group, rule| {
            let (at, path) = match rule.across {
                Across::X => (self.x.at(rule.value), format!("V{bottom:.1}")),
                Across::Y => (self.y.at(rule.value), format!("H{right:.1}")),
            };
            let Some(at) = at else { return group };
            let (start, label) = match rule.across {
                Across::X => ([at, top], text(&rule.label, at + 5.0, bottom - 6.0, "start")),
                Across::Y => ([left, at], text(&rule.label, left + 6.0, at - 5.0, "start")),
            };
            let d = format!("M{:.1} {:.1}{path}", start[0], start[1]);
            group.add(Path::new().set("class", "rule").set("d", d)).add(label)
        })
    }

    /// Where a point comes to lie.
    fn at(&self, point: &[f64; 2]) -> Option<[f64; 2]> {
        Some([self.x.at(point[0])?, self.y.at(point[1])?])
    }

    fn series(&self, series: &Series) -> Group {
        let look = look::look(series.look);
        let mut group = Group::new();
        if series.drawn != Drawn::Marks {
            let mut d = String::new();
            let mut pen = 'M';
            for point in &series.points {
                match self.at(point) {
                    Some([x, y]) => {
                        let _ = write!(d, "{pen}{x:.1} {y:.1}");
                        pen = 'L';
                    }
                    None => pen = 'M',
                }
            }
            group = group.add(Path::new().set("class", format!("series line{look}")).set("d", d));
        }
        if series.drawn != Drawn::Line {
            for [x, y] in series.points.iter().filter_map(|p| self.at(p)) {
                group = group.add(look::mark(look, x, y));
            }
        }
        group
    }

    fn names(&self) -> Group {
        let series = &self.chart.series;
        let lines: Vec<Vec<_>> = series.iter().map(|s| s.points.iter().filter_map(|p| self.at(p)).collect()).collect();
        let size = |s: &Series| match s.name.as_str() {
            "" => [0.0, 0.0],
            name => [sample(s) + look::width(name, TEXT), 1.3 * TEXT],
        };
        let sizes: Vec<_> = series.iter().map(size).collect();
        let ruled = self.chart.rules.iter().filter(|r| r.across == Across::Y).filter_map(|rule| {
            let bottom = self.y.at(rule.value)?;
            let left = self.frame.x[0];
            Some(Area { x: [left, left + look::width(&rule.label, TEXT) + 6.0], y: [bottom - 1.5 * TEXT, bottom] })
        });
        let places = labels::place(&sizes, &lines, self.frame, &ruled.collect::<Vec<_>>());
        series.iter().zip(places).fold(Group::new(), |group, (s, place)| {
            let Some(Place { area, leader }) = place else { return group };
            let look = look::look(s.look);
            let (left, middle) = (area.x[0], 0.5 * (area.y[0] + area.y[1]));
            let name = text(&s.name, left + sample(s), middle + 0.35 * TEXT, "start");
            let mut group = group.add(name.set("class", format!("name name{look}")));
            if sample(s) > 0.0 && s.drawn != Drawn::Marks {
                let d = format!("M{:.1} {middle:.1}h{:.1}", left + 7.0, SAMPLE - 13.0);
                group = group.add(Path::new().set("class", format!("series line{look}")).set("d", d));
            }
            if sample(s) > 0.0 && s.drawn != Drawn::Line {
                group = group.add(look::mark(look, left + 0.5 * SAMPLE + 0.5, middle));
            }
            let Some([[ax, ay], [bx, by]]) = leader else { return group };
            let d = format!("M{ax:.1} {ay:.1}L{bx:.1} {by:.1}");
            group.add(Path::new().set("class", format!("leader line{look}")).set("d", d))
        })
    }
}

/// Space for a sample of the series before its name, so that neither needs the colour; a point alone has its name beside it.
fn sample(series: &Series) -> f64 {
    if series.points.len() > 1 { SAMPLE } else { 0.0 }
}

fn text(words: &str, x: f64, y: f64, anchor: &str) -> Text {
    Text::new(words).set("x", format!("{x:.1}")).set("y", format!("{y:.1}")).set("text-anchor", anchor)
}

/// `title` in lines that fit into `width`.
fn lines(title: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in title.split_whitespace() {
        match lines.last_mut() {
            Some(line) if look::width(line, TITLE) + look::width(word, TITLE) + TITLE < width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
