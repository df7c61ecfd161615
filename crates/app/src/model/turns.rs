//! The turning of a ball as the keys of an animation.
//!
//! Between two keys glTF turns evenly about one axis, by less than half a turn (spherical linear interpolation). So a ball that turns fast has many
//! keys, a radian apart, and what is between them is exact where it turns evenly. Where it turns ever faster by a in rad/s^2, it is a h^2 / 8
//! off in the middle of two keys that are h apart (the error of linear interpolation), and these are nearer to each other.

use super::keys::Keys;
use crate::replay::BallRun;
use carom_dynamics::observer::Segment;
use nalgebra::UnitQuaternion;

/// How far a ball may turn between two keys, in rad.
const STEP: f64 = 1.0;

/// How far the turn of a ball may be off between two keys, in rad: less than the eye sees.
const OFF: f64 = 0.01;

/// Keys: times in s, ascending, and orientations from that of the start as quaternions x, y, z, w.
pub struct Turns {
    pub times: Vec<f32>,
    pub values: Vec<[f32; 4]>,
}

impl Turns {
    /// The keys of a ball; at most `limit` of them, or none at all.
    pub fn of(run: &BallRun, duration: f64, keys: Keys, limit: f64) -> Option<Self> {
        let needed = match keys {
            Keys::Events => run.trajectory.segments.iter().map(spans).sum::<f64>(),
            Keys::Frames { fps } => duration * fps,
        };
        if needed > limit {
            return None;
        }
        let mut turns = Self { times: Vec::new(), values: Vec::new() };
        let mut frame = 0_u32;
        for (segment, start) in run.trajectory.segments.iter().zip(run.trajectory.orientations()) {
            let mut add = |time: f64| turns.push(time, segment.rotation_at(time) * start);
            match keys {
                Keys::Events => {
                    let spans = spans(segment);
                    add(segment.time);
                    (1..=spans as u32)
                        .for_each(|k| add(segment.time + f64::from(k) / spans * (segment.end - segment.time)));
                }
                Keys::Frames { fps } => {
                    let time = |frame: u32| (f64::from(frame) / fps).min(duration);
                    while time(frame) < segment.end {
                        add(time(frame));
                        frame += 1;
                    }
                    if segment.end >= duration {
                        add(duration);
                    }
                }
            }
        }
        Some(turns)
    }

    /// Whether it turns at all.
    pub fn turn(&self) -> bool {
        self.values.iter().any(|value| *value != self.values[0])
    }

    /// A time that single precision cannot tell from the last is none.
    fn push(&mut self, time: f64, orientation: UnitQuaternion<f64>) {
        let time = time as f32;
        if self.times.last().is_none_or(|last| time > *last) {
            self.times.push(time);
            let [x, y, z, w] = *orientation.coords.as_ref();
            self.values.push([x as f32, y as f32, z as f32, w as f32]);
        }
    }
}

/// Into how many spans a segment is cut.
fn spans(segment: &Segment) -> f64 {
    let Some(turning) = segment.turning else { return 1.0 };
    let seconds = segment.end - segment.time;
    let (from, to) = (turning.at(0.0, seconds), turning.at(seconds, seconds));
    let even = from.norm().max(to.norm()) * seconds / STEP;
    let uneven = ((to - from).norm() * seconds / (8.0 * OFF)).sqrt();
    even.max(uneven).ceil().max(1.0)
}
