//! First contact of a moving ball with triangles and meshes.
