//! What can be wrong with geometric input.
