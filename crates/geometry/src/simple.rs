//! Simple loops of points in a plane: which edges cross, which way round, and ear clipping. All decisions are exact.

use crate::inside::on_segment;
use crate::predicates::{Sign, orient2d};
use nalgebra::Point2;

/// The first two edges that cross, touch or overlap other than at the vertex between them, as indices in ascending order; none if the loop is
/// simple. Edge i runs from vertex i to the next. Looks at all pairs.
pub(crate) fn first_crossing(vertices: &[Point2<f64>]) -> Option<(usize, usize)> {
    let n = vertices.len();
    let edge = |i: usize| (&vertices[i], &vertices[(i + 1) % n]);
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.into_iter().find(|&(i, j)| {
        let ((a, b), (c, d)) = (edge(i), edge(j));
        match (j == i + 1, (j + 1) % n == i) {
            // They share b = c or d = a: only folding back onto each other is wrong.
            (true, _) => on_segment(a, b, d) || on_segment(c, d, a),
            (_, true) => on_segment(a, b, c) || on_segment(c, d, b),
            _ => segments_meet(a, b, c, d),
        }
    })
}

/// Whether the closed segments a b and c d have a point in common.
fn segments_meet(a: &Point2<f64>, b: &Point2<f64>, c: &Point2<f64>, d: &Point2<f64>) -> bool {
    let apart = |i: usize| a[i].max(b[i]) < c[i].min(d[i]) || c[i].max(d[i]) < a[i].min(b[i]);
    if apart(0) || apart(1) {
        return false;
    }
    if on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b) {
        return true;
    }
    let splits = |p, q, r, s| orient2d(p, q, r) == orient2d(p, q, s).reverse() && orient2d(p, q, r) != Sign::Zero;
    splits(a, b, c, d) && splits(c, d, a, b)
}

/// Which way a simple loop turns: `Positive` is counterclockwise.
pub(crate) fn orientation(vertices: &[Point2<f64>]) -> Sign {
    let n = vertices.len();
    let least = (0..n).min_by(|&i, &j| {
        let (p, q) = (&vertices[i], &vertices[j]);
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
    });
    // The leftmost, of these lowest, vertex is a true corner: its neighbours are not on one line with it.
    least.map_or(Sign::Zero, |i| orient2d(&vertices[(i + n - 1) % n], &vertices[i], &vertices[(i + 1) % n]))
}

/// The turn at every vertex.
pub(crate) fn turns(vertices: &[Point2<f64>]) -> impl Iterator<Item = Sign> {
    let n = vertices.len();
    (0..n).map(move |i| orient2d(&vertices[(i + n - 1) % n], &vertices[i], &vertices[(i + 1) % n]))
}

/// The n - 2 triangles of a simple loop, by ear clipping; each turns as the loop does and has an area.
///
/// An ear is a corner whose closed triangle holds no other vertex, so that vertices on a straight edge are kept for a triangle of their own. A
/// simple loop always has one (Meisters 1975; flat vertices change nothing, as a diagonal still exists). The next one is looked
/// for from the last on, which avoids fans. Cubic in n at worst.
pub(crate) fn clip_ears(vertices: &[Point2<f64>]) -> Vec<[usize; 3]> {
    let way = orientation(vertices);
    let mut left: Vec<usize> = (0..vertices.len()).collect();
    let mut triangles = Vec::with_capacity(vertices.len().saturating_sub(2));
    let mut from = 0;
    while left.len() >= 3 {
        let n = left.len();
        let corner = |k: usize| [left[(k + n - 1) % n], left[k % n], left[(k + 1) % n]];
        let ear = (from..from + n).find(|&k| is_ear(vertices, &left, corner(k), way));
        let Some(k) = ear else {
            debug_assert!(false, "no ear among {left:?} of {vertices:?}");
            break;
        };
        triangles.push(corner(k));
        left.remove(k % n);
        from = k % n;
    }
    triangles
}

