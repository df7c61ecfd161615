//! Models, read by the crate `gltf` and judged by Khronos' validator.

use crate::{Job, number};
use gltf::animation::{Interpolation, util::ReadOutputs};
use serde_json::Value;
use std::io::Write;
use std::path::Path;
use std::process::Command;

/// The motion of a ball as a model has it.
struct Motion {
    name: String,
    interpolation: Interpolation,
    times: Vec<f64>,
    values: Vec<[f64; 3]>,
}

impl Motion {
    /// The position at `time` by the formulas of the glTF specification, appendix C.
    fn at(&self, time: f64) -> [f64; 3] {
        let next = self.times.partition_point(|t| *t <= time).clamp(1, self.times.len() - 1);
        let (from, to) = (self.times[next - 1], self.times[next]);
        let (span, t) = (to - from, ((time - from) / (to - from)).clamp(0.0, 1.0));
        std::array::from_fn(|axis| match self.interpolation {
            Interpolation::Linear => {
                let [a, b] = [self.values[next - 1], self.values[next]];
                a[axis] + t * (b[axis] - a[axis])
            }
            Interpolation::CubicSpline => {
                let (v0, b0) = (self.values[3 * next - 2][axis], self.values[3 * next - 1][axis]);
                let (a1, v1) = (self.values[3 * next][axis], self.values[3 * next + 1][axis]);
                (2.0 * t.powi(3) - 3.0 * t.powi(2) + 1.0) * v0
                    + span * (t.powi(3) - 2.0 * t.powi(2) + t) * b0
                    + (-2.0 * t.powi(3) + 3.0 * t.powi(2)) * v1
                    + span * (t.powi(3) - t.powi(2)) * a1
            }
            Interpolation::Step => panic!("no motion is in steps"),
        })
    }
}

/// The motions of a model, and where the middle of its stage is in the scene.
fn motions(bytes: &[u8]) -> (Vec<Motion>, [f64; 3]) {
    let model = gltf::Gltf::from_slice(bytes).expect("valid glTF");
    let blob = model.blob.as_deref().expect("a binary chunk");
    let root = model.scenes().next().and_then(|scene| scene.nodes().next()).expect("a root");
    // All the scenes have z up, so that the root turns z to y: (x, y, z) becomes (x, z, -y).
    let ([x, y, z], turn, _) = root.transform().decomposed();
    assert!((turn[0] + 0.5_f32.sqrt()).abs() < 1e-6 && (turn[3] - 0.5_f32.sqrt()).abs() < 1e-6, "{turn:?}");
    let mut found = Vec::new();
    for channel in model.animations().flat_map(|animation| animation.channels().collect::<Vec<_>>()) {
        let reader = channel.reader(|_| Some(blob));
        let times = reader.read_inputs().expect("times").map(f64::from).collect();
        let values = match reader.read_outputs() {
            Some(ReadOutputs::Translations(values)) => values,
            Some(ReadOutputs::Rotations(_)) => continue,
            _ => panic!("a ball moves and turns"),
        };
        found.push(Motion {
            name: channel.target().node().name().expect("a name").to_owned(),
            interpolation: channel.sampler().interpolation(),
            times,
            values: values.map(|v| v.map(f64::from)).collect(),
        });
    }
    (found, [x, -z, y].map(f64::from))
}

/// The orientations of the balls of a model, by name: times, and quaternions x, y, z, w.
fn turns(bytes: &[u8]) -> Vec<(String, Vec<f64>, Vec<[f64; 4]>)> {
    let model = gltf::Gltf::from_slice(bytes).expect("valid glTF");
    let blob = model.blob.as_deref().expect("a binary chunk");
    let channels = model.animations().flat_map(|animation| animation.channels().collect::<Vec<_>>());
    let turns = channels.filter_map(|channel| {
        let reader = channel.reader(|_| Some(blob));
        let Some(ReadOutputs::Rotations(values)) = reader.read_outputs() else { return None };
        assert_eq!(channel.sampler().interpolation(), Interpolation::Linear);
        let times = reader.read_inputs().expect("times").map(f64::from).collect();
        let values = values.into_f32().map(|q| q.map(f64::from)).collect();
        Some((channel.target().node().name().expect("a name").to_owned(), times, values))
    });
    turns.collect()
}

