//! What rapier3d makes of the conformance pack: its events of every scene, as the files that `carom compare` reads.
//!
//! The engine is given what suits it: steps of 1/240 s and not fewer than a thousand, continuous collision detection, inner edges
//! of meshes fixed, surfaces turned towards the ball, no rotation, no sleep. Where it has no law of its own, drag is a force of the user's.

use carom_benches::scenes::Result;
use carom_dynamics::body::{Ball, Body};
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::scene::Scene;
use carom_dynamics::surface::{Shape, Surface};
use rapier3d::prelude::*;
use std::fmt::Write;
use std::path::Path;

/// The longest step in s, and the least number of steps.
const STEP: f64 = 1.0 / 240.0;
const STEPS: f64 = 1000.0;

/// A point is a ball of this radius in m, and every plane that much farther away: which is the same.
const POINT: f64 = 0.01;

/// Slower than this, in m/s, is at rest.
const REST: f64 = 1e-3;

/// Writes the events of every scene in the folder `pack`/scenes into the folder `out`; what cannot be told to the engine gets a file that says why.
pub fn run(pack: &Path, out: &Path) -> Result<()> {
    std::fs::create_dir_all(out)?;
    for entry in std::fs::read_dir(pack.join("scenes"))? {
        let path = entry?.path();
        let (Some(name), Some("toml")) = (path.file_stem(), path.extension().and_then(|e| e.to_str())) else {
            continue;
        };
        let scene = carom::read_scene(&path)?;
        let name = name.to_string_lossy();
        match refusal(&scene) {
            Some(why) => std::fs::write(out.join(format!("{name}.txt")), why)?,
            None => std::fs::write(out.join(format!("{name}.csv")), events(&scene)?)?,
        }
    }
    Ok(())
}

/// Why the engine cannot be told the scene, if it cannot.
fn refusal(scene: &Scene) -> Option<&'static str> {
    if scene.surfaces.iter().any(|s| matches!(s.material.friction, Friction::Linear(_))) {
        return Some("it has no such law of friction");
    }
    let range = f64::from(f32::MIN_POSITIVE).sqrt()..f64::from(f32::MAX).sqrt();
    let is_told = |x: f64| x == 0.0 || range.contains(&x.abs());
    let balls = scene.balls.iter().flat_map(|b| [b.start().position.coords, b.start().velocity]);
    let numbers = balls
        .flat_map(|v| [v.x, v.y, v.z])
        .chain(scene.gravity.iter().flat_map(|g| <[f64; 3]>::from(g.acceleration())));
    (!numbers.chain([scene.duration]).all(is_told)).then_some("its squares are not in the range of f32")
}

fn events(scene: &Scene) -> Result<String> {
    let mut table = "t,ball,kind,x,y,z,vx,vy,vz\n".to_owned();
    for (index, ball) in scene.balls.iter().enumerate() {
        for (time, kind, at, v) in ball_events(scene, ball)? {
            writeln!(table, "{time:?},{index},{kind},{:?},{:?},{:?},{:?},{:?},{:?}", at.x, at.y, at.z, v.x, v.y, v.z)?;
        }
    }
    Ok(table)
}

