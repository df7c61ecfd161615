//! Mesh files: OBJ, STL and PLY into vertices and triangles.

mod obj;
mod ply;
mod polygonize;
mod stl;

use crate::scene::file::Up;
use nalgebra::Point3;
use std::path::Path;
use thiserror::Error;

/// Vertices in the file's units, and triangles as indices into them, every index in range.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RawMesh {
    pub vertices: Vec<Point3<f64>>,
    pub faces: Vec<[u32; 3]>,
}

/// Why a mesh file cannot be used, and where in it.
#[derive(Debug, Error)]
pub enum MeshFileError {
    #[error("{path}: {source}")]
    Io { path: String, source: std::io::Error },
    #[error("{path}: cannot tell the kind of mesh from the extension; use .obj, .stl or .ply")]
    Extension { path: String },
    #[error("{path}:{line}: {message}")]
    Line { path: String, line: usize, message: String },
    #[error("{path}: {message}")]
    Whole { path: String, message: String },
}

/// What a reader found wrong: the line, if it knows one, and the message.
#[derive(Debug)]
struct Fault {
    line: Option<usize>,
    message: String,
}

impl Fault {
    fn at(line: usize, message: impl Into<String>) -> Self {
        Self { line: Some(line), message: message.into() }
    }

    fn whole(message: impl Into<String>) -> Self {
        Self { line: None, message: message.into() }
    }
}

/// Whether the extension of `path` is that of a mesh file.
pub fn is_mesh(path: &Path) -> bool {
    kind(path).is_some()
}

#[derive(Clone, Copy)]
enum Kind {
    Obj,
    Stl,
    Ply,
}

fn kind(path: &Path) -> Option<Kind> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "obj" => Some(Kind::Obj),
        "stl" => Some(Kind::Stl),
        "ply" => Some(Kind::Ply),
        _ => None,
    }
}

/// Reads the mesh file at `path`, the kind following from its extension.
///
/// Coordinates are the nearest f64 to what the file says (STL, and PLY where it says `float`, are f32 by their formats).
/// Every index is in range, every coordinate finite, and there is at least one face; all else is the mesh doctor's.
pub fn read(path: &Path) -> Result<RawMesh, MeshFileError> {
    let shown = path.display().to_string();
    let Some(kind) = kind(path) else { return Err(MeshFileError::Extension { path: shown }) };
    let bytes = std::fs::read(path).map_err(|source| MeshFileError::Io { path: shown.clone(), source })?;
    let mesh = match kind {
        Kind::Obj => obj::read(&bytes),
        Kind::Stl => stl::read(&bytes),
        Kind::Ply => ply::read(&bytes),
    };
    let mesh = mesh.and_then(|mesh| match (mesh.vertices.is_empty(), mesh.faces.is_empty()) {
        (true, _) => Err(Fault::whole("the mesh is empty: it has no vertices")),
        (_, true) => Err(Fault::whole("the mesh is empty: it has vertices, but no faces")),
        _ => Ok(mesh),
    });
    mesh.map_err(|Fault { line, message }| match line {
        Some(line) => MeshFileError::Line { path: shown, line, message },
        None => MeshFileError::Whole { path: shown, message },
    })
}

impl RawMesh {
    /// Turns the axis `up` to z, the others following in cyclic order, then scales, then translates.
    pub fn place(&mut self, up: Up, scale: f64, translate: [f64; 3]) {
        let [tx, ty, tz] = translate;
        for v in &mut self.vertices {
            let (x, y, z) = match up {
                Up::X => (v.y, v.z, v.x),
                Up::Y => (v.z, v.x, v.y),
                Up::Z => (v.x, v.y, v.z),
            };
            *v = Point3::new(x * scale + tx, y * scale + ty, z * scale + tz);
        }
    }
}
