//! The keys of a scene file. Their documentation is the user's: `carom schema` is made of it.

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A scene: what moves, what it bounces on, and which effects take part. SI units throughout.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a scene, which is a table")]
#[schemars(title = "Carom scene")]
pub struct SceneFile {
    /// The schema of this file, for editors of JSON; it says nothing to the simulation.
    #[serde(rename = "$schema")]
    #[allow(dead_code, reason = "read so that it is allowed, and no more")]
    pub schema: Option<String>,
    /// The version of this format: 1.
    #[schemars(range(min = 1, max = 1))]
    pub version: u64,
    /// For how long to simulate, in s, greater than 0.
    pub duration: f64,
    /// The acceleration of gravity, in m/s^2, such as [0, 0, -9.81]. Without this key there is no gravity.
    pub gravity: Option<[f64; 3]>,
    /// Which effects of the air are simulated: those that the scene gives, or "auto": just those whose omission would change a flight
    /// time, a speed or a way by more than 1 %, or { auto = share } for another share. What is left out is told.
    pub effects: Option<EffectsTable>,
    /// The air and its resistance. Without this table the balls fly in a vacuum.
    pub air: Option<AirTable>,
    /// The materials that surfaces are made of, by name.
    #[serde(default)]
    pub materials: BTreeMap<String, MaterialTable>,
    /// What the balls bounce on. Both sides of every surface collide.
    #[serde(default)]
    pub surfaces: Vec<SurfaceTable>,
    /// The balls. May be left out when they are given with `--balls`.
    #[serde(default)]
    pub balls: Vec<BallTable>,
    /// When bouncing ends and a ball counts as at rest. Without this table the thresholds follow from the scene.
    pub rest: Option<RestTable>,
    /// How flights are computed. Without this table: exactly, wherever the scene allows it.
    pub method: Option<MethodTable>,
}

/// Which effects are simulated: "auto", or { auto = share }.
#[derive(Debug, Clone, Copy, JsonSchema)]
#[schemars(untagged)]
pub enum EffectsTable {
    /// Chosen to 1 %.
    Word(EffectsWord),
    /// Chosen to a share.
    Share(EffectsShare),
}

/// How effects are chosen.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EffectsWord {
    /// By what they would change.
    Auto,
}

/// To which share effects are chosen.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { auto = 0.001 }")]
pub struct EffectsShare {
    /// The share of a time, a speed or a way by which what is left out may change it, greater than 0.
    pub auto: f64,
}

/// The air, and what it does to the balls.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { drag = { linear = 0.05 } }")]
pub struct AirTable {
    /// Its density rho in kg/m^3, about 1.204 at 20 C, for all effects that do not give their own.
    pub density: Option<f64>,
    /// Its viscosity mu in Pa s, about 1.825e-5 at 20 C; asked for by the drag of a smooth sphere.
    pub viscosity: Option<f64>,
    /// The velocity of the wind, in m/s. Needs a drag law or the Magnus force: without them, wind does nothing.
    pub wind: Option<[f64; 3]>,
    /// The law of air resistance: `linear`, or `coefficient` and `density`, or "ball", or "sphere".
    pub drag: Option<DragTable>,
    /// The Magnus force on balls that spin.
    pub magnus: Option<MagnusTable>,
    /// The time constant in s in which the air takes the spin of a ball down to 1/e. Without this key: none is lost.
    pub spin_decay: Option<f64>,
    /// Whether the air carries the balls and is taken along by them. Without this key: no.
    pub buoyancy: Option<bool>,
}

/// Air resistance: { linear = k }, or { coefficient = C, density = rho } for the quadratic law. Or the quadratic law with the coefficient
/// of each ball ("ball", which needs the `density` of the air), or with that of a smooth sphere at its Reynolds number ("sphere",
/// which needs its `viscosity` as well).
#[derive(Debug, JsonSchema)]
#[schemars(untagged)]
pub enum DragTable {
    /// One of the laws with a number.
    Law(DragLaw),
    /// The quadratic law with a coefficient that is not the scene's.
    Of(DragOf),
}

/// Whose drag coefficient it is.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DragOf {
    /// Each ball's own.
    Ball,
    /// That of a smooth sphere at its Reynolds number.
    Sphere,
}

