//! `carom plot`: height, speed, energy over time, and the phase portrait.

use crate::cli::{PlotArgs, Quantity};
use crate::curves::{self, Curve, Sample};
use crate::error::AppError;
use crate::output::target::{Target, is_stdout, require_extension};
use crate::plot::{Axis, Chart, Drawn, Series};
use crate::replay::Replay;
use crate::scene;
use crate::stage::Stage;
use crate::terminal::say;

/// As many balls as there are looks to tell them apart.
const MOST_BALLS: usize = 8;

/// More marks than this are a smear.
const MOST_MARKS: usize = 40;

/// The share of the time shown that is left after the last event.
const AFTERWARDS: f64 = 0.05;

/// Draws the chart.
pub fn plot(args: &PlotArgs) -> Result<(), AppError> {
    require_extension(&args.output, "svg")?;
    let mut out = Target::open(&args.output)?;
    let (curves, conclusion) = if scene::is_scene(&args.file) {
        let replay = Replay::of(&args.file, &args.how)?;
        let stage = Stage::of(&replay);
        (curves::of_run(&replay, &stage.up), replay.conclude())
    } else {
        if args.how.balls.is_some() {
            return Err(AppError::Usage("--balls goes with a scene; a table of events has its balls".to_owned()));
        }
        (curves::read(&args.file)?, Ok(()))
    };
    let chosen = choose(curves, args)?;
    out.write(chart(&chosen, args).svg().as_bytes())?;
    out.finish()?;
    if !args.how.quiet && !is_stdout(&args.output) {
        say(&format!("chart     {}, for any browser", args.output.display()));
    }
    conclusion
}

/// The balls that are asked for, or the first ones.
fn choose(curves: Vec<Curve>, args: &PlotArgs) -> Result<Vec<Curve>, AppError> {
    let all = curves.len();
    if let Some(missing) = args.ball.iter().find(|ball| curves.iter().all(|curve| curve.ball != **ball)) {
        let path = args.file.display();
        let balls = if all == 1 { "1 ball".to_owned() } else { format!("{all} balls") };
        return Err(AppError::Usage(format!("there is no ball {missing}: {path} has {balls}, counted from 0")));
    }
    if args.ball.len() > MOST_BALLS {
        return Err(AppError::Usage(format!("a chart tells at most {MOST_BALLS} balls apart")));
    }
    let wanted = |curve: &Curve| args.ball.is_empty() || args.ball.contains(&curve.ball);
    let chosen: Vec<Curve> = curves.into_iter().filter(wanted).take(MOST_BALLS).collect();
    if args.ball.is_empty() && all > MOST_BALLS && !args.how.quiet {
        say(&format!("shown are the first {MOST_BALLS} of {all} balls; choose others with --ball"));
    }
    Ok(chosen)
}

fn chart(curves: &[Curve], args: &PlotArgs) -> Chart {
    let settled = curves.iter().map(|curve| curve.settled).fold(0.0, f64::max);
    let end = curves.iter().filter_map(|curve| curve.samples.last()).map(|s| s.time).fold(0.0, f64::max);
    let from = args.from.unwrap_or(0.0);
    let to = args.to.unwrap_or_else(|| (settled + AFTERWARDS * (settled - from)).min(end));
    let shown = |time: f64| time >= from && time <= to;
    let name = args.file.file_name().unwrap_or_default().to_string_lossy();
    let (what, x, y) = match args.show {
        Quantity::Height => ("height over time", "time, s", "height, m"),
        Quantity::Speed => ("speed over time", "time, s", "speed, m/s"),
        Quantity::Energy => ("energy over time", "time, s", "energy, J/kg"),
        Quantity::Phase => ("phase portrait", "height, m", "vertical velocity, m/s"),
    };
    let title = format!("{name}: {what}");
    let mut chart = Chart::new(title, String::new(), Axis::linear(x), Axis::linear(y));
    for (look, curve) in curves.iter().enumerate() {
        let samples: Vec<&Sample> = curve.samples.iter().filter(|s| shown(s.time)).collect();
        let line = |name: String, look: usize, point: &dyn Fn(&Sample) -> [f64; 2]| {
            Series::new(name, look, samples.iter().map(|s| point(s)).collect()).drawn(Drawn::Line)
        };
        let name = if curves.len() == 1 { String::new() } else { format!("ball {}", curve.ball) };
        match args.show {
            Quantity::Height => chart.series.push(line(name, look, &|s| [s.time, s.height])),
            Quantity::Speed => chart.series.push(line(name, look, &|s| [s.time, s.speed])),
            Quantity::Phase => chart.series.push(line(name, look, &|s| [s.height, s.climb])),
            Quantity::Energy => energies(&mut chart, &samples, name, look, curves.len() == 1),
        }
        if args.show == Quantity::Height {
            let impacts: Vec<[f64; 2]> = curve.impacts.iter().copied().filter(|[t, _]| shown(*t)).collect();
            if impacts.len() <= MOST_MARKS {
                chart.series.push(Series::new("", look, impacts).drawn(Drawn::Marks));
            }
        }
    }
    chart.description = describe(curves, what, from, to);
    chart
}

/// The energies of a ball: of one alone also what they consist of.
fn energies(chart: &mut Chart, samples: &[&Sample], name: String, look: usize, alone: bool) {
    // From the lowest place there is.
    let floor = samples.iter().filter_map(|s| s.potential).fold(f64::INFINITY, f64::min);
    let potential = |s: &Sample| s.potential.map(|p| p - floor);
    let mut add = |name: String, look: usize, energy: &dyn Fn(&Sample) -> f64| {
        let points = samples.iter().map(|s| [s.time, energy(s)]).collect();
        chart.series.push(Series::new(name, look, points).drawn(Drawn::Line));
    };
    if floor == f64::INFINITY {
        // From a table of events.
        let name = if alone { "kinetic".to_owned() } else { format!("{name}, kinetic") };
        add(name, look, &|s| s.kinetic);
    } else if alone {
        add("kinetic".to_owned(), 1, &|s| s.kinetic);
        add("potential".to_owned(), 2, &|s| potential(s).unwrap_or(0.0));
        add("both".to_owned(), 0, &|s| s.kinetic + potential(s).unwrap_or(0.0));
    } else {
        add(name, look, &|s| s.kinetic + potential(s).unwrap_or(0.0));
    }
}

fn describe(curves: &[Curve], what: &str, from: f64, to: f64) -> String {
    let shown = |time: f64| time >= from && time <= to;
    let ball = |curve: &Curve| {
        let impacts = curve.impacts.iter().filter(|[time, _]| shown(*time)).count();
        let samples = || curve.samples.iter().filter(|s| shown(s.time));
        let highest = samples().map(|s| s.height).fold(f64::NEG_INFINITY, f64::max);
        let fastest = samples().map(|s| s.speed).fold(0.0, f64::max);
        let ball = curve.ball;
        let times = if impacts == 1 { "once" } else { &format!("{impacts} times") };
        format!("Ball {ball} hits {times}, is {highest:.3} m high at most and {fastest:.3} m/s fast at most.")
    };
    let balls: Vec<String> = curves.iter().map(ball).collect();
    format!("The {what} from {from:.3} to {to:.3} s. {}", balls.join(" "))
}
