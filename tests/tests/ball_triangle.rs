//! A ball on a line or a parabola against a triangle: 1176 cases whose first contact is known exactly.

use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::path::Path;
use carom_geometry::rounding::{UNIT_ROUNDOFF, contact_bound, contact_doubt, point_radius};
use carom_geometry::triangle::closest_point;
use carom_tests::data::{csv, feature_name, number};
use carom_tests::exact;
use carom_tests::random::Random;
use nalgebra::{Point3, Vector3};
use std::collections::BTreeMap;

const HEADER: &str = "id,category,cx,cy,cz,vx,vy,vz,gx,gy,gz,r,ax,ay,az,bx,by,bz,ex,ey,ez,tmax,start,hit,t_lo,t_hi,t_decimal,\
                      feature,multiplicity,n_boundary_roots";

/// How far from touching a reported contact may be, in contact bounds.
fn most_doubt() -> f64 {
    contact_doubt(1.0) / contact_bound(1.0)
}

/// Support planes that the slowest case, a graze, may take.
const MOST_ROUNDS: u64 = 64;

/// A row of the table.
struct Case {
    name: String,
    category: String,
    start: Point3<f64>,
    velocity: Vector3<f64>,
    acceleration: Vector3<f64>,
    radius: f64,
    triangle: [Point3<f64>; 3],
    duration: f64,
    starts: String,
    /// The exact first contact as neighbouring f64, none if there is none.
    contact: Option<(f64, f64)>,
    feature: String,
}

/// What the crate says about a case.
struct Answer {
    contact: Contact,
    rounds: u64,
    /// The radius it was asked with: that of the case, or what stands for a point.
    radius: f64,
    terms: [Vector3<f64>; 2],
}

impl Case {
    fn all() -> Vec<Self> {
        let rows = csv("geometry-cases/ball_vs_triangle_exact.csv", HEADER);
        assert_eq!(rows.len(), 1176);
        rows.iter().map(|row| Self::of(row)).collect()
    }

    fn of(row: &[String]) -> Self {
        let n = |i: usize| number(&row[i]);
        let v = |i: usize| Vector3::new(n(i), n(i + 1), n(i + 2));
        let p = |i: usize| Point3::from(v(i));
        Self {
            name: format!("case {} ({})", row[0], row[1]),
            category: row[1].clone(),
            start: p(2),
            velocity: v(5),
            acceleration: v(8),
            radius: n(11),
            triangle: [p(12), p(15), p(18)],
            duration: n(21),
            starts: row[22].clone(),
            contact: (row[23] == "1").then(|| (n(24), n(25))),
            feature: row[27].clone(),
        }
    }

    /// The first contact with f in units of `unit` seconds.
    fn ask(&self, unit: f64) -> Answer {
        let terms = [self.velocity * unit, self.acceleration * (0.5 * unit * unit)];
        let path = Path::parabola(self.start, terms[0], terms[1]);
        let farthest = self.triangle.iter().map(|q| q.coords.amax()).fold(self.start.coords.amax(), f64::max);
        let radius = if self.radius == 0.0 { point_radius(farthest) } else { self.radius };
        let ball = MovingBall { path: &path, radius, holds: &[] };
        let mut rounds = 0;
        let contact = first_contact(&ball, &self.triangle, 0.0, self.duration / unit, &mut rounds);
        Answer { contact, rounds, radius, terms }
    }

    /// How far the ball is from touching at f, in contact bounds.
    fn doubt(&self, answer: &Answer, f: f64) -> f64 {
        let gap = exact::clearance(&self.triangle, &exact::on_path(&self.start, &answer.terms, f), answer.radius);
        gap / self.bound(answer, f)
    }

    fn bound(&self, answer: &Answer, f: f64) -> f64 {
        let size = self.triangle.iter().map(|q| (q - self.start).amax()).fold(answer.radius, f64::max);
        contact_bound(size + Path::parabola(self.start, answer.terms[0], answer.terms[1]).reach(f))
    }

    /// The speed at which the ball closes in at t, as a part of its speed.
    fn closing(&self, t: f64) -> (f64, f64) {
        let x = self.start + (self.velocity + self.acceleration * (0.5 * t)) * t;
        let v = self.velocity + self.acceleration * t;
        let n = closest_point(&self.triangle, &x).offset.normalize();
        (-n.dot(&v), -n.dot(&v) / v.norm())
    }
}

