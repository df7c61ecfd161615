//! The reference's flights: Taylor series of the motion under gravity and air resistance, to the last of their digits.
//!
//! Under constant acceleration the series ends, and is the parabola itself.

use super::real::{BITS, Real, Vector, add, dot, norm, rounded, scale, sub, vector};
use crate::effects::drag::{Drag, Law};
use nalgebra::Vector3;

/// Terms of a series.
const ORDER: usize = 30;

/// What accelerates a ball.
#[derive(Debug, Clone)]
pub struct Field {
    gravity: Vector,
    /// Resistance per mass, and the wind.
    resistance: Option<(Resistance, Vector)>,
}

/// Resistance per mass.
#[derive(Debug, Clone)]
enum Resistance {
    /// k / m of a = -(k/m) u.
    Linear(Real),
    /// c of a = -c |u| u.
    Quadratic(Real),
}

/// A stretch of flight, as a series in the time from its start.
#[derive(Debug, Clone)]
pub struct Flight {
    /// Coefficients of the position.
    terms: Vec<Vector>,
    /// For how long it holds, in s.
    pub seconds: f64,
    /// A bound on the acceleration in m/s^2 while it holds.
    pub bend: f64,
}

impl Field {
    /// For a ball of `radius` (m) and `mass` (kg).
    pub fn new(gravity: &Vector3<f64>, drag: Option<&Drag>, radius: f64, mass: Option<f64>) -> Self {
        let per_mass = |x: Real| &x / &Real::from(mass.unwrap_or(0.0));
        let resistance = drag.map(|drag| {
            let law = match drag.law() {
                Law::Linear(k) => Resistance::Linear(per_mass(Real::from(k))),
                Law::Quadratic(c_rho) => {
                    let area = &Real::pi() * &(&Real::from(radius) * &Real::from(radius));
                    Resistance::Quadratic(per_mass(&(&Real::from(0.5) * &Real::from(c_rho)) * &area))
                }
            };
            (law, vector(&drag.wind()))
        });
        Self { gravity: vector(gravity), resistance }
    }

    /// Whether nothing but gravity acts.
    pub fn is_constant(&self) -> bool {
        self.resistance.is_none()
    }

    /// The acceleration at velocity `v`.
    pub fn acceleration(&self, v: &Vector) -> Vector {
        match &self.resistance {
            None => self.gravity.clone(),
            Some((law, wind)) => {
                let u = sub(v, wind);
                let by = match law {
                    Resistance::Linear(k) => k.clone(),
                    Resistance::Quadratic(c) => c * &norm(&u),
                };
                sub(&self.gravity, &scale(&u, &by))
            }
        }
    }

    /// The flight from `x` with `v`, for at most `remaining` seconds.
    pub fn fly(&self, x: &Vector, v: &Vector, remaining: f64) -> Flight {
        let Some((law, wind)) = &self.resistance else {
            return Flight::parabola(x, v, &scale(&self.gravity, &Real::from(0.5)), remaining);
        };
        // Coefficients of u = v - w.
        let mut u = vec![sub(v, wind)];
        let mut force = QuadraticForce::new(&u[0]);
        for k in 0..ORDER {
            let resisted = match law {
                Resistance::Linear(c) => scale(&u[k], c),
                Resistance::Quadratic(c) => scale(&force.coefficient(&u, k), c),
            };
            let a = if k == 0 { sub(&self.gravity, &resisted) } else { scale(&resisted, &Real::from(-1.0)) };
            u.push(scale(&a, &(Real::from(1.0) / Real::from((k + 1) as f64))));
        }
        let mut terms = vec![x.clone()];
        for (k, term) in u.iter().enumerate() {
            let v = if k == 0 { add(term, wind) } else { term.clone() };
            terms.push(scale(&v, &(Real::from(1.0) / Real::from((k + 1) as f64))));
        }
        let seconds = length(&terms).min(remaining);
        let bend = bend(&terms, seconds);
        Flight { terms, seconds, bend }
    }
}

/// Bounds computed in f64 are made larger by 2^-10, which is more than their rounding.
const MARGIN: f64 = 1.0 + 1.0 / 1024.0;

/// For how long the series holds: until its last terms are below the digits, as a power of two (Jorba and Zou 2005).
fn length(terms: &[Vector]) -> f64 {
    let size = |v: &Vector| rounded(v).norm();
    let scale = size(&terms[1]).max(size(&terms[2]));
    let last = terms.len() - 1;
    let until = |k: usize| {
        // |c_k| h^k <= 2^-BITS scale
        let c = size(&terms[k]);
        if c > 0.0 { ((scale.log2() - c.log2() - BITS as f64) / k as f64).floor() } else { f64::INFINITY }
    };
    let exponent = until(last).min(until(last - 1));
    if exponent > 60.0 { 2f64.powi(60) } else { 2f64.powf(exponent) }
}

fn bend(terms: &[Vector], seconds: f64) -> f64 {
    let mut power = 1.0;
    let mut sum = 0.0;
    for (k, term) in terms.iter().enumerate().skip(2) {
        sum += (k * (k - 1)) as f64 * rounded(term).norm() * power;
        power *= seconds;
    }
    sum * MARGIN
}

/// The series of |u| u, one coefficient after the other.
struct QuadraticForce {
    /// 1 if u begins at 0: then u = t w, and |u| u = t^2 |w| w.
    shift: usize,
    /// Coefficients of |u|, or of |w|.
    speed: Vec<Real>,
}

