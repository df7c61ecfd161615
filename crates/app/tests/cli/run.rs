//! `carom run` end to end: what it writes, that it writes all or nothing, and that it writes the same every time.

use crate::common::{Folder, shown};
use std::io::Write;
use std::process::Stdio;

const BOUNCE: &str = r#"
version = 1
duration = 2.0
gravity = [0, 0, -9.81]
[materials.clay]
restitution = 0.75
friction = { coulomb = 0.6 }
[[surfaces]]
name = "floor"
material = "clay"
shape = { plane = { point = [0, 0, 0], normal = [0, 0, 1] } }
[[balls]]
position = [0.0, 0.0, 1.0]
velocity = [1.0, 0.0, 0.0]
radius = 0.033
"#;

/// A scene that comes with the program.
fn scene(name: &str) -> String {
    format!("{}/scenes/{name}", env!("CARGO_MANIFEST_DIR"))
}

#[track_caller]
fn succeeds(folder: &Folder, args: &[&str]) -> String {
    let output = folder.run(args);
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", shown(&output));
    String::from_utf8(output.stdout).expect("results are UTF-8")
}

/// The columns of a CSV table by name, as text.
fn rows(csv: &str) -> Vec<std::collections::HashMap<String, String>> {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    reader.deserialize().collect::<Result<_, _>>().expect("the table is CSV")
}

fn number(row: &std::collections::HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|e| panic!("{column}: {e}"))
}

#[test]
fn r03_a_change_of_sign_is_a_collision_at_the_slides_f() {
    let folder = Folder::with(&[]);
    let csv = succeeds(&folder, &["run", &scene("barrier-1d.toml"), "--events", "-", "--quiet"]);
    let hits = rows(&csv);
    assert_eq!(hits.len(), 1);
    // The steps end at y = 0.98 and 1.12: f = 0.02 / (0.02 + 0.12) = 1/7 of a step of 0.1 s after t = 0.7.
    assert!((number(&hits[0], "t") - 5.0 / 7.0).abs() < 1e-15, "{csv}");
    assert_eq!((number(&hits[0], "y"), number(&hits[0], "vy_in"), number(&hits[0], "vy")), (1.0, 1.4, -0.7));
    assert_eq!(
        (hits[0]["kind"].as_str(), hits[0]["surface"].as_str(), hits[0]["face"].as_str()),
        ("impact", "barrier", "")
    );
}

#[test]
fn columns_are_as_promised_and_rows_sorted() {
    let folder = Folder::with(&[]);
    let args = ["run", &scene("room.toml"), "--events", "e.csv", "--frames", "f.csv", "--fps", "24", "--quiet"];
    assert_eq!(succeeds(&folder, &args), "");
    assert_eq!(folder.names(), ["e.csv", "f.csv"]);
    let (events, frames) = (folder.read("e.csv"), folder.read("f.csv"));
    assert_eq!(events.lines().next(), Some("t,ball,kind,surface,face,x,y,z,nx,ny,nz,vx_in,vy_in,vz_in,vx,vy,vz"));
    assert_eq!(frames.lines().next(), Some("t,ball,x,y,z,vx,vy,vz,state"));
    for table in [rows(&events), rows(&frames)] {
        let keys: Vec<(f64, f64)> = table.iter().map(|row| (number(row, "ball"), number(row, "t"))).collect();
        assert!(keys.len() > 100 && keys.is_sorted());
    }
    for row in rows(&frames) {
        let k = (number(&row, "t") * 24.0).round();
        assert_eq!(number(&row, "t"), k / 24.0);
        assert!(["flying", "sliding", "resting"].contains(&row["state"].as_str()));
    }
    // 20 s at 24 a second, both ends, for each of 3 balls.
    assert_eq!(rows(&frames).len(), 3 * (20 * 24 + 1));
    for row in rows(&events) {
        assert!(["impact", "slide", "rest", "leave", "wake"].contains(&row["kind"].as_str()));
    }
}