/// The orientation at `time` by spherical linear interpolation, as the glTF specification has it in appendix C.
fn orientation(times: &[f64], values: &[[f64; 4]], time: f64) -> [f64; 4] {
    let next = times.partition_point(|t| *t <= time).clamp(1, times.len() - 1);
    let t = ((time - times[next - 1]) / (times[next] - times[next - 1])).clamp(0.0, 1.0);
    let (a, b) = (values[next - 1], values[next]);
    let dot: f64 = (0..4).map(|i| a[i] * b[i]).sum();
    let angle = dot.abs().min(1.0).acos();
    if angle < 1e-6 {
        return a;
    }
    let shares = [((1.0 - t) * angle).sin() / angle.sin(), dot.signum() * (t * angle).sin() / angle.sin()];
    std::array::from_fn(|i| shares[0] * a[i] + shares[1] * b[i])
}

#[test]
fn balls_turn_as_fast_as_the_table_says() {
    const FPS: f64 = 997.0;
    for scene in ["topspin.toml", "roll.toml"] {
        let job = Job::on(scene);
        job.carom(&["export", "--quiet", "-o", "model.glb"]);
        let turns = turns(&job.read("model.glb"));
        assert_eq!(turns.len(), 3);
        let frames = job.table(&["run", "--quiet", "--fps", "997", "--frames", "-"]);
        let spin = |row: &[String]| [9, 10, 11].map(|k| number(&row[k]));
        let mut turned = 0.0;
        for pair in frames.windows(2).filter(|pair| pair[0][1] == pair[1][1]) {
            let (_, times, values) =
                turns.iter().find(|(name, ..)| *name == format!("ball {}", pair[0][1])).expect("every ball turns");
            let [a, b] = [&pair[0], &pair[1]].map(|row| orientation(times, values, number(&row[0])));
            // b a^-1 turns from one frame to the next, in the axes of the scene; its vector is half the angle, as small as that is.
            let side = if (0..4).map(|i| a[i] * b[i]).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
            let cross = [b[2] * a[1] - b[1] * a[2], b[0] * a[2] - b[2] * a[0], b[1] * a[0] - b[0] * a[1]];
            let half: [f64; 3] = std::array::from_fn(|i| side * (a[3] * b[i] - b[3] * a[i] + cross[i]));
            let (before, after) = (spin(&pair[0]), spin(&pair[1]));
            let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            let jump = length(std::array::from_fn(|i| after[i] - before[i]));
            let off = length(std::array::from_fn(|i| 2.0 * FPS * half[i] - 0.5 * (before[i] + after[i])));
            // The sine of half the angle is a hundredth short of it at 500 rad/s, and single precision is 0.2 rad/s of these. A straight line
            // that is 0.01 off a parabola of the acceleration a is off in its slope by sqrt(0.02 a) at most.
            let fast = length(before).max(length(after));
            let slope = (0.02 * FPS * jump).sqrt();
            assert!(off <= 0.5 * jump + slope + 0.011 * fast + 0.5, "{scene} {pair:?}: {off}");
            turned += fast / FPS;
        }
        assert!(turned > 100.0, "{scene}: {turned} rad");
    }
}

#[test]
fn baked_turns_are_of_the_frames() {
    let job = Job::on("roll.toml");
    job.carom(&["export", "--quiet", "-o", "model.glb"]);
    let smooth = turns(&job.read("model.glb"));
    job.carom(&["export", "--quiet", "-o", "model.glb", "--keys", "fps=25"]);
    for ((_, times, values), (_, baked_times, baked)) in smooth.iter().zip(turns(&job.read("model.glb"))) {
        assert_eq!(baked_times.len(), 101);
        for (time, baked) in baked_times.iter().zip(baked) {
            let at = orientation(times, values, *time);
            let same = (0..4).map(|i| at[i] * baked[i]).sum::<f64>().abs();
            assert!(same > 1.0 - 1e-4, "{time}: {at:?} and {baked:?}");
        }
    }
}

/// Holds every ball of a model against the frames of the same scene; gives the worst distance over the size of the scene.
fn worst(scene: &str, keys: &str, fps: &str) -> f64 {
    let job = Job::on(scene);
    job.carom(&["export", "--quiet", "-o", "model.glb", "--keys", keys]);
    let (motions, origin) = motions(&job.read("model.glb"));
    let frames = job.table(&["run", "--quiet", "--fps", fps, "--frames", "-"]);
    let places = || frames.iter().map(|row| [number(&row[2]), number(&row[3]), number(&row[4])]);
    let size = (0..3)
        .map(|axis| {
            let along = places().map(|p| p[axis]);
            along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
        })
        .fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for (row, place) in frames.iter().zip(places()) {
        let motion = motions.iter().find(|m| m.name == format!("ball {}", row[1])).expect("every ball moves");
        let found = motion.at(number(&row[0]));
        for axis in 0..3 {
            worst = worst.max((found[axis] + origin[axis] - place[axis]).abs() / size);
        }
    }
    worst
}

