//! The search for the first contact: pieces of the path front to back, and on each the faces that the tree lets through.

use super::surroundings::{Left, PutOff};
use super::{FirstContact, Surroundings, Work};
use crate::bounds::{amax, largest, least};
use crate::bvh::FatSegment;
use crate::closest::Asked;
use crate::contact::{Contact, Hold, MovingBall, contact_from};
use crate::mesh::Mesh;
use crate::rounding::{contact_doubt, hold_bound, position_bound, screen_bound};
use crate::screen::Stretch;
use crate::shear::Shear;
use nalgebra::{Point3, Vector3};
use smallvec::SmallVec;

/// A path is cut no finer than into pieces whose sagitta is this share of the larger of the radius and a face's size.
const SAGITTA_SHARE: f64 = 0.125;

/// A little later than 1: where a path is back where it was, with room for rounding and for a surface that falls away.
const JUST_AFTER: f64 = 1.0 + 1.0 / 64.0;

/// No vector is longer than this beside its largest |component|: more than the square root of 3.
const LENGTH_OF_ONES: f64 = 1.75;

impl Mesh {
    /// [`first_contact`](Self::first_contact) of a ball that has been there: `around` is what it has seen of this mesh, and goes on seeing.
    pub fn first_contact_around(
        &self,
        ball: &MovingBall,
        to: f64,
        free_until: impl Fn(u32) -> f64,
        around: &mut Surroundings,
        work: &mut Work,
    ) -> Option<FirstContact> {
        let start = ball.path.start();
        let size = self.farthest_from(&start).max(ball.radius);
        // What the ball leaves it often comes back to: a first cut just after that.
        let best = self.where_it_left(ball, to, &free_until, work);
        let last = best.map_or(to, |found| found.f);
        let mut search = Search {
            mesh: self,
            ball,
            start,
            size,
            free_until,
            best,
            to,
            from: 0.0,
            end: last,
            limit: last,
            reach: 0.0,
            stretch: Stretch::default(),
            left: std::mem::take(&mut around.left),
            put_off: std::mem::take(&mut around.put_off),
            work: *work,
        };
        if best.is_some() {
            let reach = ball.path.reach(last);
            let (within, doubt) = (around.within(reach), screen_bound(size + reach));
            let length = LENGTH_OF_ONES * reach;
            let known = around.faces(self, &start, ball.radius, length, within + doubt, &mut search.work);
            if let Some(faces) = known {
                search.begin(0.0, last, within, doubt);
                faces.iter().for_each(|&face| search.consider(face, self.triangle_from(face, &start)));
                search.conclude();
                return search.end(around, work);
            }
        }
        let sagitta_limit = SAGITTA_SHARE * ball.radius.max(self.face_size());
        // Front to back: the stretch to look at next is the last of the stack.
        let mut stack = SmallVec::<[(f64, f64); 16]>::new();
        let back = ball.holds.iter().map(|hold| hold.until).fold(f64::INFINITY, least) * JUST_AFTER;
        if back > 0.0 && back < last {
            stack.push((back, last));
            stack.push((0.0, back));
        } else {
            stack.push((0.0, last));
        }
        while let Some((from, end)) = stack.pop() {
            let chord = ball.path.chord(from, end);
            let (a, b) = (start + chord.from, start + chord.to);
            // What a contact in doubt may be off by counts as near, so that the boxes leave out no face that would report one.
            let reach = ball.path.reach(end);
            let within = around.within(reach);
            let margin = position_bound(largest(largest(amax(&a.coords), amax(&b.coords)), reach))
                + contact_doubt(size + reach)
                + within;
            let radius = ball.radius + chord.sagitta + margin;
            // The margin has room for the rounding of this as well.
            if self.bounds().is_off(&a, &b, radius) {
                search.left.nothing(from, end, within);
                continue;
            }
            let middle = 0.5 * (from + end);
            if chord.sagitta > sagitta_limit && middle > from && middle < end {
                stack.push((middle, end));
                stack.push((from, middle));
                continue;
            }
            search.begin(from, end, within, screen_bound(size + reach));
            let nodes = self.bvh().look_along(&FatSegment { from: a, to: b, radius }, &Shear::new(&a, &b), |seen| {
                let face = seen.item;
                let corners = seen.corners.map(|known| known.points().map(|corner| corner - start));
                search.consider(face, corners.unwrap_or_else(|| self.triangle_from(face, &start)));
                search.part_of_interest()
            });
            search.work.nodes += nodes;
            search.conclude();
            if search.best.is_some_and(|found| found.f <= end) {
                break;
            }
        }
        search.end(around, work)
    }

    /// The first contact with a face that the ball leaves by a short hop: most such hops end there.
    fn where_it_left(
        &self,
        ball: &MovingBall,
        to: f64,
        free_until: &impl Fn(u32) -> f64,
        work: &mut Work,
    ) -> Option<FirstContact> {
        let hold = ball.holds.iter().min_by(|a, b| a.until.total_cmp(&b.until))?;
        let face = hold.face?;
        if !(hold.until > 0.0 && hold.until <= to && ball.path.reach(hold.until) <= self.face_size()) {
            return None;
        }
        work.triangles += 1;
        let free = ball.held_off(&self.triangle(face), free_until(face));
        let asked = Asked::new(self.triangle_from(face, &ball.path.start()));
        match contact_from(ball, &asked, free, to, &mut work.rounds) {
            Contact::At { f, .. } => Some(FirstContact { f: f.min(to), face }),
            Contact::Miss => None,
        }
    }
}

