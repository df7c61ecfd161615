//! What a ball did over time, for charts: its height, velocity and energy, from a run or from a table of events.

mod table;

use crate::replay::{BallRun, Replay};
use carom_dynamics::body::State;
use carom_dynamics::effects::gravity::Gravity;
use carom_dynamics::energy::{kinetic, potential, rotational};
use carom_dynamics::events::EventKind;
use nalgebra::Vector3;
pub use table::read;

/// A stretch of motion is drawn through this many points at least, where it lasts long enough to see.
const POINTS: u32 = 24;

/// The motion of a ball.
pub struct Curve {
    /// Which ball.
    pub ball: usize,
    /// Its samples, in order of time; at an impact there are two of one time.
    pub samples: Vec<Sample>,
    /// The times of its impacts, in s, with its heights then.
    pub impacts: Vec<[f64; 2]>,
    /// When nothing happens to it any more, in s.
    pub settled: f64,
}

/// A moment of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// When, in s.
    pub time: f64,
    /// Along the way up, in m.
    pub height: f64,
    /// The velocity along it, in m/s.
    pub climb: f64,
    /// In m/s.
    pub speed: f64,
    /// Kinetic energy, that of turning too, in J/kg.
    pub kinetic: f64,
    /// Potential energy in gravity, in J/kg, from the origin; none where gravity is not known.
    pub potential: Option<f64>,
}

impl Sample {
    fn of(time: f64, state: &State, up: &Vector3<f64>, gravity: Option<Option<Gravity>>) -> Self {
        Self {
            time,
            height: up.dot(&state.position.coords),
            climb: up.dot(&state.velocity),
            speed: state.velocity.norm(),
            kinetic: kinetic(state),
            potential: gravity.map(|gravity| potential(state, gravity)),
        }
    }
}

/// The curves of the balls of a run; `up` is against gravity, and along z without it.
pub fn of_run(replay: &Replay, up: &Vector3<f64>) -> Vec<Curve> {
    let gravity = replay.scene.gravity;
    let curve = |(ball, run): (usize, &BallRun)| {
        let mut samples = Vec::new();
        let body = &replay.scene.balls[ball];
        for segment in &run.trajectory.segments {
            let length = segment.end - segment.time;
            // A thousandth of the run is less than a pixel.
            let parts = if length * 1000.0 < replay.scene.duration { 4 } else { POINTS };
            for k in 0..=parts {
                let time = segment.time + length * f64::from(k) / f64::from(parts);
                let mut sample = Sample::of(time, &segment.at(time), up, Some(gravity));
                if let Some(spin) = segment.spin_at(time) {
                    sample.kinetic += rotational(body.inertia(), body.radius(), &spin);
                }
                samples.push(sample);
            }
        }
        let events = &run.trajectory.events;
        let impacts = events.iter().filter(|event| event.kind == EventKind::Impact);
        Curve {
            ball,
            samples,
            impacts: impacts.map(|event| [event.time, up.dot(&event.position.coords)]).collect(),
            settled: match events.last() {
                Some(event) if event.kind == EventKind::Rest => event.time,
                _ => run.outcome.time,
            },
        }
    };
    replay.balls.iter().enumerate().map(curve).collect()
}
