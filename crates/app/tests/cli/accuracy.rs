//! `carom accuracy` and `integrator = "auto"`: the report, its files, the target, the choice.

use crate::common::{Folder, shown};

const DROP: &str = include_str!("../../scenes/drop.toml");
const THROW: &str = include_str!("../../scenes/throw.toml");

fn folder() -> Folder {
    let auto = format!("{THROW}\n[method]\nintegrator = \"auto\"\ntolerance = 1e-6\n");
    let never = auto.replace("1e-6", "1e-30");
    Folder::with(&[
        ("drop.toml", DROP.as_bytes()),
        ("throw.toml", THROW.as_bytes()),
        ("auto.toml", auto.as_bytes()),
        ("never.toml", never.as_bytes()),
    ])
}

#[test]
fn r26_the_report_of_a_drop() {
    let output = folder().run(&["accuracy", "drop.toml", "--octaves", "4", "--decades", "2", "--repeats", "1"]);
    // Numbers of the clock are masked; those of the work are not.
    let mut settings = insta::Settings::clone_current();
    settings.add_filter(
        r"(?m)^((?:\S+ ?)+? +(?:1/\d+|1e-\d+|-) +\S+ +\S+ +\S+ ) +\d+ +\d+( +\d+ +\d+ +\d+ +\d+ +\d+ +\d+)$",
        "$1 [ns] [ns]$2",
    );
    settings.add_filter(r"(?m)^((?:\S+ ?)+? +(?:1/\d+|1e-\d+|-) +\d\S* ) +\d+( +\d+)$", "$1 [ns]$2");
    settings.bind(|| insta::assert_snapshot!("drop", shown(&output)));
}

#[test]
fn the_counts_are_the_same_twice_and_the_files_are_there() {
    let folder = folder();
    for name in ["a", "b"] {
        let (csv, plot) = (format!("{name}.csv"), format!("{name}.svg"));
        let args = ["accuracy", "throw.toml", "--repeats", "0", "--octaves", "4", "--csv", &csv, "--plot", &plot];
        let output = folder.run(&args);
        assert_eq!(output.status.code(), Some(0), "{}", shown(&output));
    }
    assert_eq!(folder.read("a.csv"), folder.read("b.csv"));
    assert_eq!(folder.read("a.svg"), folder.read("b.svg"));
    let (csv, svg) = (folder.read("a.csv"), folder.read("a.svg"));
    // 7 methods with 5 steps and the adaptive one with 11 tolerances.
    assert_eq!(csv.lines().count(), 1 + 7 * 5 + 11);
    assert!(svg.contains("<desc>") && svg.contains("prefers-color-scheme: dark"));
    for method in ["slides", "euler", "semi-implicit-euler", "rk4", "dormand-prince", "adaptive"] {
        assert!(csv.lines().any(|line| line.starts_with(method)) && svg.contains(method), "{method}");
    }
}

#[test]
fn a_target_names_the_cheapest_or_is_5() {
    let folder = folder();
    let met = folder.run(&["accuracy", "throw.toml", "--repeats", "0", "--target-error", "1e-6"]);
    assert_eq!(met.status.code(), Some(0), "{}", shown(&met));
    insta::assert_snapshot!("target", String::from_utf8_lossy(&met.stderr));
    let missed = folder.run(&["accuracy", "throw.toml", "--repeats", "0", "--target-error", "1e-30"]);
    assert_eq!(missed.status.code(), Some(5), "{}", shown(&missed));
    insta::assert_snapshot!("target_missed", String::from_utf8_lossy(&missed.stderr));
}

#[test]
fn auto_chooses_before_the_run_and_says_what() {
    let folder = folder();
    let chosen = folder.run(&["run", "auto.toml", "--events", "a.csv"]);
    assert_eq!(chosen.status.code(), Some(0), "{}", shown(&chosen));
    let said = String::from_utf8_lossy(&chosen.stderr).into_owned();
    insta::assert_snapshot!("auto", said.lines().next().unwrap_or_default());
    let again = folder.run(&["run", "auto.toml", "--events", "b.csv", "--quiet"]);
    assert!(again.stderr.is_empty(), "{}", shown(&again));
    assert_eq!(folder.read("a.csv"), folder.read("b.csv"));
    assert_eq!(folder.run(&["run", "never.toml"]).status.code(), Some(5));
}
