//! Scenes and queries of known size, made by formula: what the benchmarks, the counts of instructions and the peers all work on.

pub mod random;
pub mod terrain;
pub mod scenes;
