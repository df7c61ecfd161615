//! A run as glTF 2.0: what programs for 3-D read, with the motion as its animation.
//!
//! The format (Khronos, *glTF 2.0 Specification*) keeps positions, times and tangents in single precision. Its up is y, so a node above all
//! others turns the scene and carries its offset; everything below it is in the scene's axes and in m, relative to the middle of the stage.

mod container;
mod keys;
mod sphere;
mod turns;

use crate::error::AppError;
use crate::replay::Replay;
use crate::stage::{Prop, Stage};
use carom_dynamics::body::Ball;
use container::{Container, Target};
pub use keys::Keys;
use keys::Track;
use nalgebra::{Unit, Vector3};
use serde_json::{Value, json};
use turns::Turns;

/// The share of the stage's extent that a ball without a radius is drawn with.
const POINT_SHARE: f64 = 1.0 / 256.0;

/// The colours of surfaces, one after the other, and that of balls: linear red, green, blue.
const SURFACE_COLOURS: [[f64; 3]; 6] = [
    [0.58, 0.64, 0.72],
    [0.71, 0.62, 0.49],
    [0.54, 0.67, 0.57],
    [0.67, 0.57, 0.65],
    [0.55, 0.61, 0.76],
    [0.71, 0.69, 0.51],
];
const BALL_COLOUR: [f64; 3] = [0.85, 0.22, 0.02];

/// The other side of a ball that turns, so that it is seen to.
const SIDE_COLOUR: [f64; 3] = [0.95, 0.78, 0.55];

/// More keys of rotation than this are taken for a slip: they would be a file of a gigabyte.
const TURN_LIMIT: f64 = 5e7;

