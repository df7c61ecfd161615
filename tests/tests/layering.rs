//! Who may know whom: geometry nothing, dynamics geometry, the program both; and neither library the outside world.

use carom_tests::sources::{self, Source};
use std::collections::BTreeSet;
use std::process::Command;

/// Crates that read files, parse, print or talk to a terminal: the program's business, not the libraries'.
const OUTSIDE_WORLD: [&str; 22] = [
    "anyhow",
    "clap",
    "clap_builder",
    "csv",
    "csv-core",
    "env_logger",
    "indicatif",
    "log",
    "ply-rs",
    "ply-rs-bw",
    "rand",
    "regex",
    "schemars",
    "serde",
    "serde_core",
    "serde_json",
    "stl_io",
    "tempfile",
    "tobj",
    "toml",
    "toml_edit",
    "tracing",
];

/// How a library would read a file, print, look around or keep a global.
const REACHING_OUT: [&str; 13] = [
    "std::fs",
    "std::io",
    "std::env",
    "std::net",
    "std::process",
    "std::time",
    "fs::File",
    "print!(",
    "println!(",
    "eprint!(",
    "eprintln!(",
    "static mut",
    "thread_local!",
];

/// The packages that `package` needs to run, itself left out, however far down.
fn dependencies(package: &str) -> BTreeSet<String> {
    // Procedural macros run in the compiler; what they depend on is in no program.
    let arguments =
        ["tree", "--package", package, "--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"];
    let output = Command::new(env!("CARGO")).args(arguments).current_dir(sources::root()).output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("cargo tree prints text");
    let mut names: BTreeSet<String> =
        text.lines().filter_map(|line| line.split(' ').next().map(str::to_owned)).collect();
    assert!(names.remove(package), "cargo tree begins with the package itself:\n{text}");
    names
}

#[test]
fn geometry_knows_neither_dynamics_nor_the_program() {
    let needs = dependencies("carom-geometry");
    assert!(needs.contains("nalgebra"), "a list that is cut short proves nothing: {needs:?}");
    assert!(!needs.contains("carom-dynamics") && !needs.contains("carom"), "{needs:?}");
}

#[test]
fn dynamics_knows_geometry_and_not_the_program() {
    let needs = dependencies("carom-dynamics");
    assert!(needs.contains("carom-geometry") && !needs.contains("carom"), "{needs:?}");
}

#[test]
fn the_program_knows_both() {
    let needs = dependencies("carom");
    assert!(needs.contains("carom-geometry") && needs.contains("carom-dynamics"), "{needs:?}");
}

#[test]
fn the_libraries_depend_on_nothing_that_reads_or_prints() {
    for package in ["carom-geometry", "carom-dynamics"] {
        let needs = dependencies(package);
        let wrong: Vec<_> = OUTSIDE_WORLD.iter().filter(|name| needs.contains(**name)).collect();
        assert!(wrong.is_empty(), "{package} depends on {wrong:?}");
    }
}

#[test]
fn the_libraries_read_nothing_and_print_nothing() {
    let mut wrong = String::new();
    for folder in ["crates/geometry/src", "crates/dynamics/src"] {
        for source in sources::files(folder, &[".rs"]) {
            for (number, line) in source.code() {
                for word in REACHING_OUT.iter().filter(|word| uses(line, word)) {
                    wrong += &format!("{}:{number}: {word}\n", source.path);
                }
            }
        }
    }
    assert!(wrong.is_empty(), "a library gets what it needs as arguments and gives back what it found:\n{wrong}");
}

/// Whether the word is there as a whole: `eprint!(` is no use of `print!(`.
fn uses(line: &str, word: &str) -> bool {
    line.match_indices(word).any(|(i, _)| !line[..i].ends_with(|c: char| c.is_alphanumeric() || c == '_'))
}

#[test]
fn a_module_imports_only_from_those_above_it() {
    let mut wrong = String::new();
    for library in ["crates/geometry/src", "crates/dynamics/src"] {
        let files = sources::files(library, &[".rs"]);
        let root =
            files.iter().find(|source| source.path == format!("{library}/lib.rs")).expect("a library has a root");
        let order = modules(root);
        assert!(order.len() > 5, "{library}: found only {order:?}");
        let place = |name: &str| order.iter().position(|module| *module == name);
        for source in &files {
            let own = &source.path[library.len() + 1..];
            let Some(own) = own.split(['/', '.']).next().and_then(place) else { continue };
            for (number, line) in source.code() {
                if names_after_crate(line).filter_map(place).any(|other| other > own) {
                    wrong += &format!("{}:{number}: {}\n", source.path, line.trim());
                }
            }
        }
    }
    assert!(wrong.is_empty(), "lib.rs lists the modules in dependency order; these look further down:\n{wrong}");
}

/// The modules of a library in the order of its root.
fn modules(root: &Source) -> Vec<&str> {
    let lines = root.code().into_iter().filter_map(|(_, line)| line.trim().strip_suffix(';')?.split_once("mod "));
    lines.filter(|(visible, _)| visible.is_empty() || visible.starts_with("pub")).map(|(_, name)| name).collect()
}

/// What a line names by its path from the root of the crate.
fn names_after_crate(line: &str) -> impl Iterator<Item = &str> {
    let ends = |c: char| !(c.is_alphanumeric() || c == '_');
    line.split("crate::").skip(1).filter_map(move |rest| rest.split(ends).next())
}
