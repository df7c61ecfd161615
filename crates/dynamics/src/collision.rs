//! Collision detection and determination: the earliest f over all surfaces, and what is touched there.

mod returning;

pub use returning::Returns;

use crate::body::State;
use crate::contacts::{Contact, Contacts, MAX_CONTACTS, PerContact};
use crate::counters::Counters;
use crate::integrators::Step;
use crate::plan::Plan;
use crate::tolerance::{merge_angle_squared, rate_rounding, touch_breadth, touch_distance};
use carom_geometry::bounds::amax;
use carom_geometry::clearance::Entry;
use carom_geometry::contact::MovingBall;
use carom_geometry::mesh::{Fold, Mesh};
use carom_geometry::order::by_size;
use carom_geometry::plane::Side;
use carom_geometry::rounding::contact_doubt;
use carom_geometry::site::{Bend, RegionBound, Site};
use carom_geometry::sweep::{Surroundings, Work};
use nalgebra::{Point3, Vector3};
use returning::{Departure, slides_over};
use std::cell::Cell;
use std::cmp::Ordering;

/// The earliest collision of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The slides' f, as a part of the step.
    pub f: f64,
    /// Index of the surface.
    pub surface: usize,
    /// The face of a mesh.
    pub face: Option<u32>,
    /// The slope dc/df of the clearance there, where a plane's was solved.
    pub rate: Option<f64>,
}

/// A plane as seen from the side on which a ball is.
#[derive(Debug, Clone, Copy)]
struct FacingPlane {
    surface: usize,
    /// The unit normal towards the ball.
    normal: Vector3<f64>,
    point: Point3<f64>,
}

impl FacingPlane {
    /// [`Plane::clearance`](carom_geometry::plane::Plane::clearance) from that side, bit for bit.
    #[inline]
    fn clearance(&self, x: &Point3<f64>, radius: f64) -> f64 {
        self.normal.dot(&(x - self.point)) - radius
    }

    /// Where `step` enters it first, for a ball of `radius`, before `to` or at it; of what comes later, only that there is nothing before.
    #[inline(never)] // it is asked for each plane
    fn entry(&self, step: &Step, radius: f64, to: f64) -> Entry {
        let gap = self.clearance(&step.path.start(), radius);
        let clearance = step.path.clearance(gap, &self.normal);
        // Most planes are too far away, or the ball flies away from them.
        if gap > -2.0 * clearance.fall(to) { Entry::Never } else { clearance.first_entry(0.0, step.to) }
    }
}

/// Whether a centre that starts on a plane of normal `n`, with acceleration `a`, is behind it: on the side it moves to or, where it moves along the plane
/// to rounding, on the side it is pressed from.
fn is_behind(n: &Vector3<f64>, state: &State, a: &Vector3<f64>) -> bool {
    let heading = n.dot(&state.velocity);
    let along = heading.abs() <= rate_rounding(state.velocity.norm());
    (if along { -n.dot(a) } else { heading }) < 0.0
}

/// The contact with `site` of `surface`, at `normal`, of a ball that moves with `velocity`.
fn contact_with(surface: usize, site: Option<Site>, normal: Vector3<f64>, velocity: &Vector3<f64>) -> Contact {
    Contact { surface, site, normal, rate: normal.dot(velocity), lasting: false }
}

/// One ball among the surfaces of a plan.
#[derive(Debug, Clone)]
pub struct Obstacles<'a> {
    plan: &'a Plan,
    /// The planes from the side on which the ball is: decided once, and never again.
    planes: Vec<FacingPlane>,
    /// What the ball has seen of each mesh.
    around: Vec<Surroundings>,
    radius: f64,
    mesh_radius: f64,
}

impl<'a> Obstacles<'a> {
    /// The surfaces as met by a ball of `radius` that starts in `state` with acceleration `a`.
    pub fn new(plan: &'a Plan, radius: f64, state: &State, a: &Vector3<f64>) -> Self {
        let side = |plane: &carom_geometry::plane::Plane| {
            let n = plane.normal();
            plane
                .side_of(&state.position)
                .unwrap_or_else(|| if is_behind(&n, state, a) { Side::Negative } else { Side::Positive })
        };
        let facing = |(surface, plane): &(usize, carom_geometry::plane::Plane)| {
            let normal = plane.normal().into_inner() * side(plane).sign();
            FacingPlane { surface: *surface, normal, point: plane.point() }
        };
        let planes = plan.planes.iter().map(facing).collect();
        let mesh_radius = radius.max(plan.point_radius);
        let extent = plan.farthest + state.position.coords.amax() + mesh_radius;
        let around = vec![Surroundings::new(extent); plan.meshes.len()];
        Self { plan, planes, around, radius, mesh_radius }
    }

