//! The reference's flights: Taylor series of the motion under gravity, buoyancy, air resistance and the Magnus force, to the last of their digits.
//!
//! Under constant acceleration the series ends, and is the parabola itself.

use super::real::{BITS, Real, Vector, add, cross, norm, rounded, scale, sub, vector};
use super::resistance::{Resistance, Series};
use crate::body::Ball;
use crate::effects::buoyancy::ADDED_MASS;
use crate::scene::Scene;
use nalgebra::Vector3;

/// Terms of a series.
const ORDER: usize = 30;

/// What accelerates a ball.
#[derive(Debug, Clone)]
pub struct Field {
    /// What gravity and buoyancy leave.
    constant: Vector,
    /// Resistance per mass, and the wind.
    resistance: Option<(Resistance, Vector)>,
    spin: Spin,
    lift: Option<Lift>,
}

/// The spin omega, falling as e^(-t / tau).
#[derive(Debug, Clone)]
struct Spin {
    /// What it would have been at t = 0.
    start: Vector,
    /// 1 / tau.
    decay: Real,
}

/// The Magnus force: a = omega x u times a factor.
#[derive(Debug, Clone)]
struct Lift {
    factor: Real,
    wind: Vector,
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
    /// What accelerates `ball` in `scene`.
    pub fn of(scene: &Scene, ball: &Ball) -> Self {
        // Taken apart, so that an effect that comes to a scene is not forgotten here.
        let Scene {
            gravity,
            drag,
            magnus,
            spin_decay,
            buoyancy,
            duration: _,
            surfaces: _,
            balls: _,
            rest: _,
            method: _,
        } = scene;
        let g = vector(&gravity.map_or(Vector3::zeros(), |g| g.acceleration()));
        let r = Real::from(ball.radius());
        let area = &Real::pi() * &(&r * &r);
        let mass = Real::from(ball.mass().unwrap_or(0.0));
        let (mut constant, mut inertia) = (g.clone(), mass.clone());
        if let Some(buoyancy) = buoyancy {
            let volume = &(&area * &r) * &(Real::from(4.0) / Real::from(3.0));
            let displaced = &Real::from(buoyancy.density()) * &volume;
            inertia = &mass + &(&Real::from(ADDED_MASS) * &displaced);
            constant = scale(&g, &(&(&mass - &displaced) / &inertia));
        }
        let half = Real::from(0.5);
        let resistance = drag
            .filter(|drag| !drag.is_none())
            .map(|drag| (Resistance::of(&drag.law(), ball, &area, &inertia), vector(&drag.wind())));
        let turns = ball.spin() != Vector3::zeros() || scene.grips();
        let lift = magnus.filter(|_| turns).map(|magnus| {
            let (k_rho, wind) = magnus.parts();
            let factor = &(&(&(&half * &Real::from(k_rho)) * &area) * &r) / &inertia;
            Lift { factor, wind: vector(&wind) }
        });
        let decay = spin_decay.map_or(Real::zero(), |d| Real::from(1.0) / Real::from(d.time_constant()));
        let spin = Spin { start: vector(&ball.spin()), decay };
        Self { constant, resistance, spin, lift }
    }

    /// The spin at the time `t`, in rad/s.
    pub fn spin(&self, t: &Real) -> Vector {
        self.spin.at(t)
    }

    /// The same field about a ball that spins with `spin` (rad/s) at the time `t`.
    pub fn spun(self, spin: &Vector, t: &Real) -> Self {
        let start = if self.spin.decay.is_zero() { spin.clone() } else { scale(spin, &(&self.spin.decay * t).exp()) };
        Self { spin: Spin { start, ..self.spin }, ..self }
    }

    /// Whether nothing but gravity acts.
    pub fn is_constant(&self) -> bool {
        self.resistance.is_none() && self.lift.is_none()
    }

    /// The acceleration at velocity `v` at the time `t`.
    pub fn acceleration(&self, v: &Vector, t: &Real) -> Vector {
        let mut a = self.constant.clone();
        if let Some((law, wind)) = &self.resistance {
            let u = sub(v, wind);
            a = sub(&a, &scale(&u, &law.at(&u)));
        }
        if let Some(lift) = &self.lift {
            a = add(&a, &scale(&cross(&self.spin(t), &sub(v, &lift.wind)), &lift.factor));
        }
        a
    }

