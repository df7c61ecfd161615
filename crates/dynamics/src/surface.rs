//! What a ball can bounce on: a shape made of a material.

use crate::effects::friction::Friction;
use crate::effects::restitution::Restitution;
use carom_geometry::mesh::Mesh;
use carom_geometry::plane::Plane;
use carom_geometry::polygon::Polygon;
use std::sync::Arc;

/// How a surface answers an impact.
///
/// ```
/// use carom_dynamics::effects::{friction::Friction, restitution::Restitution};
/// use carom_dynamics::surface::Material;
///
/// let court = Material { restitution: Restitution::new(0.75)?, friction: Friction::coulomb(0.6)? };
/// assert_eq!(court.restitution.coefficient(), 0.75);
/// assert!(Restitution::new(1.2).is_err(), "nothing rebounds faster than it came");
/// # Ok::<(), carom_dynamics::error::ValueError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Restitution.
    pub restitution: Restitution,
    /// Friction.
    pub friction: Friction,
}

/// The shape of a surface; both of its sides collide.
///
/// ```
/// use carom_dynamics::geometry::{mesh::Mesh, plane::Plane, polygon::Polygon};
/// use carom_dynamics::nalgebra::{Point3, Vector3};
/// use carom_dynamics::surface::Shape;
/// use std::sync::Arc;
///
/// let floor = Shape::Plane(Plane::from_point_normal(Point3::origin(), Vector3::z())?);
/// let corners = vec![Point3::origin(), Point3::new(2.0, 0.0, 0.0), Point3::new(0.0, 2.0, 1.0)];
/// let ramp = Shape::Polygon(Polygon::new(corners.clone())?);
/// // A mesh may be shared by many scenes.
/// let mesh = Arc::new(Mesh::new(corners, vec![[0, 1, 2]])?);
/// let hill = Shape::Mesh(Arc::clone(&mesh));
/// # let _ = (floor, ramp, hill);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub enum Shape {
    /// An infinite plane.
    Plane(Plane),
    /// A simple planar polygon, convex or concave.
    Polygon(Polygon),
    /// A triangle mesh.
    Mesh(Arc<Mesh>),
}

/// A fixed surface with a name, by which events refer to it.
///
/// ```
/// use carom_dynamics::effects::{friction::Friction, restitution::Restitution};
/// use carom_dynamics::geometry::plane::Plane;
/// use carom_dynamics::nalgebra::{Point3, Vector3};
/// use carom_dynamics::surface::{Material, Shape, Surface};
///
/// let wall = Plane::from_point_normal(Point3::new(3.0, 0.0, 0.0), -Vector3::x())?;
/// let plaster = Material { restitution: Restitution::new(0.6)?, friction: Friction::None };
/// let surface = Surface { name: "wall".into(), material: plaster, shape: Shape::Plane(wall) };
/// assert_eq!(surface.name, "wall");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Surface {
    /// Its name in events.
    pub name: String,
    /// What it is made of.
    pub material: Material,
    /// Where it is.
    pub shape: Shape,
}
