//! When a ball comes back to what it leaves: to a plane, to an edge or vertex, or to the faces there.

use super::Obstacles;
use crate::contacts::{Contact, PerContact};
use crate::counters::Counters;
use crate::integrators::Step;
use crate::tolerance::{RETURN_ROUNDING, rate_rounding, touch_distance};
use carom_geometry::bounds::amax;
use carom_geometry::clearance::{Clearance, Entry};
use carom_geometry::contact::Hold;
use carom_geometry::mesh::Mesh;
use carom_geometry::site::{Bend, RegionBound};
use nalgebra::{Point3, Vector3};
use std::cell::Cell;

/// Where in one step each contact that the ball has is entered again, and at what slope: clearance 0 at the start, changing with its exact rate.
pub type Returns = PerContact<Entry>;

/// The f of a return, infinite if there is none.
fn until(back: &Entry) -> f64 {
    back.f().unwrap_or(f64::INFINITY)
}

/// The clearance from a contact along the step: 0 now by definition, and its slope the contact's own rate (plus what a path that
/// does not begin with the velocity adds).
#[inline(always)] // so that what it makes is not copied
fn leaving(step: &Step, contact: &Contact) -> Clearance {
    let mut c = [0.0, contact.rate * step.seconds, 0.0, 0.0, 0.0];
    // What the ball moves along, it leaves or enters by more than rounding or not at all.
    let along = contact.rate == 0.0;
    let part = |v: &Vector3<f64>, of: &Vector3<f64>| {
        let part = contact.normal.dot(v);
        if along && part.abs() <= rate_rounding(of.norm()) { 0.0 } else { part }
    };
    for (k, term) in step.path.terms().iter().enumerate().skip(1) {
        c[k + 1] = part(term, term);
    }
    if let Some(first) = step.path.terms().first().filter(|_| !step.exact) {
        let kick = first - step.velocity[0] * step.seconds;
        c[1] += part(&kick, first);
    }
    Clearance::new(c)
}

/// The f up to which the path cannot come back, by more than rounding, to the edge or vertex, bent as `bend`, that it leaves from distance `radius`
/// with the slope `slope` of its clearance.
///
/// For a parabola |w(f)|^2 - r^2, with w the part across the edge, is a quartic, solved like any clearance. The further terms of a path bring it
/// nearer by |t3| f^3 + |t4| f^4 at most, so that it is off while |w| is more than r and that: while |w|^2 - r^2 is more than
/// 2 r (|t3| f^3 + |t4| f^4) + (|t3| + |t4|)^2 f^4, since f is 1 at most. On a path straight back that is no sooner than it must be at f = 1.
///
/// A small ball that flies straight through the edge is on it for so short a part of its way that in rounded coefficients it is nowhere: each is
/// less by what rounding may have added, [`RETURN_ROUNDING`] of the products that it is the sum of.
fn leaves_until(step: &Step, bend: Bend, radius: f64, slope: f64) -> f64 {
    let zero = Vector3::zeros();
    let term = |k: usize| step.path.terms().get(k).unwrap_or(&zero);
    let away = bend.away_from(&step.path.start()).and_then(|away| away.try_normalize(0.0));
    let Some(w) = away.map(|n| n * radius) else { return 0.0 };
    let (b, c) = (bend.across(term(0)), bend.across(term(1)));
    let [first, second, third, fourth] = [0, 1, 2, 3].map(|k| term(k).norm());
    let further = third + fourth;
    // What is across the edge is off by a share of the whole.
    let (b_most, c_most) = (b.norm() + RETURN_ROUNDING * first, c.norm() + RETURN_ROUNDING * second);
    let less = |products: f64| RETURN_ROUNDING * products;
    // The ball touches: the term of order 0 is zero, and that of order 1 is known from the contact.
    let leaving = 2.0 * radius * slope;
    let gain = b.norm_squared() + 2.0 * w.dot(&c) - less(first * b_most + 2.0 * radius * second);
    let cubic = 2.0 * (b.dot(&c) - radius * third) - less(first * c_most + second * b_most + 2.0 * radius * third);
    let quartic = c.norm_squared() - 2.0 * radius * fourth - further * further;
    let quartic = quartic - less(second * c_most + 2.0 * radius * fourth + further * further);
    let off = Clearance::new([0.0, leaving, gain, cubic, quartic]);
    let dip = 2.0 * radius * rounding_at(step, radius);
    until(&off.first_entry(after_dip(&off, step.to, dip), step.to))
}

/// Where what is 0 at first is so again, if it is below by no more than `depth` in between; 0 if it is above at once, or goes deeper.
///
/// A ball that takes off from an edge is balanced on it: whether it leaves at once or a little later is decided by less than rounding.
fn after_dip(off: &Clearance, to: f64, depth: f64) -> f64 {
    match off.opposite().first_entry(0.0, to) {
        Entry::At { f, .. } if -off.fall(f) <= depth => f,
        _ => 0.0,
    }
}

