//! The classical Runge-Kutta method of order 4; its path is the cubic through both ends with their velocities.

use crate::body::State;
use crate::counters::Counters;
use crate::forces::Forces;
use crate::integrators::Step;
use carom_geometry::path::Path;
use nalgebra::Vector3;

/// One step of `h` seconds. Positions and velocities along the path are Hermite cubics, so both are of order 4 at an impact, not
/// only at the end of the step.
#[inline(never)] // beside the exact flight, whose loop stays small
pub fn step(forces: &Forces, state: &State, h: f64, counters: &mut Counters) -> Step {
    let State { position: x, velocity: v } = *state;
    let mut acceleration =
        |position, velocity, after| forces.acceleration_after(&State { position, velocity }, after, counters);
    let a1 = acceleration(x, v, 0.0);
    let v2 = v + a1 * (0.5 * h);
    let a2 = acceleration(x + v * (0.5 * h), v2, 0.5 * h);
    let v3 = v + a2 * (0.5 * h);
    let a3 = acceleration(x + v2 * (0.5 * h), v3, 0.5 * h);
    let v4 = v + a3 * h;
    let a4 = acceleration(x + v3 * h, v4, h);

    // x1 = x + h v + h^2 q and v1 = v + h p.
    let q = (a1 + a2 + a3) / 6.0;
    let p = (a1 + 2.0 * (a2 + a3) + a4) / 6.0;
    let a_end = acceleration(x + (v + q * h) * h, v + p * h, h);
    let h2 = h * h;
    Step {
        path: Path::from_terms(x, &[v * h, (3.0 * q - p) * h2, (p - 2.0 * q) * h2]),
        velocity: [v, a1 * h, (3.0 * p - 2.0 * a1 - a_end) * h, (a1 + a_end - 2.0 * p) * h, Vector3::zeros()],
        seconds: h,
        to: 1.0,
        exact: false,
    }
}