    /// The radius with which the ball meets the surface.
    pub fn radius_at(&self, contact: &Contact) -> f64 {
        if contact.site.is_some() { self.mesh_radius } else { self.radius }
    }

    /// The shape that the centre follows along a contact.
    pub fn bend(&self, contact: &Contact) -> Bend {
        match (contact.site, self.mesh(contact.surface)) {
            (Some(site), Some(mesh)) => mesh.bend(site),
            _ => Bend::Flat,
        }
    }

    /// Where the step, after `from`, first leaves the region of a contact.
    pub fn exit(
        &self,
        step: &Step,
        contact: &Contact,
        from: f64,
        counters: &mut Counters,
    ) -> Option<(f64, RegionBound)> {
        let mut first: Option<(f64, RegionBound)> = None;
        let rounding = touch_distance(self.plan.farthest + amax(&step.path.start().coords), 0.0);
        for bound in self.mesh(contact.surface)?.region(contact.site?) {
            counters.clearances += 1;
            let hollow = matches!(bound.next, Site::Edge { face, edge } if self.is_hollow(contact, face, edge));
            let slack = if hollow { touch_breadth(rounding, self.mesh_radius) } else { rounding };
            if let Entry::At { f, .. } = slides_over(step, &bound, from, slack)
                && first.is_none_or(|(best, _)| f < best)
            {
                first = Some((f, bound));
            }
        }
        first
    }

    /// The earliest collision of the step: over all surfaces, the smallest f at which the clearance is <= 0 and falling.
    #[inline(always)] // so that what it finds is not copied
    pub fn earliest(
        &mut self,
        step: &Step,
        contacts: &[Contact],
        returns: &Returns,
        counters: &mut Counters,
    ) -> Option<Hit> {
        let mut hit = self.earliest_plane(step, contacts, returns, counters);
        if !self.plan.meshes.is_empty() {
            self.meet_faces(&mut hit, step, contacts, returns, counters);
        }
        hit
    }

    /// Whether what is found at `f` on `surface` comes before `than`: ties go by name, so that the order of the surfaces does not matter.
    fn is_earlier(&self, f: f64, surface: usize, than: Option<(f64, usize)>) -> bool {
        let rank = |surface: usize| self.plan.surfaces[surface].rank;
        than.is_none_or(|(first, other)| f < first || (f == first && rank(surface) < rank(other)))
    }

    /// The earliest collision of the step with a plane.
    #[inline(always)] // so that what it finds is not copied
    fn earliest_plane(
        &self,
        step: &Step,
        contacts: &[Contact],
        returns: &Returns,
        counters: &mut Counters,
    ) -> Option<Hit> {
        // The f, and the surface; and how fast it closes there.
        let (mut earliest, mut closing) = (None, 0.0);
        for facing in &self.planes {
            let surface = facing.surface;
            let known = contacts.iter().zip(returns).find(|(c, _)| c.surface == surface);
            // By reference: what was just written in parts is waited for where it is copied as a whole.
            let fresh;
            let entry = match known {
                Some((_, back)) => back,
                None => {
                    counters.clearances += 1;
                    fresh = facing.entry(step, self.radius, earliest.map_or(step.to, |(f, _)| f));
                    &fresh
                }
            };
            if let Entry::At { f, rate } = *entry
                && self.is_earlier(f, surface, earliest)
            {
                (earliest, closing) = (Some((f, surface)), rate);
            }
        }
        earliest.map(|(f, surface)| Hit { f, surface, face: None, rate: Some(closing) })
    }