/// By how much the place of the ball may be off, at the start of the step.
fn rounding_at(step: &Step, radius: f64) -> f64 {
    touch_distance(amax(&step.path.start().coords).max(radius), 0.0)
}

/// Where the step crosses a bound of the region of a place.
fn leaves_region(step: &Step, bound: &RegionBound) -> Entry {
    let inward = -bound.outward;
    let gap = inward.dot(&(step.path.start() - bound.point));
    step.path.clearance(gap, &inward).first_entry(0.0, step.to)
}

/// The same after `from`, for a ball that stays on the place until then. Where it starts from the bound to within `slack` (m), it leaves only by more than
/// that: what moves along the bound would otherwise be taken from both sides of it by the rounding of its velocity or its place, without end.
pub(super) fn slides_over(step: &Step, bound: &RegionBound, from: f64, slack: f64) -> Entry {
    let inward = -bound.outward;
    let gap = inward.dot(&(step.path.start() - bound.point));
    let gap = if from == 0.0 && gap.abs() <= slack { slack } else { gap };
    step.path.clearance(gap, &inward).first_entry(from, step.to)
}

/// A ball that leaves a contact with a mesh, and returns to it.
pub(super) struct Departure<'a> {
    step: &'a Step,
    contact: &'a Contact,
    mesh: &'a Mesh,
    radius: f64,
    /// The f of its return to the plane of the contact.
    until: f64,
    bend: Bend,
    /// [`leaves_until`], once it is known.
    leaves: Cell<Option<f64>>,
}

impl<'a> Departure<'a> {
    /// A ball of `radius` that leaves `contact` with `mesh` by `step`, to whose plane it is `back`.
    pub(super) fn new(step: &'a Step, contact: &'a Contact, back: &Entry, mesh: &'a Mesh, radius: f64) -> Self {
        let is_left = !contact.lasting && contact.rate >= 0.0;
        let bend = contact.site.filter(|_| is_left).map_or(Bend::Flat, |site| mesh.bend(site));
        Self { step, contact, mesh, radius, until: until(back), bend, leaves: Cell::new(None) }
    }

    /// The f before which the ball does not touch `face` again: none of the faces at the contact before it is back at its plane; and if it leaves an edge
    /// or vertex, none before it comes back to that, or to where another part of the face is nearer. `clearances` counts what is asked for it.
    pub(super) fn free_until(&self, face: u32, clearances: &Cell<u64>) -> f64 {
        let &Self { step, contact, mesh, until, bend, .. } = self;
        let Some(site) = contact.site.filter(|site| mesh.is_at(face, *site)) else { return 0.0 };
        if bend == Bend::Flat {
            return until;
        }
        let leaves = || leaves_until(step, bend, self.radius, leaving(step, contact).rate(0.0));
        let mut free = self.leaves.get().unwrap_or_else(leaves);
        self.leaves.set(Some(free));
        for bound in mesh.region(site).iter().filter(|bound| mesh.is_at(face, bound.next)) {
            clearances.set(clearances.get() + 1);
            if let Entry::At { f, .. } = leaves_region(step, bound) {
                free = free.min(f);
            }
        }
        free.max(until)
    }
}

impl Obstacles<'_> {
    /// Makes `returns` when the path of `step` returns to each of `contacts`; never to a lasting one, along which it moves.
    #[inline(always)] // so that what it makes is not copied
    pub fn returns(&self, step: &Step, contacts: &[Contact], returns: &mut Returns, counters: &mut Counters) {
        returns.clear();
        for contact in contacts {
            returns.push(if contact.lasting {
                Entry::Never
            } else {
                counters.clearances += 1;
                leaving(step, contact).first_entry(0.0, step.to)
            });
        }
    }

    /// `contacts`, to which `step` comes back by `returns`, as the search of a mesh needs them; `face` is left to that mesh.
    pub(super) fn holds(&self, step: &Step, contacts: &[Contact], returns: &Returns) -> PerContact<Hold> {
        let slack = rounding_at(step, self.radius);
        let mut holds = PerContact::new();
        for (contact, back) in contacts.iter().zip(returns) {
            let (normal, point) = (contact.normal, self.anchor(contact));
            holds.push(Hold { normal, point, slack, until: until(back), face: None });
        }
        holds
    }

    /// A point of what is touched.
    fn anchor(&self, contact: &Contact) -> Point3<f64> {
        match (contact.site, self.mesh(contact.surface)) {
            (Some(site), Some(mesh)) => mesh.anchor(site),
            _ => self.planes.iter().find(|p| p.surface == contact.surface).map_or(Point3::origin(), |p| p.point),
        }
    }
}

#[cfg(test)]
mod tests;
