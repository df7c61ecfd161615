//! Which effects a scene has, what each changes, and what it costs: predicted, and measured by running the scene with and without it.
//!
//! ```
//! use carom_dynamics::body::Ball;
//! use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
//! use carom_dynamics::explain::{Quantity, effect::Effect, explain};
//! use carom_dynamics::geometry::plane::Plane;
//! use carom_dynamics::nalgebra::{Point3, Vector3};
//! use carom_dynamics::scene::Scene;
//! use carom_dynamics::surface::{Material, Shape, Surface};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A tennis ball falls 2.54 m onto concrete. Does the air matter?
//! let concrete = Material { restitution: Restitution::new(0.75)?, friction: Friction::None };
//! let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
//! let ball = Ball::new(Point3::new(0.0, 0.0, 2.5735), Vector3::zeros(), 0.0335, Some(0.0577))?.with_drag(0.55)?;
//! let scene = Scene {
//!     gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -9.81))?),
//!     surfaces: vec![Surface { name: "floor".into(), material: concrete, shape: Shape::Plane(floor) }],
//!     balls: vec![ball],
//!     ..Scene::lasting(3.0)
//! };
//! let explanation = explain(&scene)?;
//! let drag = explanation.entry(Effect::Drag).finding.as_ref().expect("it can be told");
//! let speed = drag.size(Quantity::ImpactSpeed).expect("it lands");
//! // It would land 2.5 % slower, as -H / 2l says.
//! assert!((speed.measured + 0.025).abs() < 0.001 && (speed.predicted + 0.025).abs() < 0.001);
//! # Ok(())
//! # }
//! ```

pub mod choice;
mod compare;
pub mod effect;
mod flight;
mod prediction;

use crate::counters::Counters;
use crate::error::SceneError;
use crate::plan::Plan;
use crate::scene::Scene;
use effect::Effect;
use flight::Flight;

/// Balls that are looked at, spread evenly over those of the scene: what is true of all is seen on a few.
const BALLS: usize = 8;

/// What a scene is explained by.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// The balls that were looked at, by their numbers in the scene.
    pub balls: Vec<usize>,
    /// Each effect, in the order of [`Effect::ALL`].
    pub entries: Vec<Entry>,
    /// How often a ball was simulated for it.
    pub runs: usize,
    /// What all these runs evaluated.
    pub work: Counters,
}

/// An effect and what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The effect.
    pub effect: Effect,
    /// Whether the scene has it.
    pub on: bool,
    /// What was taken to be so where the scene does not say; empty if it says all.
    pub assumed: &'static str,
    /// What it changes, or would change; if that cannot be told, or nothing is changed, why.
    pub finding: Result<Finding, &'static str>,
}

/// What an effect changes, with it against without it, on the ball where that is most.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The number of the ball.
    pub ball: usize,
    /// The length in m of the flight on which it is measured.
    pub way: f64,
    /// The dimensionless number that the prediction turns on, with its name.
    pub number: Option<(&'static str, f64)>,
    /// The changes; the first is the one to name.
    pub sizes: Vec<Size>,
    /// Half of the balls that were looked at end at least this far, in m, from where they would.
    pub end_shift: f64,
    /// What the effect costs.
    pub cost: Cost,
}

/// A change by an effect, predicted and measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// What changes.
    pub quantity: Quantity,
    /// By how much, by formula.
    pub predicted: f64,
    /// By how much, by two runs.
    pub measured: f64,
    /// Why the two are more than 15 % apart, if they are.
    pub apart: Option<&'static str>,
}

/// What an effect changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// The time until the first impact, as a share of it.
    FlightTime,
    /// The speed at the first impact, as a share of it.
    ImpactSpeed,
    /// The place of the first impact, in m.
    Landing,
    /// The place of the ball when the shorter flight ends, in m.
    Place,
    /// The speed along the surface after the first impact, as a share of that before it.
    TangentialSpeed,
    /// The speed away from the surface after the first impact, as a share of it.
    ReboundSpeed,
    /// The speed of a rolling ball when the shorter rolling ends, as a share of that at its start.
    RollingSpeed,
    /// The number of impacts until the end.
    Impacts,
}

/// What an effect costs in a second of simulated time, by counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Evaluations of the acceleration, more with it than without.
    pub accelerations: f64,
    /// Paths, more with it than without.
    pub paths: f64,
    /// Evaluations of contacts: restitution, friction, and the rest test.
    pub contacts: f64,
}

