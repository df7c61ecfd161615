//! From the keys of `[[balls]]` to balls, by name or by number, alone or in a grid.

use super::build::{Builder, at};
use super::file::BallTable;
use super::problem::{Problem, choose};
use crate::presets::{self, Preset};
use carom_dynamics::body::Ball;
use carom_dynamics::error::ValueError;
use nalgebra::{Point3, Vector3};

/// More balls than this in one grid are taken for a slip.
const GRID_LIMIT: u64 = 10_000_000;

impl Builder<'_> {
    /// The balls, and for each the number of its table in the file.
    pub fn balls(&mut self, tables: &[BallTable]) -> (Vec<Ball>, Vec<usize>) {
        let mut balls = Vec::new();
        let mut origins = Vec::new();
        for (i, table) in tables.iter().enumerate() {
            let Some(preset) = self.preset(i, table) else { continue };
            let (count, step) = table.grid.as_ref().map_or(([1; 3], [0.0; 3]), |grid| (grid.count, grid.step));
            if let Some(axis) = count.iter().position(|&n| n == 0) {
                let problem = Problem::new("a grid has at least one ball along each axis");
                self.refuse(at!["balls", i, "grid", "count", axis], problem);
                continue;
            }
            let total = count.iter().map(|&n| u64::from(n)).try_fold(1_u64, u64::checked_mul);
            if total.is_none_or(|n| n > GRID_LIMIT) {
                let problem = Problem::new(format!("the grid has more than {GRID_LIMIT} balls"));
                self.refuse(at!["balls", i, "grid", "count"], problem);
                continue;
            }
            for place in places(table.position, count, step) {
                match ball(place, table, preset.as_ref()) {
                    Ok(ball) => {
                        balls.push(ball);
                        origins.push(i);
                    }
                    Err(error) => {
                        self.refuse(at!["balls", i, error.name], Problem::new(error.to_string()));
                        break;
                    }
                }
            }
        }
        (balls, origins)
    }

    /// The ball that a table names, if it names one; none at all if the program does not know it.
    fn preset(&mut self, i: usize, table: &BallTable) -> Option<Option<Preset>> {
        let Some(name) = &table.ball else { return Some(None) };
        // A table that cannot be read names nothing; a test reads it.
        let known = presets::all().unwrap_or_default();
        let found = known.iter().find(|preset| preset.name == *name).cloned();
        if found.is_none() {
            let help = choose(name, "the program knows", known.iter().map(|preset| preset.name.as_str()));
            self.refuse(at!["balls", i, "ball"], Problem::new(format!("unknown ball `{name}`")).help(help));
            return None;
        }
        Some(found)
    }
}

/// The ball of a table, at `place`; what the table does not give is that of the preset.
fn ball(place: Point3<f64>, table: &BallTable, preset: Option<&Preset>) -> Result<Ball, ValueError> {
    let given = |own: Option<f64>, of: fn(&Preset) -> f64| own.or(preset.map(of));
    let radius = given(table.radius, |p| p.radius_m).unwrap_or(0.0);
    let mut ball = Ball::new(place, Vector3::from(table.velocity), radius, given(table.mass, |p| p.mass_kg))?;
    ball = ball.spinning(Vector3::from(table.spin))?;
    if let Some(alpha) = given(table.inertia, |p| p.inertia) {
        ball = ball.with_inertia(alpha)?;
    }
    if let Some(coefficient) = given(table.drag, |p| p.drag) {
        ball = ball.with_drag(coefficient)?;
    }
    match given(table.restitution, |p| p.restitution) {
        Some(c_r) => ball.with_restitution(c_r),
        None => Ok(ball),
    }
}

/// The places of a grid, x fastest.
fn places(first: [f64; 3], count: [u32; 3], step: [f64; 3]) -> impl Iterator<Item = Point3<f64>> {
    let at = move |axis: usize, n: u32| first[axis] + f64::from(n) * step[axis];
    let [nx, ny, nz] = count;
    (0..nz)
        .flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| Point3::new(at(0, i), at(1, j), at(2, k)))))
}
