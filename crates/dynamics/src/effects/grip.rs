//! Grip and slip: friction between a surface and a ball that spins.
//!
//! The point of contact moves along the surface with u = v_t - r omega x n. Where the ball slips, friction takes mu (1 + c_r) |v_n| of momentum per
//! mass against u; where that would be more than what turns u round into -e_x u, the surface grips, and it takes just that:
//! dv_t = min(mu (1 + c_r) |v_n|, alpha / (1 + alpha) (1 + e_x) |u|), r domega = -n x dv_t / alpha, with the moment of inertia alpha m r^2. The
//! tangential restitution e_x is 0 where the ball leaves rolling, 1 for a perfect superball. (R. L. Garwin, *Kinematics of an ultraelastic
//! rough ball*, Am. J. Phys. 37 (1969) 88; H. Brody, *That's how the ball bounces*, Phys. Teach. 22 (1984) 494; R. Cross, *Grip-slip behavior of a
//! bouncing ball*, Am. J. Phys. 70 (2002) 1093.)
//!
//! In lasting contact the ball slips with the friction mu until u is 0, and then rolls: as if it slid without that friction and were 1 +
//! alpha times as inert. Rolling resistance is the torque c_rr r N.

use crate::body::Ball;
use crate::error::{ValueError, require};
use nalgebra::Vector3;

/// Friction that turns the ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grip {
    mu: f64,
    e_x: f64,
    c_rr: f64,
}

impl Grip {
    /// With friction `mu` >= 0 and no tangential restitution: where it grips, the ball leaves rolling.
    pub fn new(mu: f64) -> Result<Self, ValueError> {
        let mu = require("grip friction", mu, "finite and >= 0", mu.is_finite() && mu >= 0.0)?;
        Ok(Self { mu, e_x: 0.0, c_rr: 0.0 })
    }

    /// The same with the tangential restitution `e_x` in [-1, 1].
    pub fn with_tangential(self, e_x: f64) -> Result<Self, ValueError> {
        let e_x = require("tangential restitution", e_x, "between -1 and 1", (-1.0..=1.0).contains(&e_x))?;
        Ok(Self { e_x, ..self })
    }

    /// The same with the rolling resistance `c_rr` >= 0: on a slope up to c_rr the ball does not roll.
    pub fn with_rolling(self, c_rr: f64) -> Result<Self, ValueError> {
        let c_rr = require("rolling resistance", c_rr, "finite and >= 0", c_rr.is_finite() && c_rr >= 0.0)?;
        Ok(Self { c_rr, ..self })
    }

    /// The coefficient of friction.
    pub fn friction(&self) -> f64 {
        self.mu
    }

    /// The tangential restitution e_x.
    pub fn tangential(&self) -> f64 {
        self.e_x
    }

    /// The coefficient of rolling resistance.
    pub fn rolling(&self) -> f64 {
        self.c_rr
    }

    /// What friction adds to the velocity (m/s) at an impact in which the point of contact moves with `u` (m/s) on a ball of moment of inertia
    /// `alpha`, and the normal momentum per mass is `impulse` (m/s): (1 + c_r) times the closing speed. It takes energy, or none.
    pub fn kick(&self, u: &Vector3<f64>, alpha: f64, impulse: f64) -> Vector3<f64> {
        self.against(u, alpha / (1.0 + alpha) * (1.0 + self.e_x), impulse)
    }

    /// The same of all the impacts of a bouncing that ends, whose normal momenta add up to `impulse`: in the end nothing is left of u.
    pub fn kick_to_the_end(&self, u: &Vector3<f64>, alpha: f64, impulse: f64) -> Vector3<f64> {
        self.against(u, alpha / (1.0 + alpha), impulse)
    }

    /// Against `u`, at most the share `share` of it.
    fn against(&self, u: &Vector3<f64>, share: f64, impulse: f64) -> Vector3<f64> {
        let (speed, most) = (u.norm(), self.mu * impulse);
        // Not as the smaller of two quotients: u may be 0.
        if speed * share <= most { u * -share } else { u * (-most / speed) }
    }
}

/// The velocity in m/s with which the point of contact of `ball` moves along a surface of unit normal `n` when its centre moves with
/// `velocity` (m/s) and it spins with `spin` (rad/s).
pub fn slip(ball: &Ball, velocity: &Vector3<f64>, spin: &Vector3<f64>, n: &Vector3<f64>) -> Vector3<f64> {
    velocity - n * n.dot(velocity) - spin.cross(n) * ball.radius()
}

/// The spin in rad/s after a tangential `kick` (m/s) by a surface of unit normal `n`.
pub fn turned(ball: &Ball, spin: &Vector3<f64>, kick: &Vector3<f64>, n: &Vector3<f64>) -> Vector3<f64> {
    spin - n.cross(kick) / (ball.inertia() * ball.radius())
}

/// The spin in rad/s of `ball` that rolls with `velocity` (m/s): what turns about the normal `n` it keeps of `spin`.
pub fn rolling(ball: &Ball, velocity: &Vector3<f64>, spin: &Vector3<f64>, n: &Vector3<f64>) -> Vector3<f64> {
    n.cross(velocity) / ball.radius() + n * n.dot(spin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    fn ball() -> Ball {
        Ball::new(Point3::origin(), Vector3::zeros(), 0.5, None).unwrap()
    }

    #[test]
    fn a_ball_that_grips_leaves_rolling_and_a_superball_turns_its_contact_round() {
        let (n, v, spin) = (Vector3::z(), Vector3::new(3.0, -1.0, 0.0), Vector3::new(2.0, 5.0, 7.0));
        let u = slip(&ball(), &v, &spin, &n);
        for (e_x, left) in [(0.0, Vector3::zeros()), (1.0, -u), (-1.0, u), (0.5, -0.5 * u)] {
            let grip = Grip::new(100.0).unwrap().with_tangential(e_x).unwrap();
            let kick = grip.kick(&u, 0.4, 2.0);
            let after = slip(&ball(), &(v + kick), &turned(&ball(), &spin, &kick, &n), &n);
            assert!((after - left).norm() < 1e-15, "{e_x}: {after}");
        }
    }

    #[test]
    fn a_ball_that_slips_is_slowed_by_mu_times_the_normal_momentum_and_one_that_rolls_not_at_all() {
        let (n, v) = (Vector3::z(), Vector3::new(8.0, 0.0, 0.0));
        let grip = Grip::new(0.25).unwrap();
        assert_eq!(grip.kick(&slip(&ball(), &v, &Vector3::zeros(), &n), 0.4, 2.0), Vector3::new(-0.5, 0.0, 0.0));
        let spin = rolling(&ball(), &v, &Vector3::new(1.0, 1.0, 3.0), &n);
        assert_eq!(spin, Vector3::new(0.0, 16.0, 3.0));
        assert_eq!(grip.kick(&slip(&ball(), &v, &spin, &n), 0.4, 2.0).norm(), 0.0);
    }

    #[test]
    fn values_that_mean_nothing_are_refused() {
        let grip = Grip::new(0.5).unwrap();
        assert!(Grip::new(-1.0).is_err() && grip.with_tangential(1.5).is_err() && grip.with_rolling(f64::NAN).is_err());
    }
}
