//! Segments against triangles, decided exactly on the original points.
