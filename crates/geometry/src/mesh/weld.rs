//! Vertices at the same place.

use nalgebra::Point3;

/// For each vertex the first one at exactly the same place, which may be itself; -0 and 0 are the same. A vertex that is
/// not finite is only at its own place.
pub(crate) fn first_at_same_place(vertices: &[Point3<f64>]) -> Vec<u32> {
    // Adding 0 turns -0 into 0; then equal coordinates are equal bits.
    let key = |v: u32| [0, 1, 2].map(|i| (vertices[v as usize][i] + 0.0).to_bits());
    let mut first: Vec<u32> = (0..vertices.len() as u32).collect();
    let mut order: Vec<u32> = first.clone();
    order.retain(|&v| vertices[v as usize].iter().all(|c| c.is_finite()));
    order.sort_unstable_by_key(|&v| (key(v), v));
    for place in order.chunk_by(|&a, &b| key(a) == key(b)) {
        for &v in place {
            first[v as usize] = place[0];
        }
    }
    first
}

/// Makes faces whose corners are at exactly the same place share a vertex, the first one there; returns how many corners
/// changed. Needed where a file repeats the vertices for every face: without it such faces are no neighbours, and every edge
/// is a rim. Places that differ in the last bit stay apart; so does a corner whose vertex does not exist.
pub fn weld(vertices: &[Point3<f64>], faces: &mut [[u32; 3]]) -> usize {
    let first = first_at_same_place(vertices);
    let mut changed = 0;
    for corner in faces.iter_mut().flatten() {
        if let Some(&v) = first.get(*corner as usize)
            && v != *corner
        {
            *corner = v;
            changed += 1;
        }
    }
    changed
}
