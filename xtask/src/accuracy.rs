//! What accuracy costs in three scenes: `cargo xtask accuracy` measures, draws and writes; `verify` measures again and compares all but the time.

use crate::project::{Carom, Project, output};
use crate::{Result, readme};
use std::fs;
use std::process::ExitCode;

/// The methods that a scene can ask for.
const OFFERED: [&str; 5] = ["euler", "semi-implicit-euler", "rk4", "adaptive", "exact"];

/// Where the measurements and pictures are.
const FOLDER: &str = "docs/accuracy";

/// The scenes, by name, and what each is.
const SCENES: [(&str, &str); 3] = [
    ("drop", "One plane, nothing but gravity"),
    ("throw", "A flight with air resistance, and its bounces"),
    ("bunny", "A mesh of 696 triangles"),
];

/// Errors in m that a table asks for.
const TARGETS: [&str; 6] = ["1e-1", "1e-2", "1e-4", "1e-6", "1e-9", "1e-12"];

/// The columns by the clock, the last ones.
const CLOCK: usize = 2;

/// Measures the scenes, draws the plots, and writes the table of the README anew.
pub fn run() -> Result<ExitCode> {
    let project = Project::find()?;
    let carom = project.carom()?;
    fs::create_dir_all(project.root().join(FOLDER))?;
    for (name, _) in SCENES {
        let (scene, csv, plot) = (scene(name), csv(name), plot(name));
        let (_, said) = output(&mut carom.command(["accuracy", &scene, "--csv", &csv, "--plot", &plot]))?;
        eprint!("{said}");
        println!("{csv}\n{plot}");
    }
    readme::rewrite()
}

/// The sections of the README.
pub fn block(project: &Project) -> Result<String> {
    let mut text = String::new();
    for (name, what) in SCENES {
        let rows = Table::read(project, name)?;
        text += &format!("{what} ([{name}.toml]({})):\n\n![error over cost, {name}]({})\n\n", scene(name), plot(name));
        text +=
            "| right to, m | cheapest method | off by, m | ns for a second of a ball | work |\n|---|---|---|---|---|\n";
        for target in TARGETS {
            text += &match rows.cheapest(target.parse()?)? {
                None => format!("| {target} | none | | | |\n"),
                Some(best) => format!(
                    "| {target} | {} | {:.0e} | {:.0} | {:.0} |\n",
                    best.setting()?,
                    best.number("position_error")?,
                    best.number("ns_per_second")?,
                    best.number("work")?
                ),
            };
        }
        let slides = rows.rows().filter(|row| row.text("method") == "slides").last().ok_or("no row of the slides")?;
        text += &format!(
            "\nThe slides as published, {}: off by {} m, {} impacts missed and {} invented, {:.0} ns.\n\n",
            slides.setting()?,
            error(slides.number("position_error")?),
            slides.text("missed"),
            slides.text("invented"),
            slides.number("ns_per_second")?
        );
    }
    Ok(text)
}

/// What is not as the program measures it now, a sentence each; the clock's numbers are not looked at.
pub fn stale(project: &Project, carom: &Carom) -> Result<Vec<String>> {
    let mut sentences = Vec::new();
    for (name, _) in SCENES {
        let (path, scene) = (csv(name), scene(name));
        let (fresh, _) = output(&mut carom.command(["accuracy", &scene, "--repeats", "0", "--csv", "-"]))?;
        let old = project.read(&path)?;
        if let Some((line, _)) = (1..).zip(untimed(&old).zip(untimed(&fresh))).find(|(_, (a, b))| a != b) {
            sentences.push(format!(
                "{path}:{line}: the program measures something else; `cargo xtask accuracy` writes it anew"
            ));
        } else if old.lines().count() != fresh.lines().count() {
            sentences.push(format!("{path}: the program measures more or less; `cargo xtask accuracy` writes it anew"));
        }
        // The picture tells its errors and orders in its description.
        let drawn = project.read(&plot(name))?;
        let svg = output(&mut carom.command(["accuracy", &scene, "--repeats", "0", "--plot", "-"]))?.0;
        if findings(&drawn) != findings(&svg) {
            sentences.push(format!("{}: shows something else; `cargo xtask accuracy` draws it anew", plot(name)));
        }
    }
    Ok(sentences)
}

fn scene(name: &str) -> String {
    format!("crates/app/scenes/{name}.toml")
}

