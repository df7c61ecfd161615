//! The loop: fly to the earliest collision, answer it, and go on; slide while contact lasts; rest.
//!
//! ```text
//! while time remains in the step:
//!     path = integrator over the remaining time
//!     earliest f over all surfaces at which the clearance is <= 0 and falling
//!     none: state = end of the path, the step is done
//!     some: state = path at f, respond, remaining = remaining - f timestep
//! ```

use crate::body::{Ball, State};
use crate::clock::Clock;
use crate::collision::{Hit, Obstacles, Returns};
use crate::contacts::{Contact, Contacts};
use crate::counters::Counters;
use crate::events::{Ending, Event, EventKind, Motion, Outcome};
use crate::forces::Forces;
use crate::integrators::adaptive::Adaptive;
use crate::integrators::{Integrator, Step};
use crate::observer::{Observer, Segment};
use crate::plan::Plan;
use crate::response::respond;
use crate::sliding::{Balance, Carrier, Slide, slide};
use crate::tolerance::{EVENT_BUDGET, MAX_STANDSTILL, SLIDING_TOLERANCE, least_hop, touch_distance};
use carom_geometry::clearance::Entry;
use carom_geometry::sweep::{Bend, RegionBound};
use nalgebra::Vector3;

/// Simulates one ball of `plan` to the end and shows it to `observer`.
pub fn simulate(plan: &Plan, ball: &Ball, observer: &mut impl Observer) -> Outcome {
    let forces = plan.forces(ball);
    let mut counters = Counters::default();
    let start = ball.start();
    let a = forces.acceleration(&start, &mut counters);
    let mut walk = Walk {
        plan,
        forces,
        obstacles: Obstacles::new(plan, ball.radius(), &start, &a),
        integrator: plan.integrator(),
        state: start,
        clock: Clock::start(),
        contacts: Contacts::new(),
        motion: Motion::Flying,
        settling: None,
        slider: Adaptive::new(SLIDING_TOLERANCE),
        standstill: 0,
        halvings: 0,
        events: 0,
        ending: None,
        counters,
        observer,
    };
    while walk.ending.is_none() && walk.clock.until(plan.duration) > 0.0 {
        match walk.motion {
            Motion::Flying => walk.fly(),
            Motion::Sliding => walk.slide(),
            Motion::Resting => walk.rest(),
        }
    }
    Outcome {
        ending: walk.ending.unwrap_or(Ending::Completed),
        time: walk.clock.now(),
        state: walk.state,
        motion: walk.motion,
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
    forces: Forces<'a>,
    obstacles: Obstacles<'a>,
    integrator: Integrator,
    state: State,
    clock: Clock,
    contacts: Contacts,
    motion: Motion,
    settling: Option<Settling>,
    /// Integrates what slides on no straight line.
    slider: Adaptive,
    /// Answers in a row that took no time.
    standstill: u32,
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
        while n * h <= self.clock.now() {
            n += 1.0;
        }
        (n * h).min(duration)
    }

    /// One pass of the slides' loop.
    fn fly(&mut self) {
        let end = self.step_end();
        let remaining = self.clock.until(end);
        let mut timestep = remaining;
        for _ in 0..self.halvings {
            timestep *= 0.5;
        }
        let step = self.integrator.step(&self.forces, &self.state, timestep, &mut self.counters);
        let returns = self.obstacles.returns(&step, &self.contacts, &mut self.counters);
        let hit = self.obstacles.earliest(&step, &self.contacts, &returns, &mut self.counters);
        match hit {
            None => {
                let whole = timestep == remaining && step.time(step.to) >= remaining;
                self.travel(&step, step.to, Motion::Flying, whole.then_some(end));
                self.contacts.clear();
                self.halvings = 0;
            }
            Some(hit) => {
                self.travel(&step, hit.f, Motion::Flying, None);
                self.arrive(&step, hit, &returns);
            }
        }
    }

    /// Moves along `step` to `to`, which is at the time `end` if that is known better than by the sum.
    fn travel(&mut self, step: &Step, to: f64, motion: Motion, end: Option<f64>) {
        let time = self.clock.now();
        match end {
            Some(end) => self.clock.set(end),
            None => self.clock.advance(step.time(to)),
        }
        let end = self.clock.now();
        if to > 0.0 {
            self.observer.segment(&Segment { time, end, step: *step, to, motion });
        }
        self.state = step.at(to);
        if end > time {
            self.standstill = 0;
            return;
        }
        self.standstill += 1;
        if self.standstill > MAX_STANDSTILL {
            self.ending = Some(Ending::UnresolvedContact);
        }
    }

    /// At a collision: what is touched, how fast, and the answer.
    fn arrive(&mut self, step: &Step, hit: Hit, returns: &Returns) {
        let tolerance = self.touch_tolerance(step.path.reach(hit.f));
        let before = std::mem::take(&mut self.contacts);
        let mut contacts =
            self.obstacles.touching(&self.state.position, &self.state.velocity, tolerance, &mut self.counters);
        for contact in &mut contacts {
            self.correct(contact, tolerance);
            contact.rate = self.rate(step, hit, contact, &before, returns);
        }
        let carried = |c: &Contact| before.iter().any(|b| b.lasting && b.surface == c.surface && b.site == c.site);
        if let Some(contact) = contacts.iter().find(|c| c.rate < 0.0)
            && step.exact
        {
            // The normal speed is known better from the clearance than from the velocity.
            let n = contact.normal;
            self.state.velocity += n * (contact.rate - n.dot(&self.state.velocity));
        }
        let closing: Vec<bool> = contacts.iter().map(|c| c.rate < 0.0).collect();
        if closing.contains(&true) {
            let materials: Vec<_> = contacts.iter().map(|c| self.plan.surfaces[c.surface].material).collect();
            let velocity_in = self.state.velocity;
            self.state.velocity = respond(velocity_in, &mut contacts, &materials, &mut self.counters);
            self.counters.impacts += 1;
            self.halvings = 0;
            for (contact, _) in contacts.iter().zip(&closing).filter(|(_, closing)| **closing) {
                self.tell(EventKind::Impact, contact, velocity_in);
            }
        }
        for contact in &mut contacts {
            contact.lasting = carried(contact) && contact.rate == 0.0;
        }
        self.contacts = contacts;
        let answered = closing.contains(&true);
        let carried = self.settle();
        if !answered && !carried && hit.f == 0.0 {
            // The path closes where the ball does not: the hop is too short for this step.
            self.halvings += 1;
            self.counters.halvings += 1;
        }
    }

    /// What counts as touching here.
    fn touch_tolerance(&self, travelled: f64) -> f64 {
        touch_distance(self.state.position.coords.amax().max(self.forces.ball.radius()), travelled)
    }

    /// Puts the centre back onto the surface it touches, within the rounding bound of its position (R15: explicit, bounded, counted).
    fn correct(&mut self, contact: &Contact, tolerance: f64) {
        if let Some(gap) = self.obstacles.gap(contact, &self.state.position)
            && gap != 0.0
            && gap.abs() <= tolerance
        {
            self.state.position -= contact.normal * gap;
            self.counters.corrections += 1;
        }
    }

    /// The rate of change of a contact's clearance on arrival: from the clearance itself where it was solved, else n.v.
    fn rate(&self, step: &Step, hit: Hit, contact: &Contact, before: &[Contact], returns: &Returns) -> f64 {
        let known =
            before.iter().zip(returns).find(|(b, _)| b.surface == contact.surface && b.normal == contact.normal);
        if let Some((b, known)) = known {
            match known.entry {
                _ if b.lasting => return 0.0,
                Entry::At { f, rate } if step.exact && f == hit.f => return rate / step.seconds,
                _ if hit.f == 0.0 => return b.rate,
                _ => {}
            }
        }
        match hit.rate {
            Some(rate) if step.exact && contact.surface == hit.surface => rate / step.seconds,
            _ => contact.rate,
        }
    }

    /// What the ball makes of its contacts: it flies on, goes on bouncing, or settles. Says whether something carries it.
    fn settle(&mut self) -> bool {
        let sliding = self.motion == Motion::Sliding;
        let a = self.forces.acceleration(&self.state, &mut self.counters);
        let carriers = self.carriers();
        let mut carrying = [false; crate::contacts::MAX_CONTACTS];
        let mut settling = None;
        for (i, carrier) in carriers.iter().enumerate() {
            let contact = &carrier.contact;
            let pressed = -contact.normal.dot(&a) - carrier.centripetal(&self.state.velocity);
            carrying[i] = self.ends_bouncing(contact, pressed);
            if carrying[i] && contact.rate > 0.0 {
                let c_r = self.plan.surfaces[contact.surface].material.restitution.coefficient();
                let seconds = 2.0 * contact.rate / (pressed * (1.0 - c_r));
                settling = Some(Settling { seconds, closing: contact.rate, contact: i });
            }
        }
        let several = carrying.iter().filter(|c| **c).count() > 1;
        if !carrying.contains(&true) {
            self.set_flying(sliding);
            return false;
        }
        for (contact, carrying) in self.contacts.iter_mut().zip(carrying) {
            contact.lasting = carrying;
            if carrying {
                contact.rate = 0.0;
            }
        }
        self.make_tangential();
        self.motion = Motion::Sliding;
        self.halvings = 0;
        match settling {
            Some(settling) if !several => self.settling = Some(settling),
            _ if !sliding => self.begin_sliding(),
            _ => {}
        }
        true
    }

    /// Whether bouncing on `contact` has ended: it is pressed, and the next hop would be none (three of the four parts of
    /// the rest test, for the normal speed; the fourth tells sliding from resting).
    fn ends_bouncing(&mut self, contact: &Contact, pressed: f64) -> bool {
        self.counters.rest += 1;
        let c_r = self.plan.surfaces[contact.surface].material.restitution.coefficient();
        let thresholds = self.plan.rest.at(pressed.max(0.0));
        let still = self.state.velocity == Vector3::zeros();
        if contact.rate == 0.0 {
            return pressed > 0.0 || (still && pressed >= -thresholds.force);
        }
        let hop = contact.rate * contact.rate / (2.0 * pressed);
        let resolved = self.integrator.timestep().map_or(0.0, |h| least_hop(pressed, h));
        pressed > 0.0 && c_r < 1.0 && (contact.rate <= thresholds.speed || hop <= resolved)
    }

    /// The contacts as carriers.
    fn carriers(&self) -> Vec<Carrier> {
        self.contacts
            .iter()
            .map(|contact| Carrier {
                contact: *contact,
                bend: self.obstacles.bend(contact),
                friction: self.plan.surfaces[contact.surface].material.friction.in_contact(),
                radius: self.obstacles.radius_at(contact),
            })
            .collect()
    }

    /// Takes from the velocity what would leave or enter a lasting contact.
    fn make_tangential(&mut self) {
        let lasting: Vec<Vector3<f64>> = self.contacts.iter().filter(|c| c.lasting).map(|c| c.normal).collect();
        let v = self.state.velocity;
        self.state.velocity = match lasting[..] {
            [] => v,
            [n] => v - n * n.dot(&v),
            [a, b] => a.cross(&b).try_normalize(0.0).map_or(v, |t| t * t.dot(&v)),
            _ => Vector3::zeros(),
        };
    }

    fn set_flying(&mut self, was_sliding: bool) {
        self.motion = Motion::Flying;
        self.settling = None;
        let left = self.contacts.iter().find(|c| c.lasting).or(self.contacts.first()).copied();
        if was_sliding && let Some(contact) = left {
            self.tell(EventKind::Leave, &contact, self.state.velocity);
        }
        for contact in &mut self.contacts {
            contact.lasting = false;
        }
    }

    /// Tells that sliding begins; whether it begins with rest, the next pass finds out.
    fn begin_sliding(&mut self) {
        if !self.try_to_rest()
            && let Some(contact) = self.contacts.iter().find(|c| c.lasting).copied()
        {
            self.tell(EventKind::Slide, &contact, self.state.velocity);
        }
    }

    /// The four-part rest test: slow, in contact, pressed, and held by friction. A ball that passes it rests.
    fn try_to_rest(&mut self) -> bool {
        self.counters.rest += 1;
        let carriers: Vec<Carrier> = self.lasting_carriers();
        let still = State { velocity: Vector3::zeros(), ..self.state };
        let a = self.forces.acceleration(&still, &mut self.counters);
        let balance = Balance::of(&a, &carriers, &still);
        let Some((main, _)) = balance.loads.loads().max_by(|a, b| a.1.total_cmp(&b.1)).or(Some((0, 0.0))) else {
            return false;
        };
        let Some(carrier) = carriers.get(main) else { return false };
        let pressed = -carrier.contact.normal.dot(&a);
        let slow = self.state.velocity.norm() <= self.plan.rest.at(pressed.max(0.0)).speed || balance.sticks;
        if !(slow && balance.holds()) {
            return false;
        }
        let contact = carrier.contact;
        let velocity_in = std::mem::replace(&mut self.state.velocity, Vector3::zeros());
        self.motion = Motion::Resting;
        self.tell(EventKind::Rest, &contact, velocity_in);
        true
    }

    fn lasting_carriers(&self) -> Vec<Carrier> {
        self.carriers().into_iter().filter(|c| c.contact.lasting).collect()
    }

    /// One stretch of sliding: to a stop, over an edge, into another surface, or off.
    fn slide(&mut self) {
        if self.settling.is_none() && self.try_to_rest() {
            return;
        }
        let carriers = self.lasting_carriers();
        let a = self.forces.acceleration(&self.state, &mut self.counters);
        let balance = Balance::of(&a, &carriers, &self.state);
        if balance.loads.count() == 0 && self.settling.is_none() {
            self.set_flying(true);
            return;
        }
        if self.drop_unloaded(&balance) {
            return;
        }
        let remaining = self.clock.until(self.plan.duration);
        let Slide { step, stops } = match self.settling {
            None => {
                let slider = &mut self.slider;
                slide(slider, &self.forces, &self.state, &carriers, &balance, remaining, &mut self.counters)
            }
            // The hops are too low to see, and friction acts at their ends: a flight along the surface.
            Some(settling) => {
                self.counters.paths += 1;
                let seconds = settling.seconds.min(remaining);
                let step = crate::integrators::exact::step(&self.state, balance.free, seconds);
                Slide { step, stops: seconds == settling.seconds }
            }
        };
        let motion = if self.settling.is_some() { Motion::Flying } else { Motion::Sliding };
        let exit = self.exit(&step);
        let returns = self.obstacles.returns(&step, &self.contacts, &mut self.counters);
        let hit = self.obstacles.earliest(&step, &self.contacts, &returns, &mut self.counters);
        let hit = hit.filter(|hit| exit.is_none_or(|(f, ..)| hit.f < f));
        let to = hit.map(|hit| hit.f).or(exit.map(|(f, ..)| f)).unwrap_or(step.to);
        let whole = hit.is_none() && exit.is_none() && !stops && step.time(step.to) >= remaining;
        self.travel(&step, to, motion, whole.then_some(self.plan.duration));
        if to > 0.0 {
            self.leave_behind();
        }
        self.hold_to_surface();
        match (hit, exit) {
            (Some(hit), _) => {
                self.end_settling();
                self.arrive(&step, hit, &returns);
            }
            (None, Some((_, contact, bound))) => {
                self.end_settling();
                self.cross(contact, &bound);
            }
            (None, None) if self.settling.is_some() => {
                if stops {
                    self.end_settling();
                }
            }
            (None, None) if stops => self.state.velocity = Vector3::zeros(),
            (None, None) => {}
        }
    }

    /// Forgets what the ball touched where it was, but for what it moves along.
    fn leave_behind(&mut self) {
        self.contacts.retain(|c| c.lasting);
        if let Some(settling) = &mut self.settling {
            settling.contact = 0;
        }
    }

    /// Lets go of contacts that no longer carry; says whether there were any.
    fn drop_unloaded(&mut self, balance: &Balance) -> bool {
        if self.settling.is_some() {
            return false;
        }
        let mut loaded = [false; crate::contacts::MAX_CONTACTS];
        balance.loads.loads().for_each(|(i, _)| loaded[i] = true);
        let mut place = 0;
        let mut dropped = false;
        for contact in self.contacts.iter_mut().filter(|c| c.lasting) {
            if !loaded[place] {
                contact.lasting = false;
                dropped = true;
            }
            place += 1;
        }
        dropped
    }

    /// The impacts of the hops that were flown along the surface, all at once; then sliding begins.
    fn end_settling(&mut self) {
        if let Some(settling) = self.settling.take() {
            let contact = self.contacts[settling.contact];
            let material = &self.plan.surfaces[contact.surface].material;
            let c_r = material.restitution.coefficient();
            self.state.velocity = material.friction.slow_to_the_end(self.state.velocity, settling.closing, c_r);
            self.begin_sliding();
        }
    }

    /// Where the step first leaves the region of a lasting contact.
    fn exit(&mut self, step: &Step) -> Option<(f64, usize, RegionBound)> {
        let mut first: Option<(f64, usize, RegionBound)> = None;
        for (i, contact) in self.contacts.iter().enumerate().filter(|(_, c)| c.lasting) {
            if let Some((f, bound)) = self.obstacles.exit(step, contact, &mut self.counters)
                && first.is_none_or(|(best, ..)| f < best)
            {
                first = Some((f, i, bound));
            }
        }
        first
    }

    /// The neighbouring place takes over.
    fn cross(&mut self, contact: usize, bound: &RegionBound) {
        let contact = &mut self.contacts[contact];
        let foot = self.obstacles.mesh(contact.surface).and_then(|m| m.foot(bound.next, &self.state.position));
        if let Some((_, normal)) = foot {
            contact.site = Some(bound.next);
            contact.normal = normal;
        }
        if self.motion == Motion::Sliding {
            self.make_tangential();
        }
    }

    /// After moving along lasting contacts: the position on them, their normals where they are now, the velocity along them.
    fn hold_to_surface(&mut self) {
        let position = self.state.position;
        for contact in self.contacts.iter_mut().filter(|c| c.lasting) {
            let (Some(site), Some(mesh)) = (contact.site, self.obstacles.mesh(contact.surface)) else { continue };
            if let Some((_, normal)) = mesh.foot(site, &position).filter(|_| mesh.bend(site) != Bend::Flat) {
                contact.normal = normal;
            }
        }
        let lasting: Contacts = self.contacts.iter().filter(|c| c.lasting).copied().collect();
        for contact in &lasting {
            let slack = SLIDING_TOLERANCE * self.obstacles.radius_at(contact);
            self.correct(contact, self.touch_tolerance(0.0).max(slack));
        }
        self.make_tangential();
    }

    /// Rests to the end.
    fn rest(&mut self) {
        let end = self.plan.duration;
        let zero = Vector3::zeros();
        let step =
            crate::integrators::exact::step(&State { velocity: zero, ..self.state }, zero, self.clock.until(end));
        self.travel(&step, step.to, Motion::Resting, Some(end));
    }

    fn tell(&mut self, kind: EventKind, contact: &Contact, velocity_in: Vector3<f64>) {
        let numbered = self.plan.surfaces[contact.surface].numbered;
        self.events += 1;
        if self.events >= EVENT_BUDGET {
            self.ending = Some(Ending::EventBudget);
        }
        self.observer.event(&Event {
            time: self.clock.now(),
            kind,
            surface: contact.surface,
            face: contact.site.filter(|_| numbered).map(|site| site.face()),
            position: self.state.position,
            normal: contact.normal,
            velocity_in,
            velocity: self.state.velocity,
        });
    }
}
