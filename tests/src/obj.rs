//! A reader for the vertices and triangles of a Wavefront OBJ file, for tests only.

use nalgebra::Point3;

/// The `v` and `f` lines of `text`; corners by vertex, from 0. Everything else is left out.
///
/// Panics with the line on what it does not understand: a test has nothing better to do.
pub fn read(text: &str) -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let kind = words.next();
        let words: Vec<_> = words.collect();
        match (kind, words.as_slice()) {
            (Some("v"), [x, y, z]) => {
                let [x, y, z] = [x, y, z].map(|c| c.parse().unwrap_or_else(|e| panic!("{line}: {e}")));
                vertices.push(Point3::new(x, y, z));
            }
            (Some("f"), [a, b, c]) => faces.push([a, b, c].map(|corner| {
                // v, v/vt, v//vn or v/vt/vn, counted from 1
                let vertex = corner.split('/').next().and_then(|v| v.parse::<u32>().ok());
                vertex.and_then(|v| v.checked_sub(1)).unwrap_or_else(|| panic!("{line}"))
            })),
            (Some("v" | "f"), _) => panic!("not a triangle mesh: {line}"),
            _ => {}
        }
    }
    (vertices, faces)
}
