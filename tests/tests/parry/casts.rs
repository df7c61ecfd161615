//! Flying balls against parry3d's shape casts.
//!
//! Parry's casts end when GJK's bounds agree to the square root of its tolerance: in general position they are off by 1e-8 as a rule
//! and by 1e-5 at worst, more at grazes and from near starts. Who is right is then asked of parry's own distance: at our f the ball
//! touches, to rounding. Where the two are far apart, rational arithmetic says that it is the first touch.

use crate::queries::BUNNY;
use crate::{Tally, oracle};
use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::mesh::Mesh;
use carom_geometry::path::Path;
use carom_geometry::rounding::{contact_bound, contact_doubt, position_bound};
use carom_geometry::sweep::Work;
use carom_tests::random::Random;
use carom_tests::{exact, obj};
use nalgebra::{Point3, Vector3};

/// Differences in m from which on rational arithmetic is asked as well.
const RATIONAL: f64 = 1e-6;

/// The f at which our ball first touches the triangle.
fn ours(triangle: &[Point3<f64>; 3], from: &Point3<f64>, to: &Point3<f64>, radius: f64) -> Option<f64> {
    let path = Path::line(*from, to - from);
    match first_contact(&MovingBall { path: &path, radius, holds: &[] }, triangle, 0.0, 1.0, &mut 0) {
        Contact::At { f, .. } => Some(f),
        Contact::Miss => None,
    }
}

/// A cast: both answers, the radius and the length of the way, and parry's distance from the obstacle along it.
struct Cast<'a> {
    ours: Option<f64>,
    theirs: Option<f64>,
    radius: f64,
    length: f64,
    /// The sum of all lengths.
    extent: f64,
    distance: &'a dyn Fn(f64) -> f64,
    /// Whether the first contact is at f, by rational arithmetic.
    rational: &'a dyn Fn(f64) -> bool,
}

impl Cast<'_> {
    fn compare(&self, tally: &mut Tally) {
        let gap = |f: f64| (self.distance)(f) - self.radius;
        // Of parry's distance, and of the point on the way.
        let rounding = 2.0 * position_bound(self.extent);
        let doubt = contact_doubt(self.extent) + rounding;
        let case = || format!("ours {:?}, parry {:?}, r = {}", self.ours, self.theirs, self.radius);
        match (self.ours, self.theirs) {
            (None, None) => tally.agree(),
            (Some(ours), Some(theirs)) => {
                let difference = (ours - theirs).abs() * self.length;
                // How much of the way a difference in distance makes.
                if tally.agree_within(difference, doubt) {
                    return;
                }
                if gap(0.0) < 0.0 {
                    // Parry counts an overlap at the start whatever the ball does next; we count it if the ball closes in, and so
                    // may come to another face.
                    let settled = theirs == 0.0 && ours > 0.0 && (self.rational)(ours);
                    tally.explain("an overlap that we let separate", settled, 0.0, case);
                    return;
                }
                let touches = gap(ours) <= doubt && gap(ours) >= -rounding;
                let settled = touches && (difference <= RATIONAL || (self.rational)(ours));
                let reason = match gap(theirs) {
                    d if d > doubt => "a cast that stops short",
                    d if d < -rounding => "a cast that overlaps",
                    _ => "a graze, in which both touch to rounding",
                };
                tally.explain(reason, settled, difference, case);
            }
            (None, Some(theirs)) => {
                let separating = theirs == 0.0 && gap(0.0) < 0.0;
                tally.explain("an overlap that we let separate", separating, 0.0, case);
            }
            (Some(ours), None) => {
                let settled = gap(ours).abs() <= doubt && (self.rational)(ours);
                tally.explain("a graze that parry misses", settled, 0.0, case);
            }
        }
    }
}

/// Whether the ball first touches the triangle at `f`, to rounding: nothing but doubt is left there, and just before it was more.
/// Along a line the distance from a convex body is convex: it only fell until then.
fn first_at(triangle: &[Point3<f64>; 3], from: &Point3<f64>, to: &Point3<f64>, radius: f64, f: f64) -> bool {
    let extent = triangle.iter().map(|p| (p - from).amax()).fold(radius, f64::max) + (to - from).amax();
    let at = |f: f64| exact::clearance(triangle, &exact::on_path(from, &[to - from], f), radius);
    let (here, before) = (at(f), at(f * (1.0 - f64::exp2(-20.0))));
    here <= contact_doubt(extent) && here >= -contact_bound(extent) && before > here
}

#[test]
fn h05_balls_against_triangles() {
    const CASES: u32 = 200_000;
    let mut random = Random::new(7);
    let (mut tally, mut hits) = (Tally::default(), 0);
    for _ in 0..CASES {
        let triangle = random.triangle(1.0);
        let radius = random.octave(-10, 1);
        let from = random.point(3.0);
        let target = random.in_triangle(&triangle) + random.vector(1.2 * radius);
        let to = from + (target - from) * random.within(0.5, 2.0);
        let cast = Cast {
            ours: ours(&triangle, &from, &to, radius),
            theirs: oracle::ball(&triangle, &from, &to, radius),
            radius,
            length: (to - from).norm(),
            extent: 4.0 + radius + (to - from).amax(),
            distance: &|f| oracle::distance(&triangle, &(from + (to - from) * f)),
            rational: &|f| first_at(&triangle, &from, &to, radius, f),
        };
        hits += u32::from(cast.ours.is_some());
        cast.compare(&mut tally);
    }
    println!("{hits} balls hit");
    tally.finish("balls against triangles", CASES);
}

