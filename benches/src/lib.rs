//! Scenes and queries of known size, made by formula: what the benchmarks, the counts of instructions and the peers all work on.

pub mod cases;
pub mod clock;
pub mod random;
pub mod terrain;
pub mod segments;
pub mod scenes;
pub mod operations;
