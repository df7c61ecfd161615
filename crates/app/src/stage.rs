//! Where a run takes place, for what shows it: the box around it, and its surfaces as triangles.

use crate::replay::Replay;
use carom_dynamics::events::Motion;
use carom_dynamics::surface::Shape;
use carom_geometry::bounds::Aabb;
use carom_geometry::plane::Plane;
use nalgebra::{Point3, Unit, Vector3};

/// A box has at least this share of its greatest extent along every axis, so that a flat motion is seen in space.
const LEAST_SHARE: f64 = 0.3;

/// A plane farther away than this many extents of the box is not drawn.
const PLANES_WITHIN: f64 = 2.0;

/// Where a run takes place.
pub struct Stage {
    /// The box around what is shown.
    pub bounds: Aabb,
    /// Against gravity; along z without it.
    pub up: Unit<Vector3<f64>>,
    /// The surfaces, in the order of the scene.
    pub props: Vec<Prop>,
}

/// A surface as triangles.
pub struct Prop {
    /// Its corners, in m.
    pub vertices: Vec<Point3<f64>>,
    /// Its triangles, as indices of corners; none for a plane that is too far away.
    pub faces: Vec<[u32; 3]>,
    /// The plane, if it is an infinite one, of which this is the part in the box.
    pub plane: Option<Plane>,
    /// Whether it has an inside in which something begins, so that it has to be looked through.
    pub holds_balls: bool,
}

impl Stage {
    /// Of a run.
    pub fn of(replay: &Replay) -> Self {
        let scene = &replay.scene;
        let up = scene.gravity.and_then(|g| Unit::try_new(-g.acceleration(), 0.0)).unwrap_or_else(Vector3::z_axis);
        let bounds = bounds(replay);
        let starts: Vec<Point3<f64>> = scene.balls.iter().map(|b| b.start().position).collect();
        let props = scene.surfaces.iter().map(|surface| prop(&surface.shape, &bounds, &starts)).collect();
        Self { bounds, up, props }
    }
}

/// The box around the surfaces and the balls, but for those that fly away and meet nothing any more.
fn bounds(replay: &Replay) -> Aabb {
    let scene = &replay.scene;
    let starts: Vec<Point3<f64>> = scene.balls.iter().map(|b| b.start().position).collect();
    let mut core = Aabb::of_points(&starts);
    let mut all = core;
    for (ball, run) in scene.balls.iter().zip(&replay.balls) {
        let last = run.trajectory.events.last().map_or(0.0, |event| event.time);
        for segment in &run.trajectory.segments {
            let stretch = segment.step.path.bounds(0.0, segment.to).inflate(ball.radius());
            all = all.union(&stretch);
            if segment.time < last || segment.motion != Motion::Flying {
                core = core.union(&stretch);
            }
        }
    }
    for surface in &scene.surfaces {
        core = match &surface.shape {
            Shape::Plane(_) => core,
            Shape::Polygon(polygon) => core.union(&Aabb::of_points(polygon.vertices())),
            Shape::Mesh(mesh) => core.union(mesh.bounds()),
        };
    }
    let bounds = if core.extent().amax() > 0.0 { core } else { all };
    let size = bounds.extent().amax();
    let centre = bounds.centre();
    let feet = scene.surfaces.iter().filter_map(|surface| match &surface.shape {
        Shape::Plane(plane) => {
            let distance = plane.signed_distance(&centre);
            (distance.abs() <= PLANES_WITHIN * size).then(|| centre - plane.normal().into_inner() * distance)
        }
        _ => None,
    });
    let feet: Vec<Point3<f64>> = feet.collect();
    filled(&bounds.union(&Aabb::of_points(&feet)))
}

/// The box, made thicker where it is thin.
fn filled(bounds: &Aabb) -> Aabb {
    let size = match bounds.extent().amax() {
        0.0 => 1.0,
        size => size,
    };
    let half = bounds.extent().map(|side| 0.5 * side.max(LEAST_SHARE * size));
    let centre = bounds.centre();
    Aabb::of_points(&[centre - half, centre + half])
}

