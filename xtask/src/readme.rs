//! The generated blocks of the README: `cargo xtask readme` writes them, and `verify` compares them.

use crate::project::{Carom, Project, output};
use crate::{Result, accuracy, blocks, certification, conformance, measure};
use std::fs;
use std::process::ExitCode;

/// Where the README is.
pub const PATH: &str = "README.md";

/// The job the program is for: a thousand balls let fall on a landscape.
const MAIN_JOB: &str = "crates/app/scenes/jacksboro.toml";

/// A job that is done at once, to see what its outputs look like.
const SMALL_JOB: &str = "crates/app/scenes/barrier-1d.toml";

/// Writes the blocks anew and names those that changed; a block that cannot be made stays as it is.
pub fn rewrite() -> Result<ExitCode> {
    let project = Project::find()?;
    let old = project.read(PATH)?;
    let (new, errors) = fresh(&project, &project.carom()?, &old)?;
    for name in differing(&old, &new)? {
        println!("{PATH}: block `{name}` is new");
    }
    if new != old {
        fs::write(project.root().join(PATH), new)?;
    }
    for error in &errors {
        eprintln!("error: {error}");
    }
    Ok(if errors.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// What is wrong with the blocks, a sentence each; then what the README would be.
pub fn stale(project: &Project, carom: &Carom) -> Result<Vec<String>> {
    let old = project.read(PATH)?;
    let (new, mut sentences) = fresh(project, carom, &old)?;
    let sentence = |name| format!("{PATH}: block `{name}` is stale; `cargo xtask readme` writes it anew");
    sentences.extend(differing(&old, &new)?.into_iter().map(sentence));
    if new != old {
        sentences.push(format!("\n{PATH} would be:\n\n{new}"));
    }
    Ok(sentences)
}

/// The text with its blocks as they would be if written now, and why some could not be.
fn fresh(project: &Project, carom: &Carom, old: &str) -> Result<(String, Vec<String>)> {
    let mut errors = Vec::new();
    let new = blocks::replace(old, |name, body| {
        make(project, carom, name).unwrap_or_else(|error| {
            errors.push(format!("{PATH}: block `{name}`: {error}"));
            body.to_owned()
        })
    })?;
    Ok((new, errors))
}

fn differing<'a>(old: &'a str, new: &str) -> Result<Vec<&'a str>> {
    let (before, after) = (blocks::find(old)?, blocks::find(new)?);
    let pairs = before.iter().zip(&after);
    Ok(pairs.filter(|(b, a)| old[b.body.clone()] != new[a.body.clone()]).map(|(b, _)| b.name).collect())
}

/// What belongs into the block of this name.
fn make(project: &Project, carom: &Carom, name: &str) -> Result<String> {
    match name.split_once(' ').unwrap_or((name, "")) {
        ("main-job", "") => main_job(carom),
        ("help", "") => Ok(fenced("text", &output(&mut carom.command(["--help"]))?.0)),
        ("outputs", "") => outputs(carom),
        ("crates", "") => crates(project),
        ("accuracy", "") => accuracy::block(project),
        ("certification", "") => certification::TABLE.block(project),
        ("peers", "") => measure::PEERS.block(project),
        ("scaling", "") => measure::SCALING.block(project),
        ("conformance", "") => conformance::block(project),
        ("example", package) => example(project, package),
        ("file", path) => Ok(fenced(path.rsplit('.').next().unwrap_or_default(), &project.read(path)?)),
        _ => Err("nothing makes a block of this name".into()),
    }
}

/// The main job and what it says, without what another machine or hour would say differently.
fn main_job(carom: &Carom) -> Result<String> {
    // The events go where nobody keeps them.
    let (_, summary) = output(&mut carom.command(["run", MAIN_JOB, "--events", "-"]))?;
    let summary = without_wall_time(&summary).ok_or("the summary no longer says how long the run took")?;
    Ok(fenced("console", &format!("$ cargo run --release -- run {MAIN_JOB} --events events.csv\n{summary}")))
}

