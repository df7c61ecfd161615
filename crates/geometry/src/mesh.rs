//! Triangle meshes with their topology.
