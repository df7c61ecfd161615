//! The measurement: references, runs of every method over its sweep, their errors, and their times; and the choice that follows.

use super::candidate::{time, times};
use super::compare::Compared;
use super::course::{Course, Reach};
use super::record::Record;
use super::report::{Measurement, Remark, Report};
use super::stage::{References, Stage};
use super::variant::Variant;
use super::world::World;
use crate::error::SceneError;
use crate::plan::Plan;
use crate::scene::{Method, Scene};

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Balls that are followed: the first ones.
    pub balls: usize,
    /// How often the step is halved.
    pub octaves: u32,
    /// How often the tolerance is divided by ten.
    pub decades: u32,
    /// Timed runs, of which the quickest counts; 0 for none.
    pub repeats: u32,
    /// Which methods.
    pub variants: &'static [Variant],
    /// Whether meshes are refined to see what their discretisation costs.
    pub resolutions: bool,
}

impl Default for Effort {
    fn default() -> Self {
        Self { balls: 4, octaves: 8, decades: 10, repeats: 5, variants: &Variant::ALL, resolutions: true }
    }
}

/// Measures what accuracy costs in `scene`, whose own method is not looked at. `clock` gives the time in s; it is asked only if there are
/// repeats.
pub fn measure(scene: &Scene, effort: &Effort, clock: &mut dyn FnMut() -> f64) -> Result<Report, SceneError> {
    let all = scene.balls.len();
    let balls = scene.balls[..all.min(effort.balls.max(1))].to_vec();
    let scene = Scene { balls, method: None, ..scene.clone() };
    let plan = Plan::new(&scene)?;
    let world = World::new(&plan);
    let (times, coarse) = times(&plan);
    let mut stage = Stage { scene: &scene, plan: &plan, world: &world, times: &times, remarks: Vec::new() };
    if all > scene.balls.len() {
        stage.remarks.push(Remark::SomeBalls { followed: scene.balls.len(), of: all });
    }
    let References { kind, courses: references, growth, error } = stage.references();
    let impacts = references.iter().map(|r| count(&r.course, r.until)).sum();
    let candidates = stage.candidates(effort, coarse)?;
    let mut measured: Vec<Measurement> = Vec::new();
    let mut twins: Vec<(Variant, f64, Vec<Record>)> = Vec::new();
    for candidate in &candidates {
        let records = stage.run(candidate);
        measured.push(stage.judge(candidate, &records, &references, &mut twins)?);
    }
    time(&candidates, &scene, effort.repeats, clock, &mut measured);
    let fits = impacts > 0 && comparable(&references, &times.all) > 0;
    let sweeps = stage.sweeps(measured, effort, fits);
    stage.conclude(&sweeps, impacts, comparable(&references, &times.all));
    let resolutions = if effort.resolutions { stage.resolutions(&references)? } else { Vec::new() };
    let until = references.iter().map(|r| r.until).fold(scene.duration, f64::min);
    let complete = references.iter().all(|r| r.course.reach == Reach::Complete);
    Ok(Report {
        reference: kind,
        reference_error: error,
        balls: scene.balls.len(),
        until,
        growth,
        impacts,
        ends: complete.then(|| stage.reference_ends(&references)),
        sweeps,
        resolutions,
        remarks: stage.remarks,
    })
}

/// Impacts of a course up to a time.
fn count(course: &Course, until: f64) -> usize {
    course.impacts.iter().filter(|impact| impact.time.to_f64() <= until).count()
}

/// Samples that can be compared, of all balls.
fn comparable(references: &[Compared], times: &[f64]) -> usize {
    references.iter().map(|r| times.iter().filter(|t| **t <= r.until).count()).sum()
}

/// The methods that a scene can ask for.
const OFFERED: [Variant; 5] =
    [Variant::Euler, Variant::SemiImplicitEuler, Variant::Rk4, Variant::Adaptive, Variant::Exact];

/// The cheapest method for `scene` whose positions are right to `tolerance` (m) wherever positions can be compared, with its measurement; none
/// if none is.
///
/// It looks at work counts and not at the clock, so that the same scene gets the same method on every machine.
pub fn choose(scene: &Scene, tolerance: f64) -> Result<Option<(Method, Measurement)>, SceneError> {
    let choose = |variants| -> Result<_, SceneError> {
        let effort = Effort { repeats: 0, resolutions: false, variants, ..Effort::default() };
        let report = measure(scene, &effort, &mut || 0.0)?;
        let best = report.cheapest(tolerance);
        Ok(best.and_then(|m| Some((m.method()?, m.clone()))))
    };
    // One path a flight: nothing that steps can be cheaper.
    if Plan::new(&Scene { method: None, ..scene.clone() })?.method() == Method::Exact
        && let Some(exact) = choose(&[Variant::Exact])?
    {
        return Ok(Some(exact));
    }
    choose(&OFFERED)
}
