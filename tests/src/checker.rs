//! An independent check of a finished run: brute force over samples, sharing nothing with the solver but the polynomials it left.
//!
//! Bounds. A position is right to 64 u (L + travel), and where it is known to touch, to that much again; the support planes add 32 u of
//! the same. So 256 u (L + travel), with L the largest coordinate that enters, is granted to a flight. The centre of a ball that slides
//! around an edge follows a circle to 1e-10 of its radius a step, and a flight may begin from there.

mod laws;

use crate::world::{U, World};
use carom_dynamics::body::{Ball, State};
use carom_dynamics::events::{Event, Motion, Outcome};
use carom_dynamics::observer::{Segment, Trajectory};
use carom_dynamics::scene::{Method, Scene};
use nalgebra::{Point3, Vector3};

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Flaw {
    /// A number that is none.
    NotFinite,
    /// A segment begins where the last one did not end.
    Gap,
    /// A segment begins when the last one did not end.
    TimeGap,
    /// The ball is nearer to a surface than its radius.
    Penetration,
    /// The ball is on the other side of a closed surface.
    WrongSide,
    /// An impact where nothing is touched.
    FalseContact,
    /// A normal that is not the direction from the touched point to the centre.
    Normal,
    /// v_n+ is not -c_r v_n-.
    Restitution,
    /// v_t+ is not what the friction law makes of v_t-.
    Friction,
    /// An impact without friction pushes where no touched normal does.
    Push,
    /// Velocity before an impact is not that at the end of the flight.
    Velocity,
    /// Energy grew.
    EnergyUp,
    /// Energy of an exact flight changed.
    Conservation,
    /// The ball slides or rests on nothing.
    Hovering,
    /// The ball rests where its weight would move it.
    Unsupported,
}

/// Something wrong, by how much, and how much was allowed.
#[derive(Debug, Clone)]
pub struct Finding {
    /// What.
    pub flaw: Flaw,
    /// When, in s.
    pub time: f64,
    /// In the unit of the flaw.
    pub amount: f64,
    /// In the same unit.
    pub allowed: f64,
    /// Where and how.
    pub note: String,
}

/// A share of the radius that a ball sliding around edges may be off its circle.
const SLIDE_SHARE: f64 = 1e-9;

/// Checks one ball's run.
pub struct Checker<'a> {
    world: &'a World,
    scene: &'a Scene,
    radius: f64,
    mesh_radius: f64,
    /// The most it may be: a point's stand-in is measured by the scene.
    mesh_reach: f64,
    gravity: Vector3<f64>,
    sides: Vec<f64>,
    /// What went wrong.
    pub findings: Vec<Finding>,
    /// The largest amount / allowed of each flaw that was looked for.
    pub worst: std::collections::BTreeMap<Flaw, f64>,
    slid: bool,
    /// The last stretch stood for the last hops of a bouncing; friction then acts at its end without an impact.
    settled: bool,
    now: f64,
}

impl<'a> Checker<'a> {
    /// Checks the run of `ball` in `scene`, whose surfaces are `world`.
    pub fn run(world: &'a World, scene: &'a Scene, ball: &Ball, run: &Trajectory, outcome: &Outcome) -> Self {
        let start = ball.start();
        let gravity = scene.gravity.map_or(Vector3::zeros(), |g| g.acceleration());
        let side = |(p, n, _): &(Point3<f64>, Vector3<f64>, usize)| {
            let (d, v, a) = (n.dot(&(start.position - p)), n.dot(&start.velocity), -n.dot(&gravity));
            [d, v, a].into_iter().find(|x| *x != 0.0).map_or(1.0, f64::signum)
        };
        let farthest = scene.balls.iter().fold(world.farthest, |m, b| m.max(b.start().position.coords.amax()));
        let mesh_radius = ball.radius().max(16384.0 * U * farthest);
        let point = ball.radius() < mesh_radius * (1.0 - U) || ball.radius() == 0.0;
        let mut checker = Self {
            world,
            scene,
            radius: ball.radius(),
            mesh_radius,
            mesh_reach: if point { 4.0 * mesh_radius } else { mesh_radius },
            gravity,
            sides: world.planes.iter().map(side).collect(),
            findings: Vec::new(),
            worst: Default::default(),
            slid: false,
            settled: false,
            now: 0.0,
        };
        checker.check(start, run, outcome);
        checker
    }

