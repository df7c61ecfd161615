//! What engines make of the conformance pack: judged by `carom compare`, kept in a file of which the README shows a copy.

use crate::Result;
use crate::project::{Carom, Project, output};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

/// The pack, and what engines made of it last.
const PACK: &str = "conformance";
const KEPT: &str = "tests/data/engines.md";

/// A tolerance that everything meets which is there at all.
const ANY: &str = "1e300";

/// What is right to this share of a metre, a second, a metre a second is right to the eye.
const EYE: f64 = 1e-3;

/// What an engine made of a case.
enum Verdict {
    /// The engine cannot be told the case.
    Untold(String),
    /// The targets, how many of them are met, how many are there at all, and how far the worst are off in s, m and m/s.
    Told { targets: u32, met: u32, found: u32, off: [Option<f64>; 3] },
}

/// Lets Carom and rapier3d play the pack, and writes the table.
pub fn engines() -> Result<ExitCode> {
    let project = Project::find()?;
    let carom = project.carom()?;
    let out = project.target().join("conformance");
    let folders = ["carom", "rapier"].map(|name| out.join(name));
    fs::create_dir_all(&folders[0])?;
    let rapier = folders[1].to_string_lossy();
    let program = ["run", "--release", "--manifest-path", "peers/Cargo.toml", "--", "conformance", PACK, &rapier];
    // Its own folder, whatever is set for ours: nothing is built twice by turns.
    output(project.cargo(program).env_remove("CARGO_TARGET_DIR"))?;
    let mut rows = Vec::new();
    for case in cases(&project)? {
        let events = folders[0].join(format!("{case}.csv"));
        let scene = format!("{PACK}/scenes/{case}.toml");
        output(&mut carom.command(["run", "--quiet", &scene, "--events", &events.to_string_lossy()]))?;
        let verdicts = [judge(&carom, &case, &folders[0])?, judge(&carom, &case, &folders[1])?];
        rows.push((case, verdicts));
    }
    let table = table(&rows)?;
    print!("{table}");
    fs::write(project.root().join(KEPT), table)?;
    Ok(ExitCode::SUCCESS)
}

fn figure(x: f64) -> String {
    if x == 0.0 { "0".to_owned() } else { format!("{x:.0e}") }
}

/// The table that was kept, which has a row for every case of the pack.
pub fn block(project: &Project) -> Result<String> {
    let table = project.read(KEPT)?;
    match cases(project)?.into_iter().find(|case| !table.contains(&format!("[{case}]"))) {
        Some(missing) => Err(format!("{KEPT} does not have {missing}; `cargo xtask peers` writes it anew").into()),
        None => Ok(table),
    }
}

/// The names of the cases, sorted.
fn cases(project: &Project) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(project.root().join(PACK).join("expected"))? {
        names.push(entry?.path().file_stem().unwrap_or_default().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

fn judge(carom: &Carom, case: &str, folder: &Path) -> Result<Verdict> {
    if let Ok(why) = fs::read_to_string(folder.join(format!("{case}.txt"))) {
        return Ok(Verdict::Untold(why));
    }
    let (expected, actual) = (format!("{PACK}/expected/{case}.csv"), folder.join(format!("{case}.csv")));
    let actual = actual.to_string_lossy();
    let told = |arguments: [&str; 5]| -> Result<(String, u32)> {
        let done = carom.command(arguments).output()?;
        let message = String::from_utf8_lossy(&done.stderr).into_owned();
        match done.status.code() {
            Some(0) => Ok((String::from_utf8(done.stdout)?, 0)),
            // `error: 3 of 8 targets are not met`
            Some(5) => {
                let count = message.split_whitespace().nth(1).and_then(|word| word.parse().ok());
                Ok((String::from_utf8(done.stdout)?, count.ok_or("`carom compare` no longer counts what is not met")?))
            }
            _ => Err(format!("{case}: {message}").into()),
        }
    };
    let (table, unmet) = told(["compare", "--loosen", "1", &expected, &actual])?;
    let (_, missing) = told(["compare", "--loosen", ANY, &expected, &actual])?;
    let targets = table.split_whitespace().next().and_then(|word| word.parse().ok()).unwrap_or(0);
    // `time, s  2  1.23e-16 ...`: what is compared, and how far the worst is off.
    let off = ["time, s", "place, m", "velocity, m/s"].map(|name| {
        let line = table.lines().find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().nth(1)?.parse().ok()
    });
    Ok(Verdict::Told { targets, met: targets - unmet, found: targets - missing, off })
}

fn table(rows: &[(String, [Verdict; 2])]) -> Result<String> {
    let mut lines = String::new();
    let (mut targets, mut sums, mut eye) = (0, [0; 2], 0);
    for (case, verdicts) in rows {
        write!(lines, "| [{case}]({PACK}/scenes/{case}.toml) ")?;
        for (verdict, sum) in verdicts.iter().zip(&mut sums) {
            match verdict {
                Verdict::Untold(why) => write!(lines, "| {why} | | | | ")?,
                Verdict::Told { targets: all, met, found, off } => {
                    *sum += met;
                    let there = if found < all { format!(", {} not there", all - found) } else { String::new() };
                    write!(lines, "| {met} of {all}{there} ")?;
                    off.iter().try_for_each(|x| write!(lines, "| {} ", x.map_or(String::new(), figure)))?;
                }
            }
        }
        lines += "|\n";
        if let Verdict::Told { targets: all, .. } = &verdicts[0] {
            targets += all;
        }
        if let Verdict::Told { targets: all, found, off, .. } = &verdicts[1] {
            eye += u32::from(found == all && off.iter().flatten().all(|x| *x <= EYE));
        }
    }
    let count = rows.len();
    Ok(format!(
        "Of {targets} targets in {count} cases, Carom meets {} and rapier3d {}, to the tolerances of the pack, which are those of double precision. To a \
         millimetre, a millisecond and a millimetre a second, rapier3d meets all targets of {eye} cases.\n\n\
         <details><summary>Case by case</summary>\n\n\
         | case | Carom meets | s | m | m/s | rapier3d meets | s | m | m/s |\n|---|---|--:|--:|--:|---|--:|--:|--:|\n{lines}\n</details>\n",
        sums[0], sums[1]
    ))
}
