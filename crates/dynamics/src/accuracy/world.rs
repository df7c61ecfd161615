//! The reference's surfaces: planes and triangles in extended precision, each asked on its own, with a plain grid to find the triangles near by.

use super::real::{Real, Vector, add, cross, dot, norm, point, scale, sub, vector};
use super::taylor::Flight;
use crate::plan::Plan;
use carom_geometry::plane::{Plane, Side};
use nalgebra::{Point3, Vector3};
use std::collections::HashMap;

/// Rounds of an advance before a meeting counts as undecided.
const MAX_ROUNDS: usize = 1000;

/// Cells that a triangle or a query is looked up in, at most; beyond that everything is a candidate.
const MAX_CELLS: i64 = 4096;

/// Something to meet.
#[derive(Debug, Clone)]
pub enum Obstacle {
    /// A plane, the ball being on the side of its unit normal.
    Plane { normal: Vector, point: Vector },
    /// A triangle.
    Triangle([Vector; 3]),
}

/// How a ball on a flight meets an obstacle.
#[derive(Debug, Clone)]
pub enum Meeting {
    /// Not while the flight lasts.
    Never,
    /// It touches and closes, so many seconds after the start.
    Hit(Real),
    /// It touches and neither closes nor leaves, then.
    Lasting(Real),
    /// The rounds ran out.
    Undecided(Real),
}

impl Obstacle {
    /// The distance between the surface and a ball of `radius` at `x`, and the unit normal from the one to the other.
    pub fn gap(&self, x: &Vector, radius: &Real) -> (Real, Vector) {
        match self {
            Self::Plane { normal, point } => (&dot(&sub(x, point), normal) - radius, normal.clone()),
            Self::Triangle(corners) => {
                let away = sub(x, &closest(corners, x));
                let distance = norm(&away);
                if distance.is_zero() {
                    let n = cross(&sub(&corners[1], &corners[0]), &sub(&corners[2], &corners[0]));
                    return (-radius, scale(&n, &(Real::from(1.0) / norm(&n))));
                }
                (&distance - radius, scale(&away, &(&Real::from(1.0) / &distance)))
            }
        }
    }

    /// The first meeting on `flight` between `from` and `to`, with a ball of `radius`; what is within `touch` (m) touches.
    ///
    /// Both kinds are convex, so that the distance falls no faster than its rate and the acceleration let it: it is advanced to the zero of
    /// gap + rate s - bend s^2 / 2 again and again, and never past a touch.
    pub fn meet(&self, flight: &Flight, radius: &Real, from: &Real, to: &Real, touch: &Real) -> Meeting {
        let bend = Real::from(flight.bend);
        let mut t = from.clone();
        for _ in 0..MAX_ROUNDS {
            let (gap, n) = self.gap(&flight.position(&t), radius);
            let v = flight.velocity(&t);
            let rate = dot(&n, &v);
            let touches = gap <= *touch;
            let still = Real::from(2f64.powi(-90)) * (&norm(&v) + touch);
            if touches && rate < -&still {
                return Meeting::Hit(t);
            }
            if touches && rate <= still {
                return Meeting::Lasting(t);
            }
            let gap = if touches { Real::zero() } else { gap };
            if let (Self::Plane { .. }, Some(half)) = (self, flight.half_acceleration()) {
                return parabola_meets(&gap, &rate, &dot(&n, half), &t, to);
            }
            let root = (&(&rate * &rate) + &(&(&bend + &bend) * &gap)).sqrt();
            let step = if rate > Real::zero() {
                if bend.is_zero() {
                    return Meeting::Never;
                }
                &(&rate + &root) / &bend
            } else {
                let closing = &root - &rate;
                if closing.is_zero() {
                    return Meeting::Never;
                }
                &(&gap + &gap) / &closing
            };
            t += &step;
            if t >= *to {
                return Meeting::Never;
            }
        }
        Meeting::Undecided(t)
    }
}

