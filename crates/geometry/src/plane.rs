//! Planes, signed distance and sides.
