//! Triangles: normal, barycentric coordinates, closest point.
