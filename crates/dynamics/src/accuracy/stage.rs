//! A scene with what is needed to judge runs of it: the references, the runs, their errors, and what the numbers mean.

use super::candidate::{Candidate, shifted};
use super::compare::{Compared, Ends, Errors, EulerLaws, Shares, Times, distance, growth, reference_error};
use super::course::{Course, Reach, Setting, follow};
use super::measure::Effort;
use super::real::vector;
use super::record::{Record, Recorder, effective_step};
use super::report::{Measurement, ReferenceKind, Remark, work};
use super::taylor::Field;
use super::variant::{Approach, Parameter, Variant};
use super::world::World;
use crate::body::{Ball, State};
use crate::counters::Counters;
use crate::effects::friction::Friction;
use crate::error::SceneError;
use crate::events::Motion;
use crate::plan::Plan;
use crate::scene::Scene;
use carom_geometry::rounding::UNIT_ROUNDOFF;
use nalgebra::Vector3;

/// Growth of small differences beyond which positions say nothing.
const GROWTH_LIMIT: f64 = 1000.0;

/// A scene with what is needed to judge runs of it.
pub(super) struct Stage<'a> {
    pub(super) scene: &'a Scene,
    pub(super) plan: &'a Plan,
    pub(super) world: &'a World,
    pub(super) times: &'a Times,
    pub(super) remarks: Vec<Remark>,
}

/// What the methods are compared with.
pub(super) struct References {
    pub(super) kind: ReferenceKind,
    /// One for each ball.
    pub(super) courses: Vec<Compared>,
    /// The worst growth of small differences while they can be compared.
    pub(super) growth: f64,
    /// What rounding makes of them, in m.
    pub(super) error: f64,
}

impl Stage<'_> {
    /// The reference of each ball.
    pub(super) fn references(&mut self) -> References {
        let fields: Vec<Field> = self.scene.balls.iter().map(|ball| Field::of(self.scene, ball)).collect();
        let size = self.plan.farthest.max(f64::MIN_POSITIVE);
        let shift = size * 2f64.powi(-70);
        let direction = Vector3::new(0.5, 0.5, 0.5f64.sqrt());
        let setting = Setting { plan: self.plan, world: self.world, times: &self.times.all };
        let pair = |(ball, field): (&Ball, &Field)| {
            let course = |shift: f64| follow(&setting, ball, field, &vector(&(direction * shift)));
            (course(0.0), course(shift))
        };
        let pairs: Vec<(Course, Course)> = self.scene.balls.iter().zip(&fields).map(pair).collect();
        let closed = fields.iter().all(Field::is_constant) && !self.world.has_faces();
        let kind = if closed { ReferenceKind::ClosedForm } else { ReferenceKind::Extended };
        let mut worst = 1.0_f64;
        let mut courses = Vec::new();
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
            courses.push(Compared { until: until.min(course.until), course });
        }
        References { kind, courses, growth: worst, error: reference_error(size, worst) }
    }

    /// The same stage for a scene that differs in its balls.
    pub(super) fn beside<'s>(&'s self, scene: &'s Scene) -> Stage<'s> {
        Stage { scene, plan: self.plan, world: self.world, times: self.times, remarks: Vec::new() }
    }

    /// Every method with every step or tolerance of its sweep, the coarse ones first.
    pub(super) fn candidates(&mut self, effort: &Effort, coarse: f64) -> Result<Vec<Candidate>, SceneError> {
        let mut candidates = Vec::new();
        let grips = self.scene.surfaces.iter().any(|s| matches!(s.material.friction, Friction::Grip(_)));
        let textbook = |variant: Variant| matches!(variant.with(1.0), Approach::Textbook(_));
        if grips && effort.variants.iter().any(|v| textbook(*v)) {
            self.remarks.push(Remark::NoTextbook);
        }
        for &variant in effort.variants.iter().filter(|v| !(grips && textbook(**v))) {
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

    pub(super) fn run(&self, candidate: &Candidate) -> Vec<Record> {
        let one = |ball: &Ball| {
            let mut recorder = Recorder::new(&candidate.plan, self.world, &self.times.all, ball);
            let outcome = candidate.run(ball, &mut recorder);
            recorder.finish(outcome)
        };
        self.scene.balls.iter().map(one).collect()
    }

    /// The same run from starts that are an ulp away.
    pub(super) fn run_beside(&self, candidate: &Candidate) -> Vec<Record> {
        let least = 2.0 * UNIT_ROUNDOFF * self.plan.farthest;
        let one = |ball: &Ball| {
            let ulp = |x: f64| if x == 0.0 { least } else { x.next_up() - x };
            shifted(ball, &ball.start().position.coords.map(ulp))
        };
        let beside = Scene { balls: self.scene.balls.iter().map(one).collect(), ..self.scene.clone() };
        self.beside(&beside).run(candidate)
    }

    pub(super) fn judge(
        &self,
        candidate: &Candidate,
        records: &[Record],
        references: &[Compared],
        twins: &mut Vec<(Variant, f64, Vec<Record>)>,
    ) -> Result<Measurement, SceneError> {
        let Candidate { variant, value, .. } = *candidate;
        let errors = Errors::of(self.scene, self.times, records, references);
        let beside = self.run_beside(candidate);
        let rounding = distance(&self.times.all, records, &beside, references);
        let flight_rounding = distance(self.times.in_flight(), records, &beside, references);
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
            shares: Shares { integration, determination, rounding, flight_rounding },
            laws: laws.and_then(|record| EulerLaws::of(self.scene, record, value, errors.first_impact)),
            ends: Ends::of(self.scene, &states, impacts, resting),
            counters,
            work: work(&counters) / seconds,
            cost: None,
        })
    }

    /// The run with certified collisions, made once for each step.
    pub(super) fn twin<'t>(
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
}
