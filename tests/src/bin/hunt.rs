//! The hunt: `hunt FAMILY FROM COUNT` runs and checks seeds of a family (or `all`) and tallies what is wrong; `hunt FAMILY SEED show`
//! prints one run.

use carom_dynamics::events::Ending;
use carom_tests::hunt::{FAMILIES, Hunt, Run};
use carom_tests::parallel;
use std::collections::BTreeMap;
use std::panic::catch_unwind;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let parsed = match &args[..] {
        [family, from, count] => from.parse::<u64>().ok().map(|from| (family, from, count)),
        _ => None,
    };
    let hunt = Hunt::default();
    match parsed {
        Some((family, seed, count)) if count == "show" => show(&hunt, family, seed),
        Some((family, from, count)) if let Ok(count) = count.parse() => {
            let families: Vec<&str> = FAMILIES.into_iter().filter(|f| family == "all" || f == family).collect();
            let sound: Vec<bool> = families.iter().map(|family| tally(&hunt, family, from, count)).collect();
            if sound.contains(&false) { ExitCode::FAILURE } else { ExitCode::SUCCESS }
        }
        _ => {
            eprintln!("hunt FAMILY|all FROM COUNT, or hunt FAMILY SEED show; families: {}", FAMILIES.join(" "));
            ExitCode::from(2)
        }
    }
}

/// Runs and checks one ball; none if it found no place, and a word if it came to no end.
fn run(hunt: &Hunt, family: &str, seed: u64) -> Result<Option<Run>, &'static str> {
    match catch_unwind(|| hunt.run(family, seed)) {
        Ok(Ok(run)) => Ok(run),
        Ok(Err(_)) => Err("hangs"),
        Err(_) => Err("panics"),
    }
}

/// Whether `count` seeds of a family are sound; prints what is not.
fn tally(hunt: &Hunt, family: &str, from: u64, count: usize) -> bool {
    let (mut ran, mut events, mut stretches) = (0, 0, 0);
    let mut bad: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    let mut worst = BTreeMap::new();
    let of = |i: usize| from + i as u64;
    // What is kept of a run is little beside its trajectory.
    let runs = parallel::map(count, |i| {
        run(hunt, family, of(i)).map(|run| {
            run.map(|run| {
                let names = run.flaws.iter().map(|flaw| flaw.split(',').next().unwrap_or(flaw).to_owned());
                let ending = (run.outcome.ending != Ending::Completed).then(|| format!("{:?}", run.outcome.ending));
                let (events, stretches) = (run.trajectory.events.len(), run.trajectory.segments.len());
                (names.chain(ending).collect::<Vec<_>>(), events, stretches, run.worst)
            })
        })
    });
    for (i, run) in runs.into_iter().enumerate() {
        match run {
            Ok(None) => {}
            Err(what) => bad.entry(what.to_owned()).or_default().push(of(i)),
            Ok(Some((names, some, moved, by_flaw))) => {
                ran += 1;
                events += some;
                stretches = stretches.max(moved);
                names.into_iter().for_each(|name| bad.entry(name).or_default().push(of(i)));
                for (flaw, ratio) in by_flaw {
                    let worst: &mut f64 = worst.entry(flaw).or_default();
                    *worst = worst.max(ratio);
                }
            }
        }
    }
    println!("{family}: {ran} balls, {events} events, {stretches} stretches at most");
    for (what, seeds) in &bad {
        println!("   {what}: {} {seeds:?}", seeds.len());
    }
    let worst: Vec<_> = worst.iter().map(|(flaw, ratio)| format!("{flaw:?} {ratio:.1e}")).collect();
    println!("   worst, as a part of what is allowed: {}", worst.join(", "));
    bad.is_empty()
}

fn show(hunt: &Hunt, family: &str, seed: u64) -> ExitCode {
    if let Some((scene, _)) = hunt.scene(family, seed) {
        println!("{:?} {:?} {:?} {:?}", scene.method, scene.drag, scene.gravity, scene.balls);
        println!("{:?}", scene.surfaces.iter().map(|s| s.material).collect::<Vec<_>>());
    }
    let run = match run(hunt, family, seed) {
        Ok(Some(run)) => run,
        Ok(None) => return ExitCode::SUCCESS,
        Err(what) => {
            println!("{what}");
            return ExitCode::FAILURE;
        }
    };
    println!("{:?}", run.outcome);
    for (i, e) in run.trajectory.events.iter().enumerate() {
        println!("event {i} {e:?}");
    }
    for (i, s) in run.trajectory.segments.iter().enumerate() {
        println!("stretch {i} {:?} {} to {} s {:?} to f = {}", s.motion, s.time, s.end, s.step, s.to);
    }
    for flaw in &run.flaws {
        println!("{flaw}");
    }
    if run.is_sound() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