#[test]
fn r28_contacts_are_never_missed_and_never_late() {
    let (mut hits, mut features, mut worst_overlap, mut worst_late, mut most_rounds) = (0, 0, 0.0f64, 0.0f64, 0);
    for case in Case::all() {
        let Some((_, high)) = case.contact.filter(|_| case.starts == "outside") else { continue };
        // As it stands, without a rounding, and with f in [0, 1] as the loop asks.
        for unit in [1.0, case.duration] {
            let answer = case.ask(unit);
            most_rounds = most_rounds.max(answer.rounds);
            let Contact::At { f, feature } = answer.contact else { panic!("{} is missed", case.name) };
            hits += 1;
            let overlap = -case.doubt(&answer, f);
            // Three roundings make the path that is asked for in f.
            let high = if unit == 1.0 { high } else { high / unit * (1.0 + 4.0 * UNIT_ROUNDOFF) };
            if case.radius == 0.0 {
                assert!(f <= high, "{}: f = {f:e} is late, above {high:e}", case.name);
            } else {
                assert!(overlap <= 1.0, "{}: overlaps by {overlap} bounds at f = {f:e}", case.name);
                worst_overlap = worst_overlap.max(overlap);
                worst_late = worst_late.max((f - high) * case.closing(f * unit).0 * unit / case.bound(&answer, f));
            }
            features += usize::from(case.radius == 0.0 || feature_name(feature) == case.feature);
        }
    }
    println!(
        "{hits} contacts, none missed, at most {most_rounds} rounds; an overlap of {worst_overlap} bounds at worst \
         (f late by {worst_late}); {features} features as named"
    );
    assert_eq!(hits, 2 * 973);
    assert!(most_rounds <= MOST_ROUNDS, "{most_rounds} rounds");
    assert_eq!(features, hits);
}

#[test]
fn r27_contacts_are_early_by_doubt_only() {
    let (mut worst_doubt, mut worst_early, mut transversal, mut worst_relative) = (0.0f64, 0.0f64, 0, 0.0f64);
    for case in Case::all() {
        let Some((low, _)) = case.contact.filter(|_| case.starts == "outside") else { continue };
        let answer = case.ask(1.0);
        let Contact::At { f, .. } = answer.contact else { panic!("{} is missed", case.name) };
        let doubt = case.doubt(&answer, f);
        assert!(doubt <= most_doubt(), "{}: {doubt} bounds from touching at f = {f:e}", case.name);
        worst_doubt = worst_doubt.max(doubt);
        // Where the ball does not graze, so near is also so early. What stands for a point has its own radius to be early by.
        let (speed, sine) = case.closing(low);
        if sine >= 0.1 && case.radius > 0.0 {
            let early = (low - f) * speed / case.bound(&answer, f);
            assert!(early <= most_doubt(), "{}: early by {early} bounds", case.name);
            transversal += 1;
            worst_early = worst_early.max(early);
            worst_relative = worst_relative.max((low - f) / low);
        } else if sine >= 0.1 && case.feature == "face" {
            let early = (low - f) * speed;
            let allowed = answer.radius * 1.1 + most_doubt() * case.bound(&answer, f);
            assert!(early <= allowed, "{}: early by {early:e}, above {allowed:e}", case.name);
        }
    }
    println!(
        "{worst_doubt} bounds from touching at worst; {transversal} transversal contacts are early by {worst_early} bounds, \
         {worst_relative:e} of t, at worst"
    );
}

#[test]
fn h03_false_contacts_are_grazes_in_doubt() {
    let (mut misses, mut doubtful) = (0, BTreeMap::<(String, bool), u32>::new());
    for case in Case::all() {
        if case.contact.is_some() || case.starts != "outside" {
            continue;
        }
        let answer = case.ask(1.0);
        match answer.contact {
            Contact::Miss => misses += 1,
            Contact::At { f, .. } => {
                let doubt = case.doubt(&answer, f);
                assert!(doubt <= most_doubt(), "{}: {doubt} bounds from touching at f = {f:e}", case.name);
                *doubtful.entry((case.category, case.radius == 0.0)).or_default() += 1;
            }
        }
    }
    println!("{misses} misses are seen as such, in doubt by category and whether it is a point: {doubtful:?}");
}

