//! From the keys of a scene file to a scene, every fault told at its key.

use super::air::Air;
use super::file::{
    BallTable, FallingTable, FrictionTable, Integrator, MaterialTable, MethodTable, RestTable, RestitutionTable,
    SceneFile,
};
use super::problem::Problem;
use super::shapes;
use super::tree::{Node, Step};
use carom_dynamics::body::Ball;
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::gravity::Gravity;
use carom_dynamics::effects::restitution::Restitution;
use carom_dynamics::error::ValueError;
use carom_dynamics::scene::{Method, Scene};
use carom_dynamics::surface::Material;
use carom_dynamics::tolerance::RestThresholds;
use nalgebra::{Point3, Vector3};
use std::collections::BTreeMap;
use std::path::Path;

/// The version of the scene format.
pub const VERSION: u64 = 1;

/// More balls than this in one grid are taken for a slip.
pub const GRID_LIMIT: u64 = 10_000_000;

/// Where in the file something is.
macro_rules! at {
    ($($step:expr),* $(,)?) => { &[$($crate::scene::tree::Step::from($step)),*] };
}
pub(super) use at;

/// Builds a scene, collecting what is wrong with it.
pub struct Builder<'a> {
    pub tree: &'a Node,
    pub problems: Vec<Problem>,
    /// The error in m for which the method is to be chosen, if it is.
    pub auto: Option<f64>,
}

