//! The reference solver: one ball from event to event, in more than twice the digits of f64.
//!
//! It shares nothing with the solver under test but the scene: flights are Taylor series, surfaces are asked one by one, impacts are answered by
//! the formulas of the chapter, or of grip and slip. What it does not do (slide or roll where that has no closed form, answer several surfaces
//! at once) ends the course, and the comparison with it.

use super::real::{Real, Vector, add, cross, dot, norm, point, rounded, scale, sub, vector};
use super::settle::{Settled, settle};
use super::taylor::{Field, Flight};
use super::world::{Meeting, Obstacle, World};
use crate::body::Ball;
use crate::effects::friction::Friction;
use crate::effects::grip::Grip;
use crate::plan::Plan;
use crate::surface::Material;
use nalgebra::Vector3;

/// Impacts that a course is followed for.
const MAX_IMPACTS: usize = 4000;

/// Stretches of flight that a course is followed for.
const MAX_FLIGHTS: usize = 100_000;

/// An impact of the reference.
#[derive(Debug, Clone)]
pub struct Impact {
    /// When, in s.
    pub time: Real,
    /// Index of the surface.
    pub surface: usize,
}

/// How far a course goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// To the end of the scene.
    Complete,
    /// Until the ball slides or rolls in a way that has no closed form here.
    Sliding,
    /// Until the ball touches several surfaces at once.
    Simultaneous,
    /// Until a touch that cannot be told from a miss.
    Undecided,
    /// As many impacts as a course is followed for.
    Budget,
}

/// The course of a ball.
#[derive(Debug, Clone)]
pub struct Course {
    /// Position and velocity at the sample times, as many as it reaches.
    pub samples: Vec<[Vector; 2]>,
    /// The impacts, in order of time.
    pub impacts: Vec<Impact>,
    /// When the ball came to rest, in s.
    pub rest: Option<f64>,
    /// Until when the course is known, in s.
    pub until: f64,
    /// Why it ends there.
    pub reach: Reach,
}

/// What the reference needs to know of a scene.
#[derive(Debug)]
pub struct Setting<'a> {
    /// The plan, of which only the input is read.
    pub plan: &'a Plan,
    /// The surfaces.
    pub world: &'a World,
    /// When to look, in s, ascending.
    pub times: &'a [f64],
}

/// Follows `ball` in its `field`, its start moved by `shift` (m).
pub fn follow(setting: &Setting, ball: &Ball, field: &Field, shift: &Vector) -> Course {
    let plan = setting.plan;
    let start = ball.start();
    let mut walker = Walker {
        setting,
        ball,
        field: field.clone(),
        planes: setting.world.planes(&start.position, &start.velocity),
        radius: Real::from(ball.radius()),
        face_radius: Real::from(plan.radius_at_meshes(ball)),
        touch: Real::from(plan.farthest.max(f64::MIN_POSITIVE) * 2f64.powi(-100)),
        x: add(&point(&start.position), shift),
        v: vector(&start.velocity),
        t: Real::zero(),
        course: Course { samples: Vec::new(), impacts: Vec::new(), rest: None, until: 0.0, reach: Reach::Complete },
    };
    let reach = walker.run();
    walker.course.reach = reach;
    walker.course.until = if reach == Reach::Complete { plan.duration } else { walker.t.to_f64() };
    walker.course
}

struct Walker<'a> {
    setting: &'a Setting<'a>,
    ball: &'a Ball,
    field: Field,
    planes: Vec<(usize, Obstacle)>,
    radius: Real,
    face_radius: Real,
    touch: Real,
    x: Vector,
    v: Vector,
    t: Real,
    course: Course,
}

/// What a flight comes to.
enum Arrival {
    Nothing,
    Hit(Real),
    Lasting(Real),
    Undecided(Real),
}

