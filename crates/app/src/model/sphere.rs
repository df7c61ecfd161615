//! A ball as triangles: an icosahedron, its faces split into four twice over.

use nalgebra::Vector3;
use std::collections::BTreeMap;

/// How often every face is split into four.
const SPLITS: usize = 2;

/// Vertices on the unit sphere, which are their normals too, and faces that turn counter-clockwise seen from outside.
pub fn unit() -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut vertices: Vec<Vector3<f64>> = Vec::new();
    for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        vertices
            .extend([Vector3::new(0.0, a, b), Vector3::new(a, b, 0.0), Vector3::new(b, 0.0, a)].map(|v| v.normalize()));
    }
    // Neighbours are nearer to each other than any others; three of them are a face.
    let near = |i: usize, j: usize| (vertices[i] - vertices[j]).norm_squared() < 1.5;
    let mut faces = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(k, i) {
                    let outwards = vertices[i].dot(&vertices[j].cross(&vertices[k])) > 0.0;
                    let [i, j, k] = [i, j, k].map(|v| v as u32);
                    faces.push(if outwards { [i, j, k] } else { [i, k, j] });
                }
            }
        }
    }
    for _ in 0..SPLITS {
        faces = split(&mut vertices, &faces);
    }
    (vertices, faces)
}

/// Whether a face is beyond the seam of a tennis ball: z = 2 (x^2 - y^2) parts the sphere into two sides of one shape.
pub fn is_beyond_seam(face: [u32; 3], vertices: &[Vector3<f64>]) -> bool {
    let middle = face.iter().map(|&i| vertices[i as usize]).sum::<Vector3<f64>>().normalize();
    middle.z < 2.0 * (middle.x * middle.x - middle.y * middle.y)
}

fn split(vertices: &mut Vec<Vector3<f64>>, faces: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
            vertices.len() as u32 - 1
        })
    };
    let parts = faces.iter().flat_map(|&[a, b, c]| {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    });
    parts.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_closed_round_and_turned_outwards() {
        let (vertices, faces) = unit();
        assert_eq!((vertices.len(), faces.len()), (162, 320));
        assert!(vertices.iter().all(|v| (v.norm() - 1.0).abs() < 1e-15));
        let volume: f64 =
            faces.iter().map(|f| f.map(|i| vertices[i as usize])).map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum();
        // A little less than that of the sphere, 4 pi / 3.
        assert!((4.0..4.19).contains(&volume), "{volume}");
    }
}