#[test]
fn numbers_read_back_to_the_same_bits() {
    let folder = Folder::with(&[]);
    let args = ["run", &scene("room.toml"), "--events", "e.csv", "--frames", "f.jsonl", "--quiet"];
    succeeds(&folder, &args);
    let mut read = 0;
    for row in rows(&folder.read("e.csv")) {
        for column in ["t", "x", "y", "z", "nx", "ny", "nz", "vx_in", "vy_in", "vz_in", "vx", "vy", "vz"] {
            // The shortest text that reads back to x is the text of x: so the file lost nothing.
            assert_eq!(row[column], format!("{:?}", number(&row, column)));
            read += 1;
        }
    }
    for line in folder.read("f.jsonl").lines() {
        let frame: serde_json::Value = serde_json::from_str(line).expect("a line is JSON");
        let x = frame["x"].as_f64().expect("x is a number");
        assert!(line.contains(&format!("\"x\":{x:?},")), "{line}");
        read += 1;
    }
    assert!(read > 1000);
}

#[test]
fn csv_and_json_lines_say_the_same() {
    let name = "floor, \"the\" one";
    let text = BOUNCE.replace("\"floor\"", "'floor, \"the\" one'");
    let folder = Folder::with(&[("scene.toml", text.as_bytes())]);
    succeeds(&folder, &["run", "scene.toml", "--events", "e.csv"]);
    succeeds(&folder, &["run", "scene.toml", "--events", "e.jsonl"]);
    let (table, lines) = (rows(&folder.read("e.csv")), folder.read("e.jsonl"));
    assert!(table.len() > 2);
    assert_eq!(table.len(), lines.lines().count());
    for (row, line) in table.iter().zip(lines.lines()) {
        let event: serde_json::Value = serde_json::from_str(line).expect("a line is JSON");
        assert_eq!(event.as_object().map(|o| o.len()), Some(17));
        assert_eq!((event["surface"].as_str(), row["surface"].as_str()), (Some(name), name));
        assert!(event["face"].is_null() && row["face"].is_empty());
        for column in ["t", "ball", "x", "vz_in", "nz"] {
            assert_eq!(event[column].as_f64(), Some(number(row, column)));
        }
    }
}

#[test]
fn the_same_bytes_for_any_number_of_threads_and_any_run() {
    let folder = Folder::with(&[]);
    let run = |threads: &str, tables: [&str; 2]| {
        let cow = scene("cow.toml");
        let [events, frames] = tables;
        succeeds(&folder, &["run", &cow, "--events", events, "--frames", frames, "--threads", threads, "--quiet"]);
        (folder.read(events), folder.read(frames))
    };
    let one = run("1", ["e1.csv", "f1.csv"]);
    assert!(one.0.lines().count() > 1000);
    assert!(one == run("2", ["e2.csv", "f2.csv"]));
    assert!(one == run("7", ["e7.csv", "f7.csv"]));
}

#[test]
fn json_scenes_and_lists_of_balls_give_the_same_as_toml() {
    let json = r#"{"version": 1, "duration": 2, "gravity": [0, 0, -9.81],
        "materials": {"clay": {"restitution": 0.75, "friction": {"coulomb": 0.6}}},
        "surfaces": [{"name": "floor", "material": "clay", "shape": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}],
        "balls": [{"position": [0, 0, 1], "velocity": [1, 0, 0], "radius": 0.033}]}"#;
    let list = "\u{feff}radius, x,y,z, vx\n0.033, 0,0,1, 1\n";
    let files = [("scene.toml", BOUNCE.as_bytes()), ("scene.json", json.as_bytes()), ("balls.csv", list.as_bytes())];
    let folder = Folder::with(&files);
    let expected = succeeds(&folder, &["run", "scene.toml", "--events", "-"]);
    assert!(expected.lines().count() > 3);
    assert_eq!(succeeds(&folder, &["run", "scene.json", "--events", "-"]), expected);
    assert_eq!(succeeds(&folder, &["run", "scene.toml", "--balls", "balls.csv", "--events", "-"]), expected);
    let mut child = folder.carom(&["run", "scene.json", "--balls", "-", "--events", "-"]);
    let mut child =
        child.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    child.stdin.take().expect("a pipe").write_all(list.as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(String::from_utf8_lossy(&output.stdout), expected, "{}", shown(&output));
}

