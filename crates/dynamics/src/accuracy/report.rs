//! What a measurement of accuracy gives: methods, errors, work, time; the order of each, the front of all, the cheapest for a tolerance.

use super::compare::{Ends, Errors, EulerLaws, Shares};
use super::course::Reach;
use super::fit::Order;
use super::resolution::Original;
use super::variant::{Approach, Variant};
use crate::counters::Counters;
use crate::scene::Method;
use std::fmt;

/// What the methods are compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReferenceKind {
    /// Parabolas from bounce to bounce on planes, in closed form, evaluated in 128 bits.
    ClosedForm,
    /// The same physics in 128 bits: Taylor series, and every surface on its own.
    Extended,
}

impl fmt::Display for ReferenceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ClosedForm => f.write_str("the closed form, in 128 bits"),
            Self::Extended => f.write_str("a solver of its own in 128 bits: Taylor series, every surface by itself"),
        }
    }
}

/// Time by the clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// ns for a second of one ball.
    pub per_second: f64,
    /// ns for an impact, if there are any.
    pub per_impact: Option<f64>,
}

/// One method with one step or tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// Which method.
    pub variant: Variant,
    /// Its step in s or its tolerance; 0 for the exact flight.
    pub value: f64,
    /// The effective length of its steps in s: held fixed, it would give a method of order 5 the same error.
    pub step: f64,
    /// The same in the first flights.
    pub flight_step: f64,
    /// Its errors.
    pub errors: Errors,
    /// The parts of the error of the positions.
    pub shares: Shares,
    /// Euler's laws, where they apply.
    pub laws: Option<EulerLaws>,
    /// Where the balls are at the end.
    pub ends: Ends,
    /// What was evaluated; the same on every machine.
    pub counters: Counters,
    /// The counts as one number, for comparing: nominal ns for a second of one ball.
    pub work: f64,
    /// By the clock, if it was looked at.
    pub cost: Option<Cost>,
}

impl Measurement {
    /// The method as a scene asks for it; none for the variants of the slides.
    pub fn method(&self) -> Option<Method> {
        match self.variant.with(self.value) {
            Approach::Method(method) => Some(method),
            Approach::Textbook(_) => None,
        }
    }
}

/// A method over its sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// The method.
    pub variant: Variant,
    /// From coarse to fine.
    pub measurements: Vec<Measurement>,
    /// The order of the error before the first impact.
    pub flight_order: Order,
    /// The order of the error over all.
    pub order: Order,
}

/// The scene on finer meshes of the same surfaces, beside the finest: the share of the discretisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Faces of all meshes.
    pub faces: usize,
    /// Distance of the positions from those on the finest meshes before the first impacts on those are over by a sample, in m.
    pub first_bounce: f64,
    /// The same over all that is compared, in m.
    pub position: f64,
    /// Difference of the times of the first impact, in s; none if one has none.
    pub first_impact: Option<f64>,
}

/// What a user should know before reading the numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum Remark {
    /// Only the first balls were followed.
    SomeBalls {
        /// How many.
        followed: usize,
        /// Of how many.
        of: usize,
    },
    /// No ball hits anything: nothing of the determination is measured, and no order is fitted.
    NoImpacts,
    /// Nothing can be compared: no sample lies before the time up to which the reference can be compared.
    NothingToCompare,
    /// Small differences have grown a thousandfold: positions are compared up to there, and no order is fitted if that is before the first
    /// bounces.
    Chaotic {
        /// The ball.
        ball: usize,
        /// Since when, in s.
        from: f64,
    },
    /// The reference ends before the scene does.
    ReferenceEnds {
        /// The ball.
        ball: usize,
        /// When, in s.
        at: f64,
        /// Why.
        reach: Reach,
    },
    /// The exact flight is not offered, because something other than gravity acts.
    NoExactFlight,
    /// The ways of the slides are not offered, because a surface grips and they know no spin.
    NoTextbook,
    /// What a mesh is taken to be cut from.
    Discretised {
        /// The surface, by its index in the scene.
        surface: usize,
        /// What it is taken for.
        original: Original,
    },
    /// A method whose flights are exact under gravity alone.
    ExactFlights(Variant),
    /// A bounce lowers the order.
    LoweredByBounces {
        /// Of which method.
        variant: Variant,
        /// In flight.
        flight: Order,
        /// Over all.
        order: f64,
    },
    /// The order of a method that chooses its steps, over their mean, is not quite that of its formula.
    OwnSteps {
        /// Of which method.
        variant: Variant,
        /// In flight.
        order: f64,
    },
    /// Runs in which a ball went through a surface or left the scene's impacts behind.
    Through {
        /// Of which method.
        variant: Variant,
        /// In how many of its runs.
        runs: usize,
    },
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SomeBalls { followed, of } => write!(f, "the first {followed} of {of} balls are measured"),
            Self::NoImpacts => f.write_str(
                "no ball hits anything: this says nothing of collisions, the errors are those of the flights, and no order is fitted",
            ),
            Self::NothingToCompare => f.write_str("there is nothing to compare: no error is given, and no order is fitted"),
            Self::Chaotic { ball, from } => write!(
                f,
                "ball {ball}: from {from:.4} s on small differences have grown more than a thousandfold; positions are compared up to there, and \
                 energy, impacts and places at the end stand for the rest"
            ),
            Self::ReferenceEnds { ball, at, reach } => {
                let why = match reach {
                    Reach::Complete => "at the end of the scene",
                    Reach::Sliding => "the ball slides or rolls where that has no closed form",
                    Reach::Simultaneous => "the ball touches several surfaces at once",
                    Reach::Undecided => "a touch cannot be told from a miss",
                    Reach::Budget => "the ball bounces more often than is followed",
                };
                write!(f, "ball {ball}: the reference ends at {at:.4} s: {why}; so does the comparison")
            }
            Self::Discretised { surface, original } => match original {
                Original::Sphere { radius, .. } => {
                    write!(f, "surface {surface}: its vertices lie on a sphere of radius {radius:.4} m; refined, they stay on it")
                }
                Original::Smooth => write!(
                    f,
                    "surface {surface}: refined as the smooth surface through its vertices and their normals (point-normal triangles); \
                     if it was never smooth, the numbers of the discretisation mean nothing"
                ),
                Original::Itself => write!(f, "surface {surface}: a mesh with sharp edges, taken for what it is: no discretisation"),
            },
            Self::NoTextbook => f.write_str("the ways of the slides are not offered: a surface grips, and they know no spin"),
            Self::NoExactFlight => f.write_str("`exact` is not offered: something other than uniform gravity acts"),
            Self::ExactFlights(variant) => write!(
                f,
                "{}: a parabola has no error of integration, at any step; no order can be fitted to rounding",
                variant.name()
            ),
            Self::LoweredByBounces { variant, flight, order } => {
                let flight = match flight {
                    Order::Fitted(order) => format!("order {order:.2} in flight"),
                    _ => "no error but rounding in flight".to_owned(),
                };
                let why = match variant {
                    Variant::Rk4LinearF => "f = d0 / (d0 - d1) is off by O(h^2) on a curved path, whatever the flight is worth",
                    Variant::Adaptive => "the step after a bounce begins anew, with the length that was right before it",
                    Variant::Slides | Variant::SlidesOwnF => "a rounded hit position may lie behind the plane, and edges are not met",
                    Variant::Euler | Variant::SemiImplicitEuler => {
                        "the errors of several flights and impacts add up, and none of them is in its limit yet"
                    }
                    _ => "hops that are too short for the step end at once, which is off by O(h^2)",
                };
                write!(f, "{}: {flight}, order {order:.2} with its bounces: {why}", variant.name())
            }
            Self::OwnSteps { variant, order } => write!(
                f,
                "{}: order {order:.2} in flight is over the mean of steps that it chooses, which jump by halves and doubles; \
                 {} is the same formula with steps that are given",
                variant.name(),
                Variant::DormandPrince.name()
            ),
            Self::Through { variant, runs } => {
                write!(f, "{}: in {runs} of its runs a ball passes through a surface", variant.name())
            }
        }
    }
}