    /// The flight from `x` with `v` at the time `t`, for at most `remaining` seconds.
    pub fn fly(&self, x: &Vector, v: &Vector, t: &Real, remaining: f64) -> Flight {
        if self.is_constant() {
            return Flight::parabola(x, v, &scale(&self.constant, &Real::from(0.5)), remaining);
        }
        let zero = || [Real::zero(), Real::zero(), Real::zero()];
        let wind = self.resistance.as_ref().map_or(zero(), |(_, wind)| wind.clone());
        // Coefficients of u = v - w.
        let mut u = vec![sub(v, &wind)];
        let mut resisted = self.resistance.as_ref().map(|(law, _)| law.series(&u[0], &self.constant));
        let holds = resisted.as_ref().map_or(f64::INFINITY, Series::holds);
        let spin = self.lift.as_ref().map(|lift| self.spin.series(t, &lift.factor));
        for k in 0..ORDER {
            let mut a = if k == 0 { self.constant.clone() } else { zero() };
            if let Some(resisted) = &mut resisted {
                a = sub(&a, &resisted.coefficient(&u, k));
            }
            if let (Some(lift), Some(spin)) = (&self.lift, &spin) {
                // u + (w - w') for the Magnus force's own wind w'.
                let first = sub(&add(&u[0], &wind), &lift.wind);
                let product = |i: usize| cross(&spin[i], if i == k { &first } else { &u[k - i] });
                a = (0..=k).fold(a, |sum, i| add(&sum, &product(i)));
            }
            u.push(scale(&a, &(Real::from(1.0) / Real::from((k + 1) as f64))));
        }
        let mut terms = vec![x.clone()];
        for (k, term) in u.iter().enumerate() {
            let v = if k == 0 { add(term, &wind) } else { term.clone() };
            terms.push(scale(&v, &(Real::from(1.0) / Real::from((k + 1) as f64))));
        }
        let seconds = length(&terms).min(holds).min(remaining);
        let bend = bend(&terms, seconds);
        Flight { terms, seconds, bend }
    }
}

impl Spin {
    /// It at the time `t`.
    fn at(&self, t: &Real) -> Vector {
        if self.decay.is_zero() { self.start.clone() } else { scale(&self.start, &(-&(&self.decay * t)).exp()) }
    }

    /// Its series from the time `t`, times `factor`.
    fn series(&self, t: &Real, factor: &Real) -> Vec<Vector> {
        let mut series = vec![scale(&self.at(t), factor)];
        for k in 1..=ORDER {
            let next = scale(&series[k - 1], &(-&(&self.decay / &Real::from(k as f64))));
            series.push(next);
        }
        series
    }
}

/// Bounds computed in f64 are made larger by 2^-10, which is more than their rounding.
const MARGIN: f64 = 1.0 + 1.0 / 1024.0;

/// For how long the series holds: until its last terms are below the digits, as a power of two (Jorba and Zou 2005).
fn length(terms: &[Vector]) -> f64 {
    // Of numbers that an f64 may not hold.
    let size = |v: &Vector| v.iter().map(Real::exponent).fold(f64::NEG_INFINITY, f64::max);
    let scale = size(&terms[1]).max(size(&terms[2]));
    let last = terms.len() - 1;
    let until = |k: usize| {
        // |c_k| h^k <= 2^-BITS scale
        let c = size(&terms[k]);
        if c.is_finite() { ((scale - c - BITS as f64) / k as f64).floor() } else { f64::INFINITY }
    };
    let exponent = until(last).min(until(last - 1));
    if exponent > 60.0 { 2f64.powi(60) } else { 2f64.powf(exponent) }
}

