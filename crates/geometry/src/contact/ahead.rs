//! Looking for a contact where it seems to be: the plane that is seen from there often tells all at once.

use super::{Contact, Entry, Query};
use crate::bounds::{largest, least};
use crate::clearance::Clearance;
use crate::closest::{Feature, Foot, ends_of_edge};
use crate::rounding::{exponent, power_of_two, round_bound};
use nalgebra::Vector3;

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

/// A plane from which the ball is apart, and what is known of where there is no contact.
pub(super) struct Apart {
    plane: Clearance,
    /// The f at which it is.
    at: f64,
    /// Until where it surely is, if that is known.
    until: Option<f64>,
    /// There is no contact before this, by other planes.
    free: f64,
}

impl Apart {
    pub(super) fn new(plane: Clearance, at: f64, until: Option<f64>) -> Self {
        Self { plane, at, until, free: at }
    }
}

/// What a look at one edge or vertex told.
enum Look {
    /// How the search ends.
    Ends(Contact),
    /// What else to look at, and from where on the path.
    At(Feature, f64),
}

impl Query<'_> {
    /// Looks at the triangle from where the ball seems to meet `feature`, which is nearest to it at `from`, and goes on from what is seen there. Until the ball meets the
    /// plane that it is `apart` from, there is no contact.
    pub(super) fn look_ahead(&self, feature: Feature, from: f64, apart: &mut Apart, rounds: &mut u64) -> Ahead {
        let (mut feature, mut from) = (feature, from);
        for _ in 0..MAX_LOOKS {
            let Some(part) = Part::of(feature, self.asked.corners()) else { break };
            match self.look(&part, from, apart, rounds) {
                Look::Ends(contact) => return Ahead::Ends(contact),
                Look::At(other, f) if (other, f) == (feature, from) => break,
                Look::At(other, f) => (feature, from) = (other, f),
            }
        }
        match self.free_until(apart) {
            Some(free) => Ahead::FreeUntil(free),
            None => Ahead::Ends(Contact::Miss),
        }
    }

    /// Looks at `part` from where the ball seems to meet it. Any plane with the triangle behind it that the ball does not overlap at some f is a
    /// certificate from there on, wherever it was taken.
    #[inline]
    fn look(&self, part: &Part, from: f64, apart: &mut Apart, rounds: &mut u64) -> Look {
        let there = self.seems_to_touch(part, from);
        let place = self.ball.path.displacement(there);
        let (plane, is_closest) = match self.see(part, &place) {
            Ok(seen) => seen,
            Err(other) => return Look::At(other, from),
        };
        *rounds += 1;
        let is_apart = |f: f64| plane.at(f) > 2.0 * self.bound_at(f);
        let mut start = apart.at;
        if !is_apart(start) {
            let Some(free) = self.free_until(apart) else { return Look::Ends(Contact::Miss) };
            if !is_apart(free) {
                return Look::At(self.asked.nearest(&place), from);
            }
            start = free;
        }
        let near = 2.0 * self.bound_at(there);
        let is_closest = is_closest && self.is_through_face(&place, near);
        let feature = part.feature;
        if is_closest
            && let Entry::At { f, .. } = plane.first_entry(start, self.end)
            && self.is_as_seen(&place, f)
        {
            let in_time = f <= self.to || self.meets(&plane, start).0.f().is_some_and(|f| f <= self.to);
            return Look::Ends(if in_time { Contact::At { f, feature } } else { Contact::Miss });
        }
        let (Entry::At { f: free, .. }, moved) = self.meets(&plane, start) else { return Look::Ends(Contact::Miss) };
        if free > self.to {
            return Look::Ends(Contact::Miss);
        }
        if is_closest && plane.at(there).abs() <= near && plane.rate(there) < 0.0 {
            // A graze: it touches there, or before.
            let f = self.polish((feature, plane, there), free, 2.0 * moved, rounds);
            return Look::Ends(Contact::At { f, feature });
        }
        apart.free = largest(apart.free, free);
        let later = if free > there { self.ball.path.displacement(free) } else { place };
        Look::At(self.asked.nearest(&later), largest(from, free))
    }

    /// Until where there surely is no contact; none if the ball meets the plane nowhere.
    #[inline]
    fn free_until(&self, apart: &mut Apart) -> Option<f64> {
        if apart.until.is_none() {
            apart.until = self.meets(&apart.plane, apart.at).0.f();
        }
        apart.until.map(|until| largest(until, apart.free))
    }

    /// Whether the ball, with its centre at `place`, reaches through the plane of the face: by more than `bound`, so that it is an edge or a vertex that it touches.
    #[inline]
    fn is_through_face(&self, place: &Vector3<f64>, bound: f64) -> bool {
        let height = |n: Vector3<f64>| n.dot(&(place - self.asked.corners()[0])).abs();
        self.normal.is_none_or(|n| height(n) < self.ball.radius - bound)
    }

    /// The plane across the direction from `part` of the triangle to a `place` of the centre; whether that is what is closest there; or what else may be.
    #[inline]
    fn see(&self, part: &Part, place: &Vector3<f64>) -> Result<(Clearance, bool), Feature> {
        let corners = self.asked.corners();
        let [from, to] = part.ends.map(|i| &corners[usize::from(i)]);
        let offset = if part.is_edge() {
            let foot = Foot::on([from, to], place);
            if !(0.0..=1.0).contains(&foot.part) {
                return Err(Feature::Vertex(part.ends[usize::from(foot.part > 0.5)]));
            }
            foot.offset
        } else {
            place - from
        };
        let distance = offset.norm();
        if distance == 0.0 {
            return Err(Feature::Face);
        }
        let normal = offset / distance;
        let heights = corners.map(|corner| normal.dot(&corner));
        let own = part.ends.map(|i| heights[usize::from(i)]);
        let farthest = largest(largest(heights[0], heights[1]), heights[2]);
        let plane = self.ball.path.clearance(-farthest - self.ball.radius, &normal);
        Ok((plane, largest(own[0], own[1]) == farthest))
    }

    /// Where from `from` on, but not after the end, the ball seems to touch a vertex or the line of an edge, or to pass it, if it goes on with its acceleration there:
    /// as if the square of its distance were a parabola, and again from there (Halley's method). Rounding and the other features are not asked.
    #[inline]
    fn seems_to_touch(&self, part: &Part, from: f64) -> f64 {
        let (path, corners) = (self.ball.path, self.asked.corners());
        // In a unit in which squares are in range.
        let unit = power_of_two(-exponent(self.size));
        let [origin, end] = part.ends.map(|i| &corners[usize::from(i)]);
        // Zero for a vertex.
        let along = (end - origin) * unit;
        let per_square = if part.is_edge() { 1.0 / along.norm_squared() } else { 0.0 };
        let across = |v: Vector3<f64>| {
            let v = v * unit;
            v - along * (along.dot(&v) * per_square)
        };
        let away = across(path.displacement(from) - origin);
        let (velocity, bend) = (across(path.derivative(from)), across(path.second_derivative(from)));
        // By how much the square of the distance is larger than that of the radius: c + 2 b s + a s^2 + 2 k s^3 + l s^4 / 2 after s.
        let radius = self.ball.radius * unit;
        let speed_squared = velocity.norm_squared();
        let (c, b, a) = (away.norm_squared() - radius * radius, away.dot(&velocity), speed_squared + away.dot(&bend));
        let (k, l) = (0.5 * velocity.dot(&bend), 0.5 * bend.norm_squared());
        let enough = round_bound(radius, self.size * unit);
        let mut s = 0.0;
        for _ in 0..MAX_STEPS {
            let height = c + (2.0 * b + (a + (2.0 * k + 0.5 * l * s) * s) * s) * s;
            let slope = b + (a + (3.0 * k + l * s) * s) * s;
            let discriminant = slope * slope - (a + (6.0 * k + 3.0 * l * s) * s) * height;
            if discriminant < 0.0 || slope >= 0.0 {
                s -= slope / speed_squared; // where it is nearest
                break;
            }
            let step = height / (discriminant.sqrt() - slope);
            // What this leaves out moves the square by so much, and so the place by it over twice the root and by the speed.
            let left_out = (2.0 * (k + l * s) + 0.5 * l * step) * step * (step * step);
            s += step;
            if left_out * left_out * speed_squared < enough * discriminant {
                break;
            }
        }
        if s > 0.0 { least(from + s, self.end) } else { from }
    }
}

/// An edge or a vertex.
struct Part {
    feature: Feature,
    /// The corners where it begins and ends: of an edge, the same from each face that has it.
    ends: [u8; 2],
}

impl Part {
    /// A face is neither.
    #[inline]
    fn of(feature: Feature, corners: &[Vector3<f64>; 3]) -> Option<Self> {
        let ends = match feature {
            Feature::Face => return None,
            Feature::Vertex(i) => [i, i],
            Feature::Edge(i) => ends_of_edge(i, |i| &corners[usize::from(i)]),
        };
        Some(Self { feature, ends })
    }

    fn is_edge(&self) -> bool {
        matches!(self.feature, Feature::Edge(_))
    }
}
