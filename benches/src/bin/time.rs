//! Times the scenes: `time [NAME]`, medians of several runs in one process.

use carom_benches::scenes::{self, Result};
use carom_benches::terrain::SQUARES;
use carom_dynamics::body::Ball;
use carom_dynamics::counters::Counters;
use carom_dynamics::events::Outcome;
use carom_dynamics::plan::Plan;
use carom_dynamics::run::run_balls;
use carom_dynamics::scene::Scene;
use carom_dynamics::simulate::simulate;
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
        "room" => report("room", &scenes::balls_in_room(balls, 10.0)?, runs),
        _ => report("b", &scenes::balls_on_terrain(SQUARES, balls, 0.7, 2.0)?, runs),
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
