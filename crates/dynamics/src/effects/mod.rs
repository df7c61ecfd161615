//! The effects, one file each: what bends a flight (gravity, drag with wind) and what answers a contact (restitution,
//! friction).

pub mod drag;
pub mod friction;
pub mod gravity;
pub mod restitution;
