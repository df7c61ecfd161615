//! How time and memory grow: balls, triangles, threads, length of simulation, restitution. Prints a table with fitted exponents and, if
//! asked with `scaling FILE.svg`, draws it.

use carom::plot::{Axis, Chart, Series};
use carom_benches::clock::peak_memory;
use carom_benches::scenes::{Result, balls_on_terrain, one_ball};
use carom_dynamics::plan::Plan;
use carom_dynamics::run::run_balls;
use carom_dynamics::simulate::simulate;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::process::Command;
use std::time::Instant;

/// What one run measures: what grew, time in s, and memory in bytes.
type Point = (f64, f64, f64);

/// A series of runs in which one thing grows.
struct Growth {
    what: &'static str,
    unit: &'static str,
    sizes: &'static [f64],
}

const ALL: [Growth; 6] = [
    Growth { what: "balls", unit: "s", sizes: &[1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6] },
    Growth { what: "triangles", unit: "s for 1000 balls", sizes: &[1e2, 1e3, 1e4, 1e5, 1e6, 1e7] },
    Growth { what: "build", unit: "s to build", sizes: &[1e3, 1e4, 1e5, 1e6, 1e7] },
    Growth { what: "threads", unit: "s for 10 000 balls", sizes: &[1.0, 2.0] },
    Growth { what: "seconds", unit: "s for one ball on a plane", sizes: &[1.0, 1e1, 1e2, 1e3, 1e4] },
    Growth { what: "1/(1-c_r)", unit: "s for one ball on a plane", sizes: &[2.0, 1e1, 1e2, 1e3, 1e4] },
];

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match args.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["measure", what, size] => {
            let time = measure(what, size.parse()?)?;
            println!("{time:e} {}", peak_memory().unwrap_or(0));
            Ok(())
        }
        [] => table(None),
        [file] => table(Some(file)),
        _ => Err("usage: scaling [FILE.svg]".into()),
    }
}

/// The least time of a few runs, which is the one that others have disturbed least; what takes long is run once.
fn least(what: &str, size: f64) -> Result<Point> {
    const RUNS: usize = 5;
    const LONG: f64 = 2.0;
    let mut best = in_its_own_process(what, size)?;
    for _ in 1..RUNS {
        if best.1 > LONG {
            break;
        }
        let again = in_its_own_process(what, size)?;
        best.1 = best.1.min(again.1);
    }
    Ok(best)
}

/// Every size in a process of its own, whose memory is its own.
fn in_its_own_process(what: &str, size: f64) -> Result<Point> {
    let output = Command::new(std::env::current_exe()?).args(["measure", what, &size.to_string()]).output()?;
    let text = String::from_utf8(output.stdout)?;
    let (time, memory) = text.trim().split_once(' ').ok_or("the measurement failed")?;
    Ok((size, time.parse()?, memory.parse()?))
}

fn table(chart: Option<&str>) -> Result<()> {
    println!("| what grows | size: time, peak memory | exponent of time | of memory |\n|---|---|---|---|");
    let mut series = Vec::new();
    for (look, Growth { what, unit, sizes }) in ALL.iter().enumerate() {
        let points = sizes.iter().map(|&size| least(what, size)).collect::<Result<Vec<_>>>()?;
        let shown = points.iter().map(|(size, time, memory)| format!("{size}: {time:.2e}, {:.0} MB", memory / 1.0e6));
        let time: Vec<[f64; 2]> = points.iter().map(|p| [p.0, p.1]).collect();
        let memory: Vec<[f64; 2]> = points.iter().map(|p| [p.0, p.2]).collect();
        println!(
            "| {what} ({unit}) | {} | {:.2} | {:.2} |",
            shown.collect::<Vec<_>>().join("; "),
            exponent(&time),
            exponent(&memory)
        );
        series.push(Series::new(*what, look, time));
    }
    if let Some(file) = chart {
        let mut chart = Chart::new(
            "Time against size",
            "Time in seconds of runs in which one thing grows",
            Axis::log("size"),
            Axis::log("time, s"),
        );
        chart.series = series;
        std::fs::write(file, chart.svg())?;
    }
    Ok(())
}

/// The slope of the line through the logarithms of the upper half of the points, where what is fixed no longer shows.
fn exponent(points: &[[f64; 2]]) -> f64 {
    let upper = if points.len() < 4 { points } else { &points[points.len() / 2 - points.len() / 4..] };
    let logs: Vec<[f64; 2]> = upper.iter().map(|p| p.map(f64::ln)).collect();
    let n = logs.len() as f64;
    let mean = [0, 1].map(|i| logs.iter().map(|p| p[i]).sum::<f64>() / n);
    let product = |i: usize, j: usize| logs.iter().map(|p| (p[i] - mean[i]) * (p[j] - mean[j])).sum::<f64>();
    product(0, 1) / product(0, 0)
}

/// The seconds that the run of this size takes, without what prepares it.
fn measure(what: &str, size: f64) -> Result<f64> {
    let squares = |triangles: f64| (triangles / 2.0).sqrt().round() as u32;
    Ok(match what {
        "balls" => batch(&Plan::new(&balls_on_terrain(squares(1.0e5), size as usize, 0.7, 1.0)?)?, None)?,
        "triangles" => batch(&Plan::new(&balls_on_terrain(squares(size), 1000, 0.7, 1.0)?)?, Some(1))?,
        "threads" => batch(&Plan::new(&balls_on_terrain(squares(1.0e5), 10_000, 0.7, 1.0)?)?, Some(size as usize))?,
        "build" => {
            let (vertices, faces) = carom_benches::terrain::terrain(squares(size));
            timed(|| _ = black_box(carom_geometry::mesh::Mesh::new(vertices, faces)))
        }
        "seconds" => repeated(&Plan::new(&one_ball(size, 0.8)?)?),
        _ => repeated(&Plan::new(&one_ball(1.0e6, 1.0 - 1.0 / size)?)?),
    })
}

fn timed(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// All balls, their results thrown away one by one.
fn batch(plan: &Plan, threads: Option<usize>) -> Result<f64> {
    let start = Instant::now();
    run_balls(
        plan,
        threads,
        |_| (),
        |_, (), outcome| {
            black_box(outcome);
            ControlFlow::Continue(())
        },
    )?;
    Ok(start.elapsed().as_secs_f64())
}

/// One ball, often enough to be timed.
fn repeated(plan: &Plan) -> f64 {
    const TIMES: usize = 100;
    timed(|| (0..TIMES).for_each(|_| _ = black_box(simulate(plan, &plan.balls()[0], &mut ())))) / TIMES as f64
}
