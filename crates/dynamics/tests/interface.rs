//! What programs that use the libraries rely on, beside what they do.

use carom_dynamics::error::{SceneError, ValueError};
use carom_dynamics::geometry::error::{PlaneError, PolygonError, TriangleError};
use carom_dynamics::geometry::mesh::{Mesh, MeshError};
use carom_dynamics::nalgebra::{Point3, Vector3};
use carom_dynamics::plan::Plan;
use carom_dynamics::run::ThreadsError;
use carom_dynamics::scene::Scene;
use std::error::Error;

#[test]
fn errors_can_go_anywhere() {
    fn goes<E: Error + Send + Sync + 'static>() {}
    goes::<PlaneError>();
    goes::<PolygonError>();
    goes::<TriangleError>();
    goes::<MeshError>();
    goes::<ValueError>();
    goes::<SceneError>();
    goes::<ThreadsError>();
    // With `?` into what most programs have.
    let refused: Result<Plan, Box<dyn Error + Send + Sync>> = Plan::new(&Scene::lasting(1.0)).map_err(Into::into);
    assert!(refused.is_err_and(|error| error.is::<SceneError>()));
}

#[test]
fn scenes_plans_and_meshes_can_be_shared_between_threads() {
    fn shared<T: Send + Sync + Clone + 'static>() {}
    shared::<Scene>();
    shared::<Plan>();
    shared::<Mesh>();
}

#[test]
fn both_libraries_speak_of_the_same_vectors() {
    fn same<T>(_: &T, _: &T) {}
    same(&Point3::<f64>::origin(), &carom_geometry::nalgebra::Point3::<f64>::origin());
    same(&Vector3::<f64>::x(), &nalgebra::Vector3::<f64>::x());
}
