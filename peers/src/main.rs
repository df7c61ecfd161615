//! Times the same work by Carom, rapier3d, parry3d and Embree, in one run on one machine, and prints a table in Markdown.
//!
//! `carom-peers [BALLS]`: so many balls on the terrain for rapier, which takes a hundred times as long for each.
//! `carom-peers conformance PACK OUT` writes what rapier makes of the conformance pack instead.

mod conformance;
mod embree;
mod parry;
mod rapier;
mod segments;

use carom_benches::cases::ball_and_triangle;
use carom_benches::clock::{median, peak_memory, seconds};
use carom_benches::scenes::{self, Result};
use carom_benches::terrain::{HALF, SQUARES, height};
use carom_dynamics::counters::Counters;
use carom_dynamics::plan::Plan;
use carom_dynamics::run::run_balls;
use carom_dynamics::simulate::simulate;
use carom_geometry::contact::{MovingBall, first_contact};
use nalgebra::Vector3;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

/// Runs of which the median counts.
const RUNS: usize = 5;

/// Balls on the terrain, by Carom.
const BALLS: usize = 10_000;

/// A row of the table: the work, its unit, and what it takes.
struct Row {
    work: String,
    unit: &'static str,
    carom: f64,
    peer: &'static str,
    theirs: Option<f64>,
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [task, pack, out] = arguments.as_slice()
        && task == "conformance"
    {
        return conformance::run(pack.as_ref(), out.as_ref());
    }
    let rapier_balls = arguments.first().map_or(Ok(500), |n| n.parse())?;
    let mut rows = vec![one_ball()?];
    rows.extend(terrain_balls(rapier_balls)?);
    rows.push(room()?);
    rows.extend(segments::rows()?);
    rows.extend([one_triangle(), prediction()?]);
    println!("| work | Carom | peer | ratio |\n|---|---|---|---|");
    for Row { work, unit, carom, peer, theirs } in rows {
        let figure = |x: f64| if x < 10.0 { format!("{x:.2}") } else { format!("{x:.0}") };
        let (peer, ratio) = match theirs {
            Some(theirs) => (format!("{peer}: {} {unit}", figure(theirs)), figure(theirs / carom)),
            None => ("".to_owned(), "".to_owned()),
        };
        println!("| {work} | {} {unit} | {peer} | {ratio} |", figure(carom));
    }
    if let Some(bytes) = peak_memory() {
        eprintln!("peak memory {} MB", bytes / 1_000_000);
    }
    Ok(())
}

/// All balls of a plan on so many threads, by a clock of choice: the time, and what was done.
fn run(plan: &Plan, threads: usize, clock: fn(&mut dyn FnMut()) -> f64) -> Result<(f64, Counters)> {
    let mut times = Vec::new();
    let mut counters = Counters::default();
    for _ in 0..RUNS {
        counters = Counters::default();
        let mut ended = Ok(());
        times.push(clock(&mut || {
            ended = run_balls(
                plan,
                Some(threads),
                |_| (),
                |_, (), outcome| {
                    counters += outcome.counters;
                    ControlFlow::Continue(())
                },
            );
        }));
        ended?;
    }
    times.sort_by(f64::total_cmp);
    Ok((times[RUNS / 2], counters))
}

