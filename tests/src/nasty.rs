//! Nasty input: neighbours by ulps, points planted on edges and vertices, slivers, scales by powers of two.

use nalgebra::{Point2, Point3};

/// `x` moved by `n` ulps, up if n > 0.
pub fn ulps(x: f64, n: i32) -> f64 {
    (0..n.abs()).fold(x, |x, _| if n > 0 { x.next_up() } else { x.next_down() })
}

/// The (2 n + 1)^2 points whose coordinates are within `n` ulps of those of `p`.
pub fn neighbours2(p: Point2<f64>, n: i32) -> impl Iterator<Item = Point2<f64>> {
    (-n..=n).flat_map(move |i| (-n..=n).map(move |j| Point2::new(ulps(p.x, i), ulps(p.y, j))))
}

/// The (2 n + 1)^3 points whose coordinates are within `n` ulps of those of `p`.
pub fn neighbours3(p: Point3<f64>, n: i32) -> impl Iterator<Item = Point3<f64>> {
    neighbours2(p.xy(), n).flat_map(move |q| (-n..=n).map(move |k| Point3::new(q.x, q.y, ulps(p.z, k))))
}

/// Points on a triangle: its vertices, points of its edges at k / 8 and its centre, all as near as f64 gets.
pub fn planted(triangle: &[Point3<f64>; 3]) -> Vec<Point3<f64>> {
    let [a, b, c] = *triangle;
    let mut points = vec![a, b, c, a + ((b - a) + (c - a)) / 3.0];
    for (p, q) in [(a, b), (b, c), (c, a)] {
        points.extend((1..8).map(|k| p + (q - p) * (f64::from(k) / 8.0)));
    }
    points
}

/// Triangles of length about 1 and height 2^-k for k in 0..=52: thinner ones collapse.
pub fn slivers() -> impl Iterator<Item = [Point3<f64>; 3]> {
    (0..=52).map(|k| {
        let h = 2f64.powi(-k);
        [Point3::new(0.1, 0.2, 0.3), Point3::new(1.3, 0.7, -0.4), Point3::new(0.7, 0.45 + h, -0.05 - 0.3 * h)]
    })
}

/// Powers of two from 2^-1000 to 2^900, by which a scene scales exactly.
pub fn scales() -> impl Iterator<Item = f64> {
    (-20..=18).map(|k| 2f64.powi(50 * k))
}
