//! The checks of events: contact, the laws of impact, and what carries a ball at rest.

use super::{Checker, Flaw};
use crate::world::U;
use carom_dynamics::body::State;
use carom_dynamics::effects::friction::{ContactFriction, Friction};
use carom_dynamics::events::{Event, EventKind};
use nalgebra::{Point3, Vector3};

/// How much of `change` no sum of the `touched` normals is, and the sine of the angle between these, if they are known to `angle`; none if they push in
/// all directions, or two of them in directions that may be one.
fn beside(change: &Vector3<f64>, touched: &[(Vector3<f64>, usize)], angle: f64) -> Option<(f64, f64)> {
    let mut spanned: Vec<Vector3<f64>> = Vec::new();
    let mut sine = 1.0f64;
    let rest = |v: &Vector3<f64>, spanned: &[Vector3<f64>]| spanned.iter().fold(*v, |rest, b| rest - b * b.dot(&rest));
    for (n, _) in touched {
        let new = rest(n, &spanned);
        if new.norm() > angle {
            sine = sine.min(new.norm());
            spanned.push(rest(&new.normalize(), &spanned).normalize());
        } else if new.norm() > 64.0 * U {
            return None;
        }
    }
    (spanned.len() < 3).then(|| (rest(change, &spanned).norm(), sine))
}

