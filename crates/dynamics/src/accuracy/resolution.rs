//! The share of the error that is due to the discretisation of a curved surface (R26): the same scene on finer and finer meshes of what the mesh
//! may have been cut from.
//!
//! What that was, a mesh does not say. If its vertices lie on a sphere, it is taken for that sphere; else for the smooth surface through its
//! vertices that follows their normals: point-normal triangles (A. Vlachos et al., *Curved PN triangles*, 2001). A mesh with many sharp edges
//! is taken for what it is.

use carom_geometry::mesh::Mesh;
use nalgebra::{Point3, Vector3};
use std::collections::HashMap;

/// How often the edges of a mesh are halved.
pub const LEVELS: u32 = 3;

/// Meshes with more faces than this are not refined further.
const MOST_FACES: usize = 400_000;

/// An edge that bends by more than this, as a cosine (60 degrees), is sharp; a mesh with a share of them above this is a thing with edges.
const SHARP: f64 = 0.5;
const SHARP_SHARE: f64 = 0.1;

/// How far vertices may be off a sphere and lie on it, in units of its radius: what single precision, in which meshes come, makes of it.
const SPHERICAL: f64 = 1.0 / (1 << 20) as f64;

/// What a mesh is taken to be cut from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Original {
    /// A sphere.
    Sphere {
        /// Its centre, in m.
        centre: Point3<f64>,
        /// Its radius, in m.
        radius: f64,
    },
    /// A smooth surface through the vertices.
    Smooth,
    /// Itself: it has too many sharp edges to be anything else.
    Itself,
}

impl Original {
    /// Of `mesh`.
    pub fn of(mesh: &Mesh) -> Self {
        if let Some((centre, radius)) = sphere(mesh) {
            return Self::Sphere { centre, radius };
        }
        let (mut all, mut sharp) = (0_usize, 0_usize);
        for edge in mesh.edges() {
            let normals = edge.other.and_then(|other| mesh.normal(edge.owner.0).zip(mesh.normal(other)));
            if let Some((a, b)) = normals {
                all += 1;
                sharp += usize::from(a.dot(&b) < SHARP);
            }
        }
        if sharp as f64 > SHARP_SHARE * all as f64 { Self::Itself } else { Self::Smooth }
    }
}

/// The sphere through all vertices, if there is one.
fn sphere(mesh: &Mesh) -> Option<(Point3<f64>, f64)> {
    let used: Vec<Point3<f64>> = mesh.faces().iter().flatten().map(|&v| mesh.vertices()[v as usize]).collect();
    let [a, rest @ ..] = used.as_slice() else { return None };
    let farthest = |from: &Point3<f64>| {
        let by = |p: &&Point3<f64>, q: &&Point3<f64>| (*p - from).norm_squared().total_cmp(&(*q - from).norm_squared());
        rest.iter().max_by(by).copied()
    };
    let b = farthest(a)?;
    let c = farthest(&nalgebra::center(a, &b))?;
    // Least squares of |x|^2 = 2 x . m + k over all vertices, about their middle.
    let middle = nalgebra::center(&nalgebra::center(a, &b), &c);
    let mut matrix = nalgebra::Matrix4::zeros();
    let mut right = nalgebra::Vector4::zeros();
    for p in &used {
        let x = p - middle;
        let row = nalgebra::Vector4::new(2.0 * x.x, 2.0 * x.y, 2.0 * x.z, 1.0);
        matrix += row * row.transpose();
        right += row * x.norm_squared();
    }
    let solved = matrix.lu().solve(&right)?;
    let offset = Vector3::new(solved.x, solved.y, solved.z);
    let radius = (solved.w + offset.norm_squared()).sqrt();
    let centre = middle + offset;
    let on_it = |p: &Point3<f64>| ((p - centre).norm() - radius).abs() <= SPHERICAL * radius;
    // Few vertices, or those of a plane, lie on some sphere whatever they are.
    (mesh.faces().len() >= 20 && radius.is_finite() && used.iter().all(on_it)).then_some((centre, radius))
}

