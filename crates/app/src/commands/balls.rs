//! `carom balls`: the balls that scenes can call by name.

use super::print;
use crate::cli::BallsArgs;
use crate::error::AppError;
use crate::presets::{self, Preset};
use std::fmt::Write;

/// Prints the table.
pub fn balls(args: &BallsArgs) -> Result<(), AppError> {
    let balls = presets::all().map_err(|e| AppError::Internal(format!("the table of balls cannot be read: {e}")))?;
    if args.json {
        let json = serde_json::to_string_pretty(&balls).map_err(|e| AppError::Internal(e.to_string()))?;
        return print(&(json + "\n"));
    }
    print(&text(&balls))
}

fn text(balls: &[Preset]) -> String {
    let mut text = String::from(
        "Balls by name: `ball = \"tennis\"` in [[balls]] gives radius, mass, inertia, drag coefficient and restitution. The last two are\n\
         used where the scene asks for them, by drag = \"ball\" in [air] and restitution = \"ball\" in a material. Restitution is fitted to the\n\
         middle of the rebound, with the drag of the ball in air of 1.204 kg/m^3.\n\n",
    );
    let mut row = |cells: [&str; 9]| {
        let [name, mass, radius, drag, inertia, restitution, surface, drop, rebound] = cells;
        // A string takes everything that is written to it.
        let _ = writeln!(
            text,
            "{name:<13} {mass:<8} {radius:<9} {drag:<5} {inertia:<7} {restitution:<7} {surface:<14} {drop:<7} {rebound}"
        );
    };
    row(["name", "mass kg", "radius m", "drag", "inertia", "c_r", "dropped on", "from m", "rebound m"]);
    for b in balls {
        let at_top = if b.read_at == "top" { " at its top" } else { "" };
        let rebound = format!("{}-{}{at_top}", b.rebound_lo_m, b.rebound_hi_m);
        let number = |x: f64| x.to_string();
        row([
            &b.name,
            &number(b.mass_kg),
            &number(b.radius_m),
            &number(b.drag),
            &number(b.inertia),
            &number(b.restitution),
            &b.surface,
            &number(b.drop_m),
            &rebound,
        ]);
    }
    text.push_str("\nSources of the rebounds:\n");
    for b in balls {
        let note = if b.note.is_empty() { String::new() } else { format!(" ({})", b.note) };
        let _ = writeln!(text, "  {}: {}{note}", b.name, b.source);
    }
    text.push_str("Sources of the drag coefficients:\n");
    for b in balls {
        let _ = writeln!(text, "  {}: {}", b.name, b.drag_source);
    }
    text
}
