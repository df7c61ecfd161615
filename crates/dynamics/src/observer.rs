//! What a simulation shows while it runs: events, and the stretches of motion between them.

use crate::body::State;
use crate::events::{Event, Motion};
use crate::integrators::Step;
use crate::turning::Turning;
use nalgebra::{UnitQuaternion, Vector3};

/// A stretch of motion without an event inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// When it begins, in s.
    pub time: f64,
    /// When it ends, in s; the next one begins then, to the bit.
    pub end: f64,
    /// Its path and velocity.
    pub step: Step,
    /// The f at which it ends.
    pub to: f64,
    /// How the ball moves in it.
    pub motion: Motion,
    /// How it turns, if the scene calls for it.
    pub turning: Option<Turning>,
}

impl Segment {
    /// The angular velocity in rad/s at `time`, if the scene calls for it.
    pub fn spin_at(&self, time: f64) -> Option<Vector3<f64>> {
        self.turning.map(|turning| turning.at(time - self.time, self.end - self.time))
    }

    /// How the ball has turned from the start of the segment to `time`, which is brought into it; not at all if the scene does not call for it.
    pub fn rotation_at(&self, time: f64) -> UnitQuaternion<f64> {
        let whole = self.end - self.time;
        let seconds = (time - self.time).clamp(0.0, whole);
        self.turning.map_or_else(UnitQuaternion::identity, |turning| turning.rotation(seconds, whole))
    }

    /// The state at `time`, which is brought into the segment.
    pub fn at(&self, time: f64) -> State {
        self.step.at(((time - self.time) / self.step.seconds).clamp(0.0, self.to))
    }
}

/// Watches one ball.
///
/// ```
/// # use carom_dynamics::body::Ball;
/// # use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
/// # use carom_dynamics::geometry::plane::Plane;
/// # use carom_dynamics::nalgebra::{Point3, Vector3};
/// # use carom_dynamics::scene::Scene;
/// # use carom_dynamics::surface::{Material, Shape, Surface};
/// # let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
/// # let material = Material { restitution: Restitution::new(0.5)?, friction: Friction::None };
/// # let scene = Scene {
/// #     gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0))?),
/// #     surfaces: vec![Surface { name: "floor".into(), material, shape: Shape::Plane(floor) }],
/// #     balls: vec![Ball::new(Point3::new(0.0, 0.0, 4.0), Vector3::zeros(), 0.0, None)?],
/// #     ..Scene::lasting(3.0)
/// # };
/// use carom_dynamics::events::{Event, EventKind};
/// use carom_dynamics::observer::{Observer, Segment};
/// use carom_dynamics::plan::Plan;
/// use carom_dynamics::simulate::simulate;
///
/// /// Counts the impacts and remembers the hardest.
/// #[derive(Default)]
/// struct Impacts {
///     count: usize,
///     hardest: f64,
/// }
///
/// impl Observer for Impacts {
///     fn event(&mut self, event: &Event) {
///         if event.kind == EventKind::Impact {
///             self.count += 1;
///             self.hardest = self.hardest.max(-event.normal.dot(&event.velocity_in));
///         }
///     }
///
///     fn segment(&mut self, _: &Segment) {}
/// }
///
/// let plan = Plan::new(&scene)?;
/// let mut impacts = Impacts::default();
/// simulate(&plan, &plan.balls()[0], &mut impacts);
/// assert!(impacts.count > 10 && impacts.hardest == 8.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Observer {
    /// Something happened.
    fn event(&mut self, event: &Event);

    /// The ball moved; segments come in order of time and leave no gap.
    fn segment(&mut self, segment: &Segment);

    /// Whether it looks at events: if not, they come without their bounds, which nobody need compute.
    fn looks_at_events(&self) -> bool {
        true
    }
}

/// A watcher that does not look.
impl Observer for () {
    fn event(&mut self, _: &Event) {}
    fn segment(&mut self, _: &Segment) {}

    fn looks_at_events(&self) -> bool {
        false
    }
}

/// A watcher that is kept elsewhere, or is not known by its type: `&mut dyn Observer` watches too.
impl<O: Observer + ?Sized> Observer for &mut O {
    fn event(&mut self, event: &Event) {
        (**self).event(event);
    }

    fn segment(&mut self, segment: &Segment) {
        (**self).segment(segment);
    }

    fn looks_at_events(&self) -> bool {
        (**self).looks_at_events()
    }
}

/// Two watchers side by side.
impl<A: Observer, B: Observer> Observer for (A, B) {
    fn event(&mut self, event: &Event) {
        self.0.event(event);
        self.1.event(event);
    }

    fn segment(&mut self, segment: &Segment) {
        self.0.segment(segment);
        self.1.segment(segment);
    }

    fn looks_at_events(&self) -> bool {
        self.0.looks_at_events() || self.1.looks_at_events()
    }
}

/// A watcher that may be absent.
impl<A: Observer> Observer for Option<A> {
    fn event(&mut self, event: &Event) {
        if let Some(observer) = self {
            observer.event(event);
        }
    }

    fn segment(&mut self, segment: &Segment) {
        if let Some(observer) = self {
            observer.segment(segment);
        }
    }

    fn looks_at_events(&self) -> bool {
        self.as_ref().is_some_and(Observer::looks_at_events)
    }
}

