//! The end of bouncing: which contacts hold the ball, and the last hops, summed.

use super::{Settling, Walk};
use crate::body::State;
use crate::contacts::{Contact, MAX_CONTACTS, PerContact};
use crate::effects::friction::{ContactFriction, Friction};
use crate::events::Motion;
use crate::integrators::exact;
use crate::observer::Observer;
use crate::response::changed_rate;
use crate::sliding::{Balance, Carrier, Slide};
use crate::support::along;
use crate::tolerance::{
    PATIENCE, PATIENCE_WITH_HOPS, PATIENCE_WITH_LOW_HOPS, RestThresholds, least_hop, rate_rounding, time_resolution,
};
use carom_geometry::rounding::position_bound;
use carom_geometry::site::Bend;
use nalgebra::Vector3;

/// What a ball would do next on a contact.
#[derive(Debug, Clone, Copy)]
struct Hop {
    /// How fast it leaves, in m/s.
    rate: f64,
    /// How strongly it is pressed, in m/s^2.
    pressed: f64,
    /// How much of that may be rounding, where it matters: beside a contact that is held, and around an edge, in m/s^2.
    neutral: f64,
}

/// Which hops are low under an acceleration; for most balls it is always the same.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lowness {
    /// The speed in m/s of a hop that is low, however it is pressed.
    low: f64,
    /// A speed in m/s at which bouncing does not end, however it is pressed: what presses it is not more than all of the acceleration.
    fast: f64,
}

impl Lowness {
    /// Under the acceleration `a` in m/s^2.
    pub(super) fn under(a: &Vector3<f64>, rest: &RestThresholds) -> Self {
        let most = a.norm();
        Self { low: rest.low_hop(most), fast: rest.at(2.0 * most).speed }
    }
}

