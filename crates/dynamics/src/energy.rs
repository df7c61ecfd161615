//! The energy of balls: kinetic, and potential in uniform gravity.

use crate::body::State;
use crate::effects::gravity::Gravity;
use nalgebra::Vector3;

/// The kinetic energy per mass, v^2 / 2, in J/kg.
pub fn kinetic(state: &State) -> f64 {
    0.5 * state.velocity.norm_squared()
}

/// The energy of rotation per mass, I omega^2 / 2 with the moment of inertia I = `alpha` m r^2, in J/kg: of the `radius` in m and the
/// angular velocity `spin` in rad/s.
pub fn rotational(alpha: f64, radius: f64, spin: &Vector3<f64>) -> f64 {
    0.5 * alpha * (spin * radius).norm_squared()
}

/// The potential energy per mass, -g . x, in J/kg, counted from the plane through the origin; 0 without gravity.
pub fn potential(state: &State, gravity: Option<Gravity>) -> f64 {
    gravity.map_or(0.0, |g| -g.acceleration().dot(&state.position.coords))
}

/// The energy of a set of balls at the start and at the end of a run.
///
/// Potential energy needs a height to be counted from. Here it is that of the lowest ball of the run, at its start or at its end, so
/// that nothing is negative, a scene may be moved without changing its balance, and a lone ball that falls and comes to rest has lost all it had.
///
/// Each ball counts with its mass, in kg. Where masses are unknown they are all taken as 1 kg, and the balance is per mass.
///
/// ```
/// use carom_dynamics::body::State;
/// use carom_dynamics::effects::gravity::Gravity;
/// use carom_dynamics::energy::EnergyBalance;
/// use carom_dynamics::nalgebra::{Point3, Vector3};
///
/// // 2 kg fall 4 m under g = 8 m/s^2 and lie still.
/// let mut balance = EnergyBalance::new(Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0))?));
/// let still = |z| State { position: Point3::new(0.0, 0.0, z), velocity: Vector3::zeros() };
/// balance.add(2.0, &still(4.0), &still(0.0));
/// assert_eq!((balance.start(), balance.end(), balance.change()), (64.0, 0.0, Some(-1.0)));
/// # Ok::<(), carom_dynamics::error::ValueError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyBalance {
    gravity: Option<Gravity>,
    /// The potential that sums are kept relative to, so that a scene far from the origin loses no digits: the first ball's.
    base: Option<f64>,
    lowest: f64,
    mass: f64,
    start: f64,
    end: f64,
}

impl EnergyBalance {
    /// Of no balls yet, under `gravity`.
    pub fn new(gravity: Option<Gravity>) -> Self {
        Self { gravity, base: None, lowest: 0.0, mass: 0.0, start: 0.0, end: 0.0 }
    }

    /// Adds a ball of `mass` that went from `start` to `end`.
    pub fn add(&mut self, mass: f64, start: &State, end: &State) {
        let first = potential(start, self.gravity);
        let base = *self.base.get_or_insert(first);
        let (before, after) = (first - base, potential(end, self.gravity) - base);
        self.lowest = self.lowest.min(before).min(after);
        self.mass += mass;
        self.start += mass * (kinetic(start) + before);
        self.end += mass * (kinetic(end) + after);
    }

    /// Adds the rotation of a ball of `mass` with the moment of inertia `alpha` m r^2 and the `radius` in m, whose angular velocity went from
    /// `start` to `end` (rad/s).
    pub fn add_rotation(&mut self, mass: f64, alpha: f64, radius: f64, [start, end]: [Vector3<f64>; 2]) {
        self.start += mass * rotational(alpha, radius, &start);
        self.end += mass * rotational(alpha, radius, &end);
    }

    /// At the start, in J (in J/kg summed over the balls, if each counts as 1 kg).
    pub fn start(&self) -> f64 {
        self.start - self.mass * self.lowest
    }

    /// At the end, in the same unit.
    pub fn end(&self) -> f64 {
        self.end - self.mass * self.lowest
    }

    /// The energy gained (lost, if negative) as a fraction of that at the start; none if there was none at the start.
    pub fn change(&self) -> Option<f64> {
        let change = (self.end - self.start) / self.start();
        change.is_finite().then_some(change)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};

    fn state(z: f64, vz: f64) -> State {
        State { position: Point3::new(3.0, -4.0, z), velocity: Vector3::new(0.0, 0.0, vz) }
    }

    fn down() -> Option<Gravity> {
        Gravity::uniform(Vector3::new(0.0, 0.0, -8.0)).ok()
    }

    #[test]
    fn free_fall_keeps_the_energy() {
        // h = 1, g = 8: v^2 / 2 = g h, exactly in f64.
        let mut balance = EnergyBalance::new(down());
        balance.add(1.0, &state(1.0, 0.0), &state(0.0, -4.0));
        assert_eq!((balance.start(), balance.end(), balance.change()), (8.0, 8.0, Some(0.0)));
    }

    #[test]
    fn a_ball_that_comes_to_rest_below_has_lost_everything_wherever_the_scene_lies() {
        for floor in [-64.0, 0.0, 1024.0] {
            let mut balance = EnergyBalance::new(down());
            balance.add(0.5, &state(floor + 2.0, 0.0), &state(floor, 0.0));
            assert_eq!((balance.start(), balance.end(), balance.change()), (8.0, 0.0, Some(-1.0)));
        }
    }

    #[test]
    fn without_gravity_or_balls_there_is_only_motion_or_nothing() {
        let mut balance = EnergyBalance::new(None);
        assert_eq!((balance.start(), balance.end(), balance.change()), (0.0, 0.0, None));
        balance.add(2.0, &state(5.0, 2.0), &state(9.0, -1.0));
        assert_eq!((balance.start(), balance.end(), balance.change()), (4.0, 1.0, Some(-0.75)));
    }
}
