//! Paths that leave an edge or a vertex, and come back when they must.

use super::*;
use carom_geometry::path::Path;
use carom_geometry::rounding::UNIT_ROUNDOFF;

const RADIUS: f64 = 0.125;

/// A ball on top of the origin that moves along these terms for a second.
fn step(terms: &[Vector3<f64>]) -> Step {
    let mut velocity = [Vector3::zeros(); 5];
    for (k, term) in terms.iter().enumerate() {
        velocity[k] = term * (k + 1) as f64;
    }
    let path = Path::from_terms(Point3::new(0.0, 0.0, RADIUS), terms);
    Step { path, velocity, seconds: 1.0, to: 1.0, exact: true }
}

/// An edge along y, and a vertex, both in the origin.
fn edge_and_vertex() -> [Bend; 2] {
    let point = Point3::origin();
    [Bend::Around { point, along: Vector3::y() }, Bend::About { point }]
}

#[test]
fn r28_what_goes_straight_up_is_free_until_it_is_back() {
    for (d, e) in [(0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.25, 0.125)] {
        // Up by v f - c f^2 - d f^3 - e f^4: back at 1, and on the way no higher than a ball's radius, or much higher.
        for scale in [0.0625, 1.0, 64.0] {
            let [v, c, d, e] = [1.0 + d + e, 1.0, d, e].map(|x| x * scale);
            let away = Vector3::z();
            for sideways in [Vector3::zeros(), Vector3::y() * 3.0] {
                let [edge, vertex] = edge_and_vertex();
                let up = step(&[away * v + sideways, away * -c, away * -d, away * -e]);
                let until = leaves_until(&up, edge, RADIUS, v);
                // Early by what rounding is of the products, over the slope of |w|^2 there; the slope is no less on the way to it.
                let most = v + c + d + e + sideways.norm();
                let (products, slope) = (most * (most + 2.0 * RADIUS), 2.0 * RADIUS * (c + 2.0 * d + 3.0 * e));
                let early = 1.0 - 2.0 * RETURN_ROUNDING * products / slope;
                assert!((early..=1.0).contains(&until), "back at {until}, not from {early} on, with {d} and {e}");
                // Along the edge it is nothing, about a vertex it leads away.
                let about = leaves_until(&up, vertex, RADIUS, v);
                let expected = if sideways == Vector3::zeros() { until } else { f64::INFINITY };
                assert_eq!(about, expected);
            }
        }
    }
}

#[test]
fn r28_what_flies_straight_through_an_edge_comes_back_to_it_however_small() {
    let [edge, vertex] = edge_and_vertex();
    for (k, (v, c)) in (0..40).flat_map(|k| [(1.0, 1.0), (1.0, 3.0), (0.3, 7.1)].map(|speeds| (k, speeds))) {
        let radius = RADIUS * 0.5f64.powi(k);
        for (bend, sideways) in [(edge, Vector3::y() * 3.0), (vertex, Vector3::zeros())] {
            let mut up = step(&[Vector3::z() * v + sideways, Vector3::z() * -c]);
            up.path = Path::from_terms(Point3::new(0.0, 0.0, radius), up.path.terms());
            let until = leaves_until(&up, bend, radius, v);
            assert!(until <= v / c, "not back at {until} with a radius of 2^-{}", k + 3);
        }
    }
}

#[test]
fn r28_no_path_is_free_longer_than_it_is_off() {
    let few = [[0.0, 0.0, 0.0], [0.5, 0.25, 0.0], [-0.25, 0.0, 0.5], [0.125, -0.5, -0.25], [-0.5, 0.25, -0.5]];
    let few = few.map(Vector3::<f64>::from);
    let (mut freed, mut cut) = (0, 0);
    for (bend, &v) in edge_and_vertex().into_iter().flat_map(|bend| few[1..].iter().map(move |v| (bend, v))) {
        for k in 0..125 {
            let [c, d, e] = [few[k % 5], few[k / 5 % 5], few[k / 25]];
            // None sets out into what it leaves.
            let v = Vector3::new(v.x, v.y, v.z.abs());
            let path = step(&[v, c, d, e]);
            let until = leaves_until(&path, bend, RADIUS, v.z);
            let off = |f: f64| {
                bend.away_from(&path.path.at(f)).is_some_and(|w| w.norm() >= RADIUS * (1.0 - 4.0 * UNIT_ROUNDOFF))
            };
            for k in 0..=64 {
                let f = until.min(1.0) * f64::from(k) / 64.0;
                assert!(off(f), "{bend:?}: at {f}, free until {until}, along {v} {c} {d} {e}");
            }
            freed += i32::from(until > 0.0);
            cut += i32::from(until > 0.0 && until < 1.0);
        }
    }
    assert!(freed > 800 && cut > 200, "{freed} of 1000 may leave, {cut} may come back");
}

#[test]
fn r28_what_takes_off_from_an_edge_is_free_though_rounding_lets_it_dip() {
    let [edge, vertex] = edge_and_vertex();
    // Across the edge at speed s, bent around it by s^2 / 2 r, but for a share; and faster and faster, which takes it off.
    let s = 0.5;
    let until = |bend, share: f64| {
        let around = s * s / (2.0 * RADIUS) * (1.0 + share);
        let path = step(&[Vector3::x() * s, Vector3::x() * 0.25 - Vector3::z() * around]);
        leaves_until(&path, bend, RADIUS, 0.0)
    };
    for bend in [edge, vertex] {
        for share in [-1e-3, -1e-9, 0.0, 1e-15, 1e-12, 1e-9] {
            assert_eq!(until(bend, share), f64::INFINITY, "{bend:?} with {share:e}");
        }
        assert_eq!(until(bend, 1e-3), 0.0, "{bend:?}: deeper than rounding");
    }
}
