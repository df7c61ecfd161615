//! One case of the conformance pack, and how its files are written.

use crate::oracle::U;
use std::fmt::Write;

/// A scene, what must happen in it, and how that is known.
#[derive(Debug, Clone)]
pub struct Pack {
    /// The name of its files.
    pub name: &'static str,
    /// What it is, in a few words.
    pub title: &'static str,
    /// How the answer is known.
    pub source: &'static str,
    /// The scene but for its version, in TOML.
    pub scene: String,
    /// Mesh files beside the scene.
    pub meshes: Vec<(&'static str, String)>,
    /// What must happen.
    pub targets: Vec<Target>,
}

/// The n-th event of a kind, or the number of impacts.
#[derive(Debug, Clone)]
pub struct Target {
    ball: usize,
    kind: &'static str,
    n: u64,
    time: Option<f64>,
    place: [Option<f64>; 3],
    velocity: [Option<f64>; 3],
    tolerances: [Option<f64>; 3],
}

impl Target {
    fn new(kind: &'static str, n: u64, time: Option<f64>) -> Self {
        Self { ball: 0, kind, n, time, place: [None; 3], velocity: [None; 3], tolerances: [None; 3] }
    }

    /// The n-th impact, at `time`.
    pub fn impact(n: u64, time: f64) -> Self {
        Self::new("impact", n, Some(time))
    }

    /// Rest, from `time` on.
    pub fn rest(time: f64) -> Self {
        Self::new("rest", 1, Some(time))
    }

    /// Sliding begins at `time`.
    pub fn slide(time: f64) -> Self {
        Self::new("slide", 1, Some(time))
    }

    /// Contact is lost at `time`, if that is known.
    pub fn leave(time: Option<f64>) -> Self {
        Self::new("leave", 1, time)
    }

    /// `n` impacts in all.
    pub fn impacts(n: u64) -> Self {
        Self::new("impacts", n, None)
    }

    /// Of another ball than the first.
    pub fn of(mut self, ball: usize) -> Self {
        self.ball = ball;
        self
    }

    /// Where; coordinates that are not known are NaN.
    pub fn at(mut self, place: [f64; 3]) -> Self {
        self.place = place.map(|x| (!x.is_nan()).then_some(x));
        self
    }

    /// The velocity afterwards; components that are not known are NaN.
    pub fn leaving(mut self, velocity: [f64; 3]) -> Self {
        self.velocity = velocity.map(|v| (!v.is_nan()).then_some(v));
        self
    }

    /// How far it may be off, in s, m and m/s.
    pub fn within(mut self, dt: f64, dx: f64, dv: f64) -> Self {
        let some = |known: bool, d: f64| known.then_some(d);
        let known = |v: &[Option<f64>; 3]| v.iter().any(Option::is_some);
        self.tolerances =
            [some(self.time.is_some(), dt), some(known(&self.place), dx), some(known(&self.velocity), dv)];
        self
    }

    /// Off by `n` u of a time, a length and a speed.
    pub fn ulps(self, n: f64, [time, length, speed]: [f64; 3]) -> Self {
        self.within(n * U * time, n * U * length, n * U * speed)
    }

    fn row(&self) -> String {
        let number = |x: &Option<f64>| x.map_or(String::new(), |x| format!("{x:?}"));
        let mut row = format!("{},{},{},{}", self.ball, self.kind, self.n, number(&self.time));
        for x in self.place.iter().chain(&self.velocity).chain(&self.tolerances) {
            write!(row, ",{}", number(x)).unwrap_or_default();
        }
        row
    }
}

impl Pack {
    /// A case without meshes.
    pub fn new(
        name: &'static str,
        title: &'static str,
        source: &'static str,
        scene: String,
        targets: Vec<Target>,
    ) -> Self {
        Self { name, title, source, scene, meshes: Vec::new(), targets }
    }

    /// With a mesh file beside the scene.
    pub fn mesh(mut self, name: &'static str, obj: String) -> Self {
        self.meshes.push((name, obj));
        self
    }

    pub(super) fn scene_file(&self) -> String {
        format!("# {}.\n# {}.\nversion = 1\n{}", self.title, self.source, self.scene)
    }

    pub(super) fn expected_file(&self) -> String {
        let mut text = format!("# {}. {}.\nball,kind,n,t,x,y,z,vx,vy,vz,dt,dx,dv\n", self.title, self.source);
        for target in &self.targets {
            text += &target.row();
            text.push('\n');
        }
        text
    }
}

/// The beginning of a scene: duration and gravity.
pub fn scene(duration: f64, gravity: [f64; 3]) -> String {
    let gravity = if gravity == [0.0; 3] { String::new() } else { format!("gravity = {gravity:?}\n") };
    format!("duration = {duration:?}\n{gravity}")
}

/// A material by the name `name`, with friction as it stands in the file, or none.
pub fn material(name: &str, e: f64, friction: &str) -> String {
    let friction = if friction.is_empty() { String::new() } else { format!("friction = {friction}\n") };
    format!("\n[materials.{name}]\nrestitution = {e:?}\n{friction}")
}

/// A plane.
pub fn plane(name: &str, material: &str, point: [f64; 3], normal: [f64; 3]) -> String {
    surface(name, material, &format!("plane = {{ point = {point:?}, normal = {normal:?} }}"))
}

/// A polygon.
pub fn polygon(name: &str, material: &str, vertices: &[[f64; 3]]) -> String {
    surface(name, material, &format!("polygon = {vertices:?}"))
}

/// A mesh in a file beside the scene.
pub fn mesh(name: &str, material: &str, file: &str) -> String {
    surface(name, material, &format!("mesh = {{ file = {file:?} }}"))
}

fn surface(name: &str, material: &str, shape: &str) -> String {
    format!("\n[[surfaces]]\nname = {name:?}\nmaterial = {material:?}\nshape = {{ {shape} }}\n")
}

/// A ball; what is 0 by default may be 0.
pub fn ball(position: [f64; 3], velocity: [f64; 3], radius: f64) -> String {
    format!("\n[[balls]]\nposition = {position:?}\nvelocity = {velocity:?}\nradius = {radius:?}\n")
}

/// A rest length in m, for scenes that must not come to rest too early.
pub fn rest_length(length: f64) -> String {
    format!("\n[rest]\nlength = {length:?}\n")
}
