//! `carom accuracy`: what accuracy costs in time, as a table, as CSV and as a picture; and the cheapest method for a target.

mod picture;
mod table;

pub use table::setting;

use super::print;
use crate::cli::AccuracyArgs;
use crate::error::AppError;
use crate::output::target::{Target, is_stdout};
use crate::scene;
use crate::terminal::say;
use carom_dynamics::accuracy::{Effort, Measurement, Report, Variant, measure};
use carom_dynamics::scene::Scene;
use cpu_time::ThreadTime;
use std::path::Path;

/// Measures the scene and tells what came out.
pub fn accuracy(args: &AccuracyArgs) -> Result<(), AppError> {
    let outputs = [("--csv", &args.csv), ("--plot", &args.plot)];
    if let (Some(csv), Some(plot)) = (&args.csv, &args.plot)
        && csv == plot
    {
        let place = if is_stdout(csv) { "standard output".to_owned() } else { csv.display().to_string() };
        return Err(AppError::Usage(format!("--csv and --plot cannot both go to {place}")));
    }
    let loaded = scene::load(&args.scene, None)?;
    let effort = Effort {
        balls: args.balls.get(),
        octaves: args.octaves,
        decades: args.decades,
        repeats: args.repeats,
        ..Effort::default()
    };
    // Of this thread, so that other programs do not count.
    let start = ThreadTime::now();
    let mut clock = || start.elapsed().as_secs_f64();
    let report = measure(&loaded.scene, &effort, &mut clock).map_err(|error| loaded.refuse(&error))?;
    let name = args.scene.file_name().unwrap_or_default().to_string_lossy();
    if let Some(path) = &args.csv {
        write(path, &table::csv(&report))?;
    }
    if let Some(path) = &args.plot {
        write(path, &picture::chart(&report, &name, args.target_error).svg())?;
    }
    let answer = args.target_error.map(|target| answer(&loaded.scene, &effort, &report, target));
    let text = table::text(&report, &name, &loaded.scene);
    // Data that was asked for has standard output to itself.
    if outputs.iter().any(|(_, path)| path.as_deref().is_some_and(is_stdout)) {
        say(text.trim_end());
    } else {
        print(&text)?;
    }
    match answer {
        None => Ok(()),
        Some(Ok(answer)) => {
            say(&answer);
            Ok(())
        }
        Some(Err(error)) => Err(error),
    }
}

/// The cheapest method for the target, run once more to see that it holds.
fn answer(scene: &Scene, effort: &Effort, report: &Report, target: f64) -> Result<String, AppError> {
    let best = report.cheapest(target).ok_or_else(|| {
        let least = report.measurements().filter(|m| m.method().is_some()).map(|m| m.errors.position);
        let least = least.fold(f64::INFINITY, f64::min);
        let best = if least.is_finite() { format!("the best of them is off by {least:.1e} m") } else { String::new() };
        AppError::Target(format!("no method reaches an error of {target:e} m; {best}"))
    })?;
    let again = once_more(scene, effort, best).map_err(|e| AppError::Internal(e.to_string()))?;
    let error = again.errors.position;
    if error > target || again.counters != best.counters {
        return Err(AppError::Target(format!("{} was off by {error:.1e} m when it was run again", setting(best))));
    }
    let cost = match best.cost {
        Some(cost) => format!("{} for a second of a ball", table::time(cost.per_second)),
        None => format!("nominal {} for a second of a ball", table::time(best.work)),
    };
    Ok(format!(
        "cheapest for {target:e} m: {}, off by {error:.1e} m at most, {cost}; run again, it was the same",
        setting(best)
    ))
}

/// The one measurement anew.
fn once_more(
    scene: &Scene,
    effort: &Effort,
    best: &Measurement,
) -> Result<Measurement, carom_dynamics::error::SceneError> {
    let one: &'static [Variant] = Variant::ALL.iter().find(|v| **v == best.variant).map_or(&[], std::slice::from_ref);
    let effort = Effort { repeats: 0, variants: one, resolutions: false, ..*effort };
    let report = measure(scene, &effort, &mut || 0.0)?;
    let found = report.measurements().find(|m| m.value == best.value).cloned();
    Ok(found.unwrap_or_else(|| best.clone()))
}

fn write(path: &Path, text: &str) -> Result<(), AppError> {
    let mut target = Target::open(path)?;
    target.write(text.as_bytes())?;
    target.finish()
}
