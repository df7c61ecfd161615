//! Response and time: H19 to H30, and H32.

use super::Case;

/// The cases.
pub fn cases() -> Vec<Case> {
    Vec::new()
}