impl Size {
    /// The measured change as a share: lengths of the way that was flown; none for a count.
    pub fn share(&self, way: f64) -> f64 {
        match self.quantity {
            Quantity::Landing | Quantity::Place => self.measured.abs() / way,
            Quantity::Impacts => 0.0,
            _ => self.measured.abs(),
        }
    }
}

impl Finding {
    /// The largest of the changes, as a share.
    pub fn share(&self) -> f64 {
        self.sizes.iter().map(|size| size.share(self.way)).fold(0.0, f64::max)
    }

    /// The change of one quantity, if it is among them.
    pub fn size(&self, quantity: Quantity) -> Option<&Size> {
        self.sizes.iter().find(|size| size.quantity == quantity)
    }
}

impl Explanation {
    /// What is known of one effect.
    pub fn entry(&self, effect: Effect) -> &Entry {
        // All effects are there, in their order.
        &self.entries[Effect::ALL.iter().position(|e| *e == effect).unwrap_or(0)]
    }

    /// The effects that are off and, by what the scene says of its balls, would change something by more than the share `tolerance`, the
    /// largest first.
    pub fn called_for(&self, tolerance: f64) -> Vec<&Entry> {
        self.off(tolerance, false)
    }

    /// The same of the effects whose strength nothing tells: if they are as strong as was guessed.
    pub fn possible(&self, tolerance: f64) -> Vec<&Entry> {
        self.off(tolerance, true)
    }

    fn off(&self, tolerance: f64, guessed: bool) -> Vec<&Entry> {
        let share = |entry: &Entry| entry.finding.as_ref().map_or(0.0, Finding::share);
        let of_kind = self.entries.iter().filter(|e| !e.on && e.effect.is_guessed() == guessed);
        let mut called: Vec<&Entry> = of_kind.filter(|e| share(e) > tolerance).collect();
        called.sort_by(|a, b| share(b).total_cmp(&share(a)));
        called
    }
}

/// A scene with the runs of those of its balls that are looked at.
pub(crate) struct Runs {
    scene: Scene,
    plan: Plan,
    /// Each ball's first flight, and what became of it.
    flights: Vec<Flight>,
}

impl Runs {
    /// Runs `balls` of `scene`.
    fn of(scene: Scene, balls: &[usize]) -> Result<Self, SceneError> {
        let plan = Plan::new(&scene)?;
        let flights = balls.iter().filter_map(|&ball| Flight::of(&plan, ball)).collect();
        Ok(Self { scene, plan, flights })
    }

    /// What the runs evaluated, and the time in s that they simulated.
    fn work(&self) -> (Counters, f64) {
        self.flights.iter().fold((Counters::default(), 0.0), |(mut sum, seconds), flight| {
            sum += flight.outcome.counters;
            (sum, seconds + flight.outcome.time)
        })
    }
}

/// The balls to look at, of so many.
fn spread(count: usize) -> Vec<usize> {
    if count <= BALLS { (0..count).collect() } else { (0..BALLS).map(|i| i * count / BALLS).collect() }
}

/// Explains `scene`.
pub fn explain(scene: &Scene) -> Result<Explanation, SceneError> {
    let balls = spread(scene.balls.len());
    let here = Runs::of(scene.clone(), &balls)?;
    let mut explanation = Explanation { balls, entries: Vec::new(), runs: here.flights.len(), work: here.work().0 };
    for effect in Effect::ALL {
        let entry = explain_one(effect, &here, &mut explanation);
        explanation.entries.push(entry);
    }
    Ok(explanation)
}

fn explain_one(effect: Effect, here: &Runs, explanation: &mut Explanation) -> Entry {
    let on = effect.is_on(&here.scene);
    let entry = |assumed, finding| Entry { effect, on, assumed, finding };
    let (other, assumed) = match effect.switched(&here.scene) {
        Ok(switched) => switched,
        Err(why) => return entry("", Err(why)),
    };
    let Ok(other) = Runs::of(other, &explanation.balls) else {
        return entry(assumed, Err("the scene with it, or without it, is refused"));
    };
    explanation.runs += other.flights.len();
    explanation.work += other.work().0;
    let (without, with) = if on { (&other, here) } else { (here, &other) };
    entry(assumed, compare::find(effect, without, with, &explanation.balls))
}
