//! Planes, polygons, triangles and meshes against moving points and balls, with certified decisions.
//!
//! The crate knows no time and no physics: a moving point is a path over f in [0, 1].
//!
//! ```
//! use carom_geometry::path::Path;
//! use carom_geometry::plane::{Plane, Side};
//! use nalgebra::{Point3, Vector3};
//!
//! # fn main() -> Result<(), carom_geometry::error::PlaneError> {
//! let floor = Plane::from_point_normal(Point3::origin(), Vector3::z())?;
//! let radius = 0.5;
//!
//! // In one step of Euler's method the path is straight, and f is the chapter's.
//! let path = Path::line(Point3::new(0.0, 0.0, 2.0), Vector3::new(1.0, 0.0, -3.0));
//! let before = floor.clearance(&path.start(), radius, Side::Positive);
//! let after = floor.clearance(&path.at(1.0), radius, Side::Positive);
//! let entry = path.clearance(before, &floor.normal()).first_entry(0.0, 1.0);
//! assert_eq!(entry.f(), Some(before / (before - after)));
//!
//! // Under gravity it is a parabola, and f is as exact.
//! let path = Path::parabola(Point3::new(0.0, 0.0, 2.5), Vector3::x(), Vector3::new(0.0, 0.0, -8.0));
//! let entry = path.clearance(2.0, &floor.normal()).first_entry(0.0, 1.0);
//! assert_eq!(entry.f(), Some(0.5));
//! # Ok(())
//! # }
//! ```

/// The crate of vectors and points that every signature uses, in the version it uses.
pub use nalgebra;

// In dependency order: a module imports only from those above it.
pub mod error;
pub mod rounding;
pub mod bounds;
pub mod bvh;
mod exact;
pub mod predicates;
pub mod projection;
pub mod normal;
pub mod plane;
pub mod inside;
pub mod closest;
pub mod triangle;
pub mod segment;
mod simple;
pub mod polygon;
pub mod quad;
mod bernstein;
pub mod clearance;
pub mod path;
pub mod mesh;
pub mod doctor;
pub mod site;
pub mod contact;
mod screen;
pub mod sweep;
pub mod pierce;