#[test]
fn h01_h02_a_start_in_contact_is_answered_by_closing_in() {
    let (mut now, mut never, mut later) = (0, 0, 0);
    for case in Case::all() {
        if case.starts == "outside" {
            continue;
        }
        let answer = case.ask(1.0);
        let at_start = exact::clearance(&case.triangle, &exact::point(&case.start), case.radius);
        assert!(at_start <= 0.0 && (at_start == 0.0) == (case.starts == "touch"), "{}", case.name);
        let n = closest_point(&case.triangle, &case.start).offset;
        let (rate, bend) = (n.dot(&case.velocity), n.dot(&case.acceleration));
        if rate < 0.0 || rate == 0.0 && bend < 0.0 {
            assert!(matches!(answer.contact, Contact::At { f: 0.0, .. }), "{}: {:?}", case.name, answer.contact);
            now += 1;
            continue;
        }
        match answer.contact {
            Contact::Miss => {
                assert!(bend >= 0.0, "{} never comes back", case.name);
                never += 1;
            }
            Contact::At { f, .. } => {
                // It leaves, stays away, and is back.
                let back = case.doubt(&answer, f);
                assert!(
                    (-1.0..=most_doubt()).contains(&back),
                    "{}: {back} bounds from touching at f = {f:e}",
                    case.name
                );
                let free: Vec<bool> = (0..64).map(|k| case.doubt(&answer, f * f64::from(k) / 64.0) > 0.0).collect();
                assert!(free.is_sorted(), "{}: touches before f = {f:e}: {free:?}", case.name);
                later += 1;
            }
        }
    }
    println!("starts in contact: {now} close in and collide now, {later} come back, {never} never do");
    assert!(now > 0 && later > 0 && never > 0);
}

#[test]
fn r27_r28_quartic_paths_meet_triangles_on_time() {
    const CASES: u32 = 1500;
    let mut random = Random::new(4);
    let (mut hits, mut worst_overlap, mut worst_doubt) = (0, 0.0f64, 0.0f64);
    for case in 0..CASES {
        let triangle = random.triangle(1.0);
        let radius = random.octave(-8, 0);
        let start = random.point(2.0);
        // At f = 1/2 the path is at the triangle, or near it.
        let mut terms: Vec<Vector3<f64>> = (0..3 + case % 2).map(|_| random.vector(4.0)).collect();
        terms[0] = Vector3::zeros();
        let target = random.in_triangle(&triangle) + random.vector(1.5 * radius);
        terms[0] = (target - Path::from_terms(start, &terms).at(0.5)) * 2.0;
        let path = Path::from_terms(start, &terms);
        let ball = MovingBall { path: &path, radius, holds: &[] };
        let gap = |f: f64| closest_point(&triangle, &path.at(f)).offset.norm() - radius;
        if gap(0.0) <= 0.0 {
            continue;
        }
        let size = triangle.iter().map(|q| (q - start).amax()).fold(radius, f64::max);
        let contact = first_contact(&ball, &triangle, 0.0, 1.0, &mut 0);
        let free_until = match contact {
            Contact::Miss => 1.0,
            Contact::At { f, .. } => {
                let bound = contact_bound(size + path.reach(f));
                let doubt = exact::clearance(&triangle, &exact::on_path(&start, &terms, f), radius) / bound;
                assert!(
                    (-1.0..=most_doubt()).contains(&doubt),
                    "{doubt} bounds: {contact:?} {triangle:?} {path:?} {radius}"
                );
                hits += 1;
                (worst_overlap, worst_doubt) = (worst_overlap.max(-doubt), worst_doubt.max(doubt));
                f
            }
        };
        for k in 0..256 {
            let f = free_until * f64::from(k) / 256.0;
            assert!(
                gap(f) > -contact_bound(size + path.reach(f)),
                "{contact:?}, but it touches at {f}: {triangle:?} {path:?}"
            );
        }
    }
    println!(
        "{hits} contacts of cubics and quartics: an overlap of {worst_overlap} bounds, {worst_doubt} from touching at worst"
    );
    assert!(hits > CASES / 2);
}
