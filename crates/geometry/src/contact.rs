//! First contact of a moving ball with one triangle, by support planes.
//!
//! The closest point of the triangle gives a direction n; the plane across n through the vertex that reaches farthest along n
//! has the triangle behind it, so until the path meets *that plane* it cannot meet the triangle. Advance to there, look
//! again, stop when they touch: the chapter's plane test, repeated. Any n is a certificate, whatever the closest point's rounding
//! was, so the answer is never late; doubt within the rounding bound is a hit. (Conservative advancement: Mirtich 1996; the
//! support plane makes it exact for a face and quadratically convergent for edges and vertices.)

mod ahead;

use crate::bounds::{amax, largest};
use crate::clearance::{Clearance, Entry};
use crate::closest::{Asked, Feature};
use crate::normal::unit;
use crate::path::Path;
use crate::rounding::{UNIT_ROUNDOFF, contact_bound, hold_bound, round_bound};
use ahead::{Ahead, Apart};
use nalgebra::{Point3, Vector3};

/// A plane the ball is known to touch at the start of its path: the contact it just had, or has.
///
/// What lies behind it cannot be reached before the path returns to it, so what the contact just answered is not asked again,
/// and its neighbours raise no false alarm from rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// Unit normal towards the ball.
    pub normal: Vector3<f64>,
    /// A point of the plane.
    pub point: Point3<f64>,
    /// How far the ball's position, and so the plane, may be off by rounding.
    pub slack: f64,
    /// The f at which the path returns to the plane, infinite if never.
    pub until: f64,
    /// A face of a mesh to which it returns, if it goes nowhere in between: the first to be asked. It changes no answer.
    pub face: Option<u32>,
}

impl Hold {
    /// Whether the triangle is behind the plane, as far as that can be told.
    #[inline]
    fn hides(&self, triangle: &[Point3<f64>; 3]) -> bool {
        let is_behind = |v: &Point3<f64>| {
            let d = v - self.point;
            self.normal.dot(&d) <= self.slack + hold_bound(amax(&d))
        };
        let [a, b, c] = triangle;
        is_behind(a) && is_behind(b) && is_behind(c)
    }
}

/// A moving ball: its path, its radius, and what it is known to touch at the start.
#[derive(Debug, Clone, Copy)]
pub struct MovingBall<'a> {
    /// The centre's path.
    pub path: &'a Path,
    /// The radius, > 0: a point is a ball of the least radius that f64 resolves there.
    pub radius: f64,
    /// Planes that it touches at the start.
    pub holds: &'a [Hold],
}

impl MovingBall<'_> {
    /// The triangle relative to the start of the path: what is far from the origin costs no digits.
    #[inline]
    pub(crate) fn asked(&self, triangle: &[Point3<f64>; 3]) -> Asked {
        let start = self.path.start();
        let [a, b, c] = triangle;
        Asked::new([a - start, b - start, c - start])
    }

    /// Whether the plane that faces the ball at `to` is enough to certify that it stays farther than `reach` off a triangle in
    /// [`from`, `to`]: so it is for most triangles around one that is hit at `to`.
    pub(crate) fn stays_off(&self, asked: &Asked, from: f64, to: f64, reach: f64) -> bool {
        let Support { normal, gap, .. } = Support::at(self, asked, to);
        let clearance = self.path.clearance(gap + self.radius - reach, &normal);
        clearance.at(from) > 0.0 && clearance.at(to) > 0.0 && clearance.first_entry(from, to) == Entry::Never
    }

    /// The f, at least `from`, before which the holds keep the ball off `triangle`.
    #[inline]
    pub(crate) fn held_off(&self, triangle: &[Point3<f64>; 3], from: f64) -> f64 {
        let mut f = from;
        for hold in self.holds {
            if hold.until > f && hold.hides(triangle) {
                f = hold.until;
            }
        }
        f
    }
}

