//! `cargo xtask instructions`: counts the instructions of a dozen operations with callgrind and compares them with those kept.

use crate::Result;
use crate::project::Project;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::process::{Command, ExitCode};

/// The counts that are kept, with the compiler they are of.
const KEPT: &str = "benches/instructions.csv";

/// A count that is larger by more than this share is a finding; smaller ones come from other code being laid out.
const TOLERANCE: f64 = 0.03;

/// Counts, and compares or, with `update`, keeps.
pub fn run(update: bool) -> Result<ExitCode> {
    let project = Project::find()?;
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("SKIP: valgrind is not installed, so no instructions are counted.");
        return Ok(ExitCode::SUCCESS);
    }
    let compiler = compiler()?;
    let counts = count(&project)?;
    if update {
        let mut text = format!("operation,instructions,{compiler}\n");
        counts.iter().for_each(|(name, count)| text += &format!("{name},{count},\n"));
        std::fs::write(project.root().join(KEPT), text)?;
        println!("{KEPT}: {} counts kept.", counts.len());
        return Ok(ExitCode::SUCCESS);
    }
    let text = project.read(KEPT)?;
    let kept: BTreeMap<&str, f64> = text.lines().skip(1).filter_map(row).collect();
    if !text.lines().next().is_some_and(|header| header.ends_with(&compiler)) {
        println!("The counts in {KEPT} are of another compiler than {compiler}: compare with care.");
    }
    let mut more = 0;
    for (name, count) in &counts {
        let Some(before) = kept.get(name.as_str()) else {
            println!("{name:28} {count:>9}  new");
            continue;
        };
        let change = *count as f64 / before - 1.0;
        let verdict = if change > TOLERANCE { "  MORE" } else { "" };
        more += usize::from(change > TOLERANCE);
        println!("{name:28} {count:>9}  {:+.1} %{verdict}", 100.0 * change);
    }
    if more > 0 {
        println!(
            "{more} operations take more instructions than is kept; `cargo xtask instructions --update` accepts them."
        );
    }
    Ok(if more == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn row(line: &str) -> Option<(&str, f64)> {
    let mut cells = line.split(',');
    Some((cells.next()?, cells.next()?.parse().ok()?))
}

fn compiler() -> Result<String> {
    let output = Command::new("rustc").arg("--version").output()?;
    Ok(String::from_utf8(output.stdout)?.split(' ').take(2).collect::<Vec<_>>().join(" "))
}

/// Instructions by operation, once each.
fn count(project: &Project) -> Result<BTreeMap<String, u64>> {
    let built = project.cargo(["build", "--release", "--package", "carom-benches", "--bin", "operations"]).status()?;
    if !built.success() {
        return Err("the operations do not build".into());
    }
    let out = project.root().join("target/callgrind.operations");
    let program = project.root().join("target/release/operations");
    let output = Command::new("valgrind")
        .arg("--tool=callgrind")
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(program)
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let times: u64 = String::from_utf8(output.stdout)?.trim().parse()?;
    counted(&out, times)
}

/// The inclusive cost of what the function `counted` calls, from callgrind's file: names are given once, with a number.
fn counted(out: &Path, times: u64) -> Result<BTreeMap<String, u64>> {
    let text = std::fs::read_to_string(out)?;
    let mut names: HashMap<&str, &str> = HashMap::new();
    let (mut caller, mut callee, mut call) = ("", "", false);
    let mut counts = BTreeMap::new();
    for line in text.lines() {
        let is_callee = line.starts_with("cfn=");
        if let Some(function) = line.strip_prefix("fn=").or(line.strip_prefix("cfn=")) {
            let (number, name) = function.split_once(' ').map_or((function, None), |(n, name)| (n, Some(name)));
            name.map(|name| names.insert(number, name));
            let name = names.get(number).copied().unwrap_or(number);
            if is_callee { callee = name } else { caller = name }
        } else if line.starts_with("calls=") {
            call = true;
        } else if std::mem::take(&mut call)
            && caller.starts_with("operations::counted")
            && let Some(cost) = line.split(' ').nth(1)
        {
            let name = callee.rsplit("::").next().unwrap_or(callee);
            *counts.entry(name.to_owned()).or_insert(0) += cost.parse::<u64>()?;
        }
    }
    counts.values_mut().for_each(|cost| *cost /= times);
    Ok(counts)
}