    fn note(&mut self, flaw: Flaw, amount: f64, allowed: f64, note: impl FnOnce() -> String) {
        let ratio = if amount <= 0.0 { 0.0 } else { amount / allowed };
        let worst = self.worst.entry(flaw).or_insert(0.0);
        *worst = worst.max(ratio);
        if ratio > 1.0 || ratio.is_nan() {
            self.findings.push(Finding { flaw, time: self.now, amount, allowed, note: note() });
        }
    }

    /// How much a position may be off.
    fn slack(&self, x: &Point3<f64>, travel: f64) -> f64 {
        let slid = if self.slid { SLIDE_SHARE * self.mesh_radius } else { 0.0 };
        256.0 * U * (self.world.farthest.max(x.coords.amax()) + self.radius + travel) + slid
    }

    fn energy(&self, s: &State) -> f64 {
        0.5 * s.velocity.norm_squared() - self.gravity.dot(&s.position.coords)
    }

    /// What rounding of positions and velocities does to an energy.
    fn energy_slack(&self, s: &State, share: f64) -> f64 {
        let reach = self.world.farthest.max(s.position.coords.amax()) + self.radius;
        share * (s.velocity.norm_squared() + self.gravity.norm() * reach)
    }

    fn check(&mut self, start: State, run: &Trajectory, outcome: &Outcome) {
        let exact = matches!(self.scene.method, None | Some(Method::Exact)) && self.scene.drag.is_none();
        let still_air = self.scene.drag.is_none_or(|d| d.wind() == Vector3::zeros());
        let first_order = matches!(self.scene.method, Some(Method::Euler { .. } | Method::SemiImplicitEuler { .. }));
        let share = match self.scene.method {
            _ if exact => 512.0 * U,
            Some(Method::Rk4 { step }) => 1e-6 * step.max(1e-3),
            _ => 1e-7,
        };
        let mut state = start;
        let mut time = 0.0;
        let mut events = run.events.iter().peekable();
        let mut highest = self.energy(&start);
        let around = self.world.winding(&start.position);
        let closed = self.world.planes.is_empty() && (around - around.round()).abs() < 1e-6;
        let every = (run.segments.len() / 8).max(1);
        for (k, segment) in run.segments.iter().enumerate() {
            let mut group: Vec<Event> = Vec::new();
            while let Some(e) = events.next_if(|e| e.time <= segment.time) {
                group.push(*e);
            }
            self.now = segment.time;
            self.events(&mut state, &group);
            self.continuity(&state, time, segment);
            let begin = segment.step.at(0.0);
            let slack = self.energy_slack(&begin, share);
            let e = self.energy(&begin);
            if still_air && !first_order {
                self.note(Flaw::EnergyUp, e - highest, slack, || format!("at segment {k}: {begin:?}"));
                highest = highest.min(e);
            }
            self.slid |= segment.motion == Motion::Sliding;
            self.stretch(segment, k);
            let end = segment.step.at(segment.to);
            let e1 = self.energy(&end);
            let slack = self.energy_slack(&begin, share) + self.energy_slack(&end, share);
            if still_air && !first_order {
                self.note(Flaw::EnergyUp, e1 - highest, slack, || {
                    format!("in segment {k} {:?}: {end:?}", segment.motion)
                });
                highest = highest.min(e1);
            }
            // A settling ball flies along its surface.
            let bent = segment.step.velocity[1] != self.gravity * segment.step.seconds;
            self.settled = segment.motion == Motion::Flying && bent && segment.step.exact;
            if exact && segment.motion == Motion::Flying && !self.settled {
                self.note(Flaw::Conservation, (e1 - e).abs(), slack, || format!("in segment {k}"));
            }
            if closed && (k % every == 0 || k + 1 == run.segments.len()) {
                let now = self.world.winding(&end.position);
                if (now - now.round()).abs() < 1e-3 {
                    self.note(Flaw::WrongSide, (now.round() - around.round()).abs(), 0.5, || {
                        format!("{:?}", end.position)
                    });
                }
            }
            state = end;
            time = segment.end;
        }
        self.now = outcome.time;
        let group: Vec<Event> = events.copied().collect();
        self.events(&mut state, &group);
        if outcome.motion == Motion::Resting {
            self.support(&outcome.state);
        }
    }

