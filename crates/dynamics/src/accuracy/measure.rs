//! The measurement: references, runs of every method over its sweep, their errors, and their times.

use super::compare::{
    Compared, Ends, Errors, EulerLaws, Shares, Times, distance, growth, only_gravity, reference_error,
};
use super::course::{Course, Reach, Setting, follow};
use super::fit::order;
use super::real::{rounded, vector};
use super::record::{Record, Recorder, effective_step};
use super::report::{Cost, Measurement, ReferenceKind, Remark, Report, Sweep, work};
use super::taylor::Field;
use super::textbook::simulate_textbook;
use super::variant::{Approach, Parameter, Variant};
use super::world::World;
use crate::body::{Ball, State};
use crate::counters::Counters;
use crate::error::SceneError;
use crate::events::{Event, Motion, Outcome};
use crate::observer::{Observer, Segment};
use crate::plan::Plan;
use crate::scene::{Method, Scene};
use crate::simulate::simulate;
use crate::tolerance::FINEST_TOLERANCE;
use nalgebra::Vector3;

/// Times at which positions are compared.
const SAMPLES: u32 = 64;

/// Growth of small differences beyond which positions say nothing.
const GROWTH_LIMIT: f64 = 1000.0;

/// Steps that the first flight is divided into at the coarse end of a sweep, at least.
const COARSE_STEPS: f64 = 8.0;

/// The least time by the clock that a repeat takes, in s, so that the clock can tell it.
const LEAST_REPEAT: f64 = 1.0 / 8192.0;

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
}

impl Default for Effort {
    fn default() -> Self {
        Self { balls: 4, octaves: 8, decades: 10, repeats: 5, variants: &Variant::ALL }
    }
}

/// A method made ready.
struct Candidate {
    variant: Variant,
    value: f64,
    approach: Approach,
    plan: Plan,
}

impl Candidate {
    fn new(variant: Variant, value: f64, scene: &Scene) -> Result<Self, SceneError> {
        let approach = variant.with(value);
        let method = match approach {
            Approach::Method(method) => Some(method),
            Approach::Textbook(_) => None,
        };
        let plan = Plan::new(&Scene { method, ..scene.clone() })?;
        Ok(Self { variant, value, approach, plan })
    }

    fn run(&self, ball: &Ball, observer: &mut impl Observer) -> Outcome {
        match &self.approach {
            Approach::Textbook(textbook) => simulate_textbook(&self.plan, textbook, ball, observer),
            Approach::Method(_) => simulate(&self.plan, ball, observer),
        }
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
    let (references, growth, reference) = stage.references()?;
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
    let until = references.iter().map(|r| r.until).fold(scene.duration, f64::min);
    let complete = references.iter().all(|r| r.course.reach == Reach::Complete);
    Ok(Report {
        reference,
        reference_error: reference_error(plan.farthest, growth),
        balls: scene.balls.len(),
        until,
        growth,
        impacts,
        ends: complete.then(|| stage.reference_ends(&references)),
        sweeps,
        remarks: stage.remarks,
    })
}

/// The ball with its start moved by `shift` (m); as it is, if that leaves the numbers.
fn shifted(ball: &Ball, shift: &Vector3<f64>) -> Ball {
    let start = ball.start();
    let moved = Ball::new(start.position + shift, start.velocity, ball.radius(), ball.mass());
    let moved = moved.and_then(|moved| moved.spinning(ball.spin())?.with_inertia(ball.inertia()));
    moved.unwrap_or(*ball)
}

/// When to look, and the coarsest step, in s, a power of two: the first flight has a few of them, and ends one of them where all finer ones end
/// as well.
fn times(plan: &Plan) -> (Times, f64) {
    let duration = plan.duration;
    let first = |ball: &Ball| {
        let mut run = FirstImpact(duration);
        simulate(plan, ball, &mut run);
        run.0
    };
    let first = plan.balls.iter().map(first).filter(|t| *t > 0.0).fold(duration, f64::min);
    let coarse = 2f64.powf((first / COARSE_STEPS).log2().floor());
    let mut flight = (first / coarse).floor() * coarse;
    if flight >= first && flight > coarse {
        flight -= coarse;
    }
    let mut all: Vec<f64> = (1..=SAMPLES).map(|k| duration * (f64::from(k) / f64::from(SAMPLES))).collect();
    if !all.contains(&flight) {
        all.push(flight);
        all.sort_by(f64::total_cmp);
    }
    (Times { all, flight }, coarse)
}

/// The time of the first impact, in s.
struct FirstImpact(f64);

impl Observer for FirstImpact {
    fn event(&mut self, event: &Event) {
        self.0 = self.0.min(event.time);
    }

