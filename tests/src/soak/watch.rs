//! Watches one ball of the soak as it flies.
//!
//! Bounds. A place is off by 256 u (L + travel), with L the largest coordinate, as in the checker. An impact may add 4 u of the squared speed
//! to it; over n impacts, with what rounding of places does to the potential, 4 (n + 16) u (v0^2 / 2 + g L).

use super::families::Unit;
use crate::closed::Closed;
use crate::world::U;
use carom_dynamics::body::State;
use carom_dynamics::events::{Event, EventKind, Outcome};
use carom_dynamics::observer::{Observer, Segment};
use carom_dynamics::plan::Plan;
use carom_dynamics::tolerance::time_resolution;
use nalgebra::{Point3, Vector3};
use std::sync::Arc;

/// Events between two looks at which side of a mesh the ball is on.
const LOOK_EVERY: u64 = 256;
/// Samples of a stretch that is no parabola.
const SAMPLES: u32 = 8;
/// Flaws that are told; the others are counted.
const TOLD: usize = 8;

/// What the soak found.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// Balls.
    pub balls: u64,
    /// Impacts.
    pub impacts: u64,
    /// Events of all kinds.
    pub events: u64,
    /// Looks at which side of a mesh a ball was on.
    pub looks: u64,
    /// Flights or looks that found a ball where it must not be.
    pub escapes: u64,
    /// The deepest that a ball was in a surface, as a part of what rounding may take.
    pub deepest: f64,
    /// Balls that gained more energy than rounding may give.
    pub gains: u64,
    /// The most energy gained, as a part of what rounding may give.
    pub most_gained: f64,
    /// The most events in a row without time passing.
    pub stall: u64,
    /// Balls that were ended by a guard.
    pub guards: u64,
    /// Balls that did not get on and were broken off.
    pub stalls: u64,
    /// The most steps from one event to the next.
    pub steps: u64,
    /// The first of what went wrong.
    pub flaws: Vec<String>,
}

impl Report {
    /// Whether nothing went wrong.
    pub fn is_sound(&self) -> bool {
        self.escapes + self.gains + self.guards + self.stalls == 0
    }

    /// Adds another.
    pub fn add(&mut self, other: Self) {
        self.balls += other.balls;
        self.impacts += other.impacts;
        self.events += other.events;
        self.looks += other.looks;
        self.escapes += other.escapes;
        self.gains += other.gains;
        self.guards += other.guards;
        self.stalls += other.stalls;
        self.deepest = self.deepest.max(other.deepest);
        self.most_gained = self.most_gained.max(other.most_gained);
        self.stall = self.stall.max(other.stall);
        self.steps = self.steps.max(other.steps);
        other.flaws.into_iter().for_each(|flaw| self.note(flaw));
    }

    /// Takes a flaw down, if there is room.
    pub fn note(&mut self, flaw: String) {
        if self.flaws.len() < TOLD {
            self.flaws.push(flaw);
        }
    }
}

/// Watches a ball.
pub(super) struct Watch {
    planes: Vec<(Point3<f64>, Vector3<f64>)>,
    closed: Option<Arc<Closed>>,
    farthest: f64,
    radius: f64,
    gravity: Vector3<f64>,
    /// The energy that gains are measured against, in J/kg.
    scale: f64,
    /// The energy that the rest length is worth, which counts once bouncing has ended.
    at_rest: f64,
    settled: bool,
    lowest: f64,
    gained: bool,
    /// Since when no time has passed, in s, and the events since.
    still: (f64, u64),
    steps: u64,
    report: Report,
}

impl Watch {
    pub fn new(unit: &Unit, plan: &Plan) -> Self {
        let ball = &unit.stage.0.balls[0];
        let start = ball.start();
        let gravity = unit.stage.0.gravity.map_or(Vector3::zeros(), |g| g.acceleration());
        let mesh = unit.closed.as_ref().map_or(0.0, |closed| closed.world.farthest);
        let planes = unit.planes.iter().fold(mesh, |m: f64, (p, _)| m.max(p.coords.amax()));
        let farthest = planes.max(start.position.coords.amax()) + ball.radius();
        let mut watch = Self {
            planes: unit.planes.clone(),
            closed: unit.closed.clone(),
            farthest,
            radius: ball.radius(),
            gravity,
            scale: 0.5 * start.velocity.norm_squared() + gravity.norm() * farthest,
            // What stops does so within that length of where it should.
            at_rest: gravity.norm() * plan.rest().at(0.0).distance,
            settled: false,
            lowest: 0.0,
            gained: false,
            still: (0.0, 0),
            steps: 0,
            report: Report { balls: 1, ..Report::default() },
        };
        watch.lowest = watch.energy(&start);
        watch
    }

