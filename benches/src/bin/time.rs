//! Times the scenes: `time [NAME]`, medians of several runs in one process.

use carom_benches::cases::ball_and_triangle;
use carom_benches::clock::median;
use carom_benches::scenes::{self, Result};
use carom_benches::terrain::SQUARES;
use carom_dynamics::body::Ball;
use carom_dynamics::counters::Counters;
use carom_dynamics::events::Outcome;
use carom_dynamics::plan::Plan;
use carom_dynamics::run::run_balls;
use carom_dynamics::scene::Scene;
use carom_dynamics::simulate::simulate;
use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::triangle::Feature;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let balls = args.get(1).map_or(Ok(10_000), |n| n.parse())?;
    let runs = args.get(2).map_or(Ok(3), |n| n.parse())?;
    match args.first().map_or("b", String::as_str) {
        "a" => report("a", &scenes::one_ball(3.0, 0.8)?, 1000 * runs),
        "prediction" => report("prediction", &scenes::predicted(balls)?, runs),
        "build" => {
            let (vertices, faces) = carom_benches::terrain::terrain(balls as u32);
            let (count, start) = (faces.len(), Instant::now());
            let mesh = carom_geometry::mesh::Mesh::new(vertices, faces)?;
            let (bytes, seconds) = (mesh.bytes() as f64 / count as f64, start.elapsed().as_secs_f64());
            println!("{count} faces in {seconds:.2} s, {bytes:.1} bytes a face beside the vertices");
            Ok(())
        }
        "triangle" => {
            triangle(runs);
            Ok(())
        }
        "room" => report("room", &scenes::balls_in_room(balls, 10.0)?, runs),
        _ => report("b", &scenes::balls_on_terrain(SQUARES, balls, 0.7, 2.0)?, runs),
    }
}

/// A ball against a triangle: deciles over the cases with exact answers, of the queries that end on each feature.
fn triangle(runs: usize) {
    const TIMES: usize = 1024;
    let mut all: Vec<(String, f64)> = Vec::new();
    for case in ball_and_triangle() {
        let ball = MovingBall { path: &case.path, radius: case.radius, holds: &[] };
        let query = || first_contact(&ball, black_box(&case.triangle), 0.0, 1.0, &mut 0);
        let time = median(runs, || (0..TIMES).for_each(|_| _ = black_box(query())));
        let kind = match query() {
            Contact::Miss => "miss",
            Contact::At { feature: Feature::Face, .. } => "face",
            Contact::At { feature: Feature::Edge(_), .. } => "edge",
            Contact::At { feature: Feature::Vertex(_), .. } => "vertex",
        };
        all.push((kind.into(), 1e9 * time / TIMES as f64));
    }
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    for kind in ["", "miss", "face", "edge", "vertex"] {
        let of: Vec<f64> = all.iter().filter(|(k, _)| kind.is_empty() || k == kind).map(|(_, t)| *t).collect();
        let deciles: Vec<String> = (1..10).map(|k| format!("{:.0}", of[(of.len() - 1) * k / 10])).collect();
        println!("triangle {kind}: {} queries, deciles {} ns", of.len(), deciles.join(", "));
    }
}

/// A function of its own, so that profilers can tell it from what prepares it.
#[inline(never)]
fn one_ball(plan: &Plan, ball: &Ball) -> Outcome {
    simulate(plan, ball, &mut ())
}

fn report(name: &str, scene: &Scene, runs: usize) -> Result<()> {
    let plan = Plan::new(scene)?;
    let mut times: Vec<f64> = Vec::new();
    let mut counters = Counters::default();
    let mut sum = 0.0;
    for _ in 0..runs {
        counters = Counters::default();
        sum = 0.0;
        let start = Instant::now();
        let mut note = |_: usize, (): (), outcome: Outcome| {
            counters += outcome.counters;
            sum += outcome.state.position.coords.sum();
            ControlFlow::Continue(())
        };
        match plan.balls() {
            [ball] => _ = note(0, (), one_ball(&plan, ball)),
            _ => run_balls(&plan, Some(1), |_| (), note)?,
        }
        times.push(start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    let time = times[times.len() / 2];
    let balls = scene.balls.len() as f64;
    println!(
        "{name}: {:.3} us per ball-second, {:.1} ns per impact (least {:.3}, checksum {sum:e})",
        1e6 * time / (balls * scene.duration),
        1e9 * time / counters.impacts as f64,
        1e6 * times[0] / (balls * scene.duration)
    );
    for (what, n) in counters.named() {
        println!("  {what} {:.2} a ball", n as f64 / balls);
    }
    Ok(())
}
