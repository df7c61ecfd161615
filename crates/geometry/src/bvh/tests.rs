//! The tree against a search through all boxes.

use nalgebra::{Point3, Vector3};
use proptest::prelude::*;

use super::*;

fn boxed(points: &[Point3<f64>]) -> Aabb {
    Aabb::of_points(points)
}

fn collect(tree: &Bvh, segment: &FatSegment) -> Vec<u32> {
    let mut met = Vec::new();
    tree.visit(segment, |item| {
        met.push(item);
        f64::INFINITY
    });
    met.sort_unstable();
    met
}

/// The square of the distance of a point from a box, exact for integers up to 2^20.
fn distance_squared(b: &Aabb, x: &Point3<f64>) -> f64 {
    (0..3).map(|i| (b.min()[i] - x[i]).max(x[i] - b.max()[i]).max(0.0).powi(2)).sum()
}

/// A grid of n by n squares with a height, two triangles' boxes each.
fn terrain(n: usize) -> Vec<Aabb> {
    let at = |i: usize, j: usize| {
        let (x, y) = (i as f64 / n as f64, j as f64 / n as f64);
        Point3::new(x, y, 0.05 * (7.0 * x + 11.0 * y * y).sin())
    };
    (0..n * n)
        .flat_map(|k| {
            let (i, j) = (k / n, k % n);
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
            [boxed(&[a, b, d]), boxed(&[a, d, c])]
        })
        .collect()
}

/// Integers up to 2^11, of which sums, differences and eighths are exact.
fn lattice() -> impl Strategy<Value = Point3<f64>> {
    let coordinate = || prop_oneof![-1024..=1024i32, -4..=4i32, Just(0)].prop_map(f64::from);
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| Point3::new(x, y, z))
}

fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
    let size = || prop_oneof![Just(0), 0..3, 0..1024i32].prop_map(f64::from);
    let one = || (lattice(), size(), size(), size()).prop_map(|(p, x, y, z)| boxed(&[p, p + Vector3::new(x, y, z)]));
    let copies = (one(), 1..40usize).prop_map(|(b, n)| vec![b; n]);
    prop_oneof![proptest::collection::vec(one(), 0..200), copies]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The points at s = k/8 are exact, so that what lies within the radius of one of them must be met, at any scale and
    /// any length of the segment, and a search that stops at the first must find the first.
    #[test]
    fn nothing_that_is_near_the_segment_is_lost(
        boxes in boxes(), a in lattice(), d in lattice(), r in prop_oneof![Just(0.0), (0..64i32).prop_map(f64::from)],
        scale in -300..=300i32, stretch in prop_oneof![Just(0), 0..39i32], back in any::<bool>(),
    ) {
        let (unit, d) = (2.0_f64.powi(scale), d.coords);
        let at = |k: i32| if back { a - d * f64::from(8 - k) } else { a + d * f64::from(k) };
        // Lengthened about the end where it is exact.
        let far = if back { a - d * 8.0 * 2.0_f64.powi(stretch) } else { a + d * 8.0 * 2.0_f64.powi(stretch) };
        let s_of = |k: i32| {
            let along = f64::from(if back { 8 - k } else { k }) / 8.0 / 2.0_f64.powi(stretch);
            if back { 1.0 - along } else { along }
        };
        let (from, to) = if back { (far, a) } else { (a, far) };
        let scaled: Vec<Aabb> = boxes.iter().map(|b| boxed(&[b.min() * unit, b.max() * unit])).collect();
        let tree = Bvh::build(&scaled);
        let segment = FatSegment { from: from * unit, to: to * unit, radius: r * unit };
        let met = collect(&tree, &segment);
        prop_assert!(met.windows(2).all(|w| w[0] < w[1]), "twice: {met:?}");
        let entry = |b: &Aabb| (0..=8).find(|&k| distance_squared(b, &at(k)) <= r * r);
        for (i, b) in boxes.iter().enumerate() {
            prop_assert!(entry(b).is_none() || met.contains(&(i as u32)), "item {i} lost");
        }
        let first = boxes.iter().filter_map(entry).min();
        let (mut found, mut last) = (None, f64::INFINITY);
        tree.visit(&segment, |item| {
            if let Some(k) = entry(&boxes[item as usize]) && found.is_none_or(|f| k < f) {
                found = Some(k);
                last = s_of(k);
            }
            last
        });
        prop_assert_eq!(found, first);
    }

    /// Scaling by a power of two gives the same answers, in the same order, by the same work.
    #[test]
    fn a_power_of_two_changes_nothing(boxes in boxes(), a in lattice(), b in lattice(), r in 0..9i32, k in -300..=300i32) {
        let run = |unit: f64| {
            let tree = Bvh::build(&boxes.iter().map(|b| boxed(&[b.min() * unit, b.max() * unit])).collect::<Vec<_>>());
            let mut met = Vec::new();
            let segment = FatSegment { from: a * unit, to: b * unit, radius: f64::from(r) * unit };
            let visited = tree.visit(&segment, |item| { met.push(item); f64::INFINITY });
            (met, visited)
        };
        prop_assert_eq!(run(1.0), run(2.0_f64.powi(k)));
    }

    /// The same items in the same order, by whichever registers the processor has.
    #[test]
    fn wider_registers_change_nothing(boxes in boxes(), a in lattice(), b in lattice(), r in 0..9i32, until in 0.0..1.0f64) {
        let tree = Bvh::build(&boxes);
        let Some(local) = tree.frame.segment(&FatSegment { from: a, to: b, radius: f64::from(r) }, &tree.bounds) else { return Ok(()) };
        let run = |narrow: bool| {
            let (mut stack, mut met) = (vec![Pending::default(); tree.stack], Vec::new());
            let hit = |seen: Seen<'_>| {
                met.push(seen.item);
                until + 1.0 / met.len() as f64
            };
            let Leaves::Boxes(items) = &tree.leaves else { return Default::default() };
            let mut leaves = ShowBoxes { items, hit };
            let walk = if narrow { walk_narrow } else { walk };
            let visited = walk(&tree.nodes, &local, &mut stack, &mut leaves);
            (met, visited)
        };
        prop_assert_eq!(run(true), run(false));
    }

    #[test]
    fn a_box_finds_all_that_it_meets(boxes in boxes(), a in lattice(), b in lattice(), scale in -300..=300i32) {
        let unit = 2.0_f64.powi(scale);
        let scaled: Vec<Aabb> = boxes.iter().map(|b| boxed(&[b.min() * unit, b.max() * unit])).collect();
        let query = boxed(&[a * unit, b * unit]);
        let mut met = Vec::new();
        Bvh::build(&scaled).visit_box(&query, |item| met.push(item));
        for (i, b) in scaled.iter().enumerate() {
            prop_assert!(!b.intersects(&query) || met.contains(&(i as u32)), "item {i} lost");
        }
    }

    /// Any f64 at all: segments that end on a corner of a box meet it.
    #[test]
    fn a_segment_that_ends_on_a_corner_meets_the_box(
        corners in proptest::collection::vec(proptest::array::uniform6(proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL | proptest::num::f64::ZERO), 1..30),
        other in proptest::array::uniform3(proptest::num::f64::NORMAL), which in any::<proptest::sample::Index>(), swap in any::<bool>(),
    ) {
        let pairs: Vec<_> = corners.iter().map(|c| [Point3::new(c[0], c[1], c[2]), Point3::new(c[3], c[4], c[5])]).collect();
        let tree = Bvh::build(&pairs.iter().map(|p| boxed(p)).collect::<Vec<_>>());
        let chosen = which.index(pairs.len());
        let (from, to) = (pairs[chosen][0], Point3::from(other));
        let (from, to) = if swap { (to, from) } else { (from, to) };
        let met = collect(&tree, &FatSegment { from, to, radius: 0.0 });
        prop_assert!(met.contains(&(chosen as u32)));
    }
}

