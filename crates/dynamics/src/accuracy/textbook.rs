//! The method of the slides as published, kept as a method under test: what certified collisions are measured against.
//!
//! ```text
//! while TimestepRemaining > 0:
//!     NewState = integrate(State, Timestep)
//!     if d changes its sign for a plane, and the hit lies inside the polygon:
//!         f = d[n] / (d[n] - d[n+1]), the smallest of all;  Timestep = f Timestep;  NewState = integrate(State, Timestep);  respond
//!     TimestepRemaining = TimestepRemaining - Timestep;  State = NewState
//! ```
//!
//! `Timestep` is reset after a hit (as printed, 3 s become more), an endless loop ends with its step, and there is no test
//! for rest. All else is as published, in plain f64: a hit position is rounded, so that a ball may be left behind the plane it
//! has hit, meet its back side and pass through; the inside test is a plain determinant at a rounded point; a ball has no edges and corners to meet.
//! The simulation of a scene never uses this file.

use crate::body::Ball;
use crate::counters::Counters;
use crate::events::{Ending, Event, EventKind, Motion, Outcome};
use crate::integrators::{Integrator, Step, Stepping};
use crate::observer::{Observer, Segment};
use crate::plan::Plan;
use crate::surface::Material;
use carom_geometry::bounds::Aabb;
use carom_geometry::mesh::Mesh;
use carom_geometry::projection::DominantAxis;
use nalgebra::{Point3, Vector3};

/// Collisions in one step before the rest of it is given up.
const MAX_COLLISIONS: u32 = 8;

/// Collisions of a ball before its simulation is ended: without a test for rest it trembles for ever.
const COLLISION_BUDGET: u64 = 50_000;

/// Halvings of an interval of f: as many as it has digits.
const HALVINGS: u32 = 53;

/// How the slides' method determines f.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Determination {
    /// f = d0 / (d0 - d1), as if the path were straight.
    Linear,
    /// The root of the distance along the path that the integrator made.
    OwnCurve,
}

/// A variant of the slides' method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Textbook {
    /// How the ball moves in a step; the slides' is Euler's.
    pub stepping: Stepping,
    /// h in s.
    pub step: f64,
    /// How f is found; the slides' is linear.
    pub determination: Determination,
}

/// A collision with a plane or a face.
struct Collision {
    f: f64,
    surface: usize,
    face: Option<u32>,
    normal: Vector3<f64>,
}

/// Simulates one ball of `plan` in the way of the slides and shows it to `observer`.
pub fn simulate_textbook(plan: &Plan, method: &Textbook, ball: &Ball, observer: &mut impl Observer) -> Outcome {
    let surfaces = plan.surfaces_for(ball);
    let forces = plan.forces(ball);
    let mut counters = Counters::default();
    let mut integrator = Integrator::Stepping(method.stepping, method.step);
    let mut state = ball.start();
    let mut ending = Ending::Completed;
    let steps = (plan.duration / method.step).ceil() as u64;
    let mut time = 0.0;
    'run: for n in 0..steps {
        time = n as f64 * method.step;
        let end = ((n + 1) as f64 * method.step).min(plan.duration);
        let mut remaining = end - time;
        let mut collisions = 0;
        while remaining > 0.0 {
            let step = integrator.step(&forces, &state, remaining, false, &mut counters);
            if !step.is_finite() {
                ending = Ending::Diverged;
                break 'run;
            }
            let Some(hit) = earliest(plan, method, ball, &step, &mut counters) else {
                observer.segment(&Segment { time, end, step, to: 1.0, motion: Motion::Flying, turning: None });
                state = step.end();
                break;
            };
            let timestep = hit.f * remaining;
            let arrived = match method.determination {
                Determination::Linear => integrator.step(&forces, &state, timestep, false, &mut counters),
                Determination::OwnCurve => Step { to: hit.f, ..step },
            };
            let until = time + timestep;
            if timestep > 0.0 {
                observer.segment(&Segment {
                    time,
                    end: until,
                    step: arrived,
                    to: arrived.to,
                    motion: Motion::Flying,
                    turning: None,
                });
            }
            state = if timestep > 0.0 { arrived.end() } else { state };
            let velocity_in = state.velocity;
            state.velocity = respond(&surfaces[hit.surface].material, &hit, velocity_in, &mut counters);
            observer.event(&Event {
                time: until,
                kind: EventKind::Impact,
                surface: hit.surface,
                face: hit.face,
                position: state.position,
                normal: hit.normal,
                velocity_in,
                velocity: state.velocity,
                bound: None,
                spin: None,
            });
            (time, remaining) = (until, remaining - timestep);
            collisions += 1;
            if counters.impacts >= COLLISION_BUDGET {
                ending = Ending::EventBudget;
                break 'run;
            }
            if collisions == MAX_COLLISIONS {
                counters.halvings += 1;
                break;
            }
        }
    }
    if ending == Ending::Completed {
        time = plan.duration;
    }
    Outcome { ending, time, state, motion: Motion::Flying, spin: None, counters }
}

/// v_n+ = -c_r v_n-, and friction on v_t; also where the ball does not close.
fn respond(material: &Material, hit: &Collision, v: Vector3<f64>, counters: &mut Counters) -> Vector3<f64> {
    let v_n = hit.normal * hit.normal.dot(&v);
    let v_t = v - v_n;
    counters.impacts += 1;
    counters.restitution += 1;
    counters.friction += 1;
    let c_r = material.restitution.at(v_n.norm());
    material.friction.slow(v_t, v_n.norm(), c_r) - v_n * c_r
}

