//! H9 and H10: quadrilaterals off one plane, and concave polygons.

use super::super::{Bound, Case, Figure};
use crate::exact::exact;
use crate::nasty::{neighbours2, ulps};
use crate::random::Random;
use crate::solids::Solid;
use crate::stage::{Stage, smooth};
use carom_dynamics::events::Event;
use carom_geometry::error::PolygonError;
use carom_geometry::inside::Location;
use carom_geometry::polygon::Polygon;
use carom_geometry::quad::Quad;
use carom_geometry::rounding::{UNIT_ROUNDOFF, contact_doubt, point_radius};
use carom_geometry::segment::{SegmentHit, segment_hits_triangle};
use nalgebra::{Point2, Point3, Vector3};

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case {
            id: "H9",
            title: "a wavy sheet of quadrilaterals that are not planar",
            elsewhere: "an average normal; the hit point lies off both triangles",
            bound: "each split at its shorter diagonal, off-plane distance to 4 u; 0 segments and 0 balls through edges and diagonals",
            run: wavy_sheet,
        },
        Case {
            id: "H10",
            title: "points on vertices, edges and ulps beside them: star, comb with teeth of an ulp, collinear vertices",
            elsewhere: "even-odd scanlines count a vertex twice or not at all",
            bound: "the winding in rational arithmetic, every time; repeated vertices are refused",
            run: points_in_concave,
        },
        Case {
            id: "H10",
            title: "balls dropped on a star and a comb, wound either way",
            elsewhere: "a fan of triangles covers the notches",
            bound: "hit on the polygon, none beside it; the reverse loop: positions and normals the same to 4 u",
            run: balls_on_concave,
        },
    ]
}

/// A height without symmetry, so that no cell is planar.
fn height(i: u32, j: u32) -> f64 {
    let (x, y) = (f64::from(i), f64::from(j));
    0.3 * ((1.3 * x + 0.2).sin() * (0.9 * y - 0.4).cos())
}

fn wavy_sheet() -> Figure {
    const CELLS: u32 = 8;
    let mut random = Random::new(0x91);
    let mut bound = Bound::default();
    let vertex = |i: u32, j: u32| Point3::new(f64::from(i) - 4.0, f64::from(j) - 4.0, height(i, j));
    let mut faces: Vec<[Point3<f64>; 3]> = Vec::new();
    let mut ridges: Vec<[Point3<f64>; 2]> = Vec::new();
    for i in 0..CELLS {
        for j in 0..CELLS {
            let [p0, p1, p2, p3] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            match Quad::new([p0, p1, p2, p3]) {
                Ok(Quad::Split { triangles, off_plane }) => {
                    let n = (p2 - p0).cross(&(p3 - p1)).normalize();
                    let expected = n.dot(&(p1 - p0)).abs();
                    bound.keep((off_plane - expected).abs() <= 16.0 * UNIT_ROUNDOFF, || {
                        format!("cell {i} {j}: {off_plane:e}")
                    });
                    let [first, second] = triangles.map(|t| *t.vertices());
                    let diagonal = if (p2 - p0).norm() <= (p3 - p1).norm() { [p0, p2] } else { [p1, p3] };
                    let shared = |t: &[Point3<f64>; 3]| diagonal.iter().all(|p| t.contains(p));
                    bound.keep(shared(&first) && shared(&second), || {
                        format!("cell {i} {j}: not at the shorter diagonal")
                    });
                    faces.extend([first, second]);
                    ridges.extend([diagonal, [p0, p1], [p0, p3]]);
                }
                other => bound.keep(false, || format!("cell {i} {j}: {other:?}")),
            }
        }
    }
    // The simplest one has its distance to the last bit.
    let saddle =
        |lift: f64| Quad::new([[0.0, 0.0, 0.0], [2.0, 0.0, lift], [2.0, 2.0, 0.0], [0.0, 2.0, lift]].map(Point3::from));
    for lift in [0.5, 2f64.powi(-20), 2f64.powi(-40)] {
        let off = match saddle(lift) {
            Ok(Quad::Split { off_plane, .. }) => Some(off_plane),
            _ => None,
        };
        bound.keep(off == Some(lift), || format!("lift {lift:e}: {off:?}"));
    }
    let mesh = soup(&faces);
    let (mut segments, mut balls) = (0, 0);
    for [a, b] in ridges {
        if [a, b].iter().any(|p| p.x.abs() == 4.0 || p.y.abs() == 4.0) {
            continue;
        }
        for _ in 0..6 {
            let target = a + (b - a) * random.unit();
            let start = target + random.vector(0.5) + Vector3::new(0.0, 0.0, 3.0);
            let end = start + (target - start) * 2.0;
            let hit = faces.iter().any(|t| segment_hits_triangle(&start, &end, t) != SegmentHit::Miss);
            bound.keep(hit, || format!("a segment through {target:?}"));
            segments += 1;
        }
        for radius in [0.0, 1e-6, 0.05] {
            let target = a + (b - a) * random.unit();
            let stage = Stage::new(2.0).mesh("sheet", smooth(0.0), mesh.0.clone(), mesh.1.clone());
            let start = target + Vector3::new(0.1, -0.2, 3.0);
            let run = stage.ball(start, target - start, radius).run();
            let before = run.impacts().first().is_some_and(|e| e.time <= 1.0 + 1e-12);
            bound.keep(before, || format!("a ball of {radius} through {target:?}"));
            balls += 1;
        }
    }
    bound.figure(format!("64 cells split; {segments} segments and {balls} balls aimed at edges, none through"))
}

