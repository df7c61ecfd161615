//! The first flight of a ball, to its first impact: what an effect changes is compared there.

use crate::body::State;
use crate::events::{Event, EventKind, Motion, Outcome};
use crate::observer::{Observer, Segment};
use crate::plan::Plan;
use crate::simulate::simulate;

/// A ball's first flight, and what became of the ball in the end.
#[derive(Debug, Clone)]
pub(super) struct Flight {
    segments: Vec<Segment>,
    /// The first impact, if there was one.
    pub impact: Option<Event>,
    /// Whether the ball begins with a flight, and not in contact.
    pub flies: bool,
    /// Whether it hit several surfaces at once.
    pub together: bool,
    /// Where it first began to roll, and how it rolled on.
    pub roll: Option<Event>,
    rolling: Vec<Segment>,
    /// The surfaces on which bouncing ended.
    pub endings: Vec<usize>,
    /// The end of the run.
    pub outcome: Outcome,
}

#[derive(Default)]
struct Watcher {
    segments: Vec<Segment>,
    impact: Option<Event>,
    together: bool,
    roll: Option<Event>,
    rolling: Vec<Segment>,
    /// Whether the first rolling has ended.
    rolled: bool,
    /// The surface of the last event, if that was an impact.
    bounced: Option<usize>,
    endings: Vec<usize>,
}

impl Observer for Watcher {
    fn event(&mut self, event: &Event) {
        match &self.impact {
            None if event.kind == EventKind::Impact => self.impact = Some(*event),
            Some(first) if event.kind == EventKind::Impact => self.together |= first.time == event.time,
            _ => {}
        }
        if self.roll.is_none() && event.kind == EventKind::Roll {
            self.roll = Some(*event);
        }
        if self.bounced == Some(event.surface) && matches!(event.kind, EventKind::Slide | EventKind::Rest) {
            self.endings.push(event.surface);
        }
        self.bounced = (event.kind == EventKind::Impact).then_some(event.surface);
    }

    fn segment(&mut self, segment: &Segment) {
        if self.impact.is_none() {
            self.segments.push(*segment);
        }
        match segment.motion {
            Motion::Rolling if !self.rolled => self.rolling.push(*segment),
            _ => self.rolled |= !self.rolling.is_empty(),
        }
    }
}

impl Flight {
    /// Of ball number `ball` of `plan`; none if there is no such ball.
    pub fn of(plan: &Plan, ball: usize) -> Option<Self> {
        let mut watcher = Watcher::default();
        let outcome = simulate(plan, plan.balls().get(ball)?, &mut watcher);
        let Watcher { segments, impact, together, roll, rolling, endings, .. } = watcher;
        let flies = segments.first().is_some_and(|s| s.motion == Motion::Flying);
        Some(Self { segments, impact, flies, together, roll, rolling, endings, outcome })
    }

    /// When the first rolling began and ended, in s.
    pub fn rolling(&self) -> Option<(f64, f64)> {
        Some((self.rolling.first()?.time, self.rolling.last()?.end))
    }

    /// The speed in m/s at `time` of the first rolling.
    pub fn rolling_speed(&self, time: f64) -> f64 {
        let after = self.rolling.partition_point(|s| s.time <= time).max(1);
        self.rolling.get(after - 1).map_or(0.0, |s| s.at(time).velocity.norm())
    }

    /// How long it lasts, in s.
    pub fn seconds(&self) -> f64 {
        self.impact.map_or(self.segments.last().map_or(0.0, |s| s.end), |e| e.time)
    }

    /// The state at `time` within it.
    pub fn at(&self, time: f64) -> State {
        let after = self.segments.partition_point(|s| s.time <= time).max(1);
        self.segments[after - 1].at(time)
    }

    /// The sum over times in [0, `until`] with their weights in s: Simpson's rule, finer than the segments.
    pub fn samples(&self, until: f64) -> impl Iterator<Item = (f64, State, f64)> + '_ {
        let panels = 64 * self.segments.len().clamp(1, 64);
        let h = until / (2 * panels) as f64;
        (0..=2 * panels).map(move |i| {
            let weight = if i == 0 || i == 2 * panels {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            };
            let time = h * i as f64;
            (time, self.at(time), weight * h / 3.0)
        })
    }

    /// The length of the way flown until `until`, in m.
    pub fn way(&self, until: f64) -> f64 {
        self.samples(until).map(|(_, state, weight)| state.velocity.norm() * weight).sum()
    }
}