impl Walker<'_> {
    fn run(&mut self) -> Reach {
        for _ in 0..MAX_FLIGHTS {
            let remaining = &Real::from(self.setting.plan.duration) - &self.t;
            if remaining <= Real::zero() {
                return Reach::Complete;
            }
            // Rounded up: what is left is less than the rounding of an f64.
            let flight = self.field.fly(&self.x, &self.v, &self.t, remaining.to_f64().next_up());
            match self.arrival(&flight) {
                Arrival::Nothing => self.travel(&flight, &Real::from(flight.seconds)),
                Arrival::Undecided(t) => {
                    self.travel(&flight, &t);
                    return Reach::Undecided;
                }
                Arrival::Lasting(t) => {
                    self.travel(&flight, &t);
                    return self.last();
                }
                Arrival::Hit(t) => {
                    self.travel(&flight, &t);
                    if let Some(reach) = self.answer() {
                        return reach;
                    }
                }
            }
        }
        Reach::Budget
    }

    /// Moves along `flight` for `t`, looking at the sample times on the way.
    fn travel(&mut self, flight: &Flight, t: &Real) {
        let end = &self.t + t;
        while let Some(&time) = self.setting.times.get(self.course.samples.len()) {
            let time = Real::from(time);
            if time > end {
                break;
            }
            let after = &time - &self.t;
            self.course.samples.push([flight.position(&after), flight.velocity(&after)]);
        }
        (self.x, self.v, self.t) = (flight.position(t), flight.velocity(t), end);
    }

    /// The earliest meeting on `flight`.
    fn arrival(&self, flight: &Flight) -> Arrival {
        let mut to = Real::from(flight.seconds);
        let mut arrival = Arrival::Nothing;
        let mut take = |met: Meeting, to: &mut Real| {
            let (t, found) = match met {
                Meeting::Never => return,
                Meeting::Hit(t) => (t.clone(), Arrival::Hit(t)),
                Meeting::Lasting(t) => (t.clone(), Arrival::Lasting(t)),
                Meeting::Undecided(t) => (t.clone(), Arrival::Undecided(t)),
            };
            if t < *to {
                (*to, arrival) = (t, found);
            }
        };
        for (_, plane) in &self.planes {
            take(plane.meet(flight, &self.radius, &Real::zero(), &to, &self.touch), &mut to);
        }
        if self.setting.world.has_faces() {
            let mut from = Real::zero();
            while from < to {
                let piece = self.piece(flight, &from, &to);
                let end = &from + &Real::from(piece);
                let x = rounded(&flight.position(&from));
                let speed = norm(&flight.velocity(&from)).to_f64();
                let near = (speed + flight.bend * piece) * piece + self.face_radius.to_f64();
                // A little more than the rounding of f64.
                let reach = near + 2f64.powi(-40) * (near + x.amax());
                for (_, face) in self.setting.world.near(&x, reach) {
                    let until = if end < to { &end } else { &to };
                    let until = until.clone();
                    take(face.meet(flight, &self.face_radius, &from, &until, &self.touch), &mut to);
                }
                from = end;
            }
        }
        arrival
    }

    /// A piece of a flight, in s, in which the ball passes a few triangles.
    fn piece(&self, flight: &Flight, from: &Real, to: &Real) -> f64 {
        let left = (to - from).to_f64();
        let distance = 2.0 * self.setting.world.cell();
        let speed = norm(&flight.velocity(from)).to_f64();
        // Of a flight as long as an age, no more pieces than can be looked at.
        let least = flight.seconds / 65_536.0;
        let fast = distance / (speed + (flight.bend * distance).sqrt());
        fast.max(least).min(left.max(f64::MIN_POSITIVE))
    }

    /// What the ball touches now, with its rate and surface.
    fn touched(&self) -> Vec<(usize, Vector, Real)> {
        // Two surfaces that are met at once are met to the digits of the flight.
        let touch = &self.touch * &Real::from(1024.0);
        let x = rounded(&self.x);
        let reach = self.face_radius.to_f64() + 2f64.powi(-30) * (x.amax() + self.face_radius.to_f64());
        let faces = self.setting.world.near(&x, reach).into_iter().map(|(s, face)| (s, face, &self.face_radius));
        let planes = self.planes.iter().map(|(s, plane)| (*s, plane, &self.radius));
        let mut touched: Vec<(usize, Vector, Real)> = Vec::new();
        for (surface, obstacle, radius) in planes.chain(faces) {
            let (gap, n) = obstacle.gap(&self.x, radius);
            if gap > touch {
                continue;
            }
            // Faces that share what is touched, or lie in one plane, are one.
            let same = |other: &Vector| norm(&sub(other, &n)).to_f64() < 2f64.powi(-40);
            if !touched.iter().any(|(_, other, _)| same(other)) {
                let rate = dot(&n, &self.v);
                touched.push((surface, n, rate));
            }
        }
        touched
    }

    fn material(&self, surface: usize) -> Material {
        let material = self.setting.plan.surfaces[surface].material;
        Material { restitution: material.restitution.for_ball(self.ball), ..material }
    }

    /// The chapter's response; says why the course ends, if it does.
    fn answer(&mut self) -> Option<Reach> {
        let touched = self.touched();
        let mut closing = touched.iter().filter(|(_, _, rate)| *rate < Real::zero());
        let (Some((surface, n, rate)), None) = (closing.next(), closing.next()) else {
            return Some(Reach::Simultaneous);
        };
        let material = self.material(*surface);
        self.course.impacts.push(Impact { time: self.t.clone(), surface: *surface });
        let speed = -rate;
        let c_r = restitution(&material, &speed);
        let v_t = sub(&self.v, &scale(n, rate));
        let v_t = match &material.friction {
            Friction::Grip(grip) => self.turn(grip, n, &v_t, &(&speed * &(&Real::from(1.0) + &c_r))),
            friction => slow(friction, &v_t, &speed, &c_r),
        };
        let rebound = &speed * &c_r;
        self.v = add(&v_t, &scale(n, &rebound));
        if touched.iter().any(|(_, other, _)| dot(other, &self.v) < -(&self.touch)) {
            return Some(Reach::Simultaneous);
        }
        if self.course.impacts.len() >= MAX_IMPACTS {
            return Some(Reach::Budget);
        }
        // Hops below the last digits of f64 are summed.
        let pressed = -dot(n, &self.field.acceleration(&self.v, &self.t));
        let hop = &(&rebound * &rebound) / &(&pressed + &pressed);
        let tiny = Real::from(self.setting.plan.farthest * 2f64.powi(-64));
        let ends = pressed > Real::zero() && material.restitution.coefficient() < 1.0 && hop <= tiny;
        ends.then(|| self.last())
    }

    /// v_t after a surface of unit normal `n` that grips has taken the normal momentum `impulse` (m/s) per mass; it turns the ball. The point of
    /// contact moves with u = v_t - r omega x n, and friction takes what turns it into -e_x u, or mu times the impulse if that is less.
    fn turn(&mut self, grip: &Grip, n: &Vector, v_t: &Vector, impulse: &Real) -> Vector {
        let spin = self.field.spin(&self.t);
        let u = sub(v_t, &scale(&cross(&spin, n), &self.radius));
        let (one, alpha) = (Real::from(1.0), Real::from(self.ball.inertia()));
        let grips = &(&alpha * &(&one + &Real::from(grip.tangential()))) / &(&one + &alpha);
        let (speed, most) = (norm(&u), &Real::from(grip.friction()) * impulse);
        let share = if &speed * &grips <= most { grips } else { &most / &speed };
        let kick = scale(&u, &-&share);
        let lever = &alpha * &self.radius;
        let turned = sub(&spin, &scale(&cross(n, &kick), &(&one / &lever)));
        self.field = self.field.clone().spun(&turned, &self.t);
        add(v_t, &kick)
    }

    /// Lasting contact to the end of the scene, as far as it has a closed form.
    fn last(&mut self) -> Reach {
        let touched = self.touched();
        let [(surface, n, rate)] = touched.as_slice() else { return Reach::Simultaneous };
        let material = self.material(*surface);
        if matches!(material.friction, Friction::Grip(_)) {
            return Reach::Sliding;
        }
        let on_plane = self.planes.iter().any(|(s, _)| s == surface);
        let duration = Real::from(self.setting.plan.duration);
        let settled = settle(&self.field, n, rate, &material, &self.v, &self.t, &(&duration - &self.t), on_plane);
        let Settled { pieces, rest, complete } = settled;
        for (acceleration, velocity, seconds) in pieces {
            let half = scale(&acceleration, &Real::from(0.5));
            let flight = Flight::parabola(&self.x, &velocity, &half, seconds.to_f64());
            self.travel(&flight, &seconds);
        }
        if rest {
            self.v = vector(&Vector3::zeros());
            self.course.rest = Some(self.t.to_f64());
            let flight = Flight::parabola(&self.x, &self.v, &self.v, self.setting.plan.duration);
            self.travel(&flight, &(&duration - &self.t));
            return Reach::Complete;
        }
        if complete { Reach::Complete } else { Reach::Sliding }
    }
}

