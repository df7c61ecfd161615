//! Stretches beside a right-angled triangle in the plane z = 0: ruled out where they are off by more than the reach, and only there.

use super::*;
use crate::path::Path;
use nalgebra::Point3;

const CORNERS: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

/// Longer and shorter by 2^-20.
const MORE: f64 = 1.0 + 1.0 / 1_048_576.0;
const LESS: f64 = 1.0 - 1.0 / 1_048_576.0;

/// The path from `x` along these terms, and the triangle as seen from there.
fn seen(x: [f64; 3], terms: &[[f64; 3]]) -> (Path, [Vector3<f64>; 3]) {
    let terms: Vec<Vector3<f64>> = terms.iter().map(|t| Vector3::from(*t)).collect();
    (Path::from_terms(Point3::from(x), &terms), CORNERS.map(|c| Vector3::from(c) - Vector3::from(x)))
}

/// The triangle's normal, as its winding has it and as it may be declared.
fn normals() -> [Vector3<f64>; 2] {
    [Vector3::z(), -Vector3::z()]
}

fn is_off_face(x: [f64; 3], terms: &[[f64; 3]], span: [f64; 2], reach: f64) -> bool {
    let (path, corners) = seen(x, terms);
    let [there, back] = normals().map(|n| Stretch::new(&path, span[0], span[1], reach).is_off_face(&corners, &n));
    assert_eq!(there, back, "the side a normal is on is of no matter");
    there
}

fn is_off_edges(x: [f64; 3], terms: &[[f64; 3]], span: [f64; 2], reach: f64) -> bool {
    let (path, corners) = seen(x, terms);
    let stretch = Stretch::new(&path, span[0], span[1], reach);
    let [there, back] = normals().map(|n| stretch.is_off_edges(&corners, &n));
    assert_eq!(there, back, "the side a normal is on is of no matter");
    // With whichever corner it begins.
    let [a, b, c] = corners;
    for turned in [[b, c, a], [c, a, b], [a, c, b]] {
        assert_eq!(stretch.is_off_edges(&turned, &Vector3::z()), there);
    }
    there
}

#[test]
fn the_plane_of_the_face_rules_out_what_stays_farther_than_the_reach() {
    for side in [1.0, -1.0] {
        let z = |z: f64| [0.25, -0.5, side * z];
        // Straight from 3 to 1, wholly or half of the way: the nearer end decides.
        for (terms, span, nearest) in [
            (vec![z(-2.0)], [0.0, 1.0], 1.0),
            (vec![z(-2.0)], [0.0, 0.5], 2.0),
            (vec![z(-2.0)], [0.25, 0.5], 2.0),
            (vec![z(2.0)], [0.5, 1.0], 4.0),
            // 3 - 4 f + 4 f^2 is 2 in the middle; 3 + 4 f - 4 f^2 is 3 at the ends.
            (vec![z(-4.0), z(4.0)], [0.0, 1.0], 2.0),
            (vec![z(4.0), z(-4.0)], [0.0, 1.0], 3.0),
            (vec![z(4.0), z(-4.0)], [0.25, 0.75], 3.75),
            // Over [1/4, 3/4] its chord is at 9/4, and it at 2.
            (vec![z(-4.0), z(4.0)], [0.25, 0.75], 2.0),
            (vec![], [0.0, 1.0], 3.0),
        ] {
            let off = |reach: f64| is_off_face(z(3.0), &terms, span, reach);
            assert!(off(nearest * LESS) && !off(nearest) && !off(nearest * MORE), "{side} {terms:?} over {span:?}");
        }
        // Through the plane, and back to it.
        assert!(!is_off_face(z(1.0), &[z(-2.0)], [0.0, 1.0], 0.25));
        // A cubic may be below its chord by its sagitta: it is ruled out less easily, but not never.
        let cubic = [z(-1.0), z(0.5), z(0.25)];
        let (path, _) = seen(z(3.0), &cubic);
        let nearest = 3.0 - 0.25 - path.chord(0.0, 1.0).sagitta;
        assert!(nearest > 1.5 && is_off_face(z(3.0), &cubic, [0.0, 1.0], nearest * LESS));
        assert!(!is_off_face(z(3.0), &cubic, [0.0, 1.0], nearest * MORE));
    }
    // A plane that is not the triangle's own has all of it behind only from its highest corner on.
    let (path, corners) = seen([0.0, 0.0, 8.0], &[[0.0, 0.0, -1.0]]);
    let [a, b, c] = [0.0, 1.0, 2.0].map(|z| Vector3::z() * z);
    for up in [[a, b, c], [c, a, b], [b, c, a]] {
        let corners = [0, 1, 2].map(|i| corners[i] + up[i]);
        let off = |reach: f64| Stretch::new(&path, 0.0, 1.0, reach).is_off_face(&corners, &Vector3::z());
        assert!(off(5.0 * LESS) && !off(5.0));
    }
    assert!(!Stretch::new(&path, 0.0, 1.0, 0.0).is_off_face(&corners, &Vector3::zeros()), "no normal tells nothing");
}

