//! Flights in linear drag, in closed form at both ends of a step of any length: stiff air costs no more than thin air.
//!
//! v(t) = v0 + A t p1(z) and x(t) = x0 + v0 t + A t^2 p2(z) with the acceleration A at the start, z = k t / m, p1(z) = (1 - e^-z) / z and p2(z) = (z -
//! 1 + e^-z) / z^2, which lose no digits however small k is. In between the path is the quartic with the same position, velocity and
//! acceleration at the start and the same position and velocity at the end, and the step is as long as that is close enough.

use crate::body::State;
use crate::integrators::Step;
use crate::power::exponential;
use crate::tolerance::rate_rounding;
use carom_geometry::path::Path;
use nalgebra::Vector3;

/// Below this z the functions p1 and p2 are summed as series.
const SMALL: f64 = 0.5;
/// Terms of these series: the next is below the roundoff.
const TERMS: u32 = 18;
/// For small z the quartic is off by at most 0.0346 z^3 / 120 of A t^2, where f^3 (1 - f)^2 is largest; that of the velocity by z times that of A t.
const QUARTIC: f64 = 0.0346 / 120.0;
/// And for no z by more than this.
const LARGEST: f64 = 0.25;
/// A step whose error is this far below the tolerance may be doubled: (1/2)^4, a doubling's growth of the error.
const DOUBLE_BELOW: f64 = 1.0 / 16.0;

/// The method, with the step length that it last found right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damped {
    tolerance: f64,
    /// k / m in 1/s.
    rate: f64,
    next: f64,
}

impl Damped {
    /// In air that takes the share `rate` (1/s) of the relative velocity in a second, with an error of the path of `tolerance` relative to
    /// the motion of its step.
    pub fn new(tolerance: f64, rate: f64) -> Self {
        Self { tolerance, rate, next: f64::INFINITY }
    }

    /// A step of at most `remaining` seconds from `state`, where the acceleration is `a` (m/s^2), the part without resistance `constant`.
    #[inline(never)] // beside the exact flight, whose loop stays small
    pub fn step(&mut self, state: &State, remaining: f64, a: &Vector3<f64>, constant: &Vector3<f64>) -> Step {
        let rate = self.rate;
        let speed = state.velocity.norm();
        // What the resistance has left of the rest by rounding is nothing.
        let none = rate_rounding(constant.norm() + rate * speed);
        let a = if a.norm() <= none { Vector3::zeros() } else { *a };
        let push = a.norm();
        let mut h = self.next.min(remaining);
        loop {
            let z = rate * h;
            let error = push * h * (1.0 + z) * (QUARTIC * z * z * z).min(LARGEST);
            let allowed = self.tolerance * speed.max(push * h * p1(z));
            if error <= allowed || error == 0.0 {
                self.next = if error <= DOUBLE_BELOW * allowed { 2.0 * h } else { h };
                return path(state, &a, h, z);
            }
            h *= 0.5;
        }
    }
}

/// The step of `h` seconds.
fn path(state: &State, a: &Vector3<f64>, h: f64, z: f64) -> Step {
    let State { position: x, velocity: v } = *state;
    let (one, two) = (p1(z), p2(z));
    // x = x0 + v h f + A h^2 (f^2 / 2 + c3 f^3 + c4 f^4), with p2 and p1 as its value and slope at the end.
    let c4 = (one - 1.0) - 3.0 * (two - 0.5);
    let c3 = (two - 0.5) - c4;
    // v = v0 + A h (f - z f^2 / 2 + d3 f^3 + d4 f^4), with p1 and e^-z.
    let (value, slope) = (one - 1.0 + 0.5 * z, exponential(-z) - 1.0 + z);
    let d4 = slope - 3.0 * value;
    let d3 = value - d4;
    let (ah, ah2) = (a * h, a * h * h);
    Step {
        path: Path::from_terms(x, &[v * h, ah2 * 0.5, ah2 * c3, ah2 * c4]),
        velocity: [v, ah, ah * (-0.5 * z), ah * d3, ah * d4],
        seconds: h,
        to: 1.0,
        exact: false,
    }
}

/// (1 - e^-z) / z for z >= 0.
fn p1(z: f64) -> f64 {
    if z < SMALL { series(z, 1) } else { (1.0 - exponential(-z)) / z }
}

/// (z - 1 + e^-z) / z^2 for z >= 0.
fn p2(z: f64) -> f64 {
    if z < SMALL { series(z, 2) } else { (1.0 - p1(z)) / z }
}

/// The sum of (-z)^n / (n + k)!.
fn series(z: f64, k: u32) -> f64 {
    let first = if k == 2 { 0.5 } else { 1.0 };
    first * (1..=TERMS).rev().fold(1.0, |sum, n| 1.0 - sum * z / f64::from(n + k))
}