#[test]
fn a_grid_repeats_a_ball_x_fastest() {
    let text = BOUNCE.replace("radius = 0.033", "grid = { count = [2, 1, 2], step = [10, 20, 30] }");
    let folder = Folder::with(&[("scene.toml", text.as_bytes())]);
    let frames = succeeds(&folder, &["run", "scene.toml", "--frames", "-", "--fps", "0.1"]);
    let places: Vec<[f64; 3]> = rows(&frames).iter().map(|row| ["x", "y", "z"].map(|c| number(row, c))).collect();
    assert_eq!(places, [[0.0, 0.0, 1.0], [10.0, 0.0, 1.0], [0.0, 0.0, 31.0], [10.0, 0.0, 31.0]]);
}

#[test]
fn the_summary_is_the_same_every_time_but_for_the_clock() {
    let folder = Folder::with(&[]);
    let summary = succeeds(&folder, &["run", &scene("ball-drops.toml"), "--summary", "-", "--quiet"]);
    insta::with_settings!({filters => vec![(r#""wall_seconds": [0-9.e-]+"#, r#""wall_seconds": [..]"#)]}, {
        insta::assert_snapshot!("summary", summary);
    });
    let output = folder.run(&["run", &scene("ball-drops.toml")]);
    insta::with_settings!({filters => vec![(r"[0-9.]+ s on the clock", "[..] s on the clock")]}, {
        insta::assert_snapshot!("summary_text", shown(&output));
    });
    assert_eq!(shown(&folder.run(&["run", &scene("ball-drops.toml"), "--quiet"])), "exit code: 0\n");
}

#[test]
fn r18_balls_rebound_as_the_rules_of_their_sports_demand() {
    // Lowest and highest rebound of the bottom of the ball, in m; of a basketball its top is meant, less its diameter of 0.2434 m.
    let rules = [
        (1.35, 1.47),
        (0.24, 0.26),
        (1.2 - 0.2434, 1.4 - 0.2434),
        (1.35, 1.55),
        (1.7272, 1.8288),
        (1.0922, 1.2954),
        (0.762, 0.8636),
    ];
    let folder = Folder::with(&[]);
    let events = rows(&succeeds(&folder, &["run", &scene("ball-drops.toml"), "--events", "-"]));
    for (ball, (lowest, highest)) in rules.into_iter().enumerate() {
        let first = events.iter().find(|row| number(row, "ball") == ball as f64).expect("it bounces");
        let rebound = number(first, "vz").powi(2) / (2.0 * 9.81);
        assert!((lowest..=highest).contains(&rebound), "{}: {rebound} m", first["surface"]);
    }
}

#[test]
fn r28_no_ball_leaves_a_closed_mesh() {
    let folder = Folder::with(&[]);
    let summary = succeeds(&folder, &["run", &scene("cow.toml"), "--summary", "-", "--quiet"]);
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("the summary is JSON");
    assert_eq!((summary["balls"].as_u64(), summary["off_the_map"].as_u64()), (Some(50), Some(0)));
    assert!(summary["impacts"].as_u64() > Some(1000));
    let lost = summary["energy"]["change_percent"].as_f64().expect("there is energy");
    assert!(lost.abs() < 1e-9, "elastic balls changed their energy by {lost} %");
}

#[test]
fn balls_that_miss_the_only_surface_are_off_the_map() {
    let surface = "polygon = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]";
    let text = BOUNCE
        .replace("plane = { point = [0, 0, 0], normal = [0, 0, 1] }", surface)
        .replace("radius = 0.033", "grid = { count = [2, 1, 1], step = [10, 0, 0] }");
    let folder = Folder::with(&[("scene.toml", text.as_bytes())]);
    let summary = succeeds(&folder, &["run", "scene.toml", "--summary", "-", "--quiet"]);
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("the summary is JSON");
    assert_eq!((summary["flying"].as_u64(), summary["off_the_map"].as_u64()), (Some(2), Some(1)), "{summary}");
}

#[test]
fn an_output_that_cannot_be_written_leaves_nothing_behind() {
    let folder = Folder::with(&[("scene.toml", BOUNCE.as_bytes()), ("events.csv", b"of old")]);
    let args = ["run", "scene.toml", "--events", "events.csv", "--summary", "no/such/folder/summary.json"];
    let output = folder.run(&args);
    assert_eq!(output.status.code(), Some(1), "{}", shown(&output));
    // It is the file that the user has named which cannot be written, and no other.
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.starts_with("error: cannot write no/such/folder/summary.json: "), "{message}");
    assert!(!message.contains(".part"), "{message}");
    assert_eq!(folder.names(), ["events.csv", "scene.toml"]);
    assert_eq!(folder.read("events.csv"), "of old");
    // A run that succeeds replaces it.
    succeeds(&folder, &["run", "scene.toml", "--events", "events.csv"]);
    assert_eq!(folder.names(), ["events.csv", "scene.toml"]);
    assert!(folder.read("events.csv").starts_with("t,ball"));
}

#[test]
fn a_closed_pipe_is_no_error() {
    let folder = Folder::with(&[]);
    for args in [
        &["run", &scene("cow.toml"), "--frames", "-", "--fps", "1000"][..],
        &["run", &scene("ball-drops.toml"), "--summary", "-"],
        &["schema"],
        &["materials"],
        &["completions", "bash"],
    ] {
        let mut child = folder.carom(args);
        let mut child = child.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
        // Nobody reads a byte.
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(0), "{args:?}: {}", shown(&output));
        assert!(!String::from_utf8_lossy(&output.stderr).contains("error"), "{}", shown(&output));
    }
}

