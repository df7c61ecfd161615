//! What happens to a ball, and how a run ends.

use crate::body::State;
use crate::counters::Counters;
use nalgebra::{Point3, Vector3};

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum EventKind {
    /// The ball hit a surface and was answered.
    Impact,
    /// Bouncing has ended, sliding begins; what friction took in the last hops, it took between `velocity_in` and `velocity`.
    Slide,
    /// Slipping has ended, rolling begins.
    Roll,
    /// The ball came to rest.
    Rest,
    /// Contact was lost.
    Leave,
    /// A resting ball began to move.
    Wake,
    /// The simulation of the ball was ended: its budget of events is used up.
    EventBudget,
    /// The simulation of the ball was ended: its contacts kept answering each other without time passing.
    UnresolvedContact,
    /// The simulation of the ball was ended: its next step has no finite numbers.
    Diverged,
    /// The simulation of the ball was ended: the fixed step is too long for the air resistance.
    UnstableStep,
    /// The simulation of the ball was ended: its budget of steps is used up.
    StepBudget,
}

/// One event of one ball at one surface. A simultaneous impact at several surfaces is one event for each, at one time and
/// with the same velocities.
///
/// ```
/// # use carom_dynamics::body::Ball;
/// # use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
/// # use carom_dynamics::geometry::plane::Plane;
/// # use carom_dynamics::nalgebra::{Point3, Vector3};
/// # use carom_dynamics::scene::Scene;
/// # use carom_dynamics::surface::{Material, Shape, Surface};
/// # let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
/// # let material = Material { restitution: Restitution::new(0.5)?, friction: Friction::None };
/// # let scene = Scene {
/// #     gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0))?),
/// #     surfaces: vec![Surface { name: "floor".into(), material, shape: Shape::Plane(floor) }],
/// #     balls: vec![Ball::new(Point3::new(0.0, 0.0, 4.0), Vector3::zeros(), 0.0, None)?],
/// #     ..Scene::lasting(3.0)
/// # };
/// use carom_dynamics::observer::Trajectory;
/// use carom_dynamics::plan::Plan;
/// use carom_dynamics::simulate::simulate;
///
/// let plan = Plan::new(&scene)?;
/// let mut run = Trajectory::default();
/// simulate(&plan, &plan.balls()[0], &mut run);
/// let first = &run.events[0];
/// assert_eq!(plan.balls().len(), 1);
/// assert_eq!((first.time, first.surface, first.face), (1.0, 0, None));
/// assert_eq!((first.velocity_in.z, first.velocity.z), (-8.0, 4.0));
/// // How far an exact computation could be from it.
/// assert!(first.bound.is_some_and(|bound| bound.time < 1e3 * f64::EPSILON));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When, in s from the start.
    pub time: f64,
    /// What happened.
    pub kind: EventKind,
    /// Index of the surface in the scene.
    pub surface: usize,
    /// The face of a mesh; none for planes and polygons.
    pub face: Option<u32>,
    /// The ball's centre, in m.
    pub position: Point3<f64>,
    /// Unit normal from the surface to the ball.
    pub normal: Vector3<f64>,
    /// Velocity just before, in m/s.
    pub velocity_in: Vector3<f64>,
    /// Velocity just after, in m/s.
    pub velocity: Vector3<f64>,
    /// How far `time` and `position` may be off, wherever they are those of a solution: of an impact, of a contact that ends at an edge, of sliding that
    /// friction ends on a straight line, of slipping that becomes rolling there, of hops that have come to their sum, and of what happens with one of
    /// them; and at the start.
    ///
    /// None of what was not solved for: a rest, a slide, a roll or a leave at the end of an integrated step, by which a threshold was passed or the
    /// surface no longer pressed; what a path closes in on where the ball does not; and what a guard ends.
    pub bound: Option<Bound>,
    /// Angular velocity just after, in rad/s, if the scene calls for it.
    pub spin: Option<Vector3<f64>>,
}

/// How far a computed event may be from the exact one of the path that led to it, with all its numbers from the start of that stretch taken as
/// exact: what rounding does in one flight or one stretch of sliding. What a method of integration does, and what rounding has done before, is not in
/// it; nor what the model does that sums up the last hops.
///
/// At a graze, where the clearance turns within its rounding, the exact path may miss what the computed one touches; the bound is then the time in
/// which the clearance changes by more than that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// In s, to either side.
    pub time: f64,
    /// In m, in any direction: the rounding of the position, and the way in `time`.
    pub position: f64,
}

/// How a ball moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Free of every surface, or between two bounces.
    Flying,
    /// In lasting contact, and moving.
    Sliding,
    /// In lasting contact, and moving so that the point of contact does not.
    Rolling,
    /// In lasting contact, and at rest.
    Resting,
}

/// How the simulation of a ball ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Ending {
    /// The scene's duration was reached.
    Completed,
    /// The ball used up its budget of events.
    EventBudget,
    /// Contacts kept answering each other without time passing.
    UnresolvedContact,
    /// The fixed step is too long for the air resistance: the method would make the ball faster where the air slows it.
    UnstableStep,
    /// The ball used up its budget of steps.
    StepBudget,
    /// The next step has no finite numbers: the timestep is too long for the forces, or the motion left the range
    /// whose squares are in f64. The state is the last finite one.
    Diverged,
}

/// A ball at the end of its simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub ending: Ending,
    /// When, in s.
    pub time: f64,
    /// Where, and how fast.
    pub state: State,
    /// Its angular velocity in rad/s, if the scene calls for it.
    pub spin: Option<Vector3<f64>>,
    /// How it moved at the end.
    pub motion: Motion,
    /// What the simulation evaluated.
    pub counters: Counters,
}
