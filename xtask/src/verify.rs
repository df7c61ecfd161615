//! Runs the steps of `cargo xtask verify` and reports.

use crate::Result;
use crate::log::Log;
use crate::project::Project;
use crate::steps::{STEPS, Step};
use std::io::Write;
use std::process::ExitCode;
use std::time::Instant;

struct Report {
    step: &'static Step,
    passed: bool,
    seconds: f64,
    log: Log,
}

/// Every step.
pub fn all() -> Vec<&'static Step> {
    STEPS.iter().collect()
}

/// The steps named in a list with commas, in their usual order.
pub fn named(names: &str) -> Result<Vec<&'static Step>> {
    let names: Vec<&str> = names.split(',').map(str::trim).collect();
    if let Some(unknown) = names.iter().find(|name| STEPS.iter().all(|step| step.name != **name)) {
        let known: Vec<&str> = STEPS.iter().map(|step| step.name).collect();
        return Err(format!("no step `{unknown}`; there are {}", known.join(", ")).into());
    }
    Ok(STEPS.iter().filter(|step| names.contains(&step.name)).collect())
}

/// Prints the steps.
pub fn list() -> Result<ExitCode> {
    for step in &STEPS {
        println!("{:<10} {}", step.name, step.what);
    }
    Ok(ExitCode::SUCCESS)
}

/// Runs the steps, each whatever became of those before it; the exit code is 1 if any failed.
pub fn run(steps: &[&'static Step]) -> Result<ExitCode> {
    let project = Project::find()?;
    let start = Instant::now();
    let mut reports = Vec::new();
    for (i, step) in steps.iter().enumerate() {
        print!("[{}/{}] {:<10} ", i + 1, steps.len(), step.name);
        std::io::stdout().flush()?;
        let report = one(&project, step)?;
        println!("{:>6}  {:>6.1} s", mark(report.passed), report.seconds);
        if !report.log.shown().is_empty() {
            println!("\n{}", report.log.shown());
        }
        reports.push(report);
    }
    summarise(&reports, start.elapsed().as_secs_f64())
}

fn one(project: &Project, step: &'static Step) -> Result<Report> {
    let path = project.target().join("verify").join(format!("{}.log", step.name));
    let mut log = Log::create(&path)?;
    let start = Instant::now();
    let passed = match (step.run)(project, &mut log) {
        Ok(passed) => passed,
        Err(error) => {
            log.line(&format!("error: {error}"))?;
            false
        }
    };
    Ok(Report { step, passed, seconds: start.elapsed().as_secs_f64(), log })
}

fn summarise(reports: &[Report], seconds: f64) -> Result<ExitCode> {
    println!("\n{:<10} {:>6} {:>8}", "step", "result", "seconds");
    for report in reports {
        println!("{:<10} {:>6} {:>8.1}", report.step.name, mark(report.passed), report.seconds);
    }
    println!("{:<10} {:>6} {:>8.1}", "all", "", seconds);
    // Last, so that nobody has to scroll for it.
    for report in reports.iter().filter(|report| !report.passed) {
        println!("\n==== {} FAILED ====\n{}", report.step.name, report.log.digest()?.trim_end());
    }
    let failed = reports.iter().filter(|report| !report.passed).count();
    println!("\n{} passed, {failed} failed", reports.len() - failed);
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn mark(passed: bool) -> &'static str {
    if passed { "ok" } else { "FAILED" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_steps_keep_their_order_and_unknown_ones_are_refused() {
        let steps = named("docs, format").expect("both exist");
        assert_eq!(steps.iter().map(|step| step.name).collect::<Vec<_>>(), ["format", "docs"]);
        let error = named("format,fromat").err().expect("a typo").to_string();
        assert!(error.contains("`fromat`") && error.contains("clippy"), "{error}");
    }
}