/// How the search for a contact ended.
///
/// ```
/// use carom_geometry::contact::{Contact, MovingBall, first_contact};
/// use carom_geometry::nalgebra::{Point3, Vector3};
/// use carom_geometry::path::Path;
/// use carom_geometry::triangle::Feature;
///
/// let triangle = [Point3::origin(), Point3::new(4.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0)];
/// let falling = |x: f64| Path::line(Point3::new(x, 1.0, 3.0), Vector3::new(0.0, 0.0, -4.0));
/// let contact = |path: &Path| first_contact(&MovingBall { path, radius: 1.0, holds: &[] }, &triangle, 0.0, 1.0, &mut 0);
/// // Onto the face; past the edge from corner 2 to corner 0, which is nearer than the radius; and past all of it.
/// assert_eq!(contact(&falling(1.0)), Contact::At { f: 0.5, feature: Feature::Face });
/// assert!(matches!(contact(&falling(-0.5)), Contact::At { feature: Feature::Edge(2), .. }));
/// assert_eq!(contact(&falling(-1.5)), Contact::Miss);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contact {
    /// No contact in [0, to]: certified by a plane.
    Miss,
    /// First contact at `f`: within one [`contact_bound`] of touching there, and never deeper before. A graze in doubt, which rounding
    /// keeps from touching, is reported where it is nearest, at most [`contact_doubt`](crate::rounding::contact_doubt) away.
    At {
        /// Where on the path.
        f: f64,
        /// What of the triangle is touched.
        feature: Feature,
    },
}

/// Support planes looked at before a contact that creeps (a graze, whose rounds converge linearly) is taken as it stands.
const MAX_ROUNDS: u32 = 256;

/// The first f in [`from`, `to`] at which the ball touches `triangle` and closes in; `rounds` counts support planes.
pub fn first_contact(ball: &MovingBall, triangle: &[Point3<f64>; 3], from: f64, to: f64, rounds: &mut u64) -> Contact {
    match contact_from(ball, &ball.asked(triangle), ball.held_off(triangle, from), to, rounds) {
        Contact::At { f, feature } => Contact::At { f: f.min(to), feature },
        Contact::Miss => Contact::Miss,
    }
}

/// [`first_contact`], but `from` is where the holds let go, and what is found has the same bits for every `to` <= 1, so that it may lie beyond `to` by rounding.
pub(crate) fn contact_from(ball: &MovingBall, asked: &Asked, from: f64, to: f64, rounds: &mut u64) -> Contact {
    if from > to {
        return Contact::Miss;
    }
    let query = Query::new(ball, asked, to);
    let (mut f, mut looked) = (from, false);
    for _ in 0..MAX_ROUNDS {
        if f > to {
            return Contact::Miss;
        }
        *rounds += 1;
        let bound = 2.0 * query.bound_at(f);
        let ahead = match query.face_at(f) {
            // Twice the bound: where it is met by the bound, there is no asking it again.
            Some(plane) if plane.at(f) > 2.0 * bound => query.by_face(&plane, f, rounds),
            _ => query.by_nearest(f, bound, &mut looked, rounds),
        };
        match ahead {
            Ahead::Ends(contact) => return contact,
            Ahead::FreeUntil(next) => f = next,
        }
    }
    if f > to {
        return Contact::Miss;
    }
    Contact::At { f, feature: Support::at(ball, asked, f).feature }
}

/// A ball asked for its contact with a triangle.
struct Query<'a> {
    ball: &'a MovingBall<'a>,
    asked: &'a Asked,
    /// How far the triangle reaches from the start of the path, or the radius.
    size: f64,
    /// The unit normal of the face, if it has one.
    normal: Option<Vector3<f64>>,
    /// The end of the search.
    to: f64,
    /// Planes are met on the whole path: a contact where the search ends is decided as one before it.
    end: f64,
}

impl<'a> Query<'a> {
    #[inline]
    fn new(ball: &'a MovingBall<'a>, asked: &'a Asked, to: f64) -> Self {
        let size = asked.corners().iter().map(amax).fold(ball.radius, largest);
        Self { ball, asked, size, normal: asked.normal(), to, end: to.max(1.0) }
    }

    #[inline]
    fn bound_at(&self, f: f64) -> f64 {
        contact_bound(self.size + self.ball.path.reach(f))
    }

