//! Looking for a contact where it seems to be: the plane that is seen from there often tells all at once.

use super::{Contact, Entry, Query, farthest_along};
use crate::bounds::{largest, least};
use crate::clearance::Clearance;
use crate::closest::{Feature, Foot};
use crate::order::by_size;
use crate::path::Path;
use crate::rounding::{exponent, power_of_two, round_bound};
use nalgebra::{Point3, Vector3};

/// How often to look ahead: the edge that is nearest first may not be the one, nor its end.
const MAX_LOOKS: u32 = 4;

/// Steps to a place to look at: a straight path needs one, and a parabola trebles its digits with each.
const MAX_STEPS: u32 = 6;

/// What a look ahead told.
pub(super) enum Ahead {
    /// How the search ends.
    Ends(Contact),
    /// There is no contact before this f.
    FreeUntil(f64),
}

/// A plane from which the ball is apart.
pub(super) struct Apart {
    pub(super) plane: Clearance,
    /// The f at which it is.
    pub(super) at: f64,
    /// Until where it surely is, if that is known.
    pub(super) until: Option<f64>,
}

/// What is seen of a feature from a place.
enum Seen {
    /// Its plane; and whether the feature is what is closest there.
    Plane(Clearance, bool),
    /// It is not the feature that is seen, but perhaps this one.
    Other(Feature),
}

