//! The reference's air resistance per mass, as a number and as a series in time.

use super::real::{Real, Vector, add, dot, norm, scale};
use crate::body::Ball;
use crate::effects::drag::Law;

/// Resistance per mass: a = -(what it is at |u|) u.
#[derive(Debug, Clone)]
pub enum Resistance {
    /// k / m.
    Linear(Real),
    /// c |u|.
    Quadratic(Real),
    /// That of a smooth sphere.
    Sphere(Sphere),
}

/// The drag of a smooth sphere: s + c |u| B(Re), with Re in proportion to |u|.
#[derive(Debug, Clone)]
pub struct Sphere {
    /// Of creeping flow, in 1/s.
    creeping: Real,
    /// c in 1/m.
    beyond: Real,
    /// Re over |u|, in s/m.
    reynolds: Real,
}

impl Resistance {
    /// What `law` comes to for `ball` with the `area` (m^2) and the `inertia` (kg).
    pub fn of(law: &Law, ball: &Ball, area: &Real, inertia: &Real) -> Self {
        let per_area = |coefficient: f64, density: f64| {
            let c_rho = &Real::from(coefficient) * &Real::from(density);
            &(&(&Real::from(0.5) * &c_rho) * area) / inertia
        };
        match *law {
            Law::Linear(k) => Self::Linear(&Real::from(k) / inertia),
            Law::Quadratic { coefficient, density } => Self::Quadratic(per_area(coefficient, density)),
            Law::OfBall(density) => Self::Quadratic(per_area(ball.drag().unwrap_or(0.0), density)),
            Law::Sphere { density, viscosity } => {
                let [r, mu] = [ball.radius(), viscosity].map(Real::from);
                // Stokes: 6 pi mu r.
                let creeping = &(&(&Real::from(6.0) * &Real::pi()) * &(&mu * &r)) / inertia;
                let reynolds = &(&Real::from(2.0 * density) * &r) / &mu;
                Self::Sphere(Sphere { creeping, beyond: per_area(1.0, density), reynolds })
            }
        }
    }

    /// It at the relative velocity `u`, in 1/s.
    pub fn at(&self, u: &Vector) -> Real {
        match self {
            Self::Linear(k) => k.clone(),
            Self::Quadratic(c) => c * &norm(u),
            Self::Sphere(sphere) => {
                let speed = norm(u);
                if speed.is_zero() {
                    return sphere.creeping.clone();
                }
                let mut series = SphereSeries::default();
                sphere.coefficient(&mut series, &[speed])
            }
        }
    }

    /// The series of it times u, for a u that begins with `start`; without resistance the acceleration would be `acceleration`.
    pub fn series(&self, start: &Vector, acceleration: &Vector) -> Series<'_> {
        let shift = usize::from(start.iter().all(Real::is_zero));
        let gained = &norm(acceleration) * &Real::from(ABOUT_REST);
        let creeps = matches!(self, Self::Sphere(_)) && norm(start) <= gained;
        Series { law: self, shift, creeps, speed: Vec::new(), factor: Vec::new(), sphere: SphereSeries::default() }
    }
}

/// The series of the resistance, one coefficient after the other.
pub struct Series<'a> {
    law: &'a Resistance,
    /// 1 if u begins at 0: then u = t w, and |u| u = t^2 |w| w.
    shift: usize,
    /// Whether nothing but creeping flow resists.
    creeps: bool,
    /// Coefficients of |u|, or of |w|.
    speed: Vec<Real>,
    /// Coefficients of what multiplies u, for a sphere.
    factor: Vec<Real>,
    sphere: SphereSeries,
}

/// The drag of a sphere beyond creeping flow grows with |u|^2.06, which has no series about u = 0: for so long, in s, before and after rest, it is
/// less than the digits.
const ABOUT_REST: f64 = 1.0 / (1_u64 << 40) as f64;

impl Series<'_> {
    /// For how long it holds at most, in s.
    pub fn holds(&self) -> f64 {
        if self.creeps { 2.0 * ABOUT_REST } else { f64::INFINITY }
    }

    /// Coefficient `k`; all of u up to `k` are known.
    pub fn coefficient(&mut self, u: &[Vector], k: usize) -> Vector {
        let zero = || [Real::zero(), Real::zero(), Real::zero()];
        match self.law {
            Resistance::Linear(c) => scale(&u[k], c),
            Resistance::Quadratic(c) => {
                let Some(k) = k.checked_sub(2 * self.shift) else { return zero() };
                let w = &u[self.shift..];
                next_of_norm(&mut self.speed, w);
                scale(&(0..=k).fold(zero(), |sum, i| add(&sum, &scale(&w[k - i], &self.speed[i]))), c)
            }
            Resistance::Sphere(sphere) if self.creeps => scale(&u[k], &sphere.creeping),
            Resistance::Sphere(sphere) => {
                next_of_norm(&mut self.speed, u);
                let next = sphere.coefficient(&mut self.sphere, &self.speed);
                self.factor.push(next);
                (0..=k).fold(zero(), |sum, i| add(&sum, &scale(&u[k - i], &self.factor[i])))
            }
        }
    }
}

/// The series that the drag of a sphere is made of: Re / 5, its power and quotient, and so on; see [`crate::effects::drag::sphere_coefficient`].
#[derive(Debug, Default)]
struct SphereSeries {
    wake: [Vec<Real>; 3],
    crisis: [Vec<Real>; 4],
    turbulent: [Vec<Real>; 2],
    beyond: Vec<Real>,
}

