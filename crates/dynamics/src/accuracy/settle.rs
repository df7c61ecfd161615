//! The end of bouncing in the reference: the sum of the last hops, then rest, or a slide along a straight line.

use super::course::slow;
use super::real::{Real, Vector, dot, norm, scale, sub};
use super::taylor::Field;
use crate::effects::friction::{ContactFriction, Friction};
use crate::surface::Material;

/// What becomes of a ball that stays in contact.
pub struct Settled {
    /// Stretches of constant acceleration: acceleration, velocity at the start, duration.
    pub pieces: Vec<(Vector, Vector, Real)>,
    /// Whether it rests after them.
    pub rest: bool,
    /// Whether they reach to the end of the scene.
    pub complete: bool,
}

/// At the time `now`, a ball with velocity `v` and normal speed `rate` on a surface of unit normal `n`, for at most `remaining` seconds.
///
/// Only a plane (`on_plane`) carries a slide, because it has no end; and only where nothing but gravity acts.
#[allow(clippy::too_many_arguments, reason = "the whole of a contact")]
pub fn settle(
    field: &Field,
    n: &Vector,
    rate: &Real,
    material: &Material,
    v: &Vector,
    now: &Real,
    remaining: &Real,
    on_plane: bool,
) -> Settled {
    let zero = Real::zero();
    let c_r = Real::from(material.restitution.coefficient());
    let along = |w: &Vector| sub(w, &scale(n, &dot(n, w)));
    let mut v_t = along(v);
    let a = field.acceleration(&v_t, now);
    let (pressed, a_t) = (-dot(n, &a), along(&a));
    let mut settled = Settled { pieces: Vec::new(), rest: false, complete: false };
    if pressed <= zero {
        return settled;
    }
    let mut left = remaining.clone();
    let one = Real::from(1.0);
    if *rate > zero && c_r < one {
        // Hops of 2 v/a, 2 e v/a, ...: geometric series of their times and of the closing speeds at their ends.
        let tail = &one - &c_r;
        let seconds = &(&(rate + rate) / &pressed) / &tail;
        let seconds = if seconds < left { seconds } else { left.clone() };
        settled.pieces.push((a_t.clone(), v_t.clone(), seconds.clone()));
        v_t = [0, 1, 2].map(|i| &v_t[i] + &(&a_t[i] * &seconds));
        left = &left - &seconds;
        v_t = match material.friction {
            Friction::Linear(c_f) if c_f.get() > 0.0 => scale(&v_t, &zero),
            _ => slow(&material.friction, &v_t, &(rate / &tail), &c_r),
        };
    }
    let grip = match material.friction.in_contact() {
        ContactFriction::Sticking => None,
        ContactFriction::Sliding(mu) => Some(&Real::from(mu) * &pressed),
    };
    let (speed, pull) = (norm(&v_t), norm(&a_t));
    // Below the digits of the flight, and of what is left of a projection.
    let still = speed.to_f64() <= 2f64.powi(-100) * (norm(v).to_f64() + pressed.to_f64());
    let level = pull.to_f64() <= 2f64.powi(-100) * pressed.to_f64();
    let Some(grip) = grip else {
        settled.rest = true;
        return settled;
    };
    if still && (level || pull <= grip) {
        settled.rest = field.is_constant() || level;
        return settled;
    }
    if !on_plane || !field.is_constant() {
        return settled;
    }
    let direction = if still { scale(&a_t, &(&one / &pull)) } else { scale(&v_t, &(&one / &speed)) };
    let across = norm(&sub(&a_t, &scale(&direction, &dot(&a_t, &direction))));
    if grip.is_zero() {
        settled.pieces.push((a_t, v_t, left));
        settled.complete = true;
        return settled;
    }
    if across.to_f64() > 2f64.powi(-90) * pressed.to_f64() {
        return settled;
    }
    let braking = &grip - &dot(&a_t, &direction);
    let slide = scale(&direction, &-&braking);
    if braking > zero && &speed / &braking < left {
        settled.pieces.push((slide, v_t, &speed / &braking));
        // Down again, if friction does not hold it, is another slide.
        settled.rest = pull <= grip;
        return settled;
    }
    settled.pieces.push((slide, v_t, left));
    settled.complete = true;
    settled
}
