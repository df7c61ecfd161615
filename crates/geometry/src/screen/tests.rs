//! Stretches beside a right-angled triangle in the plane z = 0: ruled out where they are off by more than the reach, and only there.

use super::*;
use crate::path::Path;
use crate::rounding::UNIT_ROUNDOFF;
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

fn is_off_nearest(x: [f64; 3], terms: &[[f64; 3]], span: [f64; 2], reach: f64) -> bool {
    let (path, corners) = seen(x, terms);
    Stretch::new(&path, span[0], span[1], reach).is_off_nearest(&corners)
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
fn the_plane_that_faces_the_path_rules_out_what_stays_farther_than_the_reach() {
    let half = 0.5f64.sqrt();
    // A point of the triangle, and a unit vector that leads away from it: off the face, an edge or a vertex, in its plane and out of it.
    for (p, out) in [
        ([1.0, 1.0], [0.0, 0.0, 1.0]),
        ([1.0, 1.0], [0.0, 0.0, -1.0]),
        ([1.0, 0.0], [0.0, -1.0, 0.0]),
        ([1.0, 0.0], [0.0, -0.6, 0.8]),
        ([0.0, 3.0], [-0.6, 0.0, -0.8]),
        ([2.0, 2.0], [half, half, 0.0]),
        ([0.0, 0.0], [-0.6, -0.8, 0.0]),
        ([4.0, 0.0], [0.8, 0.0, 0.6]),
        ([0.0, 4.0], [-0.6, 0.8, 0.0]),
    ] {
        let along = |d: f64| out.map(|c| d * c);
        let at = |d: f64| [p[0] + d * out[0], p[1] + d * out[1], d * out[2]];
        for (terms, span, nearest) in [
            (vec![-1.0], [0.0, 1.0], 2.0),
            (vec![-1.0], [0.0, 0.5], 2.5),
            (vec![1.0], [0.5, 1.0], 3.5),
            // 3 - 4 f + 4 f^2 is 2 in the middle, and so is its chord over [1/4, 3/4], at 9/4, less its bend; 3 + 4 f - 4 f^2 is 3 at the ends.
            (vec![-4.0, 4.0], [0.0, 1.0], 2.0),
            (vec![-4.0, 4.0], [0.25, 0.75], 2.0),
            (vec![4.0, -4.0], [0.0, 1.0], 3.0),
        ] {
            let terms: Vec<[f64; 3]> = terms.into_iter().map(along).collect();
            let off = |reach: f64| is_off_nearest(at(3.0), &terms, span, reach);
            assert!(off(nearest * LESS) && !off(nearest * MORE), "{p:?} {out:?} {terms:?} over {span:?}");
        }
        let cubic = [along(-0.5), along(0.125), along(0.0625)];
        let nearest = 3.0 - 0.3125 - seen(at(3.0), &cubic).0.chord(0.0, 1.0).sagitta;
        let off = |reach: f64| is_off_nearest(at(3.0), &cubic, [0.0, 1.0], reach);
        assert!(nearest > 2.0 && off(nearest * LESS) && !off(nearest * MORE), "{p:?} {out:?}");
    }
    // What passes beside an edge, slanting and bent, is measured where it passes the middle.
    assert!(is_off_nearest([-2.0, -2.0, 0.0], &[[6.0, 0.0, 0.0]], [0.0, 1.0], 2.0 * LESS));
    assert!(is_off_nearest([-2.0, -2.0, 1.0], &[[6.0, 0.0, -1.0]], [0.0, 1.0], 1.9));
    // To the very length of a plane's distance that has a whole one, a contact at the reach is not ruled out.
    assert!(!is_off_nearest([1.0, 1.0, 3.0], &[[0.0, 0.0, -1.0]], [0.0, 1.0], 2.0));
    // A triangle without an area is the segment or the point that it is.
    let path = Path::line(Point3::new(0.0, 0.0, 3.0), -Vector3::z());
    for corners in [[0.0, 1.0, 2.0], [0.0, 0.0, 0.0], [1.0, 0.0, 1.0]].map(|x| x.map(|x| Vector3::new(x, 0.0, -3.0))) {
        assert!(!Stretch::new(&path, 0.0, 1.0, 2.5).is_off_nearest(&corners));
    }
}

#[test]
fn no_stretch_is_ruled_out_that_comes_nearer_than_the_reach() {
    let few = [-3.0, -1.0, 0.5, 2.0, 5.0];
    let (mut ruled_out, mut kept) = (0, 0);
    for k in 0..15_625 {
        let pick = |i: u32| few[k / 5usize.pow(i) % 5];
        let (x, first) = ([pick(0), pick(1), pick(2)], [pick(3), pick(4), pick(5)]);
        for terms in
            [vec![first], vec![first, [pick(2), pick(0), -2.0]], vec![first, [0.5, pick(5), 1.0], [pick(1), 0.25, 1.0]]]
        {
            let (path, _) = seen(x, &terms);
            let triangle = CORNERS.map(Point3::from);
            let distance =
                |i: u32| crate::closest::closest_point(&triangle, &path.at(f64::from(i) / 32.0)).offset.norm();
            let nearest = (0..=32).map(distance).fold(f64::INFINITY, f64::min);
            assert!(!is_off_nearest(x, &terms, [0.0, 1.0], nearest * MORE), "{x:?} {terms:?}");
            let off = is_off_nearest(x, &terms, [0.0, 1.0], 0.5 * nearest);
            ruled_out += u32::from(off);
            kept += u32::from(!off);
        }
    }
    assert!(ruled_out > kept, "{ruled_out} of {} at half of their distance", ruled_out + kept);
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
        for triple in [[2.0, 3.0, 4.0], [4.0, 2.0, 3.0], [3.0, 4.0, 2.0]] {
            let corners = at(triple.map(|z| side * z));
            let off = |reach: f64| is_off_plane(&heights(&corners, &Vector3::z()), reach);
            assert!(off(2.0 * LESS) && !off(2.0) && !off(2.0 * MORE));
        }
        assert!(!is_off_plane(&heights(&at([side, 2.0 * side, -3.0 * side]), &Vector3::z()), 0.5), "it goes through");
    }
    assert!(!is_off_plane(&heights(&at([2.0, 3.0, 4.0]), &Vector3::zeros()), 0.0), "no normal tells nothing");
}

#[test]
fn over_the_inside_is_what_is_sure_to_be() {
    let of = |x: f64, y: f64, height: f64| {
        let corners = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)].map(|(a, b)| Vector3::new(a - x, b - y, -height));
        // However it is wound, and from either side.
        let [a, b, c] = corners;
        let both = [corners, [a, c, b]].map(|corners| is_over(&corners, &Vector3::z()));
        assert_eq!(both[0], both[1]);
        both[0]
    };
    assert!(of(1.0, 1.0, 3.0) && of(1.0, 1.0, -3.0) && of(1.0, 1.0, 0.0) && of(0.0625, 3.5, 1.0));
    // Outside, on the border, and beside it by less than rounding.
    assert!(!of(-1.0, 1.0, 1.0) && !of(3.0, 3.0, 1.0) && !of(2.0, 0.0, 1.0) && !of(0.0, 0.0, 1.0));
    assert!(!of(2.0, 64.0 * UNIT_ROUNDOFF, 1.0) && of(2.0, 4096.0 * UNIT_ROUNDOFF, 1.0));
    let flat = [Vector3::x(), Vector3::y(), Vector3::z()];
    assert!(!is_over(&flat, &Vector3::zeros()), "no normal tells nothing");
}
