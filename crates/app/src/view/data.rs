//! The data of a page: surfaces, motion and events as binary arrays in JSON.
//!
//! Flights are kept as what they are, one polynomial for each stretch of motion, and not as frames: the page shows any moment of them.
//! Positions are relative to the middle of the stage, so that single precision is enough for the eye; times are in double.

use crate::output::rows::kind_name;
use crate::replay::{BallRun, Replay};
use crate::stage::{Prop, Stage};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use carom_dynamics::events::{EventKind, Motion};
use carom_dynamics::integrators::Step;
use carom_dynamics::surface::{Shape, Surface};
use carom_dynamics::turning::Turning;
use nalgebra::Vector3;
use serde::{Serialize, Serializer};

/// What a degree has more when the velocity has terms of its own.
const OWN_VELOCITY: u8 = 16;

/// All that a page shows.
#[derive(Serialize)]
pub struct Data {
    title: String,
    /// The summary, a line each.
    summary: Vec<String>,
    duration: f64,
    gravity: Option<[f64; 3]>,
    up: [f64; 3],
    /// J, or J/kg where not all masses are known.
    energy_unit: &'static str,
    /// What was subtracted from every position.
    origin: [f64; 3],
    /// The box's extent from the origin to either side.
    half: [f64; 3],
    surfaces: Vec<SurfaceData>,
    balls: BallData,
    segments: SegmentData,
    /// How the balls turn; none where nothing turns them.
    turning: Option<TurningData>,
    events: EventData,
}

#[derive(Serialize)]
struct SurfaceData {
    name: String,
    shape: &'static str,
    /// The normal, of a plane.
    normal: Option<[f64; 3]>,
    holds_balls: bool,
    vertices: Packed<f32>,
    faces: Packed<u32>,
}

/// A list of numbers for each ball.
#[derive(Serialize)]
struct BallData {
    radius: Packed<f32>,
    /// In kg; 1 where a mass is unknown.
    mass: Packed<f32>,
    /// The moment of inertia in units of m r^2.
    inertia: Packed<f32>,
    /// When its simulation ended, in s.
    end: Packed<f64>,
    /// Where its segments begin in the lists of them; one more than there are balls.
    segments: Packed<u32>,
    /// Where its events begin.
    events: Packed<u32>,
}

/// A list of numbers for each stretch of motion.
#[derive(Default, Serialize)]
struct SegmentData {
    /// When it begins, in s.
    time: Packed<f64>,
    /// How long f = 1 is, in s.
    seconds: Packed<f64>,
    /// The degree of its path; and 16 more where the velocity is not the path's derivative, but has terms of its own.
    degree: Packed<u8>,
    /// The start, the terms of f, f^2, ... in m and, where it has them, the velocity's in m/s, as many; one segment after the other.
    terms: Packed<f32>,
    /// 0 flying, 1 sliding, 2 rolling, 3 resting.
    motion: Packed<u8>,
}

/// A list of numbers for each stretch of motion, of its turning.
#[derive(Default, Serialize)]
struct TurningData {
    /// How the ball has turned until then: a quaternion, x, y, z, w.
    orientation: Packed<f32>,
    /// The angular velocities at its start and its end, in rad/s, but for the decay.
    spin: Packed<f32>,
    /// The time constant of the decay in s; 0 for none, where the angular velocity changes evenly.
    decay: Packed<f32>,
}

/// A list of numbers for each event.
#[derive(Default, Serialize)]
struct EventData {
    /// The names of the kinds.
    kinds: Vec<&'static str>,
    time: Packed<f64>,
    kind: Packed<u8>,
    surface: Packed<u32>,
    /// The face of a mesh; -1 for none.
    face: Packed<i32>,
    normal: Packed<f32>,
    velocity_in: Packed<f32>,
    velocity: Packed<f32>,
}

/// Numbers, written as base64 of their little-endian bytes.
struct Packed<T>(Vec<T>);

impl<T> Default for Packed<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

macro_rules! packed {
    ($($number:ty),*) => {$(
        impl Serialize for Packed<$number> {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let bytes: Vec<u8> = self.0.iter().flat_map(|x| x.to_le_bytes()).collect();
                serializer.serialize_str(&STANDARD.encode(bytes))
            }
        }
    )*};
}
packed!(f32, f64, u8, u32, i32);

impl Packed<f32> {
    fn push(&mut self, v: &Vector3<f64>) {
        self.0.extend(v.iter().map(|&x| x as f32));
    }
}

