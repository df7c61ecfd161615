//! What will be evaluated: decided once, before the loop, from the scene.

use crate::body::{Ball, Body, State};
use crate::effects::Flow;
use crate::effects::buoyancy::Buoyancy;
use crate::effects::gravity::Gravity;
use crate::effects::spin_decay::SpinDecay;
use crate::error::{SceneError, ValueError, require};
use crate::forces::Forces;
use crate::integrators::adaptive::Adaptive;
use crate::integrators::damped::Damped;
use crate::integrators::{Integrator, Stepping};
use crate::room::check_room;
use crate::scene::{Method, Scene};
use crate::surface::{Material, Shape};
use crate::tolerance::{
    FLIGHT_TOLERANCE, LARGEST, LEAST_TOLERANCE, RestThresholds, SMALLEST, STEP_BUDGET, TOLERANCE_RANGE,
    default_rest_length,
};
use carom_geometry::bounds::Aabb;
use carom_geometry::mesh::Mesh;
use carom_geometry::plane::Plane;
use carom_geometry::rounding::{UNIT_ROUNDOFF, point_radius};
use nalgebra::{Point3, Vector3};
use std::borrow::Cow;
use std::sync::Arc;

/// A scene made ready: what is off is not in it.
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
/// use carom_dynamics::error::SceneError;
/// use carom_dynamics::plan::Plan;
/// use carom_dynamics::scene::Method;
///
/// // `scene` has gravity and a floor, and says nothing of the method.
/// let plan = Plan::new(&scene)?;
/// assert_eq!(plan.method(), Method::Exact);
/// // Everything that a scene can get wrong is found here.
/// let empty = Scene { balls: vec![], ..scene };
/// assert!(matches!(Plan::new(&empty), Err(SceneError::NoBalls)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Plan {
    pub(crate) duration: f64,
    gravity: Option<Gravity>,
    buoyancy: Option<Buoyancy>,
    /// What acts on every ball, and what acts on those that spin as well.
    flows: Vec<Arc<dyn Flow>>,
    spinning_flows: Vec<Arc<dyn Flow>>,
    spin_decay: Option<SpinDecay>,
    /// Whether a surface turns the balls.
    grips: bool,
    pub(crate) planes: Vec<(usize, Plane)>,
    pub(crate) meshes: Vec<(usize, Arc<Mesh>)>,
    pub(crate) surfaces: Vec<PlannedSurface>,
    /// Whether a surface asks each ball for its restitution.
    restitution_of_ball: bool,
    pub(crate) balls: Vec<Ball>,
    pub(crate) rest: RestThresholds,
    pub(crate) method: Method,
    pub(crate) point_radius: f64,
    /// The largest |coordinate| of the scene, in m.
    pub(crate) farthest: f64,
}

/// What the loop needs to know of a surface whatever its shape.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlannedSurface {
    pub material: Material,
    /// Place in the order of the names: ties are broken by it, not by the order of the scene.
    pub rank: usize,
    /// Whether its faces are numbered for the user: not for a polygon, which is one.
    pub numbered: bool,
}

