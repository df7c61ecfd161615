//! Lasting contact: sliding from place to place, and rest.

use super::Walk;
use crate::body::State;
use crate::collision::{Hit, Returns};
use crate::contacts::{Contact, Contacts, PerContact};
use crate::events::{Bound, EventKind, Motion};
use crate::integrators::{Step, exact};
use crate::observer::Observer;
use crate::response::changed_rate;
use crate::sliding::{Balance, Carrier, Slide, is_lifted, slide, tangential};
use crate::support::along;
use crate::tolerance::{
    RestThresholds, SLIDING_TOLERANCE, impact_time_bound, parallel, rate_rounding, stretch_bound, touch_distance,
};
use carom_geometry::site::{Bend, RegionBound, Site};
use nalgebra::Vector3;

/// Faces of one plane that a stretch of sliding crosses before it is cut after all.
const MAX_CROSSINGS: usize = 4096;

/// The carrier that is pressed most, or the first if none is.
fn main_carrier<'a>(carriers: &'a [Carrier], balance: &Balance) -> Option<&'a Carrier> {
    let main = balance.loads.loads().max_by(|a, b| a.1.total_cmp(&b.1));
    carriers.get(main.map_or(0, |(main, _)| main))
}

impl<O: Observer> Walk<'_, O> {
    /// The contacts as carriers.
    pub(super) fn carriers(&self) -> PerContact<Carrier> {
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

    /// Takes from the velocity what would leave or enter a lasting contact; the others learn what that changes.
    pub(super) fn make_tangential(&mut self) {
        let lasting: PerContact<Vector3<f64>> = self.contacts.iter().filter(|c| c.lasting).map(|c| c.normal).collect();
        let before = self.state.velocity;
        self.state.velocity = along(&lasting, before);
        for contact in self.contacts.iter_mut().filter(|c| !c.lasting) {
            contact.rate = changed_rate(contact, &before, &self.state.velocity);
        }
    }

    /// Takes off from `left`, which carried it so far, if anything did.
    pub(super) fn set_flying(&mut self, left: Option<&Contact>) {
        self.motion = Motion::Flying;
        self.settling = None;
        self.rolls = false;
        // What carried it is what lasted, if anything did.
        if let Some(contact) = left {
            self.tell(EventKind::Leave, contact, self.state.velocity);
            self.contacts.iter_mut().for_each(|contact| contact.lasting = false);
        }
    }

    /// Tells that sliding begins, or rest; `velocity_in` is the velocity before what ended the bouncing.
    pub(super) fn begin_sliding(&mut self, velocity_in: Vector3<f64>) {
        if !self.try_to_rest(velocity_in)
            && let Some(contact) = self.contacts.iter().find(|c| c.lasting).copied()
        {
            self.tell(EventKind::Slide, &contact, velocity_in);
        }
    }

    /// The four-part rest test: slow, in contact, pressed, and held by friction. A ball that passes it rests.
    fn try_to_rest(&mut self, velocity_in: Vector3<f64>) -> bool {
        self.counters.rest += 1;
        let carriers = self.lasting_carriers();
        let still = State { velocity: Vector3::zeros(), ..self.state };
        let a = self.forces.acceleration(&still, &mut self.counters);
        let balance = Balance::of(&a, &carriers, &still);
        let Some(carrier) = main_carrier(&carriers, &balance) else { return false };
        let threshold = self.slowest(carrier, &a);
        let slow = self.state.velocity.norm() <= threshold || balance.sticks;
        if !(slow && balance.holds()) || (self.spins && self.turns_on(&carriers, threshold)) {
            return false;
        }
        let contact = carrier.contact;
        self.state.velocity = Vector3::zeros();
        self.motion = Motion::Resting;
        if self.spins {
            self.stop_turning(&contact);
        }
        self.tell(EventKind::Rest, &contact, velocity_in);
        true
    }

    /// The speed in m/s up to which a ball with the acceleration `a`, carried by `main` above all, stands.
    fn slowest(&self, main: &Carrier, a: &Vector3<f64>) -> f64 {
        self.plan.rest.at((-main.contact.normal.dot(a)).max(0.0)).speed
    }

    fn lasting_carriers(&self) -> PerContact<Carrier> {
        self.carriers().into_iter().filter(|c| c.contact.lasting).collect()
    }

    /// One stretch of sliding: to a stop, over an edge, into another surface, or off.
    pub(super) fn slide(&mut self) {
        let carriers = self.lasting_carriers();
        let a = self.forces.acceleration(&self.state, &mut self.counters);
        let mut balance = Balance::of(&a, &carriers, &self.state);
        let follows = self.spins && self.settling.is_none();
        self.slip = if follows { self.slipping(&carriers, &balance) } else { None };
        let rolls = follows && self.slip.is_none() && self.is_gripped(&carriers);
        let forces = if rolls { self.forces.of_rolling() } else { self.forces };
        if rolls {
            balance = Balance::of(&forces.acceleration(&self.state, &mut self.counters), &carriers, &self.state);
        }
        let slips = self.slip.is_some();
        let stopping = if slips { None } else { self.time_to_stop(&carriers, &balance) };
        if self.settling.is_none() && !slips && stopping.is_none() && self.try_to_rest(self.state.velocity) {
            return;
        }
        let flat = carriers.iter().all(|c| c.bend == Bend::Flat);
        let lifted = balance.loads.count() == 0 && (flat || is_lifted(&a, &carriers, &self.state));
        if lifted && self.settling.is_none() {
            self.set_flying(carriers.first().map(|c| &c.contact));
            return;
        }
        if self.drop_unloaded(&a, &carriers, &balance) {
            return;
        }
        self.begin_rolling(rolls);
        if self.settling.is_none() && !slips && self.turns_round(&a, &carriers, &balance) {
            self.state.velocity = Vector3::zeros();
            self.contacts.iter_mut().for_each(|c| c.rate = 0.0);
        }
        let remaining = self.clock.until(self.plan.duration);
        let last = stopping.and_then(|seconds| self.last_stretch(seconds));
        let Slide { mut step, stops } = match (self.slip, self.settling, last) {
            (Some(slip), ..) => self.slip(&slip, &carriers, remaining),
            (None, Some(settling), _) => self.settling_flight(&settling, &carriers, &balance),
            (None, None, Some(last)) => last,
            (None, None, None) => {
                let slider = if flat { &mut self.slider } else { &mut self.roller };
                slide(slider, &forces, &self.state, &carriers, &balance, remaining, &mut self.counters)
            }
        };
        if self.diverges(&step) {
            return;
        }
        let motion = match self.settling {
            Some(_) => Motion::Flying,
            None if rolls => Motion::Rolling,
            None => Motion::Sliding,
        };
        let off = self.settling.is_none().then(|| self.lift_off(&step, &carriers)).flatten();
        step.to = off.unwrap_or(step.to);
        let mut crossings = Vec::new();
        let exit = self.exit(&step, &mut crossings);
        let mut returns = Returns::new();
        self.obstacles.returns(&step, self.contacts, &mut returns, &mut self.counters);
        let hit = self.obstacles.earliest(&step, self.contacts, &returns, &mut self.counters);
        let hit = hit.filter(|hit| exit.is_none_or(|(f, ..)| hit.f < f));
        let to = hit.map(|hit| hit.f).or(exit.map(|(f, ..)| f)).unwrap_or(step.to);
        let whole = hit.is_none() && exit.is_none() && off.is_none() && !stops && step.time(step.to) >= remaining;
        self.travel(&step, to, motion, whole.then_some(self.plan.duration));
        self.bound = self.bound_of_slide(&step, to, exit.as_ref().filter(|_| hit.is_none()).map(|(.., bound)| bound));
        if let Some(settling) = &mut self.settling {
            settling.seconds -= step.time(to);
        }
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
                self.arrive(&step, &hit, &returns);
            }
            (None, Some((f, contact, bound))) => {
                let step = Step { exact: step.exact && self.settling.is_none(), ..step };
                self.end_settling();
                match self.face_that_rises(contact, bound.next) {
                    Some((surface, face)) => {
                        self.arrive(&step, &Hit { f, surface, face: Some(face), rate: None }, &returns)
                    }
                    None => self.cross(contact, &bound),
                }
            }
            (None, None) if self.settling.is_some() => {
                if stops {
                    self.end_settling();
                }
            }
            (None, None) if off.is_some() => {
                let left = self.contacts.iter().find(|c| c.lasting).copied();
                self.set_flying(left.as_ref());
            }
            (None, None) if stops => self.state.velocity = Vector3::zeros(),
            (None, None) => {}
        }
    }

    /// How far the end of a stretch of `step` to `to` may be off: where it leaves a place by `exit`, or where what it does has come to its end in a
    /// time that is known as a quotient. None where it is the end of an integrated step, at which a threshold may be passed, or of an integrated lift.
    fn bound_of_slide(&self, step: &Step, to: f64, exit: Option<&RegionBound>) -> Option<Bound> {
        let doubt =
            self.touch_tolerance(step.path.reach(to)).max(touch_distance(self.plan.farthest, step.path.reach(to)));
        let velocity = step.path.derivative(to) / step.seconds;
        let seconds = match exit {
            Some(bound) => {
                let acceleration = step.path.second_derivative(to) / (step.seconds * step.seconds);
                let bend = bound.outward.dot(&acceleration).abs();
                impact_time_bound(doubt, bound.outward.dot(&velocity), bend)
            }
            None if step.exact => stretch_bound(step.time(to)),
            None => return None,
        };
        Some(self.bound_of(&velocity, seconds, doubt))
    }

    /// In how many seconds friction will have stopped a ball that turns as it slides, if it is known: where the rest test has a speed of its
    /// own, that decides.
    fn time_to_stop(&self, carriers: &[Carrier], balance: &Balance) -> Option<f64> {
        let is_plain = self.forces.are_constant() && carriers.iter().all(|c| c.bend == Bend::Flat);
        let turns = !parallel(&balance.free, &self.state.velocity);
        let by_length = matches!(self.plan.rest, RestThresholds::Length(_));
        (is_plain && turns && by_length).then(|| balance.time_to_stop(&self.state.velocity)).flatten()
    }

    /// The last `seconds` of sliding, where the way is too short for its turning to be seen.
    fn last_stretch(&mut self, seconds: f64) -> Option<Slide> {
        let v = self.state.velocity;
        let way = 0.5 * v.norm() * seconds;
        if way > self.plan.rest.at(0.0).distance || seconds > self.clock.until(self.plan.duration) {
            return None;
        }
        self.counters.paths += 1;
        Some(Slide { step: exact::step(&self.state, -v / seconds, seconds), stops: true })
    }

    /// Whether a ball that friction cannot hold is so slow that it stands, before it sets out the other way: at the speed of the rest test, so that
    /// what is held has come to rest by then, or slides on until it has.
    fn turns_round(&self, a: &Vector3<f64>, carriers: &[Carrier], balance: &Balance) -> bool {
        let v = self.state.velocity;
        let slowest = main_carrier(carriers, balance).map_or(0.0, |main| self.slowest(main, a));
        balance.friction > 0.0 && !balance.holds() && balance.free.dot(&v) < 0.0 && v.norm() <= slowest
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

    /// Lets go of contacts that the ball accelerates away from; says whether there were any. Of more than two, those go as well that carry nothing,
    /// or they would hold a ball that the others let move.
    fn drop_unloaded(&mut self, a: &Vector3<f64>, carriers: &[Carrier], balance: &Balance) -> bool {
        if self.settling.is_some() {
            return false;
        }
        let State { position, velocity } = self.state;
        let mut dropped = false;
        for (i, contact) in self.contacts.iter_mut().filter(|c| c.lasting).enumerate() {
            let lift = contact.normal.dot(&balance.free) + carriers[i].centripetal(&velocity);
            if !balance.loads.loads().any(|(loaded, _)| loaded == i)
                && (carriers.len() > 2 || lift > carriers[i].neutral(a, &position))
            {
                contact.lasting = false;
                dropped = true;
            }
        }
        dropped
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

    /// A face that closes in on the ball where it comes to `next` from the lasting contact numbered `contact`: in a hollow, the next face is touched
    /// before the edge is reached, but by less than rounding where the ball is small.
    fn face_that_rises(&mut self, contact: usize, next: Site) -> Option<(usize, u32)> {
        let contact = *self.contacts.iter().filter(|c| c.lasting).nth(contact)?;
        if let Site::Edge { face, edge } = next
            && !self.obstacles.is_hollow(&contact, face, edge)
        {
            return None;
        }
        let tolerance = self.touch_tolerance(0.0);
        let mut touched = Contacts::new();
        self.obstacles.touching(&self.state, tolerance, None, &mut touched, &mut self.counters);
        let rounding = rate_rounding(self.state.velocity.norm());
        let rises = |c: &&Contact| c.surface == contact.surface && c.site != contact.site && c.rate < -rounding;
        touched.iter().find(rises).and_then(|c| Some((c.surface, c.site?.face())))
    }

    /// The neighbouring place takes over.
    fn cross(&mut self, contact: usize, bound: &RegionBound) {
        let Some(contact) = self.contacts.iter_mut().filter(|c| c.lasting).nth(contact) else { return };
        // From a face to its border the normal is the same, and known better than from where the ball is; a ball on the border itself has no other.
        let keeps =
            matches!((contact.site, bound.next), (Some(Site::Face(_)), Site::Edge { .. } | Site::Vertex { .. }));
        let mesh = self.obstacles.mesh(contact.surface);
        let turned = || mesh.and_then(|m| m.foot(bound.next, &self.state.position)).map(|(_, normal)| normal);
        if let Some(normal) = if keeps { Some(contact.normal) } else { turned() } {
            (contact.normal, contact.site) = (normal, Some(bound.next));
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
        for i in 0..self.contacts.len() {
            if self.contacts[i].lasting {
                let slack = SLIDING_TOLERANCE * self.obstacles.radius_at(&self.contacts[i]);
                self.correct(i, self.touch_tolerance(0.0).max(slack));
            }
        }
        self.make_tangential();
    }
}