/// The bytes of the model, a `.glb`.
pub fn glb(name: &str, replay: &Replay, keys: Keys) -> Result<Vec<u8>, AppError> {
    let stage = Stage::of(replay);
    let origin = stage.bounds.centre().coords;
    let mut container = Container::default();
    let mut builder = Builder {
        nodes: vec![Value::Null],
        meshes: Vec::new(),
        materials: Vec::new(),
        origin,
        extent: stage.bounds.extent().amax(),
    };
    for (i, (surface, prop)) in replay.scene.surfaces.iter().zip(&stage.props).enumerate() {
        builder.surface(&mut container, &surface.name, &SURFACE_COLOURS[i % SURFACE_COLOURS.len()], prop);
    }
    let sphere = builder.sphere(&mut container, replay.scene.spins());
    let first = builder.nodes.len();
    for (i, ball) in replay.scene.balls.iter().enumerate() {
        builder.ball(sphere, i, ball);
    }
    let off = keys::tolerance(builder.extent);
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    let mut turns_left = TURN_LIMIT;
    for (i, run) in replay.balls.iter().enumerate() {
        let mut add = |path: &str, input: usize, output: usize, interpolation: &str| {
            channels.push(json!({ "sampler": samplers.len(), "target": { "node": first + i, "path": path } }));
            samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
        };
        let track = Track::of(run, replay.scene.duration, keys, &origin, off);
        if track.times.len() > 1 {
            let (input, output) = (container.times(&track.times), container.values(&track.values));
            add("translation", input, output, keys.interpolation());
        }
        if replay.scene.spins() {
            let turns = Turns::of(run, replay.scene.duration, keys, turns_left).ok_or_else(too_many_turns)?;
            turns_left -= turns.times.len() as f64;
            if turns.turn() {
                let (input, output) = (container.times(&turns.times), container.values(&turns.values));
                add("rotation", input, output, "LINEAR");
            }
        }
    }
    let (rotation, offset) = upright(&stage.up, &origin);
    let children: Vec<usize> = (1..builder.nodes.len()).collect();
    builder.nodes[0] = json!({ "name": name, "rotation": rotation, "translation": offset, "children": children });
    let mut document = json!({
        "asset": { "version": "2.0", "generator": concat!("carom ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "name": name, "nodes": [0] }],
        "nodes": builder.nodes,
        "meshes": builder.meshes,
        "materials": builder.materials,
    });
    if !channels.is_empty() {
        // A document without motion may not have an empty list of it.
        document["animations"] = json!([{
            "name": "run", "channels": channels, "samplers": samplers,
            "extras": { "keys": keys.to_string(), "duration_s": replay.scene.duration, "off_by_at_most_m": off },
        }]);
    }
    container.finish(document)
}

/// What is built so far.
struct Builder {
    /// The first is above all others, and made last.
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    origin: Vector3<f64>,
    extent: f64,
}

impl Builder {
    fn surface(&mut self, container: &mut Container, name: &str, colour: &[f64; 3], prop: &Prop) {
        if prop.faces.is_empty() {
            return;
        }
        let vertices: Vec<[f32; 3]> = prop.vertices.iter().map(|v| single(&(v.coords - self.origin))).collect();
        // Without normals, a reader makes those of the faces: a mesh is as flat as the ball finds it.
        let attributes = json!({ "POSITION": container.vectors(&vertices, Target::Vertices) });
        let indices = container.indices(&prop.faces);
        let primitive =
            json!({ "attributes": attributes, "indices": indices, "material": self.material(name, colour) });
        self.nodes.push(json!({ "name": name, "mesh": self.meshes.len() }));
        self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
    }

    /// The mesh that all balls are; of two colours where they turn.
    fn sphere(&mut self, container: &mut Container, turns: bool) -> usize {
        let (corners, faces) = sphere::unit();
        let vertices: Vec<[f32; 3]> = corners.iter().map(single).collect();
        let places = container.vectors(&vertices, Target::Vertices);
        let attributes = json!({ "POSITION": places, "NORMAL": places });
        let (others, ones): (Vec<_>, Vec<_>) =
            faces.iter().partition(|face| turns && sphere::is_beyond_seam(**face, &corners));
        let sides = [("ball", &BALL_COLOUR, ones), ("ball, other side", &SIDE_COLOUR, others)];
        let primitives = sides.into_iter().filter(|(.., faces)| !faces.is_empty()).map(|(name, colour, faces)| {
            let (indices, material) = (container.indices(&faces), self.material(name, colour));
            json!({ "attributes": attributes, "indices": indices, "material": material })
        });
        let primitives: Vec<Value> = primitives.collect();
        self.meshes.push(json!({ "name": "ball", "primitives": primitives }));
        self.meshes.len() - 1
    }

    fn ball(&mut self, mesh: usize, index: usize, ball: &Ball) {
        let is_point = ball.radius() == 0.0;
        let radius = if is_point { POINT_SHARE * self.extent } else { ball.radius() };
        let place = single(&(ball.start().position.coords - self.origin));
        let mut node = json!({
            "name": format!("ball {index}"), "mesh": mesh, "translation": place, "scale": vec![radius as f32; 3],
        });
        if is_point {
            node["extras"] = json!({ "radius_m": 0.0 });
        }
        self.nodes.push(node);
    }

    fn material(&mut self, name: &str, colour: &[f64; 3]) -> usize {
        let [r, g, b] = colour;
        self.materials.push(json!({
            "name": name,
            "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8 },
            "doubleSided": true,
        }));
        self.materials.len() - 1
    }
}

fn too_many_turns() -> AppError {
    AppError::Usage(format!(
        "the balls turn so often that they take more than {TURN_LIMIT:e} keys; take fewer balls, a shorter duration or --keys fps=N"
    ))
}

/// The rotation, as a quaternion x, y, z, w, that takes `up` to y, and where it takes `origin`.
fn upright(up: &Unit<Vector3<f64>>, origin: &Vector3<f64>) -> ([f64; 4], [f64; 3]) {
    // Half the way round is the sum of the two; no sine is needed, which would differ between machines.
    let (axis, w) = (up.cross(&Vector3::y()), 1.0 + up.y);
    let size = (axis.norm_squared() + w * w).sqrt();
    let (v, w) = if up.y > -1.0 && size > 0.0 { (axis / size, w / size) } else { (Vector3::x(), 0.0) };
    let turned = origin + 2.0 * v.cross(&(v.cross(origin) + w * origin));
    ([v.x, v.y, v.z, w], turned.into())
}

fn single(v: &Vector3<f64>) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_becomes_y_and_the_origin_turns_along() {
        for up in [Vector3::z(), Vector3::y(), -Vector3::y(), Vector3::new(0.6, 0.0, 0.8), Vector3::new(1.0, -2.0, 2.0)]
        {
            let up = Unit::new_normalize(up);
            // What is taken for the origin is turned like every point.
            let (rotation, turned) = upright(&up, &(3.0 * up.into_inner()));
            assert!((Vector3::<f64>::from(turned) - 3.0 * Vector3::<f64>::y()).norm() < 1e-12, "{up:?}: {turned:?}");
            assert!((rotation.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }
}
