//! The surfaces of a scene file: names, materials and shapes.

use super::build::{Builder, at};
use super::file::{MeshTable, PlaneTable, ShapeTable, SurfaceTable};
use super::problem::{Problem, choose};
use super::tree::Step;
use crate::mesh_file;
use carom_dynamics::surface::{Material, Shape, Surface};
use carom_geometry::error::PolygonError;
use carom_geometry::mesh::Mesh;
use carom_geometry::plane::Plane;
use carom_geometry::polygon::Polygon;
use nalgebra::{Point3, Vector3};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The surfaces; one that is not valid is left out, and told.
pub fn surfaces(
    builder: &mut Builder<'_>,
    tables: &[SurfaceTable],
    materials: &BTreeMap<String, Option<Material>>,
    folder: &Path,
) -> Vec<Surface> {
    let mut surfaces = Vec::with_capacity(tables.len());
    for (i, table) in tables.iter().enumerate() {
        if let Some(first) = tables[..i].iter().position(|t| t.name == table.name) {
            let problem = Problem::new(format!("the name {:?} is taken by surface {first} already", table.name));
            builder.refuse(at!["surfaces", i, "name"], problem.help("give each surface a name of its own"));
        }
        let material = material(builder, i, table, materials);
        let shape = match &table.shape {
            ShapeTable::Plane(plane) => plane_shape(builder, i, plane),
            ShapeTable::Polygon(vertices) => polygon_shape(builder, i, vertices),
            ShapeTable::Mesh(mesh) => mesh_shape(builder, i, mesh, folder),
        };
        if let Some((material, shape)) = material.zip(shape) {
            surfaces.push(Surface { name: table.name.clone(), material, shape });
        }
    }
    surfaces
}

fn material(
    builder: &mut Builder<'_>,
    i: usize,
    table: &SurfaceTable,
    materials: &BTreeMap<String, Option<Material>>,
) -> Option<Material> {
    let names = || materials.keys().map(String::as_str);
    let help = |word: &str, what: &str| {
        if materials.is_empty() {
            "add a material to the scene, such as [materials.wall] with `restitution`, and name it here".to_owned()
        } else {
            choose(word, what, names())
        }
    };
    match &table.material {
        None => {
            let problem = Problem::new(format!("the surface {:?} has no material", table.name));
            builder.refuse(at!["surfaces", i, "name"], problem.help(help("", "add `material`, one of the scene's")));
            None
        }
        Some(name) => materials.get(name).copied().unwrap_or_else(|| {
            let problem = Problem::new(format!("unknown material {name:?}"));
            builder.refuse(at!["surfaces", i, "material"], problem.help(help(name, "the scene's materials")));
            None
        }),
    }
}

fn plane_shape(builder: &mut Builder<'_>, i: usize, table: &PlaneTable) -> Option<Shape> {
    let (key, plane) = match (table.point, table.normal, table.coefficients) {
        (Some(point), Some(normal), None) => {
            ("normal", Plane::from_point_normal(Point3::from(point), Vector3::from(normal)))
        }
        (None, None, Some([a, b, c, d])) => ("coefficients", Plane::from_coefficients(a, b, c, d)),
        _ => {
            let problem = Problem::new("a plane is given by `point` and `normal`, or by `coefficients` alone");
            builder.refuse(at!["surfaces", i, "shape", "plane"], problem);
            return None;
        }
    };
    match plane {
        Ok(plane) => Some(Shape::Plane(plane)),
        Err(error) => {
            builder.refuse(at!["surfaces", i, "shape", "plane", key], Problem::new(error.to_string()));
            None
        }
    }
}

fn polygon_shape(builder: &mut Builder<'_>, i: usize, vertices: &[[f64; 3]]) -> Option<Shape> {
    match Polygon::new(vertices.iter().copied().map(Point3::from).collect()) {
        Ok(polygon) => Some(Shape::Polygon(polygon)),
        Err(error) => {
            let polygon = at!["surfaces", i, "shape", "polygon"];
            let vertex = match error {
                PolygonError::NotFinite { vertex, .. }
                | PolygonError::RepeatedVertex { vertex, .. }
                | PolygonError::NotPlanar { vertex, .. } => Some(vertex),
                PolygonError::EdgesCross { second, .. } => Some(second),
                _ => None,
            };
            let place: Vec<_> = polygon.iter().copied().chain(vertex.map(Step::Index)).collect();
            builder.refuse(&place, Problem::new(error.to_string()));
            None
        }
    }
}

fn mesh_shape(builder: &mut Builder<'_>, i: usize, table: &MeshTable, folder: &Path) -> Option<Shape> {
    if !(table.scale.is_finite() && table.scale > 0.0) {
        let message = format!("scale is {:?}, but must be finite and > 0, in m per unit of the file", table.scale);
        builder.refuse(at!["surfaces", i, "shape", "mesh", "scale"], Problem::new(message));
        return None;
    }
    let refuse = |builder: &mut Builder<'_>, message: String| {
        builder.refuse(at!["surfaces", i, "shape", "mesh", "file"], Problem::new(message));
        None
    };
    let mut raw = match mesh_file::read(&folder.join(&table.file)) {
        Ok(raw) => raw,
        Err(error) => return refuse(builder, format!("cannot use the mesh: {error}")),
    };
    raw.place(table.up, table.scale, table.translate);
    match Mesh::new(raw.vertices, raw.faces) {
        Ok(mesh) => Some(Shape::Mesh(Arc::new(mesh))),
        Err(error) => refuse(builder, format!("cannot use the mesh {}: {error}", table.file)),
    }
}
