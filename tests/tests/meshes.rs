//! The meshes that the scenes use: what the doctor says about them, their topology, and the tree over them.

use carom_geometry::bvh::FatSegment;
use carom_geometry::doctor::{Finding, diagnose};
use carom_geometry::mesh::{Fold, Mesh};
use carom_tests::obj;
use nalgebra::{Point3, Vector3};

const SPOT: &str = include_str!("../../crates/app/scenes/meshes/spot_triangulated.obj");
const BUNNY: &str = include_str!("../../crates/app/scenes/meshes/low_poly_bunny.obj");
const STAIRS: &str = include_str!("../../crates/app/scenes/meshes/stairs.obj");
const TERRAIN: &str = include_str!("../../crates/app/scenes/meshes/bullet_terrain.obj");
const JACKSBORO: &str = include_str!("../../crates/app/scenes/meshes/jacksboro_dem_quarter.obj");

fn mesh(text: &str) -> Mesh {
    let (vertices, faces) = obj::read(text);
    Mesh::new(vertices, faces).unwrap()
}

fn findings(text: &str) -> Vec<Finding> {
    let (vertices, faces) = obj::read(text);
    diagnose(&vertices, &faces)
}

/// Vertices - edges + faces: 2 for a sphere, 1 for a disk.
fn euler(m: &Mesh) -> i64 {
    m.vertices().len() as i64 - m.edges().count() as i64 + m.faces().len() as i64
}

fn count(m: &Mesh, fold: Fold) -> usize {
    m.edges().filter(|e| e.fold == fold).count()
}

/// The volume inside, by the divergence theorem; positive if the normals point outwards.
fn volume(m: &Mesh) -> f64 {
    let corners = (0..m.faces().len() as u32).map(|f| m.triangle(f).map(|p| p.coords));
    corners.map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum()
}

#[test]
fn spot_bunny_and_stairs_are_closed_and_sound() {
    for (text, faces) in [(SPOT, 5856), (BUNNY, 696), (STAIRS, 44)] {
        assert_eq!(findings(text), []);
        let m = mesh(text);
        assert_eq!(m.faces().len(), faces);
        assert_eq!(euler(&m), 2);
        assert_eq!(m.edges().count() * 2, faces * 3);
        assert!(m.edges().all(|e| e.count == 2));
        assert!(volume(&m) > 0.0);
    }
}

#[test]
fn the_terrains_are_open_and_otherwise_sound() {
    for (text, [columns, rows]) in [(TERRAIN, [30, 30]), (JACKSBORO, [101, 86])] {
        let m = mesh(text);
        assert_eq!(m.faces().len(), 2 * (columns - 1) * (rows - 1));
        assert_eq!(euler(&m), 1);
        let rim = 2 * (columns - 1) + 2 * (rows - 1);
        let [Finding::Open { sides }] = &findings(text)[..] else { panic!("{:?}", findings(text)) };
        assert_eq!(sides.len(), rim);
        assert_eq!(count(&m, Fold::Rim), rim);
    }
}

#[test]
fn the_folds_of_a_body_are_those_of_its_shape() {
    // A body is convex on the whole, and the cow and the bunny are smooth: no two faces in exactly one plane.
    for text in [SPOT, BUNNY] {
        let m = mesh(text);
        assert!(count(&m, Fold::Convex) > count(&m, Fold::Concave));
        assert!(count(&m, Fold::Concave) > 0);
    }
    // The steps of the stairs are made of rectangles.
    let m = mesh(STAIRS);
    let flat: Vec<_> = m.edges().filter(|e| e.fold == Fold::Flat).collect();
    assert!(flat.len() >= 22, "{} flat edges", flat.len());
    for e in flat {
        assert_eq!(m.normal(e.owner.0), e.other.and_then(|f| m.normal(f)));
    }
}

#[test]
fn a_fold_agrees_with_the_angle_between_the_normals() {
    for text in [SPOT, BUNNY, STAIRS, TERRAIN, JACKSBORO] {
        let m = mesh(text);
        for e in m.edges() {
            let Some(other) = e.other else { continue };
            let (n, k) = (m.normal(e.owner.0).unwrap(), m.normal(other).unwrap());
            // From the middle of the edge across the other face: upwards is concave. Where rounding could decide, it does not count.
            let [a, b] = e.vertices.map(|v| m.vertices()[v as usize].coords);
            let [p, q, r] = m.triangle(other).map(|p| p.coords);
            let across = ((p + q + r) / 3.0 - (a + b) / 2.0).normalize();
            let rise = across.dot(&n);
            match e.fold {
                Fold::Concave => assert!(rise > -1e-12, "{e:?} {rise}"),
                Fold::Convex => assert!(rise < 1e-12, "{e:?} {rise}"),
                Fold::Flat => assert!(rise.abs() < 1e-12 && (n.dot(&k) - 1.0).abs() < 1e-12, "{e:?}"),
                Fold::Rim | Fold::NonManifold => panic!("{e:?}"),
            }
        }
    }
}

#[test]
fn every_face_is_found_from_everywhere() {
    for text in [SPOT, BUNNY, STAIRS, TERRAIN, JACKSBORO] {
        let m = mesh(text);
        let size = m.bounds().extent().norm();
        for f in 0..m.faces().len() as u32 {
            let [a, b, c] = m.triangle(f);
            let from = m.bounds().centre() + Vector3::new(0.3, 1.7, -0.9) * size;
            let middle = nalgebra::center(&nalgebra::center(&a, &b), &c);
            for to in [a, middle, middle + (middle - from) * 1e6] {
                let mut found = false;
                let radius = 1e-15 * size * if to == middle || to == a { 1.0 } else { 1e6 };
                m.bvh().visit(&FatSegment { from, to, radius }, |item| {
                    found |= item == f;
                    f64::INFINITY
                });
                assert!(found, "face {f} towards {to}");
            }
        }
    }
}

#[test]
fn a_short_step_looks_at_few_nodes_and_faces() {
    let m = mesh(JACKSBORO);
    let (mut nodes, mut faces, mut steps) = (0, 0, 0);
    for f in (0..m.faces().len() as u32).step_by(7) {
        let [a, ..] = m.triangle(f);
        let to: Point3<f64> = a + Vector3::new(3.0, 5.0, -20.0);
        nodes += m.bvh().visit(&FatSegment { from: a, to, radius: 1.0 }, |_| {
            faces += 1;
            f64::INFINITY
        });
        steps += 1;
    }
    // 17 000 faces are less than five levels.
    let (nodes, faces) = (nodes as f64 / f64::from(steps), f64::from(faces) / f64::from(steps));
    assert!(nodes < 10.0 && faces < 20.0, "{nodes} nodes and {faces} faces a step");
}
