//! Segments over the terrain, short and long, in random order and in that of their places.

use crate::random::Random;
use crate::terrain::{HALF, height};
use nalgebra::{Point3, Vector3};

/// A segment: where it begins, and from there to its end.
pub type Segment = (Point3<f64>, Vector3<f64>);

/// What a ball flies between two bounces: down from 0.5 m above the terrain, a metre or so.
pub fn short(count: usize) -> Vec<Segment> {
    let mut random = Random::new(3);
    let mut one = || {
        let (x, y) = (random.within(1.0 - HALF, HALF - 1.0), random.within(1.0 - HALF, HALF - 1.0));
        let along = random.vector(0.6);
        (Point3::new(x, y, height(x, y) + 0.5), Vector3::new(along.x, along.y, -1.0))
    };
    (0..count).map(|_| one()).collect()
}

/// From anywhere 2 m above the terrain to anywhere 2 m below: about 20 m, of which a half is above it.
pub fn long(count: usize) -> Vec<Segment> {
    let mut random = Random::new(4);
    let mut at = |z: f64| Point3::new(random.within(-HALF, HALF), random.within(-HALF, HALF), z);
    let mut one = || {
        let (from, to) = (at(2.0), at(-2.0));
        (from, to - from)
    };
    (0..count).map(|_| one()).collect()
}

/// The same segments by the places where they begin, along a curve that keeps neighbours together (Morton 1966).
pub fn sorted(mut segments: Vec<Segment>) -> Vec<Segment> {
    const BITS: u32 = 20;
    let spread = |c: f64| {
        let cell = ((c + HALF) / (2.0 * HALF) * f64::from(1u32 << BITS)) as u64;
        (0..BITS).map(|i| ((cell >> i) & 1) << (2 * i)).sum::<u64>()
    };
    segments.sort_by_key(|(from, _)| spread(from.x) | (spread(from.y) << 1));
    segments
}