    fn segment(&mut self, _: &Segment) {}
}

/// Impacts of a course up to a time.
fn count(course: &Course, until: f64) -> usize {
    course.impacts.iter().filter(|impact| impact.time.to_f64() <= until).count()
}

/// Samples that can be compared, of all balls.
fn comparable(references: &[Compared], times: &[f64]) -> usize {
    references.iter().map(|r| times.iter().filter(|t| **t <= r.until).count()).sum()
}

/// A scene with what is needed to judge runs of it.
struct Stage<'a> {
    scene: &'a Scene,
    plan: &'a Plan,
    world: &'a World,
    times: &'a Times,
    remarks: Vec<Remark>,
}

impl Stage<'_> {
    /// The reference of each ball, and the worst growth of small differences while it can be compared; and what kind of reference it is.
    fn references(&mut self) -> Result<(Vec<Compared>, f64, ReferenceKind), SceneError> {
        let fields: Result<Vec<Field>, _> = self.scene.balls.iter().map(|ball| Field::of(self.scene, ball)).collect();
        let size = self.plan.farthest.max(f64::MIN_POSITIVE);
        let direction = Vector3::new(0.5, 0.5, 0.5f64.sqrt());
        let (pairs, shift, kind) = match fields {
            Ok(fields) => {
                let setting = Setting { plan: self.plan, world: self.world, times: &self.times.all };
                let shift = size * 2f64.powi(-70);
                let pair = |(ball, field): (&Ball, &Field)| {
                    let course = |shift: f64| follow(&setting, ball, field, &vector(&(direction * shift)));
                    (course(0.0), course(shift))
                };
                let pairs: Vec<(Course, Course)> = self.scene.balls.iter().zip(&fields).map(pair).collect();
                let closed = fields.iter().all(Field::is_constant) && !self.world.has_faces();
                (pairs, shift, if closed { ReferenceKind::ClosedForm } else { ReferenceKind::Extended })
            }
            Err(effect) => {
                let shift = size * 2f64.powi(-30);
                let finest = |shift: f64| -> Result<Vec<Course>, SceneError> {
                    let balls = self.scene.balls.iter().map(|ball| shifted(ball, &(direction * shift)));
                    let method = Some(Method::Adaptive { tolerance: FINEST_TOLERANCE });
                    let scene = Scene { balls: balls.collect(), method, ..self.scene.clone() };
                    let candidate = Candidate::new(Variant::Adaptive, FINEST_TOLERANCE, &scene)?;
                    Ok(self.beside(&scene).run(&candidate).iter().map(|r| r.course(self.plan.duration)).collect())
                };
                let pairs = finest(0.0)?.into_iter().zip(finest(shift)?).collect();
                (pairs, shift, ReferenceKind::Itself(effect))
            }
        };
        let mut worst = 1.0_f64;
        let mut references = Vec::new();
        for (ball, (course, moved)) in pairs.into_iter().enumerate() {
            let growth = growth(&course, &moved, shift);
            let chaotic = growth.iter().position(|g| *g > GROWTH_LIMIT);
            let from = chaotic.map(|k| self.times.all[k]);
            if let Some(from) = from {
                self.remarks.push(Remark::Chaotic { ball, from });
            }
            if course.reach != Reach::Complete {
                self.remarks.push(Remark::ReferenceEnds { ball, at: course.until, reach: course.reach });
            }
            // Up to the sample before.
            let until = chaotic.map_or(course.until, |k| k.checked_sub(1).map_or(0.0, |k| self.times.all[k]));
            let known = growth.iter().take(chaotic.unwrap_or(growth.len()));
            worst = known.fold(worst, |worst, g| worst.max(*g));
            references.push(Compared { until: until.min(course.until), course });
        }
        Ok((references, worst, kind))
    }

    /// The same stage for a scene that differs in its balls.
    fn beside<'s>(&'s self, scene: &'s Scene) -> Stage<'s> {
        Stage { scene, plan: self.plan, world: self.world, times: self.times, remarks: Vec::new() }
    }

    /// Every method with every step or tolerance of its sweep, the coarse ones first.
    fn candidates(&mut self, effort: &Effort, coarse: f64) -> Result<Vec<Candidate>, SceneError> {
        let mut candidates = Vec::new();
        for &variant in effort.variants {
            let values: Vec<f64> = match variant.parameter() {
                Parameter::Step => (0..=effort.octaves).map(|k| coarse / 2f64.powi(k as i32)).collect(),
                Parameter::Tolerance => (0..=effort.decades).map(|k| 10f64.powi(-3 - k as i32)).collect(),
                Parameter::None => vec![0.0],
            };
            for value in values {
                match Candidate::new(variant, value, self.scene) {
                    Ok(candidate) => candidates.push(candidate),
                    Err(SceneError::NoExactFlight { .. }) => self.remarks.push(Remark::NoExactFlight),
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(candidates)
    }

    fn run(&self, candidate: &Candidate) -> Vec<Record> {
        let one = |ball: &Ball| {
            let mut recorder = Recorder::new(&candidate.plan, self.world, &self.times.all, ball);
            let outcome = candidate.run(ball, &mut recorder);
            recorder.finish(outcome)
        };
        self.scene.balls.iter().map(one).collect()
    }

    /// The same run from starts that are an ulp away.
    fn run_beside(&self, candidate: &Candidate) -> Vec<Record> {
        let least = self.plan.farthest * f64::EPSILON;
        let one = |ball: &Ball| {
            let ulp = |x: f64| if x == 0.0 { least } else { x.next_up() - x };
            shifted(ball, &ball.start().position.coords.map(ulp))
        };
        let beside = Scene { balls: self.scene.balls.iter().map(one).collect(), ..self.scene.clone() };
        self.beside(&beside).run(candidate)
    }

    fn judge(
        &self,
        candidate: &Candidate,
        records: &[Record],
        references: &[Compared],
        twins: &mut Vec<(Variant, f64, Vec<Record>)>,
    ) -> Result<Measurement, SceneError> {
        let Candidate { variant, value, .. } = *candidate;
        let errors = Errors::of(self.scene, self.times, records, references);
        let rounding = distance(&self.times.all, records, &self.run_beside(candidate), references);
        let twin = variant.twin();
        let (integration, determination) = if twin == variant {
            (errors.position, errors.off_touch)
        } else {
            let certified = self.twin(twin, value, twins)?;
            let error = Errors::of(self.scene, self.times, certified, references).position;
            (error, distance(&self.times.all, records, certified, references))
        };
        let integration = if integration > 4.0 * rounding { integration } else { 0.0 };
        let outcomes = || records.iter().filter_map(|r| r.outcome);
        let counters = outcomes().fold(Counters::default(), |mut sum, o| {
            sum += o.counters;
            sum
        });
        let seconds = self.scene.duration * records.len() as f64;
        let states: Vec<State> = outcomes().map(|o| o.state).collect();
        let resting = outcomes().filter(|o| o.motion == Motion::Resting).count();
        let impacts = records.iter().map(|r| r.impacts.len()).sum();
        let euler = matches!(variant, Variant::Slides | Variant::SlidesOwnF | Variant::Euler);
        let laws = records.first().filter(|_| euler);
        let sums = |k: usize| records.iter().fold((0.0, 0.0), |s, r| (s.0 + r.steps[k].0, s.1 + r.steps[k].1));
        let (first, all) = (sums(0), sums(1));
        Ok(Measurement {
            variant,
            value,
            step: effective_step(all),
            flight_step: effective_step(first),
            errors,
            shares: Shares { integration, determination, rounding },
            laws: laws.and_then(|record| EulerLaws::of(self.scene, record, value, errors.first_impact)),
            ends: Ends::of(self.scene, &states, impacts, resting),
            counters,
            work: work(&counters) / seconds,
            cost: None,
        })
    }

    /// The run with certified collisions, made once for each step.
    fn twin<'t>(
        &self,
        variant: Variant,
        value: f64,
        twins: &'t mut Vec<(Variant, f64, Vec<Record>)>,
    ) -> Result<&'t [Record], SceneError> {
        let known = twins.iter().position(|(v, x, _)| *v == variant && *x == value);
        let known = match known {
            Some(known) => known,
            None => {
                let records = self.run(&Candidate::new(variant, value, self.scene)?);
                twins.push((variant, value, records));
                twins.len() - 1
            }
        };
        Ok(&twins[known].2)
    }

    /// The measurements by method, with their orders.
    fn sweeps(&self, measured: Vec<Measurement>, effort: &Effort, fits: bool) -> Vec<Sweep> {
        let mut sweeps = Vec::new();
        for &variant in effort.variants {
            let measurements: Vec<_> = measured.iter().filter(|m| m.variant == variant).cloned().collect();
            if measurements.is_empty() {
                continue;
            }
            let stepping = variant.parameter() == Parameter::Step;
            // What a linear f is off by depends on where in a step the impacts lie: no line, but a band.
            let even = stepping && variant != Variant::Rk4LinearF;
            let fit = |error: fn(&Errors) -> f64, step: fn(&Measurement) -> f64| {
                let step = |m: &Measurement| if stepping { m.value } else { step(m) };
                let points: Vec<_> =
                    measurements.iter().map(|m| (step(m), error(&m.errors), m.shares.rounding)).collect();
                order(if fits { &points } else { &[] }, even)
            };
            let flight_order = fit(|e| e.flight, |m| m.flight_step);
            let order = fit(|e| e.position, |m| m.step);
            sweeps.push(Sweep { variant, measurements, flight_order, order });
        }
        sweeps
    }

    /// What the numbers mean.
    fn conclude(&mut self, sweeps: &[Sweep], impacts: usize, comparable: usize) {
        if comparable == 0 {
            self.remarks.push(Remark::NothingToCompare);
        } else if impacts == 0 {
            self.remarks.push(Remark::NoImpacts);
        }
        for sweep in sweeps {
            let variant = sweep.variant;
            let whole = sweep.order.value();
            let higher = variant.textbook_orders().is_some_and(|[flight, _]| flight > 1);
            if higher && only_gravity(self.scene) && comparable > 0 && impacts > 0 {
                self.remarks.push(Remark::ExactFlights(variant));
            }
            if let (Some(flight), Some(order)) = (sweep.flight_order.value(), whole)
                && order < flight - 0.1
            {
                self.remarks.push(Remark::LoweredByBounces { variant, flight, order });
            }
            let radius = self.scene.balls.iter().map(Ball::radius).fold(self.plan.farthest * 2f64.powi(-10), f64::max);
            let runs = sweep.measurements.iter().filter(|m| m.errors.penetration > radius).count();
            if runs > 0 {
                self.remarks.push(Remark::Through { variant, runs });
            }
        }
    }

    fn reference_ends(&self, references: &[Compared]) -> Ends {
        let last = references.iter().filter_map(|r| r.course.samples.last());
        let states: Vec<State> =
            last.map(|[x, v]| State { position: rounded(x).into(), velocity: rounded(v) }).collect();
        let impacts = references.iter().map(|r| r.course.impacts.len()).sum();
        let resting = references.iter().filter(|r| r.course.rest.is_some()).count();
        Ends::of(self.scene, &states, impacts, resting)
    }
}

