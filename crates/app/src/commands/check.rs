//! `carom check`: all that is wrong with a scene or a mesh.

use crate::cli::CheckArgs;
use crate::error::AppError;
use crate::mesh_file::{self, MeshFileError};
use crate::scene::problem::{Severity, render_plain};
use crate::scene::{self, Loaded};
use crate::summary::points_note;
use crate::terminal::{say, styled};
use carom_dynamics::plan::Plan;
use carom_dynamics::surface::Shape;
use carom_geometry::doctor::{self, Finding};
use nalgebra::Point3;
use std::collections::BTreeMap;
use std::mem::{Discriminant, discriminant};
use std::path::Path;

/// How many findings of a kind are shown before the rest is only counted.
const SHOWN: usize = 10;

/// Checks a file and prints the findings on standard error.
pub fn check(args: &CheckArgs) -> Result<(), AppError> {
    if mesh_file::is_mesh(&args.file) {
        check_mesh(&args.file)
    } else if scene::is_scene(&args.file) {
        check_scene(&args.file)
    } else {
        let path = args.file.display();
        Err(AppError::Usage(format!("{path}: a scene ends in .toml or .json, a mesh in .obj, .stl or .ply")))
    }
}

fn check_mesh(path: &Path) -> Result<(), AppError> {
    let mesh = mesh_file::read(path).map_err(|error| match error {
        MeshFileError::Io { path, source } => AppError::Read { path, source },
        error => AppError::Mesh(error.to_string()),
    })?;
    let size = [count(mesh.vertices.len(), "vertex", "vertices"), count(mesh.faces.len(), "face", "faces")].join(", ");
    conclude(&path.display().to_string(), &size, examine(&path.display().to_string(), &mesh.vertices, &mesh.faces))
}

fn check_scene(path: &Path) -> Result<(), AppError> {
    let (Loaded { scene, .. }, plan) = &loaded(path)?;
    let mut totals = Totals::default();
    for surface in &scene.surfaces {
        if let Shape::Mesh(mesh) = &surface.shape {
            let found = examine(&format!("surface {:?}", surface.name), mesh.vertices(), mesh.faces());
            totals.errors += found.errors;
            totals.warnings += found.warnings;
        }
    }
    if let Some(note) = points_note(plan) {
        tell(doctor::Severity::Note, &note);
    }
    let surfaces = count(scene.surfaces.len(), "surface", "surfaces");
    let size = [surfaces, count(scene.balls.len(), "ball", "balls")].join(", ");
    conclude(&path.display().to_string(), &size, totals)
}

/// The scene with its plan, if it is one that can be planned.
fn loaded(path: &Path) -> Result<(Loaded, Plan), AppError> {
    let loaded = scene::load(path, None)?;
    match Plan::new(&loaded.scene) {
        Ok(plan) => Ok((loaded, plan)),
        Err(error) => Err(loaded.refuse(&error)),
    }
}

/// How many findings there were.
#[derive(Default)]
struct Totals {
    errors: usize,
    warnings: usize,
}

/// Shows what the mesh doctor finds; long lists of one kind are cut.
fn examine(name: &str, vertices: &[Point3<f64>], faces: &[[u32; 3]]) -> Totals {
    let mut totals = Totals::default();
    let mut seen: BTreeMap<usize, usize> = BTreeMap::new();
    let mut kinds: Vec<(Discriminant<Finding>, doctor::Severity)> = Vec::new();
    for finding in doctor::diagnose(vertices, faces) {
        let severity = finding.severity();
        match severity {
            doctor::Severity::Error => totals.errors += 1,
            doctor::Severity::Warning => totals.warnings += 1,
            doctor::Severity::Note => {}
        }
        let kind = discriminant(&finding);
        let index = kinds.iter().position(|(k, _)| *k == kind).unwrap_or_else(|| {
            kinds.push((kind, severity));
            kinds.len() - 1
        });
        let count = seen.entry(index).or_default();
        *count += 1;
        if *count <= SHOWN {
            tell(severity, &format!("{name}: {finding}"));
        }
    }
    for (index, count) in seen {
        if count > SHOWN {
            let (_, severity) = kinds[index];
            tell(severity, &format!("{name}: {} more of the kind of the last", count - SHOWN));
        }
    }
    totals
}

fn tell(severity: doctor::Severity, message: &str) {
    let severity = match severity {
        doctor::Severity::Error => Severity::Error,
        doctor::Severity::Warning => Severity::Warning,
        doctor::Severity::Note => Severity::Note,
    };
    say(&render_plain(severity, message, None, styled()));
}

fn conclude(path: &str, size: &str, totals: Totals) -> Result<(), AppError> {
    let warnings = count(totals.warnings, "warning", "warnings");
    if totals.errors > 0 {
        return Err(AppError::Mesh(format!("{path}: {}, {warnings}", count(totals.errors, "error", "errors"))));
    }
    say(&format!("{path}: valid ({size}, {warnings})"));
    Ok(())
}

fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}
