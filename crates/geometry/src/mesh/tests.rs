//! Small meshes of which everything is known.

use super::*;

fn points(list: &[[f64; 3]]) -> Vec<Point3<f64>> {
    list.iter().map(|&p| Point3::from(p)).collect()
}

/// The face 0 1 2 in the plane z = 0 with normal +z, and a second one over its side 0, the edge 0 1, to the point `d`.
fn hinge(d: [f64; 3], second: [u32; 3]) -> Mesh {
    let vertices = points(&[[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], d]);
    Mesh::new(vertices, vec![[0, 1, 2], second]).unwrap()
}

/// The twelve triangles of the unit cube, normals outwards, each square with a diagonal.
fn cube() -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let vertices = (0..8).map(|k| Point3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (vertices, squares.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// A grid of n by n squares with a height, two faces each.
fn terrain(n: u32) -> Mesh {
    let at = |k: u32| {
        let (x, y) = (f64::from(k % (n + 1)), f64::from(k / (n + 1)));
        Point3::new(x, y, (0.7 * x).sin() * (1.1 * y).cos())
    };
    let square = |k: u32| {
        let a = k / n * (n + 1) + k % n;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    Mesh::new((0..(n + 1) * (n + 1)).map(at).collect(), (0..n * n).flat_map(square).collect()).unwrap()
}

#[test]
fn the_fold_is_seen_from_the_front_of_each_face() {
    let (up, down, flat) = ([1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 0.0]);
    // The normal of 0 1 2 is +z, so that a neighbour that goes up rises before its front.
    for (d, first, alike, against) in [
        (up, Fold::Concave, Fold::Concave, Fold::Convex),
        (down, Fold::Convex, Fold::Convex, Fold::Concave),
        (flat, Fold::Flat, Fold::Flat, Fold::Flat),
    ] {
        for (second, expected) in [([1, 0, 3], alike), ([0, 1, 3], against)] {
            let m = hinge(d, second);
            assert_eq!(m.normal(0).unwrap().into_inner(), Vector3::z());
            assert_eq!((m.fold(0, 0), m.fold(1, 0)), (first, expected), "{d:?} {second:?}");
            assert!([(0, 1), (0, 2), (1, 1), (1, 2)].iter().all(|&(f, side)| m.fold(f, side) == Fold::Rim));
        }
    }
}

#[test]
fn what_rounding_may_leave_of_a_plane_is_no_fold_and_more_is() {
    for height in [5e-324, 1e-300, 1e-17, 2e-15, -1e-17, -2e-15] {
        assert_eq!(hinge([1.0, 0.0, height], [1, 0, 3]).fold(0, 0), Fold::Flat);
    }
    for height in [1e-14, 1e-9, 1.0] {
        assert_eq!(hinge([1.0, 0.0, height], [1, 0, 3]).fold(0, 0), Fold::Concave);
        assert_eq!(hinge([1.0, 0.0, -height], [1, 0, 3]).fold(0, 0), Fold::Convex);
    }
}

#[test]
fn what_rounding_may_leave_depends_on_the_heights_over_the_edge_at_every_scale() {
    for k in [-300, 0, 300] {
        // An edge of 1 and heights of 8: the bound is 28 u (8 / 8 + 8 / 8), which is a sine of 6.2e-15.
        let fold = |z: f64| {
            let [a, b, c, d] = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-8.0, 0.0, 0.0], [8.0, 0.0, 8.0 * z]];
            let scaled = points(&[a, b, c, d]).into_iter().map(|p| p * 2.0_f64.powi(k)).collect();
            Mesh::new(scaled, vec![[0, 1, 2], [1, 0, 3]]).unwrap().fold(0, 0)
        };
        assert_eq!([fold(0.0), fold(4e-15), fold(-4e-15)], [Fold::Flat; 3], "2^{k}");
        assert_eq!([fold(1e-14), fold(-1e-14)], [Fold::Concave, Fold::Convex], "2^{k}");
    }
}

#[test]
fn needles_of_one_plane_are_flat_by_an_exact_decision() {
    // So thin that rounding is never the reason, in each plane across an axis.
    for axis in 0..3 {
        let across = |x: f64, y: f64| {
            let mut p = [0.5; 3];
            (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (x, y);
            p
        };
        let vertices =
            |side: f64| points(&[across(0.0, 0.0), across(1.0, 0.0), across(0.5, 1e-7), across(0.5, side * 1e-7)]);
        let fold = |side: f64| Mesh::new(vertices(side), vec![[0, 1, 2], [1, 0, 3]]).unwrap().fold(0, 0);
        assert_eq!((fold(-1.0), fold(2.0)), (Fold::Flat, Fold::Rim), "axis {axis}");
    }
}

#[test]
fn the_surface_ends_where_the_neighbour_has_no_area_or_lies_back_on_it() {
    assert_eq!(hinge([0.0, 0.5, 0.0], [1, 0, 3]).fold(0, 0), Fold::Rim);
    assert_eq!(hinge([-3.0, 0.5, 0.0], [1, 0, 3]).fold(0, 0), Fold::Rim);
    assert_eq!(hinge([9.0, 9.0, 9.0], [2, 1, 0]).fold(0, 0), Fold::Rim);
    // The topology says what is there.
    assert_eq!(hinge([0.0, 0.5, 0.0], [1, 0, 3]).neighbours(0, 0).collect::<Vec<_>>(), [1]);
}

#[test]
fn a_face_of_no_area_has_no_normal_and_does_no_harm() {
    let vertices = points(&[[0.1, 0.1, 0.1], [0.2, 0.2, 0.2], [0.4, 0.4, 0.4], [1.0, 0.0, 0.0]]);
    let faces = vec![[0, 1, 2], [0, 0, 1], [3, 3, 3], [0, 1, 0], [0, 1, 3]];
    let m = Mesh::new(vertices, faces).unwrap();
    let with_normal: Vec<_> = (0..5).filter(|&f| m.normal(f).is_some()).collect();
    assert_eq!(with_normal, [4]);
    // Face 3 has the corners of face 1.
    assert_eq!(m.vertex_faces(0), [0, 1, 4]);
    assert_eq!(m.vertex_faces(3), [2, 4]);
    let twice = Mesh::new(m.vertices().to_vec(), vec![[0, 1, 0], [0, 1, 3]]).unwrap();
    assert_eq!((twice.vertex_faces(0), twice.vertex_faces(1)), (&[0, 1][..], &[0, 1][..]), "each face once");
    for f in 0..5 {
        for side in 0..3 {
            assert!(matches!(m.fold(f, side), Fold::Rim | Fold::NonManifold));
        }
    }
}

#[test]
fn h08_a_face_that_is_there_twice_adds_nothing() {
    let once = hinge([1.0, 0.0, 0.5], [1, 0, 3]);
    let again = [once.faces(), &[[1, 2, 0], [0, 2, 1], [0, 1, 3]]].concat();
    let m = Mesh::new(once.vertices().to_vec(), again).unwrap();
    assert_eq!(m.fold(0, 0), once.fold(0, 0));
    assert_eq!(m.neighbours(0, 0).collect::<Vec<_>>(), [1]);
    assert_eq!(m.neighbours(2, 0).count(), 0);
    assert_eq!(m.vertex_faces(0), [0, 1]);
    assert!(m.edges().eq(once.edges()));
    let mut seen = Vec::new();
    m.bvh().visit_box(m.bounds(), |face| seen.push(face));
    seen.sort_unstable();
    assert_eq!(seen, [0, 1]);
}

#[test]
fn three_faces_on_an_edge_are_not_a_manifold() {
    let vertices = points(&[[0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    let m = Mesh::new(vertices, vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]).unwrap();
    for f in 0..3 {
        assert_eq!(m.fold(f, 0), Fold::NonManifold);
        assert_eq!(m.owns_edge(f, 0), f == 0);
    }
    assert_eq!(m.neighbours(1, 0).collect::<Vec<_>>(), [2, 0]);
    let edge = m.edge(2, 0);
    assert_eq!(edge, Edge { vertices: [0, 1], owner: (0, 0), other: Some(1), count: 3, fold: Fold::NonManifold });
}

#[test]
fn a_cube_is_closed_and_its_diagonals_are_flat() {
    let (vertices, faces) = cube();
    let m = Mesh::new(vertices, faces).unwrap();
    let edges: Vec<_> = m.edges().collect();
    assert_eq!(edges.len(), 18);
    assert_eq!(8 - edges.len() as i64 + 12, 2, "Euler");
    assert!(edges.iter().all(|e| e.count == 2 && e.vertices[0] < e.vertices[1]));
    assert_eq!(edges.iter().filter(|e| e.fold == Fold::Flat).count(), 6);
    assert_eq!(edges.iter().filter(|e| e.fold == Fold::Convex).count(), 12);
    for f in 0..12 {
        assert_eq!(m.normal(f), m.normal(f ^ 1));
        let outwards = m.triangle(f)[0] - m.bounds().centre();
        assert!(m.normal(f).unwrap().dot(&outwards) > 0.0);
    }
}

#[test]
fn edges_and_used_vertices_have_one_owner_each() {
    let (vertices, faces) = cube();
    for m in [Mesh::new(vertices, faces).unwrap(), terrain(7), hinge([1.0, 0.0, 1.0], [0, 1, 3])] {
        let faces = 0..m.faces().len() as u32;
        let places = faces.flat_map(|f| (0..3).map(move |i| (f, i)));
        let owned_edges = places.clone().filter(|&(f, i)| m.owns_edge(f, i)).count();
        let mut keys: Vec<_> = places.clone().map(|(f, i)| m.edge(f, i).vertices).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(owned_edges, keys.len());
        for (f, i) in places.clone() {
            let (face, side) = m.edge(f, i).owner;
            assert!(m.owns_edge(face, side) && m.edge(face, side) == m.edge(f, i));
        }
        let owned_vertices = places.filter(|&(f, i)| m.owns_vertex(f, i)).count();
        assert_eq!(owned_vertices, m.vertices().len());
    }
}

#[test]
fn h28_coplanar_neighbours_have_one_normal_bit_for_bit() {
    // Lattice points of a plane that no axis knows: each triangle by itself has a normal with its own last bits.
    let (u, v) = (Vector3::new(3.0, 5.0, 1.0), Vector3::new(-2.0, 7.0, 4.0));
    let n = 9_u32;
    let at = |k: u32| Point3::origin() + u * f64::from(k % n).powi(2) + v * f64::from(k / n * (k % n + 3));
    let square = |k: u32| {
        let a = k / (n - 1) * n + k % (n - 1);
        // Every third one wound the other way.
        let flip = |[a, b, c]: [u32; 3]| if k.is_multiple_of(3) { [b, a, c] } else { [a, b, c] };
        [flip([a, a + 1, a + n + 1]), flip([a, a + n + 1, a + n])]
    };
    let vertices: Vec<_> = (0..n * n).map(at).collect();
    let faces: Vec<_> = (0..(n - 1) * (n - 1)).flat_map(square).collect();
    let own: Vec<_> = faces.iter().map(|f| unit_normal(&corners(&vertices, f)).unwrap().into_inner()).collect();
    assert!(own.iter().any(|n| *n != own[0] && *n != -own[0]), "the case is too easy");
    let m = Mesh::new(vertices, faces).unwrap();
    for (f, own) in own.iter().enumerate() {
        let n = m.normal(f as u32).unwrap().into_inner();
        assert!(n == m.normal(0).unwrap().into_inner() || n == -m.normal(0).unwrap().into_inner());
        assert!((n - own).amax() < 1e-14, "face {f} keeps its side");
    }
    assert!(m.edges().all(|e| matches!(e.fold, Fold::Flat | Fold::Rim)));
}

#[test]
fn a_planar_mesh_has_the_declared_normal_and_flat_edges() {
    let vertices = points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 1e-17], [1.0, 1.0, 0.0], [0.0, 1.0, 1e-16]]);
    let normal = UnitVector3::new_normalize(Vector3::new(0.0, 1e-9, 1.0));
    let m = Mesh::from_planar(vertices, vec![[0, 1, 2], [0, 2, 3]], normal).unwrap();
    assert_eq!((m.normal(0), m.normal(1)), (Some(normal), Some(normal)));
    assert_eq!((m.fold(0, 2), m.fold(1, 0), m.fold(0, 0)), (Fold::Flat, Fold::Flat, Fold::Rim));
}

#[test]
fn r37_a_concave_polygon_is_one_flat_surface_with_its_rim() {
    // An arrow head in a plane that no axis knows, with a vertex on a straight edge.
    let (u, v) = (Vector3::new(3.0, 5.0, 1.0), Vector3::new(-2.0, 7.0, 4.0));
    let corners = [[0.0, 0.0], [4.0, 0.0], [8.0, 0.0], [8.0, 8.0], [5.0, 2.0]];
    let polygon = Polygon::new(corners.map(|[x, y]| Point3::origin() + u * x + v * y).to_vec()).unwrap();
    let m = Mesh::from_polygon(&polygon);
    assert_eq!((m.vertices().len(), m.faces().len()), (5, 3));
    assert!((0..3).all(|f| m.normal(f) == Some(polygon.normal())));
    let rim = m.edges().filter(|e| e.fold == Fold::Rim);
    let mut ends: Vec<_> = rim.map(|e| e.vertices).collect();
    ends.sort_unstable();
    assert_eq!(ends, [[0, 1], [0, 4], [1, 2], [2, 3], [3, 4]]);
    assert_eq!(m.edges().filter(|e| e.fold == Fold::Flat).count(), 2);
}

#[test]
fn h12_scaling_by_a_power_of_two_changes_nothing() {
    let reference = terrain(6);
    for k in [-300, -77, 1, 300] {
        let scaled: Vec<_> = reference.vertices().iter().map(|p| p * 2.0_f64.powi(k)).collect();
        let m = Mesh::new(scaled, reference.faces().to_vec()).unwrap();
        assert!(m.edges().eq(reference.edges()));
        assert!((0..72).all(|f| m.normal(f) == reference.normal(f)));
    }
}

#[test]
fn what_is_no_mesh_is_refused_with_its_place() {
    let square = points(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
    assert_eq!(Mesh::new(square.clone(), vec![]).unwrap_err(), MeshError::Empty);
    let out = Mesh::new(square.clone(), vec![[0, 1, 2], [0, 3, 1]]).unwrap_err();
    assert_eq!(out, MeshError::IndexOutOfRange { face: 1, corner: 1, index: 3, vertices: 3 });
    assert_eq!(out.to_string(), "corner 1 of face 1 is vertex 3, but there are 3 vertices, numbered from 0");
    let mut broken = square;
    broken[2].y = f64::NEG_INFINITY;
    let not_finite = Mesh::new(broken, vec![[0, 1, 2]]).unwrap_err();
    assert_eq!(not_finite, MeshError::NonFinite { vertex: 2, axis: 1, value: f64::NEG_INFINITY });
    assert_eq!(not_finite.to_string(), "vertex 2 has the coordinate y = -inf; all must be finite");
}

#[test]
fn the_tree_finds_the_face_under_a_point() {
    let m = terrain(20);
    for f in 0..m.faces().len() as u32 {
        let [a, b, c] = m.triangle(f);
        let centre = Point3::from((a.coords + b.coords + c.coords) / 3.0);
        let down = crate::bvh::FatSegment { from: centre + Vector3::z(), to: centre - Vector3::z(), radius: 0.0 };
        let mut found = false;
        m.bvh().visit(&down, |item| {
            found |= item == f;
            f64::INFINITY
        });
        assert!(found, "face {f}");
    }
}

#[test]
fn a_face_takes_at_most_a_hundred_bytes() {
    let m = terrain(128);
    let per_face = m.bytes() as f64 / m.faces().len() as f64;
    assert!(per_face <= 100.0, "{per_face}");
    // Corners, normals and half-edges of each face; the start of each vertex's faces and the end; those faces; the tree.
    let (faces, vertices) = (m.faces().len(), m.vertices().len());
    assert_eq!(m.bytes(), (12 + 24 + 12) * faces + 4 * (vertices + 1) + 12 * faces + m.bvh().bytes());
}

#[test]
fn a_vertex_is_level_where_all_its_edges_are_flat() {
    // A fan around vertex 0, which is another corner of each face; its rim is not flat, but does not end at vertex 0.
    let around = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let fan = |height: f64| {
        let rim = around.map(|[x, y]| [x, y, 0.0]);
        Mesh::new(points(&[&[[0.0, 0.0, height]], &rim[..]].concat()), vec![[0, 1, 2], [3, 0, 2], [3, 4, 0], [0, 4, 1]])
    };
    let (flat, raised) = (fan(0.0).unwrap(), fan(0.5).unwrap());
    assert!(flat.is_level(0) && (1..5).all(|rim| !flat.is_level(rim)));
    assert!((0..5).all(|v| !raised.is_level(v)));
    // Wound against each other, so that both sides of the rim end at vertex 0 and none begins there.
    let against =
        Mesh::new(points(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]), vec![[0, 2, 1], [0, 2, 3]]);
    assert!(!against.unwrap().is_level(0));
    // One fold of several is enough.
    let (vertices, faces) = cube();
    let cube = Mesh::new(vertices, faces).unwrap();
    assert!((0..8).all(|v| !cube.is_level(v)));
}

#[test]
fn the_half_edges_of_the_most_faces_leave_three_bits() {
    assert!(3 * MOST_FACES < 1 << 29 && 3 * (MOST_FACES + 1) >= 1 << 29);
}
