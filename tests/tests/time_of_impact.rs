//! Hard roots: a time of impact to 4 units of roundoff where cancellation takes half of the digits or all of them.

use carom_geometry::clearance::{Clearance, Entry};
use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::path::Path;
use carom_geometry::rounding::{UNIT_ROUNDOFF, contact_doubt};
use carom_geometry::triangle::Feature;
use carom_tests::data::{csv, number};
use carom_tests::random::Random;
use nalgebra::{Point3, Vector3};

#[test]
fn h04_roots_of_parabolas_are_good_to_4_roundoffs() {
    let rows = csv("oracles/toi_quadratic.csv", "d0,vn,an,t_first_approaching_root,vn_at_hit");
    assert_eq!(rows.len(), 22);
    let (mut worst_t, mut worst_rate, mut none) = (0.0f64, 0.0f64, 0);
    for row in &rows {
        let clearance = Clearance::new([number(&row[0]), number(&row[1]), 0.5 * number(&row[2]), 0.0, 0.0]);
        match clearance.first_entry(0.0, f64::INFINITY) {
            Entry::Never => {
                assert_eq!(row[3], "none", "{row:?}");
                none += 1;
            }
            Entry::At { f, rate } => {
                let error =
                    |got: f64, want: f64| if got == want { 0.0 } else { ((got - want) / want).abs() / UNIT_ROUNDOFF };
                let (t, v) = (error(f, number(&row[3])), error(rate, number(&row[4])));
                assert!(t <= 4.0 && v <= 4.0, "{row:?}: {f:e} off by {t} u, {rate:e} by {v} u");
                (worst_t, worst_rate) = (worst_t.max(t), worst_rate.max(v));
            }
        }
    }
    println!(
        "{} roots are off by {worst_t} u at worst, their speeds by {worst_rate} u; {none} have none",
        rows.len() - none
    );
    assert_eq!(none, 2);
}

#[test]
fn h12_powers_of_two_of_length_and_time_change_no_bit_of_a_root() {
    let mut random = Random::new(12);
    let (mut hits, mut falling) = (0, 0);
    for _ in 0..100_000 {
        let mut number = |low, high| random.octave(low, high) * [1.0, -1.0][random.below(2)];
        let (c, b, a) = (number(-20, 20), number(-20, 20), number(-20, 20));
        let (k, m) = (random.below(601) as i32 - 300, random.below(201) as i32 - 100);
        let entry = |c: f64, b: f64, a: f64| Clearance::new([c, b, a, 0.0, 0.0]).first_entry(0.0, f64::INFINITY);
        let [length, rate, bend] = [k, k - m, k - 2 * m].map(|k| 2f64.powi(k));
        match (entry(c, b, a), entry(c * length, b * rate, a * bend)) {
            (Entry::Never, Entry::Never) => {}
            (Entry::At { f, rate: at }, Entry::At { f: scaled, rate: scaled_at }) => {
                assert_eq!((f * 2f64.powi(m), at * rate), (scaled, scaled_at), "{c:e} {b:e} {a:e} by 2^{k}, 2^{m}");
                hits += 1;
                falling += u32::from(c > 0.0 && b > 0.0);
            }
            (plain, scaled) => panic!("{plain:?}, but {scaled:?}: {c:e} {b:e} {a:e} by 2^{k}, 2^{m}"),
        }
    }
    assert!(hits > 50_000 && falling > 10_000, "{hits} hits, {falling} of them after a rise");
}

#[test]
fn h03_grazes_of_vertices_and_edges_are_hits_down_to_doubt() {
    let header = "radius,distance_along,offset_b,speed,result,t_hit,n_along,n_across";
    let rows = csv("oracles/toi_grazing.csv", header);
    assert_eq!(rows.len(), 24);
    // The ball flies along x and passes the origin at y = offset: once the vertex of a triangle, once its edge along z.
    let vertex = [Point3::origin(), Point3::new(1.0, -2.0, 0.5), Point3::new(2.0, -1.0, -0.25)];
    let edge = [Point3::new(0.0, 0.0, -1.0), Point3::new(0.0, 0.0, 1.0), Point3::new(1.0, -1.0, 0.0)];
    let mut worst = 0.0f64;
    for row in &rows {
        let [radius, along, offset, speed] = [0, 1, 2, 3].map(|i| number(&row[i]));
        let path = Path::line(Point3::new(-along, offset, 0.0), Vector3::new(speed, 0.0, 0.0));
        let ball = MovingBall { path: &path, radius, holds: &[] };
        for (triangle, feature) in [(&vertex, Feature::Vertex(0)), (&edge, Feature::Edge(0))] {
            let contact = first_contact(&ball, triangle, 0.0, 10.0, &mut 0);
            let doubt = contact_doubt(along + 2.0 + path.reach(5.0));
            match (contact, row[4].as_str()) {
                (Contact::At { f, feature: found }, "hit") => {
                    let (want, slope) = (number(&row[5]), number(&row[6]) * speed);
                    // Distance from a convex body is convex along a line: what is early by t is slope t or more from touching.
                    let away = (want - f) * slope;
                    // Late by one bound at most, which is a fifth of the doubt.
                    assert!(
                        (-0.2 * doubt..=doubt).contains(&away),
                        "{row:?}: {f:e} is {away:e} from touching, above {doubt:e}"
                    );
                    assert_eq!(found, feature, "{row:?}");
                    worst = worst.max(away / doubt);
                }
                (Contact::Miss, "hit") => panic!("{row:?} is missed"),
                // A touch without a rounding to spare, and a miss by one: in doubt.
                (Contact::At { f, .. }, "tangent" | "miss") => {
                    let away = ((along - speed * f).powi(2) + offset * offset).sqrt() - radius;
                    assert!(away <= doubt, "{row:?}: {f:e} is {away:e} from touching, above {doubt:e}");
                }
                (Contact::Miss, "tangent" | "miss") => {}
                (_, other) => panic!("unknown result {other}"),
            }
        }
    }
    println!("grazing contacts are at most {worst} of the doubt from touching");
}