/// The mesh with each edge divided into 2^`level`, its new vertices on the `original`; none if it would be too large, or is no finer.
pub fn refined(mesh: &Mesh, original: &Original, level: u32) -> Option<Mesh> {
    let n = 1_usize << level;
    if *original == Original::Itself || mesh.faces().len() * n * n > MOST_FACES {
        return None;
    }
    let mut normals = vec![Vector3::zeros(); mesh.vertices().len()];
    for face in mesh.faces() {
        let [a, b, c] = face.map(|v| mesh.vertices()[v as usize]);
        let area = (b - a).cross(&(c - a));
        face.iter().for_each(|&v| normals[v as usize] += area);
    }
    let mut vertices = mesh.vertices().to_vec();
    let mut on_edges: HashMap<(u32, u32, usize), u32> = HashMap::new();
    let mut faces = Vec::new();
    for (number, &face) in (0..).zip(mesh.faces()) {
        let patch = Patch::new(mesh.triangle(number), face.map(|v| normals[v as usize]));
        let place = |p: Point3<f64>| match original {
            Original::Sphere { centre, radius } => {
                (p - centre).try_normalize(0.0).map_or(p, |away| centre + away * *radius)
            }
            _ => p,
        };
        let mut inside: HashMap<(usize, usize), u32> = HashMap::new();
        // Row i, column j: weights (n - i, i - j, j) / n of the corners.
        let mut index = |i: usize, j: usize| -> u32 {
            let weights = [n - i, i - j, j];
            if let Some(corner) = weights.iter().position(|w| *w == n) {
                return face[corner];
            }
            let at = |w: [usize; 3]| place(patch.at(w.map(|w| w as f64 / n as f64)));
            let mut add = |p: Point3<f64>| {
                vertices.push(p);
                (vertices.len() - 1) as u32
            };
            match weights.iter().position(|w| *w == 0) {
                None => *inside.entry((i, j)).or_insert_with(|| add(at(weights))),
                Some(away) => {
                    // A point of an edge is made once, by the face that comes to it first.
                    let [p, q] = [(away + 1) % 3, (away + 2) % 3];
                    let (low, high) = if face[p] < face[q] { (p, q) } else { (q, p) };
                    *on_edges.entry((face[low], face[high], weights[low])).or_insert_with(|| add(at(weights)))
                }
            }
        };
        for i in 0..n {
            for j in 0..=i {
                faces.push([index(i, j), index(i + 1, j), index(i + 1, j + 1)]);
                if j < i {
                    faces.push([index(i, j), index(i + 1, j + 1), index(i, j + 1)]);
                }
            }
        }
    }
    Mesh::new(vertices, faces).ok()
}

/// A cubic point-normal triangle.
struct Patch {
    corners: [Point3<f64>; 3],
    /// Control points of the edges: of edge k, from corner k to the next, the two thirds.
    edges: [[Point3<f64>; 2]; 3],
    middle: Point3<f64>,
}

impl Patch {
    fn new(corners: [Point3<f64>; 3], normals: [Vector3<f64>; 3]) -> Self {
        let normals = normals.map(|n| n.try_normalize(0.0).unwrap_or_else(Vector3::zeros));
        let third = |a: usize, b: usize| {
            let across = corners[b] - corners[a];
            corners[a] + (across - normals[a] * across.dot(&normals[a])) / 3.0
        };
        let edges = [0, 1, 2].map(|k| [third(k, (k + 1) % 3), third((k + 1) % 3, k)]);
        let edge = edges.iter().flatten().fold(Vector3::zeros(), |sum, p| sum + p.coords) / 6.0;
        let flat = corners.iter().fold(Vector3::zeros(), |sum, p| sum + p.coords) / 3.0;
        Self { corners, edges, middle: Point3::from(edge + (edge - flat) * 0.5) }
    }

    /// The point with barycentric coordinates `w`.
    fn at(&self, w: [f64; 3]) -> Point3<f64> {
        let mut sum = self.middle.coords * (6.0 * w[0] * w[1] * w[2]);
        for k in 0..3 {
            let (a, b) = (w[k], w[(k + 1) % 3]);
            sum += self.corners[k].coords * (a * a * a);
            sum += (self.edges[k][0].coords * a + self.edges[k][1].coords * b) * (3.0 * a * b);
        }
        Point3::from(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An octahedron, each face cut into 16 on the unit sphere.
    fn ball() -> Mesh {
        let unit = |k: usize, s: f64| {
            let mut p = Point3::origin();
            p[k] = s;
            p
        };
        let vertices = vec![unit(0, 1.0), unit(1, 1.0), unit(2, 1.0), unit(0, -1.0), unit(1, -1.0), unit(2, -1.0)];
        let faces = vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
        let sphere = Original::Sphere { centre: Point3::origin(), radius: 1.0 };
        refined(&Mesh::new(vertices, faces).unwrap(), &sphere, 2).unwrap()
    }

    #[test]
    fn a_mesh_of_a_sphere_is_recognised_and_refined_onto_it_without_cracks() {
        let coarse = ball();
        assert_eq!(coarse.faces().len(), 128);
        let Original::Sphere { centre, radius } = Original::of(&coarse) else { panic!("{:?}", Original::of(&coarse)) };
        assert!(centre.coords.norm() < 1e-12 && (radius - 1.0).abs() < 1e-12);
        let fine = refined(&coarse, &Original::of(&coarse), 1).unwrap();
        assert_eq!(fine.faces().len(), 512);
        assert!(fine.edges().all(|edge| edge.count == 2), "every edge joins two faces");
        assert!(fine.vertices().iter().all(|v| (v.coords.norm() - 1.0).abs() < 1e-12));
    }

    #[test]
    fn smooth_patches_come_nearer_to_the_sphere_than_flat_faces() {
        let coarse = ball();
        let smooth = refined(&coarse, &Original::Smooth, 1).unwrap();
        let flat = |a: u32, b: u32| nalgebra::center(&coarse.vertices()[a as usize], &coarse.vertices()[b as usize]);
        let off = |p: &Point3<f64>| (p.coords.norm() - 1.0).abs();
        let chord = coarse.faces().iter().map(|f| off(&flat(f[0], f[1]))).fold(0.0, f64::max);
        let curve = smooth.vertices().iter().map(off).fold(0.0, f64::max);
        assert!(curve < chord / 3.0, "{curve} {chord}");
        assert!(smooth.edges().all(|edge| edge.count == 2));
    }
}
