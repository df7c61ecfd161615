//! Fuzzing on stable Rust: scene and mesh files that are changed at random and read by the program; what is valid is planned and run.
//!
//! Nothing may panic, and nothing may take long: what comes out is an error in words, or a run.

use crate::patience::simulate_within;
use crate::random::Random;
use crate::sources;
use carom_dynamics::plan::Plan;
use carom_geometry::doctor::diagnose;
use std::fs;
use std::path::{Path, PathBuf};

/// Words that are likely to be handled wrongly where they do not belong, or at their limits.
const WORDS: [&str; 44] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "4294967295",
    "4294967296",
    "-9223372036854775808",
    "1e-320",
    "5e-324",
    "1e308",
    "1.7976931348623157e308",
    "1e309",
    "nan",
    "inf",
    "-inf",
    "0.1",
    "1e-9",
    "true",
    "\"\"",
    "\"floor\"",
    "[]",
    "{}",
    "[0, 0, 0]",
    "[1e300, -1e300, 1e300]",
    "[0, 0, 1e-300]",
    "plane",
    "polygon",
    "mesh",
    "point",
    "normal",
    "linear",
    "coulomb",
    "impulse",
    "grid",
    "step",
    "tolerance",
    "\n[[balls]]\n",
    "\n[[surfaces]]\n",
    "f 1 2 3\n",
    "v 1e200 0 0\n",
    "\u{0}",
    "\u{feff}",
    "#",
];
/// Numbers that are legal in many places.
const NUMBERS: [&str; 16] = [
    "0",
    "1",
    "-1",
    "0.5",
    "0.25",
    "-0.5",
    "2",
    "3.5",
    "1e-3",
    "1e-9",
    "1e6",
    "-1e3",
    "0.9999999999999999",
    "5e-324",
    "1e150",
    "1e-200",
];
/// Balls of a scene that are run, and stretches of each.
const BALLS: usize = 2;
const STRETCHES: u64 = 2000;
/// Scenes of more balls are planned and not run.
const MOST_BALLS: usize = 100_000;

/// What became of changed files.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Refused, in words.
    pub refused: u64,
    /// Read, and refused as a whole.
    pub unplanned: u64,
    /// Read and run, or diagnosed.
    pub ran: u64,
}

/// The files that are changed, and a folder for what comes of it.
pub struct Fuzz {
    corpus: Vec<(String, Vec<u8>)>,
    folder: PathBuf,
}

impl Fuzz {
    /// The scenes that come with the program, its small meshes, and the conformance pack; `folder` is there and is the caller's.
    pub fn new(folder: &Path) -> Self {
        let scenes =
            [sources::files("crates/app/scenes", &[".toml"]), sources::files("conformance/scenes", &[".toml", ".obj"])];
        let mut corpus: Vec<(String, Vec<u8>)> =
            scenes.into_iter().flatten().map(|file| (file.path, file.text.into_bytes())).collect();
        corpus.extend(
            sources::files("crates/app/scenes/meshes", &["stairs.obj"])
                .into_iter()
                .map(|f| (f.path, f.text.into_bytes())),
        );
        corpus.push(("a.ply".to_owned(), PLY.as_bytes().to_vec()));
        corpus.push(("a.stl".to_owned(), STL.as_bytes().to_vec()));
        corpus.push(("b.stl".to_owned(), binary_stl()));
        // So that scenes find a mesh where they look for one, a small one.
        let meshes = folder.join("meshes");
        let _ = fs::create_dir_all(&meshes);
        let stairs = corpus.iter().find(|(path, _)| path.ends_with("stairs.obj")).map(|(_, bytes)| bytes.clone());
        for (path, bytes) in corpus.iter().filter(|(path, _)| path.starts_with("conformance") && path.ends_with(".obj"))
        {
            let _ = fs::write(folder.join(path.rsplit('/').next().unwrap_or(path)), bytes);
        }
        for name in ["spot_triangulated.obj", "jacksboro_dem_quarter.obj", "stairs.obj"] {
            let _ = fs::write(meshes.join(name), stairs.clone().unwrap_or_default());
        }
        Self { corpus, folder: folder.to_path_buf() }
    }