impl Builder<'_> {
    /// Notes `problem` at `path`.
    pub fn refuse(&mut self, path: &[Step<'_>], problem: Problem) {
        self.problems.push(problem.at(self.tree.locate(path)));
    }

    /// The value, or none and a note at `path`.
    pub fn accept<T>(&mut self, path: &[Step<'_>], value: Result<T, ValueError>) -> Option<T> {
        value.map_err(|e| self.refuse(path, Problem::new(e.to_string()))).ok()
    }

    /// The scene, and for each ball the number of its table in the file; complete only if there are no problems.
    ///
    /// Mesh files are looked up from `folder`.
    pub fn scene(&mut self, file: &SceneFile, folder: &Path) -> (Scene, Vec<usize>) {
        if file.version != VERSION {
            let message = format!("version {} of the scene format is unknown", file.version);
            self.refuse(at!["version"], Problem::new(message).help(format!("this program reads version {VERSION}")));
        }
        if !(file.duration.is_finite() && file.duration > 0.0) {
            let message = format!("duration is {:?}, but must be finite and > 0, in s", file.duration);
            self.refuse(at!["duration"], Problem::new(message));
        }
        let gravity = file.gravity.and_then(|g| self.accept(at!["gravity"], Gravity::uniform(Vector3::from(g))));
        let air = file.air.as_ref().map_or_else(Air::default, |air| self.air(air));
        let materials = self.materials(&file.materials);
        let surfaces = shapes::surfaces(self, &file.surfaces, &materials, folder);
        let (balls, tables) = self.balls(&file.balls);
        let rest = file.rest.as_ref().and_then(|rest| self.rest(rest));
        let method = file.method.as_ref().and_then(|method| self.method(method));
        let Air { drag, magnus, spin_decay, buoyancy } = air;
        let duration = file.duration;
        (Scene { duration, gravity, drag, magnus, spin_decay, buoyancy, surfaces, balls, rest, method }, tables)
    }

    /// The materials; one that is not valid is there without a value, so that its surfaces are not blamed.
    fn materials(&mut self, tables: &BTreeMap<String, MaterialTable>) -> BTreeMap<String, Option<Material>> {
        let mut materials = BTreeMap::new();
        for (name, table) in tables {
            let name = name.as_str();
            let restitution = self.restitution(name, table.restitution);
            let (law, friction) = match table.friction {
                None => ("", Ok(Friction::None)),
                Some(FrictionTable::Linear(c_f)) => ("linear", Friction::linear(c_f)),
                Some(FrictionTable::Coulomb(mu)) => ("coulomb", Friction::coulomb(mu)),
                Some(FrictionTable::Impulse(mu)) => ("impulse", Friction::impulse(mu)),
            };
            let friction = self.accept(at!["materials", name, "friction", law], friction);
            let material = restitution.zip(friction);
            let material = material.map(|(restitution, friction)| Material { restitution, friction });
            materials.insert(name.to_owned(), material);
        }
        materials
    }

    fn restitution(&mut self, material: &str, table: RestitutionTable) -> Option<Restitution> {
        match table {
            RestitutionTable::Constant(c_r) => {
                self.accept(at!["materials", material, "restitution"], Restitution::new(c_r))
            }
            RestitutionTable::Falling(FallingTable { coefficient, falls_above }) => {
                let restitution = Restitution::falling(coefficient, falls_above);
                let key = if Restitution::new(coefficient).is_err() { "coefficient" } else { "falls_above" };
                self.accept(at!["materials", material, "restitution", key], restitution)
            }
        }
    }

    fn balls(&mut self, tables: &[BallTable]) -> (Vec<Ball>, Vec<usize>) {
        let mut balls = Vec::new();
        let mut origins = Vec::new();
        for (i, table) in tables.iter().enumerate() {
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
                match ball(place, table) {
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

    fn rest(&mut self, table: &RestTable) -> Option<RestThresholds> {
        match (table.length, table.speed, table.distance, table.force) {
            (Some(length), None, None, None) => self.accept(at!["rest", "length"], RestThresholds::length(length)),
            (None, Some(speed), Some(distance), Some(force)) => {
                let rest = RestThresholds::book(speed, distance, force);
                let keys = ["speed", "distance", "force"];
                let key = rest.err().and_then(|e| keys.into_iter().find(|key| e.name.contains(key)));
                self.accept(at!["rest", key.unwrap_or("speed")], rest)
            }
            _ => {
                let problem =
                    Problem::new("the rest thresholds are either `length`, or `speed`, `distance` and `force`");
                self.refuse(at!["rest"], problem.help("without [rest] they follow from the scene"));
                None
            }
        }
    }

    fn method(&mut self, table: &MethodTable) -> Option<Method> {
        let stepping: Option<fn(f64) -> Method> = match table.integrator {
            Integrator::Exact | Integrator::Adaptive | Integrator::Auto => None,
            Integrator::Euler => Some(|step| Method::Euler { step }),
            Integrator::SemiImplicitEuler => Some(|step| Method::SemiImplicitEuler { step }),
            Integrator::Rk4 => Some(|step| Method::Rk4 { step }),
        };
        if stepping.is_none() && table.step.is_some() {
            let problem = Problem::new("`step` is for a stepping method");
            self.refuse(at!["method", "step"], problem.help("stepping: `euler`, `semi-implicit-euler`, `rk4`"));
        }
        if !matches!(table.integrator, Integrator::Adaptive | Integrator::Auto) && table.tolerance.is_some() {
            let problem = Problem::new("`tolerance` is for the integrators `adaptive` and `auto`");
            self.refuse(at!["method", "tolerance"], problem);
        }
        let key = if stepping.is_some() { "step" } else { "tolerance" };
        let value = match table.integrator {
            Integrator::Exact => return Some(Method::Exact),
            Integrator::Adaptive | Integrator::Auto => table.tolerance,
            _ => table.step,
        };
        let Some(value) = value else {
            let problem = Problem::new(format!("this integrator needs `{key}`"));
            let help = if stepping.is_some() { "such as step = 0.01, in s" } else { "such as tolerance = 1e-9" };
            self.refuse(at!["method", "integrator"], problem.help(help));
            return None;
        };
        if !(value.is_finite() && value > 0.0) {
            self.refuse(at!["method", key], Problem::new(format!("{key} is {value:?}, but must be finite and > 0")));
            return None;
        }
        if table.integrator == Integrator::Auto {
            self.auto = Some(value);
            return None;
        }
        Some(stepping.map_or(Method::Adaptive { tolerance: value }, |make| make(value)))
    }
}

/// The ball of a table, at `place`.
fn ball(place: Point3<f64>, table: &BallTable) -> Result<Ball, ValueError> {
    let ball = Ball::new(place, Vector3::from(table.velocity), table.radius, table.mass)?;
    let ball = ball.spinning(Vector3::from(table.spin))?;
    table.inertia.map_or(Ok(ball), |alpha| ball.with_inertia(alpha))
}

/// The places of a grid, x fastest.
fn places(first: [f64; 3], count: [u32; 3], step: [f64; 3]) -> impl Iterator<Item = Point3<f64>> {
    let at = move |axis: usize, n: u32| first[axis] + f64::from(n) * step[axis];
    let [nx, ny, nz] = count;
    (0..nz)
        .flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| Point3::new(at(0, i), at(1, j), at(2, k)))))
}
