//! H18: what is not a number, infinite, negative or out of range.

use super::super::{Bound, Case, Figure};
use crate::random::Random;
use carom_dynamics::body::Ball;
use carom_dynamics::effects::drag::Drag;
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::gravity::Gravity;
use carom_dynamics::effects::restitution::Restitution;
use carom_dynamics::observer::Trajectory;
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::{Method, Scene};
use carom_dynamics::simulate::simulate;
use carom_dynamics::surface::{Material, Shape, Surface};
use carom_dynamics::tolerance::RestThresholds;
use carom_geometry::mesh::Mesh;
use carom_geometry::plane::Plane;
use carom_geometry::polygon::Polygon;
use carom_geometry::quad::Quad;
use carom_geometry::triangle::Triangle;
use nalgebra::{Point3, Vector3};
use std::sync::Arc;

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case {
            id: "H18",
            title: "NaN, infinities, r < 0, c_r and c_f outside [0, 1], mu < 0, dt <= 0",
            elsewhere: "Jolt #1383: endless loop on NaN; godot #104359: one NaN force poisons the tree; Trespasser #84",
            bound: "each refused where it enters, by a typed error",
            run: refused,
        },
        Case {
            id: "H18",
            title: "scenes of any finite numbers, from 5e-324 to 1.8e308",
            elsewhere: "overflow to infinity, then NaN, then a hang",
            bound: "refused, or ended with finite events and a finite state",
            run: any_finite_scene,
        },
    ]
}

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn scene(duration: f64, method: Option<Method>) -> Scene {
    let ball = Ball::new(Point3::origin(), Vector3::zeros(), 0.0, None);
    Scene { balls: ball.into_iter().collect(), method, ..Scene::lasting(duration) }
}

fn refused() -> Figure {
    let mut bound = Bound::default();
    let mut refusals = 0;
    let mut refuse = |refused: bool, what: &str, x: f64| {
        refusals += 1;
        bound.keep(refused, || format!("{what} = {x} is taken"));
    };
    for x in NOT_FINITE.into_iter().chain([-1.0, -f64::MIN_POSITIVE, -5e-324]) {
        refuse(Ball::new(Point3::origin(), Vector3::zeros(), x, None).is_err(), "radius", x);
        refuse(Friction::coulomb(x).is_err(), "mu", x);
        refuse(Friction::impulse(x).is_err(), "impulse mu", x);
        refuse(Drag::linear(x).is_err(), "drag", x);
        refuse(Drag::quadratic(x, 1.0).is_err() && Drag::quadratic(1.0, x).is_err(), "quadratic drag", x);
        refuse(RestThresholds::book(x, 1.0, 1.0).is_err(), "rest speed", x);
        refuse(RestThresholds::book(1.0, x, 1.0).is_err() && RestThresholds::book(1.0, 1.0, x).is_err(), "rest", x);
    }
    for x in NOT_FINITE.into_iter().chain([-1.0, -5e-324, 1f64.next_up(), 2.0]) {
        refuse(Restitution::new(x).is_err(), "c_r", x);
        refuse(Friction::linear(x).is_err(), "c_f", x);
    }
    for x in NOT_FINITE.into_iter().chain([0.0, -0.0, -1.0]) {
        refuse(Ball::new(Point3::origin(), Vector3::zeros(), 1.0, Some(x)).is_err(), "mass", x);
        refuse(RestThresholds::length(x).is_err(), "rest length", x);
        refuse(Plan::new(&scene(x, None)).is_err(), "duration", x);
        for method in [Method::Euler { step: x }, Method::SemiImplicitEuler { step: x }, Method::Rk4 { step: x }] {
            refuse(Plan::new(&scene(1.0, Some(method))).is_err(), "step", x);
        }
        refuse(Plan::new(&scene(1.0, Some(Method::Adaptive { tolerance: x }))).is_err(), "tolerance", x);
    }
    for x in NOT_FINITE {
        for axis in 0..3 {
            let mut v = Vector3::new(0.0, 0.0, 1.0);
            v[axis] = x;
            let (p, o) = (Point3::from(v), Point3::origin());
            let (a, b) = (Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0));
            refuse(Ball::new(p, Vector3::zeros(), 0.0, None).is_err(), "position", x);
            refuse(Ball::new(o, v, 0.0, None).is_err(), "velocity", x);
            refuse(Gravity::uniform(v).is_err(), "gravity", x);
            refuse(Drag::linear(1.0).and_then(|drag| drag.in_wind(v)).is_err(), "wind", x);
            refuse(Plane::from_point_normal(p, Vector3::z()).is_err(), "point of a plane", x);
            refuse(Plane::from_point_normal(o, v).is_err(), "normal of a plane", x);
            refuse(Plane::from_coefficients(v.x, v.y, v.z, 0.0).is_err(), "coefficients", x);
            refuse(Plane::from_coefficients(0.0, 0.0, 1.0, x).is_err(), "D", x);
            refuse(Plane::through(p, a, b).is_err() && Plane::through(a, b, p).is_err(), "through", x);
            refuse(Triangle::new([p, a, b]).is_err() && Triangle::new([a, p, b]).is_err(), "triangle", x);
            refuse(Polygon::new(vec![o, a, p, b]).is_err(), "polygon", x);
            refuse(Quad::new([o, a, p, b]).is_err(), "quad", x);
            refuse(Mesh::new(vec![o, a, p], vec![[0, 1, 2]]).is_err(), "mesh", x);
        }
    }
    refuse(Plane::from_point_normal(Point3::origin(), Vector3::zeros()).is_err(), "normal", 0.0);
    refuse(Mesh::new(vec![Point3::origin()], vec![[0, 0, 7]]).is_err(), "index", 7.0);
    refuse(Mesh::new(Vec::new(), Vec::new()).is_err(), "faces", 0.0);
    refuse(Polygon::new(vec![Point3::origin(); 2]).is_err(), "vertices", 2.0);
    bound.figure(format!("{refusals} refusals"))
}

