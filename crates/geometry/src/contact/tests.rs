//! Contacts of one triangle that its support planes decide.

use super::*;
use crate::rounding::contact_doubt;

/// A large triangle in the plane z = 0.
const FLOOR: [Point3<f64>; 3] = [Point3::new(-9.0, -9.0, 0.0), Point3::new(9.0, -9.0, 0.0), Point3::new(0.0, 9.0, 0.0)];

fn contact(path: &Path, holds: &[Hold], triangle: &[Point3<f64>; 3], from: f64, to: f64) -> Option<f64> {
    let mut rounds = 0;
    let found = first_contact(&MovingBall { path, radius: 1.0, holds }, triangle, from, to, &mut rounds);
    assert!(rounds > 0 || from > to || holds.iter().any(|hold| hold.until > to), "a plane was looked at");
    match found {
        Contact::Miss => None,
        Contact::At { f, .. } => Some(f),
    }
}

/// Up from the floor, at its height again at 1/2.
fn hop() -> Path {
    Path::parabola(Point3::new(0.0, 0.0, 1.0), Vector3::new(0.0, 0.0, 4.0), Vector3::new(0.0, 0.0, -8.0))
}

#[test]
fn a_contact_counts_up_to_the_end_asked_for_and_from_the_start() {
    let near = |f: Option<f64>| f.is_some_and(|f| f <= 0.5 && 0.5 - f <= contact_doubt(10.0));
    assert!(near(contact(&hop(), &[], &FLOOR, 0.0, 1.0)) && near(contact(&hop(), &[], &FLOOR, 0.0, 0.5)));
    assert_eq!(contact(&hop(), &[], &FLOOR, 0.0, 0.25), None);
    assert_eq!(contact(&hop(), &[], &FLOOR, 0.625, 0.625), Some(0.625), "in it and falling: now");
    assert_eq!(contact(&hop(), &[], &FLOOR, 0.625, 0.5), None);
}

#[test]
fn what_a_hold_hides_is_not_met_before_the_path_is_back() {
    let hold = |until| Hold { normal: Vector3::z(), point: Point3::new(2.0, 1.0, 0.0), slack: 0.0, until, face: None };
    // Believed to the letter, even when it promises too much.
    assert_eq!(contact(&hop(), &[hold(0.625)], &FLOOR, 0.0, 1.0), Some(0.625));
    assert_eq!(contact(&hop(), &[hold(f64::INFINITY)], &FLOOR, 0.0, 1.0), None);
    assert_eq!(contact(&hop(), &[hold(0.25)], &FLOOR, 0.625, 1.0), Some(0.625), "a hold that is over says nothing");
    // A triangle that stands out of the plane by more than its slack is not hidden.
    let mut tilted = FLOOR;
    tilted[0].z = 0.125;
    let f = contact(&hop(), &[hold(0.625)], &tilted, 0.0, 1.0).unwrap();
    assert!(f < 0.5, "{f}");
    let slack = Hold { slack: 0.25, ..hold(0.625) };
    assert_eq!(contact(&hop(), &[slack], &tilted, 0.0, 1.0), Some(0.625));
}

#[test]
fn a_centre_on_the_triangle_leaves_it_whichever_way_it_goes() {
    let on = Point3::new(0.5, 0.25, 0.0);
    let point = [on; 3];
    for v in [Vector3::z(), -Vector3::z(), Vector3::x(), -Vector3::x(), Vector3::zeros()] {
        for triangle in [FLOOR, [FLOOR[0], FLOOR[2], FLOOR[1]], point] {
            assert_eq!(contact(&Path::line(on, v), &[], &triangle, 0.0, 1.0), None, "along {v:?}");
        }
    }
    // Out of it and back: the plane across the triangle is met again.
    let back = Path::parabola(on, Vector3::new(1.0, 0.0, 8.0), Vector3::new(0.0, 0.0, -8.0));
    let f = contact(&back, &[], &FLOOR, 0.0, 1.0).unwrap();
    let want = 0.5 + 0.125f64.sqrt();
    assert!(f <= want && want - f <= contact_doubt(20.0), "{f} for {want}");
}

