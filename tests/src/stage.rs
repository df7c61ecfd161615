//! Small scenes in a few words, and what came of them.

use carom_dynamics::body::Ball;
use carom_dynamics::effects::buoyancy::Buoyancy;
use carom_dynamics::effects::drag::Drag;
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::gravity::Gravity;
use carom_dynamics::effects::magnus::Magnus;
use carom_dynamics::effects::restitution::Restitution;
use carom_dynamics::effects::spin_decay::SpinDecay;
use carom_dynamics::events::{Event, EventKind, Outcome};
use carom_dynamics::observer::Trajectory;
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::{Method, Scene};
use carom_dynamics::simulate::simulate;
use carom_dynamics::surface::{Material, Shape, Surface};
use carom_dynamics::tolerance::RestThresholds;
use carom_geometry::mesh::Mesh;
use carom_geometry::plane::Plane;
use carom_geometry::polygon::Polygon;
use nalgebra::{Point3, Vector3};
use std::sync::Arc;

/// A scene that is being set up. What a library would refuse panics here.
#[derive(Debug, Clone)]
pub struct Stage(pub Scene);

/// A material without friction.
pub fn smooth(c_r: f64) -> Material {
    rough(c_r, Friction::None)
}

/// A material with friction.
pub fn rough(c_r: f64, friction: Friction) -> Material {
    Material { restitution: Restitution::new(c_r).unwrap_or_else(|e| panic!("{e}")), friction }
}

/// Coulomb friction by the book.
pub fn coulomb(mu: f64) -> Friction {
    Friction::coulomb(mu).unwrap_or_else(|e| panic!("{e}"))
}

impl Stage {
    /// Empty space for `duration` seconds.
    pub fn new(duration: f64) -> Self {
        Self(Scene::lasting(duration))
    }

    /// With gravity, in m/s^2.
    pub fn gravity(mut self, g: impl Into<Vector3<f64>>) -> Self {
        self.0.gravity = Some(Gravity::uniform(g.into()).unwrap_or_else(|e| panic!("{e}")));
        self
    }

    /// With gravity `g` downwards, along -z.
    pub fn down(self, g: f64) -> Self {
        self.gravity([0.0, 0.0, -g])
    }

    /// With air resistance.
    pub fn drag(mut self, drag: Drag) -> Self {
        self.0.drag = Some(drag);
        self
    }

    /// With the Magnus force.
    pub fn magnus(mut self, magnus: Magnus) -> Self {
        self.0.magnus = Some(magnus);
        self
    }

    /// With spin that decays with the time constant `tau`, in s.
    pub fn spin_decay(mut self, tau: f64) -> Self {
        self.0.spin_decay = Some(SpinDecay::new(tau).unwrap_or_else(|e| panic!("{e}")));
        self
    }

    /// With buoyancy in a fluid of `density`, in kg/m^3.
    pub fn buoyancy(mut self, density: f64) -> Self {
        self.0.buoyancy = Some(Buoyancy::new(density).unwrap_or_else(|e| panic!("{e}")));
        self
    }

    /// With the last ball spinning at the angular velocity `spin`, in rad/s.
    pub fn spinning(mut self, spin: impl Into<Vector3<f64>>) -> Self {
        let ball = self.0.balls.pop().unwrap_or_else(|| panic!("no ball to spin"));
        self.0.balls.push(ball.spinning(spin.into()).unwrap_or_else(|e| panic!("{e}")));
        self
    }

    /// With a method.
    pub fn method(mut self, method: Method) -> Self {
        self.0.method = Some(method);
        self
    }

    /// With a rest length, in m.
    pub fn rest_length(mut self, length: f64) -> Self {
        self.0.rest = Some(RestThresholds::length(length).unwrap_or_else(|e| panic!("{e}")));
        self
    }

    /// With the book's thresholds of rest.
    pub fn book_rest(mut self, speed: f64, distance: f64, force: f64) -> Self {
        self.0.rest = Some(RestThresholds::book(speed, distance, force).unwrap_or_else(|e| panic!("{e}")));
        self
    }

    /// With a surface.
    pub fn surface(mut self, name: &str, material: Material, shape: Shape) -> Self {
        self.0.surfaces.push(Surface { name: name.to_owned(), material, shape });
        self
    }

    /// With a plane through `point`.
    pub fn plane(
        self,
        name: &str,
        material: Material,
        point: impl Into<Point3<f64>>,
        normal: impl Into<Vector3<f64>>,
    ) -> Self {
        let plane = Plane::from_point_normal(point.into(), normal.into()).unwrap_or_else(|e| panic!("{e}"));
        self.surface(name, material, Shape::Plane(plane))
    }

