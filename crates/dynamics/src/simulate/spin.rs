//! Spin: what surfaces that grip make of it, at impacts, in slipping and in rolling.

use super::Walk;
use super::flight::Closing;
use crate::body::State;
use crate::contacts::Contact;
use crate::effects::friction::Friction;
use crate::effects::grip::{self, Grip};
use crate::events::{EventKind, Motion};
use crate::integrators::{Step, exact};
use crate::observer::Observer;
use crate::response::{changed_rate, respond};
use crate::sliding::{Balance, Carrier, Slide};
use crate::tolerance::{parallel, rate_rounding};
use crate::turning::Turning;
use carom_geometry::site::Bend;
use nalgebra::Vector3;

/// A share of the time in which friction ends the slipping: a step no longer than this keeps the direction of slipping, and comes to its end.
const SHARE_OF_SLIP: f64 = 0.5;

/// A ball that slips along a surface which would rather have it roll.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slip {
    /// How the point of contact moves, in m/s.
    u: Vector3<f64>,
    /// The direction in which it slips, or begins to.
    direction: Vector3<f64>,
    /// What friction takes, in m/s^2.
    friction: f64,
    /// The velocity at the start of the stretch.
    velocity: Vector3<f64>,
    /// What would accelerate it without friction, in m/s^2.
    free: Vector3<f64>,
    /// The normal of the surface.
    normal: Vector3<f64>,
}

