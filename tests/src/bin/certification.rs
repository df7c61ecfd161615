//! What certification costs: plain, filtered and exact, per query and per bounce, in one run; prints a table in Markdown.
//!
//! Plain is the textbook's formula in f64, which is wrong where it is close. Filtered is what Carom does: an error bound decides, and exact
//! arithmetic only where it cannot. Exact is rational arithmetic all the time. The least of several runs counts.

use carom_dynamics::simulate::simulate;
use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::path::Path;
use carom_geometry::predicates::orient3d;
use carom_geometry::segment::{SegmentHit, segment_hits_triangle};
use carom_tests::exact;
use carom_tests::random::Random;
use carom_tests::stage::{Stage, smooth};
use carom_tests::world::to_triangle;
use nalgebra::{Point3, Vector3};
use std::hint::black_box;
use std::time::Instant;

/// Times that each measurement is repeated; the least counts.
const RUNS: usize = 7;

type Triangle = [Point3<f64>; 3];

fn main() {
    println!("| ns | plain f64 | filtered | exact | filtered / plain | exact / filtered |\n|---|--:|--:|--:|--:|--:|");
    orientations();
    segments();
    balls();
    bounces();
}

/// The least time of one of `items`, in ns.
fn per<T, R>(items: &[T], mut work: impl FnMut(&T) -> R) -> f64 {
    let mut once = || {
        let began = Instant::now();
        for item in items {
            black_box(work(black_box(item)));
        }
        began.elapsed().as_secs_f64() * 1e9 / items.len() as f64
    };
    (0..RUNS).map(|_| once()).fold(f64::INFINITY, f64::min)
}

fn row(name: &str, [plain, filtered, exact]: [f64; 3]) {
    let (dear, far) = (filtered / plain, exact / filtered);
    println!("| {name} | {plain:.1} | {filtered:.1} | {exact:.0} | {dear:.1} | {far:.1} |");
}

fn orientations() {
    let mut random = Random::new(1);
    let any: Vec<[Point3<f64>; 4]> = (0..2000).map(|_| [0; 4].map(|_| random.point(1.0))).collect();
    let close: Vec<[Point3<f64>; 4]> = (0..2000)
        .map(|_| {
            let t = random.triangle(1.0);
            [t[0], t[1], t[2], random.in_triangle(&t)]
        })
        .collect();
    for (name, points) in [("orient3d, any points", any), ("orient3d, on the plane to an ulp", close)] {
        let volume = |[a, b, c, d]: &[Point3<f64>; 4]| (b - a).cross(&(c - a)).dot(&(d - a));
        let plain = per(&points, |p| volume(p) > 0.0);
        let filtered = per(&points, |[a, b, c, d]| orient3d(a, b, c, d));
        let exact = per(&points[..200], |p| {
            let [a, b, c, d] = p.each_ref().map(exact::point);
            let normal = exact::cross(&exact::minus(&b, &a), &exact::minus(&c, &a));
            exact::dot(&normal, &exact::minus(&d, &a)) > exact::exact(0.0)
        });
        row(name, [plain, filtered, exact]);
    }
}

/// Moller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
fn moller_trumbore([a, b, c]: &Triangle, from: &Point3<f64>, to: &Point3<f64>) -> Option<f64> {
    let (d, ab, ac) = (to - from, b - a, c - a);
    let p = d.cross(&ac);
    let scale = 1.0 / ab.dot(&p);
    let s = from - a;
    let u = s.dot(&p) * scale;
    let q = s.cross(&ab);
    let (v, f) = (d.dot(&q) * scale, ac.dot(&q) * scale);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&f)).then_some(f)
}

fn segments() {
    let mut random = Random::new(2);
    let mut shots = |at_edge: bool| -> Vec<(Triangle, Point3<f64>, Point3<f64>)> {
        let shot = |random: &mut Random| {
            let t = random.triangle(1.0);
            let target = if at_edge { t[0] + (t[1] - t[0]) * random.unit() } else { random.in_triangle(&t) };
            let from = random.point(2.0);
            (t, from, from + (target - from) * 2.0)
        };
        (0..2000).map(|_| shot(&mut random)).collect()
    };
    for (name, shots) in [
        ("segment against triangle, aimed at its inside", shots(false)),
        ("segment against triangle, aimed at an edge", shots(true)),
    ] {
        let plain = per(&shots, |(t, p, q)| moller_trumbore(t, p, q));
        let filtered = per(&shots, |(t, p, q)| segment_hits_triangle(p, q, t));
        let exact = per(&shots[..200], |(t, p, q)| exact::segment_meets(t, p, q));
        let hits = |(t, p, q): &&(Triangle, _, _)| segment_hits_triangle(p, q, t) != SegmentHit::Miss;
        let wrong = shots.iter().filter(|s| moller_trumbore(&s.0, &s.1, &s.2).is_some() != hits(s)).count();
        row(&format!("{name} (plain is wrong in {wrong} of {})", shots.len()), [plain, filtered, exact]);
    }
}

