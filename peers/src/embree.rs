//! The queries as Embree's robust mode has them, where Debian's `libembree-dev` and a C++ compiler are installed.

use crate::segments::Segments;
use carom_benches::scenes::Result;
use nalgebra::Point3;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The program that asks Embree, compiled.
pub struct Embree(PathBuf);

impl Embree {
    /// Compiles it; none where that cannot be done.
    pub fn new() -> Option<Self> {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let (source, program) = (folder.join("src/embree.cpp"), folder.join("target/embree"));
        let mut compiler = Command::new("c++");
        compiler.args(["-O3", "-o"]).arg(&program).arg(source).arg("-lembree3").stderr(Stdio::null());
        compiler.status().is_ok_and(|status| status.success()).then_some(Self(program))
    }

    /// The seconds that each of `sets` takes against the mesh, and how many of its segments meet it.
    pub fn times(&self, vertices: &[Point3<f64>], faces: &[[u32; 3]], sets: &[Segments]) -> Result<Vec<(f64, usize)>> {
        let mut input: Vec<u8> = Vec::new();
        let mut number = |n: usize| input.extend(u32::try_from(n).unwrap_or(u32::MAX).to_ne_bytes());
        number(vertices.len());
        number(faces.len());
        let single = |x: &f64| (*x as f32).to_ne_bytes();
        vertices.iter().flat_map(|v| v.iter()).for_each(|x| input.extend(single(x)));
        faces.iter().flatten().for_each(|i| input.extend(i.to_ne_bytes()));
        input.extend((sets.len() as u32).to_ne_bytes());
        for set in sets {
            input.extend((set.len() as u32).to_ne_bytes());
            set.iter().flat_map(|(from, along)| from.iter().chain(along.iter())).for_each(|x| input.extend(single(x)));
        }
        let mut program = Command::new(&self.0).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
        // Taken, so that it is closed where all is written.
        program.stdin.take().ok_or("no standard input")?.write_all(&input)?;
        let output = program.wait_with_output()?;
        let text = String::from_utf8(output.stdout)?;
        let row = |line: &str| {
            let (seconds, hits) = line.split_once(' ')?;
            Some((seconds.parse().ok()?, hits.parse().ok()?))
        };
        text.lines().map(|line| row(line).ok_or_else(|| format!("Embree's program says {line}").into())).collect()
    }
}
