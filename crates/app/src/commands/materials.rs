//! `carom materials`: the tables of restitution and friction, which stand in `data/`.

use super::print;
use crate::cli::MaterialsArgs;
use crate::error::AppError;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

const RESTITUTION: &str = include_str!("../../data/restitution.csv");
const FRICTION: &str = include_str!("../../data/friction.csv");

/// How a ball of a kind rebounds from a surface.
#[derive(Debug, Serialize, Deserialize)]
struct Rebound {
    ball: String,
    surface: String,
    /// The height of the drop, from the bottom of the ball.
    drop_m: Option<f64>,
    rebound_lo_m: Option<f64>,
    rebound_hi_m: Option<f64>,
    /// Where on the ball the height of the rebound is read.
    read_at: Option<String>,
    diameter_lo_m: Option<f64>,
    diameter_hi_m: Option<f64>,
    /// The restitution that follows in a vacuum.
    e_lo: Option<f64>,
    e_hi: Option<f64>,
    /// The restitution that follows with the ball's own air resistance.
    e_drag_lo: Option<f64>,
    e_drag_hi: Option<f64>,
    source: String,
    note: String,
}

/// The friction between two materials.
#[derive(Debug, Serialize, Deserialize)]
struct Rubbing {
    pair: String,
    mu_lo: Option<f64>,
    mu_hi: Option<f64>,
    source: String,
}

/// Both tables.
#[derive(Debug, Serialize)]
struct Tables {
    restitution: Vec<Rebound>,
    friction: Vec<Rubbing>,
}

/// Prints the tables.
pub fn materials(args: &MaterialsArgs) -> Result<(), AppError> {
    let tables = tables().map_err(|e| AppError::Internal(format!("the tables of materials cannot be read: {e}")))?;
    if args.json {
        let json = serde_json::to_string_pretty(&tables).map_err(|e| AppError::Internal(e.to_string()))?;
        return print(&(json + "\n"));
    }
    print(&text(&tables))
}

fn tables() -> Result<Tables, csv::Error> {
    let restitution = csv::Reader::from_reader(RESTITUTION.as_bytes()).deserialize().collect::<Result<_, _>>()?;
    let friction = csv::Reader::from_reader(FRICTION.as_bytes()).deserialize().collect::<Result<_, _>>()?;
    Ok(Tables { restitution, friction })
}

fn text(tables: &Tables) -> String {
    let mut text = String::from(
        "Restitution c_r of a ball on a surface. From drop and rebound heights, in a vacuum and with the ball's own drag:\n\
         without [air] in the scene use the first, with it the second.\n\n",
    );
    let row = |text: &mut String, cells: [&str; 5]| {
        let [ball, surface, vacuum, drag, source] = cells;
        // A string takes everything that is written to it.
        let _ = writeln!(text, "{ball:<28} {surface:<14} {vacuum:<12} {drag:<12} {source}");
    };
    row(&mut text, ["ball", "surface", "vacuum", "with drag", "source"]);
    for r in &tables.restitution {
        let mut source = r.source.clone();
        if !r.note.is_empty() {
            let _ = write!(source, "; {}", r.note);
        }
        row(&mut text, [&r.ball, &r.surface, &range(r.e_lo, r.e_hi), &range(r.e_drag_lo, r.e_drag_hi), &source]);
    }
    text.push_str("\nFriction mu between two materials.\n\n");
    let _ = writeln!(text, "{:<28} {:<14} source", "pair", "mu");
    for f in &tables.friction {
        let _ = writeln!(text, "{:<28} {:<14} {}", f.pair, range(f.mu_lo, f.mu_hi), f.source);
    }
    text
}

fn range(lo: Option<f64>, hi: Option<f64>) -> String {
    match (lo, hi) {
        (Some(lo), Some(hi)) if lo == hi => format!("{lo:?}"),
        (Some(lo), Some(hi)) => format!("{lo:?}-{hi:?}"),
        (None, Some(hi)) => format!("< {hi:?}"),
        (Some(lo), None) => format!("> {lo:?}"),
        (None, None) => "-".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn r18_restitution_follows_from_the_heights_and_the_top_of_a_basketball_is_not_its_bottom() {
        for row in tables().expect("the tables are in the program").restitution {
            let (Some(drop), Some(lo), Some(hi)) = (row.drop_m, row.rebound_lo_m, row.rebound_hi_m) else { continue };
            let (Some(thin), Some(thick)) = (row.diameter_lo_m, row.diameter_hi_m) else { continue };
            // Read at the top, the rebound is too high by the diameter.
            let (less_lo, less_hi) = if row.read_at.as_deref() == Some("top") { (thick, thin) } else { (0.0, 0.0) };
            for (given, rebound) in [(row.e_lo, lo - less_lo), (row.e_hi, hi - less_hi)] {
                let given = given.expect("a row with heights has its restitution");
                // Given to three decimals.
                assert!((given - (rebound / drop).sqrt()).abs() <= 0.0005, "{}: {given}", row.ball);
            }
        }
    }

    #[test]
    fn r21_the_friction_of_the_chapter_is_there() {
        let text = text(&tables().expect("the tables are in the program"));
        for words in ["Teflon on most materials     < 0.05", "wood on wood                 0.25-0.5", "0.5-0.8"] {
            assert!(text.contains(words), "{words} is missing in\n{text}");
        }
    }
}
