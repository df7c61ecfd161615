//! Whether a ball has room where it starts.

use crate::error::SceneError;
use crate::scene::Scene;
use crate::tolerance::{rate_rounding, touch_distance};
use carom_geometry::plane::Plane;

/// Refuses a ball that starts between two parallel planes which are nearer to each other than it is wide: `planes` by their surfaces, in a scene whose
/// largest |coordinate| is `farthest` (m). One that exactly fits, to rounding, slides between them.
///
/// A ball that overlaps one plane, or planes that meet, can still get free. What is between faces of polygons and meshes is not looked for.
pub(crate) fn check_room(scene: &Scene, planes: &[(usize, Plane)], farthest: f64) -> Result<(), SceneError> {
    for (ball, b) in scene.balls.iter().enumerate() {
        let centre = b.start().position;
        let beside = |(surface, plane): &(usize, Plane)| {
            let distance = plane.signed_distance(&centre);
            (distance.abs() < b.radius())
                .then(|| (*surface, distance.abs(), plane.normal().into_inner() * distance.signum()))
        };
        let overlapped: Vec<_> = planes.iter().filter_map(beside).collect();
        for (i, (one, near, normal)) in overlapped.iter().enumerate() {
            for (other, far, opposite) in &overlapped[i + 1..] {
                let opposed = (normal + opposite).norm() <= rate_rounding(1.0);
                let (width, diameter) = (near + far, 2.0 * b.radius());
                if opposed && width < diameter - touch_distance(farthest, 0.0) {
                    let surfaces = [*one, *other].map(|surface| scene.surfaces[surface].name.clone());
                    return Err(SceneError::NoRoom { ball, surfaces, width, diameter });
                }
            }
        }
    }
    Ok(())
}