impl Data {
    /// Of a run that is called `title`.
    pub fn of(title: &str, replay: &Replay, stage: &Stage) -> Self {
        let scene = &replay.scene;
        let origin = stage.bounds.centre().coords;
        let surfaces = scene.surfaces.iter().zip(&stage.props);
        let masses = scene.balls.iter().map(|b| b.mass()).collect::<Option<Vec<f64>>>();
        let mut balls = BallData {
            radius: Packed(scene.balls.iter().map(|b| b.radius() as f32).collect()),
            mass: Packed(
                scene.balls.iter().map(|b| b.mass().filter(|_| masses.is_some()).unwrap_or(1.0) as f32).collect(),
            ),
            inertia: Packed(scene.balls.iter().map(|b| b.inertia() as f32).collect()),
            end: Packed(replay.balls.iter().map(|run| run.outcome.time).collect()),
            segments: Packed(vec![0]),
            events: Packed(vec![0]),
        };
        let mut segments = SegmentData::default();
        let mut turning = scene.spins().then(TurningData::default);
        let mut events = EventData::default();
        for run in &replay.balls {
            segments.add(run, &origin);
            turning.iter_mut().for_each(|turning| turning.add(run));
            events.add(run);
            balls.segments.0.push(segments.time.0.len() as u32);
            balls.events.0.push(events.time.0.len() as u32);
        }
        Self {
            title: title.to_owned(),
            summary: replay.summary.result(),
            duration: scene.duration,
            gravity: scene.gravity.map(|g| g.acceleration().into()),
            up: stage.up.into_inner().into(),
            energy_unit: replay.summary.energy_unit(),
            origin: origin.into(),
            half: (0.5 * stage.bounds.extent()).into(),
            surfaces: surfaces.map(|(surface, prop)| SurfaceData::of(surface, prop, &origin)).collect(),
            balls,
            segments,
            turning,
            events,
        }
    }
}

impl SurfaceData {
    fn of(surface: &Surface, prop: &Prop, origin: &Vector3<f64>) -> Self {
        let mut vertices = Packed::default();
        prop.vertices.iter().for_each(|v| vertices.push(&(v.coords - origin)));
        Self {
            name: surface.name.clone(),
            shape: match surface.shape {
                Shape::Plane(_) => "plane",
                Shape::Polygon(_) => "polygon",
                Shape::Mesh(_) => "mesh",
            },
            normal: prop.plane.map(|plane| plane.normal().into_inner().into()),
            holds_balls: prop.holds_balls,
            vertices,
            faces: Packed(prop.faces.iter().flatten().copied().collect()),
        }
    }
}

impl SegmentData {
    fn add(&mut self, run: &BallRun, origin: &Vector3<f64>) {
        for segment in &run.trajectory.segments {
            let Step { path, velocity, seconds, .. } = &segment.step;
            self.time.0.push(segment.time);
            self.seconds.0.push(*seconds);
            let (degree, own) = (path.terms().len(), !segment.step.exact);
            self.degree.0.push(degree as u8 + if own { OWN_VELOCITY } else { 0 });
            self.terms.push(&(path.start().coords - origin));
            path.terms().iter().for_each(|term| self.terms.push(term));
            if own {
                velocity.iter().take(degree + 1).for_each(|term| self.terms.push(term));
            }
            self.motion.0.push(match segment.motion {
                Motion::Flying => 0,
                Motion::Sliding => 1,
                Motion::Rolling => 2,
                Motion::Resting => 3,
            });
        }
    }
}

impl TurningData {
    fn add(&mut self, run: &BallRun) {
        let orientations = run.trajectory.orientations();
        for (segment, orientation) in run.trajectory.segments.iter().zip(orientations) {
            self.orientation.0.extend(orientation.coords.iter().map(|&x| x as f32));
            let still = Turning { from: Vector3::zeros(), to: Vector3::zeros(), decay: None };
            let Turning { from, to, decay } = segment.turning.unwrap_or(still);
            self.spin.push(&from);
            self.spin.push(&to);
            self.decay.0.push(decay.map_or(0.0, |decay| decay.time_constant() as f32));
        }
    }
}

impl EventData {
    fn add(&mut self, run: &BallRun) {
        for event in &run.trajectory.events {
            self.time.0.push(event.time);
            let kind = self.kind(event.kind);
            self.kind.0.push(kind);
            self.surface.0.push(event.surface as u32);
            self.face.0.push(event.face.map_or(-1, |face| face as i32));
            self.normal.push(&event.normal);
            self.velocity_in.push(&event.velocity_in);
            self.velocity.push(&event.velocity);
        }
    }

    /// The number of a kind in this page.
    fn kind(&mut self, kind: EventKind) -> u8 {
        let name = kind_name(kind);
        let known = self.kinds.iter().position(|k| *k == name);
        known.unwrap_or_else(|| {
            self.kinds.push(name);
            self.kinds.len() - 1
        }) as u8
    }
}
