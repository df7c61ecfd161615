//! The inside test by determinants (R44 to R46), with every sign decided exactly.

use crate::predicates::{Sign, orient2d};
use nalgebra::Point2;

/// Where a point lies with respect to a polygon.
///
/// ```
/// use carom_geometry::inside::{Location, locate_simple};
/// use carom_geometry::nalgebra::Point2;
///
/// let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::from);
/// assert_eq!(locate_simple(&square, &Point2::new(0.5, 0.5)), Location::Inside);
/// assert_eq!(locate_simple(&square, &Point2::new(1.0, 0.5)), Location::OnEdge(1));
/// assert_eq!(locate_simple(&square, &Point2::new(1.0, 1.0)), Location::OnVertex(2));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Location {
    /// Strictly inside.
    Inside,
    /// On the edge from vertex i to the next, without its ends.
    OnEdge(usize),
    /// On vertex i.
    OnVertex(usize),
    /// Strictly outside.
    Outside,
}

/// The determinant of the edge a b (upper row) over the vector from a to x (lower row): R45, twice the signed area of the triangle a, b, x.
///
/// The textbook formula in plain f64: its sign is a guess where it is near zero. [`orient2d`] has the same sign without the guess.
pub fn edge_determinant(a: &Point2<f64>, b: &Point2<f64>, x: &Point2<f64>) -> f64 {
    let (edge, to_x) = (b - a, x - a);
    edge.x * to_x.y - edge.y * to_x.x
}

/// Where `x` lies in a *convex* polygon of either orientation: inside if the determinants of all edges have one sign (R46).
///
/// Exact for all finite coordinates. Vertices on an edge between two others are allowed. Fewer than three vertices, or vertices on one
/// line, have no inside; a polygon that is not convex gets a wrong answer.
pub fn locate_convex(vertices: &[Point2<f64>], x: &Point2<f64>) -> Location {
    if let Some(place) = on_boundary(vertices, x) {
        return place;
    }
    let mut signs = edges(vertices).map(|(_, a, b)| orient2d(a, b, x));
    let Some(first) = signs.next() else { return Location::Outside };
    // Beside the boundary, but on the line of an edge: outside, or on an edge that continues this one, which is ruled out.
    if first != Sign::Zero && signs.all(|s| s == first) { Location::Inside } else { Location::Outside }
}

/// Where `x` lies in a simple polygon, convex or concave, of either orientation: inside if a ray to the right crosses an odd number of
/// edges, an edge being crossed if it has its lower end (not its upper) on or below the ray.
///
/// Exact for all finite coordinates. For a polygon that crosses itself this is the even-odd rule.
pub fn locate_simple(vertices: &[Point2<f64>], x: &Point2<f64>) -> Location {
    if let Some(place) = on_boundary(vertices, x) {
        return place;
    }
    let crossed = edges(vertices).filter(|(_, a, b)| match (a.y <= x.y, b.y <= x.y) {
        (true, false) => orient2d(a, b, x) == Sign::Positive,
        (false, true) => orient2d(a, b, x) == Sign::Negative,
        _ => false,
    });
    if crossed.count() % 2 == 1 { Location::Inside } else { Location::Outside }
}

/// The vertex or edge on which `x` lies, if any; of several, the vertex, then the edge of lowest index.
fn on_boundary(vertices: &[Point2<f64>], x: &Point2<f64>) -> Option<Location> {
    if let Some(i) = vertices.iter().position(|v| v == x) {
        return Some(Location::OnVertex(i));
    }
    edges(vertices).find(|(_, a, b)| on_segment(a, b, x)).map(|(i, ..)| Location::OnEdge(i))
}

/// Whether `x` lies on the closed segment a b, exactly.
pub(crate) fn on_segment(a: &Point2<f64>, b: &Point2<f64>, x: &Point2<f64>) -> bool {
    let between = |a: f64, b: f64, x: f64| a.min(b) <= x && x <= a.max(b);
    between(a.x, b.x, x.x) && between(a.y, b.y, x.y) && orient2d(a, b, x) == Sign::Zero
}

