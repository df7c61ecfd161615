//! Flying: one pass of the slides' loop, and the answer to what is hit.

use super::Walk;
use crate::body::State;
use crate::collision::{Hit, Returns};
use crate::contacts::{Contact, MAX_CONTACTS};
use crate::events::{Bound, Ending, EventKind, Motion};
use crate::integrators::Step;
use crate::observer::Observer;
use crate::response::{collapse, respond};
use crate::tolerance::{
    COLLAPSE_AFTER, clock_bound, impact_time_bound, merge_angle_squared, rate_rounding, touch_distance,
};
use carom_geometry::bounds::amax;
use carom_geometry::clearance::Entry;
use nalgebra::Vector3;

/// Which of the contacts of one instant close: a bit for each.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Closing(u8);

impl Closing {
    fn add(&mut self, i: usize) {
        self.0 |= 1 << i;
    }

    /// Whether contact number `i` does.
    pub(super) fn has(self, i: usize) -> bool {
        self.0 >> i & 1 == 1
    }
}

// A bit for each contact.
const _: () = assert!(MAX_CONTACTS <= u8::BITS as usize);

impl<O: Observer> Walk<'_, O> {
    /// One pass of the slides' loop.
    pub(super) fn fly(&mut self) {
        let end = self.step_end();
        let remaining = self.clock.until(end);
        let mut timestep = remaining;
        for _ in 0..self.halvings {
            timestep *= 0.5;
        }
        let rounding = || rate_rounding(self.state.velocity.norm());
        let tangential = self.integrator.timestep().is_some() && self.contacts.iter().any(|c| c.rate <= rounding());
        let step = self.integrator.step(&self.forces, &self.state, timestep, tangential, &mut self.counters);
        if self.is_unstable(&step) || self.diverges(&step) {
            return;
        }
        let mut returns = Returns::new();
        self.obstacles.returns(&step, self.contacts, &mut returns, &mut self.counters);
        let hit = self.obstacles.earliest(&step, self.contacts, &returns, &mut self.counters);
        match &hit {
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

    /// Whether a step of fixed length leaves the ball faster in the air than it can be, which ends its simulation: resistance takes from the speed v - w, and what does not
    /// change adds |a| h at most. (Euler's methods are stable up to k h / m = 2 with linear drag, Runge and Kutta's up to 2.785.)
    fn is_unstable(&mut self, step: &Step) -> bool {
        if self.integrator.timestep().is_none() || self.forces.are_constant() {
            return false;
        }
        // Of the effects that slow, all to one velocity; what else they are adds at most its own acceleration.
        let mut calm = None;
        let mut driven = self.forces.constant.norm();
        for flow in self.forces.flows {
            match flow.calms_to() {
                Some(to) => calm = Some(to),
                None => driven += flow.acceleration(&self.state, &self.forces.body).norm(),
            }
        }
        let Some(calm) = calm else { return false };
        let before = (self.state.velocity - calm).norm() + driven * step.time(step.to);
        let after = (step.end().velocity - calm).norm();
        // What is not a number is not stable either.
        let unstable = after.is_nan() || after > before + rate_rounding(before);
        if unstable {
            self.give_up(Ending::UnstableStep, EventKind::UnstableStep);
        }
        unstable
    }

    /// At the start: what the ball lies on or moves along, as nearly as its position tells, it is in contact with.
    pub(super) fn begin(&mut self) {
        let tolerance = self.touch_tolerance(0.0);
        if self.plan.radius_at_meshes(self.forces.ball) > self.forces.ball.radius() && !self.plan.meshes.is_empty() {
            let a = self.forces.acceleration(&self.state, &mut self.counters);
            self.state.position = self.obstacles.clear_of_faces(&self.state, &a, tolerance, &mut self.counters);
        }
        let State { position, velocity } = self.state;
        self.obstacles.touching(&self.state, tolerance, None, self.contacts, &mut self.counters);
        let rounding = rate_rounding(velocity.norm());
        self.contacts.retain(|c| {
            let gap = self.obstacles.gap(c, &position);
            c.rate.abs() <= rounding && gap.is_some_and(|gap| gap.abs() <= tolerance)
        });
        if self.contacts.is_empty() {
            return;
        }
        for i in 0..self.contacts.len() {
            self.contacts[i].rate = 0.0;
            self.correct(i, tolerance);
        }
        self.bound = Some(Bound { time: 0.0, position: tolerance });
        self.settle(None);
    }

    /// At a collision: what is touched, how fast, and the answer.
    pub(super) fn arrive(&mut self, step: &Step, hit: &Hit, returns: &Returns) {
        let tolerance = self.touch_tolerance(step.path.reach(hit.f)).max(self.obstacles.doubt(step, hit));
        std::mem::swap(&mut self.contacts, &mut self.before);
        let State { position, velocity } = self.state;
        // What slides is put back onto its surface, and is then elsewhere; and only of meshes it matters where.
        let f = (!self.plan.meshes.is_empty() && position == step.path.at(hit.f)).then_some(hit.f);
        self.obstacles.touching(&self.state, tolerance, f, self.contacts, &mut self.counters);
        for i in 0..self.contacts.len() {
            self.correct(i, tolerance);
            self.contacts[i].rate = self.rate(step, hit, &self.contacts[i], returns);
        }
        if self.standstill > 0 && self.contacts.iter().all(|c| c.rate >= 0.0) {
            self.add_seen(hit, &velocity);
        }
        if self.observer.looks_at_events() {
            self.bound = self.bound(step, hit, tolerance);
        }
        let collapses = self.standstill > 0 && self.collapses(tolerance);
        let carrier = self.before.iter().find(|b| b.lasting).copied();
        let mut closing = Closing::default();
        for (i, contact) in self.contacts.iter().enumerate().filter(|(_, c)| c.rate < 0.0) {
            if closing == Closing::default() && step.exact {
                // The normal speed is known better from the clearance than from the velocity.
                let n = contact.normal;
                self.state.velocity += n * (contact.rate - n.dot(&self.state.velocity));
            }
            closing.add(i);
        }
        let answered = closing != Closing::default();
        if answered {
            let surfaces = self.surfaces;
            let velocity_in = self.state.velocity;
            self.state.velocity = if collapses {
                collapse(velocity_in, self.contacts)
            } else {
                respond(velocity_in, self.contacts, |c| &surfaces[c.surface].material, &mut self.counters)
            };
            if self.spins && !collapses {
                self.grip(velocity_in, closing);
            }
            self.counters.impacts += 1;
            self.halvings = 0;
            for i in (0..self.contacts.len()).filter(|i| closing.has(*i)) {
                let contact = self.contacts[i];
                self.tell(EventKind::Impact, &contact, velocity_in);
            }
        }
        if carrier.is_some() {
            let carried =
                |c: &Contact| self.before.iter().any(|b| b.lasting && b.surface == c.surface && b.site == c.site);
            self.contacts.iter_mut().for_each(|c| c.lasting = carried(c) && c.rate == 0.0);
        }
        let carried = self.settle(carrier.as_ref());
        if !answered && !carried && (hit.f == 0.0 || !step.exact) {
            // The path closes where the ball does not: the hop is too short for this step.
            self.halvings += 1;
            self.counters.halvings += 1;
        }
    }

    /// Where no time passes and all contacts are left, adds what the search that found `hit` has seen.
    ///
    /// What is nearest to the ball is left by less than rounding: the search has seen its neighbour, to which the ball comes nearer (the vertex at the end of an
    /// edge, the face beyond a shallow fold). Either is touched; the one that closes is answered, or it would be found for ever.
    #[inline(never)] // it is seldom asked
    fn add_seen(&mut self, hit: &Hit, velocity: &Vector3<f64>) {
        let place = |c: &Contact| (c.surface, c.site);
        let seen = self.obstacles.seen(hit, &self.state.position, velocity);
        if let Some(seen) = seen.filter(|seen| self.contacts.iter().all(|c| place(c) != place(seen)))
            && self.contacts.len() < MAX_CONTACTS
        {
            self.contacts.push(seen);
            self.contacts.sort_by(|a, b| self.obstacles.order(a, b));
        }
    }

    /// How far the time and the place of `hit` may be off, with contact found to `tolerance` (m); none if nothing closes there.
    fn bound(&self, step: &Step, hit: &Hit, tolerance: f64) -> Option<Bound> {
        let doubt = tolerance.max(touch_distance(self.plan.farthest, step.path.reach(hit.f)));
        let velocity = step.path.derivative(hit.f) / step.seconds;
        let acceleration = step.path.second_derivative(hit.f) / (step.seconds * step.seconds);
        let time = |c: &Contact| {
            let across = self.obstacles.bend(c).across(&velocity).norm_squared() / self.obstacles.radius_at(c);
            let bend = c.normal.dot(&acceleration).abs() + if across > 0.0 { across } else { 0.0 };
            impact_time_bound(doubt, -c.rate, bend)
        };
        let closing = self.contacts.iter().filter(|c| c.rate < 0.0 && c.surface == hit.surface);
        Some(self.bound_of(&velocity, closing.map(time).reduce(f64::max)?, doubt))
    }

    /// What happens now while the ball moves with `velocity`, if its time is known to `seconds` and its place, at any time, to `doubt` (m).
    pub(super) fn bound_of(&self, velocity: &Vector3<f64>, seconds: f64, doubt: f64) -> Bound {
        let now = self.clock.now();
        let time = seconds.min(now) + clock_bound(now);
        Bound { time, position: doubt + velocity.norm() * time }
    }

    /// Whether contacts that lose energy have answered each other without time passing for so long that there is no end to it; then
    /// the contacts are all that took part.
    #[inline(never)] // it is seldom asked
    fn collapses(&mut self, tolerance: f64) -> bool {
        let place = |c: &Contact| (c.surface, c.site);
        for c in self.contacts.iter() {
            if self.answered.len() < MAX_CONTACTS && self.answered.iter().all(|a| place(a) != place(c)) {
                self.answered.push(*c);
            }
        }
        let loses = |c: &Contact| self.surfaces[c.surface].material.restitution.coefficient() < 1.0;
        if self.standstill < COLLAPSE_AFTER || !self.answered.iter().any(loses) {
            return false;
        }
        let radius = self.plan.radius_at_meshes(self.forces.ball);
        for a in &self.answered {
            // Of what two faces of one plane answered, once.
            let apart = |c: &Contact| (a.normal - c.normal).norm_squared() > merge_angle_squared(tolerance, radius);
            if self.contacts.len() < MAX_CONTACTS && self.contacts.iter().all(|c| place(a) != place(c) && apart(c)) {
                self.contacts.push(Contact { rate: a.normal.dot(&self.state.velocity), lasting: false, ..*a });
            }
        }
        self.contacts.sort_by(|a, b| self.obstacles.order(a, b));
        true
    }

    /// What counts as touching here.
    pub(super) fn touch_tolerance(&self, travelled: f64) -> f64 {
        let here = amax(&self.state.position.coords).max(self.forces.ball.radius());
        // Contact with a face is found to the rounding of its corners as well; planes have none.
        let corners = if self.plan.meshes.is_empty() { 0.0 } else { self.plan.farthest };
        touch_distance(here + corners, travelled)
    }

    /// Puts the centre back onto the surface of contact number `i`, within the rounding bound of its position (R15: explicit, bounded, counted).
    pub(super) fn correct(&mut self, i: usize, tolerance: f64) {
        let contact = &self.contacts[i];
        if let Some(gap) = self.obstacles.gap(contact, &self.state.position)
            && gap != 0.0
            && gap.abs() <= tolerance
        {
            self.state.position -= contact.normal * gap;
            self.counters.corrections += 1;
        }
    }

    /// The rate of change of a contact's clearance on arrival: from the clearance itself where it was solved, else n.v.
    fn rate(&self, step: &Step, hit: &Hit, contact: &Contact, returns: &Returns) -> f64 {
        let known =
            self.before.iter().zip(returns).find(|(b, _)| b.surface == contact.surface && b.normal == contact.normal);
        if let Some((b, known)) = known {
            match *known {
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
}
