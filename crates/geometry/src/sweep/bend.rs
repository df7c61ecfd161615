//! How a place of a mesh curves under a ball that rolls over it.

use nalgebra::{Point3, Vector3};

/// The shape that the centre of a ball follows while it moves on a place of a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bend {
    /// A plane.
    Flat,
    /// A cylinder around an edge.
    Around {
        /// A point of the edge.
        point: Point3<f64>,
        /// The unit direction of the edge.
        along: Vector3<f64>,
    },
    /// A sphere about a vertex.
    About {
        /// The vertex.
        point: Point3<f64>,
    },
}

impl Bend {
    /// From the edge or vertex to `centre`, at right angles to the edge; none on a plane.
    pub fn away_from(&self, centre: &Point3<f64>) -> Option<Vector3<f64>> {
        match self {
            Bend::Flat => None,
            Bend::Around { point, .. } | Bend::About { point } => Some(self.across(&(centre - point))),
        }
    }

    /// The part of `v` that follows the curve: across an edge, all of it about a vertex, none on a plane.
    pub fn across(&self, v: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Bend::Flat => Vector3::zeros(),
            Bend::Around { along, .. } => v - along * along.dot(v),
            Bend::About { .. } => *v,
        }
    }
}
