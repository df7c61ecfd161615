//! Billiards: a box, gravity wedges and thin wedges, each to its own conditioning.

use carom_dynamics::body::State;
use carom_dynamics::events::{Ending, Event, EventKind};
use carom_dynamics::observer::{Observer, Segment};
use carom_dynamics::simulate::simulate;
use carom_dynamics::tolerance::EVENT_BUDGET;
use carom_tests::oracle::{Row, Table, U, Worst};
use carom_tests::stage::{Run, Stage, smooth};
use nalgebra::{Point3, Vector3};

/// A ball is ended by a guard before it has had as many impacts as some rows tell of.
const FEASIBLE: f64 = EVENT_BUDGET as f64;

/// The state at some times, and the impacts at each of two surfaces, or all, until then; nothing else is kept of a run of millions.
struct Samples {
    times: Vec<f64>,
    hits: Vec<u64>,
    taken: Vec<(State, Vec<u64>)>,
}

impl Samples {
    /// At `times`, in order, on a stage whose only ball runs to the last of them.
    fn of(stage: &Stage, times: Vec<f64>) -> Vec<(State, Vec<u64>)> {
        let plan = stage.plan();
        let mut samples = Self { times, hits: vec![0; stage.0.surfaces.len()], taken: Vec::new() };
        let outcome = simulate(&plan, &plan.balls()[0], &mut samples);
        assert_eq!(outcome.ending, Ending::Completed);
        while samples.taken.len() < samples.times.len() {
            samples.taken.push((outcome.state, samples.hits.clone()));
        }
        samples.taken
    }
}

impl Observer for Samples {
    fn event(&mut self, event: &Event) {
        self.hits[event.surface] += u64::from(event.kind == EventKind::Impact);
    }

    fn segment(&mut self, segment: &Segment) {
        // An impact at the very end of a stretch is told after it; no row of the tables is at one.
        while let Some(&time) = self.times.get(self.taken.len()).filter(|time| **time < segment.end) {
            self.taken.push((segment.at(time), self.hits.clone()));
        }
    }
}

fn times(rows: &[&Row]) -> Vec<f64> {
    rows.iter().map(|row| row.number("t")).collect()
}

#[test]
fn r12_a_ball_in_a_box_of_six_planes() {
    let table = Table::read("box_billiard");
    let mut places = Worst::of("place in the box");
    let mut skipped = 0;
    for group in table.groups(10) {
        let [lx, ly, lz, r] = group[0].numbers(["Lx", "Ly", "Lz", "r"]);
        let start = Point3::from(group[0].numbers(["x0", "y0", "z0"]));
        let v0 = Vector3::from(group[0].numbers(["vx0", "vy0", "vz0"]));
        let feasible: Vec<_> = group.iter().filter(|row| row.number("hits") <= FEASIBLE).collect();
        skipped += group.len() - feasible.len();
        let last = feasible.last().unwrap().number("t");
        let stage = Stage::new(last).room(smooth(1.0), [lx, ly, lz]).ball(start, v0, r);
        for (row, (state, seen)) in feasible.iter().zip(Samples::of(&stage, times(&feasible))) {
            let [t, hits] = row.numbers(["t", "hits"]);
            assert_eq!(seen.iter().sum::<u64>() as f64, hits, "hits until {t}");
            // Elastic walls along the axes keep every speed to the bit.
            assert_eq!(state.velocity, Vector3::from(row.numbers(["vx", "vy", "vz"])), "velocity at {t}");
            // Each hit rounds the place and the time once: an ulp of the box and of its crossing.
            let x = state.position;
            for (axis, right) in row.numbers(["x", "y", "z"]).into_iter().enumerate() {
                let bound = 2.0 * U * (hits + 1.0) * lx.max(ly).max(lz) + 2.0 * U * t * v0[axis].abs();
                places.see(x[axis], right, bound, || format!("axis {axis}, t = {t}, {hits} hits"));
            }
        }
    }
    places.settle();
    assert_eq!(skipped, 2, "rows beyond {FEASIBLE} hits");
}

/// A wedge x = +-tan(half angle) y with its apex at the origin, gravity along -y.
fn gravity_wedge(duration: f64, g: f64, half_angle: f64, start: [f64; 4]) -> Stage {
    let (sin, cos) = half_angle.to_radians().sin_cos();
    let [x, y, vx, vy] = start;
    Stage::new(duration)
        .gravity([0.0, -g, 0.0])
        .plane("R", smooth(1.0), [0.0; 3], [-cos, sin, 0.0])
        .plane("L", smooth(1.0), [0.0; 3], [cos, sin, 0.0])
        .ball([x, y, 0.0], [vx, vy, 0.0], 0.0)
}