fn csv(name: &str) -> String {
    format!("{FOLDER}/{name}.csv")
}

fn plot(name: &str) -> String {
    format!("{FOLDER}/{name}.svg")
}

fn error(x: f64) -> String {
    if x.is_finite() { format!("{x:.0e}") } else { "any number of".to_owned() }
}

/// The lines without the columns of the clock.
fn untimed(csv: &str) -> impl Iterator<Item = &str> {
    csv.lines().map(|line| line.rsplitn(CLOCK + 1, ',').last().unwrap_or_default())
}

/// The part of a picture's description that says what came out.
fn findings(svg: &str) -> &str {
    let description = svg.split_once("<desc>").map_or("", |(_, rest)| rest.split("</desc>").next().unwrap_or(""));
    description.split_once("cheaper.").map_or("", |(_, findings)| findings)
}

/// A table of measurements.
struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// A row of it.
#[derive(Clone, Copy)]
struct Row<'a> {
    columns: &'a [String],
    cells: &'a [String],
}

impl Table {
    fn read(project: &Project, name: &str) -> Result<Self> {
        let text = project.read(&csv(name)).map_err(|error| format!("{error}; `cargo xtask accuracy` makes it"))?;
        Ok(Self::parse(&text))
    }

    /// Of a CSV without quotes.
    fn parse(text: &str) -> Self {
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect());
        Self { columns: lines.next().unwrap_or_default(), rows: lines.collect() }
    }

    fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { columns: &self.columns, cells })
    }

    /// The cheapest row by work of a method that a scene can ask for, right to `target`.
    fn cheapest(&self, target: f64) -> Result<Option<Row<'_>>> {
        let mut best: Option<(f64, Row<'_>)> = None;
        for row in self.rows().filter(|row| OFFERED.contains(&row.text("method"))) {
            let work = row.number("work")?;
            if row.number("position_error")? <= target && best.is_none_or(|(least, _)| work < least) {
                best = Some((work, row));
            }
        }
        Ok(best.map(|(_, row)| row))
    }
}

impl Row<'_> {
    fn text(&self, column: &str) -> &str {
        let place = self.columns.iter().position(|name| name == column);
        place.and_then(|k| self.cells.get(k)).map_or("", String::as_str)
    }

    fn number(&self, column: &str) -> Result<f64> {
        let text = self.text(column);
        text.parse().map_err(|_| format!("{FOLDER}: `{text}` in column {column} is no number").into())
    }

    /// The method with its step or tolerance.
    fn setting(&self) -> Result<String> {
        let method = self.text("method");
        Ok(match (self.text("step"), self.text("tolerance")) {
            ("", "") => format!("`{method}`"),
            ("", tolerance) => format!("`{method}`, tolerance {tolerance}"),
            // Steps are powers of two.
            _ => format!("`{method}`, h = 1/{} s", 1.0 / self.number("step")?),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CSV: &str = "method,step,tolerance,position_error,work,ns_per_second,ns_per_impact\n\
                       slides,0.5,,1e-9,1,7,8\neuler,0.125,,0.01,20,9,\nadaptive,,1e-5,1e-6,10,11,12\n";

    #[test]
    fn the_cheapest_is_one_that_a_scene_can_ask_for() {
        let table = Table::parse(CSV);
        let best = |target| table.cheapest(target).expect("numbers").map(|row| row.setting().expect("numbers"));
        assert_eq!(best(0.1).as_deref(), Some("`adaptive`, tolerance 1e-5"));
        assert_eq!(best(1e-9), None);
        assert_eq!(
            table.rows().nth(1).map(|row| row.setting().expect("numbers")).as_deref(),
            Some("`euler`, h = 1/8 s")
        );
    }

    #[test]
    fn time_is_not_compared_and_all_else_is() {
        let other = CSV.replace(",9,", ",99,").replace("11,12", "13,14");
        assert!(untimed(CSV).eq(untimed(&other)));
        assert!(!untimed(CSV).eq(untimed(&CSV.replace("1e-6", "2e-6"))));
        let svg = |unit: &str, error: &str| {
            format!("<desc>\nError over {unit}. Lower is better, left is cheaper. {error}\n</desc>")
        };
        assert_eq!(findings(&svg("time", "1")), findings(&svg("work", "1")));
        assert_ne!(findings(&svg("time", "1")), findings(&svg("time", "2")));
    }
}
