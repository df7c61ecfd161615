//! Planes, polygons, triangles and meshes against moving points and balls, with certified decisions.
//!
//! The crate knows no time and no physics: a moving point is a path over f in [0, 1].

// In dependency order: a module imports only from those above it.
pub mod bounds;
pub mod bvh;
pub mod error;
pub mod rounding;
mod exact;
pub mod predicates;
pub mod projection;
pub mod normal;
pub mod plane;
pub mod inside;
pub mod closest;
pub mod triangle;
pub mod segment;
pub mod polygon;
pub mod clearance;
pub mod path;
pub mod mesh;
pub mod doctor;
pub mod contact;
