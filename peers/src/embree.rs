//! The segments as Embree has them: a program in C++, compiled and run where the compiler and Debian's `libembree-dev` are there.

use carom_benches::scenes::Result;
use carom_benches::segments::Segment;
use nalgebra::Point3;
use std::env::temp_dir;
use std::fs;
use std::process::{Command, Stdio, id};

const PROGRAM: &str = include_str!("embree.cpp");

/// The median times in ns of a segment of each set, of so many runs; none where Embree cannot be had.
pub fn segments(
    vertices: &[Point3<f64>],
    faces: &[[u32; 3]],
    sets: &[&[Segment]],
    runs: usize,
) -> Result<Option<Vec<f64>>> {
    let folder = temp_dir().join(format!("carom-embree-{}", id()));
    fs::create_dir_all(&folder)?;
    let times = in_folder(&folder, vertices, faces, sets, runs);
    fs::remove_dir_all(&folder)?;
    times
}

fn in_folder(
    folder: &std::path::Path,
    vertices: &[Point3<f64>],
    faces: &[[u32; 3]],
    sets: &[&[Segment]],
    runs: usize,
) -> Result<Option<Vec<f64>>> {
    let (source, program, data) = (folder.join("embree.cpp"), folder.join("embree"), folder.join("data"));
    fs::write(&source, PROGRAM)?;
    let mut compile = Command::new("g++");
    compile.args(["-O3", "-o"]).args([&program, &source]).arg("-lembree3").stderr(Stdio::null());
    if !compile.status().is_ok_and(|status| status.success()) {
        eprintln!("segments: no Embree here (Debian's libembree-dev and g++)");
        return Ok(None);
    }
    // Numbers of vertices, faces, sets and runs, and for each set that of its segments; then f32 and u32, all in the order of this machine.
    let mut bytes = Vec::new();
    let counts = [vertices.len(), faces.len(), sets.len(), runs].into_iter().chain(sets.iter().map(|set| set.len()));
    counts.for_each(|n| bytes.extend((n as u64).to_ne_bytes()));
    let mut put = |c: &f64| bytes.extend((*c as f32).to_ne_bytes());
    vertices.iter().for_each(|v| v.iter().for_each(&mut put));
    faces.iter().flatten().for_each(|v| bytes.extend(v.to_ne_bytes()));
    let mut put = |c: &f64| bytes.extend((*c as f32).to_ne_bytes());
    sets.iter().copied().flatten().for_each(|(from, along)| from.iter().chain(along.iter()).for_each(&mut put));
    fs::write(&data, bytes)?;
    let output = Command::new(&program).arg(&data).output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let times =
        String::from_utf8(output.stdout)?.lines().map(str::parse).collect::<std::result::Result<Vec<f64>, _>>()?;
    Ok((times.len() == sets.len()).then_some(times))
}