fn bend(terms: &[Vector], seconds: f64) -> f64 {
    let seconds = Real::from(seconds);
    let mut power = Real::from(1.0);
    let mut sum = 0.0;
    for (k, c) in terms.iter().enumerate().skip(2) {
        sum += (k * (k - 1)) as f64 * rounded(&scale(c, &power)).norm();
        power = &power * &seconds;
    }
    sum * MARGIN
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

    use crate::effects::drag::Drag;
    use crate::effects::gravity::Gravity;
    use crate::effects::magnus::Magnus;
    use nalgebra::Point3;

    fn field(g: f64, drag: Drag, radius: f64, mass: f64) -> Field {
        let ball = Ball::new(Point3::origin(), Vector3::zeros(), radius, Some(mass)).unwrap();
        let gravity = Some(Gravity::uniform(Vector3::new(0.0, 0.0, -g)).unwrap());
        Field::of(&Scene { gravity, drag: Some(drag), ..Scene::lasting(1.0) }, &ball)
    }

    fn end(field: &Field, x: Vector, v: Vector, from: f64, to: f64) -> (Vector, Vector) {
        let (mut x, mut v, mut t) = (x, v, from);
        while t < to {
            let flight = field.fly(&x, &v, &Real::from(t), to - t);
            let h = Real::from(flight.seconds);
            (x, v) = (flight.position(&h), flight.velocity(&h));
            t += flight.seconds;
        }
        (x, v)
    }

    fn origin() -> Vector {
        vector(&Vector3::zeros())
    }

    #[test]
    fn quadratic_drag_without_gravity_is_its_closed_form() {
        // v = v0 / (1 + c v0 t), c = rho C A / 2 m with A = pi / 4.
        let field = field(0.0, Drag::quadratic(1.0, 1.0).unwrap(), 0.5, 2.0);
        let (_, v) = end(&field, origin(), vector(&Vector3::new(3.0, 0.0, 4.0)), 0.0, 2.0);
        let c = &Real::pi() / &Real::from(16.0);
        let speed = Real::from(5.0) / (Real::from(1.0) + &c * &Real::from(10.0));
        let error = (norm(&v) - speed).to_f64().abs();
        assert!(error < 2f64.powi(-110), "{error:e}");
    }

    #[test]
    fn a_drop_from_rest_and_a_throw_through_its_apex_keep_their_digits() {
        // Upwards, then down again: where u = 0, |u| has a kink, and steps get short.
        let field = field(10.0, Drag::quadratic(0.5, 1.2).unwrap(), 0.1, 0.1);
        let up = vector(&Vector3::new(0.0, 0.0, 4.0));
        let whole = end(&field, origin(), up.clone(), 0.0, 1.5);
        let (x, v) = end(&field, origin(), up, 0.0, 0.75);
        let rest = end(&field, x, v, 0.75, 1.5);
        assert!((&whole.0[2] - &rest.0[2]).to_f64().abs() < 2f64.powi(-100));
        // From rest v = vt tanh(g t / vt).
        let (_, v) = end(&field, origin(), origin(), 0.0, 0.5);
        let c = 0.5 * 0.5 * 1.2 * std::f64::consts::PI * 0.01 / 0.1;
        let vt = (10.0 / c).sqrt();
        let expected = -vt * (10.0 * 0.5 / vt).tanh();
        assert!((v[2].to_f64() - expected).abs() < 4e-15, "{} {expected}", v[2].to_f64());
    }

    #[test]
    fn the_magnus_force_alone_turns_the_flight_around_a_circle() {
        // a = f omega x v: the velocity turns with f omega, here 2 rad/s.
        let factor = 0.5 * std::f64::consts::PI * 0.25 * 0.5 / 2.0;
        let spin = Vector3::new(0.0, 0.0, 2.0 / factor);
        let ball = Ball::new(Point3::origin(), Vector3::zeros(), 0.5, Some(2.0)).unwrap().spinning(spin).unwrap();
        let scene = Scene { magnus: Some(Magnus::new(1.0, 1.0).unwrap()), ..Scene::lasting(1.0) };
        let field = Field::of(&scene, &ball);
        let (_, v) = end(&field, origin(), vector(&Vector3::new(3.0, 0.0, 0.0)), 0.0, 1.0);
        assert!((v[0].to_f64() - 3.0 * 2f64.cos()).abs() < 4e-15 && (v[1].to_f64() - 3.0 * 2f64.sin()).abs() < 4e-15);
    }
}