#[test]
fn h05_balls_against_a_mesh() {
    const CASES: u32 = 30_000;
    let (vertices, faces) = obj::read(BUNNY);
    let parry = oracle::Mesh::new(&vertices, &faces);
    let mesh = Mesh::new(vertices, faces).unwrap();
    let (centre, size) = (mesh.bounds().centre(), mesh.bounds().extent().amax());
    let mut random = Random::new(8);
    let (mut tally, mut hits) = (Tally::default(), 0);
    for _ in 0..CASES {
        let radius = size * random.octave(-12, -3);
        let from = centre + random.vector(size);
        let to = from + (centre + random.vector(0.6 * size) - from) * random.within(0.5, 2.0);
        let path = Path::line(from, to - from);
        let ball = MovingBall { path: &path, radius, holds: &[] };
        let found = mesh.first_contact(&ball, 1.0, |_| 0.0, &mut Work::default());
        let triangle = mesh.triangle(found.map_or(0, |found| found.face));
        let cast = Cast {
            ours: found.map(|found| found.f),
            theirs: parry.ball(&from, &to, radius),
            radius,
            length: (to - from).norm(),
            extent: centre.coords.amax() + 3.0 * size,
            distance: &|f| parry.distance(&(from + (to - from) * f)),
            rational: &|f| first_at(&triangle, &from, &to, radius, f),
        };
        hits += u32::from(found.is_some());
        cast.compare(&mut tally);
    }
    println!("{hits} balls hit the mesh");
    tally.finish("balls against a mesh", CASES);
}

/// The vertices of a triangle and its unit normal.
fn triangle_and_normal(random: &mut Random) -> ([Point3<f64>; 3], Vector3<f64>) {
    let triangle = random.triangle(1.0);
    let [a, b, c] = triangle;
    (triangle, (b - a).cross(&(c - a)).normalize())
}

#[test]
fn h03_near_starts_are_ours_to_rounding_and_parrys_to_what_is_printed() {
    let mut random = Random::new(9);
    for k in 1..12 {
        let gap = 10f64.powi(-k);
        let (mut worst, mut missed) = (0.0f64, 0);
        for _ in 0..200 {
            let (triangle, n) = triangle_and_normal(&mut random);
            let radius = random.octave(-4, 1);
            let from = random.in_triangle(&triangle) + n * (radius + gap);
            let to = from - n * (2.0 * gap) + random.vector(0.05 * gap);
            let case = || format!("{triangle:?} {from} {to} r = {radius}");
            let f = ours(&triangle, &from, &to, radius).unwrap_or_else(|| panic!("missed: {}", case()));
            assert!(first_at(&triangle, &from, &to, radius, f), "at {f}: {}", case());
            match oracle::ball(&triangle, &from, &to, radius) {
                Some(theirs) => worst = worst.max((theirs - f).abs()),
                None => missed += 1,
            }
        }
        println!(
            "a start {gap:.0e} m away: parry is off by {worst:.1e} of a way of twice that, and misses {missed} of 200"
        );
    }
}

#[test]
fn h03_grazes_of_edges_are_ours_to_rounding_and_parrys_to_what_is_printed() {
    let mut random = Random::new(10);
    for k in 1..13 {
        let depth = 10f64.powi(-k);
        let (mut worst, mut missed) = (0.0f64, 0);
        for _ in 0..200 {
            let (triangle, n) = triangle_and_normal(&mut random);
            let [a, b, c] = triangle;
            let radius = 2.0 * depth + random.octave(-4, 1);
            // Past the edge b c at right angles to the face, nearer by `depth` than a touch.
            let out = (c - b).cross(&n).normalize();
            let out = if out.dot(&(a - b)) > 0.0 { -out } else { out };
            let beside = b + (c - b) * random.within(0.2, 0.8) + out * (radius - depth);
            let (from, to) = (beside - n * 3.0, beside + n * 3.0);
            let case = || format!("{triangle:?} {from} {to} r = {radius}");
            let f = ours(&triangle, &from, &to, radius).unwrap_or_else(|| panic!("missed: {}", case()));
            assert!(first_at(&triangle, &from, &to, radius, f), "at {f}: {}", case());
            match oracle::ball(&triangle, &from, &to, radius) {
                Some(theirs) => worst = worst.max((theirs - f).abs() * 6.0),
                None => missed += 1,
            }
        }
        println!("a graze {depth:.0e} m deep: parry is off by {worst:.1e} m, and misses {missed} of 200");
    }
}
