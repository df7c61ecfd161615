//! The scenes that are timed.

use crate::random::Random;
use crate::terrain::{HALF, height, terrain};
use carom_dynamics::body::Ball;
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::gravity::Gravity;
use carom_dynamics::effects::restitution::Restitution;
use carom_dynamics::scene::Scene;
use carom_dynamics::surface::{Material, Shape, Surface};
use carom_geometry::mesh::Mesh;
use carom_geometry::plane::Plane;
use nalgebra::{Point3, Vector3};
use std::error::Error;
use std::sync::Arc;

/// What can go wrong while a scene is made: its numbers are constants, so nothing does.
pub type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Earth's acceleration, as all peers are given it, in m/s^2.
pub const GRAVITY: f64 = 9.81;

/// The radius of the balls on the terrain, in m.
pub const BALL_RADIUS: f64 = 0.05;

fn surface(name: &str, c_r: f64, shape: Shape) -> Result<Surface> {
    let material = Material { restitution: Restitution::new(c_r)?, friction: Friction::None };
    Ok(Surface { name: name.into(), material, shape })
}

fn falling(duration: f64) -> Result<Scene> {
    let gravity = Some(Gravity::uniform(Vector3::new(0.0, 0.0, -GRAVITY))?);
    Ok(Scene { gravity, ..Scene::lasting(duration) })
}

/// Scene A, with restitution 0.8 and 3 s: one ball of 0.1 m falls 1 m onto a plane.
pub fn one_ball(duration: f64, c_r: f64) -> Result<Scene> {
    let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
    Ok(Scene {
        surfaces: vec![surface("floor", c_r, Shape::Plane(floor))?],
        balls: vec![Ball::new(Point3::new(0.0, 0.0, 1.1), Vector3::zeros(), 0.1, None)?],
        ..falling(duration)?
    })
}

/// Where ball `i` of scene B starts: 0.8 to 1.2 m above the terrain, at up to 1 m/s along each axis.
pub fn start_on_terrain(i: usize) -> (Point3<f64>, Vector3<f64>) {
    let mut random = Random::new(i as u64);
    let mut along = || random.within(0.1 - HALF, HALF - 0.1) * 0.9;
    let (x, y) = (along(), along());
    let z = height(x, y) + random.within(0.8, 1.2);
    (Point3::new(x, y, z), random.vector(1.0))
}

/// Scene B: balls of 5 cm on the terrain of `squares` x `squares` squares, without friction.
pub fn balls_on_terrain(squares: u32, balls: usize, c_r: f64, duration: f64) -> Result<Scene> {
    let (vertices, faces) = terrain(squares);
    let mesh = Arc::new(Mesh::new(vertices, faces)?);
    let ball = |i| {
        let (position, velocity) = start_on_terrain(i);
        Ball::new(position, velocity, BALL_RADIUS, None)
    };
    Ok(Scene {
        surfaces: vec![surface("terrain", c_r, Shape::Mesh(mesh))?],
        balls: (0..balls).map(ball).collect::<std::result::Result<_, _>>()?,
        ..falling(duration)?
    })
}

/// A ball on the terrain of 7938 triangles, with restitution 0.9, whose next 8 s are wanted; `balls` of them, one by one.
pub fn predicted(balls: usize) -> Result<Scene> {
    balls_on_terrain(63, balls, 0.9, 8.0)
}

/// Balls of 1 cm in a room of 10 m with six elastic walls, without gravity, at 10 m/s or so.
pub fn balls_in_room(balls: usize, duration: f64) -> Result<Scene> {
    let mut surfaces = Vec::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (side, sign) in [("low", -1.0), ("high", 1.0)] {
            let mut normal = Vector3::zeros();
            normal[axis] = -sign;
            let plane = Plane::from_point_normal(Point3::from(normal * -5.0), normal)?;
            surfaces.push(surface(&format!("{name} {side}"), 1.0, Shape::Plane(plane))?);
        }
    }
    let mut random = Random::new(1);
    let mut ball = || Ball::new(Point3::from(random.vector(4.0)), random.vector(10.0), 0.01, None);
    let balls = (0..balls).map(|_| ball()).collect::<std::result::Result<_, _>>()?;
    Ok(Scene { surfaces, balls, ..Scene::lasting(duration) })
}
