//! The commands beside `run`: help, usage errors, tables, the schema, and what `check` finds.

use crate::common::{Folder, shown};

#[test]
fn help_of_every_command() {
    let folder = Folder::with(&[]);
    insta::assert_snapshot!("help", shown(&folder.run(&["--help"])));
    let commands = [
        "init",
        "run",
        "accuracy",
        "view",
        "plot",
        "export",
        "explain",
        "check",
        "compare",
        "schema",
        "balls",
        "materials",
        "completions",
        "man",
    ];
    for command in commands {
        insta::assert_snapshot!(format!("help_{command}"), shown(&folder.run(&[command, "--help"])));
    }
}

#[test]
fn usage_errors_are_2() {
    let scene = "version = 1\nduration = 1\n[[balls]]\nposition = [0, 0, 0]\n";
    let folder = Folder::with(&[("scene.toml", scene.as_bytes())]);
    for args in [
        &["jump"][..],
        &["run"],
        &["run", "scene.toml", "--event", "x.csv"],
        &["run", "scene.toml", "--frames", "x.csv", "--fps", "0"],
        &["run", "scene.toml", "--frames", "x.csv", "--fps", "1/0"],
        &["run", "scene.toml", "--frames", "x.csv", "--fps", "fast"],
        &["run", "scene.toml", "--threads", "0"],
        &["run", "scene.toml", "--events", "x.xlsx"],
        &["run", "scene.toml", "--events", "-", "--frames", "-"],
        &["run", "scene.toml", "--events", "x.csv", "--frames", "x.csv"],
        &["check", "scene.xyz"],
        &["view", "scene.toml"],
        &["view", "scene.toml", "-o", "x.pdf"],
        &["plot", "scene.toml", "-o", "x.png"],
        &["export", "scene.toml", "-o", "x.obj"],
        &["export", "scene.toml", "-o", "x.glb", "--keys", "all"],
        &["export", "scene.toml", "-o", "x.glb", "--keys", "fps=0"],
        &["plot", "scene.toml", "-o", "x.svg", "--show", "colour"],
        &["init", "scene.toml"],
        &["accuracy", "scene.toml", "--target-error", "0"],
        &["accuracy", "scene.toml", "--csv", "-", "--plot", "-"],
        &["completions", "csh"],
    ] {
        let output = folder.run(args);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {}", shown(&output));
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{args:?}: {}", shown(&output));
        assert_eq!(folder.names(), ["scene.toml"], "{args:?}");
    }
}

#[test]
fn r18_r21_the_tables_of_materials() {
    let folder = Folder::with(&[]);
    insta::assert_snapshot!("materials", shown(&folder.run(&["materials"])));
    let json = folder.run(&["materials", "--json"]);
    let tables: serde_json::Value = serde_json::from_slice(&json.stdout).expect("the tables are JSON");
    for (table, least) in [("restitution", 10), ("friction", 3)] {
        let rows = tables[table].as_array().expect("a table is a list");
        assert!(rows.len() >= least, "{table}");
        assert!(rows.iter().all(|row| row["source"].as_str().is_some_and(|s| !s.is_empty())), "a row without a source");
    }
}

#[test]
fn the_schema_names_every_key_and_says_what_it_is() {
    let output = Folder::with(&[]).run(&["schema"]);
    let schema: serde_json::Value = serde_json::from_slice(&output.stdout).expect("the schema is JSON");
    let mut described = 0;
    let mut stack = vec![&schema];
    while let Some(value) = stack.pop() {
        if let Some(keys) = value.get("properties").and_then(|p| p.as_object()) {
            // A choice such as `plane` is described as a whole.
            let choice = keys.len() == 1 && value.get("description").is_some();
            for (key, of) in keys {
                assert!(choice || of.get("description").is_some(), "`{key}` has no description");
                described += 1;
            }
        }
        match value {
            serde_json::Value::Array(items) => stack.extend(items),
            serde_json::Value::Object(items) => stack.extend(items.values()),
            _ => {}
        }
    }
    assert!(described > 30, "only {described} keys");
    insta::assert_snapshot!("schema", String::from_utf8_lossy(&output.stdout));
}

#[test]
fn completions_of_every_shell_know_the_commands() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let output = Folder::with(&[]).run(&["completions", shell]);
        assert_eq!(output.status.code(), Some(0));
        let script = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(script.contains("materials") && script.contains("summary"), "{shell}");
    }
}

#[test]
fn a_sound_mesh_passes_and_an_odd_one_is_told_all_its_oddities() {
    let tetrahedron: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    // The second face is wound against the first, the third repeats it, the fourth has no area; vertex 6 is spare.
    let odd: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\nv 9 9 9\nf 1 2 3\nf 2 3 4\nf 4 2 3\nf 1 2 5\n";
    let folder = Folder::with(&[("sound.obj", tetrahedron), ("odd.obj", odd), ("none.stl", b"words")]);
    insta::assert_snapshot!("check_sound_mesh", shown(&folder.run(&["check", "sound.obj"])));
    insta::assert_snapshot!("check_odd_mesh", shown(&folder.run(&["check", "odd.obj"])));
    insta::assert_snapshot!("check_no_mesh", shown(&folder.run(&["check", "none.stl"])));
    insta::assert_snapshot!("check_missing_mesh", shown(&folder.run(&["check", "missing.obj"])));
}

#[test]
fn the_scenes_that_come_with_the_program_are_valid() {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    let mut checked = 0;
    for entry in std::fs::read_dir(scenes).expect("the scenes are there") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "toml") {
            let output = Folder::with(&[]).run(&["check", &path.to_string_lossy()]);
            assert_eq!(output.status.code(), Some(0), "{}: {}", path.display(), shown(&output));
            let text = std::fs::read_to_string(&path).expect("the scene can be read");
            assert!(text.starts_with("# "), "{} does not say what it is for", path.display());
            checked += 1;
        }
    }
    assert!(checked >= 6, "only {checked} scenes");
}
