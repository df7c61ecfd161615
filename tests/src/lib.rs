//! What the cross-crate tests share.

pub mod catalogue;
pub mod data;
pub mod exact;
pub mod nasty;
pub mod obj;
pub mod random;
pub mod sources;
pub mod stage;