#[test]
fn flights_between_events_are_exact() {
    // To single precision, of places and of times: a flight of 7 m/s is at another place 2^-24 of 10 s later. All of them are
    // parabolas or rest, or slide along straight lines, so that the splines themselves add nothing.
    for scene in ["ramp.toml", "ball-drops.toml", "cow.toml", "barrier-1d.toml"] {
        let worst = worst(scene, "events", "97");
        assert!(worst < 3e-6, "{scene}: {worst:e} of its size");
    }
    // The flights in air are quartics, which the splines follow to single precision.
    let worst = worst("room.toml", "events", "97");
    assert!(worst < 3e-6, "room: {worst:e} of its size");
}

#[test]
fn there_is_a_key_for_each_event_and_no_more() {
    let job = Job::on("ball-drops.toml");
    job.carom(&["export", "--quiet", "-o", "model.glb"]);
    let (motions, _) = motions(&job.read("model.glb"));
    let events = job.table(&["run", "--quiet", "--events", "-"]);
    for (ball, motion) in motions.iter().enumerate() {
        let mine = events.iter().filter(|row| row[1] == ball.to_string());
        let mut times: Vec<f64> = mine.map(|row| f64::from(number(&row[0]) as f32)).chain([0.0, 30.0]).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        assert_eq!(motion.times, times, "ball {ball}");
        assert_eq!(motion.values.len(), 3 * motion.times.len());
    }
}

#[test]
fn baked_keys_are_the_frames() {
    let worst = worst("ramp.toml", "fps=25", "25");
    assert!(worst < 1e-7, "{worst:e} of its size");
    let job = Job::on("ramp.toml");
    job.carom(&["export", "--quiet", "-o", "model.glb", "--keys", "fps=25"]);
    let (motions, _) = motions(&job.read("model.glb"));
    assert!(motions.iter().all(|motion| motion.times.len() == 251 && motion.interpolation == Interpolation::Linear));
}

#[test]
fn surfaces_are_where_they_are() {
    let job = Job::on("ramp.toml");
    job.carom(&["export", "--quiet", "-o", "model.glb"]);
    let bytes = job.read("model.glb");
    let model = gltf::Gltf::from_slice(&bytes).expect("valid glTF");
    let blob = model.blob.as_deref().expect("a binary chunk");
    let (_, origin) = motions(&bytes);
    let steep = model.meshes().find(|mesh| mesh.name() == Some("steep")).expect("the steep ramp");
    let primitive = steep.primitives().next().expect("its triangles");
    let reader = primitive.reader(|_| Some(blob));
    let mut corners: Vec<[i64; 3]> = reader
        .read_positions()
        .expect("corners")
        .map(|v| std::array::from_fn(|axis| (10.0 * (f64::from(v[axis]) + origin[axis])).round() as i64))
        .collect();
    corners.sort();
    // [[0, 0, 3.6], [6, 0, 0], [6, 1, 0], [0, 1, 3.6]], in tenths.
    assert_eq!(corners, [[0, 0, 36], [0, 10, 36], [60, 0, 0], [60, 10, 0]]);
    assert_eq!(reader.read_indices().expect("triangles").into_u32().count(), 6);
    assert!(model.nodes().any(|node| node.name() == Some("ball 2")));
}

#[test]
fn khronos_validator_finds_nothing() {
    // Where the project's continuous integration puts it.
    let tools = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/tools");
    let node = |script: &str, file: &str| Command::new("node").args(["-e", script, file]).current_dir(&tools).output();
    if !node("require('gltf-validator')", "").is_ok_and(|output| output.status.success()) {
        // Not by a macro, whose output a passing test swallows.
        let _ = writeln!(
            std::io::stderr(),
            "SKIP: no node with gltf-validator in target/tools, so the models are not validated"
        );
        return;
    }
    let script = "require('gltf-validator').validateBytes(new Uint8Array(require('fs').readFileSync(process.argv[1])))\
                  .then(report => console.log(JSON.stringify(report.issues)))";
    for scene in
        ["ramp.toml", "room.toml", "barrier-1d.toml", "cow.toml", "topspin.toml", "roll.toml", "jacksboro.toml"]
    {
        for keys in ["events", "fps=2"] {
            let job = Job::on(scene);
            job.carom(&["export", "--quiet", "-o", "model.glb", "--keys", keys]);
            let file = job.folder.path().join("model.glb");
            let output = node(script, &file.to_string_lossy()).expect("node runs");
            let issues: Value = serde_json::from_slice(&output.stdout).expect("a report");
            let count = |kind: &str| issues[kind].as_u64();
            assert_eq!((count("numErrors"), count("numWarnings")), (Some(0), Some(0)), "{scene}, {keys}: {issues}");
        }
    }
}
