//! The conformance pack on disk is what its one home makes.

use carom_tests::conformance;
use carom_tests::sources::root;
use std::collections::BTreeSet;
use std::fs;

#[test]
fn the_folder_is_fresh() {
    let folder = root().join("conformance");
    let files = conformance::files();
    for (path, text) in &files {
        let found = fs::read_to_string(folder.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
        assert!(found == *text, "{path} is stale; `cargo xtask conformance` writes it anew");
    }
    let known: BTreeSet<&str> = files.iter().map(|(path, _)| path.as_str()).collect();
    for part in ["scenes", "expected"] {
        for entry in fs::read_dir(folder.join(part)).expect("the pack is there") {
            let path = format!("{part}/{}", entry.expect("an entry").file_name().to_string_lossy());
            assert!(known.contains(path.as_str()), "{path} is of no case");
        }
    }
}

#[test]
fn there_are_cases_enough_and_each_has_targets() {
    let all = conformance::all();
    assert!(all.len() >= 20, "{} cases", all.len());
    assert!(all.iter().all(|pack| !pack.targets.is_empty()));
    let names: BTreeSet<_> = all.iter().map(|pack| pack.name).collect();
    assert_eq!(names.len(), all.len(), "each name once");
}
