//! The soak: `soak --bounces N [--shots M] [--family NAME]` bounces balls N times in scenes of every kind and shoots M points and M balls from
//! inside closed meshes at their edges; it reports escapes, energy gained and the longest stall, and fails if anything is wrong.

use carom_tests::closed::Closed;
use carom_tests::parallel;
use carom_tests::shots::{SHOTS, Tally, shoot};
use carom_tests::soak::{FAMILIES, Places, Report, soak};
use std::process::ExitCode;
use std::time::Instant;

const USAGE: &str = "soak [--bounces N] [--shots M] [--family NAME]; N and M may be written as 1e8";

/// Shots that are one piece of work.
const SHOTS_AT_ONCE: u64 = 1000;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (mut bounces, mut shots, mut only) = (0, 0, None);
    for pair in args.chunks(2) {
        match pair {
            [key, value] if key == "--family" && FAMILIES.iter().any(|f| f.name == value) => only = Some(value.clone()),
            [key, value] if key == "--bounces" && count(value).is_some() => bounces = count(value).unwrap_or(0),
            [key, value] if key == "--shots" && count(value).is_some() => shots = count(value).unwrap_or(0),
            _ => {
                eprintln!("{USAGE}");
                return ExitCode::from(2);
            }
        }
    }
    if bounces == 0 && shots == 0 {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    }
    let sound = [bounces == 0 || bounce(bounces, only.as_deref()), shots == 0 || shoot_all(shots)];
    if sound == [true, true] { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// A whole number, also as `1e8`.
fn count(word: &str) -> Option<u64> {
    let n: f64 = word.replace('_', "").parse().ok()?;
    ((0.0..=1e15).contains(&n) && n.fract() == 0.0).then_some(n as u64)
}

fn bounce(bounces: u64, only: Option<&str>) -> bool {
    let began = Instant::now();
    let places = Places::default();
    let mut all = Report::default();
    println!(
        "| family | balls | bounces | escapes | deepest | balls that gained | most gained | longest stall | steps | guards | stalled | s |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    for family in FAMILIES.iter().filter(|family| only.is_none_or(|name| name == family.name)) {
        let since = Instant::now();
        let wanted = if only.is_some() { bounces } else { bounces * family.share / 100 };
        let report = soak(&places, family, wanted.max(1), u64::MAX);
        row(&format!("{}: {}", family.name, family.what), &report, since);
        report.flaws.iter().for_each(|flaw| eprintln!("{flaw}"));
        all.add(report);
    }
    row("all", &all, began);
    println!(
        "\nDeepest and most gained as a part of what rounding, and the rest length where bouncing has ended, may take or give; a stall is events in a row without time passing, steps are those from one event to the next."
    );
    all.is_sound()
}

fn row(name: &str, r: &Report, since: Instant) {
    let seconds = since.elapsed().as_secs_f64();
    println!(
        "| {name} | {} | {} | {} | {:.3} | {} | {:.3} | {} | {} | {} | {} | {seconds:.1} |",
        r.balls, r.impacts, r.escapes, r.deepest, r.gains, r.most_gained, r.stall, r.steps, r.guards, r.stalls
    );
}

fn shoot_all(shots: u64) -> bool {
    println!(
        "\n| inside | shots | at their mark | impacts | missed | outside | guards | stalled | s |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|"
    );
    let all = Closed::all();
    // As many points as balls, along lines as along parabolas, in each mesh.
    let each = shots.div_ceil(2 * all.len() as u64);
    let began = Instant::now();
    let mut sum = Tally::default();
    for closed in &all {
        let since = Instant::now();
        let mut tally = Tally::default();
        for (k, shot) in SHOTS.into_iter().enumerate() {
            let pieces = each.div_ceil(SHOTS_AT_ONCE);
            let some = parallel::map(pieces as usize, |i| {
                let count = SHOTS_AT_ONCE.min(each - i as u64 * SHOTS_AT_ONCE);
                shoot(closed, shot, count, 4 * i as u64 + k as u64)
            });
            some.into_iter().for_each(|piece| tally.add(piece));
        }
        tell(&format!("{} {:?}", closed.body, closed.treatment), &tally, since);
        tally.wrong.iter().for_each(|wrong| eprintln!("{wrong}"));
        sum.add(tally);
    }
    tell("all", &sum, began);
    sum.is_sound()
}

fn tell(name: &str, t: &Tally, since: Instant) {
    let seconds = since.elapsed().as_secs_f64();
    println!(
        "| {name} | {} | {} | {} | {} | {} | {} | {} | {seconds:.1} |",
        t.shots, t.met, t.impacts, t.missed, t.outside, t.guarded, t.stalled
    );
}