/// Air resistance: { linear = k }, or { coefficient = C, density = rho } for the quadratic law.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, { linear = k } or { coefficient = C, density = rho }")]
pub struct DragLaw {
    /// k in kg/s of the linear law F = -k (v - w).
    pub linear: Option<f64>,
    /// The drag coefficient C, no unit, of the quadratic law F = -1/2 rho C A |v - w| (v - w); about 0.47 for a sphere.
    pub coefficient: Option<f64>,
    /// The density rho of the air in kg/m^3, for the quadratic law; about 1.204 at 20 C.
    pub density: Option<f64>,
}

/// The Magnus force F = 1/2 rho A K r omega x (v - w).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { coefficient = 1.0 }")]
pub struct MagnusTable {
    /// K, no unit: the lift coefficient is K times the spin parameter r omega / |v - w|.
    pub coefficient: f64,
    /// The density rho of the air in kg/m^3, if not that of `[air]`.
    pub density: Option<f64>,
}

/// A material.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { restitution = 0.75 }")]
pub struct MaterialTable {
    /// The coefficient of restitution c_r, from 0 (sticks) to 1 (loses nothing), or a law of it.
    pub restitution: RestitutionTable,
    /// The law of friction. Without this key: none.
    pub friction: Option<FrictionTable>,
}

/// Restitution: a number from 0 to 1, or { coefficient = c_r, falls_above = v }, or "ball" for each ball's own.
#[derive(Debug, Clone, Copy, JsonSchema)]
#[schemars(untagged)]
pub enum RestitutionTable {
    /// The same at every speed.
    Constant(#[schemars(range(min = 0.0, max = 1.0))] f64),
    /// Less for faster impacts.
    Falling(FallingTable),
    /// Each ball's own.
    Of(RestitutionOf),
}

/// Whose restitution it is.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RestitutionOf {
    /// Each ball's own.
    Ball,
}

/// Restitution that falls with the speed.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { coefficient = 0.9, falls_above = 1.0 }")]
pub struct FallingTable {
    /// c_r of slow impacts.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub coefficient: f64,
    /// The closing speed in m/s above which it falls, as v^(-1/4).
    pub falls_above: f64,
}

/// Friction at an impact: exactly one of its laws.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", expecting = "a table with one law, such as { coulomb = 0.6 }")]
pub enum FrictionTable {
    /// c_f, from 0 to 1: the tangential velocity is multiplied by 1 - c_f.
    Linear(f64),
    /// mu, the book's Coulomb law: the tangential speed falls by up to mu times the closing speed.
    Coulomb(f64),
    /// mu, the impulse law: the tangential speed falls by up to mu (1 + c_r) times the closing speed.
    Impulse(f64),
    /// The impulse law at the point of contact, which turns the ball: { mu, tangential, rolling }.
    Grip(GripTable),
}

/// Friction that turns the ball.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { mu = 0.6 }")]
pub struct GripTable {
    /// mu, the coefficient of friction.
    pub mu: f64,
    /// e_x, the tangential restitution where the surface grips, from -1 to 1: at 0 the ball leaves rolling.
    #[serde(default)]
    pub tangential: f64,
    /// c_rr, the rolling resistance: on a slope up to c_rr the ball does not roll.
    #[serde(default)]
    pub rolling: f64,
}

/// A fixed surface.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table with `name`, `material` and `shape`")]
pub struct SurfaceTable {
    /// Its name, by which events refer to it; each name once.
    pub name: String,
    /// The name of its material, one of `materials`.
    #[schemars(required)]
    pub material: Option<String>,
    /// Where it is: exactly one of `plane`, `polygon` and `mesh`.
    pub shape: ShapeTable,
}