/// Triangles over vertices that they share where these are equal.
fn soup(faces: &[[Point3<f64>; 3]]) -> Solid {
    let mut vertices: Vec<Point3<f64>> = Vec::new();
    let number = |vertices: &mut Vec<Point3<f64>>, p: &Point3<f64>| match vertices.iter().position(|q| q == p) {
        Some(i) => i as u32,
        None => {
            vertices.push(*p);
            vertices.len() as u32 - 1
        }
    };
    let faces = faces.iter().map(|t| t.each_ref().map(|p| number(&mut vertices, p))).collect();
    (vertices, faces)
}

/// A star of five points.
fn star() -> Vec<Point2<f64>> {
    let tip = |k: u32| {
        let angle = f64::from(k) * std::f64::consts::TAU / 10.0;
        let r = if k.is_multiple_of(2) { 1.0 } else { 0.35 };
        Point2::new(r * angle.cos(), r * angle.sin())
    };
    (0..10).map(tip).collect()
}

/// A comb: teeth and gaps of `width` ulps of 1 each.
fn comb(width: i32) -> Vec<Point2<f64>> {
    let mut loop_ = vec![Point2::new(2.0, -1.0), Point2::new(0.0, -1.0), Point2::new(0.0, 1.0)];
    for tooth in 0..5 {
        let x = |side: i32| ulps(1.0, (4 * tooth + side) * width);
        loop_.extend([[x(0), 1.0], [x(1), 0.0], [x(2), 0.0], [x(3), 1.0]].map(Point2::from));
    }
    loop_.push(Point2::new(2.0, 1.0));
    loop_
}

/// A square with vertices on its straight sides, and a notch whose tip lies level with others.
fn notched() -> Vec<Point2<f64>> {
    let p = [
        [0.0, 0.0],
        [0.5, 0.0],
        [1.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [2.0, 1.5],
        [2.0, 2.0],
        [0.0, 2.0],
        [0.0, 1.0],
    ];
    p.map(Point2::from).to_vec()
}

/// Where `x` is: on the border, inside or outside, by the even-odd rule in rational arithmetic.
fn winding(polygon: &[Point2<f64>], x: &Point2<f64>) -> Location {
    let [px, py] = [exact(x.x), exact(x.y)];
    let mut inside = false;
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        if a == x {
            return Location::OnVertex(i);
        }
        let [ax, ay, bx, by] = [a.x, a.y, b.x, b.y].map(exact);
        let cross = (&bx - &ax) * (&py - &ay) - (&by - &ay) * (&px - &ax);
        let between = |low: f64, high: f64, x: f64| low.min(high) <= x && x <= low.max(high);
        if cross.is_zero() && between(a.x, b.x, x.x) && between(a.y, b.y, x.y) && b != x {
            return Location::OnEdge(i);
        }
        if (ay > py) != (by > py) {
            // The crossing lies to the right of x.
            let at = &ax + (&py - &ay) * (&bx - &ax) / (&by - &ay);
            inside ^= at > px;
        }
    }
    if inside { Location::Inside } else { Location::Outside }
}

fn flat(polygon: &[Point2<f64>]) -> Vec<Point3<f64>> {
    polygon.iter().map(|p| Point3::new(p.x, p.y, 0.0)).collect()
}

