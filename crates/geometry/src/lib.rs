//! Planes, polygons, triangles and meshes against moving points and balls, with certified decisions.
//!
//! The crate knows no time and no physics: a moving point is a [path](path::Path) over f in [0, 1], and the questions are where a point
//! lies, what is nearest, and at which f a point or a ball on its path first meets something.
//!
//! # What it promises
//!
//! - Signs are exact: on which side of a plane, inside or outside, on an edge or a vertex, crossing or not ([`predicates`], [`inside`],
//!   [`segment`], [`polygon`]). No tolerance is involved, and the answer does not depend on the order of the arguments.
//! - Numbers come with a bound: each is a formula in the unit roundoff u = 2^-53, stands in [`rounding`] with its derivation, and is held
//!   against exact arithmetic by the tests.
//! - Searches are certified: a [first contact](mesh::Mesh::first_contact) is never late and never missed, an entry that cannot be told from a touch
//!   counts as one, and every search says how it ended.
//! - Input is checked once, where a [plane](plane::Plane::from_point_normal), a [polygon](polygon::Polygon::new) or a
//!   [mesh](mesh::Mesh::new) is made; the error says which vertex is wrong and what would be right. Nothing panics on numbers.
//!
//! Lengths may be in any unit, usually m; coordinates are any finite `f64` whose squares are in range. All types are `Send` and `Sync`.
//!
//! # A first example
//!
//! A ball falls onto a floor, and f is the share of its path at which it is there:
//!
//! ```
//! use carom_geometry::nalgebra::{Point3, Vector3};
//! use carom_geometry::path::Path;
//! use carom_geometry::plane::{Plane, Side};
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
//!
//! # Where to go on
//!
//! - [`polygon`] and [`inside`]: point in polygon, convex or concave. Example: `point_in_polygon`.
//! - [`mesh`], [`doctor`], [`segment`], [`closest`]: closed meshes, what is wrong with them, segments against them. Example: `watertight_mesh`.
//! - [`path`], [`clearance`], [`sweep`]: moving points and balls.
//! - What balls do when they have hit: the crate `carom-dynamics`.

/// The crate of vectors and points that every signature uses, in the version it uses.
pub use nalgebra;

// In dependency order: a module imports only from those above it.
pub mod error;
pub mod rounding;
pub mod bounds;
mod shear;
pub mod order;
pub mod bvh;
mod exact;
mod twofold;
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