#[test]
fn r12_a_right_angled_wedge_is_two_bouncers() {
    let table = Table::read("wedge45_exact");
    let (mut places, mut speeds) = (Worst::of("place in the wedge"), Worst::of("velocity in the wedge"));
    let mut skipped = 0;
    for group in table.groups(5) {
        let [g, x0, y0, vx0, vy0] = group[0].numbers(["g", "x0", "y0", "vx0", "vy0"]);
        let hits = |row: &carom_tests::oracle::Row| row.number("hits_left_wall") + row.number("hits_right_wall");
        let feasible: Vec<_> = group.iter().filter(|row| hits(row) <= FEASIBLE).collect();
        skipped += group.len() - feasible.len();
        let last = feasible.last().unwrap().number("t");
        let stage = gravity_wedge(last, g, 45.0, [x0, y0, vx0, vy0]);
        let speed = (vx0 * vx0 + vy0 * vy0 + 2.0 * g * y0).sqrt();
        for (row, (state, seen)) in feasible.iter().zip(Samples::of(&stage, times(&feasible))) {
            let t = row.number("t");
            for (wall, column) in [(0, "hits_right_wall"), (1, "hits_left_wall")] {
                assert_eq!(seen[wall] as f64, row.number(column), "{column} until {t}");
            }
            // Each hit rounds the speed of the other bouncer, and so the length of all its hops to come: half a square.
            let bound = U * (t * hits(row) / 2.0 + 16.0);
            let (x, v) = (state.position, state.velocity);
            for (axis, [place, velocity]) in [["x", "vx"], ["y", "vy"]].into_iter().enumerate() {
                let at = || format!("axis {axis}, t = {t}");
                places.see(x[axis], row.number(place), bound * speed, at);
                speeds.see(v[axis], row.number(velocity), bound * g, at);
            }
        }
    }
    Worst::settle_all([places, speeds]);
    // 10^9 s are some 2 10^9 hits.
    assert_eq!(skipped, 3, "rows beyond {FEASIBLE} hits");
}

#[test]
fn r12_gravity_wedges_as_far_as_f64_can_know() {
    let table = Table::read("wedge_billiard");
    let (mut times, mut places) = (Worst::of("time of the hit"), Worst::of("place of the hit"));
    let mut speeds = Worst::of("velocity after the hit");
    let mut unknowable = 0;
    for group in table.groups(6) {
        let [g, angle, x0, y0, vx0, vy0] = group[0].numbers(["g", "half_angle_deg", "x0", "y0", "vx0", "vy0"]);
        // Until a millionth of the motion is left to compare.
        let known: Vec<_> = group.iter().filter(|row| row.number("log10_error_growth") < 9.0).collect();
        unknowable += group.len() - known.len();
        let last = known.last().unwrap().number("t");
        let impacts = gravity_wedge(last * (1.0 + 1e-6), g, angle, [x0, y0, vx0, vy0]).run().impacts();
        let speed = (2.0 * g * y0).sqrt();
        // Of all errors made on the way, the worst amplified counts.
        let mut worst = 0.0f64;
        for row in known {
            let [hit, t, growth] = row.numbers(["hit", "t", "log10_error_growth"]);
            worst = worst.max(growth);
            let impact = &impacts[hit as usize - 1];
            assert_eq!(["R", "L"][impact.surface], row.text("wall"), "half angle {angle}, hit {hit}");
            let bound = 4.0 * U * hit * 10f64.powf(worst);
            let at = || format!("half angle {angle}, hit {hit}, growth 1e{growth:.1}");
            times.see(impact.time, t, bound * (1.0 + t), at);
            for (axis, [place, velocity]) in [["x", "vx_after"], ["y", "vy_after"]].into_iter().enumerate() {
                places.see(impact.position[axis], row.number(place), bound * y0, at);
                speeds.see(impact.velocity[axis], row.number(velocity), bound * speed, at);
            }
        }
    }
    Worst::settle_all([times, places, speeds]);
    println!("{unknowable} rows lie beyond what f64 can know");
}

#[test]
fn r26_an_error_of_the_start_grows_as_fast_as_the_tables_say() {
    let (growths, hits) = (Table::read("wedge_lyapunov"), Table::read("wedge_billiard"));
    let groups = hits.groups(6);
    let mut rows = 0;
    for row in growths.rows() {
        let [angle, growth] = row.numbers(["half_angle_deg", "log10_growth_100_hits"]);
        let group =
            groups.iter().find(|group| group[0].number("half_angle_deg") == angle).expect("a wedge of the table");
        let [g, x0, y0, vx0, vy0] = group[0].numbers(["g", "x0", "y0", "vx0", "vy0"]);
        // Two starts an error apart: as many hits as it takes for the one to be seen and not yet to be everything.
        let apart = 1e-12;
        let seen = group.iter().filter(|row| row.number("log10_error_growth") < 9.0);
        let last = seen.clone().next_back().expect("the first hits are known");
        let [n, t, right] = last.numbers(["hit", "t", "log10_error_growth"]);
        let place = |x0: f64| {
            let impacts = gravity_wedge(1.1 * t + 1.0, g, angle, [x0, y0, vx0, vy0]).run().impacts();
            impacts[n as usize - 1].position
        };
        let found = ((place(x0 + apart) - place(x0)).norm() / apart).log10();
        // The table's is of the worst direction of phase space, and of the whole state; ours of one start and of the place alone.
        assert!(
            found <= right + 1.0 && found >= right - 2.5,
            "{angle} degrees, hit {n}: 1e{found:.2}, table 1e{right:.2}"
        );
        assert!(n >= 100.0 || growth > 9.0, "{angle} degrees: 100 hits can be known");
        rows += 1;
    }
    assert_eq!(rows, 5);
}