impl QuadraticForce {
    fn new(start: &Vector) -> Self {
        let shift = usize::from(start.iter().all(Real::is_zero));
        Self { shift, speed: Vec::new() }
    }

    /// Coefficient `k`; all of u up to `k` are known.
    fn coefficient(&mut self, u: &[Vector], k: usize) -> Vector {
        let zero = || [Real::zero(), Real::zero(), Real::zero()];
        let Some(k) = k.checked_sub(2 * self.shift) else { return zero() };
        let w = &u[self.shift..];
        // |w|^2 = q, so s_0 = sqrt(q_0) and 2 s_0 s_k = q_k - sum s_i s_{k-i}.
        let mut q = (0..=k).fold(Real::zero(), |sum, i| &sum + &dot(&w[i], &w[k - i]));
        let s = if k == 0 {
            q.sqrt()
        } else {
            for i in 1..k {
                q = &q - &(&self.speed[i] * &self.speed[k - i]);
            }
            &q / &(&self.speed[0] + &self.speed[0])
        };
        self.speed.push(s);
        (0..=k).fold(zero(), |sum, i| add(&sum, &scale(&w[k - i], &self.speed[i])))
    }
}

impl Flight {
    /// A stretch of constant acceleration, `half` of which is given.
    pub fn parabola(x: &Vector, v: &Vector, half: &Vector, seconds: f64) -> Self {
        let bend = 2.0 * norm(half).to_f64() * MARGIN;
        Self { terms: vec![x.clone(), v.clone(), half.clone()], seconds, bend }
    }

    /// Half the acceleration, if that is constant.
    pub fn half_acceleration(&self) -> Option<&Vector> {
        self.terms.get(2).filter(|_| self.terms.len() == 3)
    }

    /// Where the ball is `t` seconds after the start.
    pub fn position(&self, t: &Real) -> Vector {
        let (last, rest) = match self.terms.split_last() {
            Some(parts) => parts,
            None => return [Real::zero(), Real::zero(), Real::zero()],
        };
        rest.iter().rev().fold(last.clone(), |sum, term| add(&scale(&sum, t), term))
    }

    /// How fast it is `t` seconds after the start.
    pub fn velocity(&self, t: &Real) -> Vector {
        let zero = [Real::zero(), Real::zero(), Real::zero()];
        self.terms
            .iter()
            .enumerate()
            .skip(1)
            .rev()
            .fold(zero, |sum, (k, term)| add(&scale(&sum, t), &scale(term, &Real::from(k as f64))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(field: &Field, x: Vector3<f64>, v: Vector3<f64>, seconds: f64) -> (Vector, Vector) {
        let (mut x, mut v, mut t) = (vector(&x), vector(&v), 0.0);
        while t < seconds {
            let flight = field.fly(&x, &v, seconds - t);
            let h = Real::from(flight.seconds);
            (x, v) = (flight.position(&h), flight.velocity(&h));
            t += flight.seconds;
        }
        (x, v)
    }

    #[test]
    fn quadratic_drag_without_gravity_is_its_closed_form() {
        // v = v0 / (1 + c v0 t), c = rho C A / 2 m with A = pi / 4.
        let drag = Drag::quadratic(1.0, 1.0).unwrap();
        let field = Field::new(&Vector3::zeros(), Some(&drag), 0.5, Some(2.0));
        let (_, v) = end(&field, Vector3::zeros(), Vector3::new(3.0, 0.0, 4.0), 2.0);
        let c = &Real::pi() / &Real::from(16.0);
        let speed = Real::from(5.0) / (Real::from(1.0) + &c * &Real::from(10.0));
        let error = (norm(&v) - speed).to_f64().abs();
        assert!(error < 2f64.powi(-110), "{error:e}");
    }

    #[test]
    fn a_drop_from_rest_and_a_throw_through_its_apex_are_smooth_to_the_last_digit() {
        // Upwards, then down again: where u = 0, |u| has a kink. Energy: v dv/dz = -g - c |v| v has a first integral.
        let drag = Drag::quadratic(0.5, 1.2).unwrap();
        let g = Vector3::new(0.0, 0.0, -10.0);
        let field = Field::new(&g, Some(&drag), 0.1, Some(0.1));
        let whole = end(&field, Vector3::zeros(), Vector3::new(0.0, 0.0, 4.0), 1.5);
        let half = end(&field, Vector3::zeros(), Vector3::new(0.0, 0.0, 4.0), 0.7);
        let rest = {
            let (mut x, mut v, mut t) = (half.0, half.1, 0.7);
            while t < 1.5 {
                let flight = field.fly(&x, &v, 1.5 - t);
                let h = Real::from(flight.seconds);
                (x, v) = (flight.position(&h), flight.velocity(&h));
                t += flight.seconds;
            }
            (x, v)
        };
        // 0.7 + (1.5 - 0.7) is 1.5 to rounding of the times only.
        assert!((&whole.0[2] - &rest.0[2]).to_f64().abs() < 2e-15);
        // The terminal speed is reached as tanh from rest: v = vt tanh(g t / vt).
        let (_, v) = end(&field, Vector3::zeros(), Vector3::zeros(), 0.5);
        let c = 0.5 * 0.5 * 1.2 * std::f64::consts::PI * 0.01 / 0.1;
        let vt = (10.0 / c).sqrt();
        let expected = -vt * (10.0 * 0.5 / vt).tanh();
        assert!((v[2].to_f64() - expected).abs() < 4e-15, "{} {expected}", v[2].to_f64());
    }
}