#[test]
fn a_ball_that_a_guard_ends_is_named_and_the_exit_code_is_4() {
    // Two walls a tenth of a micrometre apart, and a ball that loses nothing: 10^7 impacts a second.
    let text = r#"
version = 1
duration = 5.0
[materials.elastic]
restitution = 1.0
[[surfaces]]
name = "left"
material = "elastic"
shape = { plane = { point = [0, 0, 0], normal = [1, 0, 0] } }
[[surfaces]]
name = "right"
material = "elastic"
shape = { plane = { point = [1e-7, 0, 0], normal = [1, 0, 0] } }
[[balls]]
position = [5e-8, 0, 0]
[[balls]]
position = [5e-8, 0, 0]
velocity = [1, 0, 0]
"#;
    let folder = Folder::with(&[("scene.toml", text.as_bytes())]);
    let output = folder.run(&["run", "scene.toml", "--summary", "summary.json"]);
    assert_eq!(output.status.code(), Some(4), "{}", shown(&output));
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        message.contains("ball 1 at") && message.contains("event budget") && !message.contains("ball 0"),
        "{message}"
    );
    let summary: serde_json::Value = serde_json::from_str(&folder.read("summary.json")).expect("the summary is JSON");
    assert_eq!(summary["ended_early"][0]["ending"].as_str(), Some("event_budget"), "{summary}");
}

#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_written_to_and_not_replaced() {
    let folder = Folder::with(&[("scene.toml", BOUNCE.as_bytes()), ("real.csv", b"of old")]);
    std::os::unix::fs::symlink("real.csv", folder.path().join("link.csv")).expect("a link can be made");
    std::os::unix::fs::symlink("/dev/null", folder.path().join("null.csv")).expect("a link can be made");
    succeeds(&folder, &["run", "scene.toml", "--events", "link.csv", "--frames", "null.csv"]);
    let kind = |name: &str| std::fs::symlink_metadata(folder.path().join(name)).expect("it is there").file_type();
    assert!(kind("link.csv").is_symlink() && kind("null.csv").is_symlink() && kind("real.csv").is_file());
    assert!(folder.read("real.csv").starts_with("t,ball"));
    let null = std::fs::metadata("/dev/null").expect("it is there");
    assert!(!null.is_file());
}

#[cfg(unix)]
#[test]
fn an_interrupt_takes_the_unfinished_files_away() {
    let text = BOUNCE.replace("radius = 0.033", "grid = { count = [1000, 1000, 1], step = [1, 1, 0] }");
    let folder = Folder::with(&[("scene.toml", text.as_bytes())]);
    let mut child = folder.carom(&["run", "scene.toml", "--frames", "frames.csv"]);
    let mut child = child.stderr(Stdio::null()).spawn().expect("it starts");
    while folder.names().len() < 2 {
        assert!(child.try_wait().expect("it can be asked").is_none(), "it ended before it wrote");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill can be run").success());
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    assert_eq!(folder.names(), ["scene.toml"]);
}
