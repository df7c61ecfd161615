//! The surfaces of a scene as a checker sees them: triangles and planes, with distances of its own.

use crate::grid::Grid;
use carom_dynamics::scene::Scene;
use carom_dynamics::surface::Shape;
use carom_geometry::mesh::Mesh;
use nalgebra::{Point3, Vector3};

/// Unit roundoff.
pub const U: f64 = f64::EPSILON / 2.0;

/// Triangles and planes, each with the surface it belongs to.
#[derive(Debug, Clone)]
pub struct World {
    /// The triangles of meshes and polygons.
    pub triangles: Vec<([Point3<f64>; 3], usize)>,
    /// A point and the unit normal of each plane.
    pub planes: Vec<(Point3<f64>, Vector3<f64>, usize)>,
    /// The largest |coordinate| of a surface.
    pub farthest: f64,
    grid: Grid,
}

impl World {
    /// The surfaces of `scene`.
    pub fn of(scene: &Scene) -> Self {
        let (mut triangles, mut planes) = (Vec::new(), Vec::new());
        for (i, surface) in scene.surfaces.iter().enumerate() {
            match &surface.shape {
                Shape::Plane(plane) => planes.push((plane.point(), plane.normal().into_inner(), i)),
                Shape::Polygon(polygon) => {
                    let v = polygon.vertices();
                    triangles.extend(polygon.triangulate().iter().map(|f| (f.map(|k| v[k]), i)));
                }
                Shape::Mesh(mesh) => {
                    let v = mesh.vertices();
                    triangles.extend(mesh.faces().iter().map(|f| (f.map(|k| v[k as usize]), i)));
                }
            }
        }
        Self::from_parts(triangles, planes)
    }

    /// A mesh alone, as surface 0.
    pub fn of_mesh(mesh: &Mesh) -> Self {
        let v = mesh.vertices();
        Self::from_parts(mesh.faces().iter().map(|f| (f.map(|k| v[k as usize]), 0)).collect(), Vec::new())
    }

    fn from_parts(triangles: Vec<([Point3<f64>; 3], usize)>, planes: Vec<(Point3<f64>, Vector3<f64>, usize)>) -> Self {
        let boxes: Vec<_> = triangles.iter().map(|([a, b, c], _)| (a.inf(b).inf(c), a.sup(b).sup(c))).collect();
        let corners = triangles.iter().flat_map(|(t, _)| t).chain(planes.iter().map(|(p, ..)| p));
        let farthest = corners.fold(0.0, |m: f64, p| m.max(p.coords.amax()));
        Self { triangles, planes, farthest, grid: Grid::new(&boxes) }
    }

    /// The triangles that may be within the box from `low` to `high`.
    pub fn near(&self, low: &Point3<f64>, high: &Point3<f64>) -> Vec<u32> {
        self.grid.near(low, high)
    }

    /// The nearest point of triangle `i` as seen from `x`.
    pub fn to_triangle(&self, i: u32, x: &Point3<f64>) -> Vector3<f64> {
        to_triangle(&self.triangles[i as usize].0, x)
    }

    /// The winding number of the triangles around `x`: 1 inside a closed mesh that is wound outwards, 0 outside.
    pub fn winding(&self, x: &Point3<f64>) -> f64 {
        let solid = self.triangles.iter().map(|(t, _)| {
            let [a, b, c] = t.map(|p| (p - x).normalize());
            let numerator = a.dot(&b.cross(&c));
            2.0 * numerator.atan2(1.0 + a.dot(&b) + b.dot(&c) + c.dot(&a))
        });
        solid.sum::<f64>() / (4.0 * std::f64::consts::PI)
    }

    /// The distance from `x` to the nearest triangle, no farther than `most`.
    pub fn distance(&self, x: &Point3<f64>, most: f64) -> f64 {
        let reach = Vector3::repeat(most);
        let near = self.near(&(x - reach), &(x + reach));
        near.iter().map(|&i| self.to_triangle(i, x).norm()).fold(most, f64::min)
    }
}

/// The nearest point of the triangle as seen from `x`: its three sides and, above its inside, its plane.
pub fn to_triangle(triangle: &[Point3<f64>; 3], x: &Point3<f64>) -> Vector3<f64> {
    let corners = triangle.map(|p| p - x);
    // In a unit of about its size, by a power of two: products of four lengths vanish in a small scene.
    let size = corners.iter().map(|p| p.amax()).fold(f64::MIN_POSITIVE, f64::max);
    let unit = f64::from_bits(size.to_bits() & !((1 << 52) - 1));
    to_unit_triangle(corners.map(|p| p / unit)) * unit
}

/// The nearest point of the triangle with these corners as seen from the origin.
fn to_unit_triangle([a, b, c]: [Vector3<f64>; 3]) -> Vector3<f64> {
    let mut best = to_segment(&a, &b);
    for other in [to_segment(&b, &c), to_segment(&c, &a)] {
        if other.norm_squared() < best.norm_squared() {
            best = other;
        }
    }
    let (ab, ac) = (b - a, c - a);
    let n = ab.cross(&ac);
    // A needle's normal is rounding; it is no farther from its sides than it is wide.
    if n.norm() > 1e-9 * ab.norm() * ac.norm() {
        let side = |p: &Vector3<f64>, q: &Vector3<f64>| n.dot(&(q - p).cross(&-p));
        if side(&a, &b) >= 0.0 && side(&b, &c) >= 0.0 && side(&c, &a) >= 0.0 {
            let unit = n.normalize();
            // From the nearest corner: the height is then known best.
            let corner =
                [a, b, c].into_iter().min_by(|p, q| p.norm_squared().total_cmp(&q.norm_squared())).unwrap_or(a);
            let foot = unit * unit.dot(&corner);
            if foot.norm_squared() < best.norm_squared() {
                best = foot;
            }
        }
    }
    best
}

/// The point of the segment a b nearest to the origin.
fn to_segment(a: &Vector3<f64>, b: &Vector3<f64>) -> Vector3<f64> {
    let d = b - a;
    let length = d.norm_squared();
    if length == 0.0 {
        return *a;
    }
    // From the nearer end.
    let (p, d) = if a.norm_squared() <= b.norm_squared() { (a, d) } else { (b, -d) };
    let s = (-p.dot(&d) / length).clamp(0.0, 1.0);
    p + d * s
}