/// The collision with the smallest f: of planes and faces at which the distance changes its sign.
fn earliest(plan: &Plan, method: &Textbook, ball: &Ball, step: &Step, counters: &mut Counters) -> Option<Collision> {
    let (x0, x1) = (step.path.start(), step.end().position);
    let mut earliest: Option<Collision> = None;
    let mut consider = |p: &Point3<f64>, n: Vector3<f64>, surface: usize, face: Option<(u32, &Mesh)>| {
        counters.clearances += 1;
        let numbered = plan.surfaces[surface].numbered;
        // The side is that of the centre, and with it the sign of the radius.
        let n = if (x0 - p).dot(&n) >= 0.0 { n } else { -n };
        let distance = |x: &Point3<f64>| (x - p).dot(&n) - ball.radius();
        let (d0, d1) = (distance(&x0), distance(&x1));
        if (d0 >= 0.0) == (d1 >= 0.0) {
            return;
        }
        let f = match method.determination {
            Determination::Linear => d0 / (d0 - d1),
            Determination::OwnCurve => root(|f| distance(&step.path.at(f)), d0),
        };
        let at = match method.determination {
            Determination::Linear => x0 + (x1 - x0) * f,
            Determination::OwnCurve => step.path.at(f),
        };
        let inside = face.is_none_or(|(face, mesh)| {
            counters.triangles += 1;
            is_inside(&mesh.triangle(face), &n, &(at - n * ball.radius()))
        });
        if inside && earliest.as_ref().is_none_or(|hit| f < hit.f) {
            earliest = Some(Collision { f, surface, face: face.map(|(face, _)| face).filter(|_| numbered), normal: n });
        }
    };
    for (surface, plane) in &plan.planes {
        consider(&plane.point(), plane.normal().into_inner(), *surface, None);
    }
    let mut nodes = 0;
    for (surface, mesh) in &plan.meshes {
        let path = Aabb::of_points(&[x0, step.path.at(0.5), x1]).inflate(ball.radius());
        nodes += mesh.bvh().visit_box(&path, |face| {
            if let Some(n) = mesh.normal(face) {
                consider(&mesh.triangle(face)[0], n.into_inner(), *surface, Some((face, mesh)));
            }
        });
    }
    counters.nodes += nodes;
    earliest
}

/// Where `distance`, which begins at `d0`, changes its sign in [0, 1]: the last f that has not.
fn root(distance: impl Fn(f64) -> f64, d0: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (distance(middle) >= 0.0) == (d0 >= 0.0) { low = middle } else { high = middle }
    }
    low
}

/// Whether the determinants of the edges and the point, on the plane of the dominant axis, all have one sign.
fn is_inside(corners: &[Point3<f64>; 3], n: &Vector3<f64>, at: &Point3<f64>) -> bool {
    let axis = DominantAxis::of(n);
    let [x, a, b, c] = [at, &corners[0], &corners[1], &corners[2]].map(|p| axis.project(p));
    let signs = [(a, b), (b, c), (c, a)].map(|(p, q)| (q.x - p.x) * (x.y - p.y) - (q.y - p.y) * (x.x - p.x) >= 0.0);
    signs == [true; 3] || signs == [false; 3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
    use crate::observer::Trajectory;
    use crate::scene::Scene;
    use crate::surface::{Material, Shape, Surface};
    use carom_geometry::plane::Plane;

    fn plan(height: f64, duration: f64) -> Plan {
        let material = Material { restitution: Restitution::new(0.5).unwrap(), friction: Friction::None };
        let floor = Plane::from_point_normal(Point3::origin(), Vector3::z()).unwrap();
        Plan::new(&Scene {
            gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0)).unwrap()),
            surfaces: vec![Surface { name: "floor".into(), material, shape: Shape::Plane(floor) }],
            balls: vec![Ball::new(Point3::new(0.0, 0.0, height), Vector3::zeros(), 0.0, None).unwrap()],
            ..Scene::lasting(duration)
        })
        .unwrap()
    }

    fn slides(step: f64) -> Textbook {
        Textbook { stepping: Stepping::Euler, step, determination: Determination::Linear }
    }

    #[test]
    fn r10_the_loop_of_the_slides_hits_at_f_and_flies_on_in_the_same_step() {
        // h = 1/4, g = 8: z = 3, 3, 2.5, 1.5, 0 exactly at n = 4: d1 = 0 is no change of sign, the next step's is, at f = 0.
        let (plan, mut run) = (plan(3.0, 1.25), Trajectory::default());
        simulate_textbook(&plan, &slides(0.25), &plan.balls()[0], &mut run);
        assert_eq!((run.events[0].time, run.events[0].velocity_in.z, run.events[0].velocity.z), (1.0, -8.0, 4.0));
        let end = run.segments.last().unwrap();
        assert_eq!((end.end, end.step.end().position.z), (1.25, 1.0));
    }

    #[test]
    fn r28_a_rounded_hit_position_lets_balls_fall_through() {
        // From 64 heights; where the first hit is rounded to below the floor, the ball meets its back side.
        let through = (1..=64).filter(|k| {
            let plan = plan(f64::from(*k) * 0.1, 8.0);
            let outcome = simulate_textbook(&plan, &slides(0.01), &plan.balls()[0], &mut ());
            outcome.state.position.z < -1.0
        });
        assert!(through.count() > 8);
    }
}
