//! Leaves with faces against a look at every face.

use super::super::{Bvh, FatSegment, Pending, Seen, ShowFaces, lanes, walk, walk_narrow};
use super::*;
use crate::mesh::Mesh;
use crate::pierce::Pierced;
use crate::rounding::scale;
use crate::segment::{SegmentHit, segment_hits_triangle};
use crate::shear::Shear;
use crate::sweep::Work;
use nalgebra::Vector3;
use proptest::prelude::*;

type Triangle = [Point3<f64>; 3];

fn tree(triangles: &[Triangle]) -> Bvh {
    Bvh::of_faces(triangles.len(), |f| Aabb::of_points(&triangles[f]), |f| triangles[f as usize])
}

fn shown(tree: &Bvh, segment: &FatSegment) -> Vec<u32> {
    let mut shown = Vec::new();
    tree.visit(segment, |face| {
        shown.push(face);
        f64::INFINITY
    });
    shown.sort_unstable();
    shown
}

/// Integers up to 2^10, of which sums, differences and eighths are exact.
fn lattice() -> impl Strategy<Value = Point3<f64>> {
    let coordinate = || prop_oneof![-1024..=1024i32, -4..=4i32, Just(0)].prop_map(f64::from);
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| Point3::new(x, y, z))
}

/// Soups, strips that share their corners, faces without an area, and many copies of one.
fn triangles() -> impl Strategy<Value = Vec<Triangle>> {
    let one = || {
        prop_oneof![
            [lattice(), lattice(), lattice()],
            (lattice(), lattice()).prop_map(|(a, b)| [a, b, a]),
            lattice().prop_map(|a| [a; 3]),
            (lattice(), 0..8i32, 0..8i32).prop_map(|(a, i, j)| [
                a,
                a + Vector3::new(f64::from(i), f64::from(j), 0.0),
                a + Vector3::new(0.0, f64::from(i), f64::from(j)),
            ]),
        ]
    };
    let strip = proptest::collection::vec(lattice(), 3..60)
        .prop_map(|p| p.windows(3).enumerate().map(|(k, w)| [w[k % 3], w[(k + 1) % 3], w[(k + 2) % 3]]).collect());
    let copies = (one(), 1..40usize).prop_map(|(t, n)| vec![t; n]);
    prop_oneof![proptest::collection::vec(one(), 0..80), strip, copies]
}