/// The shape of a surface: exactly one of these.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", expecting = "a table with one of `plane`, `polygon` and `mesh`")]
pub enum ShapeTable {
    /// An infinite plane.
    Plane(PlaneTable),
    /// The vertices of a simple planar polygon in order, in m; convex or concave.
    Polygon(#[schemars(length(min = 3))] Vec<[f64; 3]>),
    /// A triangle mesh from a file.
    Mesh(MeshTable),
}

/// A plane: { point, normal }, or { coefficients }.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, { point = [..], normal = [..] } or { coefficients = [A, B, C, D] }")]
pub struct PlaneTable {
    /// A point of the plane, in m.
    pub point: Option<[f64; 3]>,
    /// A vector at right angles to the plane, of any length but 0.
    pub normal: Option<[f64; 3]>,
    /// [A, B, C, D] of A x + B y + C z + D = 0.
    pub coefficients: Option<[f64; 4]>,
}

/// A mesh file and how it is placed: first `up`, then `scale`, then `translate`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { file = \"hill.obj\" }")]
pub struct MeshTable {
    /// The file, relative to the scene file: OBJ, STL or PLY.
    pub file: String,
    /// Metres per unit of the file, greater than 0.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0))]
    pub scale: f64,
    /// Where the origin of the file comes to lie, in m.
    #[serde(default)]
    pub translate: [f64; 3],
    /// The axis of the file that points up: it becomes z, and the other two follow in cyclic order.
    #[serde(default)]
    pub up: Up,
}

fn one() -> f64 {
    1.0
}

/// An axis of a mesh file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", expecting = "\"x\", \"y\" or \"z\"")]
pub enum Up {
    X,
    Y,
    #[default]
    Z,
}

/// A ball, or a grid of equal balls.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { position = [0, 0, 1] }")]
pub struct BallTable {
    /// Where its centre starts, in m.
    pub position: [f64; 3],
    /// Its velocity at the start, in m/s.
    #[serde(default)]
    pub velocity: [f64; 3],
    /// The name of a ball that the program knows, such as "tennis"; `carom balls` lists them. It gives whatever of `radius`, `mass`,
    /// `inertia`, `drag` and `restitution` is not given here.
    pub ball: Option<String>,
    /// Its radius in m; 0 is a point. Without this key: 0, or that of the `ball`.
    #[schemars(range(min = 0.0))]
    pub radius: Option<f64>,
    /// Its mass in kg, greater than 0; needed only by effects that divide a force by it.
    pub mass: Option<f64>,
    /// Its angular velocity at the start, in rad/s, right-handed; needed only by effects of spin.
    #[serde(default)]
    pub spin: [f64; 3],
    /// alpha of its moment of inertia alpha m r^2: 0.4 for a solid sphere, 2/3 for a thin shell. Without this key: 0.4.
    pub inertia: Option<f64>,
    /// Its own drag coefficient, for drag = "ball" in [air].
    pub drag: Option<f64>,
    /// Its own coefficient of restitution, from 0 to 1, for restitution = "ball" in a material.
    pub restitution: Option<f64>,
    /// Repeats the ball in a grid.
    pub grid: Option<GridTable>,
}

/// A grid of balls: ball (i, j, k) starts at position + (i, j, k) * step, and i runs fastest.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, { count = [nx, ny, nz], step = [dx, dy, dz] }")]
pub struct GridTable {
    /// How many balls along x, y and z, each 1 or more.
    pub count: [u32; 3],
    /// The distances between neighbours along x, y and z, in m.
    pub step: [f64; 3],
}

/// The thresholds of the rest test: `length` alone, or the book's `speed`, `distance` and `force` together.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table, { length = .. } or { speed = .., distance = .., force = .. }")]
pub struct RestTable {
    /// The one tolerance, in m: a hop lower than this is no hop.
    pub length: Option<f64>,
    /// The book's e1, in m/s: at rest, a ball is slower.
    pub speed: Option<f64>,
    /// The book's e2, in m: at rest, a ball is nearer to the surface.
    pub distance: Option<f64>,
    /// The book's e3 per mass, in m/s^2: at rest, a ball is pulled off the surface less.
    pub force: Option<f64>,
}

/// How flights are computed.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { integrator = \"rk4\", step = 0.01 }")]
pub struct MethodTable {
    /// The integrator.
    pub integrator: Integrator,
    /// The time step in s of `euler`, `semi-implicit-euler` and `rk4`.
    pub step: Option<f64>,
    /// For `adaptive` the error allowed per step, relative to the size of the motion; for `auto` the largest error of a position, in m.
    pub tolerance: Option<f64>,
}

/// The integrators.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", expecting = "the name of an integrator")]
pub enum Integrator {
    /// Straight lines and parabolas in closed form; only under constant acceleration.
    Exact,
    /// The chapter's explicit Euler method, of order 1.
    Euler,
    /// Velocity first, then position: order 1.
    SemiImplicitEuler,
    /// The classical Runge-Kutta method, of order 4.
    Rk4,
    /// Runge-Kutta of orders 5 and 4 that chooses its steps.
    Adaptive,
    /// The cheapest of these that keeps positions right to `tolerance`, with its step: chosen before the run, by measuring, and said.
    Auto,
}
