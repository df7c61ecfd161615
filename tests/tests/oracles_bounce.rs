//! Bouncing on one plane and between two, against closed forms: times, speeds, heights and places, bounce by bounce.

use carom_dynamics::effects::friction::Friction;
use carom_dynamics::events::{Event, EventKind, Motion};
use carom_tests::oracle::{Row, Table, U, Worst};
use carom_tests::stage::{Run, Stage, coulomb, rough, smooth};

/// A hop this low is below all that the tables hold.
const NO_REST: f64 = 1e-300;

/// The n-th row of a group is the n-th impact of the run.
fn pair<'a>(run: &Run, group: &[Row<'a>]) -> Vec<(Row<'a>, Event)> {
    let impacts = run.impacts();
    assert!(impacts.len() >= group.len(), "{} impacts of {}", impacts.len(), group.len());
    group.iter().copied().zip(impacts).collect()
}

#[test]
fn r17_bounces_of_a_dropped_ball() {
    let table = Table::read("bounce_plane");
    let (mut times, mut speeds) = (Worst::of("time of impact"), Worst::of("speeds in and out"));
    let (mut heights, mut tops) = (Worst::of("height of the apex"), Worst::of("time of the apex"));
    for group in table.groups(3) {
        let [g, h0, e] = group[0].numbers(["g", "h0", "e"]);
        let last = group[group.len() - 1].number("t_apex");
        let stage = Stage::new(2.0 * last).down(g).floor(smooth(e)).ball([0.0, 0.0, h0], [0.0; 3], 0.0);
        let run = stage.rest_length(NO_REST).run();
        for (row, impact) in pair(&run, &group) {
            let [n, t, v_in, v_out] = row.numbers(["n", "t_impact", "v_in", "v_out"]);
            let bound = 4.0 * n * U;
            let place = || format!("e = {e}, n = {n}");
            times.see(impact.time, t, bound * t, place);
            speeds.see(-impact.velocity_in.z, v_in, bound * v_in, place);
            speeds.see(impact.velocity.z, v_out, bound * v_out, place);
            // The top of the stored path, where its slope is 0; each hop is one path. Heights go with the square of the speed.
            let [height, t_apex] = row.numbers(["apex_height", "t_apex"]);
            let hop = run.trajectory.segments[n as usize];
            let [rise, fall] = [hop.step.path.terms()[0].z, hop.step.path.terms()[1].z];
            let top = -rise / (2.0 * fall);
            heights.see(hop.step.at(top).position.z, height, 2.0 * bound * height, place);
            tops.see(hop.time + hop.step.time(top), t_apex, bound * t_apex, place);
        }
    }
    Worst::settle_all([times, speeds, heights, tops]);
}

#[test]
fn r19_r23_bounces_with_each_law_of_friction() {
    let table = Table::read("bounce_friction");
    let (mut times, mut places) = (Worst::of("time of impact"), Worst::of("place of impact"));
    let mut speeds = Worst::of("tangential speed after it");
    for group in table.groups(6) {
        let [g, h0, vx0, e, c] = group[0].numbers(["g", "h0", "vx0", "e", "c_f_or_mu"]);
        let law = group[0].text("law");
        let friction = match law {
            "linear" => Friction::linear(c).unwrap(),
            "book_coulomb" => coulomb(c),
            "impulse_coulomb" => Friction::impulse(c).unwrap(),
            _ => panic!("{law}"),
        };
        let last = group[group.len() - 1].number("t_impact");
        let stage = Stage::new(2.0 * last).down(g).floor(rough(e, friction)).ball([0.0, 0.0, h0], [vx0, 0.0, 0.0], 0.0);
        for (row, impact) in pair(&stage.rest_length(NO_REST).run(), &group) {
            let [n, t, x, vt] = row.numbers(["n", "t_impact", "x_impact", "vt_after"]);
            let bound = 4.0 * n * U;
            let place = || format!("{law}, e = {e}, c = {c}, n = {n}");
            times.see(impact.time, t, bound * t, place);
            places.see(impact.position.x, x, bound * x, place);
            // Coulomb's laws subtract: what is left is as accurate as what there was.
            speeds.see(impact.velocity.x, vt, bound * vx0, place);
        }
    }
    Worst::settle_all([times, places, speeds]);
}

#[test]
fn r31_bouncing_ends_at_the_sum_of_all_bounces() {
    let table = Table::read("bounce_zeno");
    let (mut ends, mut last) = (Worst::of("end of bouncing"), Worst::of("the impact that ends it"));
    for row in table.rows() {
        let [g, h0, e, t_zeno] = row.numbers(["g", "h0", "e", "t_zeno"]);
        let stage = Stage::new(2.0 * t_zeno).down(g).floor(smooth(e)).ball([0.0, 0.0, h0], [0.0; 3], 0.0);
        let place = || format!("e = {e}, h0 = {h0}, v_rest = {}", row.text("v_rest"));
        // By the scene's own length, and by the book's speed.
        let [v_rest, count, t] = row.numbers(["v_rest", "n_first_out_speed_le_v_rest", "t_of_that_impact"]);
        let by_speed = stage.clone().book_rest(v_rest, 0.0, 0.0).run();
        assert_eq!(by_speed.impacts().len() as f64, count, "{}", place());
        last.see(by_speed.impacts().last().unwrap().time, t, 4.0 * count * U * t, place);
        for run in [stage.run(), by_speed] {
            assert_eq!(run.events(EventKind::Slide), []);
            assert_eq!(run.outcome.motion, Motion::Resting);
            assert_eq!(run.outcome.state.position.z, 0.0);
            ends.see(run.events(EventKind::Rest)[0].time, t_zeno, 1e-13 * t_zeno, place);
        }
    }
    Worst::settle_all([ends, last]);
}

#[test]
fn r17_bounces_between_two_walls() {
    let table = Table::read("two_walls");
    let (mut times, mut speeds) = (Worst::of("time of impact"), Worst::of("speed after it"));
    for group in table.groups(3) {
        let [gap, v0, e] = group[0].numbers(["gap_minus_2r", "v0", "e"]);
        let last = group[group.len() - 1].number("t_hit_n");
        // Radius and gap add up without rounding.
        let r = 0.125;
        let stage = Stage::new(last * (1.0 + 1e-9))
            .plane("left", smooth(e), [0.0; 3], [1.0, 0.0, 0.0])
            .plane("right", smooth(e), [gap + 2.0 * r, 0.0, 0.0], [-1.0, 0.0, 0.0])
            .ball([r, 0.0, 0.0], [v0, 0.0, 0.0], r);
        for (row, impact) in pair(&stage.run(), &group) {
            let [n, t, speed] = row.numbers(["n", "t_hit_n", "speed_after"]);
            let place = || format!("e = {e}, n = {n}");
            times.see(impact.time, t, 4.0 * n * U * t, place);
            speeds.see(impact.velocity.x.abs(), speed, 4.0 * n * U * speed, place);
        }
    }
    Worst::settle_all([times, speeds]);
}
