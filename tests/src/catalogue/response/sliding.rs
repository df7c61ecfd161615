//! x
use super::super::Case;
pub(super) const CASES: &[Case] = &[];
