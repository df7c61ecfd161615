//! Random numbers that are the same on every machine: SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).

use nalgebra::{Point3, Vector3};

/// A stream of random numbers that its seed determines.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// The stream of `seed`.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A multiple of 2^-53 in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in [low, high).
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// A number from 2^low up to 2^high; each octave is as likely.
    pub fn octave(&mut self, low: i32, high: i32) -> f64 {
        let k = low + self.below((high - low) as usize) as i32;
        2f64.powi(k) * self.within(1.0, 2.0)
    }

    /// A vector in [-size, size)^3.
    pub fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::new(self.within(-size, size), self.within(-size, size), self.within(-size, size))
    }

    /// A point in [-size, size)^3.
    pub fn point(&mut self, size: f64) -> Point3<f64> {
        Point3::from(self.vector(size))
    }

    /// A triangle in [-size, size)^3.
    pub fn triangle(&mut self, size: f64) -> [Point3<f64>; 3] {
        [self.point(size), self.point(size), self.point(size)]
    }

    /// A point of the triangle, evenly spread, to rounding.
    pub fn in_triangle(&mut self, [a, b, c]: &[Point3<f64>; 3]) -> Point3<f64> {
        let (s, t) = (self.unit(), self.unit());
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        a + (b - a) * s + (c - a) * t
    }
}
