//! Euler's methods: the chapter's explicit one, and the semi-implicit one, which moves with the new velocity.

use crate::body::State;
use crate::integrators::Step;
use carom_geometry::path::Path;
use nalgebra::Vector3;

/// x + h v, then v + h a: the path is straight, with the velocity it begins with.
pub fn explicit(state: &State, a: Vector3<f64>, h: f64) -> Step {
    straight(state, state.velocity, a, h)
}

/// v + h a, then x + h v: the path is straight, with the velocity the step ends with.
pub fn semi_implicit(state: &State, a: Vector3<f64>, h: f64) -> Step {
    straight(state, state.velocity + a * h, a, h)
}

/// A straight path; the velocity changes evenly along it, so that a step cut at f has felt f h of the acceleration.
fn straight(state: &State, along: Vector3<f64>, a: Vector3<f64>, h: f64) -> Step {
    let zero = Vector3::zeros();
    Step {
        path: Path::line(state.position, along * h),
        velocity: [state.velocity, a * h, zero, zero, zero],
        seconds: h,
        to: 1.0,
        exact: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn each_moves_with_its_own_velocity() {
        let state = State { position: Point3::origin(), velocity: Vector3::new(2.0, 0.0, 0.0) };
        let a = Vector3::new(0.0, 0.0, -8.0);
        let (book, symplectic) = (explicit(&state, a, 0.5).end(), semi_implicit(&state, a, 0.5).end());
        assert_eq!(book.position, Point3::new(1.0, 0.0, 0.0));
        assert_eq!(symplectic.position, Point3::new(1.0, 0.0, -2.0));
        assert_eq!(book.velocity, symplectic.velocity);
        assert_eq!(book.velocity, Vector3::new(2.0, 0.0, -4.0));
    }
}
