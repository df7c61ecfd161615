//! H5 and H6: hits on edges and vertices, and no way out of a closed mesh.

use super::super::{Bound, Case, Figure, Worst};
use super::start::{bits, keep_events_apart};
use crate::random::Random;
use crate::solids::{Solid, icosphere, moved, triangles};
use crate::stage::{Run, Stage, smooth};
use carom_dynamics::events::Ending;
use carom_geometry::predicates::{Sign, orient3d};
use carom_geometry::rounding::UNIT_ROUNDOFF;
use carom_geometry::segment::{SegmentHit, segment_hits_triangle};
use nalgebra::{Point3, Vector3};

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case {
            id: "H5",
            title: "segments from inside a closed sphere of 320 triangles, aimed at edges and vertices",
            elsewhere: "20 000 segments: Moller-Trumbore loses 1255, orient2d of the rounded hit point 1826, parry 0.31.1 793",
            bound: "0 lost, as it is, at 1e8, flattened 1e-6, at 1e-160",
            run: segments_from_inside,
        },
        Case {
            id: "H5",
            title: "points and balls inside it, aimed at edges and vertices, bouncing for good",
            elsewhere: "parry #444: bunny littered with holes; Embree #181: shoots through even with ROBUST; three.js #11449",
            bound: "0 outside, every bounce answered once",
            run: balls_inside,
        },
        Case {
            id: "H5",
            title: "a ray on the diagonal between two triangles, and 1000 more",
            elsewhere: "Oblikovati #2146, tinybvh #168: missed; Embree #188: hit twice",
            bound: "one impact each, at h/v to 4 u, straight back",
            run: on_the_diagonal,
        },
        Case {
            id: "H6",
            title: "a ball on the tip of a pyramid, faces in every order",
            elsewhere: "the normal is that of the face that was tested first",
            bound: "n = (c - V)/|c - V| to 4 u; the same bits for all 120 x 3 orders",
            run: tip_in_every_order,
        },
    ]
}

