//! The terrain z = 0.3 sin(1.7 x) cos(2.3 y) on [-20, 20]^2, in as many triangles as wanted.

use nalgebra::Point3;

/// Half the side of the terrain, in m.
pub const HALF: f64 = 20.0;

/// Squares along a side for which the terrain has 200 978 triangles.
pub const SQUARES: u32 = 317;

/// The height of the terrain in m at (x, y).
pub fn height(x: f64, y: f64) -> f64 {
    0.3 * (1.7 * x).sin() * (2.3 * y).cos()
}

/// The vertices and faces of the terrain in `squares` x `squares` squares of two triangles each, fronts up.
pub fn terrain(squares: u32) -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let n = squares + 1;
    let at = |k: u32| 2.0 * HALF * f64::from(k) / f64::from(squares) - HALF;
    let vertices = (0..n * n).map(|k| {
        let (x, y) = (at(k % n), at(k / n));
        Point3::new(x, y, height(x, y))
    });
    let faces = (0..squares * squares).flat_map(|k| {
        let a = k / squares * n + k % squares;
        [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]
    });
    (vertices.collect(), faces.collect())
}
