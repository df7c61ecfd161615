//! `carom explain`: what it says of every scene that comes with the program.

use crate::common::{Folder, shown};

/// The scenes that come with the program, by their paths.
fn scenes() -> Vec<String> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    let entries = std::fs::read_dir(folder).expect("the scenes are there");
    let paths = entries.map(|entry| entry.expect("an entry").path().to_string_lossy().into_owned());
    let mut scenes: Vec<String> = paths.filter(|path| path.ends_with(".toml")).collect();
    scenes.sort();
    scenes
}

/// The name of a scene without folder and ending.
fn name(path: &str) -> &str {
    path.rsplit('/').next().and_then(|file| file.strip_suffix(".toml")).expect("a scene")
}

#[test]
fn every_scene_is_explained() {
    for scene in scenes() {
        insta::assert_snapshot!(
            format!("explain_{}", name(&scene)),
            shown(&Folder::with(&[]).run(&["explain", &scene]))
        );
    }
}

#[test]
fn every_prediction_is_within_15_percent_of_what_is_measured_or_says_why_not() {
    let (mut within, mut apart) = (0, 0);
    for scene in scenes() {
        let output = Folder::with(&[]).run(&["explain", &scene, "--json"]);
        let told: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        for effect in told["effects"].as_array().expect("effects") {
            for size in effect["finding"]["sizes"].as_array().into_iter().flatten() {
                let [measured, predicted] = ["measured", "predicted"].map(|key| size[key].as_f64().expect("a number"));
                let close = (predicted - measured).abs() <= 0.15 * measured.abs();
                let why = size["apart"].as_str().unwrap_or_default();
                assert!(close == why.is_empty(), "{scene}: {}: {size}", effect["effect"]);
                if close { within += 1 } else { apart += 1 }
            }
        }
    }
    assert!(within > 20 && apart < within / 2, "{within} within 15 %, {apart} apart");
}

#[test]
fn a_tennis_ball_on_concrete_is_told_to_need_its_drag() {
    let scene = "version = 1\nduration = 3\ngravity = [0, 0, -9.81]\n[materials.concrete]\nrestitution = \"ball\"\n\
                 [[surfaces]]\nname = \"floor\"\nmaterial = \"concrete\"\nshape = { plane = { coefficients = [0, 0, 1, 0] } }\n\
                 [[balls]]\nball = \"tennis\"\nposition = [0, 0, 2.5735]\n";
    let folder = Folder::with(&[("drop.toml", scene.as_bytes())]);
    insta::assert_snapshot!(shown(&folder.run(&["explain", "drop.toml"])));
    assert_eq!(folder.run(&["explain", "drop.toml", "--tolerance", "0"]).status.code(), Some(2));
}

#[test]
fn a_run_tells_how_its_effects_were_chosen_and_its_tables_tell_the_spin() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/topspin.toml");
    let folder = Folder::with(&[]);
    let output = folder.run(&["run", scene, "--events", "events.csv", "--frames", "frames.csv", "--fps", "2"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    // All but the time on the clock.
    let told: Vec<&str> = told.lines().map(|line| line.split(" simulated").next().unwrap_or(line)).collect();
    let events = folder.read("events.csv");
    let frames = folder.read("frames.csv");
    assert!(events.lines().next().is_some_and(|header| header.ends_with(",vx,vy,vz,wx,wy,wz")), "{events}");
    assert!(frames.lines().next().is_some_and(|header| header.ends_with(",state,wx,wy,wz")), "{frames}");
    let kinds: Vec<String> =
        events.lines().skip(1).map(|line| line.split(',').skip(1).take(2).collect::<Vec<_>>().join(" ")).collect();
    insta::assert_snapshot!(format!("{}\n\n{}", told.join("\n"), kinds.join("\n")));
}