/// The sphere as it is, far away, flattened, and tiny.
fn spheres(thickness: f64) -> [(&'static str, Solid); 4] {
    let unit = icosphere(2);
    let far = moved(&unit, |p| p + Vector3::new(1e8, -1e8, 1e8));
    let flat = moved(&unit, |p| Point3::new(p.x, p.y, thickness * p.z));
    let tiny = moved(&unit, |p| p * 1e-160);
    [("unit", unit), ("1e8 away", far), ("flattened", flat), ("1e-160", tiny)]
}

/// A point of an edge, or a vertex, as near as f64 gets.
fn target(random: &mut Random, (vertices, faces): &Solid) -> Point3<f64> {
    let face = faces[random.below(faces.len())];
    let (a, b) = (vertices[face[0] as usize], vertices[face[1] as usize]);
    match random.below(4) {
        0 => a,
        1 => a + (b - a) * 0.5,
        _ => a + (b - a) * random.unit(),
    }
}

/// A point well inside a convex solid.
fn inside(random: &mut Random, (vertices, _): &Solid) -> Point3<f64> {
    let centre = vertices.iter().fold(Vector3::zeros(), |sum, v| sum + v.coords / vertices.len() as f64);
    let vertex = vertices[random.below(vertices.len())];
    Point3::from(centre + (vertex.coords - centre) * random.within(0.0, 0.6))
}

/// Whether `x` is strictly inside a convex solid with its faces outwards, exactly.
fn is_inside(faces: &[[Point3<f64>; 3]], x: &Point3<f64>) -> bool {
    faces.iter().all(|[a, b, c]| orient3d(a, b, c, x) == Sign::Negative)
}

fn segments_from_inside() -> Figure {
    let mut random = Random::new(0x51);
    let mut bound = Bound::default();
    let mut shot = Vec::new();
    for (name, solid) in spheres(1e-6) {
        let faces = triangles(&solid);
        let count = if name == "1e-160" { 200 } else { 2000 };
        let mut lost = 0;
        for _ in 0..count {
            let start = inside(&mut random, &solid);
            let end = start + (target(&mut random, &solid) - start) * 2.0;
            let hit = faces.iter().any(|t| segment_hits_triangle(&start, &end, t) != SegmentHit::Miss);
            lost += usize::from(!hit);
        }
        bound.keep(lost == 0, || format!("{name}: {lost} lost"));
        shot.push(format!("{lost} of {count} ({name})"));
    }
    bound.figure(format!("lost {}", shot.join(", ")))
}

fn balls_inside() -> Figure {
    let mut random = Random::new(0x52);
    let mut bound = Bound::default();
    let (mut balls, mut impacts) = (0, 0);
    // Flatter, and the rim is a wedge that a ball without loss leaves after a million bounces.
    for (name, solid) in spheres(0.03).into_iter().filter(|(name, _)| *name != "1e-160") {
        let faces = triangles(&solid);
        let size = solid.0.iter().map(|p| (p - solid.0[0]).amax()).fold(0.0, f64::max);
        for k in 0..60 {
            let start = inside(&mut random, &solid);
            let aim = target(&mut random, &solid) - start;
            // As fast as it takes to get there in 1 s; every other one under a gravity that bends its way by as much.
            let g = if k % 2 == 0 { Vector3::zeros() } else { random.vector(size) };
            let velocity = aim - g * 0.5;
            // A ball that is inside at its start, or a point.
            let room = faces.iter().map(|t| height_below(t, &start)).fold(f64::INFINITY, f64::min);
            let radius = if k % 3 == 0 { 0.0 } else { room * 0.5 };
            let (c_r, what) = ([1.0, 0.9][k % 2], format!("{name}, ball {k}"));
            let (vertices, corners) = solid.clone();
            let stage = Stage::new(6.0).gravity(g).mesh("sphere", smooth(c_r), vertices, corners);
            let run = stage.ball(start, velocity, radius).run();
            keep_events_apart(&mut bound, &run, &what);
            bound.keep(!run.impacts().is_empty(), || format!("{what}: no impact"));
            bound.keep(run.outcome.ending == Ending::Completed, || format!("{what}: {:?}", run.outcome.ending));
            let out = first_outside(&run, &faces);
            bound.keep(out.is_none(), || format!("{what}: outside at {out:?}"));
            balls += 1;
            impacts += run.impacts().len();
        }
    }
    bound.figure(format!("{balls} balls, {impacts} impacts, none outside"))
}

/// How far `x` is below the plane of a triangle.
fn height_below([a, b, c]: &[Point3<f64>; 3], x: &Point3<f64>) -> f64 {
    let n = (b - a).cross(&(c - a));
    let scale = n.amax();
    let n = if scale > 0.0 {
        (n / scale).normalize()
    } else {
        (b - a).map(|c| c * 1e160).cross(&(c - a).map(|c| c * 1e160)).normalize()
    };
    n.dot(&(a - x))
}

/// The first time at which the centre is seen not inside, at 16 places of each segment.
fn first_outside(run: &Run, faces: &[[Point3<f64>; 3]]) -> Option<(f64, Point3<f64>)> {
    let places = run.trajectory.segments.iter().flat_map(|s| (0..=16).map(move |k| (s, s.to * f64::from(k) / 16.0)));
    let mut seen = places.map(|(s, f)| (s.time + s.step.time(f), s.step.at(f).position));
    seen.find(|(_, x)| !is_inside(faces, x))
}

fn on_the_diagonal() -> Figure {
    let mut random = Random::new(0x53);
    let (mut bound, mut worst) = (Bound::default(), Worst::new());
    let corner = |x: f64, y: f64| Point3::new(x, y, 0.0);
    let vertices = vec![corner(-5.0, -5.0), corner(5.0, -5.0), corner(5.0, 5.0), corner(-5.0, 5.0)];
    let faces = vec![[0, 1, 2], [0, 2, 3]];
    let run = |velocity: Vector3<f64>, start: Point3<f64>, radius: f64| {
        let stage = Stage::new(20.0).mesh("quad", smooth(1.0), vertices.clone(), faces.clone());
        stage.ball(start, velocity, radius).run()
    };
    let oblikovati = run(Vector3::new(0.30458447, 0.30458447, -0.9024725), Point3::new(0.0, 0.0, 10.0), 0.0);
    let place = oblikovati.impacts().first().map(|e| e.position.xy());
    bound.keep(place.is_some_and(|p| (p.x - 3.375).abs() < 1e-7 && p.x == p.y), || format!("hit at {place:?}"));
    let count = 1000;
    for k in 0..count {
        // Exactly onto the diagonal, or an ulp beside it.
        let s = random.within(-4.9, 4.9);
        let start = Point3::new(s, if k % 2 == 0 { s } else { s.next_up() }, random.within(1.0, 9.0));
        let velocity = Vector3::new(0.0, 0.0, -random.octave(-1, 6));
        let radius = if k % 3 == 0 { 0.5 } else { 0.0 };
        let run = run(velocity, start, radius);
        let impacts = run.impacts();
        bound.keep(impacts.len() == 1, || format!("from {start:?}: {} impacts", impacts.len()));
        let Some(event) = impacts.first() else { continue };
        bound
            .keep(event.velocity == -velocity && event.normal == Vector3::z(), || format!("from {start:?}: {event:?}"));
        // A point is a ball of a size that its place resolves.
        let reached = start.z + velocity.z * event.time;
        let radius =
            if radius > 0.0 { radius } else { carom_geometry::rounding::point_radius(start.coords.amax().max(10.0)) };
        worst.of((reached - radius).abs() / (UNIT_ROUNDOFF * start.z));
        bound.keep((reached - radius).abs() <= 4.0 * UNIT_ROUNDOFF * start.z, || {
            format!("from {start:?}: at {reached:e}")
        });
    }
    bound.figure(format!("{} rays, one impact each, off by {:.2} u at worst", count + 1, worst.0))
}

fn tip_in_every_order() -> Figure {
    let mut bound = Bound::default();
    let mut worst = Worst::new();
    let tip = Point3::new(0.1, -0.2, 0.7);
    let rim = (0..5).map(|k| {
        let angle = f64::from(k) * std::f64::consts::TAU / 5.0;
        Point3::new(angle.cos(), angle.sin(), -0.3 * f64::from(k))
    });
    let vertices: Vec<Point3<f64>> = std::iter::once(tip).chain(rim).collect();
    let faces: Vec<[u32; 3]> = (0..5).map(|k| [0, 1 + k, 1 + (k + 1) % 5]).collect();
    let mut first: Option<Run> = None;
    let mut orders = 0;
    for order in permutations(5) {
        for turn in 0..3 {
            let faces = order.iter().map(|&k| {
                let mut corners = faces[k];
                corners.rotate_left((turn + k) % 3);
                corners
            });
            let stage = Stage::new(2.0).down(9.81).mesh("tip", smooth(0.8), vertices.clone(), faces.collect());
            let run = stage.ball([0.15, -0.21, 2.0], [-0.02, 0.03, 0.0], 0.25).run();
            let impacts = run.impacts();
            let Some(hit) = impacts.first() else {
                bound.keep(false, || format!("{order:?}: no impact"));
                continue;
            };
            let n = (hit.position - tip).normalize();
            worst.of((hit.normal - n).amax() / UNIT_ROUNDOFF);
            bound
                .keep((hit.normal - n).amax() <= 4.0 * UNIT_ROUNDOFF, || format!("{order:?}: normal {:?}", hit.normal));
            let same = first.get_or_insert_with(|| run.clone());
            bound.keep(bits(same) == bits(&run), || format!("{order:?} turned by {turn}: another run"));
            orders += 1;
        }
    }
    let events = first.map_or(0, |run| run.trajectory.events.len());
    bound.figure(format!("{orders} orders, {events} events the same to the bit, normal off by {:.1} u", worst.0))
}

/// Every order of `count` things (Heap's algorithm).
pub(super) fn permutations(count: usize) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..count).collect();
    let mut all = vec![order.clone()];
    let mut state = vec![0; count];
    let mut i = 0;
    while i < count {
        if state[i] < i {
            order.swap(if i % 2 == 0 { 0 } else { state[i] }, i);
            all.push(order.clone());
            state[i] += 1;
            i = 0;
        } else {
            state[i] = 0;
            i += 1;
        }
    }
    all
}
