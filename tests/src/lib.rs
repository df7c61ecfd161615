//! What the cross-crate tests share.

pub mod catalogue;
pub mod checker;
pub mod closed;
pub mod conformance;
pub mod data;
pub mod exact;
pub mod fuzz;
pub mod grid;
pub mod hunt;
pub mod nasty;
pub mod obj;
pub mod oracle;
pub mod patience;
pub mod parallel;
pub mod random;
pub mod shots;
pub mod soak;
pub mod solids;
pub mod sources;
pub mod stage;
pub mod world;
