//! The house rules that a machine can check.

use carom_tests::sources::{self, Source};
use std::collections::BTreeSet;

/// This file, which holds the words it looks for.
const THIS_FILE: &str = "tests/tests/tidy.rs";

/// A file that one cannot take in at one sitting is two.
const LONGEST: usize = 400;

/// What stands for work not done, for a test not run, and for a lint switched off for a whole file.
const UNFINISHED: [&str; 5] = ["todo!(", "unimplemented!(", "dbg!(", "#[ignore", "#![allow("];

/// The only files that may hold small numbers: the bounds of rounding, and the thresholds of the model.
const HOMES_OF_SMALL_NUMBERS: [&str; 2] = ["crates/geometry/src/rounding.rs", "crates/dynamics/src/tolerance.rs"];

/// Below this, a literal in a computation is a tolerance whatever it is called.
const SMALL: f64 = 1e-3;

/// Folders that exist on one machine only.
const ONE_MACHINE: [&str; 5] = ["/work/", "/root/", "/home/", "/Users/", "/tmp/"];

/// Fails with every finding, each with its place.
#[track_caller]
fn assert_none(rule: &str, found: &[String]) {
    assert!(found.is_empty(), "{rule}; {} places:\n{}", found.len(), found.join("\n"));
}

/// The findings of `judge` in lines with their numbers.
fn judged<'a>(
    source: &Source,
    lines: impl IntoIterator<Item = (usize, &'a str)>,
    judge: impl Fn(&str) -> Option<String>,
) -> Vec<String> {
    let found = lines.into_iter().filter_map(|(number, line)| Some((number, judge(line)?)));
    found.map(|(number, what)| format!("{}:{number}: {what}", source.path)).collect()
}

/// The findings of `judge` in whole texts, comments and tests included; this file is left out.
fn in_texts(sources: &[Source], judge: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let others = sources.iter().filter(|source| source.path != THIS_FILE);
    others.flat_map(|source| judged(source, (1..).zip(source.text.lines()), &judge)).collect()
}

/// The first of the words that a line has.
fn first_of(words: &[&str], line: &str) -> Option<String> {
    words.iter().find(|word| line.contains(**word)).map(|word| (*word).to_owned())
}

#[test]
fn every_file_begins_by_saying_what_it_is() {
    let sources = sources::rust();
    let silent: Vec<_> = sources.iter().filter(|s| !s.text.starts_with("//! ")).map(|s| s.path.clone()).collect();
    assert_none("a file begins with one `//!` sentence", &silent);
}

#[test]
fn no_file_is_too_long() {
    let lengths = sources::rust().into_iter().map(|source| (source.text.lines().count(), source.path));
    let long: Vec<_> = lengths.filter(|(n, _)| *n > LONGEST).map(|(n, path)| format!("{path}: {n} lines")).collect();
    assert_none("a file has at most 400 lines", &long);
}

#[test]
fn nothing_is_left_unfinished() {
    let found = in_texts(&sources::rust(), |line| first_of(&UNFINISHED, line));
    assert_none("no unfinished work, no tests that are not run, no lints switched off for a file", &found);
}

#[test]
fn r29_small_numbers_live_in_their_two_homes() {
    let libraries = ["crates/geometry/src", "crates/dynamics/src"];
    let sources: Vec<_> = libraries.iter().flat_map(|folder| sources::files(folder, &[".rs"])).collect();
    for home in HOMES_OF_SMALL_NUMBERS {
        assert!(sources.iter().any(|source| source.path == home), "{home} has moved");
    }
    let elsewhere = sources.iter().filter(|source| !HOMES_OF_SMALL_NUMBERS.contains(&source.path.as_str()));
    let found: Vec<_> = elsewhere.flat_map(|source| judged(source, source.code(), small_number)).collect();
    assert_none("an epsilon belongs into rounding.rs or tolerance.rs", &found);
}

/// The first literal of a line that is a small positive number, or a standard epsilon.
fn small_number(line: &str) -> Option<String> {
    words_and_numbers(line).into_iter().find(|word| *word == "EPSILON" || is_small(word)).map(str::to_owned)
}

fn is_small(word: &str) -> bool {
    let digits = word.trim_end_matches("f64").trim_end_matches("f32").replace('_', "");
    digits.starts_with(|c: char| c.is_ascii_digit()) && digits.parse().is_ok_and(|x: f64| x > 0.0 && x < SMALL)
}

/// The identifiers and the numbers of a line, numbers with the sign of their exponent: `1e-9`.
fn words_and_numbers(line: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut start = None;
    for (i, c) in line.char_indices() {
        let word = start.map(|start| &line[start..i]);
        let exponent = |word: &str| word.starts_with(|c: char| c.is_ascii_digit()) && word.ends_with(['e', 'E']);
        if c.is_ascii_alphanumeric() || c == '_' || c == '.' || (c == '-' && word.is_some_and(exponent)) {
            start = start.or(Some(i));
        } else {
            words.extend(word);
            start = None;
        }
    }
    words.extend(start.map(|start| &line[start..]));
    words
}

#[test]
fn small_numbers_are_recognised() {
    for line in ["x < 1e-9", "1E-6_f64", "d < 0.000_001;", "if y>1.5e-4{", "f64::EPSILON * 2.0", "0.0005"] {
        assert!(small_number(line).is_some(), "{line}");
    }
    for line in ["x - 1", "1e9", "0.0", "0.5", "a1e-9", "2.0_f64.powi(-53)", "x0.001", "n - 0.25", "EPSILON_OF"] {
        assert_eq!(small_number(line), None, "{line}");
    }
}

#[test]
fn the_project_stands_by_itself() {
    let texts = sources::files("", &[".rs", ".md", ".toml"]);
    assert_none("no path of one machine", &in_texts(&texts, |line| first_of(&ONE_MACHINE, line)));
    let names = texts.iter().filter_map(|source| source.path.rsplit('/').next());
    let known: BTreeSet<&str> = names.filter(|name| name.ends_with(".md")).collect();
    let absent = |line: &str| documents(line).find(|name| !known.contains(name)).map(str::to_owned);
    assert_none("a document that is mentioned is in the project", &in_texts(&texts, absent));
}

/// The names of the Markdown files that a line mentions.
fn documents(line: &str) -> impl Iterator<Item = &str> {
    let names = line.split(|c: char| !(c.is_ascii_alphanumeric() || "-_.".contains(c)));
    names.filter(|name| name.ends_with(".md") && *name != ".md")
}
