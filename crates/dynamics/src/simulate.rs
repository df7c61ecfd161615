//! The loop: fly to the earliest collision, answer it, and go on; slide while contact lasts; rest.
//!
//! ```text
//! while time remains in the step:
//!     path = integrator over the remaining time
//!     earliest f over all surfaces at which the clearance is <= 0 and falling
//!     none: state = end of the path, the step is done
//!     some: state = path at f, respond, remaining = remaining - f timestep
//! ```

mod flight;
mod lasting;
mod settling;
mod spin;

use crate::body::{Ball, State};
use crate::clock::Clock;
use crate::collision::Obstacles;
use crate::contacts::{Contact, Contacts};
use crate::counters::Counters;
use crate::events::{Bound, Ending, Event, EventKind, Motion, Outcome};
use crate::forces::Forces;
use crate::integrators::adaptive::Adaptive;
use crate::integrators::{Integrator, Step};
use crate::observer::{Observer, Segment};
use crate::plan::{Plan, PlannedSurface};
use crate::tolerance::{
    EVENT_BUDGET, FARTHEST, MAX_STANDSTILL, ROLLING_TOLERANCE, SLIDING_TOLERANCE, STEP_BUDGET, time_resolution,
};
use carom_geometry::bounds::amax;
use nalgebra::Vector3;
use settling::Lowness;
use spin::Slip;

/// Simulates one ball of `plan` to the end and shows it to `observer`.
///
/// ```
/// # use carom_dynamics::body::Ball;
/// # use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
/// # use carom_dynamics::geometry::plane::Plane;
/// # use carom_dynamics::nalgebra::{Point3, Vector3};
/// # use carom_dynamics::scene::Scene;
/// # use carom_dynamics::surface::{Material, Shape, Surface};
/// # let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
/// # let material = Material { restitution: Restitution::new(0.5)?, friction: Friction::None };
/// # let scene = Scene {
/// #     gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0))?),
/// #     surfaces: vec![Surface { name: "floor".into(), material, shape: Shape::Plane(floor) }],
/// #     balls: vec![Ball::new(Point3::new(0.0, 0.0, 4.0), Vector3::zeros(), 0.0, None)?],
/// #     ..Scene::lasting(3.0)
/// # };
/// use carom_dynamics::events::{Ending, EventKind};
/// use carom_dynamics::observer::Trajectory;
/// use carom_dynamics::plan::Plan;
/// use carom_dynamics::simulate::simulate;
///
/// // A drop from 4 m under g = 8 m/s^2, restitution 1/2, for 3 s.
/// let plan = Plan::new(&scene)?;
/// let mut run = Trajectory::default();
/// let outcome = simulate(&plan, &plan.balls()[0], &mut run);
/// assert_eq!((run.events[0].time, run.events[0].kind), (1.0, EventKind::Impact));
/// // After 1 s and infinitely many bounces in 2 s it rests.
/// assert_eq!(run.events.last().map(|event| event.kind), Some(EventKind::Rest));
/// assert_eq!((outcome.ending, outcome.state.velocity), (Ending::Completed, Vector3::zeros()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate(plan: &Plan, ball: &Ball, observer: &mut impl Observer) -> Outcome {
    let forces = plan.forces(ball);
    let surfaces = plan.surfaces_for(ball);
    let mut counters = Counters::default();
    let start = ball.start();
    let a = forces.acceleration(&start, &mut counters);
    let mut walk = Walk {
        plan,
        surfaces: &surfaces,
        spins: plan.spins(ball),
        rolls: false,
        slip: None,
        forces,
        obstacles: Obstacles::new(plan, ball.radius(), &start, &a),
        integrator: plan.integrator(&forces),
        state: start,
        clock: Clock::start(),
        contacts: &mut Contacts::new(),
        before: &mut Contacts::new(),
        motion: Motion::Flying,
        settling: None,
        slider: Adaptive::new(SLIDING_TOLERANCE),
        roller: Adaptive::new(ROLLING_TOLERANCE),
        standstill: 0,
        answered: Contacts::new(),
        moved: 0.0,
        bound: None,
        low_hops: 0,
        lowness: Lowness::under(&a, &plan.rest),
        halvings: 0,
        events: 0,
        ending: None,
        counters,
        observer,
    };
    walk.begin();
    while walk.ending.is_none() && walk.clock.until(plan.duration) > 0.0 {
        match walk.motion {
            Motion::Flying => walk.fly(),
            Motion::Sliding | Motion::Rolling => walk.slide(),
            Motion::Resting => walk.rest(),
        }
        if walk.counters.paths >= STEP_BUDGET && walk.ending.is_none() {
            walk.give_up(Ending::StepBudget, EventKind::StepBudget);
        }
    }
    Outcome {
        ending: walk.ending.unwrap_or(Ending::Completed),
        time: walk.clock.now(),
        state: walk.state,
        spin: walk.spins.then_some(walk.forces.body.spin),
        motion: if walk.rolls && walk.motion == Motion::Sliding { Motion::Rolling } else { walk.motion },
        counters: walk.counters,
    }
}