/// Whether fewer than three places are among the corners.
fn repeats(t: &Triangle) -> bool {
    t[0] == t[1] || t[1] == t[2] || t[2] == t[0]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// What is not finite is shown everything: each face once, with its own corners in their order.
    #[test]
    fn every_face_is_in_a_leaf_with_its_corners(triangles in triangles(), k in -300..=300i32) {
        let triangles: Vec<Triangle> = triangles.iter().map(|t| t.map(|p| p.map(|c| scale(c, k)))).collect();
        let tree = tree(&triangles);
        prop_assert!(matches!(&tree.leaves, Leaves::Faces(_)));
        let endless = FatSegment { from: Point3::origin(), to: Point3::new(f64::INFINITY, 0.0, 0.0), radius: 0.0 };
        let mut seen = vec![0; triangles.len()];
        tree.look_along(&endless, &Shear::new(&endless.from, &endless.to), |face| {
            let t = &triangles[face.item as usize];
            seen[face.item as usize] += 1;
            match face.corners {
                Some(corners) => assert_eq!(corners.points(), *t),
                None => assert!(repeats(t), "{t:?}"),
            }
            f64::INFINITY
        });
        prop_assert!(seen.iter().all(|&times| times == 1), "{seen:?}");
    }

    /// Exactly: every face that a segment meets is shown, at any scale and wherever it points, and every one with a corner that is within
    /// the radius of a point of it.
    #[test]
    fn no_face_that_is_near_the_segment_is_left_out(
        triangles in triangles(), a in lattice(), d in lattice(), to_corner in any::<proptest::sample::Index>(),
        aims in any::<bool>(), r in prop_oneof![Just(0), 0..64i32], k in -300..=300i32,
    ) {
        let d = if aims && !triangles.is_empty() { (to_corner.get(&triangles)[0] - a) / 8.0 } else { d.coords };
        let unit = |p: Point3<f64>| p.map(|c| scale(c, k));
        let (from, to) = (unit(a), unit(a + d * 8.0));
        let scaled: Vec<Triangle> = triangles.iter().map(|t| t.map(unit)).collect();
        let shown = shown(&tree(&scaled), &FatSegment { from, to, radius: scale(f64::from(r), k) });
        prop_assert!(shown.windows(2).all(|w| w[0] < w[1]), "twice: {shown:?}");
        let near = |p: &Point3<f64>| (0..=8).any(|j| (p - (a + d * f64::from(j))).norm_squared() <= f64::from(r * r));
        for (face, (t, s)) in (0..).zip(triangles.iter().zip(&scaled)) {
            // An aimed segment is at its corner at j = 8, where d has no rounding.
            let met = segment_hits_triangle(&from, &to, s) != SegmentHit::Miss || (!aims && t.iter().any(near));
            prop_assert!(!met || shown.contains(&face), "face {face} lost");
        }
    }

    /// The first face that a segment meets is that of brute force, bit for bit.
    #[test]
    fn r46_the_first_face_pierced_is_that_of_brute_force(
        triangles in triangles(), from in lattice(), to in lattice(), k in prop_oneof![Just(0), -300..=200i32], offset in 0..3i32,
    ) {
        let shift = Vector3::repeat(f64::from(offset) / 3.0);
        let place = |p: Point3<f64>| (p + shift).map(|c| scale(c, k));
        let (from, to) = (place(from), place(to));
        let vertices: Vec<_> = triangles.iter().flatten().map(|p| place(*p)).collect();
        let faces: Vec<_> = (0..triangles.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        let Ok(mesh) = Mesh::new(vertices, faces) else { return Ok(()) };
        let hits = (0..mesh.faces().len() as u32).filter_map(|face| match segment_hits_triangle(&from, &to, &mesh.triangle(face)) {
            SegmentHit::Hit { f, feature, .. } => Some(Pierced { f, face, feature }),
            SegmentHit::Miss => None,
        });
        let first = hits.min_by(|a, b| a.f.total_cmp(&b.f).then(a.face.cmp(&b.face)));
        prop_assert_eq!(mesh.first_pierced(&from, &to, &mut Work::default()), first);
    }

    /// A box is shown the faces whose boxes it meets, and no others.
    #[test]
    fn a_box_is_shown_what_it_meets(triangles in triangles(), a in lattice(), b in lattice(), k in -300..=300i32) {
        let unit = |p: Point3<f64>| p.map(|c| scale(c, k));
        let scaled: Vec<Triangle> = triangles.iter().map(|t| t.map(unit)).collect();
        let query = Aabb::of_points(&[unit(a), unit(b)]);
        let mut shown = Vec::new();
        tree(&scaled).visit_box(&query, |face| shown.push(face));
        shown.sort_unstable();
        let met = |&face: &u32| Aabb::of_points(&scaled[face as usize]).intersects(&query);
        prop_assert_eq!(shown, (0..scaled.len() as u32).filter(met).collect::<Vec<_>>());
    }

    /// The same faces in the same order, with the same coordinates, by whichever registers the processor has.
    #[test]
    fn wider_registers_change_nothing(triangles in triangles(), a in lattice(), b in lattice(), r in 0..9i32, until in 0.0..1.0f64) {
        let tree = tree(&triangles);
        let segment = FatSegment { from: a, to: b, radius: f64::from(r) };
        let Some(local) = tree.frame.segment(&segment, &tree.bounds) else { return Ok(()) };
        let run = |narrow: bool| {
            let (mut stack, mut met) = (vec![Pending::default(); tree.stack], Vec::new());
            let Leaves::Faces(units) = &tree.leaves else { return Default::default() };
            let hit = |seen: Seen<'_>| {
                met.push((seen.item, seen.corners.map(|known| known.sheared().map(|v| v.map(f64::to_bits)))));
                until + 1.0 / met.len() as f64
            };
            let prism = Prism::around(&segment, &Shear::new(&a, &b), &tree.bounds);
            let mut leaves = ShowFaces { units, prism, sheared: lanes::ShearedPoints::default(), hit };
            let walk = if narrow { walk_narrow } else { walk };
            let visited = walk(&tree.nodes, &local, &mut stack, &mut leaves);
            (met, visited)
        };
        prop_assert_eq!(run(true), run(false));
    }

    /// Any f64 at all: a segment along a side of a face meets it.
    #[test]
    fn any_finite_corner_can_be_stored(bits in proptest::collection::vec(proptest::array::uniform9(any::<f64>().prop_filter("finite", |x| x.is_finite())), 1..30)) {
        let triangles: Vec<Triangle> = bits.iter().map(|b| [0, 3, 6].map(|i| Point3::new(b[i], b[i + 1], b[i + 2]))).collect();
        let tree = tree(&triangles);
        for t in &triangles {
            let to_corner = FatSegment { from: t[0], to: t[1], radius: 0.0 };
            let face = triangles.iter().position(|s| s == t).map(|f| f as u32);
            prop_assert!(shown(&tree, &to_corner).iter().any(|f| Some(*f) == face), "{t:?}");
        }
    }
}

fn terrain(squares: u32) -> Vec<Triangle> {
    let at = |i: u32, j: u32| {
        let (x, y) = (f64::from(i) / f64::from(squares), f64::from(j) / f64::from(squares));
        Point3::new(x, y, 0.05 * (7.0 * x + 11.0 * y * y).sin())
    };
    let places = (0..squares * squares).map(|k| (k / squares, k % squares));
    let halves = places.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
        [[a, b, d], [a, d, c]]
    });
    halves.collect()
}

#[test]
fn the_tree_is_the_same_on_however_many_cores() {
    let triangles = terrain(64);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let tree = pool.install(|| tree(&triangles));
        let Leaves::Faces(units) = tree.leaves else { panic!("there are corners") };
        (format!("{:?}", tree.nodes), units)
    };
    assert!(on(1) == on(3));
}

#[test]
fn the_leaves_of_a_terrain_are_well_filled() {
    let triangles = terrain(64);
    let per_face = tree(&triangles).bytes() as f64 / triangles.len() as f64;
    // Of sixteen faces with fifteen corners it would be 30, and the nodes 2 at least.
    assert!(per_face < 38.0, "{per_face}");
    let soup: Vec<Triangle> = (0..).zip(&triangles).map(|(k, t)| t.map(|p| p + Vector3::z() * f64::from(k))).collect();
    let leaf =
        |t: &[Triangle]| Faces { bounds: |_| Aabb::empty(), corners: |f: u32| t[f as usize] }.fit(0..t.len() as u32);
    assert!(leaf(&soup[..5]) && !leaf(&soup[..6]), "three corners each");
    assert!(leaf(&vec![triangles[0]; 16]) && !leaf(&vec![triangles[0]; 17]));
}
