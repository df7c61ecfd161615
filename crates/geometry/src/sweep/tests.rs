//! What a ball touches where several places of a mesh are near.

use super::*;
use crate::path::Path;
use crate::site::Site;
use nalgebra::{Point3, Vector3};

const TOLERANCE: f64 = 1e-6;

fn mesh(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Mesh {
    Mesh::new(vertices.iter().map(|&p| Point3::from(p)).collect(), faces.to_vec()).unwrap()
}

fn touches(m: &Mesh, centre: [f64; 3], radius: f64) -> Vec<Touch> {
    m.touches(&centre.into(), &Vector3::zeros(), radius, TOLERANCE, &mut Work::default()).into_vec()
}

fn sites(m: &Mesh, centre: [f64; 3], radius: f64) -> Vec<Site> {
    touches(m, centre, radius).into_iter().map(|touch| touch.site).collect()
}

/// The face 0 1 2 in the plane z = 0 with normal +z, and a second one over the edge 0 1 to a point at that height.
fn hinge(height: f64) -> Mesh {
    let d = [1.0, 0.0, height];
    mesh(&[[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], d], &[[0, 1, 2], [1, 0, 3]])
}

const RIDGE: Site = Site::Edge { face: 0, edge: 0 };

#[test]
fn a_ridge_is_touched_itself_and_a_hollow_by_its_faces() {
    // Folds so shallow that rounding puts the nearest point of both faces on the edge.
    let (above, below) = ([0.0, 0.5, 1.0], [0.0, 0.5, -1.0]);
    let both = [Site::Face(0), Site::Face(1)];
    assert_eq!((sites(&hinge(1e-14), above, 1.0), sites(&hinge(1e-14), below, 1.0)), (both.to_vec(), vec![RIDGE]));
    assert_eq!((sites(&hinge(-1e-14), above, 1.0), sites(&hinge(-1e-14), below, 1.0)), (vec![RIDGE], both.to_vec()));
    // A steep hollow that holds the ball away from its edge is not touched there at all.
    assert_eq!(sites(&hinge(1.0), [0.0, 0.5, 1.0], 0.5), []);
}

#[test]
fn the_normal_is_the_face_s_own_or_from_the_edge_to_the_centre() {
    let m = hinge(-1.0);
    let touch = touches(&m, [0.0, 0.5, 1.0], 1.0);
    assert_eq!(touch, [Touch { site: RIDGE, normal: Vector3::z() }]);
    let slanted = touches(&m, [0.6, 0.5, 0.8], 1.0);
    assert_eq!(slanted.len(), 1);
    assert_eq!(slanted[0].site, RIDGE);
    assert!((slanted[0].normal - Vector3::new(0.6, 0.0, 0.8)).amax() < 1e-15);
    // A face that no axis knows: its normal bit for bit, towards the ball.
    let face = mesh(&[[0.1, 0.2, 0.3], [1.3, 0.7, -0.4], [-0.6, 0.9, 0.35]], &[[0, 1, 2]]);
    let (n, [a, b, c]) = (face.normal(0).unwrap().into_inner(), face.triangle(0));
    for n in [n, -n] {
        let centre = Point3::from((a.coords + b.coords + c.coords) / 3.0) + n * 0.7;
        assert_eq!(touches(&face, centre.into(), 0.7), [Touch { site: Site::Face(0), normal: n }]);
    }
}

#[test]
fn h28_the_border_of_what_is_touched_does_not_show() {
    let roof = hinge(-1.0);
    // Beside the ridge by less than the tolerance: both faces see their edge, or one its inside.
    assert_eq!(sites(&roof, [-1e-7, 0.5, 1.0], 1.0), [Site::Face(0)]);
    // Beside its end: a third face sees the vertex, which belongs to the ridge.
    let three =
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [1.0, 0.0, -1.0], [-1.0, -1.0, -1.0], [1.0, -1.0, -1.0]];
    let m = mesh(&three, &[[0, 1, 2], [1, 0, 3], [0, 4, 5]]);
    assert_eq!(sites(&m, [0.0, 1e-7, 1.0], 1.0), [RIDGE]);
    // Two faces with a vertex in common and no edge.
    let corner = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, -1.0], [0.0, -1.0, -1.0]];
    let m = mesh(&corner, &[[0, 1, 2], [0, 3, 4]]);
    assert_eq!(sites(&m, [1e-7, 1e-7, 1.0], 1.0), [Site::Face(0)]);
    // An edge that only begins on a touched face is not hidden by it: it leaves the floor at a slant.
    let slant = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 4.0, 4.0], [-4.0, 2.0, 2.0]];
    let m = mesh(&slant, &[[0, 1, 2], [0, 3, 4]]);
    assert_eq!(sites(&m, [1.0, 1.0, 1.0], 1.0), [Site::Face(0), Site::Edge { face: 1, edge: 0 }]);
}

#[test]
fn where_rounding_decides_it_is_what_the_ball_moves_to() {
    // The foot is on the open side of the floor, where only the heading tells its rim from its inside.
    let m = mesh(&[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]], &[[0, 1, 2]]);
    let at = |heading: Vector3<f64>| {
        let touches = m.touches(&Point3::new(1.0, 0.0, 1.0), &heading, 1.0, TOLERANCE, &mut Work::default());
        touches.into_iter().map(|touch| touch.site).collect::<Vec<_>>()
    };
    assert_eq!(at(Vector3::y() * 1e-3), [Site::Face(0)]);
    assert_eq!(at(-Vector3::y() * 1e3), [RIDGE]);
}

#[test]
fn the_work_of_a_query_is_counted() {
    let (m, mut work) = (hinge(0.0), Work::default());
    m.touches(&Point3::new(-0.25, 0.25, 1.0), &Vector3::zeros(), 1.0, TOLERANCE, &mut work);
    assert_eq!((work.nodes, work.triangles, work.rounds), (1, 2, 0));
    let path = Path::line(Point3::new(-0.25, 0.25, 3.0), Vector3::new(0.0, 0.0, -4.0));
    let ball = MovingBall { path: &path, radius: 1.0, holds: &[] };
    let found = m.first_contact(&ball, 1.0, |_| 0.0, &mut work);
    assert_eq!(found, Some(FirstContact { f: 0.5, face: 0 }));
    assert!(work.nodes == 2 && work.triangles >= 3 && work.rounds >= 1, "{work:?}");
}
