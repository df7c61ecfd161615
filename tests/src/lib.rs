//! What the cross-crate tests share.

pub mod checker;
pub mod data;
pub mod grid;
pub mod nasty;
pub mod obj;
pub mod sources;
pub mod world;