type Happening = (f64, &'static str, Vector, Vector);

/// What happens to one ball, which is alone: an impact wherever contacts begin to push it, and rest if it is at rest from then on.
fn ball_events(scene: &Scene, ball: &Ball) -> Result<Vec<Happening>> {
    let dt = STEP.min(scene.duration / STEPS);
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = dt as f32;
    world.gravity = scene.gravity.map_or(Vector::ZERO, |g| vector(g.acceleration().into()));
    for surface in &scene.surfaces {
        world.colliders.insert(collider(surface, ball)?);
    }
    let start = ball.start();
    let body = RigidBodyBuilder::dynamic()
        .translation(vector(start.position.coords.into()))
        .linvel(vector(start.velocity.into()))
        .lock_rotations()
        .can_sleep(false)
        .ccd_enabled(true);
    let handle = world.bodies.insert(body);
    let shape = ColliderBuilder::ball(radius(ball) as f32).mass(ball.mass().unwrap_or(1.0) as f32).friction(0.0);
    // What a surface is made of decides alone.
    world.colliders.insert_with_parent(shape.restitution(0.0), handle, &mut world.bodies);
    let seen = Body { radius: ball.radius(), inertia: 1.0, drag: ball.drag().unwrap_or(0.0), spin: ball.spin() };
    let (mut found, mut hit, mut still_since): (Vec<Happening>, bool, Option<Happening>) = (Vec::new(), false, None);
    for step in 1..=(scene.duration / dt).round() as u64 {
        let mut expected = world.gravity * dt as f32;
        let body = &mut world.bodies[handle];
        let before = body.linvel();
        if let Some(drag) = scene.drag {
            let through = vector(drag.wind().into()) - before;
            let force = through * drag.force_per_speed(f64::from(through.length()), &seen) as f32;
            body.reset_forces(true);
            body.add_force(force, true);
            expected += force * (dt as f32 / body.mass());
        }
        world.step();
        let body = &world.bodies[handle];
        let (at, v, time) = (body.translation(), body.linvel(), step as f64 * dt);
        let push = v - before - expected;
        // More than holds it up, and more than what rounding does to the velocity.
        let is_hit = push.length() > 2.0 * expected.length() + 1e-4 * before.length();
        if is_hit && !hit && push.dot(before) < 0.0 {
            found.push((time, "impact", at, v));
        } else if let (true, true, Some(last)) = (is_hit, hit, found.last_mut()) {
            // An impact that takes several steps ends with the last of them.
            last.3 = v;
        }
        hit = is_hit;
        still_since = if f64::from(v.length()) < REST { still_since.or(Some((time, "rest", at, v))) } else { None };
    }
    found.extend(still_since);
    Ok(found)
}

fn radius(ball: &Ball) -> f64 {
    if ball.radius() == 0.0 { POINT } else { ball.radius() }
}

/// A surface as the ball meets it: planes have their solid side away from its start.
fn collider(surface: &Surface, ball: &Ball) -> Result<Collider> {
    let mu = match surface.material.friction {
        Friction::Coulomb(mu) | Friction::Impulse(mu) => mu.get(),
        _ => 0.0,
    };
    let shape = match &surface.shape {
        Shape::Plane(plane) => {
            let start = ball.start();
            let distance = plane.signed_distance(&start.position);
            let outwards = if distance < 0.0 { -1.0 } else { 1.0 };
            let normal = plane.normal().into_inner() * outwards;
            let foot = start.position - plane.normal().into_inner() * distance;
            let place = foot - normal * (radius(ball) - ball.radius());
            let up = vector(normal.into());
            return Ok(finish(
                ColliderBuilder::new(SharedShape::halfspace(up)).translation(vector(place.coords.into())),
                surface,
                mu,
            ));
        }
        Shape::Polygon(polygon) => {
            // With its inner edges fixed, a mesh has one side: that on which the ball starts.
            let turn = polygon.plane().signed_distance(&ball.start().position) < 0.0;
            let face = |[a, b, c]: [u32; 3]| if turn { [a, c, b] } else { [a, b, c] };
            let faces = polygon.triangulate().iter().map(|corners| face(corners.map(|i| i as u32))).collect();
            mesh(polygon.vertices(), faces)?
        }
        Shape::Mesh(the) => mesh(the.vertices(), the.faces().to_vec())?,
    };
    Ok(finish(ColliderBuilder::new(shape), surface, mu))
}

fn finish(collider: ColliderBuilder, surface: &Surface, mu: f64) -> Collider {
    collider
        .restitution(surface.material.restitution.coefficient() as f32)
        .restitution_combine_rule(CoefficientCombineRule::Max)
        .friction(mu as f32)
        .friction_combine_rule(CoefficientCombineRule::Max)
        .build()
}

fn mesh(vertices: &[nalgebra::Point3<f64>], faces: Vec<[u32; 3]>) -> Result<SharedShape> {
    let vertices = vertices.iter().map(|v| vector(v.coords.into())).collect();
    Ok(SharedShape::trimesh_with_flags(vertices, faces, TriMeshFlags::FIX_INTERNAL_EDGES)?)
}

fn vector(v: [f64; 3]) -> Vector {
    Vector::new(v[0] as f32, v[1] as f32, v[2] as f32)
}