/// The chapter's way for a ball on a straight path, in plain f64: the plane of the face, then edges, then vertices, each by its first root.
fn textbook(t: &Triangle, from: &Point3<f64>, d: &Vector3<f64>, r: f64) -> Option<f64> {
    let first = |a: f64, b: f64, c: f64| {
        let under = b * b - a * c;
        (a > 0.0 && under >= 0.0).then(|| (-b - under.sqrt()) / a).filter(|f| (0.0..=1.0).contains(f))
    };
    let n = (t[1] - t[0]).cross(&(t[2] - t[0])).normalize();
    let gap = n.dot(&(from - t[0]));
    let f = (r * gap.signum() - gap) / n.dot(d);
    let at = from + d * f;
    let inside = (0..3).all(|i| n.dot(&(t[(i + 1) % 3] - t[i]).cross(&(at - t[i]))) >= 0.0);
    if inside && (0.0..=1.0).contains(&f) {
        return Some(f);
    }
    let edge = |i: usize| {
        let (e, w) = ((t[(i + 1) % 3] - t[i]), from - t[i]);
        let square = e.norm_squared();
        let (along, ahead) = (e * (e.dot(d) / square), e * (e.dot(&w) / square));
        let (d, w) = (d - along, w - ahead);
        let f = first(d.norm_squared(), d.dot(&w), w.norm_squared() - r * r)?;
        let place = e.dot(&(from + (along + d) * f - t[i])) / square;
        (0.0..=1.0).contains(&place).then_some(f)
    };
    let vertex = |i: usize| {
        let w = from - t[i];
        first(d.norm_squared(), d.dot(&w), w.norm_squared() - r * r)
    };
    (0..3).filter_map(edge).chain((0..3).filter_map(vertex)).reduce(f64::min)
}

fn balls() {
    let mut random = Random::new(3);
    let shots: Vec<(Triangle, Point3<f64>, Vector3<f64>, f64)> = (0..2000)
        .map(|_| {
            let t = random.triangle(1.0);
            let from = loop {
                let x = random.point(2.0);
                if to_triangle(&t, &x).norm() > 0.5 {
                    break x;
                }
            };
            (t, from, (random.in_triangle(&t) - from) * 1.5, random.within(0.05, 0.4))
        })
        .collect();
    let plain = per(&shots, |(t, from, d, r)| textbook(t, from, d, *r));
    let paths: Vec<(Triangle, Path, f64)> =
        shots.iter().map(|(t, from, d, r)| (*t, Path::line(*from, *d), *r)).collect();
    let contact = |(t, path, r): &(Triangle, Path, f64)| {
        let mut rounds = 0;
        first_contact(&MovingBall { path, radius: *r, holds: &[] }, t, 0.0, 1.0, &mut rounds)
    };
    let filtered = per(&paths, contact);
    // One decision of a bisection takes 53.
    let exact = per(&shots[..200], |(t, from, d, r)| {
        let x = exact::on_path(from, &[*d], 0.5);
        exact::distance_squared(t, &x) > exact::exact(*r) * exact::exact(*r)
    });
    let missed = paths.iter().filter(|shot| contact(shot) == Contact::Miss).count();
    assert_eq!(missed, 0, "all are aimed at it");
    row("ball against triangle, first contact (exact: 53 steps of a bisection)", [plain, filtered, 53.0 * exact]);
}

/// Bounces in a box of six planes along the axes, without gravity.
fn bounces() {
    const BOUNCES: f64 = 100_000.0;
    let (size, start, velocity, r) = ([2.0, 1.5, 1.0], [0.5, 0.4, 0.3], [1.0, 0.7, 0.35], 0.125);
    let rate: f64 = (0..3).map(|i| velocity[i] / (size[i] - 2.0 * r)).sum();
    let duration = BOUNCES / rate;
    let plan = Stage::new(duration).room(smooth(1.0), size).ball(start, velocity, r).plan();
    let filtered = per(&[()], |()| simulate(&plan, &plan.balls()[0], &mut ())) / BOUNCES;
    // The nearest of the six walls, without memory of the last: it counts where the ball closes in.
    let walls = |axis: usize, v: f64| if v > 0.0 { size[axis] - r } else { r };
    let plain = per(&[()], |()| {
        let (mut x, mut v, mut t) = (start, velocity, 0.0);
        while t < duration {
            let time = |axis: usize| (walls(axis, v[axis]) - x[axis]) / v[axis];
            let times = [time(0), time(1), time(2)];
            let axis = (0..3).fold(0, |best, i| if times[i] < times[best] { i } else { best });
            (0..3).for_each(|i| x[i] += v[i] * times[axis]);
            v[axis] = -v[axis];
            t += times[axis];
        }
        (x, v)
    }) / BOUNCES;
    // The same with each time of impact rational, and rounded once.
    let many = 500;
    let exact = per(&[()], |()| {
        let (mut x, mut v) = (start, velocity);
        for _ in 0..many {
            let time =
                |axis: usize| (exact::exact(walls(axis, v[axis])) - exact::exact(x[axis])) / exact::exact(v[axis]);
            let times = [time(0), time(1), time(2)];
            let axis = (0..3).fold(0, |best, i| if times[i] < times[best] { i } else { best });
            for i in 0..3 {
                x[i] = exact::nearest(&(exact::exact(x[i]) + exact::exact(v[i]) * &times[axis]));
            }
            v[axis] = -v[axis];
        }
        (x, v)
    }) / f64::from(many);
    row("bounce in a box of six planes (plain, exact: nothing but the formula)", [plain, filtered, exact]);
}
