//! The clearance along a path, and its first entry.