/// The closed form: the first t after `now`, and before `to`, at which gap + rate s + half s^2 comes to 0 from above.
fn parabola_meets(gap: &Real, rate: &Real, half: &Real, now: &Real, to: &Real) -> Meeting {
    let four = Real::from(4.0);
    let discriminant = &(rate * rate) - &(&four * &(half * gap));
    // A graze is no impact.
    if discriminant <= Real::zero() {
        return Meeting::Never;
    }
    let root = discriminant.sqrt();
    let s = if *rate < Real::zero() {
        &(gap + gap) / &(&root - rate)
    } else if *half < Real::zero() {
        &(rate + &root) / &-&(half + half)
    } else {
        return Meeting::Never;
    };
    let t = now + &s;
    if t < *to { Meeting::Hit(t) } else { Meeting::Never }
}

/// The point of a triangle that is nearest to `x`, by the regions of its corners, edges and inside (Ericson 2005, 5.1.5).
fn closest([a, b, c]: &[Vector; 3], x: &Vector) -> Vector {
    let zero = Real::zero();
    let (ab, ac, ax) = (sub(b, a), sub(c, a), sub(x, a));
    let (d1, d2) = (dot(&ab, &ax), dot(&ac, &ax));
    if d1 <= zero && d2 <= zero {
        return a.clone();
    }
    let bx = sub(x, b);
    let (d3, d4) = (dot(&ab, &bx), dot(&ac, &bx));
    if d3 >= zero && d4 <= d3 {
        return b.clone();
    }
    let vc = &(&d1 * &d4) - &(&d3 * &d2);
    if vc <= zero && d1 >= zero && d3 <= zero {
        return add(a, &scale(&ab, &(&d1 / &(&d1 - &d3))));
    }
    let cx = sub(x, c);
    let (d5, d6) = (dot(&ab, &cx), dot(&ac, &cx));
    if d6 >= zero && d5 <= d6 {
        return c.clone();
    }
    let vb = &(&d5 * &d2) - &(&d1 * &d6);
    if vb <= zero && d2 >= zero && d6 <= zero {
        return add(a, &scale(&ac, &(&d2 / &(&d2 - &d6))));
    }
    let va = &(&d3 * &d6) - &(&d5 * &d4);
    let (d43, d56) = (&d4 - &d3, &d5 - &d6);
    if va <= zero && d43 >= zero && d56 >= zero {
        return add(b, &scale(&sub(c, b), &(&d43 / &(&d43 + &d56))));
    }
    let sum = &(&va + &vb) + &vc;
    add(a, &add(&scale(&ab, &(&vb / &sum)), &scale(&ac, &(&vc / &sum))))
}

/// A triangle of a surface.
#[derive(Debug, Clone)]
struct Face {
    surface: usize,
    obstacle: Obstacle,
    /// Its box.
    low: Vector3<f64>,
    high: Vector3<f64>,
}

/// All surfaces.
#[derive(Debug, Clone)]
pub struct World {
    planes: Vec<(usize, Plane)>,
    faces: Vec<Face>,
    grid: HashMap<[i64; 3], Vec<u32>>,
    /// Faces too large for the grid.
    large: Vec<u32>,
    cell: f64,
}

impl World {
    /// The surfaces of `plan`.
    pub fn new(plan: &Plan) -> Self {
        let mut faces = Vec::new();
        for (surface, mesh) in &plan.meshes {
            for face in 0..mesh.faces().len() as u32 {
                let corners = mesh.triangle(face);
                let obstacle = Obstacle::Triangle(corners.each_ref().map(point));
                let low = corners[0].coords.inf(&corners[1].coords).inf(&corners[2].coords);
                let high = corners[0].coords.sup(&corners[1].coords).sup(&corners[2].coords);
                faces.push(Face { surface: *surface, obstacle, low, high });
            }
        }
        // Cells of about the size of the faces.
        let size =
            faces.iter().map(|face: &Face| (face.high - face.low).amax()).sum::<f64>() / faces.len().max(1) as f64;
        let cell = if size > 0.0 { size } else { 1.0 };
        let mut world = Self { planes: plan.planes.clone(), faces, grid: HashMap::new(), large: Vec::new(), cell };
        for face in 0..world.faces.len() {
            match world.cells(&world.faces[face].low, &world.faces[face].high) {
                Some(cells) => cells.into_iter().for_each(|cell| world.grid.entry(cell).or_default().push(face as u32)),
                None => world.large.push(face as u32),
            }
        }
        world
    }

