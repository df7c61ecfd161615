//! Balls by name, with what is known of each: the table stands in `data/balls.csv`.

use serde::{Deserialize, Serialize};

const BALLS: &str = include_str!("../data/balls.csv");

/// A ball of a kind, and the drop that its restitution follows from.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Preset {
    /// The name by which scenes call it.
    pub name: String,
    /// In kg.
    pub mass_kg: f64,
    /// In m.
    pub radius_m: f64,
    /// The drag coefficient.
    pub drag: f64,
    /// alpha of the moment of inertia alpha m r^2.
    pub inertia: f64,
    /// c_r, which with this drag gives the middle of the allowed rebound.
    pub restitution: f64,
    /// What it is dropped on.
    pub surface: String,
    /// The height of the drop, from the bottom of the ball.
    pub drop_m: f64,
    /// The allowed, or measured, height of the rebound.
    pub rebound_lo_m: f64,
    pub rebound_hi_m: f64,
    /// Where on the ball the rebound is read: `bottom` or `top`.
    pub read_at: String,
    pub source: String,
    pub drag_source: String,
    pub note: String,
}

/// All of them, in the order of the table.
pub fn all() -> Result<Vec<Preset>, csv::Error> {
    csv::Reader::from_reader(BALLS.as_bytes()).deserialize().collect()
}
