//! `carom compare`: the conformance pack, which carom passes, and files that are malformed or off.

use crate::common::Folder;
use std::path::Path;

const EXPECTED: &str =
    "# why\nball,kind,n,t,x,y,z,vx,vy,vz,dt,dx,dv\n0,impact,1,1.0,0,0,0,0,0,4,1e-9,1e-9,1e-9\n0,impacts,1,,,,,,,,,,\n";
const ACTUAL: &str = "t,ball,kind,x,y,z,vx,vy,vz\n1.0,0,impact,0,0,0,0,0,4\n";

/// Exit code and all that is said.
fn compare(expected: &str, actual: &str, more: &[&str]) -> (i32, String) {
    let folder = Folder::with(&[("expected.csv", expected.as_bytes()), ("actual.csv", actual.as_bytes())]);
    let output = folder.run(&[&["compare", "expected.csv", "actual.csv"], more].concat());
    let text = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    (output.status.code().expect("it ends by itself"), text)
}

#[test]
fn carom_passes_the_conformance_pack() {
    let pack = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../conformance");
    let scenes = std::fs::read_dir(pack.join("scenes")).expect("the pack has scenes");
    let scenes =
        scenes.map(|entry| entry.expect("an entry").path()).filter(|p| p.extension().is_some_and(|e| e == "toml"));
    let (mut count, folder) = (0, Folder::with(&[]));
    for scene in scenes {
        let name = scene.file_stem().expect("a name").to_string_lossy().into_owned();
        let ran = folder.run(&["run", &scene.to_string_lossy(), "--events", "events.csv", "--quiet"]);
        assert!(ran.status.success(), "{name}: {}", String::from_utf8_lossy(&ran.stderr));
        let expected = pack.join(format!("expected/{name}.csv"));
        let output = folder.run(&["compare", &expected.to_string_lossy(), "events.csv"]);
        let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{name}: {said}");
        count += 1;
    }
    assert!(count >= 20, "{count} cases");
}

#[test]
fn what_is_within_its_tolerance_is_met() {
    let (code, said) = compare(EXPECTED, ACTUAL, &[]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("2 targets"), "{said}");
    let off = ACTUAL.replace("1.0,0,impact", "1.000000002,0,impact");
    assert_eq!(compare(EXPECTED, &off, &["--loosen", "3"]).0, 0);
}

#[test]
fn what_is_off_or_missing_is_5() {
    for (actual, what) in [
        (ACTUAL.replace("1.0,0,impact", "1.000000002,0,impact"), "time off by 1.9999999"),
        (ACTUAL.replace(",4\n", ",4.1\n"), "velocity off by 9.9"),
        (ACTUAL.replace("impact", "slide"), "is missing: there are 0"),
        (format!("{ACTUAL}2.0,0,impact,0,0,0,0,0,2\n"), "ball 0 has 2 impacts, not 1"),
        ("t,ball,kind\n1.0,0,impact\n".to_owned(), "place off by NaN"),
    ] {
        let (code, said) = compare(EXPECTED, &actual, &[]);
        assert_eq!(code, 5, "{said}");
        assert!(said.contains(what) && said.contains("1 of 2 targets") | said.contains("2 of 2 targets"), "{said}");
    }
}

#[test]
fn an_impact_at_several_surfaces_at_once_is_one() {
    let twice = ACTUAL.to_owned() + "1.0,0,impact,0,0,0,0,0,4\n";
    assert_eq!(compare(EXPECTED, &twice, &[]).0, 0);
}

#[test]
fn what_is_malformed_is_3_with_its_line() {
    for (expected, actual, what) in [
        (EXPECTED.replace("impact,1,1.0", "impact,1,one"), ACTUAL.to_owned(), "expected.csv:3: t = `one`"),
        (EXPECTED.replace("impact,1,1.0", "crash,1,1.0"), ACTUAL.to_owned(), "expected.csv:3: `crash` is no kind"),
        (EXPECTED.replace(",dv", ",du"), ACTUAL.to_owned(), "there is no column `dv`"),
        (EXPECTED.replace("1e-9\n", "-1\n"), ACTUAL.to_owned(), "expected.csv:3: a tolerance of -1"),
        (EXPECTED.to_owned(), ACTUAL.replace(",0,impact", ",x,impact"), "actual.csv:2: ball = `x`"),
        (EXPECTED.to_owned(), ACTUAL.replace("1.0,0,", "nan,0,"), "actual.csv:2: t = `nan`"),
        (EXPECTED.to_owned(), ACTUAL.replace(",4\n", "\n"), "actual.csv:2"),
        (EXPECTED.to_owned(), "ball,kind\n".to_owned(), "there is no column `t`"),
        (EXPECTED.to_owned(), String::new(), "there is no column `t`"),
        ("ball,kind,n,t,x,y,z,vx,vy,vz,dt,dx,dv\n".to_owned(), ACTUAL.to_owned(), "no targets"),
    ] {
        let (code, said) = compare(&expected, &actual, &[]);
        assert!(code == 3 && said.contains(what), "{code}, {what}: {said}");
    }
    assert_eq!(Folder::with(&[]).run(&["compare", "a.csv", "b.csv"]).status.code(), Some(1));
    assert_eq!(compare(EXPECTED, ACTUAL, &["--loosen", "0"]).0, 2);
}
