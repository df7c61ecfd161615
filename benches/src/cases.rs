//! Balls against one triangle: the cases whose first contact is known exactly, which start apart.

use carom_geometry::path::Path;
use carom_geometry::rounding::point_radius;
use nalgebra::{Point3, Vector3};

const TABLE: &str = include_str!("../../tests/data/geometry-cases/ball_vs_triangle_exact.csv");

/// A ball on its way past or into a triangle.
#[derive(Debug, Clone)]
pub struct Case {
    /// The path over the whole duration, f in [0, 1].
    pub path: Path,
    /// The radius; that of the ball that stands for a point, if it is one.
    pub radius: f64,
    /// The triangle.
    pub triangle: [Point3<f64>; 3],
    /// Velocity at the start in m/s.
    pub velocity: Vector3<f64>,
    /// Acceleration in m/s^2.
    pub acceleration: Vector3<f64>,
    /// How long it flies, in s.
    pub duration: f64,
    /// The exact time of the first contact, if there is one.
    pub contact: Option<f64>,
}

/// All cases of the table in which the ball starts apart from the triangle.
pub fn ball_and_triangle() -> Vec<Case> {
    TABLE.lines().skip(1).filter_map(case).collect()
}

fn case(row: &str) -> Option<Case> {
    let cells: Vec<&str> = row.split(',').collect();
    let number = |i: usize| cells.get(i)?.parse::<f64>().ok();
    let vector = |i: usize| Some(Vector3::new(number(i)?, number(i + 1)?, number(i + 2)?));
    if *cells.get(22)? != "outside" {
        return None;
    }
    let (start, velocity, acceleration) = (Point3::from(vector(2)?), vector(5)?, vector(8)?);
    let triangle = [vector(12)?, vector(15)?, vector(18)?].map(Point3::from);
    let (given, duration) = (number(11)?, number(21)?);
    let farthest = triangle.iter().map(|v| v.coords.amax()).fold(start.coords.amax(), f64::max);
    Some(Case {
        path: Path::parabola(start, velocity * duration, acceleration * (0.5 * duration * duration)),
        radius: if given == 0.0 { point_radius(farthest) } else { given },
        triangle,
        velocity,
        acceleration,
        duration,
        contact: if cells.get(23) == Some(&"1") { number(24) } else { None },
    })
}
