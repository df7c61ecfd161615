//! Simple planar polygons, convex or concave.
