//! The tool measures what is known: closed forms, orders, the laws of Euler's method; and says so where there is nothing to measure.

use super::*;
use crate::body::Ball;
use crate::effects::{
    drag::Drag, friction::Friction, gravity::Gravity, grip::Grip, magnus::Magnus, restitution::Restitution,
    spin_decay::SpinDecay,
};
use crate::scene::{Method, Scene};
use crate::surface::{Material, Shape, Surface};
use carom_geometry::plane::Plane;
use nalgebra::{Point3, Vector3};

const COUNTED: Effort =
    Effort { balls: 1, octaves: 6, decades: 10, repeats: 0, variants: &Variant::ALL, resolutions: true };

fn scene(height: f64, velocity: Vector3<f64>, duration: f64) -> Scene {
    let material = Material { restitution: Restitution::new(0.75).unwrap(), friction: Friction::None };
    let floor = Plane::from_point_normal(Point3::origin(), Vector3::z()).unwrap();
    Scene {
        gravity: Some(Gravity::uniform(Vector3::new(0.0, 0.0, -9.81)).unwrap()),
        surfaces: vec![Surface { name: "floor".into(), material, shape: Shape::Plane(floor) }],
        balls: vec![Ball::new(Point3::new(0.0, 0.0, height), velocity, 0.0, Some(0.058)).unwrap()],
        ..Scene::lasting(duration)
    }
}

fn drop() -> Scene {
    scene(1.0, Vector3::zeros(), 1.5)
}

fn throw() -> Scene {
    let drag = Some(Drag::linear(0.05).unwrap());
    Scene { drag, ..scene(2.0, Vector3::new(9.0, 0.0, 3.0), 1.5) }
}

fn sweep(report: &Report, variant: Variant) -> &Sweep {
    report.sweeps.iter().find(|sweep| sweep.variant == variant).unwrap()
}

fn counted(scene: &Scene) -> Report {
    measure(scene, &COUNTED, &mut || 0.0).unwrap()
}

#[test]
fn r26_euler_obeys_its_laws_to_the_letter() {
    let report = counted(&drop());
    for variant in [Variant::Slides, Variant::Euler] {
        for m in &sweep(&report, variant).measurements {
            let laws = m.laws.unwrap();
            assert!((laws.height - 1.0).abs() < 1e-11, "{}: {laws:?}", m.value);
            assert!((laws.energy - 1.0).abs() < 1e-9, "{}: {laws:?}", m.value);
            // h/2 up to the position of the floor within the step.
            assert!((laws.late.unwrap() - 1.0).abs() < m.value, "{}: {laws:?}", m.value);
        }
    }
}

#[test]
fn r26_orders_are_those_of_the_textbook() {
    let report = counted(&throw());
    assert_eq!(report.reference, ReferenceKind::Extended);
    for variant in [Variant::Euler, Variant::SemiImplicitEuler, Variant::Rk4, Variant::DormandPrince, Variant::Adaptive]
    {
        let order = sweep(&report, variant).flight_order.value().unwrap_or(f64::NAN);
        let right = f64::from(variant.textbook_orders().unwrap()[0]);
        assert!((order - right).abs() < 0.1, "{variant:?}: {order}");
    }
    // What a linear f costs: two orders of four, even where the flights have no error at all.
    let linear = sweep(&counted(&drop()), Variant::Rk4LinearF).order.value().unwrap_or(f64::NAN);
    assert!((1.5..2.5).contains(&linear), "{linear}");
    assert!(report.remarks.contains(&Remark::NoExactFlight));
}

#[test]
fn r26_a_ball_that_spins_and_is_gripped_is_held_against_the_solver_of_128_bits() {
    let grip = Grip::new(0.4).unwrap().with_tangential(0.25).unwrap();
    let mut spun = throw();
    spun.magnus = Some(Magnus::new(0.5, 1.25).unwrap());
    spun.spin_decay = Some(SpinDecay::new(2.0).unwrap());
    spun.surfaces[0].material.friction = Friction::Grip(grip);
    let ball = Ball::new(Point3::new(0.0, 0.0, 1.0), Vector3::new(9.0, 1.0, -2.0), 0.03125, Some(0.058)).unwrap();
    spun.balls = vec![ball.spinning(Vector3::new(20.0, 300.0, 5.0)).unwrap()];
    let report = counted(&spun);
    assert_eq!(report.reference, ReferenceKind::Extended);
    assert!(report.impacts >= 2, "{}", report.impacts);
    let finest = sweep(&report, Variant::Adaptive).measurements.last().unwrap();
    assert!(finest.errors.position < 1e-12 && finest.errors.missed == 0, "{:e}", finest.errors.position);
    let order = sweep(&report, Variant::Rk4).flight_order.value().unwrap_or(f64::NAN);
    assert!((order - 4.0).abs() < 0.1, "{order}");
}

