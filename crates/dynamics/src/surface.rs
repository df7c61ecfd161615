//! What a ball can bounce on: a shape made of a material.

use crate::effects::friction::Friction;
use crate::effects::restitution::Restitution;
use carom_geometry::mesh::Mesh;
use carom_geometry::plane::Plane;
use carom_geometry::polygon::Polygon;
use std::sync::Arc;

/// How a surface answers an impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Restitution.
    pub restitution: Restitution,
    /// Friction.
    pub friction: Friction,
}

/// The shape of a surface; both of its sides collide.
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
#[derive(Debug, Clone)]
pub struct Surface {
    /// Its name in events.
    pub name: String,
    /// What it is made of.
    pub material: Material,
    /// Where it is.
    pub shape: Shape,
}