/// A finite number: ordinary, zero, subnormal or huge.
fn any(random: &mut Random) -> f64 {
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    sign * match random.below(80) {
        0 => f64::MAX,
        1 => f64::from_bits(1 + random.below(9) as u64),
        2 => 2f64.powi(random.below(2040) as i32 - 1020),
        3..=5 => random.octave(-450, 450),
        6..=12 => random.octave(-40, 40),
        13..=22 => 0.0,
        _ => random.within(0.0, 2.0),
    }
}

fn any_vector(random: &mut Random) -> Vector3<f64> {
    Vector3::new(any(random), any(random), any(random))
}

fn any_finite_scene() -> Figure {
    let mut random = Random::new(0x182);
    let mut bound = Bound::default();
    let (mut refused, mut ran, mut events) = (0, 0, 0);
    for k in 0..20_000 {
        let Some(scene) = any_scene(&mut random) else {
            refused += 1;
            continue;
        };
        let Ok(plan) = Plan::new(&scene) else {
            refused += 1;
            continue;
        };
        let mut run = Trajectory::default();
        let outcome = simulate(&plan, &plan.balls()[0], &mut run);
        ran += 1;
        events += run.events.len();
        let finite = |v: &Vector3<f64>| v.iter().all(|c| c.is_finite());
        let state = outcome.state;
        bound.keep(outcome.time.is_finite() && finite(&state.position.coords) && finite(&state.velocity), || {
            format!("scene {k}: ends at {} with {state:?}", outcome.time)
        });
        for e in &run.events {
            let all = finite(&e.position.coords) && finite(&e.velocity) && finite(&e.velocity_in) && finite(&e.normal);
            bound.keep(e.time.is_finite() && all, || format!("scene {k}: {e:?}"));
        }
    }
    bound.keep(ran > 1000, || format!("only {ran} ran"));
    bound.figure(format!("{ran} ran with {events} events, {refused} refused"))
}

/// A scene, if its parts can be made.
fn any_scene(random: &mut Random) -> Option<Scene> {
    let material = |random: &mut Random| {
        let restitution = Restitution::new(random.unit()).ok()?;
        let friction = match random.below(3) {
            0 => Friction::None,
            1 => Friction::linear(random.unit()).ok()?,
            _ => Friction::coulomb(any(random).abs()).ok()?,
        };
        Some(Material { restitution, friction })
    };
    let mut surfaces = Vec::new();
    for name in ["a", "b"] {
        let point = |random: &mut Random| Point3::from(any_vector(random));
        let shape = match random.below(3) {
            0 => Shape::Plane(Plane::from_point_normal(point(random), any_vector(random)).ok()?),
            1 => {
                let vertices = (0..5).map(|_| point(random)).collect();
                Shape::Mesh(Arc::new(Mesh::new(vertices, vec![[0, 1, 2], [0, 2, 3], [2, 3, 4]]).ok()?))
            }
            _ => {
                let [x, y, z] = [any(random), any(random), any(random)];
                let quad = [[x, y, z], [-x, y, z], [-x, -y, z], [x, -y, z]].map(Point3::from);
                Shape::Polygon(Polygon::new(quad.to_vec()).ok()?)
            }
        };
        surfaces.push(Surface { name: name.into(), material: material(random)?, shape });
    }
    let ball = Ball::new(Point3::from(any_vector(random)), any_vector(random), any(random).abs(), None).ok()?;
    let gravity = Gravity::uniform(any_vector(random)).ok()?;
    let gravity = (random.below(3) > 0).then_some(gravity);
    Some(Scene { gravity, surfaces, balls: vec![ball], ..Scene::lasting(any(random).abs()) })
}
