//! What can be wrong with geometric input.

use nalgebra::Point3;
use thiserror::Error;

/// Why a plane was refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PlaneError {
    /// A coordinate or coefficient is NaN or infinite.
    #[error("{name} of the plane is {value}, but must be finite")]
    NotFinite {
        /// Which number, such as `normal x` or `coefficient D`.
        name: &'static str,
        /// The refused value.
        value: f64,
    },
    /// A normal of length zero has no direction.
    #[error("the normal (A, B, C) of the plane is zero; at least one of its components must not be")]
    ZeroNormal,
    /// Three points on one line lie in many planes.
    #[error("the points {points:?} lie on one line (exactly) and span no plane; move one of them off it")]
    Collinear {
        /// The points.
        points: [Point3<f64>; 3],
    },
    /// The plane is farther from the origin than f64 reaches.
    #[error("the plane with D = {offset} and a normal of length about {length} lies beyond what f64 can represent")]
    OutOfRange {
        /// D.
        offset: f64,
        /// The largest of |A|, |B|, |C|.
        length: f64,
    },
}

/// Why a triangle was refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum TriangleError {
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} of the triangle is {point:?}, but must be finite")]
    NotFinite {
        /// Index of the vertex, 0 to 2.
        vertex: usize,
        /// The vertex.
        point: Point3<f64>,
    },
    /// The vertices lie on one line, or coincide: the area is exactly zero.
    #[error("the triangle {vertices:?} has zero area (exactly); its vertices must not lie on one line")]
    ZeroArea {
        /// The vertices.
        vertices: [Point3<f64>; 3],
    },
}

/// Why a polygon was refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PolygonError {
    /// Fewer than three vertices.
    #[error("the polygon has {count} vertices, but needs at least 3")]
    TooFewVertices {
        /// How many it has.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} of the polygon is {point:?}, but must be finite")]
    NotFinite {
        /// Index of the vertex, from 0.
        vertex: usize,
        /// The vertex.
        point: Point3<f64>,
    },
    /// Two consecutive vertices are the same point.
    #[error("vertices {vertex} and {next} of the polygon are both {point:?}; drop one of them")]
    RepeatedVertex {
        /// Index of the first of the two.
        vertex: usize,
        /// Index of the one after it (0 after the last).
        next: usize,
        /// The point.
        point: Point3<f64>,
    },
    /// All vertices lie on one line.
    #[error("all vertices of the polygon lie on one line (exactly), so it has no area")]
    Collinear,
    /// A vertex is off the plane of the polygon by more than rounding explains.
    #[error(
        "vertex {vertex} of the polygon is {distance} off its plane, more than the {bound:e} that rounded coordinates explain; split it into triangles"
    )]
    NotPlanar {
        /// Index of the vertex farthest off, from 0.
        vertex: usize,
        /// How far off it is.
        distance: f64,
        /// How far off it may be.
        bound: f64,
    },
    /// Two edges cross, touch or overlap.
    #[error(
        "edges {first} and {second} of the polygon cross or touch (edge i runs from vertex i to the next); edges may meet only at the vertex between them"
    )]
    EdgesCross {
        /// Index of the first edge.
        first: usize,
        /// Index of the second edge, larger than the first.
        second: usize,
    },
    /// A half of a quadrilateral that is not planar has no area.
    #[error("a half of the quadrilateral: {0}")]
    Half(#[from] TriangleError),
}
