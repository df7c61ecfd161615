//! The motion of a ball as the keys of an animation.
//!
//! A cubic spline by Hermite takes any polynomial up to degree 3 as it is, when its keys hold the values and slopes at both ends: so one key
//! at each end of a flight makes the whole parabola exact. A path of degree 4 is p'''' h^4 / 384 off in the middle of a span of length
//! h (the error of cubic Hermite interpolation), and is cut into as many spans as make that small.

use crate::replay::BallRun;
use carom_dynamics::observer::Segment;
use nalgebra::Vector3;
use std::fmt;

/// What a motion is given by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Keys {
    /// A key at every event, with the velocities before and after it; parabolas are exact.
    Events,
    /// A position for every frame, straight lines between them, for programs that ignore velocities.
    Frames {
        /// Frames per second.
        fps: f64,
    },
}

impl Keys {
    /// The name of the interpolation in glTF.
    pub fn interpolation(self) -> &'static str {
        match self {
            Keys::Events => "CUBICSPLINE",
            Keys::Frames { .. } => "LINEAR",
        }
    }
}

impl fmt::Display for Keys {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Keys::Events => f.write_str("events"),
            Keys::Frames { fps } => write!(f, "fps={fps}"),
        }
    }
}

/// How far a spline may be from a path that it cannot be, in m, on a stage of this extent: half of what single precision resolves there.
pub fn tolerance(extent: f64) -> f64 {
    extent * 2f64.powi(-24)
}

/// Keys: times in s, ascending, and their values in m. For `Keys::Events` a key has three values: the slope in m/s before it, the position,
/// and the slope after it.
pub struct Track {
    pub times: Vec<f32>,
    pub values: Vec<[f32; 3]>,
}

impl Track {
    /// The keys of a ball, relative to `origin`; splines are `off` m off at most.
    pub fn of(run: &BallRun, duration: f64, keys: Keys, origin: &Vector3<f64>, off: f64) -> Self {
        match keys {
            Keys::Events => Self::spline(run, origin, off),
            Keys::Frames { fps } => Self::frames(run, duration, fps, origin),
        }
    }

    fn frames(run: &BallRun, duration: f64, fps: f64, origin: &Vector3<f64>) -> Self {
        let mut track = Self { times: Vec::new(), values: Vec::new() };
        for k in 0_u32.. {
            let time = (f64::from(k) / fps).min(duration);
            // A ball that a guard has ended has no more keys.
            let Some((state, _)) = run.trajectory.at(time) else { break };
            if track.times.last().is_none_or(|last| time as f32 > *last) {
                track.times.push(time as f32);
                track.values.push(single(state.position.coords - origin));
            }
            if time >= duration {
                break;
            }
        }
        track
    }

    fn spline(run: &BallRun, origin: &Vector3<f64>, off: f64) -> Self {
        let mut track = Self { times: Vec::new(), values: Vec::new() };
        for segment in &run.trajectory.segments {
            let spans = spans(segment, off);
            for k in 0..spans {
                track.span(segment, f64::from(k) / f64::from(spans), f64::from(k + 1) / f64::from(spans), origin);
            }
        }
        track
    }

    /// Appends the part of a segment between two shares of it. Where single precision cannot tell its ends apart, they are one key.
    fn span(&mut self, segment: &Segment, from: f64, to: f64, origin: &Vector3<f64>) {
        let at = |share: f64| {
            let f = share * segment.to;
            let slope = segment.step.path.derivative(f) / segment.step.seconds;
            (single(segment.step.path.at(f).coords - origin), single(slope))
        };
        let time = |share: f64| (segment.time + share * (segment.end - segment.time)) as f32;
        let ((start, leaving), (end, arriving)) = (at(from), at(to));
        if self.times.is_empty() {
            self.times.push(time(from));
            self.values.extend([[0.0; 3], start, leaving]);
        }
        let last = self.values.len() - 1;
        self.values[last] = leaving;
        let end_time = if to == 1.0 { segment.end as f32 } else { time(to) };
        if self.times.last().is_some_and(|last| end_time > *last) {
            self.times.push(end_time);
            self.values.extend([arriving, end, [0.0; 3]]);
        } else {
            self.values[last - 1] = end;
        }
    }
}

/// Into how many spans a segment is cut.
fn spans(segment: &Segment, off: f64) -> u32 {
    let Some(top) = segment.step.path.terms().get(3) else { return 1 };
    // p'''' h^4 / 384 with p'''' = 24 t4 and h the share of f: t4 f^4 / 16, and a 16th of that with every doubling.
    let square = segment.to * segment.to;
    let error = top.norm() * square * square / 16.0;
    (error / off).sqrt().sqrt().ceil().clamp(1.0, 256.0) as u32
}

fn single(v: Vector3<f64>) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}