    /// Where after `f` the ball meets a plane, and the bound that was taken off: never late, since the plane is moved towards the ball by the bound that
    /// holds where the path meets it.
    #[inline]
    fn meets(&self, plane: &Clearance, f: f64) -> (Entry, f64) {
        let bound = 2.0 * self.bound_at(f);
        let entry = plane.beyond(bound).first_entry(f, self.end);
        match entry {
            Entry::At { f: next, .. } if self.bound_at(next) > bound => {
                let bound = self.bound_at(next);
                (plane.beyond(bound).first_entry(f, self.end), bound)
            }
            _ => (entry, bound),
        }
    }

    /// What the `plane` of the face tells, from which the ball is apart at `f`, and what is seen from where it meets that.
    #[inline]
    fn by_face(&self, plane: &Clearance, f: f64, rounds: &mut u64) -> Ahead {
        let mut until = None;
        let met = match plane.first_entry(f, self.end) {
            Entry::At { f: met, .. } if met <= self.to => met,
            // Never or too late, but perhaps only by rounding.
            entry => {
                let (Entry::At { f: free, rate }, _) = self.meets(plane, f) else { return Ahead::Ends(Contact::Miss) };
                if free > self.to {
                    return Ahead::Ends(Contact::Miss);
                }
                until = Some(free);
                match entry {
                    Entry::At { f: met, .. } => met,
                    Entry::Never if rate < 0.0 => free,
                    Entry::Never => return Ahead::FreeUntil(free),
                }
            }
        };
        let place = self.ball.path.displacement(met);
        match self.asked.nearest(&place) {
            // Met over its inside, the face is what is touched.
            Feature::Face => Ahead::Ends(Contact::At { feature: Feature::Face, f: met }),
            feature => self.look_ahead(feature, met, &mut Apart::new(*plane, f, until), rounds),
        }
    }

    /// What the plane tells that faces the ball at `f`, which touches if it is no farther off than `bound`, and what is seen from where it meets that, unless
    /// it was `looked` for before.
    fn by_nearest(&self, f: f64, bound: f64, looked: &mut bool, rounds: &mut u64) -> Ahead {
        let (feature, plane) = self.near(f, bound);
        let touches = plane.at(f) <= bound && plane.rate(f) < 0.0;
        let contact = |bound: f64, rounds: &mut u64| {
            Ahead::Ends(Contact::At { feature, f: self.polish((feature, plane, f), f, bound, rounds) })
        };
        if touches {
            return contact(bound, rounds);
        }
        let (entry, moved) = self.meets(&plane, f);
        let Entry::At { f: next, .. } = entry else { return Ahead::Ends(Contact::Miss) };
        let bound = 2.0 * moved;
        if (plane.at(f) <= bound && plane.rate(f) < 0.0) || next - f <= 2.0 * UNIT_ROUNDOFF * f {
            return contact(bound, rounds);
        }
        if *looked || next > self.to {
            return Ahead::FreeUntil(next);
        }
        *looked = true;
        self.look_ahead(feature, next, &mut Apart::new(plane, f, Some(next)), rounds)
    }

    /// From `f`, where the ball touches to within the bound, to where it touches: support planes again, now where they are. The triangle
    /// is behind them all the same, so this ends at the contact to the rounding of the planes: on a face at once, at an edge or a vertex in
    /// a step or two of Newton's method. The first is the `plane` that faces the ball at `seen`, of that `feature`.
    fn polish(&self, (feature, plane, seen): (Feature, Clearance, f64), f: f64, bound: f64, rounds: &mut u64) -> f64 {
        let (mut f, mut feature, mut plane, mut seen) = (f, feature, plane, seen);
        for _ in 0..MAX_POLISH {
            let Entry::At { f: next, .. } = plane.first_entry(f, self.end) else {
                break;
            };
            let is_as_seen = || self.is_as_seen(&self.ball.path.displacement(seen), next);
            let arrived = next - f <= 2.0 * UNIT_ROUNDOFF * f || feature == Feature::Face || is_as_seen();
            f = next;
            if arrived {
                break;
            }
            *rounds += 1;
            seen = f;
            (feature, plane) = self.near(f, bound);
        }
        f
    }

