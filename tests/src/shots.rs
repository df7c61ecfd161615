//! Points and balls shot from inside closed meshes at their edges and vertices, along lines and parabolas: none may get outside.

use crate::closed::Closed;
use crate::patience::simulate_within;
use crate::random::Random;
use crate::stage::{Run, Stage, smooth};
use crate::world::U;
use carom_dynamics::events::{Ending, EventKind};
use carom_dynamics::observer::Trajectory;
use carom_dynamics::surface::Shape;
use nalgebra::{Point3, Vector3};
use std::sync::Arc;

/// Shots from one start.
const SHOTS_A_START: u64 = 16;
/// Stretches of motion that a shot takes at most.
const STRETCHES: u64 = 200_000;
/// What went wrong and is told; the rest is counted.
const TOLD: usize = 8;
/// Tries to find a start with room for a ball.
const TRIES: usize = 100;

/// What is shot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shot {
    /// A ball and not a point.
    pub ball: bool,
    /// Along a parabola and not a line.
    pub curved: bool,
}

/// Every kind of shot.
pub const SHOTS: [Shot; 4] = [
    Shot { ball: false, curved: false },
    Shot { ball: false, curved: true },
    Shot { ball: true, curved: false },
    Shot { ball: true, curved: true },
];

/// What came of many shots.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tally {
    /// How many.
    pub shots: u64,
    /// Their impacts.
    pub impacts: u64,
    /// Points whose first impact was where they were aimed at.
    pub met: u64,
    /// Shots that met nothing.
    pub missed: u64,
    /// Shots that got outside.
    pub outside: u64,
    /// Shots that were ended by a guard.
    pub guarded: u64,
    /// Shots that did not get on.
    pub stalled: u64,
    /// The first few that went wrong.
    pub wrong: Vec<String>,
}

impl Tally {
    /// Whether none went wrong.
    pub fn is_sound(&self) -> bool {
        self.missed + self.outside + self.guarded + self.stalled == 0
    }

    /// Adds others.
    pub fn add(&mut self, other: Self) {
        self.shots += other.shots;
        self.impacts += other.impacts;
        self.met += other.met;
        self.missed += other.missed;
        self.outside += other.outside;
        self.guarded += other.guarded;
        self.stalled += other.stalled;
        other.wrong.into_iter().for_each(|wrong| self.note(wrong));
    }

    fn note(&mut self, wrong: String) {
        if self.wrong.len() < TOLD {
            self.wrong.push(wrong);
        }
    }
}

/// Shoots `count` times inside `closed`; the seed says where from and where to.
pub fn shoot(closed: &Closed, shot: Shot, count: u64, seed: u64) -> Tally {
    let mut random = Random::new(seed);
    let mut tally = Tally::default();
    while tally.shots < count {
        let (start, radius) = place(closed, shot, &mut random);
        for _ in 0..SHOTS_A_START.min(count - tally.shots) {
            let face = match random.below(2) {
                0 => closed.neighbour(start.face, &mut random),
                _ => random.below(closed.mesh.faces().len()) as u32,
            };
            let target = closed.feature(face, &mut random);
            let aim = target - start.position;
            if aim == Vector3::zeros() {
                continue;
            }
            // As fast as it takes to get there in 1 s; under a gravity that bends its way by as much as it is long.
            let g = if shot.curved { random.vector(2.0 * aim.amax()) } else { Vector3::zeros() };
            // Flat bodies end in wedges that a ball without loss leaves after millions of bounces.
            let c_r = [0.0, 0.5, 0.9][random.below(3)];
            let stage = Stage::new(random.within(1.25, 3.0))
                .gravity(g)
                .surface("body", smooth(c_r), Shape::Mesh(Arc::clone(&closed.mesh)))
                .ball(start.position, aim - g * 0.5, radius);
            let between = random.unit();
            let g = stage.0.gravity.map_or(g, |g| g.acceleration());
            let name = || {
                let Some(ball) = stage.0.balls.first() else { return String::new() };
                let (body, treatment, duration) = (closed.body, closed.treatment, stage.0.duration);
                format!("{body} {treatment:?}, c_r = {c_r}, {ball:?}, gravity {g:?}, {duration} s")
            };
            let plan = stage.plan();
            let mut trajectory = Trajectory::default();
            let run = match simulate_within(&plan, &plan.balls()[0], &mut trajectory, STRETCHES) {
                Ok(outcome) => Run { trajectory, outcome },
                Err(stalled) => {
                    tally.shots += 1;
                    tally.stalled += 1;
                    tally.note(format!("{stalled:?} after {} events: {}", trajectory.events.len(), name()));
                    continue;
                }
            };
            judge(closed, &run, between, &mut tally, name);
            let first = run.trajectory.events.first();
            let near = 64.0 * (closed.resolved() + U * closed.size);
            tally.met += u64::from(radius == 0.0 && first.is_some_and(|e| (e.position - target).amax() <= near));
        }
    }
    tally
}

fn place(closed: &Closed, shot: Shot, random: &mut Random) -> (crate::closed::Start, f64) {
    for _ in 0..TRIES {
        let start = closed.start(random);
        if !shot.ball {
            return (start, 0.0);
        }
        let radius = start.room * random.within(0.01, 0.95);
        // A ball is larger than the rounding of its place, and does not count as a point.
        if radius > closed.resolved() {
            return (start, radius);
        }
    }
    panic!("{} {:?}: no room for a ball", closed.body, closed.treatment)
}

fn judge(closed: &Closed, run: &Run, between: f64, tally: &mut Tally, name: impl Fn() -> String) {
    tally.shots += 1;
    let impacts = run.trajectory.events.iter().filter(|e| e.kind == EventKind::Impact).count() as u64;
    tally.impacts += impacts;
    let middle = run.at(run.outcome.time * between);
    let start = run.at(0.0);
    let inside = |x: &Point3<f64>| closed.is_inside(x) || closed.is_with(&start, x);
    let inside = inside(&run.outcome.state.position) && inside(&middle);
    let guarded = run.outcome.ending != Ending::Completed;
    tally.missed += u64::from(impacts == 0);
    tally.outside += u64::from(!inside);
    tally.guarded += u64::from(guarded);
    if impacts == 0 || !inside || guarded {
        tally.note(format!("{impacts} impacts, inside: {inside}, {:?}: {}", run.outcome, name()));
    }
}
