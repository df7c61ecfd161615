//! Detection: H1 to H18, and H31.

mod extremes;
mod grazing;
mod inputs;
mod order;
mod polygons;
mod rims;
mod rows;
mod slivers;
mod start;
mod watertight;

use super::Case;

/// The cases.
pub fn cases() -> Vec<Case> {
    let pieces = [
        start::cases(),
        grazing::cases(),
        watertight::cases(),
        slivers::cases(),
        polygons::cases(),
        extremes::cases(),
        order::cases(),
        inputs::cases(),
        rims::cases(),
    ];
    pieces.into_iter().flatten().collect()
}