/// c_r at a closing speed.
fn restitution(material: &Material, closing: &Real) -> Real {
    let c_r = Real::from(material.restitution.coefficient());
    match material.restitution.falls_above().map(Real::from) {
        Some(above) if *closing > above => &c_r * &(&above / closing).sqrt().sqrt(),
        _ => c_r,
    }
}

/// v_t after an impact or a series of them with the closing speed `closing` (m/s) in all.
pub fn slow(friction: &Friction, v_t: &Vector, closing: &Real, c_r: &Real) -> Vector {
    let less = |amount: &Real| {
        let speed = norm(v_t);
        if speed <= *amount {
            return [Real::zero(), Real::zero(), Real::zero()];
        }
        scale(v_t, &(&(&speed - amount) / &speed))
    };
    match friction {
        // What grips turns the ball as well.
        Friction::None | Friction::Grip(_) => v_t.clone(),
        Friction::Linear(c_f) => scale(v_t, &(Real::from(1.0) - Real::from(c_f.get()))),
        Friction::Coulomb(mu) => less(&(&Real::from(mu.get()) * closing)),
        Friction::Impulse(mu) => {
            let one_and_c_r = &Real::from(1.0) + c_r;
            less(&(&(&Real::from(mu.get()) * &one_and_c_r) * closing))
        }
    }
}