    /// With the floor z = 0.
    pub fn floor(self, material: Material) -> Self {
        self.plane("floor", material, [0.0; 3], [0.0, 0.0, 1.0])
    }

    /// With a room from 0 to `size` of six planes, their normals inwards.
    pub fn room(self, material: Material, size: [f64; 3]) -> Self {
        let [x, y, z] = size;
        self.plane("west", material, [0.0; 3], [1.0, 0.0, 0.0])
            .plane("east", material, [x, 0.0, 0.0], [-1.0, 0.0, 0.0])
            .plane("south", material, [0.0; 3], [0.0, 1.0, 0.0])
            .plane("north", material, [0.0, y, 0.0], [0.0, -1.0, 0.0])
            .plane("floor", material, [0.0; 3], [0.0, 0.0, 1.0])
            .plane("ceiling", material, [0.0, 0.0, z], [0.0, 0.0, -1.0])
    }

    /// With a polygon.
    pub fn polygon(self, name: &str, material: Material, vertices: &[[f64; 3]]) -> Self {
        let polygon = Polygon::new(vertices.iter().map(|v| Point3::from(*v)).collect());
        self.surface(name, material, Shape::Polygon(polygon.unwrap_or_else(|e| panic!("{e}"))))
    }

    /// With a mesh.
    pub fn mesh(self, name: &str, material: Material, vertices: Vec<Point3<f64>>, faces: Vec<[u32; 3]>) -> Self {
        let mesh = Mesh::new(vertices, faces).unwrap_or_else(|e| panic!("{e}"));
        self.surface(name, material, Shape::Mesh(Arc::new(mesh)))
    }

    /// With a ball that has no mass.
    pub fn ball(self, x: impl Into<Point3<f64>>, v: impl Into<Vector3<f64>>, radius: f64) -> Self {
        self.thing(x, v, radius, None)
    }

    /// With a ball of `mass` kg.
    pub fn thing(
        mut self,
        x: impl Into<Point3<f64>>,
        v: impl Into<Vector3<f64>>,
        radius: f64,
        mass: Option<f64>,
    ) -> Self {
        self.0.balls.push(Ball::new(x.into(), v.into(), radius, mass).unwrap_or_else(|e| panic!("{e}")));
        self
    }

    /// The plan.
    pub fn plan(&self) -> Plan {
        Plan::new(&self.0).unwrap_or_else(|e| panic!("{e}"))
    }

    /// Runs every ball.
    pub fn run_all(&self) -> Vec<Run> {
        let plan = self.plan();
        plan.balls().iter().map(|ball| Run::of(&plan, ball)).collect()
    }

    /// Runs the only ball.
    pub fn run(&self) -> Run {
        let mut runs = self.run_all();
        assert_eq!(runs.len(), 1, "one ball");
        runs.remove(0)
    }
}

/// What became of a ball.
#[derive(Debug, Clone)]
pub struct Run {
    /// Its events and motion.
    pub trajectory: Trajectory,
    /// How it ended.
    pub outcome: Outcome,
}

impl Run {
    /// Simulates `ball`.
    pub fn of(plan: &Plan, ball: &Ball) -> Self {
        let mut trajectory = Trajectory::default();
        let outcome = simulate(plan, ball, &mut trajectory);
        Self { trajectory, outcome }
    }

    /// Its events of one kind.
    pub fn events(&self, kind: EventKind) -> Vec<Event> {
        self.trajectory.events.iter().filter(|e| e.kind == kind).copied().collect()
    }

    /// Its impacts.
    pub fn impacts(&self) -> Vec<Event> {
        self.events(EventKind::Impact)
    }

    /// The kinds of its events, in order.
    pub fn kinds(&self) -> Vec<EventKind> {
        self.trajectory.events.iter().map(|e| e.kind).collect()
    }

    /// The position at `time`; panics outside the run.
    pub fn at(&self, time: f64) -> Point3<f64> {
        let found = self.trajectory.at(time);
        found.unwrap_or_else(|| panic!("nothing at t = {time}, the run ends at {}", self.outcome.time)).0.position
    }

    /// The velocity at `time`; panics outside the run.
    pub fn velocity_at(&self, time: f64) -> Vector3<f64> {
        let found = self.trajectory.at(time);
        found.unwrap_or_else(|| panic!("nothing at t = {time}, the run ends at {}", self.outcome.time)).0.velocity
    }
}