/// A summary without the end of the line that says how long the run took: `, 1.234 s on the clock`.
fn without_wall_time(summary: &str) -> Option<String> {
    const END: &str = " s on the clock";
    let line = summary.lines().find(|line| line.ends_with(END))?;
    let (simulated, _) = line.rsplit_once(", ")?;
    Some(summary.replace(line, simulated))
}

/// The files a run writes, with the columns it really writes.
fn outputs(carom: &Carom) -> Result<String> {
    let columns = |option: &str| -> Result<String> {
        let (text, _) = output(&mut carom.command(["run", SMALL_JOB, option, "-"]))?;
        Ok(text.lines().next().unwrap_or_default().replace(',', ", "))
    };
    let mut table = "| option | one line for each | columns |\n|---|---|---|\n".to_owned();
    table += &format!("| `--events FILE` | impact, begin of sliding, rest | `{}` |\n", columns("--events")?);
    table += &format!("| `--frames FILE --fps N` | ball and frame | `{}` |\n", columns("--frames")?);
    table += "| `--summary FILE` | run, as JSON | what the run prints, by name |\n";
    Ok(table)
}

/// The members of the workspace and what each is for.
fn crates(project: &Project) -> Result<String> {
    let mut table = "| crate | folder | what it is |\n|---|---|---|\n".to_owned();
    for member in project.members()? {
        let private = if member.published { "" } else { " (not published)" };
        table += &format!(
            "| `{}` | [{}]({}) | {}{private} |\n",
            member.name, member.folder, member.folder, member.description
        );
    }
    Ok(table)
}

/// The first example in a library's own documentation, where the doctests run it.
fn example(project: &Project, package: &str) -> Result<String> {
    let members = project.members()?;
    let member = members.iter().find(|member| member.name == package).ok_or_else(|| format!("no crate {package}"))?;
    let path = format!("{}/src/lib.rs", member.folder);
    let code =
        first_example(&project.read(&path)?).ok_or_else(|| format!("{path}: no example in its documentation"))?;
    Ok(fenced("rust", &code))
}

fn first_example(source: &str) -> Option<String> {
    let documentation = source.lines().filter_map(|line| line.strip_prefix("//!"));
    let mut lines = documentation.map(|line| line.strip_prefix(' ').unwrap_or(line)).skip_while(|line| *line != "```");
    lines.next()?;
    // A line behind `# ` is for the doctest, not for the reader.
    let code: Vec<&str> =
        lines.take_while(|line| *line != "```").filter(|line| !(*line == "#" || line.starts_with("# "))).collect();
    Some(code.join("\n"))
}

fn fenced(language: &str, text: &str) -> String {
    // Markdown shows what is inside as it is, but trailing blanks are noise in every later diff.
    let lines: Vec<&str> = text.trim_end().lines().map(str::trim_end).collect();
    format!("```{language}\n{}\n```\n", lines.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_example_is_the_first_code_of_the_documentation_without_hidden_lines() {
        let source = "//! A crate.\n//!\n//! ```\n//! let x = 1;\n//! # hidden();\n//!\n//! assert_eq!(x, 1);\n//! ```\n//! ```\n//! no\n//! ```\n";
        assert_eq!(first_example(source).as_deref(), Some("let x = 1;\n\nassert_eq!(x, 1);"));
        assert_eq!(first_example("//! No code.\nfn f() {}\n"), None);
    }

    #[test]
    fn wall_time_is_cut_off_and_missed_if_not_there() {
        let summary = "balls     1\ntime      3 s simulated, 0.012 s on the clock\n";
        assert_eq!(without_wall_time(summary).as_deref(), Some("balls     1\ntime      3 s simulated\n"));
        assert_eq!(without_wall_time("balls     1\n"), None);
    }

    #[test]
    fn a_block_that_differs_is_named() {
        let (old, new) =
            ("<!-- generated: a -->\n1\n<!-- /generated -->\n", "<!-- generated: a -->\n2\n<!-- /generated -->\n");
        assert_eq!(differing(old, new).expect("well formed"), ["a"]);
        assert!(differing(old, old).expect("well formed").is_empty());
    }
}
