//! Bouncing-ball dynamics: flights, the earliest collision, the response, sliding and rest.
//!
//! Data flows one way: a [`Scene`](scene::Scene) (what is wanted) becomes a [`Plan`](plan::Plan) (what will be evaluated), and
//! [`simulate`](simulate::simulate) shows one ball of it to an [`Observer`](observer::Observer): events, and the stretches of motion between
//! them. [`run_balls`](run::run_balls) does so with many balls on all cores. The crate reads no files and prints nothing.
//!
//! # The model
//!
//! An impact takes no time. Surfaces stand still, and balls do not meet each other. Gravity is uniform; [effects] on the flight
//! and at the contact are off unless the scene asks for them, and then cost nothing. Contact is a clearance that has run out *and* is
//! closing; what bounces ever lower slides or rests in the end, on one surface, in a groove or in a corner.
//!
//! Units are SI: m, s, kg, rad. Vectors are in the axes of the scene, of which none is special; down is where gravity points.
//!
//! # What it promises
//!
//! - A ball never passes through a surface: contacts are certified by [`carom_geometry`], and one in doubt is a contact.
//! - Flights under constant acceleration are exact, for steps of any length: parabolas whose impacts are known to the rounding of the
//!   numbers. Flights in air are as exact as the method's tolerance, on paths of degree 4 that collide as exactly.
//! - The same scene gives the same bits on every machine, for any number of threads and any order of the surfaces.
//! - Every run says [how it ended](events::Ending): by its duration, or by a named guard. Nothing panics on numbers, nothing loops for ever.
//! - The few thresholds of the model stand on [one page](tolerance), with their meaning and their unit.
//!
//! # A first example
//!
//! ```
//! use carom_dynamics::body::Ball;
//! use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
//! use carom_dynamics::geometry::plane::Plane;
//! use carom_dynamics::nalgebra::{Point3, Vector3};
//! use carom_dynamics::observer::Trajectory;
//! use carom_dynamics::plan::Plan;
//! use carom_dynamics::scene::Scene;
//! use carom_dynamics::simulate::simulate;
//! use carom_dynamics::surface::{Material, Shape, Surface};
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
//!
//! # Where to go on
//!
//! - The next bounces of a ball in closed form: example `next_bounces`.
//! - A ball in a game's loop, whose frames are as long as they happen to be: example `game_loop`.
//! - An effect of your own: [`Flow`](effects::Flow) and [`Plan::with_flow`](plan::Plan::with_flow); example `own_effect`.
//! - A surface of your own: any triangle mesh; example `own_surface`.
//! - Scenes in files, a page that plays them, charts: the program `carom`.

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
mod room;
pub mod plan;
pub mod contacts;
pub mod clock;
pub mod events;
pub mod energy;
pub mod collision;
pub mod support;
pub mod response;
pub mod sliding;
pub mod turning;
pub mod observer;
pub mod simulate;
pub mod run;
pub mod explain;
pub mod accuracy;