impl Plan {
    /// Checks `scene` and decides what to evaluate.
    ///
    /// The method is the scene's; if it names none, the exact flight where the acceleration is constant, else the adaptive pair.
    pub fn new(scene: &Scene) -> Result<Self, SceneError> {
        let duration = scene.duration;
        require("duration", duration, "finite and > 0, in s", duration.is_finite() && duration > 0.0)?;
        if scene.balls.is_empty() {
            return Err(SceneError::NoBalls);
        }
        let grips = scene.grips();
        if grips && let Some(ball) = scene.balls.iter().position(|ball| ball.radius() == 0.0) {
            return Err(SceneError::RadiusMissing { ball, effect: "grip" });
        }
        let spins = scene.spins();
        let mut flows: Vec<Arc<dyn Flow>> = Vec::new();
        if let Some(drag) = scene.drag.filter(|drag| !drag.is_none()) {
            flows.push(Arc::new(drag));
        }
        let mut spinning_flows = flows.clone();
        if let Some(magnus) = scene.magnus.filter(|magnus| !magnus.is_none() && spins) {
            spinning_flows.push(Arc::new(magnus));
        }
        let buoyancy = scene.buoyancy.filter(|buoyancy| !buoyancy.is_none());
        let needs_mass = scene.drag.map(|_| "drag").or(scene.magnus.map(|_| "the Magnus force"));
        if let Some(effect) = needs_mass.or(scene.buoyancy.map(|_| "buoyancy"))
            && let Some(ball) = scene.balls.iter().position(|b| b.mass().is_none())
        {
            return Err(SceneError::MassMissing { ball, effect });
        }
        let drag_of_ball = scene.drag.is_some_and(|drag| drag.is_of_ball());
        let restitution_of_ball = scene.surfaces.iter().any(|s| s.material.restitution.is_of_ball());
        for (ball, b) in scene.balls.iter().enumerate() {
            if drag_of_ball && b.drag().is_none() {
                return Err(SceneError::OwnMissing { ball, what: "drag coefficient", effect: "the drag law" });
            }
            if restitution_of_ball && b.restitution().is_none() {
                return Err(SceneError::OwnMissing { ball, what: "restitution", effect: "a material" });
            }
        }
        let method = method(scene, &spinning_flows)?;
        let (planes, meshes) = shapes(scene);
        let size = Size::of(scene, &planes, &meshes);
        check_range(scene, &size, !meshes.is_empty())?;
        let least = 16.0 * UNIT_ROUNDOFF * size.farthest;
        for (ball, b) in scene.balls.iter().enumerate() {
            if b.radius() > 0.0 && b.radius() < least {
                let (radius, distance) = (b.radius(), size.farthest);
                return Err(SceneError::RadiusBelowResolution { ball, radius, least, distance });
            }
        }
        check_room(scene, &planes, size.farthest)?;
        let mut by_name: Vec<usize> = (0..scene.surfaces.len()).collect();
        by_name.sort_by(|&a, &b| scene.surfaces[a].name.cmp(&scene.surfaces[b].name));
        let mut rank = vec![0; by_name.len()];
        by_name.iter().enumerate().for_each(|(place, &surface)| rank[surface] = place);
        let surfaces = scene.surfaces.iter().zip(rank).map(|(surface, rank)| PlannedSurface {
            material: surface.material,
            rank,
            numbered: matches!(surface.shape, Shape::Mesh(_)),
        });
        Ok(Self {
            duration,
            gravity: scene.gravity,
            buoyancy,
            flows,
            spinning_flows,
            spin_decay: scene.spin_decay.filter(|_| spins),
            grips,
            planes,
            meshes,
            surfaces: surfaces.collect(),
            restitution_of_ball,
            balls: scene.balls.clone(),
            rest: scene.rest.unwrap_or(RestThresholds::Length(default_rest_length(size.extent, size.farthest))),
            method,
            point_radius: point_radius(size.farthest),
            farthest: size.farthest,
        })
    }

    /// The same plan with a flow effect of your own, which acts on every ball in flight beside those of the scene.
    ///
    /// A plan that was exact is computed by the adaptive pair from here on: no closed form knows the effect.
    pub fn with_flow(mut self, flow: Arc<dyn Flow>) -> Self {
        self.flows.push(Arc::clone(&flow));
        self.spinning_flows.push(flow);
        if self.method == Method::Exact {
            self.method = Method::Adaptive { tolerance: FLIGHT_TOLERANCE };
        }
        self
    }

    /// The balls, in the order of the scene.
    pub fn balls(&self) -> &[Ball] {
        &self.balls
    }

    /// For how long it simulates, in s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The radius in m with which `ball` meets polygons and meshes: its own, or, for a point and for what is not much larger than the rounding of its
    /// position, [the one that stands for a point](point_radius). A point stays that far from them; planes it meets as what it is.
    pub fn radius_at_meshes(&self, ball: &Ball) -> f64 {
        ball.radius().max(self.point_radius)
    }

