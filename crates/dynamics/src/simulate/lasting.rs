//! Lasting contact: when bouncing ends, sliding from place to place, and rest.

use super::{Settling, Walk};
use crate::body::State;
use crate::contacts::{Contact, Contacts, MAX_CONTACTS};
use crate::effects::friction::ContactFriction;
use crate::events::{EventKind, Motion};
use crate::integrators::{Step, exact};
use crate::observer::Observer;
use crate::response::changed_rate;
use crate::sliding::{Balance, Carrier, Slide, is_lifted, slide, tangential};
use crate::tolerance::{PATIENCE, PATIENCE_WITH_HOPS, SLIDING_TOLERANCE, least_hop, rate_rounding, time_resolution};
use carom_geometry::rounding::position_bound;
use carom_geometry::site::{Bend, RegionBound, Site};
use nalgebra::Vector3;

/// Faces of one plane that a stretch of sliding crosses before it is cut after all.
const MAX_CROSSINGS: usize = 4096;

impl<O: Observer> Walk<'_, O> {
    /// What the ball makes of its contacts: it flies on, goes on bouncing, or settles. Says whether something carries it.
    pub(super) fn settle(&mut self) -> bool {
        let sliding = self.motion == Motion::Sliding;
        let a = self.forces.acceleration(&self.state, &mut self.counters);
        let carriers = self.carriers();
        let mut carrying = [false; MAX_CONTACTS];
        let mut settling = None;
        // A contact may press the ball into another that its weight alone would not press it into: asked again, until no other carries.
        let mut free = a;
        let mut more = true;
        while std::mem::take(&mut more) {
            for (i, carrier) in carriers.iter().enumerate() {
                if carrying[i] {
                    continue;
                }
                let contact = &carrier.contact;
                let pressed = -contact.normal.dot(&free) - carrier.centripetal(&self.state.velocity);
                carrying[i] = self.ends_bouncing(contact, pressed);
                more |= carrying[i];
                let c_r = self.surfaces[contact.surface].material.restitution.coefficient();
                if carrying[i] && contact.rate > 0.0 && c_r < 1.0 {
                    // Around an edge the way along the surface is no flight: there the hops end at once.
                    let flat = carrier.bend == Bend::Flat;
                    let seconds = if flat { 2.0 * contact.rate / (pressed * (1.0 - c_r)) } else { 0.0 };
                    settling = Some(Settling { seconds, closing: contact.rate, contact: i });
                }
            }
            let held: Vec<Carrier> = carriers.iter().zip(&carrying).filter(|(_, c)| **c).map(|(c, _)| *c).collect();
            free = Balance::of(&a, &held, &self.state).free;
        }
        if settling.is_some() && self.drives_into_others(&carrying) {
            // What hops is not held down where that would press the ball into something else: it flies the hop.
            settling = None;
            for (contact, carrying) in self.contacts.iter().zip(&mut carrying) {
                *carrying &= contact.rate <= 0.0;
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
        let before = self.state.velocity;
        self.make_tangential();
        for contact in self.contacts.iter_mut().filter(|c| !c.lasting) {
            contact.rate = changed_rate(contact, &before, &self.state.velocity);
        }
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
        // What loses nothing bounces for ever. The air takes from each hop; an elastic surface with
        // friction loses in a corner, without end.
        let material = &self.surfaces[contact.surface].material;
        let smooth = material.friction.in_contact() == ContactFriction::Sliding(0.0);
        let in_air = !self.forces.are_constant();
        let loses = material.restitution.coefficient() < 1.0 || !smooth || in_air || self.standstill > PATIENCE;
        let thresholds = self.plan.rest.at(pressed.max(0.0));
        let still = self.state.velocity == Vector3::zeros();
        if contact.rate == 0.0 {
            return pressed > 0.0 || (still && pressed >= -thresholds.force);
        }
        let hop = contact.rate * contact.rate / (2.0 * pressed);
        let resolved = self.integrator.timestep().map_or(0.0, |h| least_hop(pressed, h));
        let hidden = hop <= position_bound(self.plan.farthest.max(self.state.position.coords.amax()));
        // Nor does one go on whose hops the clock has not resolved for long: what is left of them has a closed form.
        let brief =
            self.standstill >= PATIENCE_WITH_HOPS && 2.0 * contact.rate <= pressed * time_resolution(self.clock.now());
        let over = contact.rate <= thresholds.speed || hop <= resolved;
        pressed > 0.0 && ((over && (loses || hidden)) || (brief && loses))
    }

    /// The contacts as carriers.
    fn carriers(&self) -> Vec<Carrier> {
        self.contacts
            .iter()
            .map(|contact| Carrier {
                contact: *contact,
                bend: self.obstacles.bend(contact),
                friction: self.surfaces[contact.surface].material.friction.in_contact(),
                radius: self.obstacles.radius_at(contact),
            })
            .collect()
    }

    /// Whether taking the ball along the contacts that carry would drive it into one that does not.
    fn drives_into_others(&self, carrying: &[bool]) -> bool {
        let contacts = || self.contacts.iter().zip(carrying);
        let held: Vec<_> = contacts().filter(|(_, carrying)| **carrying).map(|(c, _)| c.normal).collect();
        let v = along(&held, self.state.velocity);
        let rounding = rate_rounding(self.state.velocity.norm());
        contacts().any(|(c, carrying)| !carrying && c.normal.dot(&v) < -rounding)
    }

    /// Takes from the velocity what would leave or enter a lasting contact.
    fn make_tangential(&mut self) {
        let lasting: Vec<Vector3<f64>> = self.contacts.iter().filter(|c| c.lasting).map(|c| c.normal).collect();
        self.state.velocity = along(&lasting, self.state.velocity);
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
    pub(super) fn slide(&mut self) {
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
        if self.settling.is_none() && self.turns_round(&balance) {
            self.state.velocity = Vector3::zeros();
            self.contacts.iter_mut().for_each(|c| c.rate = 0.0);
        }
        let remaining = self.clock.until(self.plan.duration);
        let Slide { mut step, stops } = match self.settling {
            None => {
                let slider = &mut self.slider;
                slide(slider, &self.forces, &self.state, &carriers, &balance, remaining, &mut self.counters)
            }
            // The hops are too low to see, and friction acts at their ends: a flight along the surface.
            Some(settling) => {
                self.counters.paths += 1;
                let seconds = settling.seconds.min(remaining);
                let step = exact::step(&self.state, balance.free, seconds);
                Slide { step, stops: seconds == settling.seconds }
            }
        };
        if self.diverges(&step) {
            return;
        }
        let motion = if self.settling.is_some() { Motion::Flying } else { Motion::Sliding };
        let off = self.settling.is_none().then(|| self.lift_off(&step, &carriers)).flatten();
        step.to = off.unwrap_or(step.to);
        let mut crossings = Vec::new();
        let exit = self.exit(&step, &mut crossings);
        let returns = self.obstacles.returns(&step, &self.contacts, &mut self.counters);
        let hit = self.obstacles.earliest(&step, &self.contacts, &returns, &mut self.counters);
        let hit = hit.filter(|hit| exit.is_none_or(|(f, ..)| hit.f < f));
        let to = hit.map(|hit| hit.f).or(exit.map(|(f, ..)| f)).unwrap_or(step.to);
        let whole = hit.is_none() && exit.is_none() && off.is_none() && !stops && step.time(step.to) >= remaining;
        self.travel(&step, to, motion, whole.then_some(self.plan.duration));
        self.cross_level(&crossings, to);
        if to > 0.0 {
            self.leave_behind();
        }
        self.hold_to_surface();
        match (hit, exit) {
            (Some(hit), _) => {
                // Friction at the end of a settling changes the velocity: the path no longer tells it.
                let step = Step { exact: step.exact && self.settling.is_none(), ..step };
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
            (None, None) if off.is_some() => self.set_flying(true),
            (None, None) if stops => self.state.velocity = Vector3::zeros(),
            (None, None) => {}
        }
    }

    /// Whether a ball that friction cannot hold is so slow that it stands, before it sets out the other way.
    fn turns_round(&self, balance: &Balance) -> bool {
        let v = self.state.velocity;
        let load: f64 = balance.loads.loads().map(|(_, load)| load).sum();
        balance.friction > 0.0 && balance.free.dot(&v) < 0.0 && v.norm() <= self.plan.rest.at(load).speed
    }

    /// Where in `step` the last of `carriers` stops carrying: the ball leaves an edge too fast for its curve, or the air lifts it.
    fn lift_off(&mut self, step: &Step, carriers: &[Carrier]) -> Option<f64> {
        if self.forces.are_constant() && carriers.iter().all(|c| c.bend == Bend::Flat) {
            return None;
        }
        let mut lifted = |f: f64| {
            let state = tangential(&step.at(f), carriers);
            is_lifted(&self.forces.acceleration(&state, &mut self.counters), carriers, &state)
        };
        if !lifted(step.to) {
            return None;
        }
        let (mut on, mut off) = (0.0, step.to);
        loop {
            let middle = 0.5 * (on + off);
            if middle <= on || middle >= off {
                return Some(off);
            }
            if lifted(middle) { off = middle } else { on = middle }
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
        let mut loaded = [false; MAX_CONTACTS];
        balance.loads.loads().for_each(|(i, _)| loaded[i] = true);
        let mut dropped = false;
        for (place, contact) in self.contacts.iter_mut().filter(|c| c.lasting).enumerate() {
            if !loaded[place] {
                contact.lasting = false;
                dropped = true;
            }
        }
        dropped
    }

    /// The impacts of the hops that were flown along the surface, all at once; then sliding begins.
    fn end_settling(&mut self) {
        if let Some(settling) = self.settling.take() {
            let contact = self.contacts[settling.contact];
            let material = &self.surfaces[contact.surface].material;
            let c_r = material.restitution.coefficient();
            self.state.velocity = material.friction.slow_to_the_end(self.state.velocity, settling.closing, c_r);
            self.begin_sliding();
        }
    }

    /// Where the step first leaves the region of a lasting contact, and which of the lasting ones that is; on the way, `crossings`
    /// notes the faces of the same plane that it comes to: they cut no path, so that a plane is one however it is cut into triangles.
    fn exit(&mut self, step: &Step, crossings: &mut Vec<(f64, usize, Site)>) -> Option<(f64, usize, RegionBound)> {
        let mut first: Option<(f64, usize, RegionBound)> = None;
        for (i, contact) in self.contacts.iter().filter(|c| c.lasting).enumerate() {
            let mut contact = *contact;
            let mut from = 0.0;
            let mut exit = self.obstacles.exit(step, &contact, from, &mut self.counters);
            while let Some((f, bound)) = exit
                && crossings.len() < MAX_CROSSINGS
                && self.obstacles.continues(&contact, bound.next)
            {
                crossings.push((f, i, bound.next));
                contact.site = Some(bound.next);
                from = f;
                exit = self.obstacles.exit(step, &contact, from, &mut self.counters);
            }
            if let Some((f, bound)) = exit
                && first.is_none_or(|(best, ..)| f < best)
            {
                first = Some((f, i, bound));
            }
        }
        first
    }

    /// Comes to the faces of the same plane that lie on the way to `to`.
    fn cross_level(&mut self, crossings: &[(f64, usize, Site)], to: f64) {
        for (_, i, site) in crossings.iter().filter(|(f, ..)| *f <= to) {
            if let Some(contact) = self.contacts.iter_mut().filter(|c| c.lasting).nth(*i) {
                contact.site = Some(*site);
            }
        }
    }

    /// The neighbouring place takes over.
    fn cross(&mut self, contact: usize, bound: &RegionBound) {
        let Some(contact) = self.contacts.iter_mut().filter(|c| c.lasting).nth(contact) else { return };
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
}

/// The part of `v` along all planes with these normals.
fn along(normals: &[Vector3<f64>], v: Vector3<f64>) -> Vector3<f64> {
    match normals {
        [] => v,
        [n] => v - n * n.dot(&v),
        [a, b] => a.cross(b).try_normalize(0.0).map_or(v, |t| t * t.dot(&v)),
        _ => Vector3::zeros(),
    }
}
