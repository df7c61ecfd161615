//! From the keys of a scene file to a scene, every fault told at its key.

use super::air::Air;
use super::file::{
    EffectsShare, EffectsTable, FallingTable, FrictionTable, GripTable, Integrator, MaterialTable, MethodTable,
    RestTable, RestitutionOf, RestitutionTable, SceneFile,
};
use super::problem::Problem;
use super::shapes;
use super::tree::{Node, Step};
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::gravity::Gravity;
use carom_dynamics::effects::grip::Grip;
use carom_dynamics::effects::restitution::Restitution;
use carom_dynamics::error::ValueError;
use carom_dynamics::scene::{Method, Scene};
use carom_dynamics::surface::Material;
use carom_dynamics::tolerance::RestThresholds;
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::path::Path;

/// The version of the scene format.
pub const VERSION: u64 = 1;

/// What of a grip a message names, and its key.
const GRIP_KEYS: [(&str, &str); 3] = [("grip", "mu"), ("tangential", "tangential"), ("rolling", "rolling")];

fn grip(table: GripTable) -> Result<Friction, ValueError> {
    let grip = Grip::new(table.mu)?.with_tangential(table.tangential)?.with_rolling(table.rolling)?;
    Ok(Friction::Grip(grip))
}

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
        if let Some(EffectsTable::Share(EffectsShare { auto })) = file.effects
            && !(auto.is_finite() && auto > 0.0)
        {
            let message = format!("auto is {auto:?}, but must be a finite share > 0");
            self.refuse(at!["effects", "auto"], Problem::new(message));
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
                Some(FrictionTable::Grip(table)) => ("grip", grip(table)),
            };
            let key = friction.err().and_then(|e| GRIP_KEYS.into_iter().find(|(word, _)| e.name.contains(word)));
            let friction = match key {
                Some((_, key)) => self.accept(at!["materials", name, "friction", law, key], friction),
                None => self.accept(at!["materials", name, "friction", law], friction),
            };
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
            RestitutionTable::Of(RestitutionOf::Ball) => Some(Restitution::of_ball()),
            RestitutionTable::Falling(FallingTable { coefficient, falls_above }) => {
                let restitution = Restitution::falling(coefficient, falls_above);
                let key = if Restitution::new(coefficient).is_err() { "coefficient" } else { "falls_above" };
                self.accept(at!["materials", material, "restitution", key], restitution)
            }
        }
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