/// The wedge between y = 0 (A) and y = x / m (B), and a point that comes in along -x.
fn thin_wedge(duration: f64, m: f64, x0: f64, y0: f64, speed: f64) -> Run {
    Stage::new(duration)
        .plane("A", smooth(1.0), [0.0; 3], [0.0, 1.0, 0.0])
        .plane("B", smooth(1.0), [0.0; 3], [1.0, -m, 0.0])
        .ball([x0, y0, 0.0], [-speed, 0.0, 0.0], 0.0)
        .run()
}

#[test]
fn r12_a_thin_wedge_is_left_after_the_exact_number_of_hits() {
    let (counts, hits) = (Table::read("thin_wedge_counts"), Table::read("thin_wedge_hits"));
    let groups = hits.groups(5);
    let (mut times, mut distances) = (Worst::of("time of the hit"), Worst::of("distance from the apex"));
    let mut speeds = Worst::of("velocity after the hit");
    let mut skipped = 0;
    for (row, group) in counts.rows().zip(groups) {
        let [m, x0, y0, speed, total, phi, last] =
            row.numbers(["M", "x0", "y0", "speed", "hits_total", "phi", "t_last_hit"]);
        if total > FEASIBLE {
            skipped += 1;
            continue;
        }
        let impacts = thin_wedge(4.0 * last, m, x0, y0, speed).impacts();
        assert_eq!(impacts.len() as f64, total, "M = {m}");
        for row in group {
            assert_eq!(row.number("M"), m);
            let [hit, t, distance, vx, vy] =
                row.numbers(["hit", "t_hit", "distance_from_apex", "vx_after", "vy_after"]);
            let impact = &impacts[hit as usize - 1];
            assert_eq!(["A", "B"][impact.surface], row.text("wall"), "M = {m}, hit {hit}");
            // Unfolded, the point moves straight past the apex at distance y0, and the hit is where it crosses the line at
            // angle hit * phi. Each hit turns the motion by a few u, and the line crosses it at that angle.
            let turned = 4.0 * U * (hit + 1.0);
            let crossing = y0 / (hit * phi).sin().powi(2);
            let at = || format!("M = {m}, hit {hit}");
            times.see(impact.time, t, turned * crossing / speed + 4.0 * U * t, at);
            distances.see(impact.position.coords.norm(), distance, turned * crossing + 4.0 * U * distance, at);
            speeds.see(impact.velocity.x, vx, turned * speed, at);
            speeds.see(impact.velocity.y, vy, turned * speed, at);
        }
    }
    Worst::settle_all([times, distances, speeds]);
    assert_eq!(skipped, 0, "wedges with more than {FEASIBLE} hits");
}

#[test]
fn h20_a_wedge_of_any_angle_is_hit_once_for_each_of_its_images_that_the_straight_line_crosses() {
    for degrees in [60.0, 7.0, 1.0, 0.1, 0.01] {
        let angle = f64::to_radians(degrees);
        let (sin, cos) = angle.sin_cos();
        let wedge = Stage::new(1e6).plane("A", smooth(1.0), [0.0; 3], [0.0, 1.0, 0.0]);
        let wedge = wedge.plane("B", smooth(1.0), [0.0; 3], [sin, -cos, 0.0]);
        let start = Point3::new((0.5 * angle).cos(), (0.5 * angle).sin(), 0.0);
        // From half of the angle to the direction of the velocity; no multiple of an angle is near one of these directions.
        for heading in [166.9257, 121.3333, 93.4567] {
            let (y, x) = f64::to_radians(heading).sin_cos();
            let run = wedge.clone().ball(start, [x, y, 0.0], 0.0).run();
            assert_eq!(run.impacts().len() as f64, (heading / degrees).floor(), "{degrees} degrees, {heading}");
            assert!(run.impacts().len() as f64 <= (180.0 / degrees).ceil());
            // No speed is won or lost, but for what each hit rounds.
            let v = run.outcome.state.velocity;
            assert!((v.norm() - 1.0).abs() <= 8.0 * U * (1.0 + run.impacts().len() as f64), "{degrees}: {v}");
        }
    }
}
