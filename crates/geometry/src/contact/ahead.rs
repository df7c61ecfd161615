//! Looking for a contact where it seems to be: the plane that is seen from there often tells all at once.

use super::{Contact, Entry, Query, Support};
use crate::bounds::largest;
use crate::closest::Feature;
use crate::order::by_size;
use crate::rounding::{exponent, power_of_two};
use nalgebra::Vector3;

/// How often to look ahead: the edge that is nearest first may not be the one, nor its end.
const MAX_LOOKS: u32 = 3;

/// Steps to a place to look at: a straight path needs one, and a parabola trebles its digits with each.
const MAX_STEPS: u32 = 6;

/// What a look ahead told.
pub(super) enum Ahead {
    /// How the search ends.
    Ends(Contact),
    /// There is no contact before this f.
    FreeUntil(f64),
}

impl Query<'_> {
    /// Looks at the triangle from where the ball seems to meet `feature`, which is nearest to it at `f`. Any plane with the triangle behind it
    /// that the ball does not overlap at `f` is a certificate from there on, wherever it was taken. There is no contact before `free`, that is known.
    pub(super) fn look_ahead(&self, feature: Feature, f: f64, free: f64, to: f64, rounds: &mut u64) -> Ahead {
        // In a unit in which squares are in range.
        let unit = power_of_two(-exponent(self.size));
        let (mut f, mut free, mut feature) = (f, free, feature);
        for _ in 0..MAX_LOOKS {
            let Some(there) = self.seems_to_touch(feature, free, unit).filter(|there| *there < self.end) else { break };
            *rounds += 1;
            let near = 2.0 * self.bound_at(there);
            let (closest, plane) = Support::near(self.ball, self.asked, there, near);
            if plane.at(f) <= 2.0 * self.bound_at(f) {
                break;
            }
            let (entry, bound) = self.meets(&plane, f);
            f = match entry {
                Entry::At { f: next, .. } if next <= to => next,
                _ => return Ahead::Ends(Contact::Miss),
            };
            free = largest(free, f);
            if plane.at(there).abs() <= near && plane.rate(there) < 0.0 {
                let f = self.polish((closest, plane, there), f, bound, rounds);
                return Ahead::Ends(Contact::At { f, feature: closest });
            }
            if closest == feature {
                break;
            }
            feature = closest;
        }
        Ahead::FreeUntil(free)
    }

    /// Where after `f` the ball seems to touch a vertex or the line of an edge, or to pass it: as if the square of its distance were a parabola, and again
    /// from there (Halley's method). Rounding and the other features are not asked. `unit` is what lengths are multiplied by.
    fn seems_to_touch(&self, feature: Feature, f: f64, unit: f64) -> Option<f64> {
        let (path, radius) = (self.ball.path, self.ball.radius * unit);
        let corners = self.asked.corners().map(|corner| corner * unit);
        let (origin, along) = match feature {
            Feature::Face => return None,
            Feature::Edge(i) => {
                let (p, q) = (corners[usize::from(i)], corners[(usize::from(i) + 1) % 3]);
                if by_size(&p, &q).is_le() { (p, q - p) } else { (q, p - q) }
            }
            Feature::Vertex(i) => (corners[usize::from(i)], Vector3::zeros()),
        };
        let square = along.norm_squared();
        let per_square = if square > 0.0 { 1.0 / square } else { 0.0 };
        let across = |v: Vector3<f64>| v - along * (along.dot(&v) * per_square);
        let near = 2.0 * self.bound_at(f) * unit * radius;
        let mut at = f;
        for _ in 0..MAX_STEPS {
            let (away, velocity) = (across(path.displacement(at) * unit - origin), across(path.derivative(at) * unit));
            let (a, b) = (velocity.norm_squared(), away.dot(&velocity));
            let c = away.norm_squared() - radius * radius;
            if c.abs() <= near {
                break;
            }
            let bend = across(path.second_derivative(at) * unit);
            let discriminant = b * b - (a + away.dot(&bend)) * c;
            if discriminant < 0.0 || b >= 0.0 {
                at -= b / a; // where it is nearest
                break;
            }
            at += c / (discriminant.sqrt() - b);
        }
        (at > f).then_some(at)
    }
}
