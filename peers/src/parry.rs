//! The queries as parry3d-f64 has them.

use carom_benches::cases::Case;
use carom_benches::scenes::Result;
use nalgebra::{Point3, Vector3};
use parry3d::math::{Pose, Vector};
use parry3d::query::{Ray, RayCast, ShapeCastOptions, cast_shapes};
use parry3d::shape::{Ball, TriMesh, Triangle};

fn vector(v: &Vector3<f64>) -> Vector {
    Vector::from_array((*v).into())
}

fn point(p: &Point3<f64>) -> Vector {
    vector(&p.coords)
}

/// A mesh.
pub struct Obstacle(TriMesh);

impl Obstacle {
    /// The mesh with these vertices and faces.
    pub fn new(vertices: &[Point3<f64>], faces: &[[u32; 3]]) -> Result<Self> {
        Ok(Self(TriMesh::new(vertices.iter().map(point).collect(), faces.to_vec())?))
    }

    /// Where the segment from `from` along `along` first meets it.
    pub fn segment(&self, from: &Point3<f64>, along: &Vector3<f64>) -> Option<f64> {
        self.0.cast_local_ray(&Ray::new(point(from), vector(along)), 1.0, true)
    }
}

/// When the ball of a case without acceleration first touches its triangle.
pub fn ball_and_triangle(case: &Case) -> Option<f64> {
    let [a, b, c] = case.triangle.each_ref().map(point);
    let (start, still) = (Pose::from_translation(point(&case.path.start())), Pose::identity());
    let options = ShapeCastOptions::with_max_time_of_impact(case.duration);
    let (ball, triangle) = (Ball::new(case.radius), Triangle::new(a, b, c));
    cast_shapes(&start, vector(&case.velocity), &ball, &still, Vector::ZERO, &triangle, options)
        .ok()
        .flatten()
        .map(|hit| hit.time_of_impact)
}