/// The time on the wall, in s, for what is done on more than one core.
fn wall(work: &mut dyn FnMut()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// The processor's time, in s.
fn processor(work: &mut dyn FnMut()) -> f64 {
    seconds(work)
}

fn one_ball() -> Result<Row> {
    const DURATION: f64 = 3.0;
    const TIMES: usize = 1000;
    let plan = Plan::new(&scenes::one_ball(DURATION, 0.8)?)?;
    let ball = &plan.balls()[0];
    let time = median(RUNS, || (0..TIMES).for_each(|_| _ = black_box(simulate(&plan, ball, &mut ()))));
    let theirs = rapier::one_ball(DURATION, 1.0 / 60.0);
    Ok(Row {
        work: "one ball on a plane, 3 s".into(),
        unit: "us per simulated second",
        carom: 1.0e6 * time / (TIMES as f64 * DURATION),
        peer: "rapier3d at 1/60 s",
        theirs: Some(1.0e6 * theirs / DURATION),
    })
}

fn terrain_balls(rapier_balls: usize) -> Result<[Row; 2]> {
    const DURATION: f64 = 2.0;
    let plan = Plan::new(&scenes::balls_on_terrain(SQUARES, BALLS, 0.7, DURATION)?)?;
    let through = |ball| {
        let end = simulate(&plan, ball, &mut ()).state.position;
        // Off the edge of the terrain there is nothing to fall through.
        end.x.abs() < HALF && end.y.abs() < HALF && end.z < height(end.x, end.y)
    };
    let through = plan.balls().iter().filter(|ball| through(ball)).count();
    eprintln!("terrain: {through} of {BALLS} balls through the surface");
    let (time, _) = run(&plan, 1, processor)?;
    let theirs = rapier::balls_on_terrain(rapier_balls, DURATION, 1.0 / 240.0)?;
    let ((one, _), (two, _)) = (run(&plan, 1, wall)?, run(&plan, 2, wall)?);
    Ok([
        Row {
            work: "10 000 balls on 200 978 triangles, 2 s".into(),
            unit: "us per ball-second",
            carom: 1.0e6 * time / (BALLS as f64 * DURATION),
            peer: "rapier3d, ccd, internal edges fixed, at 1/240 s",
            theirs: Some(1.0e6 * theirs / (rapier_balls as f64 * DURATION)),
        },
        Row {
            work: "the same balls on two threads".into(),
            unit: "times as fast as on one",
            carom: one / two,
            peer: "",
            theirs: None,
        },
    ])
}

fn room() -> Result<Row> {
    let plan = Plan::new(&scenes::balls_in_room(BALLS, 10.0)?)?;
    let (time, counters) = run(&plan, 1, processor)?;
    let carom = 1.0e9 * time / counters.impacts as f64;
    Ok(Row {
        work: "balls in a room of six elastic walls".into(),
        unit: "ns per impact",
        carom,
        peer: "",
        theirs: None,
    })
}

fn one_triangle() -> Row {
    const TIMES: usize = 200;
    let cases = ball_and_triangle();
    let mut ours: Vec<f64> = Vec::new();
    let mut others: Vec<f64> = Vec::new();
    for case in &cases {
        let ball = MovingBall { path: &case.path, radius: case.radius, holds: &[] };
        let each = |work: &dyn Fn()| 1.0e9 * median(3, || (0..TIMES).for_each(|_| work())) / TIMES as f64;
        ours.push(each(&|| _ = black_box(first_contact(black_box(&ball), &case.triangle, 0.0, 1.0, &mut 0))));
        if case.acceleration == Vector3::zeros() {
            others.push(each(&|| _ = black_box(parry::ball_and_triangle(case))));
        }
    }
    ours.sort_by(f64::total_cmp);
    others.sort_by(f64::total_cmp);
    Row {
        work: "a ball against a triangle, median of the cases with exact answers, certified".into(),
        unit: "ns",
        carom: ours[ours.len() / 2],
        peer: "parry3d-f64, straight ones only",
        theirs: Some(others[others.len() / 2]),
    }
}

fn prediction() -> Result<Row> {
    const TIMES: usize = 100;
    let plan = Plan::new(&scenes::predicted(TIMES)?)?;
    let time = median(RUNS, || plan.balls().iter().for_each(|ball| _ = black_box(simulate(&plan, ball, &mut ()))));
    let carom = 1.0e6 * time / TIMES as f64;
    Ok(Row { work: "one ball 8 s ahead on 7938 triangles".into(), unit: "us", carom, peer: "", theirs: None })
}
