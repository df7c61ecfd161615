//! A mesh with one of each fault.

use super::*;
use crate::mesh::{Mesh, weld};

fn points(list: &[[f64; 3]]) -> Vec<Point3<f64>> {
    list.iter().map(|&p| Point3::from(p)).collect()
}

fn tetrahedron() -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let vertices = points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    (vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
}

#[test]
fn a_sound_mesh_has_no_findings() {
    let (vertices, faces) = tetrahedron();
    assert_eq!(diagnose(&vertices, &faces), []);
}

#[test]
fn everything_is_found_and_in_order() {
    let (mut vertices, mut faces) = tetrahedron();
    // 4 at the place of 1; 5 unused; 6 not finite and unused; 7 in the middle of 0 and 1.
    vertices.extend(points(&[[1.0, -0.0, 0.0], [9.0, 9.0, 9.0], [0.0, f64::NAN, f64::INFINITY], [0.5, 0.0, 0.0]]));
    // 1 wound the wrong way; 4 repeats 2 with other corners; 5 does not exist; 6 has no area.
    faces[1] = [1, 0, 3];
    faces.extend([[3, 4, 2], [0, 1, 99], [0, 1, 7]]);
    let findings = diagnose(&vertices, &faces);
    let text: Vec<_> = findings.iter().map(|f| format!("{:?}: {f}", f.severity())).collect();
    assert_eq!(
        text,
        [
            "Error: vertex 6 has the coordinate y = NaN; all must be finite",
            "Error: vertex 6 has the coordinate z = inf; all must be finite",
            "Error: corner 2 of face 5 is vertex 99, but there are 8 vertices, numbered from 0",
            "Warning: face 6 has no area: its corners lie on one line",
            "Warning: face 4 has the same corners as face 2",
            "Warning: the edge from vertex 0 to 1 has 3 faces: 0, 1, 6",
            "Warning: the edge from vertex 2 to 3 has 3 faces: 2, 3, 4",
            "Warning: faces 1 and 3, at the edge from vertex 0 to 3, are wound differently",
            "Warning: faces 1 and 2, at the edge from vertex 1 to 3, are wound differently",
            "Warning: 2 vertices are at the same place: 1, 4",
            "Note: the mesh is open: 4 edges have one face only, those of faces 4, 6",
            "Note: vertex 5 is in no face",
            "Note: vertex 6 is in no face",
        ]
    );
}

#[test]
fn there_is_an_error_exactly_where_a_mesh_is_refused() {
    let (vertices, faces) = tetrahedron();
    let mut broken = vertices.clone();
    broken[3].z = f64::NAN;
    let refused = [(&vertices, vec![]), (&broken, faces.clone()), (&vertices, vec![[0, 1, 4]])];
    let taken = [(&vertices, faces), (&vertices, vec![[0, 0, 0], [0, 1, 2], [0, 1, 2]])];
    for (vertices, faces) in refused.into_iter().chain(taken) {
        let found = diagnose(vertices, &faces);
        let error = found.iter().find_map(|f| if let Finding::Invalid(e) = f { Some(e.clone()) } else { None });
        assert_eq!(found.iter().any(|f| f.severity() == Severity::Error), error.is_some());
        match (Mesh::new(vertices.clone(), faces), error) {
            (Ok(_), None) => {}
            // NaN is not equal to itself: compare what is said.
            (Err(refusal), Some(error)) => assert_eq!(refusal.to_string(), error.to_string()),
            (result, error) => panic!("{result:?}, but {error:?}"),
        }
    }
}

#[test]
fn faces_with_their_own_vertices_are_open_until_they_are_welded() {
    let (vertices, faces) = tetrahedron();
    let soup: Vec<_> = faces.iter().flatten().map(|&v| vertices[v as usize]).collect();
    let mut own: Vec<[u32; 3]> = (0..4).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let findings = diagnose(&soup, &own);
    let places =
        findings.iter().filter(|f| matches!(f, Finding::DuplicateVertices { vertices } if vertices.len() == 3));
    assert_eq!(places.count(), 4);
    assert!(findings.iter().any(|f| matches!(f, Finding::Open { sides } if sides.len() == 12)));
    assert_eq!(weld(&soup, &mut own), 8);
    assert!(Mesh::new(soup, own).unwrap().edges().all(|e| e.count == 2));
}

#[test]
fn long_lists_are_cut_short_in_the_text_only() {
    let vertices: Vec<_> = (0..12).map(|k| Point3::new(f64::from(k), f64::from(k * k), 0.0)).collect();
    let faces: Vec<_> = (2..12).map(|k| [0, 1, k]).collect();
    let findings = diagnose(&vertices, &faces);
    let Some(crowded @ Finding::NonManifold { faces, .. }) = findings.first() else { panic!("{findings:?}") };
    assert_eq!(faces.len(), 10);
    let text = "the edge from vertex 0 to 1 has 10 faces: 0, 1, 2, 3, 4, 5, 6, 7 and 2 more";
    assert_eq!(crowded.to_string(), text);
}

#[test]
fn open_sides_are_those_without_a_neighbour() {
    let (vertices, mut faces) = tetrahedron();
    faces.remove(1);
    let open = diagnose(&vertices, &faces).into_iter().find(|f| matches!(f, Finding::Open { .. }));
    assert_eq!(open, Some(Finding::Open { sides: vec![(0, 2), (1, 2), (2, 1)] }));
}