/// The last, ever smaller hops on a surface, whose infinite sum is finite: what is left of it.
#[derive(Debug, Clone, Copy)]
struct Settling {
    /// Until the last hop ends, in s.
    seconds: f64,
    /// The closing speed of the first of these impacts, in m/s.
    closing: f64,
    /// Which contact it is.
    contact: usize,
}

/// One ball on its way.
struct Walk<'a, O> {
    plan: &'a Plan,
    /// What it can meet, as it meets them.
    surfaces: &'a [PlannedSurface],
    /// Whether its spin is followed.
    spins: bool,
    /// Whether it rolls where it moves along a surface.
    rolls: bool,
    /// How it slips in this stretch, if it spins.
    slip: Option<Slip>,
    forces: Forces<'a>,
    obstacles: Obstacles<'a>,
    integrator: Integrator,
    state: State,
    clock: Clock,
    contacts: &'a mut Contacts,
    /// What it left to get to them, of use only on arrival.
    before: &'a mut Contacts,
    motion: Motion,
    settling: Option<Settling>,
    /// Integrates what slides on planes on no straight line.
    slider: Adaptive,
    /// Integrates what slides around edges and vertices.
    roller: Adaptive,
    /// Answers in a row that took no time to speak of.
    standstill: u32,
    /// What has been touched since time last passed.
    answered: Contacts,
    /// Since when, in s.
    moved: f64,
    /// How far the impact that happens now may be off.
    bound: Option<Bound>,
    /// Impacts in a row after which no hop was high.
    low_hops: u32,
    /// Which hops are.
    lowness: Lowness,
    /// How often the timestep is halved because the path closes where the ball does not.
    halvings: u32,
    events: u64,
    ending: Option<Ending>,
    counters: Counters,
    observer: &'a mut O,
}

impl<O: Observer> Walk<'_, O> {
    /// The end of the current step: the next n h, or the end of the run.
    fn step_end(&self) -> f64 {
        let duration = self.plan.duration;
        let Some(h) = self.integrator.timestep() else { return duration };
        let mut n = (self.clock.now() / h).floor();
        // Twice at most: the plan refuses more steps than f64 can count one by one.
        while n * h <= self.clock.now() {
            n += 1.0;
        }
        (n * h).min(duration)
    }

    /// Moves along `step` to `to`, which is at the time `end` if that is known better than by the sum.
    fn travel(&mut self, step: &Step, to: f64, motion: Motion, end: Option<f64>) {
        let time = self.clock.now();
        self.bound = None;
        match end {
            Some(end) => self.clock.set(end),
            None => self.clock.advance(step.time(to)),
        }
        let end = self.clock.now();
        let turning = self.spins.then(|| self.turning(step, to, motion, self.slip.as_ref()));
        if to > 0.0 {
            self.observer.segment(&Segment { time, end, step: *step, to, motion, turning });
        }
        self.state = step.at(to);
        if let Some(turning) = turning {
            let seconds = step.time(to);
            self.forces.body.spin = turning.at(seconds, seconds);
        }
        if end - self.moved > time_resolution(end) {
            self.standstill = 0;
            self.moved = end;
            return;
        }
        self.stand_still();
    }

    /// Counts what takes no time to speak of.
    #[inline(never)] // it is seldom asked
    fn stand_still(&mut self) {
        if self.standstill == 0 {
            self.answered.clone_from(self.contacts);
        }
        self.standstill += 1;
        if self.standstill > MAX_STANDSTILL {
            self.give_up(Ending::UnresolvedContact, EventKind::UnresolvedContact);
        }
    }

    /// Whether `step` is none because a number in it is not finite, or because the ball is out of range; ends its simulation if so.
    fn diverges(&mut self, step: &Step) -> bool {
        let State { position, velocity } = &self.state;
        let diverges = !step.is_finite() || amax(&position.coords) > FARTHEST || amax(velocity) > FARTHEST;
        if diverges {
            self.give_up(Ending::Diverged, EventKind::Diverged);
        }
        diverges
    }

    /// Rests to the end.
    fn rest(&mut self) {
        let end = self.plan.duration;
        let zero = Vector3::zeros();
        let step =
            crate::integrators::exact::step(&State { velocity: zero, ..self.state }, zero, self.clock.until(end));
        self.travel(&step, step.to, Motion::Resting, Some(end));
    }

    /// Ends the simulation of this ball by a guard, and says so where it is in contact.
    #[inline(never)] // once at most
    fn give_up(&mut self, ending: Ending, kind: EventKind) {
        self.ending = Some(ending);
        self.bound = None;
        if let Some(contact) = self.contacts.first().copied() {
            self.tell(kind, &contact, self.state.velocity);
        }
    }

    fn tell(&mut self, kind: EventKind, contact: &Contact, velocity_in: Vector3<f64>) {
        let numbered = self.surfaces[contact.surface].numbered;
        self.events += 1;
        self.observer.event(&Event {
            time: self.clock.now(),
            kind,
            surface: contact.surface,
            face: contact.site.filter(|_| numbered).map(|site| site.face()),
            position: self.state.position,
            normal: contact.normal,
            velocity_in,
            velocity: self.state.velocity,
            bound: self.bound,
            spin: self.spins.then_some(self.forces.body.spin),
        });
        if self.events == EVENT_BUDGET {
            self.give_up(Ending::EventBudget, EventKind::EventBudget);
        }
    }
}
