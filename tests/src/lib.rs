//! What the cross-crate tests share.

pub mod catalogue;
pub mod data;
pub mod nasty;
pub mod obj;
pub mod oracle;
pub mod sources;
pub mod stage;