#[test]
fn the_planes_through_the_edges_rule_out_what_stays_beside_them() {
    let half = 0.5f64.sqrt();
    // Out of each edge: a point of it, and the direction.
    for (p, out) in [([1.0, 0.0], [0.0, -1.0]), ([0.0, 1.0], [-1.0, 0.0]), ([2.0, 2.0], [half, half])] {
        let along = [-out[1], out[0]];
        let at = |d: f64, s: f64, z: f64| [p[0] + d * out[0] + s * along[0], p[1] + d * out[1] + s * along[1], z];
        let term = |d: f64, s: f64, z: f64| [d * out[0] + s * along[0], d * out[1] + s * along[1], z];
        for (terms, span, nearest) in [
            (vec![term(0.0, 0.5, -4.0)], [0.0, 1.0], 2.0),
            (vec![term(-1.0, 0.5, -4.0)], [0.0, 1.0], 1.0),
            (vec![term(-1.0, 0.5, -4.0)], [0.0, 0.5], 1.5),
            (vec![term(1.0, 0.0, -4.0)], [0.0, 1.0], 2.0),
            // 2 - 4 f + 4 f^2, and its other way.
            (vec![term(-4.0, 0.5, -4.0), term(4.0, 0.0, 0.0)], [0.0, 1.0], 1.0),
            (vec![term(4.0, 0.5, -4.0), term(-4.0, 0.0, 0.0)], [0.0, 1.0], 2.0),
        ] {
            let off = |reach: f64| is_off_edges(at(2.0, 0.0, 2.0), &terms, span, reach);
            assert!(off(nearest * LESS) && !off(nearest * MORE), "{p:?} {terms:?} over {span:?}");
        }
        let cubic = [term(-0.5, 0.0, -4.0), term(0.125, 0.0, 0.0), term(0.0625, 0.0, 0.0)];
        let nearest = 2.0 - 0.3125 - seen(at(2.0, 0.0, 2.0), &cubic).0.chord(0.0, 1.0).sagitta;
        let off = |reach: f64| is_off_edges(at(2.0, 0.0, 2.0), &cubic, [0.0, 1.0], reach);
        assert!(nearest > 1.0 && off(nearest * LESS) && !off(nearest * MORE), "{p:?}");
        // Within, or through the plane of the edge either way, however small the reach; or so bent that it may be.
        for terms in [[term(0.0, 0.0, -4.0)], [term(2.0, 0.0, -4.0)]] {
            assert!(!is_off_edges(at(-1.0, 0.0, 2.0), &terms, [0.0, 1.0], 0.0));
        }
        assert!(!is_off_edges(at(1.0, 0.0, 2.0), &[term(-2.0, 0.0, -4.0)], [0.0, 1.0], 0.0));
        let (there, back) = (term(-8.0, 0.0, -4.0), term(8.0, 0.0, 0.0));
        assert!(!is_off_edges(at(1.0, 0.0, 2.0), &[there, back], [0.0, 1.0], 0.5));
    }
    // To the very length of an edge that has a whole one, a contact at the reach is not ruled out.
    assert!(!is_off_edges([1.0, -2.0, 2.0], &[[0.0, 0.0, -4.0]], [0.0, 1.0], 2.0));
}

