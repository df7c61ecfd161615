//! The soak: many millions of bounces in scenes of every kind, each flight watched as it happens for escapes, gains of energy and stalls.

mod families;
mod watch;

pub use families::{FAMILIES, Family, Places};
pub use watch::Report;

use crate::parallel;
use crate::patience::simulate_within;
use carom_dynamics::events::Ending;
use watch::Watch;

/// Balls that are simulated before it is asked whether there have been enough bounces: the same number on every machine.
const BALLS_AT_ONCE: u64 = 64;
/// Stretches of motion that a ball takes at most; those without loss bounce some 300 000 times.
const STRETCHES: u64 = 2_000_000;

/// Runs balls of a family until they have bounced `bounces` times, or `most` balls have run.
pub fn soak(places: &Places, family: &Family, bounces: u64, most: u64) -> Report {
    let mut report = Report::default();
    let mut seed = 0;
    while report.impacts < bounces && report.balls < most {
        let count = BALLS_AT_ONCE.min(most - report.balls);
        for ball in parallel::map(count as usize, |i| one(places, family, seed + i as u64)) {
            report.add(ball);
        }
        seed += count;
    }
    report
}

/// Runs the ball that a seed makes of a family.
pub fn one(places: &Places, family: &Family, seed: u64) -> Report {
    let unit = (family.unit)(places, seed);
    let plan = unit.stage.plan();
    let ball = &plan.balls()[0];
    let mut watch = Watch::new(&unit, &plan);
    let name = format!("{} {seed}", family.name);
    let outcome = simulate_within(&plan, ball, &mut watch, STRETCHES);
    let mut report = watch.finish(outcome.as_ref().ok());
    match outcome {
        Ok(outcome) if outcome.ending == Ending::Completed => {}
        Ok(outcome) => {
            report.guards += 1;
            report.note(format!("ended by {:?} at t = {} s", outcome.ending, outcome.time));
        }
        Err(stalled) => {
            report.stalls += 1;
            report.note(format!("{stalled:?}"));
        }
    }
    for flaw in &mut report.flaws {
        *flaw = format!("{name}: {flaw}");
    }
    report
}