fn is_ear(vertices: &[Point2<f64>], left: &[usize], corner: [usize; 3], way: Sign) -> bool {
    let [a, b, c] = corner.map(|i| &vertices[i]);
    let within = |x| [(a, b), (b, c), (c, a)].iter().all(|(p, q)| orient2d(p, q, x) != way.reverse());
    orient2d(a, b, c) == way && !left.iter().any(|i| !corner.contains(i) && within(&vertices[*i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Exact, exact};
    use proptest::prelude::*;

    fn points<const N: usize>(p: [(f64, f64); N]) -> Vec<Point2<f64>> {
        p.map(|(x, y)| Point2::new(x, y)).to_vec()
    }

    fn twice_area(vertices: &[Point2<f64>]) -> Exact {
        let n = vertices.len();
        (0..n).fold(Exact::ZERO, |sum, i| {
            let (p, q) = (vertices[i], vertices[(i + 1) % n]);
            sum + exact(p.x) * exact(q.y) - exact(p.y) * exact(q.x)
        })
    }

    #[test]
    fn r36_crossings_are_found_where_they_are() {
        let bow_tie = points([(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert_eq!(first_crossing(&bow_tie), Some((0, 2)));
        let spike = points([(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
        assert_eq!(first_crossing(&spike), Some((0, 1)));
        let spike_at_the_end = points([(1.0, 0.0), (1.0, 1.0), (0.0, 0.0), (2.0, 0.0)]);
        assert!(first_crossing(&spike_at_the_end).is_some());
        assert_eq!(
            first_crossing(&points([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])),
            Some((0, 2)),
            "folds back at the end"
        );
        let touching = points([(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
        assert_eq!(first_crossing(&touching), Some((0, 2)));
        let touching_from_below = points([(4.0, 0.0), (0.0, 0.0), (0.0, -2.0), (2.0, 0.0), (4.0, -2.0)]);
        assert_eq!(first_crossing(&touching_from_below), Some((0, 2)));
        let touching_from_the_left = points([(0.0, 4.0), (0.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (-2.0, 4.0)]);
        assert_eq!(first_crossing(&touching_from_the_left), Some((0, 2)));
        let nearly = points([(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, f64::from_bits(1)), (0.0, 2.0)]);
        assert_eq!(first_crossing(&nearly), None);
        let flat_vertices = points([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0)]);
        assert_eq!(first_crossing(&flat_vertices), None);
    }

    #[test]
    fn r47_ears_keep_vertices_on_straight_edges() {
        // A square with the middles of its edges, and a triangle with many points on one side.
        let square =
            points([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0), (0.0, 2.0), (0.0, 1.0)]);
        let side = points([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (4.0, 0.0), (1.0, 3.0)]);
        for vertices in [square, side] {
            check(&vertices);
        }
    }

    /// n - 2 triangles of the loop's orientation whose areas add up exactly.
    fn check(vertices: &[Point2<f64>]) {
        let triangles = clip_ears(vertices);
        assert_eq!(triangles.len(), vertices.len() - 2, "{vertices:?}");
        let mut sum = Exact::ZERO;
        for t in &triangles {
            let t = t.map(|i| vertices[i]);
            assert_eq!(orient2d(&t[0], &t[1], &t[2]), orientation(vertices));
            sum += twice_area(&t);
        }
        assert_eq!(sum, twice_area(vertices));
    }

    proptest! {
        #[test]
        fn r37_concave_loops_are_triangulated_exactly(radii in prop::collection::vec(1u32..6, 4..24), reverse in any::<bool>()) {
            // Star-shaped: one vertex in each direction of a square spiral of directions, at any distance.
            let n = radii.len();
            let mut vertices: Vec<Point2<f64>> = radii.iter().enumerate().map(|(i, r)| {
                let angle = i as f64 / n as f64 * std::f64::consts::TAU;
                Point2::new((f64::from(*r) * angle.cos() * 8.0).round(), (f64::from(*r) * angle.sin() * 8.0).round())
            }).collect();
            if reverse {
                vertices.reverse();
            }
            // Rounding to integers can make neighbours coincide or edges touch; that is not the subject here.
            if first_crossing(&vertices).is_none() {
                check(&vertices);
            } else {
                prop_assert!(n > 12, "{vertices:?}");
            }
        }
    }
}