impl Checker<'_> {
    /// The directions from all that is touched at `x`, and how much is granted.
    fn touched(&self, x: &Point3<f64>, slack: f64) -> Vec<(Vector3<f64>, usize)> {
        let reach = self.mesh_reach + slack;
        let margin = Vector3::repeat(reach);
        let mut all: Vec<(Vector3<f64>, usize)> = Vec::new();
        for i in self.world.near(&(x - margin), &(x + margin)) {
            let w = -self.world.to_triangle(i, x);
            if w.norm() <= reach && w.norm() > 0.0 {
                all.push((w.normalize(), self.world.triangles[i as usize].1));
            }
        }
        for (p, n, surface) in &self.world.planes {
            let d = n.dot(&(x - p));
            if d.abs() <= self.radius + slack {
                let i = self.world.planes.iter().position(|q| q.2 == *surface).unwrap_or(0);
                all.push((n * self.sides[i], *surface));
            }
        }
        all
    }

    pub(super) fn events(&mut self, state: &mut State, group: &[Event]) {
        for (i, e) in group.iter().enumerate() {
            let exact = self.scene.drag.is_none();
            let slack = self.slack(&e.position, 0.0) * 4.0;
            let touched = self.touched(&e.position, slack);
            let speed = e.velocity_in.norm();
            let rounding = 256.0 * U * speed + f64::MIN_POSITIVE;
            if matches!(e.kind, EventKind::Impact | EventKind::Rest | EventKind::Slide) {
                if touched.is_empty() {
                    let r = self.mesh_radius;
                    let d = self.world.distance(&e.position, 1e3 * r);
                    self.note(Flaw::FalseContact, 1.0, 0.5, || {
                        format!("{:?} at {:?}: {d:e} from the nearest, r = {:e}", e.kind, e.position, r)
                    });
                } else {
                    let away = touched.iter().map(|(n, _)| (n - e.normal).norm()).fold(2.0, f64::min);
                    let angle = (64.0 * slack / self.mesh_radius).sqrt() + 1e-12;
                    self.note(Flaw::Normal, away, angle, || format!("{e:?}"));
                }
            }
            if e.kind == EventKind::Impact {
                let same = |o: &Event| {
                    o.kind == EventKind::Impact && o.velocity_in == e.velocity_in && o.velocity == e.velocity
                };
                let together = group.iter().filter(|o| same(o)).count();
                let first = group.iter().position(same) == Some(i);
                if first {
                    let jump = (e.velocity_in - state.velocity).norm();
                    let reach = self.world.farthest.max(e.position.coords.amax()) + self.radius;
                    // Around a small ball, rounding of its position turns the normal that the velocity is held along.
                    let turn = slack / self.mesh_radius;
                    let allowed = (1e-9 + turn) * speed + (8192.0 * U * self.gravity.norm() * reach).sqrt();
                    self.note(Flaw::Velocity, jump, allowed, || format!("{:?} -> {:?}", state.velocity, e.velocity_in));
                    let gain = e.velocity.norm_squared() - e.velocity_in.norm_squared();
                    self.note(Flaw::EnergyUp, gain, 64.0 * U * speed * speed, || format!("at impact {e:?}"));
                }
                state.velocity = e.velocity;
                let angle =
                    (64.0 * (slack + self.mesh_reach - self.mesh_radius) / self.mesh_radius).sqrt().min(0.2) + 1e-9;
                let alone = together == 1 && touched.iter().all(|(n, _)| (n - e.normal).norm() <= angle);
                if first && touched.iter().all(|(_, s)| self.scene.surfaces[*s].material.friction == Friction::None) {
                    let change = e.velocity - e.velocity_in;
                    // The normals of planes do not depend on where the ball is.
                    let is_plane = |surface: usize| self.world.planes.iter().any(|q| q.2 == surface);
                    let angle = if touched.iter().all(|(_, s)| is_plane(*s)) { 64.0 * U } else { angle };
                    if let Some((off, sine)) = beside(&change, &touched, angle) {
                        let allowed = (rounding + angle * change.norm()) / sine;
                        self.note(Flaw::Push, off, allowed, || format!("{e:?}, touched {touched:?}"));
                    }
                }
                if alone && exact {
                    let m = &self.scene.surfaces[e.surface].material;
                    let c_r = m.restitution.coefficient();
                    let (a, b) = (e.normal.dot(&e.velocity_in), e.normal.dot(&e.velocity));
                    self.note(Flaw::Restitution, (b + c_r * a).abs(), rounding, || format!("{e:?}"));
                    let (ta, tb) = (e.velocity_in - e.normal * a, e.velocity - e.normal * b);
                    let cut = match m.friction {
                        Friction::None => 0.0,
                        Friction::Linear(c) => c.get() * ta.norm(),
                        Friction::Coulomb(mu) => mu.get() * -a,
                        // What turns the ball is not told by its velocity.
                        Friction::Grip(_) => (ta - tb).norm(),
                        Friction::Impulse(mu) => mu.get() * (1.0 + c_r) * -a,
                    };
                    let want = if ta.norm() > cut { ta * (1.0 - cut / ta.norm()) } else { Vector3::zeros() };
                    self.note(Flaw::Friction, (tb - want).norm(), rounding * 4.0, || format!("{e:?} want {want:?}"));
                }
            }
            if e.kind == EventKind::Slide {
                let gain = e.velocity.norm_squared() - e.velocity_in.norm_squared();
                self.note(Flaw::EnergyUp, gain, 64.0 * U * speed * speed, || format!("where sliding begins {e:?}"));
                state.velocity = e.velocity;
            }
            if e.kind == EventKind::Rest {
                state.velocity = Vector3::zeros();
            }
        }
    }

    /// A resting ball: what it touches can carry its weight, and friction what is left of it.
    pub(super) fn support(&mut self, state: &State) {
        let slack = self.slack(&state.position, 0.0) * 4.0;
        let touched = self.touched(&state.position, slack);
        let g = self.gravity;
        if touched.is_empty() {
            self.note(Flaw::Hovering, 1.0, 0.5, || format!("rests at {:?}", state.position));
            return;
        }
        if self.scene.drag.is_some() {
            return;
        }
        // Gauss's principle by Gauss and Seidel: loads >= 0 that leave as little acceleration as can be.
        let mut loads = vec![0.0; touched.len()];
        let mut left = g;
        for _ in 0..20_000 {
            for ((n, _), load) in touched.iter().zip(&mut loads) {
                let more: f64 = -n.dot(&left);
                let new = (*load + more).max(0.0);
                left += n * (new - *load);
                *load = new;
            }
        }
        let mut friction = 0.0;
        for ((_, surface), load) in touched.iter().zip(&loads) {
            match self.scene.surfaces[*surface].material.friction.in_contact() {
                ContactFriction::Sliding(mu) => friction += mu * load,
                ContactFriction::Sticking if *load > 0.0 => return,
                ContactFriction::Sticking => {}
            }
        }
        let angle = (64.0 * slack / self.mesh_radius).sqrt() + 1e-9;
        self.note(Flaw::Unsupported, left.norm() - friction, angle * g.norm() + f64::MIN_POSITIVE, || {
            format!("left {left:?}, friction {friction:e}, {} touched at {:?}", touched.len(), state.position)
        });
    }
}
