//! What carries a ball: the contacts that push, and how strongly.
//!
//! Both questions are one: of all vectors that no contact forbids (n_i.w >= 0), which is nearest to a given one? For a velocity it
//! is Moreau's projection, for an acceleration Gauss's principle; the multipliers are the impulses and the loads. In three
//! dimensions at most three contacts push, so the few subsets are tried, the smallest first.
//!
//! What counts is that nothing is forbidden: in the corner of an acute wedge the loads are the quotients of small differences, and their signs may be
//! rounding. Then it is the nearest of the allowed places (on a plane, in a groove, in the corner) all the same, and to stand still is always allowed.

use crate::tolerance::rate_rounding;
use nalgebra::Vector3;

/// The nearest allowed vector, and what each contact adds to reach it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// The nearest vector with n_i.w >= 0 for all i.
    pub velocity: Vector3<f64>,
    pushing: [(usize, f64); 3],
    count: usize,
}

impl Projection {
    /// `velocity`, reached by the loads of up to three contacts; those that are negative by rounding are none.
    fn new(velocity: Vector3<f64>, loads: &[(usize, f64)]) -> Self {
        let mut pushing = [(0, 0.0); 3];
        for (slot, &(i, load)) in pushing.iter_mut().zip(loads) {
            *slot = (i, load.max(0.0));
        }
        Self { velocity, pushing, count: loads.len() }
    }

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

/// The vector nearest to `w` with n_i.w >= -`allowed(i)`, `allowed(i)` >= 0: a contact that curves away lets the ball accelerate towards it.
pub fn project_offset(w: &Vector3<f64>, normals: &[Vector3<f64>], allowed: impl Fn(usize) -> f64) -> Projection {
    let lack = |v: &Vector3<f64>, i: usize| -(normals[i].dot(v) + allowed(i));
    let m = normals.len();
    let deepest = (0..m).map(|i| (i, lack(w, i))).max_by(|a, b| a.1.total_cmp(&b.1));
    let Some(deepest) = deepest.filter(|(_, lack)| *lack > 0.0) else {
        return Projection::new(*w, &[]);
    };
    let mut search = Search { w, nearest: Projection::new(Vector3::zeros(), &[deepest]), least: f64::NEG_INFINITY };
    let excess = |v: &Vector3<f64>| (0..m).map(|i| lack(v, i)).fold(0.0, f64::max);
    let is_allowed = |v: &Vector3<f64>| excess(v) <= rate_rounding(w.norm() + v.norm());
    for (i, normal) in normals.iter().enumerate() {
        let load = lack(w, i);
        let v = w + normal * load;
        if is_allowed(&v) && search.ends_with(v, &[(i, load)]) {
            return search.nearest;
        }
    }
    for i in 0..m {
        for j in i + 1..m {
            let (a, b) = (&normals[i], &normals[j]);
            let along = groove(a, b);
            let square = along.norm_squared();
            if square == 0.0 {
                continue;
            }
            // Put together in the directions of the groove: `w` plus the loads would leave in v the rounding of the loads, which in an acute
            // groove are much larger than w.
            let v = (along * along.dot(w) - b.cross(&along) * allowed(i) - along.cross(a) * allowed(j)) / square;
            let change = v - w;
            let loads = [(i, change.cross(b).dot(&along) / square), (j, a.cross(&change).dot(&along) / square)];
            if is_allowed(&v) && search.ends_with(v, &loads) {
                return search.nearest;
            }
        }
    }
    for i in 0..m {
        for j in i + 1..m {
            for k in j + 1..m {
                let [a, b, c] = [i, j, k].map(|i| &normals[i]);
                let across = [groove(b, c), groove(c, a), groove(a, b)];
                let volume = across[0].dot(a);
                if volume == 0.0 {
                    continue;
                }
                let v = Vector3::zeros()
                    - (across[0] * allowed(i) + across[1] * allowed(j) + across[2] * allowed(k)) / volume;
                let load = |l: usize| across[l].dot(&(v - w)) / volume;
                if is_allowed(&v) && search.ends_with(v, &[(i, load(0)), (j, load(1)), (k, load(2))]) {
                    return search.nearest;
                }
            }
        }
    }
    search.nearest
}

/// The nearest to `w` of the allowed vectors seen so far.
struct Search<'a> {
    w: &'a Vector3<f64>,
    nearest: Projection,
    /// The least of its loads.
    least: f64,
}

