//! The places of a cube, of which everything is known.

use super::*;

/// The unit cube, normals outwards, each square with a diagonal: faces 2 and 3 are the top, with the diagonal from 4 to 7.
fn cube() -> Mesh {
    let vertices = (0..8).map(|k| Point3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh::new(vertices, squares.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()).unwrap()
}

/// The edge from vertex 4 to 5, between the top and the side y = 0.
const FRONT: Site = Site::Edge { face: 2, edge: 0 };
const CORNER: Site = Site::Vertex { vertex: 7, face: 2 };

#[test]
fn each_place_has_one_name_from_every_face() {
    let m = cube();
    assert_eq!((m.site(2, Feature::Edge(0)), m.site(5, Feature::Edge(1))), (FRONT, FRONT));
    assert_eq!((m.site(2, Feature::Edge(2)), m.site(3, Feature::Edge(0))), (Site::Face(2), Site::Face(3)));
    assert_eq!((m.site(2, Feature::Vertex(2)), m.site(11, Feature::Vertex(1))), (CORNER, CORNER));
    assert_eq!((FRONT.face(), CORNER.face(), Site::Face(7).face()), (2, 2, 7));
    assert_eq!((&m.faces_at(Site::Face(7))[..], &m.faces_at(FRONT)[..]), (&[7][..], &[2, 5][..]));
    assert_eq!(m.faces_at(CORNER)[..], [2, 3, 6, 7, 10, 11]);
    // Vertex 0 of a flat fan is no place of its own.
    let around = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let flat = around.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
    let fan = Mesh::new(flat, vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]).unwrap();
    assert_eq!(fan.site(2, Feature::Vertex(0)), Site::Face(2));
    assert_eq!(fan.site(2, Feature::Vertex(1)), Site::Vertex { vertex: 3, face: 1 });
}

#[test]
fn the_ends_of_an_edge_come_in_one_order() {
    let m = cube();
    assert_eq!((m.edge_ends(2, 0), m.edge_ends(5, 1)), ([4, 5], [4, 5]));
    assert_eq!((m.edge_ends(2, 2), m.edge_ends(3, 0)), ([4, 7], [4, 7]));
    assert_eq!(m.edge_ends(2, 1), [5, 7]);
}

#[test]
fn a_face_ends_at_its_edges_and_goes_on_across_a_flat_one() {
    let m = cube();
    let bound = |outward: Vector3<f64>, vertex: usize, next| RegionBound {
        outward: outward.normalize(),
        point: m.vertices()[vertex],
        next,
    };
    let across = Vector3::new(-1.0, 1.0, 0.0);
    assert_eq!(
        m.region(Site::Face(2))[..],
        [
            bound(-Vector3::y(), 4, FRONT),
            bound(Vector3::x(), 5, Site::Edge { face: 2, edge: 1 }),
            bound(across, 4, Site::Face(3)),
        ]
    );
}

#[test]
fn an_edge_ends_at_its_vertices_and_where_its_faces_begin() {
    let m = cube();
    let bound = |outward, vertex: usize, next| RegionBound { outward, point: m.vertices()[vertex], next };
    assert_eq!(
        m.region(FRONT)[..],
        [
            bound(-Vector3::x(), 4, Site::Vertex { vertex: 4, face: 2 }),
            bound(Vector3::x(), 5, Site::Vertex { vertex: 5, face: 2 }),
            bound(Vector3::y(), 4, Site::Face(2)),
            bound(-Vector3::z(), 4, Site::Face(5)),
        ]
    );
}

#[test]
fn a_vertex_ends_where_its_edges_begin() {
    let m = cube();
    let corner = m.vertices()[7];
    let edges = [(5, (2, 1)), (4, (2, 2)), (6, (3, 1)), (2, (6, 2)), (3, (7, 1)), (1, (10, 2))];
    let bounds = edges.map(|(far, (face, edge))| RegionBound {
        outward: (m.vertices()[far] - corner).normalize(),
        point: corner,
        next: Site::Edge { face, edge },
    });
    assert_eq!(m.region(CORNER)[..], bounds[..]);
}

#[test]
fn the_centre_follows_a_plane_a_cylinder_or_a_sphere() {
    let m = cube();
    let (front, corner) = (m.vertices()[4], m.vertices()[7]);
    assert_eq!((m.bend(Site::Face(2)), m.bend(Site::Edge { face: 2, edge: 2 })), (Bend::Flat, Bend::Flat));
    assert_eq!(m.bend(FRONT), Bend::Around { point: front, along: Vector3::x() });
    assert_eq!(m.bend(CORNER), Bend::About { point: corner });
    let centre = Point3::new(0.5, -1.0, 3.0);
    assert_eq!(m.bend(FRONT).away_from(&centre), Some(Vector3::new(0.0, -1.0, 2.0)));
    assert_eq!(m.bend(CORNER).away_from(&centre), Some(centre - corner));
    assert_eq!(Bend::Flat.away_from(&centre), None);
    let slanted = Bend::Around { point: front, along: Vector3::new(0.0, 0.0, 1.0) };
    let v = Vector3::new(5.0, -2.0, 4.0);
    assert_eq!(
        [Bend::Flat, slanted, m.bend(CORNER)].map(|b| b.across(&v)),
        [Vector3::zeros(), v - Vector3::z() * 4.0, v]
    );
}

#[test]
fn the_foot_of_a_centre_is_the_nearest_point_of_plane_line_or_vertex() {
    let m = cube();
    let p = Point3::<f64>::new;
    for (z, n) in [(3.0, Vector3::z()), (1.0, Vector3::z()), (-1.0, -Vector3::z())] {
        assert_eq!(m.foot(Site::Face(2), &p(0.25, 0.5, z)), Some((p(0.25, 0.5, 1.0), n)), "height {z}");
    }
    assert_eq!(m.foot(FRONT, &p(0.5, -3.0, 5.0)), Some((p(0.5, 0.0, 1.0), Vector3::new(0.0, -0.6, 0.8))));
    assert_eq!(m.foot(CORNER, &p(1.0, 4.0, 5.0)), Some((p(1.0, 1.0, 1.0), Vector3::new(0.0, 0.6, 0.8))));
    assert_eq!((m.foot(FRONT, &p(0.5, 0.0, 1.0)), m.foot(CORNER, &p(1.0, 1.0, 1.0))), (None, None));
    let anchors = [Site::Face(3), Site::Edge { face: 2, edge: 1 }, CORNER].map(|site| m.anchor(site));
    assert_eq!(anchors, [4, 5, 7].map(|v| m.vertices()[v]));
}