    /// Makes `earliest` the collision of the step with a face, if one comes before it.
    #[inline(never)] // beside the loop over planes, which stays small
    fn meet_faces(
        &mut self,
        earliest: &mut Option<Hit>,
        step: &Step,
        contacts: &[Contact],
        returns: &Returns,
        counters: &mut Counters,
    ) {
        let mut holds = self.holds(step, contacts, returns);
        for (i, (surface, mesh)) in self.plan.meshes.iter().enumerate() {
            for (contact, hold) in contacts.iter().zip(&mut holds) {
                hold.face = contact.site.filter(|_| contact.surface == *surface).map(|site| site.face());
            }
            let ball = MovingBall { path: &step.path, radius: self.mesh_radius, holds: &holds };
            let to = earliest.map_or(step.to, |hit| hit.f);
            let mut work = Work::default();
            let asked = Cell::new(0);
            let on_it = contacts.iter().zip(returns).filter(|(contact, _)| contact.surface == *surface);
            let departures: PerContact<Departure> =
                on_it.map(|(contact, back)| Departure::new(step, contact, back, mesh, ball.radius)).collect();
            let free_until =
                |face: u32| departures.iter().map(|departure| departure.free_until(face, &asked)).fold(0.0, f64::max);
            let found = mesh.first_contact_around(&ball, to, free_until, &mut self.around[i], &mut work);
            counters.add(&work);
            counters.clearances += asked.get();
            if let Some(found) = found
                && self.is_earlier(found.f, *surface, earliest.map(|hit| (hit.f, hit.surface)))
            {
                *earliest = Some(Hit { f: found.f, surface: *surface, face: Some(found.face), rate: None });
            }
        }
    }

    /// How far from touching the ball may be at `hit`, by the rounding of the search that found it: it grows with the face.
    pub fn doubt(&self, step: &Step, hit: &Hit) -> f64 {
        let Some((face, mesh)) = hit.face.and_then(|face| Some((face, self.mesh(hit.surface)?))) else { return 0.0 };
        let corners = mesh.triangle(face).map(|v| (v - step.path.start()).amax());
        let size = corners.into_iter().fold(self.mesh_radius, f64::max);
        contact_doubt(size + step.path.reach(hit.f))
    }

    /// What the search that found `hit` has seen of its face, if a ball at `position` with `velocity` closes in on that.
    pub fn seen(&self, hit: &Hit, position: &Point3<f64>, velocity: &Vector3<f64>) -> Option<Contact> {
        let (face, mesh) = hit.face.zip(self.mesh(hit.surface))?;
        let touch = mesh.nearest_of(face, position)?;
        Some(contact_with(hit.surface, Some(touch.site), touch.normal, velocity)).filter(|contact| contact.rate < 0.0)
    }

    /// Makes `touched` the contacts of a ball in `state`, to within `tolerance` (m), each with its rate n.v. If that is where it is at
    /// `f` of the step that the [`earliest`](Self::earliest) hit was asked for, they need not be looked for again.
    ///
    /// Of contacts whose normals are one to within what the tolerance makes of them, the one that closes fastest stays.
    pub fn touching(
        &self,
        state: &State,
        tolerance: f64,
        f: Option<f64>,
        touched: &mut Contacts,
        counters: &mut Counters,
    ) {
        touched.clear();
        for facing in &self.planes {
            if facing.clearance(&state.position, self.radius) <= tolerance {
                touched.push(contact_with(facing.surface, None, facing.normal, &state.velocity));
            }
        }
        if !self.plan.meshes.is_empty() {
            self.touch_faces(state, tolerance, f, touched, counters);
        }
        if touched.len() > 1 {
            self.merge(touched, tolerance);
        }
    }

    /// Adds what a ball in `state` touches of the meshes, as [`touching`](Self::touching) is asked for it.
    #[inline(never)] // beside the loop over planes, which stays small
    fn touch_faces(
        &self,
        state: &State,
        tolerance: f64,
        f: Option<f64>,
        touched: &mut Contacts,
        counters: &mut Counters,
    ) {
        let State { position, velocity } = state;
        for ((surface, mesh), around) in self.plan.meshes.iter().zip(&self.around) {
            let mut work = Work::default();
            let touches = match f {
                Some(f) => mesh.touches_at(f, around, position, velocity, self.mesh_radius, tolerance, &mut work),
                None => mesh.touches(position, velocity, self.mesh_radius, tolerance, &mut work),
            };
            for touch in touches {
                touched.push(contact_with(*surface, Some(touch.site), touch.normal, velocity));
            }
            counters.add(&work);
        }
    }

