//! `carom explain`: which effects a scene has, what each changes, and what it costs.

use super::print;
use crate::cli::ExplainArgs;
use crate::error::AppError;
use crate::scene;
use carom_dynamics::explain::choice::Choice;
use carom_dynamics::explain::effect::Effect;
use carom_dynamics::explain::{Cost, Entry, Explanation, Finding, Quantity, Size, explain as explain_scene};
use serde_json::{Value, json};
use std::fmt::Write;

/// Explains the scene.
pub fn explain(args: &ExplainArgs) -> Result<(), AppError> {
    let loaded = scene::load(&args.scene, args.balls.as_deref())?;
    let explanation = explain_scene(&loaded.scene).map_err(|error| loaded.refuse(&error))?;
    if args.json {
        let json = serde_json::to_string_pretty(&as_json(&explanation, args.tolerance, loaded.choice.as_ref()));
        return print(&(json.map_err(|e| AppError::Internal(e.to_string()))? + "\n"));
    }
    let name = args.scene.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let choice = loaded.choice.as_ref().map_or_else(String::new, |choice| chosen(choice) + "\n\n");
    print(&(choice + &text(&name, &explanation, loaded.scene.balls.len(), args.tolerance)))
}

/// What was chosen, what was left out, and what that costs in accuracy and in work.
pub fn chosen(choice: &Choice) -> String {
    let list = |list: &[(Effect, f64)]| match list {
        [] => "nothing".to_owned(),
        list => {
            let each = |(effect, share): &(Effect, f64)| format!("{} ({} %)", effect.name(), figure(100.0 * share));
            list.iter().map(each).collect::<Vec<_>>().join(", ")
        }
    };
    let percent = |share: f64| figure(100.0 * share);
    let (kept, left) = (list(&choice.kept), list(&choice.left_out));
    let (price, tolerance) = (percent(choice.price), percent(choice.tolerance));
    let work = &choice.work;
    format!(
        "effects   kept {kept}; left out {left}\n          what is left out changes flights and landings by {price} %, to {tolerance} % asked for;\n          \
         chosen by {} runs of single balls, {} paths, {} accelerations",
        choice.runs, work.paths, work.accelerations
    )
}

/// What to write into a scene to have an effect.
fn key(effect: Effect) -> &'static str {
    match effect {
        Effect::Gravity => "gravity = [0, 0, -9.81]",
        Effect::Drag => "[air] drag",
        Effect::Wind => "[air] wind",
        Effect::Magnus => "[air] magnus",
        Effect::SpinDecay => "[air] spin_decay",
        Effect::Buoyancy => "[air] buoyancy = true",
        Effect::FallingRestitution => "restitution = { coefficient, falls_above } in the material",
        Effect::Friction => "friction = { coulomb = mu } in the material",
        Effect::ImpulseFriction => "friction = { impulse = mu } in the material",
        Effect::Grip => "friction = { grip = { mu = mu } } in the material",
        Effect::Rolling => "rolling = c_rr in friction = { grip = { .. } }",
        Effect::Rest => "a surface",
    }
}

/// For the eye.
fn text(name: &str, explanation: &Explanation, count: usize, tolerance: f64) -> String {
    let mut text = String::new();
    let looked = explanation.balls.len();
    let balls = if looked == count { count.to_string() } else { format!("{looked} of {count}") };
    let noun = if count == 1 { "ball" } else { "balls" };
    let percent = 100.0 * tolerance;
    let mut line = |what: String| {
        // A string takes everything that is written to it.
        let _ = writeln!(text, "{what}");
    };
    line(format!("{name}: what each effect changes, on the one of {balls} {noun} where that is most"));
    line(String::new());
    let called = explanation.called_for(tolerance);
    if called.is_empty() {
        line(format!("No effect that is off would, by what the scene says, change anything by more than {percent} %."));
    } else {
        line(format!("Off, and would change something by more than {percent} %:"));
    }
    called.into_iter().for_each(|entry| line(sentence(entry)));
    let possible = explanation.possible(tolerance);
    if !possible.is_empty() {
        line("Off, and how strong it is the scene does not tell; if it is as said here:".to_owned());
    }
    possible.into_iter().for_each(|entry| line(sentence(entry)));
    for entry in &explanation.entries {
        line(String::new());
        line(format!("{:<4} {}", if entry.on { "on" } else { "off" }, with_assumption(entry)));
        match &entry.finding {
            Err(why) => line(format!("     {why}")),
            Ok(finding) => {
                for size in &finding.sizes {
                    line(format!("     {}", compared(size, finding)));
                    if let Some(why) = size.apart {
                        line(format!("       apart: {why}"));
                    }
                }
                if let Some((name, value)) = finding.number {
                    line(format!("     by {name} = {}", figure(value)));
                }
                line(format!("     {}", cost(&finding.cost, finding.end_shift)));
            }
        }
    }
    line(String::new());
    let work = explanation.work;
    let counts = format!("{} paths, {} accelerations, {} impacts", work.paths, work.accelerations, work.impacts);
    line(format!("Told by {} runs of single balls: {counts}.", explanation.runs));
    text
}

/// What an effect that is off would do.
fn sentence(entry: &Entry) -> String {
    let Ok(finding) = &entry.finding else { return String::new() };
    let sizes: Vec<String> = finding.sizes.iter().map(|s| would(s, finding)).collect();
    format!("  {}: off. Would {}; add {}.", with_assumption(entry), sizes.join(", "), key(entry.effect))
}

fn with_assumption(entry: &Entry) -> String {
    match entry.assumed {
        "" => entry.effect.name().to_owned(),
        assumed => format!("{}, {assumed}", entry.effect.name()),
    }
}