impl<O: Observer> Walk<'_, O> {
    /// At the impact that `velocity_in` came to with the `closing` contacts: what those that grip make of velocity and spin.
    ///
    /// The normal momentum of each is what the impact has changed along its normal; where friction drives the ball into another contact, that
    /// answers again.
    pub(super) fn grip(&mut self, velocity_in: Vector3<f64>, closing: Closing) {
        let (ball, surfaces) = (self.forces.ball, self.surfaces);
        let change = self.state.velocity - velocity_in;
        for i in (0..self.contacts.len()).filter(|&i| closing.has(i)) {
            let Friction::Grip(grip) = surfaces[self.contacts[i].surface].material.friction else { continue };
            let n = self.contacts[i].normal;
            let u = grip::slip(ball, &self.state.velocity, &self.forces.body.spin, &n);
            let kick = grip.kick(&u, ball.inertia(), n.dot(&change).max(0.0));
            self.counters.friction += 1;
            let before = self.state.velocity;
            self.kick(&kick, &n);
            for contact in self.contacts.iter_mut() {
                contact.rate = changed_rate(contact, &before, &self.state.velocity);
            }
        }
        if self.contacts.iter().any(|c| c.rate < 0.0) {
            let material = |c: &Contact| &surfaces[c.surface].material;
            self.state.velocity = respond(self.state.velocity, self.contacts, material, &mut self.counters);
        }
    }

    /// Adds a tangential `kick` at a surface of normal `n` to velocity and spin.
    fn kick(&mut self, kick: &Vector3<f64>, n: &Vector3<f64>) {
        self.forces.body.spin = grip::turned(self.forces.ball, &self.forces.body.spin, kick, n);
        self.state.velocity += kick;
    }

    /// What all the impacts of a bouncing that ends on `contact`, the first with the closing speed `closing` (m/s), make of velocity and spin.
    pub(super) fn grip_to_the_end(&mut self, contact: &Contact, grip: &Grip, closing: f64, c_r: f64) {
        let ball = self.forces.ball;
        let u = grip::slip(ball, &self.state.velocity, &self.forces.body.spin, &contact.normal);
        let kick = grip.kick_to_the_end(&u, ball.inertia(), (1.0 + c_r) * closing / (1.0 - c_r));
        self.kick(&kick, &contact.normal);
    }

    /// How a ball in lasting contact slips, or none if it does not spin, rolls, or nothing alone grips it.
    ///
    /// It rolls when its point of contact is at rest, to within the speed of the rest test, and friction can keep it so.
    pub(super) fn slipping(&self, carriers: &[Carrier], balance: &Balance) -> Option<Slip> {
        let [Carrier { contact, .. }] = carriers else { return None };
        let Friction::Grip(grip) = self.surfaces[contact.surface].material.friction else { return None };
        let ball = self.forces.ball;
        let (velocity, spin, normal) = (self.state.velocity, self.forces.body.spin, contact.normal);
        let u = grip::slip(ball, &velocity, &spin, &normal);
        let load: f64 = balance.loads.loads().map(|(_, load)| load).sum();
        let (friction, free) = (grip.friction() * load, balance.free);
        let rounding = rate_rounding(velocity.norm() + ball.radius() * spin.norm());
        let direction = if u.norm() > rounding.max(self.plan.rest.at(load).speed) {
            u.try_normalize(0.0)
        } else if free.norm() * ball.inertia() > friction * (1.0 + ball.inertia()) {
            free.try_normalize(0.0)
        } else {
            None
        };
        direction.map(|direction| Slip { u, direction, friction, velocity, free, normal })
    }

    /// One stretch of slipping: to its end, where the direction does not turn; else for a part of the time that is left of it.
    pub(super) fn slip(&mut self, slip: &Slip, carriers: &[Carrier], remaining: f64) -> Slide {
        self.counters.paths += 1;
        let more = 1.0 + 1.0 / self.forces.ball.inertia();
        let flat = carriers.iter().all(|c| c.bend == Bend::Flat);
        let speed = slip.u.norm();
        if flat && self.forces.are_constant() && (speed == 0.0 || parallel(&slip.free, &slip.u)) {
            let a = slip.free - slip.direction * slip.friction;
            let braking = more * slip.friction - slip.free.dot(&slip.direction);
            let mut step = exact::step(&self.state, a, remaining);
            if speed > 0.0 && braking > 0.0 && speed / braking < remaining {
                step.to = (speed / braking) / step.seconds;
            }
            return Slide { step, stops: false };
        }
        let longest = SHARE_OF_SLIP * speed.max(self.plan.rest.at(slip.friction).speed)
            / (more * slip.friction + slip.free.norm());
        let (forces, counters) = (&self.forces, &mut self.counters);
        let step = self.slider.step(&self.state, longest.min(remaining), |s, after| {
            let balance = Balance::of(&forces.acceleration_after(s, after, counters), carriers, s);
            // The spin follows from the momentum that friction has given; what else accelerates is taken as it was at the start.
            let u = slip.u + (s.velocity - slip.velocity) * more - slip.free * (after * (more - 1.0));
            balance.free - u.try_normalize(0.0).unwrap_or(slip.direction) * slip.friction
        });
        Slide { step, stops: false }
    }

    /// Whether one of `carriers` grips: then a ball that does not slip rolls (in a groove as on a plane, which is not quite so).
    pub(super) fn is_gripped(&self, carriers: &[Carrier]) -> bool {
        let friction = |c: &Carrier| self.surfaces[c.contact.surface].material.friction;
        carriers.iter().any(|c| matches!(friction(c), Friction::Grip(_)))
    }

    /// At rest on `contact`: what grips has stopped the ball from turning.
    pub(super) fn stop_turning(&mut self, contact: &Contact) {
        if matches!(self.surfaces[contact.surface].material.friction, Friction::Grip(_)) {
            self.forces.body.spin = Vector3::zeros();
        }
    }

    /// Whether a ball that has come to rest still turns against what it rests on, so that it is not at rest.
    pub(super) fn turns_on(&self, carriers: &[Carrier], threshold: f64) -> bool {
        let [Carrier { contact, .. }] = carriers else { return false };
        let spin = self.forces.body.spin;
        matches!(self.surfaces[contact.surface].material.friction, Friction::Grip(_))
            && grip::slip(self.forces.ball, &self.state.velocity, &spin, &contact.normal).norm() > threshold
    }

    /// The spin during a stretch of `step` to `to`.
    pub(super) fn turning(&self, step: &Step, to: f64, motion: Motion, slip: Option<&Slip>) -> Turning {
        let (ball, spin) = (self.forces.ball, self.forces.body.spin);
        let end: State = step.at(to);
        let lasting = self.contacts.iter().find(|c| c.lasting);
        let to = match (motion, slip, lasting) {
            (Motion::Rolling, _, Some(contact)) => grip::rolling(ball, &end.velocity, &spin, &contact.normal),
            (Motion::Sliding, Some(slip), _) => {
                let given = end.velocity - slip.velocity - slip.free * step.time(to);
                grip::turned(ball, &spin, &given, &slip.normal)
            }
            _ => return Turning { from: spin, to: spin, decay: self.forces.decay },
        };
        Turning { from: spin, to, decay: None }
    }

    /// Tells that slipping has ended, if the ball rolls now and did not before.
    pub(super) fn begin_rolling(&mut self, rolls: bool) {
        if rolls
            && !std::mem::replace(&mut self.rolls, rolls)
            && let Some(contact) = self.contacts.iter().find(|c| c.lasting).copied()
        {
            self.tell(EventKind::Roll, &contact, self.state.velocity);
        }
        self.rolls = rolls;
    }
}