#[test]
fn r26_a_smooth_sphere_dropped_from_rest_is_held_against_the_solver_of_128_bits() {
    let sphere = Some(Drag::sphere(1.2, 1.8e-5).unwrap());
    let balls = vec![Ball::new(Point3::new(0.0, 0.0, 1.0), Vector3::zeros(), 0.02, Some(0.0027)).unwrap()];
    let report = counted(&Scene { drag: sphere, balls, ..throw() });
    assert_eq!(report.reference, ReferenceKind::Extended);
    let finest = sweep(&report, Variant::Adaptive).measurements.last().unwrap();
    assert!(finest.errors.position < 1e-13 && finest.errors.missed == 0, "{:e}", finest.errors.position);
}

#[test]
fn the_exact_flight_sits_at_roundoff_and_at_one_cost() {
    let report = counted(&drop());
    assert_eq!(report.reference, ReferenceKind::ClosedForm);
    let exact = &sweep(&report, Variant::Exact).measurements;
    assert_eq!(exact.len(), 1);
    assert!(exact[0].errors.position < 1e-15, "{:e}", exact[0].errors.position);
    assert_eq!((exact[0].errors.missed, exact[0].errors.invented), (0, 0));
    assert_eq!(exact[0].shares.integration, 0.0);
    let (method, _) = choose(&drop(), 1e-9).unwrap().unwrap();
    assert_eq!(method, Method::Exact);
}

#[test]
fn twice_measured_is_the_same_and_so_is_the_choice() {
    let (a, b) = (counted(&throw()), counted(&throw()));
    assert_eq!(a, b);
    for tolerance in [1e-2, 1e-6, 1e-10] {
        let best = a.cheapest(tolerance).unwrap();
        assert!(best.errors.position <= tolerance && best.method().is_some());
        assert_eq!(Some(best), b.cheapest(tolerance));
        let dearer = a.measurements().filter(|m| m.method().is_some() && m.errors.position <= tolerance);
        assert!(dearer.into_iter().all(|m| m.work >= best.work));
    }
    assert!(a.cheapest(0.0).is_none() && choose(&throw(), 1e-30).unwrap().is_none());
    let front = a.front();
    assert!(front.windows(2).all(|w| w[0].work < w[1].work && w[0].errors.position > w[1].errors.position));
}

#[test]
fn what_cannot_be_measured_gets_no_fitted_line() {
    let fitted = |report: &Report| report.sweeps.iter().any(|s| s.order.value().or(s.flight_order.value()).is_some());
    // Nothing is hit.
    let free = counted(&Scene { surfaces: Vec::new(), ..drop() });
    assert!(free.remarks.contains(&Remark::NoImpacts) && !fitted(&free));
    // One step of each length is no sweep.
    let single = Effort { octaves: 0, decades: 0, ..COUNTED };
    let single = measure(&throw(), &single, &mut || 0.0).unwrap();
    assert!(!fitted(&single) && single.sweeps.iter().all(|s| s.measurements.len() == 1));
    // A scene that is none.
    assert!(measure(&Scene { balls: Vec::new(), ..drop() }, &COUNTED, &mut || 0.0).is_err());
}

#[test]
fn the_clock_is_asked_in_turn_and_the_quickest_counts() {
    // A clock that ticks a second at each look, and stands still for the first round.
    let mut looks = 0.0;
    let mut clock = || {
        looks += 1.0;
        looks
    };
    let effort = Effort { octaves: 1, decades: 1, repeats: 2, ..COUNTED };
    let report = measure(&drop(), &effort, &mut clock).unwrap();
    assert!(report.measurements().all(|m| m.cost.is_some_and(|c| (c.per_second - 1e9 / 1.5).abs() < 1.0)));
    assert_eq!(looks, 2.0 * 2.0 * report.measurements().count() as f64);
}