    /// The cells of a box; none if they are too many.
    fn cells(&self, low: &Vector3<f64>, high: &Vector3<f64>) -> Option<Vec<[i64; 3]>> {
        let index = |v: &Vector3<f64>| v.map(|x| (x / self.cell).floor());
        let (a, b) = (index(low), index(high));
        let count = (b - a).add_scalar(1.0).product();
        if count.is_nan() || count > MAX_CELLS as f64 {
            return None;
        }
        let range = |axis: usize| (a[axis] as i64)..=(b[axis] as i64);
        let mut cells = Vec::new();
        for i in range(0) {
            for j in range(1) {
                cells.extend(range(2).map(|k| [i, j, k]));
            }
        }
        Some(cells)
    }

    /// The planes as met by a ball that starts at `start` with `velocity`, with their surfaces.
    pub fn planes(&self, start: &Point3<f64>, velocity: &Vector3<f64>) -> Vec<(usize, Obstacle)> {
        let obstacle = |(surface, plane): &(usize, Plane)| {
            let n = vector(&plane.normal());
            let unit = scale(&n, &(Real::from(1.0) / norm(&n)));
            // A centre on the plane is on the side it moves to.
            let towards = if plane.normal().dot(velocity) < 0.0 { Side::Negative } else { Side::Positive };
            let side = plane.side_of(start).unwrap_or(towards);
            let normal = scale(&unit, &Real::from(side.sign()));
            (*surface, Obstacle::Plane { normal, point: point(&plane.point()) })
        };
        self.planes.iter().map(obstacle).collect()
    }

    /// Whether there are triangles.
    pub fn has_faces(&self) -> bool {
        !self.faces.is_empty()
    }

    /// The usual size of a triangle, in m.
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// The triangles that come within `reach` of `x`, and perhaps others.
    pub fn near(&self, x: &Vector3<f64>, reach: f64) -> Vec<(usize, &Obstacle)> {
        let (low, high) = (x.add_scalar(-reach), x.add_scalar(reach));
        let mut found: Vec<u32> = match self.cells(&low, &high) {
            Some(cells) => {
                let listed = cells.iter().filter_map(|cell| self.grid.get(cell)).flatten();
                listed.chain(&self.large).copied().collect()
            }
            None => (0..self.faces.len() as u32).collect(),
        };
        found.sort_unstable();
        found.dedup();
        let touches = |face: &&Face| (0..3).all(|k| face.low[k] <= high[k] && low[k] <= face.high[k]);
        let faces = found.into_iter().map(|f| &self.faces[f as usize]).filter(touches);
        faces.map(|face| (face.surface, &face.obstacle)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners() -> [Vector; 3] {
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(|c| c.map(Real::from))
    }

    #[test]
    fn the_closest_point_is_found_in_each_of_the_seven_regions() {
        for (x, expected) in [
            ([1.0, 1.0, 3.0], [1.0, 1.0, 0.0]),
            ([-1.0, -1.0, 0.0], [0.0, 0.0, 0.0]),
            ([6.0, -1.0, 1.0], [4.0, 0.0, 0.0]),
            ([-1.0, 6.0, 1.0], [0.0, 4.0, 0.0]),
            ([2.0, -3.0, 1.0], [2.0, 0.0, 0.0]),
            ([-3.0, 2.0, 1.0], [0.0, 2.0, 0.0]),
            ([3.0, 3.0, 1.0], [2.0, 2.0, 0.0]),
        ] {
            assert_eq!(closest(&corners(), &x.map(Real::from)).map(|c| c.to_f64()), expected, "{x:?}");
        }
    }

    #[test]
    fn a_ball_meets_an_edge_where_the_quartic_says() {
        // Straight down beside the edge y = 0 at a distance of 0.3, radius 0.5: it touches 0.4 above.
        let start = [1.0, -0.3, 2.4].map(Real::from);
        let flight = Flight::parabola(&start, &[0.0, 0.0, -1.0].map(Real::from), &[0.0; 3].map(Real::from), 8.0);
        let touch = Real::from(2f64.powi(-100));
        let met =
            Obstacle::Triangle(corners()).meet(&flight, &Real::from(0.5), &Real::zero(), &Real::from(8.0), &touch);
        // 0.3 and 2.4 are off by their own rounding.
        let Meeting::Hit(t) = met else { panic!("{met:?}") };
        assert!((t.to_f64() - 2.0).abs() < 1e-15, "{t:?}");
    }
}