/// A search along a path, a piece at a time.
struct Search<'a, F> {
    mesh: &'a Mesh,
    ball: &'a MovingBall<'a>,
    /// The start of the path.
    start: Point3<f64>,
    /// How far the mesh reaches from there.
    size: f64,
    free_until: F,
    /// The first contact of the faces asked so far.
    best: Option<FirstContact>,
    to: f64,
    /// The piece; `limit` is the end of what is of interest of it.
    from: f64,
    end: f64,
    limit: f64,
    /// How near a face has to be ruled out.
    reach: f64,
    stretch: Stretch,
    left: Left,
    put_off: PutOff,
    work: Work,
}

impl<F: Fn(u32) -> f64> Search<'_, F> {
    /// Goes on to the piece over [`from`, `end`]. What is ruled out is so to `within` of touching, as computed to `doubt`.
    fn begin(&mut self, from: f64, end: f64, within: f64, doubt: f64) {
        (self.from, self.end, self.limit) = (from, end, end);
        self.reach = self.ball.radius + within + doubt;
        self.stretch = Stretch::new(self.ball.path, from, end, self.reach);
        self.left.nothing(from, end, within);
    }

    /// The part of the piece that is still of interest.
    fn part_of_interest(&self) -> f64 {
        (self.limit - self.from) / (self.end - self.from)
    }

    /// Looks at a face with these `corners` that may be met in the piece.
    fn consider(&mut self, face: u32, corners: [Vector3<f64>; 3]) {
        if self.best.is_some_and(|found| found.face == face) {
            self.left.faces.push((face, f64::INFINITY));
            return;
        }
        self.work.triangles += 1;
        let normal = self.mesh.plain_normal(face);
        if self.stretch.is_off_face(&corners, normal) {
            return;
        }
        if self.best.is_none() && !self.stretch.leads_into(&corners, normal, self.ball.radius) {
            self.put_off.later.push(face);
            return;
        }
        if self.best.is_some() && self.stretch.is_off_nearest(&corners) {
            return;
        }
        self.ask(face, corners);
    }

    /// The f before which the ball is known not to touch `face`; notes a face of which that is all there is to know.
    #[inline]
    fn free_until(&mut self, face: u32) -> f64 {
        if self.ball.holds.is_empty() {
            return 0.0;
        }
        let held = self.ball.held_off(&self.mesh.triangle(face), 0.0);
        if held > self.limit {
            self.put_off.hidden.push(face);
            return held;
        }
        let known = (self.free_until)(face);
        if known > self.limit {
            self.left.faces.push((face, f64::INFINITY));
        }
        largest(held, known)
    }

    /// Whether the ball is well off what its holds hide, where the piece ends.
    fn is_off_holds(&self) -> bool {
        let end = self.start + self.ball.path.displacement(self.limit);
        let off =
            |hold: &Hold| hold.normal.dot(&(end - hold.point)) > self.reach + hold.slack + hold_bound(2.0 * self.size);
        self.ball.holds.iter().all(|hold| hold.until <= self.limit || off(hold))
    }

    /// Asks a face with these `corners`, unless the ball is known not to touch it in the piece.
    fn ask(&mut self, face: u32, corners: [Vector3<f64>; 3]) {
        let free = self.free_until(face);
        if free > self.limit {
            return;
        }
        // Asked from the start of the path, not of the piece: the answer does not depend on the pieces.
        let asked = Asked::new(corners);
        if self.best.is_some() {
            self.work.rounds += 1;
            if self.ball.stays_off(&asked, free, self.limit, self.reach) {
                self.left.faces.push((face, free));
                return;
            }
        }
        self.left.faces.push((face, f64::INFINITY));
        if let Contact::At { f, .. } = contact_from(self.ball, &asked, free, self.limit, &mut self.work.rounds)
            && self.best.is_none_or(|found| (f.min(self.to), face) < (found.f, found.face))
        {
            self.best = Some(FirstContact { f: f.min(self.to), face });
            if f < self.limit {
                self.limit = f;
                self.stretch = Stretch::new(self.ball.path, self.from, f, self.reach);
            }
        }
    }

    /// Asks what was put off, as far as it is still of interest.
    fn conclude(&mut self) {
        for i in 0..self.put_off.later.len() {
            let face = self.put_off.later[i];
            let corners = self.mesh.triangle_from(face, &self.start);
            // Without a hit, the piece is the one for which its plane did not tell.
            let is_off_face = self.best.is_some() && self.stretch.is_off_face(&corners, self.mesh.plain_normal(face));
            if !(is_off_face || self.stretch.is_off_nearest(&corners)) {
                self.ask(face, corners);
            }
        }
        self.left.to = self.limit;
        if !(self.put_off.hidden.is_empty() || self.is_off_holds()) {
            self.left.faces.extend(self.put_off.hidden.iter().map(|face| (*face, f64::INFINITY)));
        }
        self.put_off.later.clear();
        self.put_off.hidden.clear();
    }

    /// What was found; what the ball has seen and what was looked at goes to where it is kept.
    fn end(self, around: &mut Surroundings, work: &mut Work) -> Option<FirstContact> {
        (around.left, around.put_off, *work) = (self.left, self.put_off, self.work);
        self.best
    }
}

impl Left {
    /// Nothing is left on [`from`, `to`], so far.
    fn nothing(&mut self, from: f64, to: f64, within: f64) {
        (self.from, self.to, self.within) = (from, to, within);
        self.faces.clear();
    }
}