fn points_in_concave() -> Figure {
    let mut random = Random::new(0xa1);
    let mut bound = Bound::default();
    let mut asked = 0;
    let shapes = [("star", star()), ("comb of an ulp", comb(1)), ("comb of 3 ulps", comb(3)), ("notched", notched())];
    for (name, shape) in &shapes {
        let (forward, backward) =
            match (Polygon::new(flat(shape)), Polygon::new(flat(shape).into_iter().rev().collect())) {
                (Ok(forward), Ok(backward)) => (forward, backward),
                other => {
                    bound.keep(false, || format!("{name}: {other:?}"));
                    continue;
                }
            };
        bound.keep(forward.normal() == -backward.normal() && !forward.is_convex(), || format!("{name}: normals"));
        let count = shape.len();
        let mut points = Vec::new();
        for (i, a) in shape.iter().enumerate() {
            let b = shape[(i + 1) % count];
            points.extend(neighbours2(*a, 5));
            for k in 1..8 {
                points.extend(neighbours2(a + (b - a) * (f64::from(k) / 8.0), 4));
            }
            // On the level of every vertex, where a scanline meets it.
            points.extend((0..4).map(|_| Point2::new(random.within(-1.5, 2.5), a.y)));
        }
        points.extend((0..300).map(|_| Point2::new(random.within(-1.5, 2.5), random.within(-1.5, 2.5))));
        for x in &points {
            let expected = winding(shape, x);
            let at = Point3::new(x.x, x.y, 0.0);
            bound.keep(forward.locate(&at) == expected, || format!("{name}: {x:?} is {expected:?}"));
            let mirrored = match expected {
                Location::OnVertex(i) => Location::OnVertex(count - 1 - i),
                Location::OnEdge(i) => Location::OnEdge((2 * count - 2 - i) % count),
                other => other,
            };
            bound.keep(backward.locate(&at) == mirrored, || format!("{name} reversed: {x:?} is {mirrored:?}"));
        }
        asked += 2 * points.len();
        let area: f64 = forward.triangulate().len() as f64;
        bound.keep(area == (count - 2) as f64, || format!("{name}: {area} triangles"));
    }
    let mut repeated = flat(&star());
    repeated.insert(3, repeated[3]);
    bound.keep(matches!(Polygon::new(repeated), Err(PolygonError::RepeatedVertex { vertex: 3, .. })), || {
        "a repeated vertex".into()
    });
    bound.figure(format!("{asked} questions in {} polygons, all right", shapes.len()))
}

fn balls_on_concave() -> Figure {
    let mut random = Random::new(0xa2);
    let mut bound = Bound::default();
    let (mut hits, mut misses) = (0, 0);
    for (name, shape) in [("star", star()), ("comb", comb(1)), ("notched", notched())] {
        let loops = [flat(&shape), flat(&shape).into_iter().rev().collect::<Vec<_>>()];
        for k in 0..300 {
            let i = random.below(shape.len());
            let (a, b) = (shape[i], shape[(i + 1) % shape.len()]);
            let x = match k % 3 {
                0 => Point2::new(random.within(-1.5, 2.5), random.within(-1.5, 2.5)),
                1 => a + (b - a) * random.unit(),
                _ => a + (b - a) * random.unit() + Vector3::from(random.vector(1e-9)).xy(),
            };
            let runs = loops.each_ref().map(|vertices| {
                let vertices: Vec<[f64; 3]> = vertices.iter().map(|p| [p.x, p.y, p.z]).collect();
                let stage = Stage::new(1.5).polygon("polygon", smooth(1.0), &vertices);
                stage.ball([x.x, x.y, 1.0], [0.0, 0.0, -1.0], 0.0).run()
            });
            let events = runs.each_ref().map(|run| run.trajectory.events.clone());
            // The triangles may be others, and their roundings; a point an ulp beside an edge may be met within the doubt about it.
            let near = |a: &Event, b: &Event| {
                let off = (a.position - b.position).amax();
                let turned = (a.normal - b.normal).amax() * point_radius(2.0);
                let late = (a.time - b.time).abs();
                (a.kind, a.surface) == (b.kind, b.surface)
                    && off.max(turned) <= 4.0 * UNIT_ROUNDOFF
                    && late <= contact_doubt(2.0)
            };
            let same = events[0].len() == events[1].len() && events[0].iter().zip(&events[1]).all(|(a, b)| near(a, b));
            bound.keep(same, || format!("{name}: {x:?} depends on the winding"));
            // What stands for a point is touched within its radius.
            let doubt = 2.0 * point_radius(2.0);
            let clear = shape.iter().enumerate().all(|(i, a)| distance(a, &shape[(i + 1) % shape.len()], &x) > doubt);
            let expected = winding(&shape, &x) != Location::Outside;
            let hit = !runs[0].impacts().is_empty();
            bound.keep(hit == expected || (hit && !clear), || format!("{name}: {x:?} hit: {hit}"));
            hits += usize::from(hit);
            misses += usize::from(!hit);
        }
    }
    bound.keep(hits > 100 && misses > 100, || format!("too few: {hits}, {misses}"));
    bound.figure(format!("{hits} on it hit, {misses} beside it do not"))
}

fn distance(a: &Point2<f64>, b: &Point2<f64>, x: &Point2<f64>) -> f64 {
    let (e, w) = (b - a, x - a);
    let s = (e.dot(&w) / e.norm_squared()).clamp(0.0, 1.0);
    (w - e * s).norm()
}