impl Query<'_> {
    /// Looks at the triangle from where the ball seems to meet `feature`, which is nearest to it at `from`. Any plane with the triangle behind it
    /// that the ball does not overlap at some f is a certificate from there on, wherever it was taken. Until it meets the plane that it is `apart` from, there is no contact.
    pub(super) fn look_ahead(&self, feature: Feature, from: f64, apart: &mut Apart, rounds: &mut u64) -> Ahead {
        // In a unit in which squares are in range.
        let unit = power_of_two(-exponent(self.size));
        let (mut feature, mut from) = (feature, from);
        for _ in 0..MAX_LOOKS {
            let Some(there) = self.seems_to_touch(feature, from, unit) else { break };
            let place = self.ball.path.displacement(there);
            let (plane, is_closest) = match self.see(feature, &place) {
                Seen::Plane(plane, is_closest) => (plane, is_closest),
                Seen::Other(other) => {
                    feature = other;
                    continue;
                }
            };
            *rounds += 1;
            let is_apart = |f: f64| plane.at(f) > 2.0 * self.bound_at(f);
            let mut start = apart.at;
            if !is_apart(start) {
                let Some(until) = self.until(apart) else { return Ahead::Ends(Contact::Miss) };
                if !is_apart(until) {
                    let closest = self.asked.nearest(&place);
                    if closest == feature {
                        break;
                    }
                    feature = closest;
                    continue;
                }
                start = until;
            }
            let near = 2.0 * self.bound_at(there);
            let is_closest = is_closest && self.face_at(there).is_none_or(|face| face.at(there) < -near);
            if is_closest
                && let Entry::At { f, .. } = plane.first_entry(start, self.end)
                && self.is_as_seen(there, f)
            {
                let in_time = f <= self.to || matches!(self.meets(&plane, start).0, Entry::At { f, .. } if f <= self.to);
                return Ahead::Ends(if in_time { Contact::At { f, feature } } else { Contact::Miss });
            }
            let (free, bound) = match self.meets(&plane, start) {
                (Entry::At { f, .. }, bound) if f <= self.to => (f, bound),
                _ => return Ahead::Ends(Contact::Miss),
            };
            if is_closest && plane.at(there).abs() <= near && plane.rate(there) < 0.0 {
                // A graze: it touches there, or before.
                let f = self.polish((feature, plane, there), free, bound, rounds);
                return Ahead::Ends(Contact::At { f, feature });
            }
            apart.until = Some(apart.until.map_or(free, |until| largest(until, free)));
            let closest = if free <= there {
                self.asked.nearest(&place)
            } else {
                self.asked.nearest(&self.ball.path.displacement(free))
            };
            if closest == feature && free <= from {
                break;
            }
            (feature, from) = (closest, largest(from, free));
        }
        match self.until(apart) {
            Some(until) => Ahead::FreeUntil(until),
            None => Ahead::Ends(Contact::Miss),
        }
    }

    /// Until where the ball surely is apart from the plane; none if it meets it nowhere.
    fn until(&self, apart: &mut Apart) -> Option<f64> {
        if apart.until.is_none() {
            apart.until = self.meets(&apart.plane, apart.at).0.f();
        }
        apart.until
    }

    /// The plane across the direction from an edge or a vertex to a `place` of the centre.
    fn see(&self, feature: Feature, place: &Vector3<f64>) -> Seen {
        let corners = self.asked.corners();
        let (offset, own) = match feature {
            Feature::Face => return Seen::Other(feature),
            Feature::Vertex(i) => (place - corners[usize::from(i)], [i, i]),
            Feature::Edge(i) => {
                let j = (i + 1) % 3;
                let [p, q] = [i, j].map(|i| Point3::from(corners[usize::from(i)]));
                let foot = Foot::on(&p, &q, &Point3::from(*place));
                if !(0.0..=1.0).contains(&foot.part) {
                    let nearer = (place - p.coords).norm_squared() < (place - q.coords).norm_squared();
                    return Seen::Other(Feature::Vertex(if nearer { i } else { j }));
                }
                (foot.offset, [i, j])
            }
        };
        let distance = offset.norm();
        if !(distance > 0.0) {
            return Seen::Other(Feature::Face);
        }
        let normal = offset / distance;
        let [own, other] = own.map(|i| normal.dot(&corners[usize::from(i)]));
        let farthest = farthest_along(corners, &normal);
        let plane = self.ball.path.clearance(-farthest - self.ball.radius, &normal);
        Seen::Plane(plane, largest(own, other) == farthest)
    }

    /// Where from `from` on, but not after the end, the ball seems to touch a vertex or the line of an edge, or to pass it: as if the square of its distance were a parabola, and again
    /// from there (Halley's method). Rounding and the other features are not asked. `unit` is what lengths are multiplied by.
    fn seems_to_touch(&self, feature: Feature, from: f64, unit: f64) -> Option<f64> {
        let radius = self.ball.radius * unit;
        let corner = |i: u8| self.asked.corners()[usize::from(i)] * unit;
        let (origin, along) = match feature {
            Feature::Face => return None,
            Feature::Edge(i) => {
                let (p, q) = (corner(i), corner((i + 1) % 3));
                if by_size(&p, &q).is_le() { (p, q - p) } else { (q, p - q) }
            }
            Feature::Vertex(i) => (corner(i), Vector3::zeros()),
        };
        let square = along.norm_squared();
        let per_square = if square > 0.0 { 1.0 / square } else { 0.0 };
        let across = |v: Vector3<f64>| v - along * (along.dot(&v) * per_square);
        let way = Way::new(self.ball.path, across(-origin), |term| across(term * unit));
        let enough = round_bound(radius, self.size * unit);
        let mut at = from;
        for _ in 0..MAX_STEPS {
            let [away, velocity, bend] = way.at(at);
            let (a, b) = (velocity.norm_squared(), away.dot(&velocity));
            let c = away.norm_squared() - radius * radius;
            let discriminant = b * b - (a + away.dot(&bend)) * c;
            if discriminant < 0.0 || b >= 0.0 {
                at -= b / a; // where it is nearest
                break;
            }
            let root = discriminant.sqrt();
            let step = c / (root - b);
            at += step;
            // Of the square, a step leaves out this: it is as much over 2 `root` too far.
            let left_out = (velocity.dot(&bend) + 0.25 * bend.norm_squared() * step) * step * (step * step);
            if left_out * left_out * a < enough * discriminant {
                break;
            }
        }
        Some(if at > from { least(at, self.end) } else { from })
    }
}

/// The way of the centre as seen from a line or a point: its Taylor terms.
struct Way {
    terms: [Vector3<f64>; 5],
    degree: usize,
}

impl Way {
    /// From `start`, along the terms of a path as `seen`.
    #[inline]
    fn new(path: &Path, start: Vector3<f64>, seen: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> Self {
        let mut terms = [Vector3::zeros(); 5];
        terms[0] = start;
        for (term, own) in terms[1..].iter_mut().zip(path.terms()) {
            *term = seen(own);
        }
        Self { terms, degree: path.terms().len() }
    }

    /// Place, velocity and half of... at f.
    #[inline]
    fn at(&self, f: f64) -> [Vector3<f64>; 3] {
        let [t0, t1, t2, t3, t4] = &self.terms;
        if self.degree <= 2 {
            let bend = t2 * f;
            return [t0 + (t1 + bend) * f, t1 + bend * 2.0, t2 * 2.0];
        }
        let place = t0 + (t1 + (t2 + (t3 + t4 * f) * f) * f) * f;
        let velocity = t1 + (t2 * 2.0 + (t3 * 3.0 + t4 * (4.0 * f)) * f) * f;
        [place, velocity, t2 * 2.0 + (t3 * 6.0 + t4 * (12.0 * f)) * f]
    }
}
