//! Measured drops of real balls, against the model with and without drag.

use carom_dynamics::effects::drag::Drag;
use carom_tests::oracle::{Row, Table};
use carom_tests::stage::{Stage, smooth};
use std::fmt::Write;

/// A table tennis ball: 2.7 g, 40 mm, C = 0.45 in air of 1.204 kg/m^3.
const MASS: f64 = 0.0027;
const RADIUS: f64 = 0.02;

fn air() -> Drag {
    Drag::quadratic(0.45, 1.204).unwrap()
}

/// The height in m to which a table tennis ball with restitution `e` rises after a drop from `drop` m.
fn rebound(drop: f64, e: f64, drag: Option<Drag>) -> f64 {
    let mut stage = Stage::new(2.0).down(9.81).floor(smooth(e)).rest_length(1e-6);
    stage.0.drag = drag;
    let run = stage.thing([0.0, 0.0, drop + RADIUS], [0.0; 3], RADIUS, Some(MASS)).run();
    let impacts = run.impacts();
    let (first, second) = (impacts[0].time, impacts[1].time);
    // The top of the hop: where the ball no longer rises, by halves.
    let (mut up, mut down) = (first, second);
    for _ in 0..60 {
        let middle = 0.5 * (up + down);
        let rises = run.velocity_at(middle).z > 0.0;
        if rises { up = middle } else { down = middle }
    }
    run.at(up).z - RADIUS
}

/// The root mean square of what the model is off, in mm.
fn rms(rows: &[Row], e: f64, drag: Option<Drag>) -> f64 {
    let off = |row: &Row| {
        let [drop, mean] = row.numbers(["drop_cm", "mean_rebound_cm"]);
        1e3 * rebound(0.01 * drop, e, drag) - 10.0 * mean
    };
    (rows.iter().map(off).map(|mm| mm * mm).sum::<f64>() / rows.len() as f64).sqrt()
}

/// The e that fits best, and what is left, by golden sections.
fn fit(rows: &[Row], drag: Option<Drag>) -> (f64, f64) {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut lo, mut hi) = (0.85, 1.0);
    while hi - lo > 1e-5 {
        let (a, b) = (hi - golden * (hi - lo), lo + golden * (hi - lo));
        if rms(rows, a, drag) < rms(rows, b, drag) { hi = b } else { lo = a }
    }
    (lo, rms(rows, lo, drag))
}

#[test]
fn r18_drops_of_a_table_tennis_ball_from_six_heights_have_one_restitution_with_drag_and_none_without() {
    let table = Table::read("measured_drops");
    let rows: Vec<Row> = table.rows().filter(|row| row.text("ball") == "ping-pong").collect();
    assert_eq!(rows.len(), 6);
    let ((e_air, left_air), (e_vacuum, left_vacuum)) = (fit(&rows, Some(air())), fit(&rows, None));
    assert!(left_air < 2.5 && left_vacuum > 2.5, "{left_air} mm with drag, {left_vacuum} mm without");
    let mut text = format!("with drag    e = {e_air:.4}, {left_air:.2} mm rms\n");
    writeln!(text, "in a vacuum  e = {e_vacuum:.4}, {left_vacuum:.2} mm rms").unwrap();
    for row in &rows {
        let [drop, mean] = row.numbers(["drop_cm", "mean_rebound_cm"]);
        let model = [rebound(0.01 * drop, e_air, Some(air())), rebound(0.01 * drop, e_vacuum, None)];
        let [with, without] = model.map(|h| 100.0 * h);
        writeln!(text, "from {drop} cm: measured {mean} cm, with drag {with:.2} cm, in a vacuum {without:.2} cm")
            .unwrap();
    }
    insta::assert_snapshot!(text);
}