    /// Whether a plane that faces the ball with its centre at `seen` is as near to an edge or a vertex at `f` as rounding tells: the ball, which is round, is off it there
    /// by half the square of its way over its radius.
    #[inline]
    fn is_as_seen(&self, seen: &Vector3<f64>, f: f64) -> bool {
        let way = self.ball.path.displacement(f) - seen;
        way.norm_squared() < round_bound(self.ball.radius, self.size)
    }

    /// The clearance from the plane of the triangle, seen from the side the ball is on at `f`. While the ball has not met it, it is as good a
    /// certificate as any, and for a contact with the face the only one needed.
    #[inline]
    fn face_at(&self, f: f64) -> Option<Clearance> {
        let (n, corners) = (self.normal?, self.asked.corners());
        let n = if n.dot(&(self.ball.path.displacement(f) - corners[0])) < 0.0 { -n } else { n };
        Some(Support::of(self.ball, corners, n, Feature::Face).clearance(self.ball))
    }

    /// What is closest to the ball at `f`, and the path's clearance from the plane that faces it there; where the ball touches the border of the triangle to within `bound`, the
    /// better of that and the face's own.
    ///
    /// For a ball that is small beside the triangle, the direction to the border is rounding: a plane that it turns towards the face has that in
    /// front, and tells nothing; one that it turns away closes in on a ball that rises from the face.
    fn near(&self, f: f64, bound: f64) -> (Feature, Clearance) {
        let support = Support::at(self.ball, self.asked, f);
        let (feature, plane) = (support.feature, support.clearance(self.ball));
        let height = plane.at(f);
        if feature == Feature::Face || height > bound {
            return (feature, plane);
        }
        let Some(face) = self.face_at(f) else { return (feature, plane) };
        let better = face.at(f) >= -bound && (height < -bound || face.rate(f) >= 0.0);
        (feature, if better { face } else { plane })
    }
}

/// A support plane of a triangle, from the start of the path.
struct Support {
    /// Unit normal towards the ball.
    normal: Vector3<f64>,
    /// The distance between plane and ball at the start.
    gap: f64,
    /// What of the triangle is closest to the ball.
    feature: Feature,
}

impl Support {
    /// The plane across `normal`.
    #[inline]
    fn of(ball: &MovingBall, corners: &[Vector3<f64>; 3], normal: Vector3<f64>, feature: Feature) -> Self {
        Self { normal, gap: -farthest_along(corners, &normal) - ball.radius, feature }
    }

    /// The plane that faces the ball at `f`.
    #[inline]
    fn at(ball: &MovingBall, asked: &Asked, f: f64) -> Self {
        let closest = asked.closest(&ball.path.displacement(f));
        let corners = asked.corners();
        let (away, distance) = (closest.offset, closest.offset.norm());
        let normal = if distance > 0.0 { away / distance } else { escape_direction(corners, ball.path, f) };
        Self::of(ball, corners, normal, closest.feature)
    }

    /// The path's clearance from it.
    #[inline]
    fn clearance(&self, ball: &MovingBall) -> Clearance {
        ball.path.clearance(self.gap, &self.normal)
    }
}

/// How far the triangle reaches along `normal`, from the start of the path.
fn farthest_along(corners: &[Vector3<f64>; 3], normal: &Vector3<f64>) -> f64 {
    let [a, b, c] = corners;
    largest(largest(normal.dot(a), normal.dot(b)), normal.dot(c))
}

/// Support planes looked at to polish a contact: from within its bound, a graze comes nearer by a factor of 4 with each.
const MAX_POLISH: u32 = 8;

/// Where to look when the centre lies on the triangle: across the face, to the side the ball moves to.
fn escape_direction(corners: &[Vector3<f64>; 3], path: &Path, f: f64) -> Vector3<f64> {
    let [a, b, c] = corners;
    let across = unit(&(b - a).cross(&(c - a)));
    let velocity = path.derivative(f);
    match across.or_else(|| unit(&velocity)).map(|n| n.into_inner()) {
        Some(n) if n.dot(&velocity) < 0.0 => -n,
        Some(n) => n,
        None => Vector3::x(),
    }
}

#[cfg(test)]
mod tests;