/// Times the candidates: in turn, `repeats` times over, the quickest of each.
fn time(
    candidates: &[Candidate],
    scene: &Scene,
    repeats: u32,
    clock: &mut dyn FnMut() -> f64,
    measured: &mut [Measurement],
) {
    let mut best = vec![f64::INFINITY; candidates.len()];
    let mut rounds = vec![1_u32; candidates.len()];
    for _ in 0..repeats {
        for (k, candidate) in candidates.iter().enumerate() {
            loop {
                let start = clock();
                for _ in 0..rounds[k] {
                    for ball in &scene.balls {
                        candidate.run(ball, &mut ());
                    }
                }
                let taken = clock() - start;
                best[k] = best[k].min(taken / f64::from(rounds[k]));
                if taken >= LEAST_REPEAT || rounds[k] >= 4096 || taken < 0.0 {
                    break;
                }
                rounds[k] *= 4;
            }
        }
    }
    let seconds = scene.duration * scene.balls.len() as f64;
    for (m, best) in measured.iter_mut().zip(best).filter(|(_, best)| best.is_finite()) {
        let impacts = m.counters.impacts;
        let per_impact = (impacts > 0).then(|| best * 1e9 / impacts as f64);
        m.cost = Some(Cost { per_second: best * 1e9 / seconds, per_impact });
    }
}

/// The methods that a scene can ask for.
const OFFERED: [Variant; 5] =
    [Variant::Euler, Variant::SemiImplicitEuler, Variant::Rk4, Variant::Adaptive, Variant::Exact];

/// The cheapest method for `scene` whose positions are right to `tolerance` (m) wherever positions can be compared, with its measurement; none
/// if none is.
///
/// It looks at work counts and not at the clock, so that the same scene gets the same method on every machine.
pub fn choose(scene: &Scene, tolerance: f64) -> Result<Option<(Method, Measurement)>, SceneError> {
    let effort = Effort { repeats: 0, variants: &OFFERED, ..Effort::default() };
    let report = measure(scene, &effort, &mut || 0.0)?;
    let best = report.cheapest(tolerance);
    Ok(best.and_then(|m| Some((m.method()?, m.clone()))))
}
