//! What a newcomer does first: a scene by `init`, a run, a page, a chart, a model, a manual.

use crate::common::{Folder, shown};

#[test]
fn the_first_scene_runs_and_is_never_written_over() {
    let folder = Folder::with(&[]);
    insta::assert_snapshot!("init", shown(&folder.run(&["init"])));
    let scene = folder.read("scene.toml");
    for args in [
        &["check", "scene.toml"][..],
        &["run", "scene.toml", "--quiet"],
        &["view", "scene.toml", "-o", "scene.html", "--quiet"],
        &["plot", "scene.toml", "-o", "scene.svg"],
        &["export", "scene.toml", "-o", "scene.glb", "--quiet"],
    ] {
        let output = folder.run(args);
        assert_eq!(output.status.code(), Some(0), "{args:?}: {}", shown(&output));
    }
    assert_eq!(folder.names(), ["scene.glb", "scene.html", "scene.svg", "scene.toml"]);
    insta::assert_snapshot!("init_twice", shown(&folder.run(&["init"])));
    insta::assert_snapshot!("init_no_toml", shown(&folder.run(&["init", "scene.xml"])));
    assert_eq!(folder.read("scene.toml"), scene);
    assert_eq!(String::from_utf8_lossy(&folder.run(&["init", "-"]).stdout), scene);
    // What is behind `#` for later is as valid as the rest.
    let all: Vec<&str> =
        scene.lines().map(|line| line.strip_prefix("# ").filter(|l| is_key(l)).unwrap_or(line)).collect();
    std::fs::write(folder.path().join("all.toml"), all.join("\n")).expect("a file can be written");
    std::fs::write(folder.path().join("hill.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        .expect("a file can be written");
    let output = folder.run(&["run", "all.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", shown(&output));
    assert!(all.iter().filter(|line| line.starts_with("[[surfaces]]")).count() == 3);
}

/// Whether a line behind `#` is TOML and not a sentence.
fn is_key(line: &str) -> bool {
    line.starts_with('[') || line.split_once(" = ").is_some_and(|(key, _)| key.chars().all(char::is_alphanumeric))
}

#[test]
fn the_page_and_the_model_are_the_same_bytes_for_any_number_of_threads() {
    let folder = Folder::with(&[]);
    folder.run(&["init"]);
    for command in ["view", "export"] {
        let output = |threads| folder.run(&[command, "scene.toml", "-o", "-", "--quiet", "--threads", threads]).stdout;
        let one = output("1");
        assert!(one.len() > 1000 && one == output("3"), "{command}");
    }
}

#[test]
fn there_is_a_manual_page_for_every_command() {
    let folder = Folder::with(&[]);
    let page = folder.run(&["man"]);
    assert!(String::from_utf8_lossy(&page.stdout).starts_with(".ie"), "{}", shown(&page));
    assert_eq!(folder.run(&["man", "-o", "pages"]).status.code(), Some(0));
    let pages = std::fs::read_dir(folder.path().join("pages")).expect("a folder");
    let names: Vec<String> = pages.map(|p| p.expect("a page").file_name().to_string_lossy().into_owned()).collect();
    for command in ["carom", "carom-run", "carom-view", "carom-export", "carom-man"] {
        assert!(names.contains(&format!("{command}.1")), "{command}: {names:?}");
    }
}

#[test]
fn charts_are_made_of_scenes_and_of_tables_of_events() {
    let folder = Folder::with(&[]);
    folder.run(&["init"]);
    folder.run(&["run", "scene.toml", "--events", "events.csv", "--quiet"]);
    for what in ["height", "speed", "energy", "phase"] {
        for source in ["scene.toml", "events.csv"] {
            let output = folder.run(&["plot", source, "-o", "-", "--show", what]);
            let chart = String::from_utf8_lossy(&output.stdout).into_owned();
            assert!(chart.contains("</svg>") && chart.contains("<desc"), "{what} of {source}: {}", shown(&output));
        }
    }
    // The flights between the events of a table are the ones of the scene, so that both hit as often and rise as high.
    let described = |source: &str| {
        let output = folder.run(&["plot", source, "-o", "-", "--from", "1", "--to", "2"]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        text.split_once("<desc").and_then(|(_, rest)| rest.split_once("</desc>")).map(|(desc, _)| desc.to_owned())
    };
    insta::assert_snapshot!("plot_description", described("scene.toml").expect("a description"));
    let bad = Folder::with(&[("events.csv", b"t,ball\n1,0\n"), ("x.svg", b"")]);
    insta::assert_snapshot!("plot_no_table", shown(&bad.run(&["plot", "events.csv", "-o", "chart.svg"])));
    insta::assert_snapshot!("plot_unknown_form", shown(&bad.run(&["plot", "x.svg", "-o", "chart.svg"])));
    insta::assert_snapshot!(
        "plot_no_such_ball",
        shown(&folder.run(&["plot", "scene.toml", "-o", "c.svg", "--ball", "7"]))
    );
    assert_eq!(bad.names(), ["events.csv", "x.svg"]);
}
