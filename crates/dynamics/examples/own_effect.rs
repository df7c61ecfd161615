//! A flow effect of your own: the Coriolis force, which takes a ball that falls in a tower a little to the east.
//!
//! `cargo run -p carom-dynamics --example own_effect`

use carom_dynamics::body::{Ball, Body, State};
use carom_dynamics::counters::Counters;
use carom_dynamics::effects::{Flow, friction::Friction, gravity::Gravity, restitution::Restitution};
use carom_dynamics::geometry::plane::Plane;
use carom_dynamics::nalgebra::{Point3, Vector3};
use carom_dynamics::observer::Trajectory;
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Scene;
use carom_dynamics::simulate::simulate;
use carom_dynamics::surface::{Material, Shape, Surface};
use std::error::Error;
use std::sync::Arc;

/// The Coriolis acceleration -2 omega x v on a turning earth; x points east, y north, z up.
#[derive(Debug)]
struct Coriolis {
    /// The angular velocity of the earth, seen from here, in rad/s.
    omega: Vector3<f64>,
}

impl Flow for Coriolis {
    fn name(&self) -> &'static str {
        "the Coriolis force"
    }

    fn acceleration(&self, state: &State, _: &Body) -> Vector3<f64> {
        -2.0 * self.omega.cross(&state.velocity)
    }

    // It turns a motion and never slows it: no resistance.
    fn calms_to(&self) -> Option<Vector3<f64>> {
        None
    }

    // The counts that the library keeps are of its own effects.
    fn count(&self, _: &mut Counters) {}
}

fn main() -> Result<(), Box<dyn Error>> {
    let mud = Material { restitution: Restitution::new(0.0)?, friction: Friction::None };
    let ground = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
    let (height, g) = (158.0, 9.81);
    let scene = Scene {
        gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -g))?),
        surfaces: vec![Surface { name: "ground".into(), material: mud, shape: Shape::Plane(ground) }],
        balls: vec![Ball::new(Point3::new(0.0, 0.0, height), Vector3::zeros(), 0.0, None)?],
        ..Scene::lasting(10.0)
    };
    // A day has 86164 s by the stars; at 50 degrees north the axis leans by as much.
    let (day, latitude) = (86164.1, 50f64.to_radians());
    let omega = Vector3::new(0.0, latitude.cos(), latitude.sin()) * (std::f64::consts::TAU / day);
    let plan = Plan::new(&scene)?.with_flow(Arc::new(Coriolis { omega }));
    let mut run = Trajectory::default();
    simulate(&plan, &plan.balls()[0], &mut run);
    let landing = &run.events[0];
    // To first order in omega: g omega cos(latitude) t^3 / 3.
    let t = (2.0 * height / g).sqrt();
    let formula = g * omega.y * t * t * t / 3.0;
    println!(
        "it lands {:.3} mm east after {:.3} s; the formula says {:.3} mm",
        1e3 * landing.position.x,
        landing.time,
        1e3 * formula
    );
    assert!((landing.position.x / formula - 1.0).abs() < 1e-3);
    Ok(())
}
