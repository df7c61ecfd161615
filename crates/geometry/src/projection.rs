//! Projection along the dominant axis of a normal.
