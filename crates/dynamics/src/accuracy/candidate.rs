//! What is run: a method with its step or tolerance, on a plan of its own; when it is looked at; and how long it takes.

use super::compare::Times;
use super::report::{Cost, Measurement};
use super::textbook::simulate_textbook;
use super::variant::{Approach, Variant};
use crate::body::Ball;
use crate::error::SceneError;
use crate::events::{Event, Outcome};
use crate::observer::{Observer, Segment};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::simulate::simulate;
use nalgebra::Vector3;

/// Times at which positions are compared.
const SAMPLES: u32 = 64;

/// Steps that the first flight is divided into at the coarse end of a sweep, at least.
const COARSE_STEPS: f64 = 8.0;

/// A run that takes longer than this, in s, is timed this often and no more: one need not wait for it, and the clock can tell it well enough.
const LONG: f64 = 1.0 / 16.0;
const ENOUGH: u32 = 2;

/// The least time by the clock that a repeat takes, in s, so that the clock can tell it.
const LEAST_REPEAT: f64 = 1.0 / 8192.0;

/// A method made ready.
pub(super) struct Candidate {
    pub(super) variant: Variant,
    pub(super) value: f64,
    pub(super) approach: Approach,
    pub(super) plan: Plan,
}

impl Candidate {
    pub(super) fn new(variant: Variant, value: f64, scene: &Scene) -> Result<Self, SceneError> {
        let approach = variant.with(value);
        let method = match approach {
            Approach::Method(method) => Some(method),
            Approach::Textbook(_) => None,
        };
        let plan = Plan::new(&Scene { method, ..scene.clone() })?;
        Ok(Self { variant, value, approach, plan })
    }

    pub(super) fn run(&self, ball: &Ball, observer: &mut impl Observer) -> Outcome {
        match &self.approach {
            Approach::Textbook(textbook) => simulate_textbook(&self.plan, textbook, ball, observer),
            Approach::Method(_) => simulate(&self.plan, ball, observer),
        }
    }
}

/// The ball with its start moved by `shift` (m); as it is, if that leaves the numbers.
pub(super) fn shifted(ball: &Ball, shift: &Vector3<f64>) -> Ball {
    let start = ball.start();
    ball.starting(start.position + shift, start.velocity).unwrap_or(*ball)
}

/// When to look, and the coarsest step, in s, a power of two: the first flight has a few of them, and ends one of them where all finer ones end
/// as well.
pub(super) fn times(plan: &Plan) -> (Times, f64) {
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

/// Times the candidates: in turn, `repeats` times over, the quickest of each.
pub(super) fn time(
    candidates: &[Candidate],
    scene: &Scene,
    repeats: u32,
    clock: &mut dyn FnMut() -> f64,
    measured: &mut [Measurement],
) {
    let mut best = vec![f64::INFINITY; candidates.len()];
    let mut rounds = vec![1_u32; candidates.len()];
    for repeat in 0..repeats {
        for (k, candidate) in candidates.iter().enumerate() {
            if repeat >= ENOUGH && best[k] > LONG {
                continue;
            }
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