/// Contacts on the way down past the floor's border, with the feature and the height of the centre by which it is nearest.
fn past_the_border() -> [(Path, Feature, f64); 3] {
    let onto = |x: f64, y: f64| Path::line(Point3::new(x, y, 3.0), Vector3::new(0.0, 0.0, -4.0));
    let thrown =
        Path::parabola(Point3::new(-1.0, -9.75, 1.25), Vector3::new(2.0, 0.0, 5.0), Vector3::new(0.0, 0.0, -8.0));
    let height = 0.4375f64.sqrt();
    [
        (onto(1.0, -9.75), Feature::Edge(0), height),
        (onto(0.0, 9.75), Feature::Vertex(2), height),
        (thrown, Feature::Edge(0), height),
    ]
}

#[test]
fn an_edge_and_a_vertex_are_met_at_a_look() {
    for (path, feature, height) in past_the_border() {
        let mut rounds = 0;
        let ball = MovingBall { path: &path, radius: 1.0, holds: &[] };
        let Contact::At { f, feature: found } = first_contact(&ball, &FLOOR, 0.0, 1.0, &mut rounds) else {
            panic!("{feature:?} is missed")
        };
        assert_eq!(found, feature);
        assert!((path.at(f).z - height).abs() <= contact_doubt(10.0), "{feature:?} at {f}");
        // The plane of the face, and the one that is seen from where it touches.
        assert!(rounds <= 3, "{rounds} rounds for {feature:?}");
    }
}

#[test]
fn what_is_found_has_the_same_bits_wherever_the_search_ends() {
    for (path, feature, _) in past_the_border() {
        let f = contact(&path, &[], &FLOOR, 0.0, 1.0).unwrap();
        for to in [f, f.next_up(), 0.5 * (1.0 + f)] {
            assert_eq!(contact(&path, &[], &FLOOR, 0.0, to), Some(f), "{feature:?} to {to}");
        }
        // Too late by rounding only: as near as can be told, that is where it touches.
        assert_eq!(contact(&path, &[], &FLOOR, 0.0, f.next_down()), Some(f.next_down()), "{feature:?}");
        assert_eq!(contact(&path, &[], &FLOOR, 0.0, 0.75 * f), None, "{feature:?}");
    }
}

#[test]
fn a_ball_that_passes_the_border_and_comes_back_lands_on_the_face() {
    // Up beside the floor, from below it, and over its edge: the plane of the face is met outside first, from below.
    let path =
        Path::parabola(Point3::new(0.0, -14.0, -4.0), Vector3::new(0.0, 14.0, 24.0), Vector3::new(0.0, 0.0, -16.0));
    let mut rounds = 0;
    let ball = MovingBall { path: &path, radius: 1.0, holds: &[] };
    let found = first_contact(&ball, &FLOOR, 0.0, 2.0, &mut rounds);
    let Contact::At { f, feature: Feature::Face } = found else { panic!("{found:?}") };
    // -4 + 24 f - 16 f^2 = 1, falling.
    let want = 1.25;
    assert!((f - want).abs() <= contact_doubt(60.0), "{f} for {want}");
    assert!(rounds <= 5, "{rounds} rounds");
}

#[test]
fn a_triangle_far_off_is_no_contact() {
    // It comes down to the plane of the triangle well beside it, from where no feature's own plane tells anything new.
    let triangle = [Point3::new(8.0, 11.0, 0.0), Point3::new(9.0, 12.0, 0.0), Point3::new(8.0, 12.0, 0.0)];
    let path =
        Path::parabola(Point3::new(11.0, 10.0, 0.25), Vector3::new(-5.0, 4.0, 0.0), Vector3::new(0.0, 0.0, -4.0));
    let ball = MovingBall { path: &path, radius: 0.1, holds: &[] };
    let mut rounds = 0;
    assert_eq!(first_contact(&ball, &triangle, 0.0, 1.0, &mut rounds), Contact::Miss);
    assert!(rounds <= 8, "{rounds} rounds");
}
