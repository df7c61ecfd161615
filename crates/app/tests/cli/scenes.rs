//! The scenes with real meshes: their first and last events, what they end as, and the work they take.

use crate::common::Folder;
use std::fmt::Write;

/// Numbers of an event in six digits: hundreds of bounces amplify the last ones, and the bits are compared elsewhere.
fn rounded(line: &str) -> String {
    let cell = |cell: &str| match cell.parse::<f64>() {
        Ok(x) if cell.contains(['.', 'e']) => format!("{x:.5e}"),
        _ => cell.to_owned(),
    };
    line.split(',').map(cell).collect::<Vec<_>>().join(",")
}

/// How a scene that comes with the program ends, and its first and last `n` events.
fn told(name: &str, n: usize) -> String {
    let folder = Folder::with(&[]);
    let scene = format!("{}/scenes/{name}", env!("CARGO_MANIFEST_DIR"));
    let output = folder.run(&["run", &scene, "--events", "events.csv", "--summary", "summary.json", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let events = folder.read("events.csv");
    let lines: Vec<&str> = events.lines().collect();
    let mut text = format!("{}\n", lines[0]);
    for line in &lines[1..=n] {
        writeln!(text, "{}", rounded(line)).expect("a string grows");
    }
    writeln!(text, "... {} events in all ...", lines.len() - 1).expect("a string grows");
    for line in &lines[lines.len() - n..] {
        writeln!(text, "{}", rounded(line)).expect("a string grows");
    }
    let summary: serde_json::Value = serde_json::from_str(&folder.read("summary.json")).expect("the summary is JSON");
    let counts = ["balls", "impacts", "resting", "sliding", "flying", "off_the_map", "ended_early", "counters"];
    for key in counts {
        writeln!(text, "{key}: {:#}", summary[key]).expect("a string grows");
    }
    text
}

#[test]
fn r28_a_cow_keeps_its_balls() {
    insta::assert_snapshot!(told("cow.toml", 3));
}

#[test]
fn r31_balls_on_the_jacksboro_fault_come_to_rest() {
    insta::assert_snapshot!(told("jacksboro.toml", 3));
}