impl Sphere {
    /// The next coefficient of what multiplies u, of a |u| whose series is `speed` as far as it is needed.
    fn coefficient(&self, series: &mut SphereSeries, speed: &[Real]) -> Real {
        let k = series.beyond.len();
        let re = &self.reynolds * &speed[k];
        let [w, power, wake] = &mut series.wake;
        w.push(&re / &Real::from(5.0));
        next_of_power(power, w, &ratio(152, 100));
        next_over_one_and(wake, w, power);
        let [c, low, eighth, crisis] = &mut series.crisis;
        c.push(&re / &Real::from(263_000.0));
        next_of_power(low, c, &ratio(6, 100));
        next_of_power(eighth, c, &ratio(8, 1));
        next_over_one_and(crisis, low, eighth);
        let [t, turbulent] = &mut series.turbulent;
        t.push(&re / &Real::from(1_000_000.0));
        next_over_one_and(turbulent, t, t);
        let parts = [(ratio(26, 10), &wake[k]), (ratio(411, 1000), &crisis[k]), (ratio(25, 100), &turbulent[k])];
        series.beyond.push(parts.iter().fold(Real::zero(), |sum, (weight, part)| &sum + &(weight * part)));
        let product = (0..=k).fold(Real::zero(), |sum, i| &sum + &(&speed[i] * &series.beyond[k - i]));
        let next = &self.beyond * &product;
        if k == 0 { &next + &self.creeping } else { next }
    }
}

/// A decimal number that no binary one is.
fn ratio(a: u32, b: u32) -> Real {
    Real::from(f64::from(a)) / Real::from(f64::from(b))
}

/// The next coefficient of |w|: |w|^2 = q, so s_0 = sqrt(q_0) and 2 s_0 s_k = q_k - sum s_i s_{k-i}.
fn next_of_norm(s: &mut Vec<Real>, w: &[Vector]) {
    let k = s.len();
    let mut q = (0..=k).fold(Real::zero(), |sum, i| &sum + &dot(&w[i], &w[k - i]));
    if k == 0 {
        s.push(q.sqrt());
        return;
    }
    for i in 1..k {
        q = &q - &(&s[i] * &s[k - i]);
    }
    s.push(&q / &(&s[0] + &s[0]));
}

/// The next coefficient of y = x^p, x_0 > 0: x y' = p x' y, so k x_0 y_k = sum over i of (p i - (k - i)) x_i y_{k-i}.
fn next_of_power(y: &mut Vec<Real>, x: &[Real], p: &Real) {
    let k = y.len();
    if k == 0 {
        y.push(x[0].power(p));
        return;
    }
    let weight = |i: usize| &(p * &Real::from(i as f64)) - &Real::from((k - i) as f64);
    let sum = (1..=k).fold(Real::zero(), |sum, i| &sum + &(&weight(i) * &(&x[i] * &y[k - i])));
    y.push(&sum / &(&Real::from(k as f64) * &x[0]));
}

/// The next coefficient of q = a / (1 + b).
fn next_over_one_and(q: &mut Vec<Real>, a: &[Real], b: &[Real]) {
    let k = q.len();
    let rest = (1..=k).fold(a[k].clone(), |rest, i| &rest - &(&b[i] * &q[k - i]));
    q.push(&rest / &(&Real::from(1.0) + &b[0]));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::drag::sphere_coefficient;
    use nalgebra::{Point3, Vector3};

    #[test]
    fn a_sphere_resists_as_by_its_coefficient() {
        let ball = Ball::new(Point3::origin(), Vector3::zeros(), 0.5, Some(2.0)).unwrap();
        let law = Law::Sphere { density: 1.25, viscosity: 1.8e-5 };
        let area = &Real::pi() * &Real::from(0.25);
        let resistance = Resistance::of(&law, &ball, &area, &Real::from(2.0));
        for speed in [1e-6, 1e-3, 0.5, 4.0, 9.0] {
            let re = 1.25 * speed / 1.8e-5;
            let right = 0.5 * 1.25 * std::f64::consts::PI * 0.25 * speed * sphere_coefficient(re) / 2.0;
            let at = resistance.at(&[Real::zero(), Real::from(speed), Real::zero()]).to_f64();
            assert!((at / right - 1.0).abs() < 1e-14, "{speed}: {at:e} {right:e}");
        }
    }

    #[test]
    fn a_series_is_that_of_the_resistance_along_it() {
        // u = (3 + t, 4 - t, t^2): the series at t = 2^-8 beside the law itself there.
        let ball = Ball::new(Point3::origin(), Vector3::zeros(), 0.02, Some(0.003)).unwrap();
        let area = &Real::pi() * &Real::from(0.0004);
        let t = Real::from(2f64.powi(-8));
        let terms = |list: [f64; 3]| list.map(Real::from);
        let mut u = vec![terms([3.0, 4.0, 0.0]), terms([1.0, -1.0, 0.0]), terms([0.0, 0.0, 1.0])];
        u.resize(24, terms([0.0; 3]));
        let at = |list: &[Vector]| list.iter().rev().fold(terms([0.0; 3]), |sum, c| add(&scale(&sum, &t), c));
        for law in [Law::Quadratic { coefficient: 0.5, density: 1.2 }, Law::Sphere { density: 1.2, viscosity: 1.8e-5 }]
        {
            let resistance = Resistance::of(&law, &ball, &area, &Real::from(0.003));
            let mut series = resistance.series(&u[0], &terms([0.0, 0.0, 9.81]));
            let found: Vec<Vector> = (0..24).map(|k| series.coefficient(&u, k)).collect();
            let right = scale(&at(&u), &resistance.at(&at(&u)));
            let off = norm(&super::super::real::sub(&at(&found), &right)).to_f64();
            assert!(off < 2f64.powi(-110), "{off:e}");
        }
    }
}
