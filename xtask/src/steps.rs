//! The steps of `cargo xtask verify`, in their order.

use crate::log::Log;
use crate::project::Project;
use crate::{Result, accuracy, commands, readme};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// One check of the whole project.
pub struct Step {
    /// What `--only` calls it.
    pub name: &'static str,
    /// What it checks.
    pub what: &'static str,
    /// Does it; true if all is well. An error fails the step as well.
    pub run: fn(&Project, &mut Log) -> Result<bool>,
}

/// Cheap ones first. The debug profile is built once, for the tests; the release profile once, for the scenes and the
/// README.
pub const STEPS: [Step; 13] = [
    Step { name: "format", what: "the code is formatted", run: format },
    Step { name: "clippy", what: "no warning of rustc or clippy, in any target", run: clippy },
    Step { name: "native", what: "the libraries build for all that this processor has, too", run: native },
    Step { name: "tests", what: "the tests of every crate; no snapshot is written", run: tests },
    Step { name: "doctests", what: "the examples in the documentation", run: doctests },
    Step { name: "examples", what: "the examples of the libraries run to their end", run: examples },
    Step { name: "docs", what: "the documentation builds without a warning", run: docs },
    Step { name: "snapshots", what: "no snapshot waits for review", run: snapshots },
    Step { name: "catalogue", what: "the hard cases: what breaks elsewhere, our figure, the bound", run: catalogue },
    Step {
        name: "checker",
        what: "every ball of the mesh scenes, by brute force and without the solver",
        run: checker,
    },
    Step { name: "scenes", what: "the scenes of the program are valid and run to their end", run: scenes },
    Step {
        name: "accuracy",
        what: "what accuracy costs is measured as it is told; time is not compared",
        run: accuracy,
    },
    Step { name: "readme", what: "the README's commands exist and its generated blocks are fresh", run: readme },
];

fn format(project: &Project, log: &mut Log) -> Result<bool> {
    // rustfmt asks the terminal, not cargo, about colours.
    log.run(&mut project.cargo(["fmt", "--all", "--check", "--", "--color", "never"]))
}

fn clippy(project: &Project, log: &mut Log) -> Result<bool> {
    log.run(&mut project.cargo(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))
}

fn native(project: &Project, log: &mut Log) -> Result<bool> {
    // What is dispatched at run time may be known when it is compiled. Beside the other builds, of which nothing is built again.
    let check = ["check", "--package", "carom-dynamics", "--target-dir", "target/native"];
    log.run(project.cargo(check).env("RUSTFLAGS", "-D warnings -C target-cpu=native"))
}

fn tests(project: &Project, log: &mut Log) -> Result<bool> {
    // Without the benchmarks, which clippy builds and which say nothing when not optimised.
    let kinds = ["test", "--workspace", "--no-fail-fast", "--lib", "--bins", "--tests", "--examples"];
    // A snapshot that differs must fail, whatever the caller's settings of insta are.
    log.run(project.cargo(kinds).env("CI", "true").env("INSTA_UPDATE", "no").env_remove("INSTA_FORCE_PASS"))
}

fn doctests(project: &Project, log: &mut Log) -> Result<bool> {
    log.run(&mut project.cargo(["test", "--workspace", "--no-fail-fast", "--doc"]))
}

fn examples(project: &Project, log: &mut Log) -> Result<bool> {
    let mut passed = true;
    for (package, folder) in
        [("carom-geometry", "crates/geometry/examples"), ("carom-dynamics", "crates/dynamics/examples")]
    {
        let mut names = Vec::new();
        for entry in fs::read_dir(project.root().join(folder))? {
            names.extend(entry?.path().file_stem().map(|name| name.to_string_lossy().into_owned()));
        }
        names.sort();
        for name in &names {
            passed &= log.run(&mut project.cargo(["run", "--quiet", "--package", package, "--example", name]))?;
        }
    }
    Ok(passed)
}

fn docs(project: &Project, log: &mut Log) -> Result<bool> {
    log.run(project.cargo(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"))
}

fn snapshots(project: &Project, log: &mut Log) -> Result<bool> {
    let mut waiting = Vec::new();
    find_waiting(project.root(), &mut waiting)?;
    waiting.sort();
    for path in &waiting {
        let path = path.strip_prefix(project.root()).unwrap_or(path);
        log.line(&format!("{}: not reviewed; accept or reject it with `cargo insta review`", path.display()))?;
    }
    Ok(waiting.is_empty())
}

fn find_waiting(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let (path, name) = (entry.path(), entry.file_name());
        let name = name.to_string_lossy();
        if entry.file_type()?.is_dir() {
            // Cargo marks what it builds into.
            if !name.starts_with('.') && !path.join("CACHEDIR.TAG").exists() {
                find_waiting(&path, found)?;
            }
        } else if name.ends_with(".snap.new") || name.ends_with(".pending-snap") {
            found.push(path);
        }
    }
    Ok(())
}

fn catalogue(project: &Project, log: &mut Log) -> Result<bool> {
    log.run_shown(&mut project.cargo(["run", "--quiet", "--package", "carom-tests", "--bin", "catalogue"]))
}

fn checker(project: &Project, log: &mut Log) -> Result<bool> {
    let mut meshes = Vec::new();
    for scene in project.scenes()? {
        if project.read(&scene)?.contains("mesh =") {
            meshes.push(scene);
        }
    }
    let checker = ["run", "--quiet", "--package", "carom-tests", "--bin", "checker", "--"];
    log.run_shown(project.cargo(checker).args(meshes))
}

fn scenes(project: &Project, log: &mut Log) -> Result<bool> {
    let carom = project.carom()?;
    let mut passed = true;
    for scene in project.scenes()? {
        passed &= log.run(&mut carom.command(["check", &scene]))?;
        passed &= log.run(&mut carom.command(["run", &scene]))?;
    }
    Ok(passed)
}

fn accuracy(project: &Project, log: &mut Log) -> Result<bool> {
    let wrong = accuracy::stale(project, &project.carom()?)?;
    for sentence in &wrong {
        log.line(sentence)?;
    }
    Ok(wrong.is_empty())
}

fn readme(project: &Project, log: &mut Log) -> Result<bool> {
    let carom = project.carom()?;
    let mut wrong = commands::wrong(project, &carom, &project.read(readme::PATH)?)?;
    wrong.extend(readme::stale(project, &carom)?);
    for sentence in &wrong {
        log.line(sentence)?;
    }
    Ok(wrong.is_empty())
}