    fn energy(&self, s: &State) -> f64 {
        0.5 * s.velocity.norm_squared() - self.gravity.dot(&s.position.coords)
    }

    fn see_energy(&mut self, now: f64, time: f64) {
        let rounding = 4.0 * (self.report.impacts + 16) as f64 * U * self.scale;
        let allowed = rounding + if self.settled { self.at_rest } else { 0.0 };
        let gain = (now - self.lowest) / allowed;
        self.lowest = self.lowest.min(now);
        self.report.most_gained = self.report.most_gained.max(gain);
        if (gain > 1.0 || gain.is_nan()) && !self.gained {
            self.gained = true;
            self.report.gains += 1;
            self.report.note(format!("energy up by {gain:.2} of what is allowed at t = {time} s"));
        }
    }

    fn escape(&mut self, what: String) {
        self.report.escapes += 1;
        self.report.note(what);
    }

    fn look(&mut self, x: &Point3<f64>, time: f64) {
        let Some(closed) = &self.closed else { return };
        self.report.looks += 1;
        let slack = 256.0 * U * self.farthest;
        let near = closed.world.distance(x, self.radius + slack);
        let inside = closed.is_inside(x);
        if self.radius > 0.0 {
            self.report.deepest = self.report.deepest.max((self.radius - near) / slack);
        }
        if !inside || near < self.radius - slack {
            self.escape(format!("inside: {inside}, {near:e} from a face of r = {:e} at t = {time} s", self.radius));
        }
    }

    pub fn finish(mut self, outcome: Option<&Outcome>) -> Report {
        if let Some(outcome) = outcome {
            self.look(&outcome.state.position, outcome.time);
        }
        self.report
    }
}

impl Observer for Watch {
    fn event(&mut self, e: &Event) {
        self.steps = 0;
        self.report.events += 1;
        if e.time - self.still.0 > time_resolution(e.time) {
            self.still = (e.time, 0);
        }
        self.still.1 += 1;
        self.report.stall = self.report.stall.max(self.still.1);
        self.settled |= e.kind == EventKind::Slide;
        if e.kind == EventKind::Impact {
            self.report.impacts += 1;
            self.see_energy(self.energy(&State { position: e.position, velocity: e.velocity }), e.time);
        }
        if self.report.events.is_multiple_of(LOOK_EVERY) {
            self.look(&e.position, e.time);
        }
    }

    fn segment(&mut self, s: &Segment) {
        self.steps += 1;
        self.report.steps = self.report.steps.max(self.steps);
        let (start, terms) = (s.step.path.start(), s.step.path.terms());
        let travel = terms.iter().rev().fold(0.0, |sum, term| (sum + term.norm()) * s.to);
        let slack = 256.0 * U * (self.farthest.max(start.coords.amax()) + travel);
        let mut least = f64::INFINITY;
        for (p, n) in &self.planes {
            let gap = n.dot(&(start - p)) - self.radius;
            let rates: Vec<f64> = terms.iter().map(|term| n.dot(term)).collect();
            let mut look = |f: f64| least = least.min(gap + rates.iter().rev().fold(0.0, |sum, rate| (sum + rate) * f));
            look(s.to);
            match rates[..] {
                // The only extremum of a parabola.
                [linear, quadratic] if quadratic > 0.0 => look((-0.5 * linear / quadratic).clamp(0.0, s.to)),
                [] | [_] | [_, _] => {}
                // What slides on no straight line goes by polynomials of higher degree.
                _ => (1..SAMPLES).for_each(|i| look(s.to * f64::from(i) / f64::from(SAMPLES))),
            }
        }
        if !self.planes.is_empty() {
            self.report.deepest = self.report.deepest.max(-least / slack);
            if least < -slack || least.is_nan() {
                self.escape(format!("{least:e} m in a plane, allowed {slack:e}, at t = {} s", s.time));
            }
        }
        let end = s.step.at(s.to);
        if let Some(closed) = &self.closed {
            let (low, high) = (closed.mesh.bounds().min(), closed.mesh.bounds().max());
            if !(0..3).all(|i| low[i] <= end.position[i] && end.position[i] <= high[i]) {
                self.escape(format!("out of the box of the mesh at t = {} s", s.end));
            }
        }
        self.see_energy(self.energy(&end), s.end);
    }
}
