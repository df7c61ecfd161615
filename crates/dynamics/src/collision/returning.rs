//! When a ball comes back to what it leaves: to a plane, to an edge or vertex, or to the faces there.

use super::Obstacles;
use crate::contacts::{Contact, PerContact};
use crate::counters::Counters;
use crate::integrators::Step;
use crate::tolerance::{rate_rounding, touch_distance};
use carom_geometry::bounds::amax;
use carom_geometry::clearance::{Clearance, Entry};
use carom_geometry::contact::Hold;
use carom_geometry::mesh::Mesh;
use carom_geometry::site::{Bend, RegionBound, Site};
use nalgebra::{Point3, Vector3};
use smallvec::SmallVec;

/// When a contact that the ball has is entered again: clearance 0 at the start, changing with its exact rate.
#[derive(Debug, Clone)]
pub struct Return {
    /// For the mesh queries.
    pub(super) hold: Hold,
    /// Where, and at what slope.
    pub entry: Entry,
    /// What that says of the faces of a mesh that the contact is on.
    pub(super) free: Option<Free>,
}

/// Until when a ball that leaves a place of a mesh cannot touch the faces there again.
#[derive(Debug, Clone)]
pub(super) struct Free {
    pub(super) surface: usize,
    site: Site,
    /// Until here none of them, whatever the way.
    all: f64,
    /// Until here none whose nearest part is still the place.
    here: f64,
    /// Where other places become the nearest part of their faces.
    exits: SmallVec<[(Site, f64); 4]>,
}

impl Free {
    /// The f before which the ball does not touch `face` of `surface`, which is `mesh`.
    pub(super) fn until(&self, surface: usize, mesh: &Mesh, face: u32) -> f64 {
        if surface != self.surface || !mesh.is_at(face, self.site) {
            return 0.0;
        }
        let exits = self.exits.iter().filter(|(next, _)| mesh.is_at(face, *next));
        exits.map(|(_, f)| *f).fold(self.here, f64::min).max(self.all)
    }
}

/// The returns of one step, one for each contact.
pub type Returns = PerContact<Return>;

/// The clearance from a contact along the step: 0 now by definition, and its slope the contact's own rate (plus what a path that
/// does not begin with the velocity adds).
fn leaving(step: &Step, contact: &Contact) -> Clearance {
    let mut c = [0.0; 5];
    // What the ball moves along, it leaves or enters by more than rounding or not at all.
    let along = contact.rate == 0.0;
    let part = |v: &Vector3<f64>, of: &Vector3<f64>| {
        let part = contact.normal.dot(v);
        if along && part.abs() <= rate_rounding(of.norm()) { 0.0 } else { part }
    };
    for (k, term) in step.path.terms().iter().enumerate() {
        c[k + 1] = part(term, term);
    }
    if let Some(first) = step.path.terms().first() {
        let kick = first - step.velocity[0] * step.seconds;
        c[1] = contact.rate * step.seconds + part(&kick, first);
    }
    Clearance::new(c)
}

/// The f up to which the path cannot come back to the edge or vertex, bent as `bend`, that it leaves from distance `radius`
/// with the slope `slope` of its clearance.
///
/// For a parabola |w(f)|^2 - r^2, with w the part across the edge, is a quartic, solved like any clearance. The further terms of a path bring it
/// nearer by |t3| f^3 + |t4| f^4 at most, so that it is off while |w| is more than r and that: while |w|^2 - r^2 is more than
/// 2 r (|t3| f^3 + |t4| f^4) + (|t3| + |t4|)^2 f^4, since f is 1 at most. On a path straight back that is no sooner than it must be at f = 1.
fn leaves_until(step: &Step, bend: Bend, radius: f64, slope: f64) -> f64 {
    let zero = Vector3::zeros();
    let term = |k: usize| bend.across(step.path.terms().get(k).unwrap_or(&zero));
    let away = bend.away_from(&step.path.start()).and_then(|away| away.try_normalize(0.0));
    let Some(w) = away.map(|n| n * radius) else { return 0.0 };
    let (b, c) = (term(0), term(1));
    let (third, fourth) = (term(2).norm(), term(3).norm());
    // The ball touches: the term of order 0 is zero, and that of order 1 is known from the contact.
    let leaving = 2.0 * radius * slope;
    let gain = b.norm_squared() + 2.0 * w.dot(&c);
    let cubic = 2.0 * (b.dot(&c) - radius * third);
    let quartic = c.norm_squared() - 2.0 * radius * fourth - (third + fourth) * (third + fourth);
    let off = Clearance::new([0.0, leaving, gain, cubic, quartic]);
    off.first_entry(0.0, step.to).f().unwrap_or(f64::INFINITY)
}

/// Where the step, after `from`, crosses a bound of the region of a place.
pub(super) fn leaves_region(step: &Step, bound: &RegionBound, from: f64) -> Entry {
    let inward = -bound.outward;
    let gap = inward.dot(&(step.path.start() - bound.point));
    step.path.clearance(gap, &inward).first_entry(from, step.to)
}

impl Obstacles<'_> {
    /// When the path of `step` returns to each of `contacts`; never to a lasting one, along which it moves.
    pub fn returns(&self, step: &Step, contacts: &[Contact], counters: &mut Counters) -> Returns {
        let slack = touch_distance(amax(&step.path.start().coords).max(self.radius), 0.0);
        contacts
            .iter()
            .map(|contact| {
                let hold = |until| Hold {
                    normal: contact.normal,
                    point: self.anchor(contact),
                    slack,
                    until,
                    face: contact.site.map(|site| site.face()),
                };
                if contact.lasting {
                    let until = f64::INFINITY;
                    return Return { hold: hold(until), entry: Entry::Never, free: self.free(contact, until, None) };
                }
                counters.clearances += 1;
                let entry = leaving(step, contact).first_entry(0.0, step.to);
                let until = entry.f().unwrap_or(f64::INFINITY);
                let curved = self.bend(contact) != Bend::Flat && contact.rate >= 0.0;
                let free = self.free(contact, until, curved.then_some((step, counters)));
                Return { hold: hold(until), entry, free }
            })
            .collect()
    }

    /// A point of what is touched.
    fn anchor(&self, contact: &Contact) -> Point3<f64> {
        match (contact.site, self.mesh(contact.surface)) {
            (Some(site), Some(mesh)) => mesh.anchor(site),
            _ => self.planes.iter().find(|p| p.surface == contact.surface).map_or(Point3::origin(), |p| p.point),
        }
    }

    /// Until when a ball that returns to the plane of `contact` at `until` is free of the faces there; if it leaves an edge or vertex along `leaves`,
    /// until it comes back to that, or to where another part of a face is nearer.
    fn free(&self, contact: &Contact, until: f64, leaves: Option<(&Step, &mut Counters)>) -> Option<Free> {
        let (surface, site) = (contact.surface, contact.site?);
        let mut free = Free { surface, site, all: until, here: until, exits: SmallVec::new() };
        if let Some((step, counters)) = leaves {
            let slope = leaving(step, contact).rate(0.0);
            free.here = leaves_until(step, self.bend(contact), self.radius_at(contact), slope);
            for bound in self.mesh(surface)?.region(site) {
                counters.clearances += 1;
                if let Entry::At { f, .. } = leaves_region(step, &bound, 0.0) {
                    free.exits.push((bound.next, f));
                }
            }
        }
        Some(free)
    }
}

#[cfg(test)]
mod tests;
