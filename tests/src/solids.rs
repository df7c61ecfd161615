//! Shapes that several cases use.

use nalgebra::{Point3, Vector3};
use std::collections::BTreeMap;

/// Vertices and faces.
pub type Solid = (Vec<Point3<f64>>, Vec<[u32; 3]>);

/// The icosahedron, each face cut into 4^`level`, its vertices on the unit sphere; closed, faces outwards.
pub fn icosphere(level: usize) -> Solid {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let corners = [
        [-1.0, golden, 0.0],
        [1.0, golden, 0.0],
        [-1.0, -golden, 0.0],
        [1.0, -golden, 0.0],
        [0.0, -1.0, golden],
        [0.0, 1.0, golden],
        [0.0, -1.0, -golden],
        [0.0, 1.0, -golden],
        [golden, 0.0, -1.0],
        [golden, 0.0, 1.0],
        [-golden, 0.0, -1.0],
        [-golden, 0.0, 1.0],
    ];
    let on_sphere = |p: Vector3<f64>| Point3::from(p / p.norm());
    let mut vertices: Vec<Point3<f64>> = corners.iter().map(|c| on_sphere(Vector3::from(*c))).collect();
    let mut faces: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..level {
        let mut middles: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum = vertices[a as usize].coords + vertices[b as usize].coords;
                vertices.push(on_sphere(sum));
                vertices.len() as u32 - 1
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    (vertices, faces)
}

/// Every vertex moved.
pub fn moved((vertices, faces): &Solid, place: impl Fn(&Point3<f64>) -> Point3<f64>) -> Solid {
    (vertices.iter().map(place).collect(), faces.clone())
}

/// The corners of the faces.
pub fn triangles((vertices, faces): &Solid) -> Vec<[Point3<f64>; 3]> {
    faces.iter().map(|f| f.map(|v| vertices[v as usize])).collect()
}

/// The box [-1, 1]^3 as twelve triangles, faces outwards.
pub fn cube() -> Solid {
    let corner = |i: u32| {
        let side = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
        Point3::new(side(1), side(2), side(4))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    ((0..8).map(corner).collect(), faces)
}
