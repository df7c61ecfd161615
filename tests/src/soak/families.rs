//! The scenes of the soak: each ball of a family is made from its seed.

use crate::closed::{BODIES, Closed, Treatment};
use crate::random::Random;
use crate::stage::{Stage, coulomb, rough, smooth};
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::surface::{Material, Shape};
use nalgebra::{Point3, Vector3};
use std::sync::Arc;

/// Bounces that a ball without loss is given time for, about.
const BOUNCES: f64 = 20_000.0;
/// Gravity in m/s^2.
const G: f64 = 9.81;

/// The meshes, read once.
pub struct Places(Vec<Arc<Closed>>);

impl Default for Places {
    fn default() -> Self {
        Self(BODIES.iter().map(|body| Arc::new(Closed::new(body, Treatment::AsItIs))).collect())
    }
}

/// One ball in its scene.
pub struct Unit {
    /// The scene.
    pub(super) stage: Stage,
    /// A point and the unit normal of each plane, towards the ball.
    pub(super) planes: Vec<(Point3<f64>, Vector3<f64>)>,
    /// The mesh around it.
    pub(super) closed: Option<Arc<Closed>>,
}

impl Unit {
    /// The scene.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }
}

/// A kind of scene.
pub struct Family {
    /// Its name.
    pub name: &'static str,
    /// What is in it.
    pub what: &'static str,
    /// Its share of the bounces, in percent.
    pub share: u64,
    /// The ball of a seed.
    pub unit: fn(&Places, u64) -> Unit,
}

/// Every kind of scene; the shares add up to 100.
pub const FAMILIES: [Family; 10] = [
    Family { name: "floor", what: "a level floor, e = 1", share: 20, unit: floor },
    Family { name: "box", what: "a box of six planes without gravity, e = 1", share: 20, unit: weightless_box },
    Family { name: "heavy-box", what: "a box of six planes under any gravity, e = 1", share: 15, unit: heavy_box },
    Family { name: "wedge", what: "a V of two planes under gravity, e = 1", share: 15, unit: wedge },
    Family { name: "lossy-box", what: "a box, e < 1, any friction, until it rests", share: 5, unit: lossy_box },
    Family { name: "lossy-wedge", what: "a V, e < 1, any friction, until it rests", share: 5, unit: lossy_wedge },
    Family { name: "mesh", what: "inside a closed mesh without gravity, e = 1", share: 8, unit: weightless_mesh },
    Family { name: "heavy-mesh", what: "inside a closed mesh under gravity, e = 1", share: 8, unit: heavy_mesh },
    Family { name: "lossy-mesh", what: "inside a closed mesh, e < 1, any friction", share: 2, unit: lossy_mesh },
    Family { name: "thin-wedge", what: "a wedge of 10^-1 to 10^-5 rad, e = 1", share: 2, unit: thin_wedge },
];

fn random(seed: u64) -> Random {
    Random::new(seed.wrapping_mul(0x9e6c_63d0_876a_3f6b).wrapping_add(0x1fb7))
}

fn lossy(random: &mut Random) -> Material {
    let friction = match random.below(4) {
        0 => Friction::None,
        1 => coulomb(random.within(0.0, 1.5)),
        2 => Friction::impulse(random.within(0.0, 1.0)).unwrap_or_else(|e| panic!("{e}")),
        _ => Friction::linear(random.unit()).unwrap_or_else(|e| panic!("{e}")),
    };
    rough([0.0, 0.5, 0.9, random.within(0.0, 0.97)][random.below(4)], friction)
}

fn radius(random: &mut Random, most: f64) -> f64 {
    if random.below(3) == 0 { 0.0 } else { most * random.octave(-10, 0) * 0.5 }
}

fn floor(_: &Places, seed: u64) -> Unit {
    let mut random = random(seed);
    let (h, r) = (random.octave(-20, 10), radius(&mut random, 1.0));
    let period = 2.0 * (2.0 * h / G).sqrt();
    let stage = Stage::new(period * BOUNCES).down(G).floor(smooth(1.0)).ball([0.0, 0.0, r + h], [0.0; 3], r);
    Unit { stage, planes: vec![(Point3::origin(), Vector3::z())], closed: None }
}

/// A box with its lowest corner at a multiple of 1 m, and a ball in it; `g` is its gravity, of size 0 for none.
fn boxed(random: &mut Random, material: Material, g: f64, duration: Option<f64>) -> Unit {
    let shift = [0.0, 0.0, 1.0, 1000.0][random.below(4)];
    let size = Vector3::new(random.within(1.0, 4.0), random.within(1.0, 4.0), random.within(1.0, 4.0));
    let (low, high) = (Point3::new(shift, -shift, shift), Point3::new(shift, -shift, shift) + size);
    let r = radius(random, 0.5);
    let at = Vector3::from_fn(|i, _| r + (size[i] - 2.0 * r) * random.within(0.01, 0.99));
    let velocity = random.vector(random.clone().octave(-3, 6));
    let rate: f64 = (0..3).map(|i| velocity[i].abs() / (size[i] - 2.0 * r)).sum();
    // Under gravity a ball bounces on the floor at least.
    let rate = rate.max((g / (8.0 * size.amax())).sqrt());
    let mut stage = Stage::new(duration.unwrap_or(BOUNCES / rate)).gravity(random.vector(1.0) * g);
    let mut planes = Vec::new();
    for axis in 0..3 {
        let n = Vector3::ith(axis, 1.0);
        for (name, p, n) in [(["west", "south", "floor"][axis], low, n), (["east", "north", "roof"][axis], high, -n)] {
            stage = stage.plane(name, material, p, n);
            planes.push((p, n));
        }
    }
    Unit { stage: stage.ball(low + at, velocity, r), planes, closed: None }
}