    fn continuity(&mut self, state: &State, time: f64, segment: &Segment) {
        let begin = segment.step.at(0.0);
        let end = segment.step.at(segment.to);
        let finite = |s: &State| s.position.iter().chain(s.velocity.iter()).all(|x| x.is_finite());
        if !(finite(&begin) && finite(&end) && segment.time.is_finite() && segment.end.is_finite()) {
            self.note(Flaw::NotFinite, 1.0, 0.5, || format!("{segment:?}"));
        }
        let gap = (begin.position - state.position).norm();
        let slack = self.slack(&begin.position, 0.0);
        self.note(Flaw::Gap, gap, slack, || {
            format!("{:?} -> {:?} {:?}", state.position, begin.position, segment.motion)
        });
        let late = (segment.time - time).abs();
        self.note(Flaw::TimeGap, late, 8.0 * U * time + f64::MIN_POSITIVE, || format!("{time} -> {}", segment.time));
    }

    /// No sample, and no nearest approach between samples, is nearer than allowed.
    fn stretch(&mut self, segment: &Segment, k: usize) {
        let path = &segment.step.path;
        let start = path.start();
        // Own evaluation, term by term.
        let at = |f: f64| {
            let (mut x, mut power) = (start, 1.0);
            for term in path.terms() {
                power *= f;
                x += term * power;
            }
            x
        };
        let length: f64 = (0..16)
            .map(|i| (at(segment.to * f64::from(i + 1) / 16.0) - at(segment.to * f64::from(i) / 16.0)).norm())
            .sum();
        let pieces = match segment.motion {
            Motion::Resting => 1,
            // Each piece is searched once more inside; a short step needs few.
            _ if length < self.mesh_radius.min(0.01 * self.world.farthest) => 8,
            _ => 32.0f64.max((length / self.mesh_radius.max(0.02 * self.world.farthest)).min(512.0)) as usize,
        };
        let (r, travel) = (self.mesh_radius, length);
        let slack = self.slack(&start, travel);
        let mut from = (0.0, start);
        for i in 1..=pieces {
            let f = segment.to * i as f64 / pieces as f64;
            let x = at(f);
            for p in 0..self.world.planes.len() {
                let (point, n, _) = self.world.planes[p];
                let side = self.sides[p];
                let radius = self.radius;
                let (s, short) = least(from.0, f, |f| side * n.dot(&(at(f) - point)) - radius);
                self.note(Flaw::Penetration, -short, slack, || {
                    format!(
                        "plane {p}, segment {k} {:?} at f = {s:e} of {:e}, motion {length:e}",
                        segment.motion, segment.to
                    )
                });
            }
            let chord = (x - from.1).norm();
            let margin = Vector3::repeat(self.mesh_reach + chord);
            let mut touched = segment.motion == Motion::Flying || length == 0.0;
            for face in self.world.near(&(from.1.inf(&x) - margin), &(from.1.sup(&x) + margin)) {
                let distance = |f: f64| self.world.to_triangle(face, &at(f)).norm();
                let (d0, d1) = (distance(from.0), distance(f));
                touched |= d1 <= self.mesh_reach + 4.0 * slack;
                if d0.min(d1) - 0.75 * chord > r {
                    continue;
                }
                let (s, d) = least(from.0, f, distance);
                self.note(Flaw::Penetration, r - d, slack, || {
                    format!(
                        "face {face}, segment {k} {:?} at f = {s:e} of {:e}: d = {d:e}, r = {r:e}, motion {length:e}",
                        segment.motion, segment.to
                    )
                });
            }
            let r0 = self.radius;
            touched |= self.world.planes.iter().any(|(p, n, _)| n.dot(&(x - p)).abs() <= r0 + 4.0 * slack);
            if !touched {
                self.note(Flaw::Hovering, 1.0, 0.5, || {
                    format!("segment {k} {:?} at f = {f} of {}: {x:?}", segment.motion, segment.to)
                });
            }
            from = (f, x);
        }
    }
}

/// The least value of `of` between `from` and `to`, sought by golden section, and at the ends.
fn least(from: f64, to: f64, of: impl Fn(f64) -> f64) -> (f64, f64) {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut a, mut b) = (from, to);
    let (mut p, mut q) = (b - ratio * (b - a), a + ratio * (b - a));
    let (mut at_p, mut at_q) = (of(p), of(q));
    let mut best = (from, of(from));
    for candidate in [(to, of(to)), (p, at_p), (q, at_q)] {
        if candidate.1 < best.1 {
            best = candidate;
        }
    }
    for _ in 0..48 {
        if at_p <= at_q {
            (b, q, at_q) = (q, p, at_p);
            p = b - ratio * (b - a);
            at_p = of(p);
            if at_p < best.1 {
                best = (p, at_p);
            }
        } else {
            (a, p, at_p) = (p, q, at_q);
            q = a + ratio * (b - a);
            at_q = of(q);
            if at_q < best.1 {
                best = (q, at_q);
            }
        }
    }
    best
}
