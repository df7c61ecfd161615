//! The scenes as rapier3d has them, in f32, as it is used.

use carom_benches::clock::median;
use carom_benches::scenes::{BALL_RADIUS, GRAVITY, Result, start_on_terrain};
use carom_benches::terrain::{SQUARES, terrain};
use rapier3d::prelude::*;

fn world(dt: f32) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::Z * -(GRAVITY as f32);
    world.integration_parameters.dt = dt;
    world
}

fn ball(radius: f32, restitution: f32) -> ColliderBuilder {
    // Balls meet the ground and not each other.
    let groups = InteractionGroups::new(Group::GROUP_1, Group::GROUP_2, InteractionTestMode::And);
    ColliderBuilder::ball(radius).restitution(restitution).friction(0.0).collision_groups(groups)
}

fn ground(shape: ColliderBuilder) -> ColliderBuilder {
    let groups = InteractionGroups::new(Group::GROUP_2, Group::GROUP_1, InteractionTestMode::And);
    shape.friction(0.0).restitution_combine_rule(CoefficientCombineRule::Max).collision_groups(groups)
}

fn simulate(mut world: PhysicsWorld, duration: f64) {
    let steps = (duration / f64::from(world.integration_parameters.dt)).round() as usize;
    (0..steps).for_each(|_| world.step());
}

/// The seconds that one ball on a plane takes.
pub fn one_ball(duration: f64, dt: f64) -> f64 {
    median(5, || {
        let mut world = world(dt as f32);
        world.colliders.insert(ground(ColliderBuilder::new(SharedShape::halfspace(Vector::Z))));
        let body = world.bodies.insert(RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 1.1)));
        world.colliders.insert_with_parent(ball(0.1, 0.8), body, &mut world.bodies);
        simulate(world, duration);
    })
}

/// The seconds that `balls` balls on the terrain take, with its best mesh setting.
pub fn balls_on_terrain(balls: usize, duration: f64, dt: f64) -> Result<f64> {
    let (vertices, faces) = terrain(SQUARES);
    let vertices: Vec<Vector> = vertices.iter().map(|v| Vector::new(v.x as f32, v.y as f32, v.z as f32)).collect();
    let mesh = SharedShape::trimesh_with_flags(vertices, faces, TriMeshFlags::FIX_INTERNAL_EDGES)?;
    Ok(median(3, || {
        let mut world = world(dt as f32);
        world.colliders.insert(ground(ColliderBuilder::new(mesh.clone())));
        for i in 0..balls {
            let (p, v) = start_on_terrain(i);
            let place = Vector::new(p.x as f32, p.y as f32, p.z as f32);
            let velocity = Vector::new(v.x as f32, v.y as f32, v.z as f32);
            let body = RigidBodyBuilder::dynamic().translation(place).linvel(velocity).ccd_enabled(true);
            let body = world.bodies.insert(body);
            world.colliders.insert_with_parent(ball(BALL_RADIUS as f32, 0.7), body, &mut world.bodies);
        }
        simulate(world, duration);
    }))
}