fn prop(shape: &Shape, bounds: &Aabb, starts: &[Point3<f64>]) -> Prop {
    match shape {
        Shape::Plane(plane) => {
            let vertices = cut(plane, bounds);
            let faces = (2..vertices.len() as u32).map(|i| [0, i - 1, i]).collect();
            Prop { vertices, faces, plane: Some(*plane), holds_balls: false }
        }
        Shape::Polygon(polygon) => Prop {
            vertices: polygon.vertices().to_vec(),
            faces: polygon.triangulate().iter().map(|face| face.map(|i| i as u32)).collect(),
            plane: None,
            holds_balls: false,
        },
        Shape::Mesh(mesh) => {
            let within = starts.iter().any(|x| mesh.bounds().contains(x));
            Prop {
                vertices: mesh.vertices().to_vec(),
                faces: mesh.faces().to_vec(),
                plane: None,
                holds_balls: within && mesh.edges().all(|edge| edge.count == 2),
            }
        }
    }
}

/// The part of a plane that lies in the box: a convex polygon, or nothing.
fn cut(plane: &Plane, bounds: &Aabb) -> Vec<Point3<f64>> {
    let normal = plane.normal();
    let centre = bounds.centre();
    let foot = centre - normal.into_inner() * plane.signed_distance(&centre);
    let reach = 2.0 * bounds.extent().norm();
    let first = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize() * reach;
    let second = normal.cross(&first);
    let mut corners = vec![foot - first - second, foot + first - second, foot + first + second, foot - first + second];
    for axis in 0..3 {
        // A plane on a face of the box stays, whatever its rounding.
        let slack = 2f64.powi(-40) * reach;
        corners = clip(&corners, |x| x[axis] - bounds.min()[axis] + slack);
        corners = clip(&corners, |x| bounds.max()[axis] - x[axis] + slack);
    }
    corners
}

/// The part of a convex polygon where `inside` is >= 0.
fn clip(corners: &[Point3<f64>], inside: impl Fn(&Point3<f64>) -> f64) -> Vec<Point3<f64>> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (i, a) in corners.iter().enumerate() {
        let b = &corners[(i + 1) % corners.len()];
        let (at_a, at_b) = (inside(a), inside(b));
        if at_a >= 0.0 {
            kept.push(*a);
        }
        if (at_a >= 0.0) != (at_b >= 0.0) {
            kept.push(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Aabb {
        Aabb::of_points(&[Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0)])
    }

    #[test]
    fn a_plane_is_cut_to_the_box() {
        let floor = Plane::from_point_normal(Point3::new(9.0, 9.0, -1.0), Vector3::z()).expect("a plane");
        let corners = cut(&floor, &cube());
        assert_eq!(corners.len(), 4);
        assert!(
            corners.iter().all(|x| x.z == -1.0 && (x.x.abs() - 1.0).abs() < 1e-9 && (x.y.abs() - 1.0).abs() < 1e-9)
        );
        // Across the diagonal of a cube it is a hexagon.
        let across = Plane::from_point_normal(Point3::origin(), Vector3::new(1.0, 1.0, 1.0)).expect("a plane");
        assert_eq!(cut(&across, &cube()).len(), 6);
        let away = Plane::from_point_normal(Point3::new(0.0, 0.0, 2.0), Vector3::z()).expect("a plane");
        assert!(cut(&away, &cube()).is_empty());
    }

    #[test]
    fn a_flat_box_is_filled_and_a_point_gets_room() {
        let flat = Aabb::of_points(&[Point3::origin(), Point3::new(10.0, 0.0, 0.0)]);
        assert_eq!(filled(&flat).extent(), Vector3::new(10.0, 3.0, 3.0));
        assert!(filled(&Aabb::of_points(&[Point3::new(5.0, 5.0, 5.0)])).extent().amin() > 0.0);
    }
}