/// A change of an effect that is off, as part of a sentence.
fn would(size: &Size, finding: &Finding) -> String {
    let percent = format!("{} %", figure(100.0 * size.measured.abs()));
    let of = |more: &'static str, less: &'static str| if size.measured > 0.0 { more } else { less };
    let way = figure(finding.way);
    match size.quantity {
        Quantity::FlightTime => format!("make this flight of {way} m {percent} {}", of("longer", "shorter")),
        Quantity::ImpactSpeed => format!("land {percent} {}", of("faster", "slower")),
        Quantity::Landing => format!("land {} m elsewhere", figure(size.measured)),
        Quantity::Place => format!("be {} m elsewhere after {way} m", figure(size.measured)),
        Quantity::TangentialSpeed => {
            format!("leave the first impact {percent} {} along the surface", of("faster", "slower"))
        }
        Quantity::ReboundSpeed => format!("rebound {percent} {}", of("faster", "slower")),
        Quantity::RollingSpeed => format!("roll {percent} {}", of("faster", "slower")),
        Quantity::Impacts => format!("take {} impacts {}", figure(size.measured.abs()), of("more", "fewer")),
    }
}

/// A change, measured and predicted.
fn compared(size: &Size, finding: &Finding) -> String {
    let ball = finding.ball;
    let (what, unit, scale) = match size.quantity {
        Quantity::FlightTime => ("flight time", " %", 100.0),
        Quantity::ImpactSpeed => ("impact speed", " %", 100.0),
        Quantity::Landing => ("landing", " m", 1.0),
        Quantity::Place => ("place in flight", " m", 1.0),
        Quantity::TangentialSpeed => ("speed along the surface after the first impact", " %", 100.0),
        Quantity::ReboundSpeed => ("rebound speed", " %", 100.0),
        Quantity::RollingSpeed => ("speed of rolling at its end", " % of that at its start", 100.0),
        Quantity::Impacts => ("impacts", "", 1.0),
    };
    let [measured, predicted] = [size.measured, size.predicted].map(|x| signed(scale * x));
    format!("ball {ball}: {what} {measured}{unit}, predicted {predicted}{unit}")
}

fn cost(cost: &Cost, end_shift: f64) -> String {
    let per_second: Vec<String> =
        [(cost.accelerations, "accelerations"), (cost.paths, "paths"), (cost.contacts, "contact evaluations")]
            .into_iter()
            .filter(|(rate, _)| *rate != 0.0)
            .map(|(rate, what)| format!("{} {what}", signed(rate)))
            .collect();
    let per_second = if per_second.is_empty() { "nothing".to_owned() } else { per_second.join(", ") };
    format!("costs {per_second} per second; half of the balls end {} m elsewhere or farther", figure(end_shift))
}

/// Three digits and the sign.
fn signed(x: f64) -> String {
    if x > 0.0 { format!("+{}", figure(x)) } else { figure(x) }
}

/// Three digits.
fn figure(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return if x == 0.0 { "0".to_owned() } else { "none".to_owned() };
    }
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    if (1e-3..1e6).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// For programs: the same with all digits.
fn as_json(explanation: &Explanation, tolerance: f64, choice: Option<&Choice>) -> Value {
    let size = |s: &Size| {
        json!({
            "quantity": quantity(s.quantity), "measured": s.measured, "predicted": s.predicted, "apart": s.apart,
        })
    };
    let found = |f: &Finding| {
        json!({
            "ball": f.ball,
            "way_m": f.way,
            "share": f.share(),
            "number": f.number.map(|(name, value)| json!({ "name": name, "value": value })),
            "sizes": f.sizes.iter().map(size).collect::<Vec<_>>(),
            "end_shift_m": f.end_shift,
            "per_second": {
                "accelerations": f.cost.accelerations, "paths": f.cost.paths, "contacts": f.cost.contacts,
            },
        })
    };
    let entry = |e: &Entry| {
        json!({
            "effect": e.effect.name(),
            "on": e.on,
            "assumed": (!e.assumed.is_empty()).then_some(e.assumed),
            "finding": e.finding.as_ref().ok().map(found),
            "why_not": e.finding.as_ref().err(),
        })
    };
    let shares = |list: &[(Effect, f64)]| {
        list.iter().map(|(effect, share)| json!({ "effect": effect.name(), "share": share })).collect::<Vec<_>>()
    };
    let chosen = choice.map(|c| {
        json!({
            "tolerance": c.tolerance,
            "kept": shares(&c.kept),
            "left_out": shares(&c.left_out),
            "price": c.price,
            "runs": c.runs,
        })
    });
    json!({
        "chosen": chosen,
        "tolerance": tolerance,
        "called_for": explanation.called_for(tolerance).iter().map(|e| e.effect.name()).collect::<Vec<_>>(),
        "possible": explanation.possible(tolerance).iter().map(|e| e.effect.name()).collect::<Vec<_>>(),
        "balls": explanation.balls,
        "effects": explanation.entries.iter().map(entry).collect::<Vec<_>>(),
        "runs": explanation.runs,
        "work": explanation.work.named().into_iter().collect::<std::collections::BTreeMap<_, _>>(),
    })
}

fn quantity(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::FlightTime => "flight_time",
        Quantity::ImpactSpeed => "impact_speed",
        Quantity::Landing => "landing_m",
        Quantity::Place => "place_m",
        Quantity::TangentialSpeed => "tangential_speed",
        Quantity::ReboundSpeed => "rebound_speed",
        Quantity::RollingSpeed => "rolling_speed",
        Quantity::Impacts => "impacts",
    }
}
