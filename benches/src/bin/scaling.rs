//! How time and memory grow: balls, triangles, threads, length of simulation, restitution. Prints a table with fitted exponents and, if
//! asked with `scaling FILE.svg`, draws it.

use carom::plot::{Axis, Chart, Series};
use carom_benches::clock::peak_memory;
use carom_benches::scenes::{Result, balls_on_terrain, one_ball};
use carom_dynamics::counters::Counters;
use carom_dynamics::plan::Plan;
use carom_dynamics::run::run_balls;
use carom_dynamics::simulate::simulate;
use carom_geometry::bvh::Bvh;
use carom_geometry::mesh::Mesh;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::process::Command;
use std::time::Instant;

/// What one run measures.
struct Point {
    /// What grew.
    size: f64,
    /// In s.
    time: f64,
    /// In bytes.
    memory: f64,
    /// How many impacts there were, and what was looked at for each: nodes, triangles, support planes and clearances. Both are the same on
    /// every machine and in every run.
    impacts: u64,
    looked_at: f64,
}

/// A series of runs in which one thing grows.
struct Growth {
    what: &'static str,
    unit: &'static str,
    sizes: &'static [f64],
}

const ALL: [Growth; 7] = [
    Growth { what: "balls", unit: "s", sizes: &[1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6] },
    Growth { what: "triangles", unit: "s for 1000 balls", sizes: &[1e2, 1e3, 1e4, 1e5, 1e6, 1e7] },
    Growth { what: "tree", unit: "s to build over so many triangles", sizes: &[1e3, 1e4, 1e5, 1e6, 1e7] },
    Growth { what: "mesh", unit: "s to build of so many triangles, tree and all", sizes: &[1e3, 1e4, 1e5, 1e6, 1e7] },
    Growth { what: "threads", unit: "s for 10 000 balls", sizes: &[1.0, 2.0] },
    Growth { what: "seconds", unit: "s for one ball on a plane", sizes: &[1.0, 1e1, 1e2, 1e3, 1e4] },
    Growth { what: "1/(1-c_r)", unit: "s for one ball on a plane", sizes: &[2.0, 1e1, 1e2, 1e3, 1e4] },
];

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match args.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["measure", what, size] => {
            let (time, counters) = measure(what, size.parse()?)?;
            let Counters { impacts, nodes, triangles, rounds, clearances, .. } = counters;
            println!("{time:e} {} {impacts} {}", peak_memory().unwrap_or(0), nodes + triangles + rounds + clearances);
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
        if best.time > LONG {
            break;
        }
        best.time = best.time.min(in_its_own_process(what, size)?.time);
    }
    Ok(best)
}

/// Every size in a process of its own, whose memory is its own.
fn in_its_own_process(what: &str, size: f64) -> Result<Point> {
    let output = Command::new(std::env::current_exe()?).args(["measure", what, &size.to_string()]).output()?;
    let text = String::from_utf8(output.stdout)?;
    let &[time, memory, impacts, looked_at] = text.split_whitespace().collect::<Vec<_>>().as_slice() else {
        return Err("the measurement failed".into());
    };
    let impacts: u64 = impacts.parse()?;
    let looked_at = looked_at.parse::<f64>()? / impacts.max(1) as f64;
    Ok(Point { size, time: time.parse()?, memory: memory.parse()?, impacts, looked_at })
}

fn table(chart: Option<&str>) -> Result<()> {
    println!(
        "| what grows | size: time, peak memory | exponent of time | of memory | size: impacts, looked at for each | more with each tenfold |"
    );
    println!("|---|---|---|---|---|---|");
    let mut series = Vec::new();
    for (look, Growth { what, unit, sizes }) in ALL.iter().enumerate() {
        let points = sizes.iter().map(|&size| least(what, size)).collect::<Result<Vec<_>>>()?;
        let times = points.iter().map(|p| format!("{}: {:.2e}, {:.0} MB", p.size, p.time, p.memory / 1.0e6));
        let counted: Vec<&Point> = points.iter().filter(|p| p.impacts > 0).collect();
        let counts = counted.iter().map(|p| format!("{}: {}, {:.1}", p.size, p.impacts, p.looked_at));
        let time: Vec<[f64; 2]> = points.iter().map(|p| [p.size, p.time]).collect();
        let logs = |of: &dyn Fn(&Point) -> f64| points.iter().map(|p| [p.size.ln(), of(p).ln()]).collect::<Vec<_>>();
        let tenfold: Vec<[f64; 2]> = counted.iter().map(|p| [p.size.log10(), p.looked_at]).collect();
        println!(
            "| {what} ({unit}) | {} | {:.2} | {:.2} | {} | {} |",
            times.collect::<Vec<_>>().join("; "),
            slope(upper(&logs(&|p| p.time))),
            slope(upper(&logs(&|p| p.memory))),
            counts.collect::<Vec<_>>().join("; "),
            if counted.is_empty() { String::new() } else { format!("{:.1}", slope(&tenfold)) }
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

/// The upper half of the points, where what is fixed no longer shows.
fn upper(points: &[[f64; 2]]) -> &[[f64; 2]] {
    if points.len() < 4 { points } else { &points[points.len() / 2 - points.len() / 4..] }
}

/// The slope of the line through the points.
fn slope(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mean = [0, 1].map(|i| points.iter().map(|p| p[i]).sum::<f64>() / n);
    let product = |i: usize, j: usize| points.iter().map(|p| (p[i] - mean[i]) * (p[j] - mean[j])).sum::<f64>();
    product(0, 1) / product(0, 0)
}

/// The seconds that the run of this size takes, without what prepares it, and what was counted.
fn measure(what: &str, size: f64) -> Result<(f64, Counters)> {
    let squares = |triangles: f64| (triangles / 2.0).sqrt().round() as u32;
    let terrain = || carom_benches::terrain::terrain(squares(size));
    Ok(match what {
        "balls" => batch(&Plan::new(&balls_on_terrain(squares(1.0e5), size as usize, 0.7, 1.0)?)?, None)?,
        "triangles" => batch(&Plan::new(&balls_on_terrain(squares(size), 1000, 0.7, 1.0)?)?, Some(1))?,
        "threads" => batch(&Plan::new(&balls_on_terrain(squares(1.0e5), 10_000, 0.7, 1.0)?)?, Some(size as usize))?,
        "tree" => {
            let (vertices, faces) = terrain();
            (timed(|| _ = black_box(Bvh::of_triangles(&vertices, &faces))), Counters::default())
        }
        "mesh" => {
            let (vertices, faces) = terrain();
            (timed(|| _ = black_box(Mesh::new(vertices, faces))), Counters::default())
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
fn batch(plan: &Plan, threads: Option<usize>) -> Result<(f64, Counters)> {
    let (start, mut counters) = (Instant::now(), Counters::default());
    run_balls(
        plan,
        threads,
        |_| (),
        |_, (), outcome| {
            counters += outcome.counters;
            ControlFlow::Continue(())
        },
    )?;
    Ok((start.elapsed().as_secs_f64(), counters))
}

/// One ball, often enough to be timed.
fn repeated(plan: &Plan) -> (f64, Counters) {
    const TIMES: usize = 100;
    let one = || black_box(simulate(plan, &plan.balls()[0], &mut ()));
    (timed(|| (0..TIMES).for_each(|_| _ = one())) / TIMES as f64, one().counters)
}
