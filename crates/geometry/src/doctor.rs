//! What is wrong with a mesh, face by face.