#[test]
fn degenerate_input_works() {
    let origin = Point3::origin();
    let everywhere = FatSegment { from: Point3::new(-9.0, 0.0, 0.0), to: Point3::new(9.0, 0.0, 0.0), radius: 0.0 };
    assert!(Bvh::build(&[]).is_empty());
    assert_eq!(collect(&Bvh::build(&[]), &everywhere), []);
    assert_eq!(Bvh::build(&[]).visit_box(&boxed(&[origin]), |_| panic!("there is nothing")), 0);
    assert_eq!(collect(&Bvh::build(&[boxed(&[origin])]), &everywhere), [0]);
    assert_eq!(collect(&Bvh::build(&vec![boxed(&[origin]); 100]), &everywhere), (0..100).collect::<Vec<_>>());
    let mixed = [Aabb::empty(), boxed(&[origin]), Aabb::empty()];
    assert_eq!(collect(&Bvh::build(&mixed), &everywhere), [1]);
    let infinite = boxed(&[Point3::new(f64::NEG_INFINITY, 0.0, 0.0), Point3::new(f64::INFINITY, 1.0, 1.0)]);
    assert_eq!(collect(&Bvh::build(&[infinite, boxed(&[origin])]), &everywhere), [0, 1]);
}

#[test]
fn zero_lengths_axis_parallels_and_negative_zeros_lose_nothing() {
    let boxes = terrain(8);
    let tree = Bvh::build(&boxes);
    for (i, b) in boxes.iter().enumerate() {
        for axis in 0..3 {
            for zero in [0.0, -0.0, 5e-324, -5e-324] {
                let mut away = *b.min();
                away[axis] += 0.5;
                away[(axis + 1) % 3] += zero;
                for (from, to) in [(*b.min(), *b.min()), (*b.min(), away), (away, *b.min())] {
                    assert!(collect(&tree, &FatSegment { from, to, radius: 0.0 }).contains(&(i as u32)));
                }
            }
        }
    }
}

#[test]
fn h13_huge_segments_lose_nothing() {
    let boxes = terrain(16);
    let tree = Bvh::build(&boxes);
    for length in [1.0, 1e3, 1e8, 1e20, 1e150, 1e300] {
        for (i, b) in boxes.iter().enumerate() {
            let c = b.centre();
            let d = Vector3::new(length, -0.75 * length, 0.5 * length);
            let met = collect(&tree, &FatSegment { from: c, to: c + d, radius: 0.0 });
            assert!(met.contains(&(i as u32)), "item {i}, length {length}");
            let met = collect(&tree, &FatSegment { from: c - d, to: c, radius: 0.0 });
            assert!(met.contains(&(i as u32)), "item {i}, length {length}, backwards");
        }
    }
    let endless = FatSegment { from: Point3::origin(), to: Point3::new(f64::INFINITY, f64::NAN, 0.0), radius: 0.0 };
    assert_eq!(collect(&tree, &endless).len(), boxes.len());
    let nowhere = FatSegment { from: Point3::new(9.0, 9.0, 9.0), to: Point3::new(9.0, 9.0, 9.0), radius: f64::NAN };
    assert_eq!(collect(&tree, &nowhere).len(), boxes.len());
}

#[test]
fn far_from_the_origin_only_what_the_coordinates_lose_is_lost() {
    let shift = Vector3::new(1e8, -3e8, 2e8);
    let near: Vec<_> = terrain(64);
    let far: Vec<_> = near.iter().map(|b| boxed(&[b.min() + shift, b.max() + shift])).collect();
    let down = FatSegment { from: Point3::new(0.3, 0.6, 1.0), to: Point3::new(0.3, 0.6, -1.0), radius: 0.0 };
    let shifted = FatSegment { from: down.from + shift, to: down.to + shift, ..down };
    assert!(collect(&Bvh::build(&near), &down).len() <= 8);
    assert!(collect(&Bvh::build(&far), &shifted).len() <= 8);
}

#[test]
fn work_grows_with_the_logarithm() {
    let mean = |n: usize| {
        let tree = Bvh::build(&terrain(n));
        let (mut nodes, mut items) = (0, 0);
        for k in 0..1000 {
            // Points of a lattice that fills the square evenly.
            let x = (f64::from(k) * 0.754_877_666).fract();
            let y = (f64::from(k) * 0.569_840_291).fract();
            let segment = FatSegment { from: Point3::new(x, y, 1.0), to: Point3::new(x, y, -1.0), radius: 0.0 };
            nodes += tree.visit(&segment, |_| {
                items += 1;
                f64::INFINITY
            });
        }
        (nodes as f64 / 1000.0, f64::from(items) / 1000.0)
    };
    let (few, items) = mean(16);
    let (many, more_items) = mean(256);
    // 256 times the items: log8(256) = 2.7 levels more, at a little over one node a level.
    assert!(few >= 2.0 && many - few < 6.0, "{few} and {many} nodes");
    assert!(items < 6.0 && more_items < 6.0, "{items} and {more_items} items");
}

