//! A surface of your own: a bowl z = (x^2 + y^2) / 8 from its formula, as a mesh in which balls find the lowest place.
//!
//! `cargo run -p carom-dynamics --example own_surface`

use carom_dynamics::body::Ball;
use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
use carom_dynamics::events::Motion;
use carom_dynamics::geometry::mesh::Mesh;
use carom_dynamics::nalgebra::{Point3, Vector3};
use carom_dynamics::plan::Plan;
use carom_dynamics::run::run_balls;
use carom_dynamics::scene::Scene;
use carom_dynamics::surface::{Material, Shape, Surface};
use std::error::Error;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Squares along a side of the bowl.
const SQUARES: u32 = 40;

/// Half the side of the bowl, in m.
const HALF: f64 = 2.0;

/// The mesh of a height over the plane, two triangles for each square of a grid.
fn height_field(height: impl Fn(f64, f64) -> f64) -> Result<Mesh, Box<dyn Error>> {
    let place = |i: u32| HALF * (2.0 * f64::from(i) / f64::from(SQUARES) - 1.0);
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for j in 0..=SQUARES {
        for i in 0..=SQUARES {
            vertices.push(Point3::new(place(i), place(j), height(place(i), place(j))));
        }
    }
    for j in 0..SQUARES {
        for i in 0..SQUARES {
            let a = j * (SQUARES + 1) + i;
            let (b, c, d) = (a + 1, a + SQUARES + 2, a + SQUARES + 1);
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    Ok(Mesh::new(vertices, faces)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let wood = Material { restitution: Restitution::new(0.6)?, friction: Friction::coulomb(0.05)? };
    let bowl = height_field(|x, y| (x * x + y * y) / 8.0)?;
    let balls = (0..9).map(|i| {
        let start = Point3::new(0.4 * f64::from(i % 3) - 0.4, 0.5 * f64::from(i / 3) - 0.5, 1.5);
        Ball::new(start, Vector3::new(0.3, -0.2, 0.0), 0.05, None)
    });
    let scene = Scene {
        gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -9.81))?),
        surfaces: vec![Surface { name: "bowl".into(), material: wood, shape: Shape::Mesh(Arc::new(bowl)) }],
        balls: balls.collect::<Result<_, _>>()?,
        ..Scene::lasting(30.0)
    };
    let plan = Plan::new(&scene)?;
    // All cores, the same answer for any number of them; `()` watches nothing: only the outcomes are wanted.
    let mut resting = 0;
    run_balls(
        &plan,
        None,
        |_| (),
        |ball, (), outcome| {
            let end = outcome.state.position;
            println!(
                "ball {ball}: {:?} at ({:.3}, {:.3}, {:.3}) after {} impacts",
                outcome.motion, end.x, end.y, end.z, outcome.counters.impacts
            );
            // Friction holds a ball where the slope is below 0.05, which is within 0.2 m of the middle, give or take a square.
            assert!(end.x.hypot(end.y) < 0.4);
            resting += u32::from(outcome.motion == Motion::Resting);
            ControlFlow::Continue(())
        },
    )?;
    assert_eq!(resting, 9);
    Ok(())
}
