//! Distances between points and triangles in rational numbers: who is right when two programs disagree.

use dashu_ratio::Relaxed;
use nalgebra::{Point3, Vector3};

/// An exact number.
pub type Exact = Relaxed;

/// An exact point or vector.
pub type ExactVector = [Exact; 3];

/// `x` exactly; panics if it is not finite.
pub fn exact(x: f64) -> Exact {
    Exact::try_from(x).unwrap_or_else(|_| panic!("{x} is not finite"))
}

/// A point exactly.
pub fn point(p: &Point3<f64>) -> ExactVector {
    [exact(p.x), exact(p.y), exact(p.z)]
}

/// The nearest f64.
pub fn nearest(x: &Exact) -> f64 {
    x.to_f64().value()
}

/// p(t) = start + t1 t + t2 t^2 + ... with the terms t1, t2 ..., without a rounding.
pub fn on_path(start: &Point3<f64>, terms: &[Vector3<f64>], t: f64) -> ExactVector {
    let t = exact(t);
    std::array::from_fn(|i| {
        let displacement = terms.iter().rev().fold(Exact::ZERO, |sum, term| (sum + exact(term[i])) * &t);
        exact(start[i]) + displacement
    })
}

/// a - b.
pub fn minus(a: &ExactVector, b: &ExactVector) -> ExactVector {
    std::array::from_fn(|i| &a[i] - &b[i])
}

/// a . b.
pub fn dot(a: &ExactVector, b: &ExactVector) -> Exact {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// a x b.
pub fn cross(a: &ExactVector, b: &ExactVector) -> ExactVector {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &a[j] * &b[k] - &a[k] * &b[j]
    })
}

/// The squared distance of `x` from the triangle: over the face if x projects into it, else the least over the edges.
pub fn distance_squared(triangle: &[Point3<f64>; 3], x: &ExactVector) -> Exact {
    let t = triangle.each_ref().map(point);
    let n = cross(&minus(&t[1], &t[0]), &minus(&t[2], &t[0]));
    let area = dot(&n, &n);
    let within = |i: usize| dot(&n, &cross(&minus(&t[(i + 1) % 3], &t[i]), &minus(x, &t[i]))) >= Exact::ZERO;
    if !area.is_zero() && (0..3).all(within) {
        let height = dot(&n, &minus(x, &t[0]));
        return &height * &height / area;
    }
    let edge = |i: usize| {
        let (e, w) = (minus(&t[(i + 1) % 3], &t[i]), minus(x, &t[i]));
        let (along, length) = (dot(&e, &w), dot(&e, &e));
        let square = dot(&w, &w);
        if along <= Exact::ZERO || length.is_zero() {
            square
        } else if along >= length {
            square + &length - along * exact(2.0)
        } else {
            square - &along * &along / length
        }
    };
    edge(0).min(edge(1)).min(edge(2))
}

/// How far a ball at `x` is from touching the triangle, distance - radius, rounded only at the end: good to a few u of itself.
pub fn clearance(triangle: &[Point3<f64>; 3], x: &ExactVector, radius: f64) -> f64 {
    let square = distance_squared(triangle, x);
    let r = exact(radius);
    let distance = nearest(&square).sqrt();
    if radius == 0.0 { distance } else { nearest(&(square - &r * &r)) / (distance + radius) }
}

/// Whether the closed segment meets the closed triangle, by the signs of five volumes; panics if all five points lie in one plane.
pub fn segment_meets(triangle: &[Point3<f64>; 3], from: &Point3<f64>, to: &Point3<f64>) -> bool {
    let t = triangle.each_ref().map(point);
    let (p, q) = (point(from), point(to));
    let volume = |a: &ExactVector, b: &ExactVector, c: &ExactVector, d: &ExactVector| {
        dot(&cross(&minus(b, a), &minus(c, a)), &minus(d, a))
    };
    let (above, below) = (volume(&t[0], &t[1], &t[2], &p), volume(&t[0], &t[1], &t[2], &q));
    assert!(!(above.is_zero() && below.is_zero()), "in one plane");
    let sides = [volume(&p, &q, &t[0], &t[1]), volume(&p, &q, &t[1], &t[2]), volume(&p, &q, &t[2], &t[0])];
    let zero = Exact::ZERO;
    above * below <= zero && (sides.iter().all(|s| *s >= zero) || sides.iter().all(|s| *s <= zero))
}