#[test]
fn a_ball_leads_into_the_triangle_where_it_comes_to_the_height_of_its_radius() {
    let leads = |x: [f64; 3], to: [f64; 3], radius: f64| {
        let term = [to[0] - x[0], to[1] - x[1], to[2] - x[2]];
        let (path, corners) = seen(x, &[term]);
        let [there, back] = normals().map(|n| Stretch::new(&path, 0.0, 1.0, 0.0).leads_into(&corners, &n, radius));
        assert_eq!(there, back, "the side a normal is on is of no matter");
        there
    };
    for side in [1.0, -1.0] {
        let p = |x: f64, y: f64, z: f64| [x, y, side * z];
        // Straight onto the inside, a border, and beside each edge.
        assert!(leads(p(1.0, 1.0, 3.0), p(1.0, 1.0, -1.0), 1.0) && leads(p(1.0, 0.0, 3.0), p(1.0, 0.0, -1.0), 1.0));
        for [x, y] in [[3.0, 3.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0], [5.0, -0.5], [-0.5, 5.0]] {
            assert!(!leads(p(x, y, 3.0), p(x, y, -1.0), 1.0), "{x} {y}");
        }
        // At a slant from x = -1 by 1 for 1: at height 2 it is over the triangle, at height 3 not yet; and the other way.
        assert!(leads(p(-1.0, 1.0, 4.0), p(3.0, 1.0, 0.0), 2.0) && !leads(p(-1.0, 1.0, 4.0), p(3.0, 1.0, 0.0), 3.5));
        assert!(leads(p(2.0, 1.0, 4.0), p(6.0, 1.0, 0.0), 3.5) && !leads(p(2.0, 1.0, 4.0), p(6.0, 1.0, 0.0), 2.0));
        assert!(leads(p(-3.0, 1.0, 4.0), p(5.0, 1.0, 0.0), 2.0), "half of the way");
        // Not so far as that, where it ends; as far from the start, where it begins; and away, where it ends.
        assert!(leads(p(-1.0, 1.0, 4.0), p(1.0, 1.0, 3.0), 1.0) && !leads(p(1.0, 1.0, 4.0), p(-1.0, 1.0, 3.0), 1.0));
        assert!(leads(p(1.0, 1.0, 0.5), p(-3.0, 1.0, 0.25), 1.0) && !leads(p(-1.0, 1.0, 0.5), p(1.0, 1.0, 0.25), 1.0));
        assert!(leads(p(-1.0, 1.0, 3.0), p(1.0, 1.0, 4.0), 1.0) && !leads(p(1.0, 1.0, 3.0), p(-1.0, 1.0, 4.0), 1.0));
        assert!(leads(p(-1.0, 1.0, 3.0), p(1.0, 1.0, 3.0), 1.0), "level, it is where it ends");
    }
}

#[test]
fn a_triangle_is_off_the_plane_through_the_origin_by_its_nearest_corner() {
    let at = |heights: [f64; 3]| [0, 1, 2].map(|i| Vector3::from(CORNERS[i]) + Vector3::z() * heights[i]);
    for side in [1.0, -1.0] {
        for heights in [[2.0, 3.0, 4.0], [4.0, 2.0, 3.0], [3.0, 4.0, 2.0]] {
            let corners = at(heights.map(|z| side * z));
            let off = |reach: f64| is_off_plane(&corners, &Vector3::z(), reach);
            assert!(off(2.0 * LESS) && !off(2.0) && !off(2.0 * MORE));
        }
        assert!(!is_off_plane(&at([side, 2.0 * side, -3.0 * side]), &Vector3::z(), 0.5), "it goes through");
    }
    assert!(!is_off_plane(&at([2.0, 3.0, 4.0]), &Vector3::zeros(), 0.0), "no normal tells nothing");
}
