//! Where will it land? The next three bounces of a thrown ball, with time, place and speed, in closed form.
//!
//! `cargo run -p carom-dynamics --example next_bounces`

use carom_dynamics::body::Ball;
use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
use carom_dynamics::events::EventKind;
use carom_dynamics::geometry::plane::Plane;
use carom_dynamics::nalgebra::{Point3, Vector3};
use carom_dynamics::observer::Trajectory;
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Scene;
use carom_dynamics::simulate::simulate;
use carom_dynamics::surface::{Material, Shape, Surface};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // A tennis ball leaves the racket 1 m over the court at 30 m/s.
    let court = Material { restitution: Restitution::new(0.745)?, friction: Friction::coulomb(0.6)? };
    let ground = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
    let scene = Scene {
        gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -9.81))?),
        surfaces: vec![Surface { name: "court".into(), material: court, shape: Shape::Plane(ground) }],
        balls: vec![Ball::new(Point3::new(0.0, 0.0, 1.0), Vector3::new(29.5, 1.0, 5.0), 0.0335, Some(0.058))?],
        ..Scene::lasting(10.0)
    };
    let plan = Plan::new(&scene)?;
    let mut run = Trajectory::default();
    simulate(&plan, &plan.balls()[0], &mut run);
    let bounces: Vec<_> = run.events.iter().filter(|event| event.kind == EventKind::Impact).take(3).collect();
    for bounce in &bounces {
        let (t, x) = (bounce.time, bounce.position);
        println!(
            "at {t:.4} s, {:.3} m down the court, {:.3} m to the left, {:.2} m/s",
            x.x,
            x.y,
            bounce.velocity.norm()
        );
    }
    // The first one from the formula: z0 + v t - g t^2 / 2 = r.
    let t = (5.0 + (25.0_f64 + 2.0 * 9.81 * (1.0 - 0.0335)).sqrt()) / 9.81;
    assert!((bounces[0].time - t).abs() < 4.0 * f64::EPSILON);
    // Between the events every moment is known: here the top of the hop after the first bounce.
    let top = 0.5 * (bounces[0].time + bounces[1].time);
    let (state, _) = run.at(top).ok_or("the ball is still flying")?;
    println!("between the first two it rises to {:.3} m, at {top:.4} s", state.position.z);
    assert!(state.velocity.z.abs() < 1e-12);
    Ok(())
}
