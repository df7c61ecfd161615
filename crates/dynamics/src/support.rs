//! What carries a ball: the contacts that push, and how strongly.
//!
//! Both questions are one: of all vectors that no contact forbids (n_i.w >= 0), which is nearest to a given one? For a velocity it
//! is Moreau's projection, for an acceleration Gauss's principle; the multipliers are the impulses and the loads. In three
//! dimensions at most three contacts push, so the few subsets are tried, the smallest first.

use crate::tolerance::rate_rounding;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// Solutions of a small system, each for what the last one left: normals that are nearly one lose digits in its determinant.
const REFINEMENTS: usize = 3;

/// The nearest allowed vector, and what each contact adds to reach it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// The nearest vector with n_i.w >= 0 for all i.
    pub velocity: Vector3<f64>,
    pushing: [(usize, f64); 3],
    count: usize,
}

impl Projection {
    /// The contacts that push, as (index, load), each load >= 0 and along its normal.
    pub fn loads(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.pushing[..self.count].iter().copied()
    }

    /// How many contacts push.
    pub fn count(&self) -> usize {
        self.count
    }
}

/// The vector nearest to `w` that no normal forbids.
pub fn project(w: &Vector3<f64>, normals: &[Vector3<f64>]) -> Projection {
    project_offset(w, normals, |_| 0.0)
}

/// The vector nearest to `w` with n_i.w >= -`allowed(i)`: a contact that curves away lets the ball accelerate towards it.
pub fn project_offset(w: &Vector3<f64>, normals: &[Vector3<f64>], allowed: impl Fn(usize) -> f64) -> Projection {
    let none = Projection { velocity: *w, pushing: [(0, 0.0); 3], count: 0 };
    if normals.iter().enumerate().all(|(i, n)| n.dot(w) + allowed(i) >= 0.0) {
        return none;
    }
    // How far `v` is from allowed, and how large what rounding makes of its loads.
    let excess =
        |v: &Vector3<f64>| normals.iter().enumerate().map(|(i, n)| -(n.dot(v) + allowed(i))).fold(0.0, f64::max);
    let m = normals.len();
    let lack = |v: &Vector3<f64>, i: usize| -(normals[i].dot(v) + allowed(i));
    // If rounding decides and no subset solves, the one that comes nearest.
    let mut best = (f64::INFINITY, Projection { velocity: Vector3::zeros(), ..none });
    let mut good = |v: Vector3<f64>, pushing: &[(usize, f64)]| {
        let sum: f64 = pushing.iter().map(|(_, load)| load).sum();
        let over = excess(&v);
        if pushing.iter().any(|(_, load)| *load < 0.0) || over >= best.0 {
            return None;
        }
        let mut all = [(0, 0.0); 3];
        all[..pushing.len()].copy_from_slice(pushing);
        best = (over, Projection { velocity: v, pushing: all, count: pushing.len() });
        (over <= rate_rounding(w.norm() + sum)).then_some(best.1)
    };
    for (i, normal) in normals.iter().enumerate() {
        let load = lack(w, i);
        if let Some(found) = good(w + normal * load, &[(i, load)]) {
            return found;
        }
    }
    for i in 0..m {
        for j in i + 1..m {
            let c = normals[i].dot(&normals[j]);
            let Some(inverse) = Matrix2::new(1.0, c, c, 1.0).try_inverse() else { continue };
            let mut load = Vector2::zeros();
            let mut v = *w;
            for _ in 0..REFINEMENTS {
                load += inverse * Vector2::new(lack(&v, i), lack(&v, j));
                v = w + normals[i] * load.x + normals[j] * load.y;
            }
            let v = in_groove(w, [&normals[i], &normals[j]], [allowed(i), allowed(j)]);
            if let Some(found) = good(v, &[(i, load.x), (j, load.y)]) {
                return found;
            }
        }
    }
    let fixed = (0..m).all(|i| allowed(i) == 0.0);
    for i in 0..m {
        for j in i + 1..m {
            for k in j + 1..m {
                let across = Matrix3::from_columns(&[normals[i], normals[j], normals[k]]);
                let Some(inverse) = (across.transpose() * across).try_inverse() else { continue };
                let (mut v, mut load) = (*w, Vector3::zeros());
                for _ in 0..REFINEMENTS {
                    load += inverse * Vector3::new(lack(&v, i), lack(&v, j), lack(&v, k));
                    v = w + across * load;
                }
                let v = if fixed { Vector3::zeros() } else { v };
                if let Some(found) = good(v, &[(i, load.x), (j, load.y), (k, load.z)]) {
                    return found;
                }
            }
        }
    }
    best.1
}

/// The vector with n_i.v = -`allowed[i]` for both `normals` that is `w` along their groove.
///
/// Put together in the directions of the groove: `w` plus the loads would leave in v the rounding of the loads, which in an acute groove
/// are much larger than w.
fn in_groove(w: &Vector3<f64>, normals: [&Vector3<f64>; 2], allowed: [f64; 2]) -> Vector3<f64> {
    let along = normals[0].cross(normals[1]);
    let v = along * along.dot(w) - normals[1].cross(&along) * allowed[0] - along.cross(normals[0]) * allowed[1];
    v / along.norm_squared()
}

/// The part of `v` along all planes with these normals: of three, none.
pub fn along(normals: &[Vector3<f64>], v: Vector3<f64>) -> Vector3<f64> {
    match normals {
        [] => v,
        [n] => v - n * n.dot(&v),
        [a, b] => a.cross(b).try_normalize(0.0).map_or(v, |t| t * t.dot(&v)),
        _ => Vector3::zeros(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floor_carries_the_weight_and_lets_the_rest_go() {
        let p = project(&Vector3::new(2.0, 0.0, -9.0), &[Vector3::z()]);
        assert_eq!(p.velocity, Vector3::new(2.0, 0.0, 0.0));
        assert_eq!(p.loads().collect::<Vec<_>>(), [(0, 9.0)]);
    }

    #[test]
    fn r33_a_groove_shares_the_weight_between_its_sides() {
        let s = 0.5f64.sqrt();
        let p = project(&Vector3::new(0.0, 0.0, -2.0), &[Vector3::new(s, 0.0, s), Vector3::new(-s, 0.0, s)]);
        assert!(p.velocity.norm() < 1e-15);
        for (_, load) in p.loads() {
            assert!((load - 2.0 * s).abs() < 1e-15);
        }
        assert_eq!(p.count(), 2);
    }

    #[test]
    fn r33_a_corner_carries_with_three() {
        let p = project(&Vector3::new(-1.0, -2.0, -3.0), &[Vector3::x(), Vector3::y(), Vector3::z()]);
        assert_eq!(p.velocity, Vector3::zeros());
        assert_eq!(p.loads().collect::<Vec<_>>(), [(0, 1.0), (1, 2.0), (2, 3.0)]);
    }

    #[test]
    fn a_wall_that_is_not_pressed_carries_nothing() {
        let p = project(&Vector3::new(1.0, 0.0, -9.0), &[Vector3::x(), Vector3::z()]);
        assert_eq!(p.loads().collect::<Vec<_>>(), [(1, 9.0)]);
        assert_eq!(project(&Vector3::new(1.0, 0.0, 2.0), &[Vector3::x(), Vector3::z()]).count(), 0);
    }
}