impl<O: Observer> Walk<'_, O> {
    /// What the ball makes of its contacts: it flies on, goes on bouncing, or settles; `left` is what carried it so far, if anything
    /// did. Says whether something carries it.
    ///
    /// Contacts are held one at a time, the one that is left most slowly first: what is held may press the ball into another that its
    /// weight alone would not press it into, and takes from what presses it into a third that it hops on.
    pub(super) fn settle(&mut self, left: Option<&Contact>) -> bool {
        let a = self.forces.acceleration(&self.state, &mut self.counters);
        if !self.forces.are_constant() {
            self.lowness = Lowness::under(&a, &self.plan.rest);
        }
        self.count_low_hops();
        if self.bounces_on() {
            self.counters.rest += self.contacts.len() as u64;
            self.set_flying(left);
            return false;
        }
        self.hold(&a, left)
    }

    /// Holds what the ball no longer bounces on; says whether that carries it.
    #[inline(never)] // most impacts bounce on
    fn hold(&mut self, a: &Vector3<f64>, left: Option<&Contact>) -> bool {
        let sliding = self.motion == Motion::Sliding;
        let carriers = self.carriers();
        let before = self.state.velocity;
        let mut carrying = [false; MAX_CONTACTS];
        let mut settling = None;
        while let Some((i, hop)) = self.next_held(a, &carriers, &carrying) {
            carrying[i] = true;
            let contact = &carriers[i].contact;
            let c_r = self.surfaces[contact.surface].material.restitution.coefficient();
            if contact.rate > 0.0 && c_r < 1.0 {
                // Around an edge the way along the surface is no flight: there the hops end at once.
                let flat = carriers[i].bend == Bend::Flat;
                let seconds = if flat { 2.0 * contact.rate / (hop.pressed * (1.0 - c_r)) } else { 0.0 };
                settling = Some(Settling { seconds, closing: contact.rate, contact: i });
            }
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
            self.set_flying(left);
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
            _ if !sliding => self.begin_sliding(before),
            _ => {}
        }
        true
    }

    /// Of the contacts on which bouncing has ended and that are not yet `carrying`, the one that is left most slowly.
    fn next_held(
        &mut self,
        a: &Vector3<f64>,
        carriers: &[Carrier],
        carrying: &[bool; MAX_CONTACTS],
    ) -> Option<(usize, Hop)> {
        let held: PerContact<Carrier> = carriers.iter().zip(carrying).filter(|(_, c)| **c).map(|(c, _)| *c).collect();
        let normals: PerContact<Vector3<f64>> = held.iter().map(|c| c.contact.normal).collect();
        let free = if held.is_empty() { *a } else { Balance::of(a, &held, &self.state).free };
        let velocity = along(&normals, self.state.velocity);
        let mut next: Option<(usize, Hop)> = None;
        for (i, carrier) in carriers.iter().enumerate().filter(|(i, _)| !carrying[*i]) {
            let contact = &carrier.contact;
            let rate = if contact.rate == 0.0 { 0.0 } else { changed_rate(contact, &self.state.velocity, &velocity) };
            let pressed = -carrier.lift(&free, &State { velocity, ..self.state });
            let surely = held.is_empty() && carrier.bend == Bend::Flat;
            let neutral = if surely { 0.0 } else { carrier.neutral(a, &self.state.position) };
            let hop = Hop { rate, pressed, neutral };
            // Two leave one direction to move in, a third none: it is nothing for a ball that moves. One that is driven back along the groove
            // before it has got as far as a hop may be high does not, however slowly the groove leads away from the third.
            let moves = held.len() > 1 && velocity.norm() > self.plan.rest.at(free.norm()).speed;
            if !moves && self.ends_bouncing(contact, &hop) && next.is_none_or(|(_, other)| rate < other.rate) {
                next = Some((i, hop));
            }
        }
        next
    }

    /// Whether every contact is left so fast, and has been for so short a time, that bouncing goes on however it is pressed.
    fn bounces_on(&self) -> bool {
        self.standstill < PATIENCE_WITH_HOPS
            && self.low_hops <= PATIENCE_WITH_LOW_HOPS
            && self.integrator.timestep().is_none()
            && self.contacts.iter().all(|c| c.rate > self.lowness.fast)
    }

    /// Counts the impacts in a row after which no hop is high.
    fn count_low_hops(&mut self) {
        let are_low = self.contacts.iter().all(|c| c.rate <= self.lowness.low);
        self.low_hops = if are_low { self.low_hops + 1 } else { 0 };
    }

    /// Whether bouncing on `contact` has ended: it is pressed, and the next hop would be none (three of the four parts of
    /// the rest test, for the normal speed; the fourth tells sliding from resting).
    fn ends_bouncing(&mut self, contact: &Contact, hop: &Hop) -> bool {
        self.counters.rest += 1;
        let &Hop { rate, pressed, neutral } = hop;
        let thresholds = self.plan.rest.at(pressed.max(0.0));
        let still = self.state.velocity == Vector3::zeros();
        if rate == 0.0 {
            return pressed > 0.0 || (neutral > 0.0 && pressed >= -neutral) || (still && pressed >= -thresholds.force);
        }
        let loses = self.standstill > PATIENCE || self.contacts.iter().any(|c| self.takes_energy(c));
        let height = rate * rate / (2.0 * pressed);
        let resolved = self.integrator.timestep().map_or(0.0, |h| least_hop(pressed, h));
        let hidden = height <= position_bound(self.plan.farthest.max(self.state.position.coords.amax()));
        // Nor does one go on whose hops the clock has not resolved for long: what is left of them has a closed form.
        let brief = self.standstill >= PATIENCE_WITH_HOPS && 2.0 * rate <= pressed * time_resolution(self.clock.now());
        // Nor one on an elastic wall at the end of a rail, which is for ever as low as what the rail has left of it.
        let elastic = self.surfaces[contact.surface].material.restitution.coefficient() == 1.0;
        let endless = elastic && self.low_hops > PATIENCE_WITH_LOW_HOPS && rate <= self.plan.rest.low_hop(pressed);
        let over = rate <= thresholds.speed || height <= resolved;
        pressed > 0.0 && ((over && (loses || hidden)) || ((brief || endless) && loses))
    }

    /// Whether bouncing on `contact` takes energy. What loses nothing bounces for ever. The air takes from each hop; an elastic surface
    /// with friction loses in a corner, without end.
    fn takes_energy(&self, contact: &Contact) -> bool {
        let material = &self.surfaces[contact.surface].material;
        let smooth = material.friction.in_contact() == ContactFriction::Sliding(0.0);
        material.restitution.coefficient() < 1.0 || !smooth || !self.forces.are_constant()
    }

    /// Whether taking the ball along the contacts that carry would drive it into one that does not.
    fn drives_into_others(&self, carrying: &[bool]) -> bool {
        let contacts = || self.contacts.iter().zip(carrying);
        let held: PerContact<_> = contacts().filter(|(_, carrying)| **carrying).map(|(c, _)| c.normal).collect();
        let v = along(&held, self.state.velocity);
        let rounding = rate_rounding(self.state.velocity.norm());
        contacts().any(|(c, carrying)| !carrying && c.normal.dot(&v) < -rounding)
    }

    /// The last hops are too low to see, and friction acts at their ends: a flight along the surface.
    pub(super) fn settling_flight(&mut self, settling: &Settling, carriers: &[Carrier], balance: &Balance) -> Slide {
        self.counters.paths += 1;
        let seconds = settling.seconds.min(self.clock.until(self.plan.duration));
        let step = if self.forces.are_constant() {
            exact::step(&self.state, balance.free, seconds)
        } else {
            let (forces, counters) = (&self.forces, &mut self.counters);
            self.slider.step(&self.state, seconds, |s, after| {
                Balance::of(&forces.acceleration_after(s, after, counters), carriers, s).free
            })
        };
        Slide { step, stops: step.time(step.to) >= settling.seconds }
    }

    /// The impacts of the hops that were flown along the surface, all at once; then sliding begins.
    pub(super) fn end_settling(&mut self) {
        if let Some(settling) = self.settling.take() {
            let contact = self.contacts[settling.contact];
            let material = &self.surfaces[contact.surface].material;
            let c_r = material.restitution.coefficient();
            let before = self.state.velocity;
            match material.friction {
                Friction::Grip(grip) => self.grip_to_the_end(&contact, &grip, settling.closing, c_r),
                _ => self.state.velocity = material.friction.slow_to_the_end(before, settling.closing, c_r),
            }
            self.begin_sliding(before);
        }
    }
}