    /// How many balls meet polygons or meshes with [a radius](Self::radius_at_meshes) that is not their own, and which; none if all are what they are.
    pub fn points_at_meshes(&self) -> Option<(usize, f64)> {
        let points = self.balls.iter().filter(|ball| ball.radius() < self.point_radius).count();
        (points > 0 && !self.meshes.is_empty()).then_some((points, self.point_radius))
    }

    /// The method that flights are computed with.
    pub fn method(&self) -> Method {
        self.method
    }

    /// The thresholds of the rest test.
    pub fn rest(&self) -> RestThresholds {
        self.rest
    }

    /// The constant part of the acceleration of `ball`, in m/s^2.
    pub fn constant_acceleration(&self, ball: &Ball) -> Vector3<f64> {
        let g = self.gravity.map_or(Vector3::zeros(), |g| g.acceleration());
        match (self.buoyancy, ball.mass()) {
            (Some(buoyancy), Some(mass)) => buoyancy.weight(&g, ball, mass),
            _ => g,
        }
    }

    /// The box of all bounded surfaces; none if there are none, or if an infinite plane is among them.
    pub fn bounds(&self) -> Option<Aabb> {
        if !self.planes.is_empty() || self.meshes.is_empty() {
            return None;
        }
        Some(self.meshes.iter().fold(Aabb::empty(), |sum, (_, mesh)| sum.union(mesh.bounds())))
    }

    /// Whether the spin of `ball` is followed: it has some, or a surface may give it some.
    pub fn spins(&self, ball: &Ball) -> bool {
        self.grips || ball.spin() != Vector3::zeros()
    }

    pub(crate) fn forces<'a>(&'a self, ball: &'a Ball) -> Forces<'a> {
        // Without a mass nothing asks for it: the plan has seen to that.
        let mass = ball.mass().unwrap_or(f64::INFINITY);
        let inertia = self.buoyancy.map_or(mass, |buoyancy| buoyancy.inertia(ball, mass));
        let spins = self.spins(ball);
        Forces {
            constant: self.constant_acceleration(ball),
            flows: if spins { &self.spinning_flows } else { &self.flows },
            ball,
            body: Body { radius: ball.radius(), inertia, drag: ball.drag().unwrap_or(0.0), spin: ball.spin() },
            decay: self.spin_decay.filter(|_| spins),
        }
    }

    /// The surfaces as `ball` meets them.
    pub(crate) fn surfaces_for(&self, ball: &Ball) -> Cow<'_, [PlannedSurface]> {
        if !self.restitution_of_ball {
            return Cow::Borrowed(&self.surfaces);
        }
        let of_ball = |surface: &PlannedSurface| {
            let restitution = surface.material.restitution.for_ball(ball);
            PlannedSurface { material: Material { restitution, ..surface.material }, ..*surface }
        };
        self.surfaces.iter().map(of_ball).collect()
    }

    pub(crate) fn integrator(&self, forces: &Forces) -> Integrator {
        match self.method {
            Method::Exact => Integrator::Exact,
            Method::Euler { step } => Integrator::Stepping(Stepping::Euler, step),
            Method::SemiImplicitEuler { step } => Integrator::Stepping(Stepping::SemiImplicitEuler, step),
            Method::Rk4 { step } => Integrator::Stepping(Stepping::Rk4, step),
            Method::Adaptive { tolerance } => {
                let rate = if let [flow] = forces.flows { flow.rate(&forces.body) } else { None };
                rate.map_or(Integrator::Adaptive(Adaptive::new(tolerance)), |rate| {
                    Integrator::Damped(Damped::new(tolerance, rate))
                })
            }
        }
    }
}