#[test]
fn clusters_within_clusters_do_not_make_it_deep() {
    // Ever smaller boxes towards a corner: the surface heuristic would peel off one at a time.
    let boxes: Vec<_> =
        (0..4000).map(|k| boxed(&[Point3::origin(), Point3::new(1.0, 1.0, 1.0) * 0.99_f64.powi(k)])).collect();
    let tree = Bvh::build(&boxes);
    assert!(tree.stack <= 7 * 27 + 8, "{}", tree.stack);
    let segment = FatSegment { from: Point3::origin(), to: Point3::origin(), radius: 0.0 };
    assert_eq!(collect(&tree, &segment).len(), 4000);
    // More is pending here than there is room for without a heap.
    let mut met = 0;
    tree.visit_box(&boxed(&[Point3::origin()]), |_| met += 1);
    assert_eq!(met, 4000);
    let mirrored: Vec<_> = boxes.iter().map(|b| boxed(&[-*b.min(), -*b.max()])).collect();
    assert_eq!(collect(&Bvh::build(&mirrored), &segment).len(), 4000);
}

#[test]
fn memory_is_below_forty_bytes_an_item() {
    let boxes = terrain(128);
    let per_item = Bvh::build(&boxes).bytes() as f64 / boxes.len() as f64;
    assert!(per_item < 40.0, "{per_item}");
}

#[test]
fn what_lies_in_a_row_is_shown_front_to_back() {
    let boxes: Vec<_> = (0..64)
        .map(|k| boxed(&[Point3::new(f64::from(k), 0.0, 0.0), Point3::new(f64::from(k) + 0.5, 1.0, 1.0)]))
        .collect();
    let tree = Bvh::build(&boxes);
    let (left, right) = (Point3::new(-9.0, 0.5, 0.5), Point3::new(99.0, 0.5, 0.5));
    let shown = |from, to| {
        let mut shown = Vec::new();
        tree.visit(&FatSegment { from, to, radius: 0.0 }, |item| {
            shown.push(item as i32);
            f64::INFINITY
        });
        shown
    };
    // To within the four items of a leaf.
    let disorder = |shown: Vec<i32>| shown.iter().zip(0..).map(|(item, k)| (item - k).abs()).max();
    assert!(disorder(shown(left, right)) < Some(4));
    assert!(disorder(shown(right, left).into_iter().map(|item| 63 - item).collect()) < Some(4));
    let mut first = Vec::new();
    let work = tree.visit(&FatSegment { from: left, to: right, radius: 0.0 }, |item| {
        first.push(item);
        9.25 / 108.0
    });
    assert!(first.len() <= 4 && work <= 2, "beyond the limit nothing is looked at: {first:?}, {work} nodes");
}

#[test]
fn a_box_finds_little_that_it_does_not_meet() {
    let boxes = terrain(16);
    let tree = Bvh::build(&boxes);
    let mut met = Vec::new();
    let visited = tree.visit_box(&boxes[100], |item| met.push(item));
    let touching = boxes.iter().filter(|b| b.intersects(&boxes[100])).count();
    assert!(met.len() <= touching + 4 && (2..16).contains(&visited), "{} for {touching}, {visited} nodes", met.len());
}

#[test]
fn a_tree_says_how_much_it_holds() {
    let one = boxed(&[Point3::origin()]);
    for n in 1..4 {
        let tree = Bvh::build(&vec![one; n]);
        assert_eq!((tree.len(), tree.is_empty()), (n, false));
        assert_eq!(tree.bytes(), 7 * 8 * 4 + 4 * n, "six planes and a child, eight of each, and the items");
    }
    assert_eq!((Bvh::build(&[]).len(), Bvh::build(&[]).bytes()), (0, 0));
}
