//! The exact flight under constant acceleration: a parabola, or a straight line, for a step of any length.

use crate::body::State;
use crate::integrators::Step;
use carom_geometry::bounds::amax;
use carom_geometry::path::Path;
use nalgebra::Vector3;

/// By how much a flight is cut shorter that leaves the range of f64: 2^-64.
const SHORTER: f64 = 1.0 / (1u128 << 64) as f64;

/// The flight from `state` under the constant acceleration `a` for `remaining` seconds.
///
/// A flight that leaves the range of f64 is cut shorter, to where it has not left it: what is not a number hits nothing.
///
/// f = 1 stands for the next power of two of seconds, so that the path's terms v h and a h^2 / 2 are exact, and the same
/// flight is the same bits however much time remains.
#[inline]
pub fn step(state: &State, a: Vector3<f64>, remaining: f64) -> Step {
    let mut h = next_power_of_two(remaining);
    // Not a (h h / 2): h^2 may be out of range where nothing accelerates.
    let terms = |h: f64| (state.velocity * h, (a * h) * (0.5 * h));
    let (mut linear, mut quadratic) = terms(h);
    while !(amax(&linear) + amax(&quadratic)).is_finite() {
        h *= SHORTER;
        (linear, quadratic) = terms(h);
    }
    let zero = Vector3::zeros();
    Step {
        path: Path::parabola(state.position, linear, quadratic),
        velocity: [state.velocity, a * h, zero, zero, zero],
        seconds: h,
        to: (remaining / h).min(1.0),
        exact: true,
    }
}

/// The least power of two >= `x` > 0; the largest there is, if none is.
fn next_power_of_two(x: f64) -> f64 {
    let floor = f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & (0x7ff << 52));
    if floor < x && x <= 2f64.powi(1023) { 2.0 * floor } else { floor }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn powers_of_two() {
        for (x, p) in [
            (1.0, 1.0),
            (1.5, 2.0),
            (3.0, 4.0),
            (0.3, 0.5),
            (1e-3, 2f64.powi(-9)),
            (300.0, 512.0),
            (f64::MAX, 2f64.powi(1023)),
        ] {
            assert_eq!(next_power_of_two(x), p);
        }
    }

    #[test]
    fn a_flight_beyond_the_range_of_f64_is_cut_within_it() {
        let state = State { position: Point3::origin(), velocity: Vector3::new(1.0, 0.0, 0.0) };
        let step = step(&state, Vector3::new(0.0, 0.0, -9.81), 1e300);
        assert!(step.path.terms().iter().all(|t| t.amax().is_finite()) && step.time(step.to) > 1e100);
        let free = super::step(&state, Vector3::zeros(), 1e300);
        assert_eq!(free.end().position, Point3::new(1e300, 0.0, 0.0));
    }

    #[test]
    fn the_same_flight_is_the_same_bits_however_long_the_step() {
        let state = State { position: Point3::new(0.1, 0.2, 3.0), velocity: Vector3::new(1.0, -0.3, 2.0) };
        let a = Vector3::new(0.0, 0.0, -9.81);
        let (short, long) = (step(&state, a, 1.0), step(&state, a, 100.0));
        assert_eq!(short.at(0.25), long.at(0.25 / 128.0));
    }
}
