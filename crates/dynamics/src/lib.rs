//! Bouncing-ball dynamics: flights, the earliest collision, the response, sliding and rest.
//!
//! Data flows one way: [`Scene`](scene::Scene) (what is wanted) to [`Plan`](plan::Plan) (what will be evaluated) to
//! events, frames and counters. The crate reads no files and prints nothing.
//!
//! ```
//! use carom_dynamics::body::Ball;
//! use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
//! use carom_dynamics::observer::Trajectory;
//! use carom_dynamics::plan::Plan;
//! use carom_dynamics::scene::Scene;
//! use carom_dynamics::simulate::simulate;
//! use carom_dynamics::surface::{Material, Shape, Surface};
//! use carom_geometry::plane::Plane;
//! use nalgebra::{Point3, Vector3};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let clay = Material { restitution: Restitution::new(0.5)?, friction: Friction::None };
//! let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
//! let scene = Scene {
//!     gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0))?),
//!     surfaces: vec![Surface { name: "floor".into(), material: clay, shape: Shape::Plane(floor) }],
//!     balls: vec![Ball::new(Point3::new(0.0, 0.0, 4.5), Vector3::zeros(), 0.5, None)?],
//!     ..Scene::lasting(3.0)
//! };
//! let plan = Plan::new(&scene)?;
//! let mut run = Trajectory::default();
//! simulate(&plan, &plan.balls()[0], &mut run);
//! // It falls 4 m in 1 s, lands at 8 m/s, and at half of that is up for another second.
//! assert_eq!((run.events[0].time, run.events[0].velocity.z), (1.0, 4.0));
//! assert_eq!((run.events[1].time, run.events[1].velocity.z), (2.0, 2.0));
//! # Ok(())
//! # }
//! ```

/// The geometry that surfaces are made of, in the version that every signature uses.
pub use carom_geometry as geometry;
/// The crate of vectors and points that every signature uses, in the version it uses.
pub use nalgebra;

// In dependency order: a module imports only from those above it.
pub mod error;
pub mod tolerance;
pub mod power;
pub mod counters;
pub mod body;
pub mod effects;
pub mod forces;
pub mod surface;
pub mod scene;
pub mod integrators;
pub mod plan;
pub mod contacts;
pub mod clock;
pub mod events;
pub mod energy;
pub mod collision;
pub mod support;
pub mod response;
pub mod sliding;
pub mod observer;
pub mod simulate;
pub mod run;