    /// The file of a seed: its name, and its bytes.
    pub fn file(&self, seed: u64) -> (String, Vec<u8>) {
        let mut random = Random::new(seed.wrapping_mul(0xd6e8_feb8_6659_fd93));
        let (path, bytes) = &self.corpus[random.below(self.corpus.len())];
        let mut bytes = bytes.clone();
        for _ in 0..=random.below(4) {
            change(&mut bytes, &mut random);
        }
        (path.rsplit('/').next().unwrap_or(path).to_owned(), bytes)
    }

    /// Reads the file of a seed, and runs what is valid.
    pub fn run(&self, seed: u64, tally: &mut Tally) {
        let (name, bytes) = self.file(seed);
        let path = self.folder.join(format!("{seed}-{name}"));
        fs::write(&path, bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        if name.ends_with(".toml") {
            scene(&path, tally);
        } else {
            match carom::read_mesh(&path) {
                Err(_) => tally.refused += 1,
                Ok(mesh) => {
                    diagnose(mesh.vertices(), mesh.faces());
                    tally.ran += 1;
                }
            }
        }
        let _ = fs::remove_file(&path);
    }
}

fn scene(path: &Path, tally: &mut Tally) {
    let Ok(scene) = carom::read_scene(path) else {
        tally.refused += 1;
        return;
    };
    let Ok(plan) = Plan::new(&scene) else {
        tally.unplanned += 1;
        return;
    };
    tally.ran += 1;
    if plan.balls().len() <= MOST_BALLS {
        for ball in plan.balls().iter().take(BALLS) {
            // Where it ends is no matter here; that it panics or hangs would be.
            let _ = simulate_within(&plan, ball, &mut (), STRETCHES);
        }
    }
}

/// One change: of a byte, a piece, a word or a number.
fn change(bytes: &mut Vec<u8>, random: &mut Random) {
    let at = |random: &mut Random, bytes: &[u8]| random.below(bytes.len() + 1).min(bytes.len());
    match random.below(12) {
        0 if !bytes.is_empty() => {
            let i = random.below(bytes.len());
            bytes[i] ^= 1 << random.below(8);
        }
        1 => {
            let (a, b) = (at(random, bytes), at(random, bytes));
            let (a, b) = (a.min(b), b.max(a).min(a.min(b) + 64));
            bytes.drain(a..b);
        }
        2 => {
            let a = at(random, bytes);
            let b = (a + random.below(64)).min(bytes.len());
            let (piece, to) = (bytes[a..b].to_vec(), at(random, bytes));
            bytes.splice(to..to, piece);
        }
        3 => {
            let to = at(random, bytes);
            bytes.splice(to..to, WORDS[random.below(WORDS.len())].bytes());
        }
        4 => bytes.truncate(at(random, bytes)),
        5..=9 => {
            let mut words = words(bytes);
            words.retain(|word| bytes[word.start].is_ascii_digit() || bytes[word.start] == b'-');
            if let Some(word) = (!words.is_empty()).then(|| words[random.below(words.len())].clone()) {
                bytes.splice(word, NUMBERS[random.below(NUMBERS.len())].bytes());
            }
        }
        _ => {
            let words = words(bytes);
            if let Some(word) = (!words.is_empty()).then(|| words[random.below(words.len())].clone()) {
                let other = match random.below(3) {
                    0 => bytes[words[random.below(words.len())].clone()].to_vec(),
                    _ => WORDS[random.below(WORDS.len())].as_bytes().to_vec(),
                };
                bytes.splice(word, other);
            }
        }
    }
}

/// The places of words and numbers outside of comments.
fn words(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    let (mut words, mut start, mut comment) = (Vec::new(), None, false);
    for (i, &b) in bytes.iter().enumerate() {
        comment = (comment || b == b'#') && b != b'\n';
        let within = !comment && (b.is_ascii_alphanumeric() || b"._-+".contains(&b));
        match (within, start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                words.push(from..i);
                start = None;
            }
            _ => {}
        }
    }
    words
}

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n\
    property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n3 0 1 2\n3 0 2 3\n";
const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";

fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(2u32.to_le_bytes());
    for facet in [[0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], [0.0; 12]] {
        bytes.extend(facet.iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}
