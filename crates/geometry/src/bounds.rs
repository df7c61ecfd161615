//! Axis-aligned boxes.
