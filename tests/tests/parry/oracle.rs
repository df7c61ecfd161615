//! What parry3d says: its shapes and queries behind our types.

use nalgebra::{Point2, Point3, Vector3};
use parry3d::math::{Pose, Vector, Vector2};
use parry3d::query::{PointQuery, Ray, RayCast, ShapeCastOptions, cast_shapes};
use parry3d::shape::{Ball, HalfSpace, Shape, TriMesh, Triangle};
use parry3d::utils::point_in_poly2d;

fn vector(v: &Vector3<f64>) -> Vector {
    Vector::from_array((*v).into())
}

fn point(p: &Point3<f64>) -> Vector {
    vector(&p.coords)
}

fn shape([a, b, c]: &[Point3<f64>; 3]) -> Triangle {
    Triangle::new(point(a), point(b), point(c))
}

/// The signed distance of `x` from the plane through `origin` across the unit vector `normal`; `HalfSpace` would not normalise it.
pub fn signed_distance(origin: &Point3<f64>, normal: &Vector3<f64>, x: &Point3<f64>) -> f64 {
    HalfSpace::new(vector(normal)).distance_to_point(&Pose::from_translation(point(origin)), point(x), false)
}

/// The unit normal, none if parry takes the triangle to have no area.
pub fn normal(triangle: &[Point3<f64>; 3]) -> Option<Vector3<f64>> {
    shape(triangle).normal().map(|n| Vector3::from(n.to_array()))
}

/// The distance of `x` from the triangle.
pub fn distance(triangle: &[Point3<f64>; 3], x: &Point3<f64>) -> f64 {
    shape(triangle).distance_to_local_point(point(x), true)
}

/// Where the segment first meets the triangle.
pub fn segment(triangle: &[Point3<f64>; 3], from: &Point3<f64>, to: &Point3<f64>) -> Option<f64> {
    shape(triangle).cast_local_ray(&Ray::new(point(from), vector(&(to - from))), 1.0, true)
}

/// When a ball that flies from `from` to `to` first touches the triangle, 0 if it does at the start.
pub fn ball(triangle: &[Point3<f64>; 3], from: &Point3<f64>, to: &Point3<f64>, radius: f64) -> Option<f64> {
    cast(&shape(triangle), from, to, radius)
}

fn cast(obstacle: &dyn Shape, from: &Point3<f64>, to: &Point3<f64>, radius: f64) -> Option<f64> {
    let (start, still) = (Pose::from_translation(point(from)), Pose::identity());
    let options = ShapeCastOptions {
        compute_impact_geometry_on_penetration: false,
        ..ShapeCastOptions::with_max_time_of_impact(1.0)
    };
    cast_shapes(&start, vector(&(to - from)), &Ball::new(radius), &still, Vector::ZERO, obstacle, options)
        .expect("parry casts balls against triangles and meshes")
        .map(|hit| hit.time_of_impact)
}

/// A mesh as parry has it.
pub struct Mesh(TriMesh);

impl Mesh {
    /// The mesh of these vertices and faces.
    pub fn new(vertices: &[Point3<f64>], faces: &[[u32; 3]]) -> Self {
        Self(TriMesh::new(vertices.iter().map(point).collect(), faces.to_vec()).expect("a mesh that parry takes"))
    }

    /// Where the segment first meets the mesh.
    pub fn segment(&self, from: &Point3<f64>, to: &Point3<f64>) -> Option<f64> {
        self.0.cast_local_ray(&Ray::new(point(from), vector(&(to - from))), 1.0, true)
    }

    /// The distance of `x` from the mesh.
    pub fn distance(&self, x: &Point3<f64>) -> f64 {
        self.0.distance_to_local_point(point(x), true)
    }

    /// When a ball that flies from `from` to `to` first touches the mesh, 0 if it does at the start.
    pub fn ball(&self, from: &Point3<f64>, to: &Point3<f64>, radius: f64) -> Option<f64> {
        cast(&self.0, from, to, radius)
    }
}

/// Whether `x` lies in the polygon, by counting crossings.
pub fn in_polygon(polygon: &[Point2<f64>], x: &Point2<f64>) -> bool {
    let vertices: Vec<Vector2> = polygon.iter().map(|p| Vector2::new(p.x, p.y)).collect();
    point_in_poly2d(Vector2::new(x.x, x.y), &vertices)
}