/// The whole run of a ball: its events and its motion.
///
/// ```
/// # use carom_dynamics::body::Ball;
/// # use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
/// # use carom_dynamics::geometry::plane::Plane;
/// # use carom_dynamics::nalgebra::{Point3, Vector3};
/// # use carom_dynamics::scene::Scene;
/// # use carom_dynamics::surface::{Material, Shape, Surface};
/// # let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
/// # let material = Material { restitution: Restitution::new(0.5)?, friction: Friction::None };
/// # let scene = Scene {
/// #     gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0))?),
/// #     surfaces: vec![Surface { name: "floor".into(), material, shape: Shape::Plane(floor) }],
/// #     balls: vec![Ball::new(Point3::new(0.0, 0.0, 4.0), Vector3::zeros(), 0.0, None)?],
/// #     ..Scene::lasting(3.0)
/// # };
/// use carom_dynamics::observer::Trajectory;
/// use carom_dynamics::plan::Plan;
/// use carom_dynamics::simulate::simulate;
///
/// let plan = Plan::new(&scene)?;
/// let mut run = Trajectory::default();
/// simulate(&plan, &plan.balls()[0], &mut run);
/// // Any moment of it is the one that was computed, and no frame.
/// let (state, _) = run.at(0.5).ok_or("within the run")?;
/// assert_eq!((state.position.z, state.velocity.z), (3.0, -4.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trajectory {
    /// The events, in order of time.
    pub events: Vec<Event>,
    /// The motion, in order of time and without gaps.
    pub segments: Vec<Segment>,
}

impl Observer for Trajectory {
    fn event(&mut self, event: &Event) {
        self.events.push(*event);
    }

    fn segment(&mut self, segment: &Segment) {
        self.segments.push(*segment);
    }
}

impl Trajectory {
    /// The state and the kind of motion at `time`; none before the start and after the end.
    pub fn at(&self, time: f64) -> Option<(State, Motion)> {
        let after = self.segments.partition_point(|s| s.time <= time);
        let segment = self.segments.get(after.checked_sub(1)?)?;
        (time <= segment.end).then(|| (segment.at(time), segment.motion))
    }

    /// How the ball has turned from its start to the start of each segment; see [`Segment::rotation_at`] for what comes after that.
    pub fn orientations(&self) -> Vec<UnitQuaternion<f64>> {
        let turned = |orientation: &mut UnitQuaternion<f64>, segment: &Segment| {
            let before = *orientation;
            // Products of many rotations drift off unit length by their rounding.
            *orientation = UnitQuaternion::new_normalize((segment.rotation_at(segment.end) * before).into_inner());
            Some(before)
        };
        self.segments.iter().scan(UnitQuaternion::identity(), turned).collect()
    }
}

/// A ball at the time of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// k / fps, in s.
    pub time: f64,
    /// Where and how fast.
    pub state: State,
    /// How it moves.
    pub motion: Motion,
    /// Its angular velocity in rad/s, if the scene calls for it.
    pub spin: Option<Vector3<f64>>,
}

/// Samples the motion at t = k / fps. Frames are read off the stored paths and never change the run.
///
/// ```
/// # use carom_dynamics::body::Ball;
/// # use carom_dynamics::effects::{friction::Friction, gravity::Gravity, restitution::Restitution};
/// # use carom_dynamics::geometry::plane::Plane;
/// # use carom_dynamics::nalgebra::{Point3, Vector3};
/// # use carom_dynamics::scene::Scene;
/// # use carom_dynamics::surface::{Material, Shape, Surface};
/// # let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
/// # let material = Material { restitution: Restitution::new(0.5)?, friction: Friction::None };
/// # let scene = Scene {
/// #     gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -8.0))?),
/// #     surfaces: vec![Surface { name: "floor".into(), material, shape: Shape::Plane(floor) }],
/// #     balls: vec![Ball::new(Point3::new(0.0, 0.0, 4.0), Vector3::zeros(), 0.0, None)?],
/// #     ..Scene::lasting(3.0)
/// # };
/// use carom_dynamics::observer::FrameSampler;
/// use carom_dynamics::plan::Plan;
/// use carom_dynamics::simulate::simulate;
///
/// let plan = Plan::new(&scene)?;
/// let mut sampler = FrameSampler::new(2.0, plan.duration());
/// simulate(&plan, &plan.balls()[0], &mut sampler);
/// let frames = sampler.frames();
/// assert_eq!((frames.len(), frames[1].time, frames[1].state.position.z), (7, 0.5, 3.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FrameSampler {
    fps: f64,
    duration: f64,
    frames: Vec<Frame>,
}

impl FrameSampler {
    /// Frames at `fps` per second, > 0, from 0 to `duration` (s), both included.
    pub fn new(fps: f64, duration: f64) -> Self {
        Self { fps, duration, frames: Vec::new() }
    }

    /// The frames so far.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }
}

impl Observer for FrameSampler {
    fn event(&mut self, _: &Event) {}

    fn segment(&mut self, segment: &Segment) {
        let end = segment.end;
        loop {
            let time = self.frames.len() as f64 / self.fps;
            // A frame at the time of an event shows what comes after it; the last frame has nothing after it.
            let last = time >= self.duration && end >= self.duration;
            if time > self.duration || (time >= end && !last) {
                return;
            }
            let (state, spin) = (segment.at(time), segment.spin_at(time));
            self.frames.push(Frame { time, state, motion: segment.motion, spin });
        }
    }

    fn looks_at_events(&self) -> bool {
        false
    }
}
