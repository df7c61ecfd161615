//! What is kept of a run under test: where the ball was at fixed times, its impacts, its first flight, how deep it got.

use super::course::{Course, Impact, Reach};
use super::real::{Real, point, vector};
use super::world::{Obstacle, World};
use crate::body::{Ball, State};
use crate::energy::{kinetic, potential};
use crate::events::{Ending, Event, EventKind, Motion, Outcome};
use crate::observer::{Observer, Segment};
use crate::plan::Plan;
use crate::scene::Scene;
use carom_geometry::plane::Plane;

/// Places of a stretch that are looked at for penetration, beside its start.
const LOOKS: u32 = 4;

/// Impacts that are looked at in extended precision: a ball that trembles has no end of them.
const MOST_IMPACTS: usize = 64;

/// A run under test of one ball.
#[derive(Debug, Clone)]
pub struct Record {
    /// Where and how fast the ball was at the sample times, as many as it lived to see.
    pub samples: Vec<State>,
    /// Time and surface of each impact; simultaneous ones are one.
    pub impacts: Vec<(f64, usize)>,
    /// The end of the last whole step before anything happened: its time, the state, and the number of steps.
    pub flight: Option<(f64, State, u32)>,
    /// Sums of h^6 and of h over the first flight, and over all, h being the steps that the method took.
    pub steps: [(f64, f64); 2],
    /// How far the ball got behind a surface, in m.
    pub penetration: f64,
    /// How far from touching it was where an impact was answered, in m, at most.
    pub off_touch: f64,
    /// How the run ended.
    pub outcome: Option<Outcome>,
}

/// Watches a ball.
pub struct Recorder<'a> {
    plan: &'a Plan,
    world: &'a World,
    times: &'a [f64],
    radius: f64,
    planes: Vec<(Plane, f64)>,
    obstacles: Vec<Obstacle>,
    happened: bool,
    /// The first flight but for its last step, which may turn out to end in an impact.
    before: Option<(f64, State, u32)>,
    record: Record,
}

impl<'a> Recorder<'a> {
    /// For `ball`, looked at at `times`.
    pub fn new(plan: &'a Plan, world: &'a World, times: &'a [f64], ball: &Ball) -> Self {
        let start = ball.start();
        let side = |plane: &Plane| {
            let towards = if plane.normal().dot(&start.velocity) < 0.0 { -1.0 } else { 1.0 };
            plane.side_of(&start.position).map_or(towards, |side| side.sign())
        };
        Self {
            plan,
            world,
            times,
            radius: ball.radius(),
            planes: plan.planes.iter().map(|(_, plane)| (*plane, side(plane))).collect(),
            obstacles: world.planes(&start.position, &start.velocity).into_iter().map(|(_, o)| o).collect(),
            happened: false,
            before: None,
            record: Record {
                samples: Vec::new(),
                impacts: Vec::new(),
                flight: None,
                steps: [(0.0, 0.0); 2],
                penetration: 0.0,
                off_touch: 0.0,
                outcome: None,
            },
        }
    }

    /// What was seen, and how it ended.
    pub fn finish(self, outcome: Outcome) -> Record {
        Record { outcome: Some(outcome), ..self.record }
    }

    /// Of the planes, at any time.
    fn behind(&mut self, state: &State) {
        for (plane, side) in &self.planes {
            let gap = side * plane.signed_distance(&state.position) - self.radius;
            self.record.penetration = self.record.penetration.max(-gap);
        }
    }

    /// Of the faces, by the reference's own distance.
    fn inside(&mut self, state: &State) {
        let radius = self.radius.max(self.plan.point_radius);
        let x = point(&state.position);
        for (_, face) in self.world.near(&state.position.coords, radius) {
            let gap = face.gap(&x, &Real::from(radius)).0.to_f64();
            self.record.penetration = self.record.penetration.max(-gap);
        }
    }

    fn off_touch(&self, state: &State) -> f64 {
        let x = point(&state.position);
        let radius = self.radius.max(self.plan.point_radius);
        let reach = 2.0 * radius + 64.0 * self.plan.point_radius;
        let faces = self.world.near(&state.position.coords, reach);
        let faces = faces.iter().map(|(_, face)| face.gap(&x, &Real::from(radius)).0);
        let planes = self.obstacles.iter().map(|o| o.gap(&x, &Real::from(self.radius)).0);
        let least = faces.chain(planes).map(|gap| gap.to_f64().abs()).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 0.0 }
    }
}

impl Observer for Recorder<'_> {
    fn event(&mut self, event: &Event) {
        if !std::mem::replace(&mut self.happened, true) && self.record.flight.is_some_and(|(end, ..)| end == event.time)
        {
            self.record.flight = self.before;
        }
        if event.kind != EventKind::Impact || self.record.impacts.last().is_some_and(|(t, _)| *t == event.time) {
            return;
        }
        self.record.impacts.push((event.time, event.surface));
        if self.record.impacts.len() > MOST_IMPACTS {
            return;
        }
        let state = State { position: event.position, velocity: event.velocity };
        self.record.off_touch = self.record.off_touch.max(self.off_touch(&state));
        if self.world.has_faces() {
            self.inside(&state);
        }
    }

    fn segment(&mut self, segment: &Segment) {
        for k in 1..=LOOKS {
            self.behind(&segment.step.at(segment.to * f64::from(k) / f64::from(LOOKS)));
        }
        while let Some(&time) = self.times.get(self.record.samples.len())
            && time <= segment.end
        {
            let state = segment.at(time);
            self.record.samples.push(state);
            if self.world.has_faces() {
                self.inside(&state);
            }
        }
        if segment.motion == Motion::Flying {
            let h = segment.step.seconds * segment.step.to;
            for (powers, sum) in &mut self.record.steps[usize::from(self.happened)..] {
                *powers += h.powi(6);
                *sum += h;
            }
        }
        let whole = segment.to == segment.step.to;
        if !self.happened && whole {
            let steps = self.record.flight.map_or(0, |(_, _, steps)| steps);
            self.before = self.record.flight;
            self.record.flight = Some((segment.end, segment.step.end(), steps + 1));
        }
    }
}

/// The step that, held fixed, would give a method of order 5 the error of the steps with these sums: their local errors go as h^6.
pub fn effective_step((powers, sum): (f64, f64)) -> f64 {
    if sum > 0.0 { (powers / sum).powf(0.2) } else { 0.0 }
}

/// The energy per mass in `scene`, in J/kg.
pub fn energy(scene: &Scene, state: &State) -> f64 {
    kinetic(state) + potential(state, scene.gravity)
}

impl Record {
    /// The run as a course, where there is nothing better to compare with; known up to `duration` (s) if it got there.
    pub fn course(&self, duration: f64) -> Course {
        let resting = self.outcome.is_some_and(|outcome| outcome.motion == Motion::Resting);
        let ended = self.outcome.filter(|outcome| outcome.ending != Ending::Completed).map(|outcome| outcome.time);
        Course {
            samples: self.samples.iter().map(|s| [point(&s.position), vector(&s.velocity)]).collect(),
            impacts: self
                .impacts
                .iter()
                .map(|(t, surface)| Impact { time: Real::from(*t), surface: *surface })
                .collect(),
            rest: resting.then_some(duration),
            until: ended.unwrap_or(duration),
            reach: if ended.is_some() { Reach::Undecided } else { Reach::Complete },
        }
    }
}