    /// Of contacts whose normals are one, that which closes fastest; then in order.
    #[inline(never)] // there are seldom two
    fn merge(&self, contacts: &mut Contacts, tolerance: f64) {
        contacts.sort_by(|a, b| a.rate.total_cmp(&b.rate).then_with(|| self.order(a, b)));
        let mut kept = 0;
        for i in 0..contacts.len() {
            let c = contacts[i];
            let same = |kept: &Contact| {
                // The normals of planes and faces do not depend on where rounding put the ball: two of them are two.
                let exact = self.bend(kept) == Bend::Flat && self.bend(&c) == Bend::Flat;
                let radius = if exact { 0.0 } else { self.radius_at(kept).min(self.radius_at(&c)) };
                let angle = merge_angle_squared(tolerance, radius);
                (kept.normal - c.normal).norm_squared() <= angle
            };
            if kept < MAX_CONTACTS && !contacts[..kept].iter().any(same) {
                contacts[kept] = c;
                kept += 1;
            }
        }
        contacts.truncate(kept);
        contacts.sort_by(|a, b| self.order(a, b));
    }

    /// Where a point that starts in `state` with acceleration `a` is clear of the faces it lies on: off them by the radius that it has there, on the side
    /// it moves to or is pressed from. Which way a face is wound is of no matter.
    pub fn clear_of_faces(
        &self,
        state: &State,
        a: &Vector3<f64>,
        tolerance: f64,
        counters: &mut Counters,
    ) -> Point3<f64> {
        let mut position = state.position;
        let mut touched = Contacts::new();
        self.touching(state, tolerance, None, &mut touched, counters);
        for contact in touched.iter().filter(|c| c.site.is_some() && self.bend(c) == Bend::Flat) {
            let Some(gap) = self.gap(contact, &position) else { continue };
            // Of a face, the height is never below 0: it is seen from where the point is.
            let height = gap + self.mesh_radius;
            let side = if height <= tolerance && is_behind(&contact.normal, state, a) { -1.0 } else { 1.0 };
            position += contact.normal * (side * self.mesh_radius - height);
        }
        position
    }

    /// The order of contacts: by what they are and not by how they are numbered, so that the order of surfaces and faces does not matter.
    pub fn order(&self, a: &Contact, b: &Contact) -> Ordering {
        let rank = |c: &Contact| self.plan.surfaces[c.surface].rank;
        rank(a).cmp(&rank(b)).then_with(|| by_size(&a.normal, &b.normal)).then_with(|| a.site.cmp(&b.site))
    }

    /// The distance that is left between the ball at `position` and what it is in contact with.
    pub fn gap(&self, contact: &Contact, position: &Point3<f64>) -> Option<f64> {
        match contact.site {
            Some(site) => self.gap_at(contact.surface, site, position),
            None => {
                let facing = self.planes.iter().find(|p| p.surface == contact.surface)?;
                Some(facing.clearance(position, self.radius))
            }
        }
    }

    /// The same for `site` of the mesh that `surface` is.
    #[inline(never)] // beside what is asked of planes, which stays small
    fn gap_at(&self, surface: usize, site: Site, position: &Point3<f64>) -> Option<f64> {
        let (foot, _) = self.mesh(surface)?.foot(site, position)?;
        Some((position - foot).norm() - self.mesh_radius)
    }

    /// Whether `next` continues the plane of `contact` to the bit: moving on it, nothing changes there.
    pub fn continues(&self, contact: &Contact, next: Site) -> bool {
        let Some(mesh) = self.mesh(contact.surface) else { return false };
        match (contact.site, next) {
            (Some(Site::Face(here)), Site::Face(there)) => {
                let normal = mesh.normal(there).map(|n| n.into_inner());
                normal.is_some_and(|n| mesh.normal(here).is_some_and(|m| n == *m || n == -m.into_inner()))
            }
            _ => false,
        }
    }

    /// Whether the fold at `edge` of `face` is hollow on the side that `contact` is on.
    pub fn is_hollow(&self, contact: &Contact, face: u32, edge: u8) -> bool {
        let Some(mesh) = self.mesh(contact.surface) else { return false };
        let fold = mesh.fold(face, edge.into());
        let in_front = mesh.normal(face).is_some_and(|n| n.dot(&contact.normal) > 0.0);
        (if in_front { fold } else { fold.from_back() }) == Fold::Concave
    }

    /// The mesh that `surface` is, if it is one.
    pub fn mesh(&self, surface: usize) -> Option<&'a Mesh> {
        self.plan.meshes.iter().find(|(s, _)| *s == surface).map(|(_, mesh)| mesh.as_ref())
    }
}