/// The edges as (index, start, end).
fn edges(vertices: &[Point2<f64>]) -> impl Iterator<Item = (usize, &Point2<f64>, &Point2<f64>)> {
    let next = vertices.iter().cycle().skip(1);
    vertices.iter().zip(next).enumerate().map(|(i, (a, b))| (i, a, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Exact, exact};
    use proptest::prelude::*;

    fn square() -> Vec<Point2<f64>> {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point2::new(x, y)).to_vec()
    }

    /// The winding number of a polygon around a point off its boundary, by quadrants in rationals: no code shared with the rule tested.
    fn winding(vertices: &[Point2<f64>], x: &Point2<f64>) -> i32 {
        let zero = Exact::ZERO;
        let rel = |p: &Point2<f64>| (exact(p.x) - exact(x.x), exact(p.y) - exact(x.y));
        let quadrant = |(dx, dy): &(Exact, Exact)| -> i32 {
            if *dx > zero && *dy >= zero {
                0
            } else if *dx <= zero && *dy > zero {
                1
            } else if *dx < zero && *dy <= zero {
                2
            } else {
                3
            }
        };
        let quarters: i32 = edges(vertices)
            .map(|(_, a, b)| {
                let (a, b) = (rel(a), rel(b));
                match (quadrant(&b) - quadrant(&a)).rem_euclid(4) {
                    2 if &a.0 * &b.1 > &a.1 * &b.0 => 2,
                    2 => -2,
                    3 => -1,
                    q => q,
                }
            })
            .sum();
        quarters / 4
    }

    #[test]
    fn r45_determinant_is_edge_over_vector_to_the_hit() {
        let (a, b, x) = (Point2::new(1.0, 2.0), Point2::new(4.0, 3.0), Point2::new(2.0, 6.0));
        // |3 1; 1 4| = 11
        assert_eq!(edge_determinant(&a, &b, &x), 11.0);
        assert_eq!(edge_determinant(&b, &a, &x), -11.0);
    }

    #[test]
    fn r46_one_sign_is_inside_for_both_orientations() {
        let mut square = square();
        for _ in 0..2 {
            assert_eq!(locate_convex(&square, &Point2::new(0.5, 0.25)), Location::Inside);
            assert_eq!(locate_convex(&square, &Point2::new(1.0f64.next_up(), 0.25)), Location::Outside);
            assert_eq!(locate_convex(&square, &Point2::new(1.0f64.next_down(), 0.25)), Location::Inside);
            assert_eq!(locate_convex(&square, &Point2::new(2.0, 0.0)), Location::Outside);
            square.reverse();
        }
        assert_eq!(locate_convex(&square, &Point2::new(0.0, 1.0)), Location::OnVertex(3));
        assert_eq!(locate_convex(&square, &Point2::new(1.0, 0.25)), Location::OnEdge(1));
    }

    #[test]
    fn r46_degenerate_polygons_have_no_inside() {
        let p = Point2::new(1.0, 1.0);
        for vertices in
            [vec![], vec![p], vec![p, Point2::new(3.0, 3.0)], vec![p, Point2::new(3.0, 3.0), Point2::new(2.0, 2.0)]]
        {
            for locate in [locate_convex, locate_simple] {
                assert_eq!(locate(&vertices, &Point2::new(1.5, 1.0)), Location::Outside);
                assert_eq!(locate(&vertices, &Point2::new(4.0, 4.0)), Location::Outside);
                let on = if vertices.is_empty() { Location::Outside } else { Location::OnVertex(0) };
                assert_eq!(locate(&vertices, &p), on);
            }
        }
    }

    /// A comb with teeth an ulp wide, a vertex on an edge, and teeth ends at the same height.
    fn comb() -> Vec<Point2<f64>> {
        let mut vertices = vec![Point2::new(0.0, -1.0), Point2::new(2.0, -1.0), Point2::new(4.0, -1.0)];
        for k in (0..4).rev() {
            let x = f64::from(k) + 0.3;
            vertices.extend([Point2::new(x.next_up(), 0.0), Point2::new(x, 1.0), Point2::new(x.next_down(), 0.0)]);
        }
        vertices
    }

    #[test]
    fn r37_concave_comb_agrees_with_exact_winding_at_ulp_neighbours() {
        let mut vertices = comb();
        let mut counts = [0; 3];
        for _ in 0..2 {
            let anchors: Vec<_> = edges(&vertices)
                .flat_map(|(_, a, b)| (0..=8).map(move |k| a + (b - a) * (f64::from(k) / 8.0)))
                .collect();
            for p in anchors {
                for (i, j) in (-2..=2).flat_map(|i| (-2..=2).map(move |j| (i, j))) {
                    let x = Point2::new(ulps(p.x, i), ulps(p.y, j));
                    match locate_simple(&vertices, &x) {
                        Location::Inside => {
                            counts[0] += 1;
                            assert_eq!(winding(&vertices, &x).abs(), 1, "{x:?}");
                        }
                        Location::Outside => {
                            counts[1] += 1;
                            assert_eq!(winding(&vertices, &x), 0, "{x:?}");
                        }
                        Location::OnVertex(i) => assert_eq!(vertices[i], x),
                        Location::OnEdge(_) => counts[2] += 1,
                    }
                }
            }
            vertices.reverse();
        }
        assert!(counts.iter().all(|&n| n > 100), "inside, outside, on an edge: {counts:?}");
    }

    fn ulps(x: f64, n: i64) -> f64 {
        (0..n.abs()).fold(x, |x, _| if n > 0 { x.next_up() } else { x.next_down() })
    }

    proptest! {
        #[test]
        fn r46_convex_and_simple_rules_agree_on_triangles(c in prop::array::uniform8(-3i32..4), ulp in prop::array::uniform2(-1i64..2)) {
            let at = |i: usize| Point2::new(f64::from(c[2 * i]) / 3.0, f64::from(c[2 * i + 1]) / 3.0);
            let vertices = [at(0), at(1), at(2)];
            let x = Point2::new(ulps(at(3).x, ulp[0]), ulps(at(3).y, ulp[1]));
            prop_assert_eq!(locate_convex(&vertices, &x), locate_simple(&vertices, &x));
            if matches!(locate_simple(&vertices, &x), Location::Inside | Location::Outside) {
                let inside = winding(&vertices, &x) != 0;
                prop_assert_eq!(inside, locate_simple(&vertices, &x) == Location::Inside);
            }
        }
    }
}
