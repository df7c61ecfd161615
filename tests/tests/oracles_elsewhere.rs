//! What the library has no words for, said in its own: a wall that moves, from its own frame; a planet, as an effect of your own; a round wall, by its
//! tangents.

use carom_dynamics::body::{Body, State};
use carom_dynamics::counters::Counters;
use carom_dynamics::effects::Flow;
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Method;
use carom_tests::oracle::{Table, U, Worst};
use carom_tests::stage::{Run, Stage, smooth};
use nalgebra::{Point3, Vector3};
use std::sync::Arc;

/// A hop this low is below all that the tables hold.
const NO_REST: f64 = 1e-300;

#[test]
fn r17_bounces_on_a_plane_that_moves_are_those_of_its_frame() {
    let table = Table::read("moving_plane");
    let (mut times, mut places) = (Worst::of("time of impact"), Worst::of("place of impact"));
    let mut speeds = Worst::of("speeds in and out");
    let mut rows = 0;
    for group in table.groups(5) {
        let [g, h0, v0, wall, e] = group[0].numbers(["g", "h0", "vy0", "plane_speed_up", "e"]);
        let last = group[group.len() - 1].number("t_impact");
        let stage = Stage::new(1.01 * last).down(g).floor(smooth(e)).rest_length(NO_REST);
        let run = stage.ball([0.0, 0.0, h0], [0.0, 0.0, v0 - wall], 0.0).run();
        let impacts = run.impacts();
        for (row, impact) in group.iter().zip(&impacts) {
            let [n, t, y, v_in, v_out] = row.numbers(["n", "t_impact", "y_impact", "vy_in", "vy_out"]);
            let bound = 8.0 * n * U;
            let place = || format!("g = {g}, wall at {wall}, e = {e}, n = {n}");
            times.see(impact.time, t, bound * t, place);
            places.see(impact.position.z + wall * impact.time, y, bound * (h0 + y.abs()), place);
            speeds.see(impact.velocity_in.z + wall, v_in, bound * (v_in.abs() + wall.abs()), place);
            speeds.see(impact.velocity.z + wall, v_out, bound * (v_out.abs() + wall.abs()), place);
            rows += 1;
        }
    }
    assert_eq!(rows, table.rows().count());
    Worst::settle_all([times, places, speeds]);
}

/// A point that attracts with GM / distance^2.
#[derive(Debug)]
struct Planet {
    gm: f64,
    centre: Point3<f64>,
}

impl Flow for Planet {
    fn name(&self) -> &'static str {
        "a planet"
    }

    fn acceleration(&self, state: &State, _: &Body) -> Vector3<f64> {
        let from = state.position - self.centre;
        from * (-self.gm / (from.norm_squared() * from.norm()))
    }

    fn calms_to(&self) -> Option<Vector3<f64>> {
        None
    }

    fn count(&self, _: &mut Counters) {}
}

#[test]
fn r05_bounces_on_a_planet_whose_pull_changes_with_height() {
    let table = Table::read("point_attractor_radial");
    let (mut times, mut speeds) = (Worst::of("time of impact"), Worst::of("speed at impact"));
    let mut rows = 0;
    for group in table.groups(4) {
        let [gm, radius, h0, e] = group[0].numbers(["GM", "R", "h0", "e"]);
        let last = group[group.len() - 1].number("t_impact");
        let planet = Arc::new(Planet { gm, centre: Point3::new(0.0, 0.0, -radius) });
        for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
            let stage = Stage::new(1.01 * last).floor(smooth(e)).method(Method::Adaptive { tolerance });
            let stage = stage.ball([0.0, 0.0, h0], [0.0; 3], 0.0).rest_length(NO_REST);
            let plan = Plan::new(&stage.0).unwrap().with_flow(planet.clone());
            let impacts = Run::of(&plan, &plan.balls()[0]).impacts();
            for (row, impact) in group.iter().zip(&impacts) {
                let [n, t, v] = row.numbers(["n", "t_impact", "v_in"]);
                // As in drag: a flight is tens of steps, and an impact keeps what went before.
                let bound = n * (8.0 * tolerance + 64.0 * U);
                let place = || format!("R = {radius}, h0 = {h0}, n = {n}, tolerance {tolerance:e}");
                times.see(impact.time, t, bound * t, place);
                speeds.see(-impact.velocity_in.z, v, bound * v, place);
                rows += 1;
            }
        }
    }
    assert_eq!(rows, 4 * table.rows().count());
    Worst::settle_all([times, speeds]);
}

#[test]
fn r12_a_point_inside_a_circle_has_the_hits_of_its_tangents() {
    /// A tangent for each hit, and each flight asks all.
    const FEASIBLE: f64 = 1e4;
    let table = Table::read("circle_billiard");
    let (mut places, mut times) = (Worst::of("place on the circle"), Worst::of("time, as a way at 1 m/s"));
    let mut moments = Worst::of("moment of the velocity");
    let mut rows = 0;
    for group in table.groups(3) {
        let [r, theta0, alpha] = group[0].numbers(["R", "theta0", "alpha"]);
        let feasible: Vec<_> = group.iter().filter(|row| row.number("n") <= FEASIBLE).collect();
        let [most, way] = feasible[feasible.len() - 1].numbers(["n", "path_length"]);
        // Hit k is at theta0 + k (pi - 2 alpha): the half turns change the sign, and what the product loses turns by as little.
        let towards = |k: u32| {
            let whole = -2.0 * f64::from(k) * alpha;
            let lost = f64::mul_add(-2.0 * f64::from(k), alpha, -whole);
            let angle = theta0 + whole;
            let lost = lost + ((theta0 - (angle - whole)) + (whole - (angle - (angle - whole))));
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            Vector3::new(angle.cos() - lost * angle.sin(), angle.sin() + lost * angle.cos(), 0.0) * sign
        };
        // All tangents lie outside of the circle: the chords of the hits touch none but their own.
        let tangents = 1..=most as u32;
        let walls = tangents.fold(Stage::new(way + r * alpha.cos()), |stage, k| {
            stage.plane(&format!("tangent {k}"), smooth(1.0), Point3::from(towards(k) * r), -towards(k))
        });
        let start = Point3::from(towards(0) * r);
        let run = walls.ball(start, (towards(1) - towards(0)).normalize(), 0.0).run();
        let impacts = run.impacts();
        assert_eq!(impacts.len() as f64, most);
        for row in feasible {
            let [n, x, y] = row.numbers(["n", "x", "y"]);
            let impact = &impacts[n as usize - 1];
            // Each hit turns the ball by two roundings of the tangent's direction, which all that follow carry on.
            let bound = 4.0 * U * (n + 1.0) * (n + 1.0) * r;
            let place = || format!("R = {r}, alpha = {alpha}, n = {n}");
            places.see(impact.position.x, x, bound, place);
            places.see(impact.position.y, y, bound, place);
            times.see(impact.time, row.number("path_length"), bound, place);
            let moment = impact.position.coords.cross(&impact.velocity).z;
            moments.see(moment.abs(), row.number("angular_momentum_per_speed"), bound, place);
            rows += 1;
        }
    }
    assert_eq!(rows, 20, "of {} rows, those of up to {FEASIBLE} hits", table.rows().count());
    Worst::settle_all([places, times, moments]);
}