/// The measurement of a scene.
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
/// use carom_dynamics::accuracy::{Effort, measure};
///
/// // No timed runs: cost is counted as work.
/// let effort = Effort { octaves: 2, decades: 2, repeats: 0, resolutions: false, ..Effort::default() };
/// let report = measure(&scene, &effort, &mut || 0.0)?;
/// let cheapest = report.cheapest(1e-3).ok_or("some method is right to a millimetre")?;
/// assert_eq!(cheapest.variant.name(), "exact");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// What the methods are compared with.
    pub reference: ReferenceKind,
    /// What rounding makes of the reference itself, at worst, in m.
    pub reference_error: f64,
    /// Balls measured.
    pub balls: usize,
    /// Up to when positions are compared, in s, for the first ball that ends the comparison.
    pub until: f64,
    /// How many times a small difference grows up to there, at worst.
    pub growth: f64,
    /// Impacts of the reference up to there, of all balls.
    pub impacts: usize,
    /// Where the balls are at the end by the reference, if it gets there with all of them.
    pub ends: Option<Ends>,
    /// The methods.
    pub sweeps: Vec<Sweep>,
    /// The surfaces at several resolutions, from the given one on; empty if nothing in the scene is a mesh of something smooth.
    pub resolutions: Vec<Resolution>,
    /// What else there is to know.
    pub remarks: Vec<Remark>,
}

impl Report {
    /// All measurements.
    pub fn measurements(&self) -> impl Iterator<Item = &Measurement> {
        self.sweeps.iter().flat_map(|sweep| &sweep.measurements)
    }

    /// The measurements that no other beats in both error and work, from cheap to dear; the cheapest first.
    pub fn front(&self) -> Vec<&Measurement> {
        let mut all: Vec<&Measurement> = self.measurements().filter(|m| m.errors.position.is_finite()).collect();
        let error = |m: &Measurement| m.errors.position;
        all.sort_by(|a, b| a.work.total_cmp(&b.work).then(error(a).total_cmp(&error(b))));
        let mut front: Vec<&Measurement> = Vec::new();
        for m in all {
            if front.last().is_none_or(|best| error(m) < error(best)) {
                front.push(m);
            }
        }
        front
    }

    /// The cheapest measurement of a method that a scene can ask for whose positions are right to `tolerance` (m); none if none is. Cheap is
    /// what takes little work by its counts, so that the answer is the same on every machine.
    pub fn cheapest(&self, tolerance: f64) -> Option<&Measurement> {
        let good = self.measurements().filter(|m| m.method().is_some() && m.errors.position <= tolerance);
        good.min_by(|a, b| a.work.total_cmp(&b.work))
    }
}

/// What the counts of a run amount to, in nominal ns.
///
/// The weights are rounded times of one evaluation, fitted by eye to runs on a processor of 2023; they rank runs, and the clock says what these
/// cost.
pub fn work(counters: &Counters) -> f64 {
    let weights = [
        (counters.paths, 60.0),
        (counters.clearances, 40.0),
        (counters.nodes, 30.0),
        (counters.triangles, 30.0),
        (counters.rounds, 100.0),
        (counters.accelerations, 50.0),
        (counters.drag, 10.0),
        (counters.magnus, 10.0),
        (counters.impacts, 150.0),
        (counters.rest, 20.0),
    ];
    weights.iter().map(|(count, weight)| *count as f64 * weight).sum()
}