fn method(scene: &Scene, flows: &[Arc<dyn Flow>]) -> Result<Method, SceneError> {
    let method = match (scene.method, flows) {
        (Some(Method::Exact), [flow, ..]) => return Err(SceneError::NoExactFlight { effect: flow.name() }),
        (Some(method), _) => method,
        (None, []) => Method::Exact,
        (None, _) => Method::Adaptive { tolerance: FLIGHT_TOLERANCE },
    };
    let positive =
        |name, x: f64, expected| -> Result<f64, ValueError> { require(name, x, expected, x.is_finite() && x > 0.0) };
    match method {
        Method::Exact => {}
        Method::Euler { step } | Method::SemiImplicitEuler { step } | Method::Rk4 { step } => {
            positive("step", step, "finite and > 0, in s")?;
            let enough = scene.duration / step <= STEP_BUDGET as f64;
            require("step", step, "no less than a 10 000 000 000th of the duration, in s", enough)?;
        }
        Method::Adaptive { tolerance } => {
            require("tolerance", tolerance, TOLERANCE_RANGE, (LEAST_TOLERANCE..=1.0).contains(&tolerance))?;
        }
    }
    Ok(method)
}

/// Refuses what f64 cannot square; lengths are squared where there are meshes.
fn check_range(scene: &Scene, size: &Size, has_meshes: bool) -> Result<(), SceneError> {
    let refuse = |what, value, expected| Err(SceneError::OutOfRange { what, value, expected });
    let speed = scene.balls.iter().map(|b| b.start().velocity.amax()).fold(0.0, f64::max);
    let gravity = scene.gravity.map_or(0.0, |g| g.acceleration().amax());
    let largest =
        [("the largest coordinate (m)", size.farthest), ("a speed (m/s)", speed), ("gravity (m/s^2)", gravity)];
    if let Some((what, value)) = largest.into_iter().find(|(_, value)| *value > LARGEST) {
        return refuse(what, value, "at most 2^500");
    }
    if has_meshes && size.extent < SMALLEST {
        return refuse("the size of a scene with polygons or meshes (m)", size.extent, "at least 2^-450");
    }
    Ok(())
}

/// Planes with their surfaces.
type Planes = Vec<(usize, Plane)>;
/// Meshes with their surfaces.
type Meshes = Vec<(usize, Arc<Mesh>)>;

fn shapes(scene: &Scene) -> (Planes, Meshes) {
    let (mut planes, mut meshes) = (Vec::new(), Vec::new());
    for (i, surface) in scene.surfaces.iter().enumerate() {
        match &surface.shape {
            Shape::Plane(plane) => planes.push((i, *plane)),
            Shape::Polygon(polygon) => meshes.push((i, Arc::new(Mesh::from_polygon(polygon)))),
            Shape::Mesh(mesh) => meshes.push((i, Arc::clone(mesh))),
        }
    }
    (planes, meshes)
}

/// How large a scene is.
struct Size {
    /// Its size in m, wherever it is.
    extent: f64,
    /// Its largest |coordinate| in m.
    farthest: f64,
}

impl Size {
    fn of(scene: &Scene, planes: &[(usize, Plane)], meshes: &[(usize, Arc<Mesh>)]) -> Self {
        let starts: Vec<Point3<f64>> = scene.balls.iter().map(|b| b.start().position).collect();
        let mut bounds = Aabb::of_points(&starts);
        for (_, mesh) in meshes {
            bounds = bounds.union(mesh.bounds());
        }
        let radius = scene.balls.iter().map(Ball::radius).fold(0.0, f64::max);
        let above = planes.iter().flat_map(|(_, plane)| starts.iter().map(|x| plane.signed_distance(x).abs()));
        let mut extent = above.fold(bounds.extent().amax().max(radius), f64::max);
        if extent == 0.0 {
            // Points that start on their plane: as far as they get in the time.
            let fastest = |s: State| s.velocity.amax() * scene.duration;
            extent = scene.balls.iter().map(|b| fastest(b.start())).fold(0.0, f64::max);
        }
        let corners = bounds.min().coords.amax().max(bounds.max().coords.amax());
        let farthest = planes.iter().map(|(_, plane)| plane.point().coords.amax()).fold(corners, f64::max);
        Self { extent, farthest: farthest.max(extent) }
    }
}