fn weightless_box(_: &Places, seed: u64) -> Unit {
    boxed(&mut random(seed), smooth(1.0), 0.0, None)
}

fn heavy_box(_: &Places, seed: u64) -> Unit {
    boxed(&mut random(seed), smooth(1.0), G, None)
}

fn lossy_box(_: &Places, seed: u64) -> Unit {
    let mut random = random(seed);
    let material = lossy(&mut random);
    boxed(&mut random, material, G, Some(60.0))
}

/// Two planes that lean towards each other over the y axis, and a ball between them.
fn vee(random: &mut Random, material: Material, duration: Option<f64>) -> Unit {
    let half = random.within(5f64.to_radians(), 80f64.to_radians());
    let (sin, cos) = half.sin_cos();
    let (right, left) = (Vector3::new(-cos, 0.0, sin), Vector3::new(cos, 0.0, sin));
    let r = radius(random, 0.5);
    let h = random.octave(-6, 4);
    // Above where both planes are touched.
    let z = r / sin + h;
    let x = (z - r / sin) * half.tan() * random.within(-0.9, 0.9);
    let velocity = Vector3::new(random.within(-2.0, 2.0), random.within(-0.1, 0.1), 0.0);
    let speed = (2.0 * G * h + velocity.norm_squared()).sqrt();
    let stage = Stage::new(duration.unwrap_or(BOUNCES * speed / G))
        .down(G)
        .plane("left", material, [0.0; 3], left)
        .plane("right", material, [0.0; 3], right)
        .ball([x, 0.0, z], velocity, r);
    let unit = |n: Vector3<f64>| (Point3::origin(), n.normalize());
    Unit { stage, planes: vec![unit(left), unit(right)], closed: None }
}

fn wedge(_: &Places, seed: u64) -> Unit {
    vee(&mut random(seed), smooth(1.0), None)
}

fn lossy_wedge(_: &Places, seed: u64) -> Unit {
    let mut random = random(seed);
    let material = lossy(&mut random);
    vee(&mut random, material, Some(60.0))
}

fn thin_wedge(_: &Places, seed: u64) -> Unit {
    let mut random = random(seed);
    let angle = 10f64.powf(random.within(-5.0, -1.0));
    let (sin, cos) = angle.sin_cos();
    let (floor, roof) = (Vector3::z(), Vector3::new(sin, 0.0, -cos));
    // In at a slant, out again after pi / angle hits.
    let start = Point3::new(1.0, 0.0, angle.tan() * random.within(0.1, 0.9));
    let velocity = Vector3::new(-1.0, random.within(-0.1, 0.1), angle * random.within(-1.0, 1.0));
    let stage = Stage::new(4.0)
        .plane("floor", smooth(1.0), [0.0; 3], floor)
        .plane("roof", smooth(1.0), [0.0; 3], roof)
        .ball(start, velocity, 0.0);
    let planes = vec![(Point3::origin(), floor), (Point3::origin(), roof.normalize())];
    Unit { stage, planes, closed: None }
}

fn in_a_mesh(places: &Places, random: &mut Random, material: Material, g: f64, bounces: f64) -> Unit {
    let closed = Arc::clone(&places.0[random.below(places.0.len())]);
    let start = closed.start(random);
    let r = if random.below(3) == 0 { 0.0 } else { start.room * random.within(0.05, 0.95) };
    let r = if r > closed.resolved() { r } else { 0.0 };
    let velocity = random.vector(random.clone().octave(-2, 4));
    let speed = velocity.norm().max((g * closed.size).sqrt());
    let duration = bounces * 0.2 * closed.size / speed;
    let stage = Stage::new(duration)
        .gravity(random.vector(1.0) * g)
        .surface("body", material, Shape::Mesh(Arc::clone(&closed.mesh)))
        .ball(start.position, velocity, r);
    Unit { stage, planes: Vec::new(), closed: Some(closed) }
}

fn weightless_mesh(places: &Places, seed: u64) -> Unit {
    in_a_mesh(places, &mut random(seed), smooth(1.0), 0.0, BOUNCES)
}

fn heavy_mesh(places: &Places, seed: u64) -> Unit {
    in_a_mesh(places, &mut random(seed), smooth(1.0), G, BOUNCES)
}

fn lossy_mesh(places: &Places, seed: u64) -> Unit {
    let mut random = random(seed);
    let material = lossy(&mut random);
    in_a_mesh(places, &mut random, material, G, 1000.0)
}
