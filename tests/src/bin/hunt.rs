//! The soak: `hunt FAMILY FROM COUNT` runs and checks seeds of a family (or `all`) and tallies what is wrong; `hunt FAMILY SEED show`
//! prints one run.

use carom_dynamics::events::Ending;
use carom_tests::hunt::{FAMILIES, Hunt, Run};
use std::collections::BTreeMap;
use std::process::ExitCode;
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

/// A ball that takes longer hangs, and is left to itself.
const PATIENCE: Duration = Duration::from_secs(20);
/// A ball that takes longer is named.
const LONG: Duration = Duration::from_secs(2);

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let parsed = match &args[..] {
        [family, from, count] => from.parse::<u64>().ok().map(|from| (family, from, count)),
        _ => None,
    };
    let hunt = Arc::new(Hunt::default());
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

/// Runs and checks one ball in a thread of its own.
fn run(hunt: &Arc<Hunt>, family: &str, seed: u64) -> Result<Option<Run>, &'static str> {
    let (send, receive) = mpsc::channel();
    let (hunt, family) = (Arc::clone(hunt), family.to_owned());
    std::thread::spawn(move || {
        let _ = send.send(hunt.run(&family, seed));
    });
    receive.recv_timeout(PATIENCE).map_err(|e| match e {
        mpsc::RecvTimeoutError::Timeout => "hangs",
        mpsc::RecvTimeoutError::Disconnected => "panics",
    })
}

/// Whether `count` seeds of a family are sound; prints what is not.
fn tally(hunt: &Arc<Hunt>, family: &str, from: u64, count: u64) -> bool {
    let (mut ran, mut events) = (0, 0);
    let mut bad: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    let mut worst = BTreeMap::new();
    for seed in from..from + count {
        let began = Instant::now();
        let run = match run(hunt, family, seed) {
            Ok(Some(run)) => run,
            Ok(None) => continue,
            Err(what) => {
                bad.entry(what.to_owned()).or_default().push(seed);
                continue;
            }
        };
        ran += 1;
        events += run.trajectory.events.len();
        for flaw in &run.flaws {
            let name = flaw.split(',').next().unwrap_or(flaw);
            bad.entry(name.to_owned()).or_default().push(seed);
        }
        if run.outcome.ending != Ending::Completed {
            bad.entry(format!("{:?}", run.outcome.ending)).or_default().push(seed);
        }
        if began.elapsed() > LONG {
            println!("{family} {seed} took {:?}, {} stretches", began.elapsed(), run.trajectory.segments.len());
        }
        for (flaw, ratio) in run.worst {
            let worst: &mut f64 = worst.entry(flaw).or_default();
            *worst = worst.max(ratio);
        }
    }
    println!("{family}: {ran} balls, {events} events");
    for (what, seeds) in &bad {
        println!("   {what}: {} {seeds:?}", seeds.len());
    }
    let worst: Vec<_> = worst.iter().map(|(flaw, ratio)| format!("{flaw:?} {ratio:.1e}")).collect();
    println!("   worst, as a part of what is allowed: {}", worst.join(", "));
    bad.is_empty()
}

fn show(hunt: &Arc<Hunt>, family: &str, seed: u64) -> ExitCode {
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
