//! Dormand and Prince's embedded Runge-Kutta pair of orders 5 and 4 with its own dense output, a quartic, as the path.
//!
//! J. R. Dormand, P. J. Prince, J. Comp. Appl. Math. 6 (1980); dense output after E. Hairer, S. P. Nørsett, G. Wanner, *Solving
//! Ordinary Differential Equations I*, II.6. Steps grow and shrink by halves and doubles only, so that no power function, whose
//! last bit differs between machines, enters the result.

use crate::body::State;
use crate::integrators::Step;
use carom_geometry::path::Path;
use nalgebra::Vector3;

/// Lower triangle of the Butcher tableau; its last row is also the weights of the fifth-order result.
const A: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Difference of the two orders' weights.
const E: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];
/// Weights of the dense output's highest term.
const D: [f64; 7] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];
/// A step whose error is this far below the tolerance may be doubled: (1/2)^6, a doubling's growth of the error.
const DOUBLE_BELOW: f64 = 1.0 / 64.0;
/// Halvings in a row before a step is taken as it is.
const MAX_HALVINGS: u32 = 64;

/// The pair, with the step length that it last found right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adaptive {
    tolerance: f64,
    next: f64,
}

impl Adaptive {
    /// The pair with an error per step of `tolerance` relative to the motion of that step.
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, next: f64::INFINITY }
    }

    /// A step of at most `remaining` seconds under `acceleration`, which is told the state and the time since the start of the step, in s.
    pub fn step(
        &mut self,
        state: &State,
        remaining: f64,
        acceleration: impl FnMut(&State, f64) -> Vector3<f64>,
    ) -> Step {
        self.step_over(0.0, state, remaining, acceleration)
    }

    /// The same where `noise` is the relative rounding of the acceleration: no step is made smaller because of that.
    pub fn step_over(
        &mut self,
        noise: f64,
        state: &State,
        remaining: f64,
        mut acceleration: impl FnMut(&State, f64) -> Vector3<f64>,
    ) -> Step {
        let tolerance = self.tolerance.max(noise);
        let mut h = self.next.min(remaining);
        // A step that is cut short tells nothing against the length that was right before; it may even be of no length at all.
        let mut known = if h < self.next { self.next } else { 0.0 };
        for _ in 0..MAX_HALVINGS {
            let (step, error) = within(tolerance, state, h, &mut acceleration);
            if error <= 1.0 {
                self.next = known.max(if error <= DOUBLE_BELOW { 2.0 * h } else { h });
                return step;
            }
            h *= 0.5;
            known = 0.0;
        }
        self.next = h;
        within(tolerance, state, h, &mut acceleration).0
    }
}

/// One step of `h`, and its error in units of what `tolerance` allows.
#[inline(never)] // beside the exact flight, whose loop stays small
fn within(
    tolerance: f64,
    state: &State,
    h: f64,
    acceleration: &mut impl FnMut(&State, f64) -> Vector3<f64>,
) -> (Step, f64) {
    let (step, error, speed) = attempt(state, h, acceleration);
    let error = if error == 0.0 { 0.0 } else { error / (tolerance * speed) };
    (step, error)
}

/// One step of `h` seconds, whatever its error.
#[inline(never)] // beside the exact flight, whose loop stays small
pub fn step(state: &State, h: f64, mut acceleration: impl FnMut(&State, f64) -> Vector3<f64>) -> Step {
    attempt(state, h, &mut acceleration).0
}

/// One step of `h` seconds, its error and the greatest speed in it, both in m/s.
fn attempt(state: &State, h: f64, acceleration: &mut impl FnMut(&State, f64) -> Vector3<f64>) -> (Step, f64, f64) {
    let State { position: x, velocity: v } = *state;
    let zero = Vector3::zeros();
    // Stages relative to v, so that the straight part h v of the path stays exact: u = (v at the stage) - v.
    let mut a = [acceleration(state, 0.0), zero, zero, zero, zero, zero, zero];
    let mut u = [zero; 7];
    for (row, weights) in A.iter().enumerate() {
        let stage = row + 1;
        let (mut share, mut dv, mut dx) = (0.0, zero, zero);
        for (k, w) in weights.iter().enumerate().take(stage) {
            share += w;
            dv += a[k] * *w;
            dx += u[k] * *w;
        }
        u[stage] = dv * h;
        let at = State { position: x + (v * share + dx) * h, velocity: v + u[stage] };
        a[stage] = acceleration(&at, share * h);
    }
    let (x_terms, x_error) = dense(&u, h);
    let (v_terms, v_error) = dense(&a, h);
    let speed = v.norm().max((v + u[6]).norm()).max(a[0].norm() * h);
    let worst = v_error.norm().max(x_error.norm() / h);
    let step = Step {
        path: Path::from_terms(x, &[v * h + x_terms[0], x_terms[1], x_terms[2], x_terms[3]]),
        velocity: [v, v_terms[0], v_terms[1], v_terms[2], v_terms[3]],
        seconds: h,
        to: 1.0,
        exact: false,
    };
    (step, worst, speed)
}

/// The quartic of the dense output from the stages `k` of one component, and the error estimate at its end.
fn dense(k: &[Vector3<f64>; 7], h: f64) -> ([Vector3<f64>; 4], Vector3<f64>) {
    let weighted = |weights: &[f64]| k.iter().zip(weights).fold(Vector3::zeros(), |sum, (k, w)| sum + k * *w) * h;
    let change = weighted(&A[5]);
    let bend = k[0] * h - change;
    let end = change - k[6] * h - bend;
    let top = weighted(&D);
    ([change + bend, end - bend + top, -end - 2.0 * top, top], weighted(&E))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn r03_a_step_that_is_cut_short_does_not_shorten_the_next() {
        // A pendulum with a period of 6.3 s.
        let state = State { position: Point3::new(1.0, 0.0, 0.0), velocity: Vector3::zeros() };
        let pull = |s: &State, _: f64| -s.position.coords;
        let mut pair = Adaptive::new(1e-6);
        let long = pair.step(&state, 100.0, pull).seconds;
        assert!((0.01..1.0).contains(&long), "{long}");
        for short in [1e-3, 1e-300, 0.0] {
            assert_eq!(pair.step(&state, short, pull).seconds, short);
            assert!(pair.step(&state, 100.0, pull).seconds >= long);
        }
        // The first step of all may be one of no length.
        let mut pair = Adaptive::new(1e-6);
        assert_eq!(pair.step(&state, 0.0, pull).seconds, 0.0);
        assert_eq!(pair.step(&state, 100.0, pull).seconds, long);
    }
}