impl Search<'_> {
    /// Sees the allowed vector `v`, which the `loads` lead to; says whether it is the nearest of all because they all push.
    fn ends_with(&mut self, v: Vector3<f64>, loads: &[(usize, f64)]) -> bool {
        let least = loads.iter().map(|(_, load)| *load).fold(f64::INFINITY, f64::min);
        // |w - nearest|^2 - |w - v|^2 as a product: the squares may be the same to rounding.
        let nearer = (v - self.nearest.velocity).dot(&((self.w - self.nearest.velocity) + (self.w - v)));
        if least >= 0.0 || nearer > 0.0 || (nearer == 0.0 && least > self.least) {
            (self.nearest, self.least) = (Projection::new(v, loads), least);
        }
        least >= 0.0
    }
}

/// The direction of the groove between two planes with unit normals `a` and `b`: a x b, to about a rounding of its length however acute the groove is,
/// because of normals that are nearly one or opposite it is their difference that counts, and that is exact.
fn groove(a: &Vector3<f64>, b: &Vector3<f64>) -> Vector3<f64> {
    let difference = if a.dot(b) < 0.0 { b + a } else { b - a };
    a.cross(&difference)
}

/// The part of `v` along all planes with these normals: of three, none.
pub fn along(normals: &[Vector3<f64>], v: Vector3<f64>) -> Vector3<f64> {
    match normals {
        [] => v,
        [n] => v - n * n.dot(&v),
        [a, b] => groove(a, b).try_normalize(0.0).map_or(v, |t| t * t.dot(&v)),
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

    #[test]
    fn r33_in_the_corner_of_a_flat_wedge_nothing_moves_where_nothing_is_allowed_to() {
        // Three faces of the cow with its z times 10^-6; the groove of the first two leads into the third.
        let normals = [
            Vector3::new(-1.3727475984811537e-5, -1.9847707492453558e-7, 0.9999999999057586),
            Vector3::new(2.5363429362996367e-6, 4.752743983003709e-6, -0.9999999999854892),
            Vector3::new(5.99295746690405e-6, 7.415127194105935e-6, 0.9999999999545504),
        ];
        let w = Vector3::new(0.198_428_586, -0.200_173_856, 1.156_253_597);
        for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0], [0, 2, 1], [2, 0, 1], [1, 0, 2]] {
            let p = project(&w, &order.map(|i| normals[i]));
            assert_eq!((p.velocity, p.count()), (Vector3::zeros(), 3));
            let pushed: Vector3<f64> = p.loads().map(|(i, load)| normals[order[i]] * load).sum();
            let most = p.loads().map(|(_, load)| load).fold(0.0, f64::max);
            assert!((pushed + w).norm() <= rate_rounding(most), "{:e} of {most:e}", (pushed + w).norm());
        }
    }

    #[test]
    fn a_groove_is_as_straight_as_its_normals_however_acute() {
        for k in 4..40 {
            let slope = 0.5f64.powi(k);
            let [a, b] = [slope, -1.25 * slope].map(|s| Vector3::new(s, 0.3 * slope, 1.0).normalize());
            for b in [b, -b] {
                let along = groove(&a, &b).normalize();
                let off = a.dot(&along).abs().max(b.dot(&along).abs());
                assert!(off <= rate_rounding(1.0), "{off:e} at 2^-{k}");
            }
        }
    }
}
