//! The balls that scenes call by name rebound as the rules of their sports say.

use crate::common::{Folder, shown};
use std::fmt::Write;

/// Air at 20 C, for which the restitution of the balls is fitted, and gravity.
const RHO: f64 = 1.204;
const G: f64 = 9.81;

fn balls() -> Vec<serde_json::Value> {
    let output = Folder::with(&[]).run(&["balls", "--json"]);
    serde_json::from_slice(&output.stdout).expect("the balls are JSON")
}

fn number(ball: &serde_json::Value, key: &str) -> f64 {
    ball[key].as_f64().unwrap_or_else(|| panic!("{key} of {ball}"))
}

/// The allowed rebound of the bottom of the ball.
fn allowed(ball: &serde_json::Value) -> (f64, f64) {
    let read_above = if ball["read_at"] == "top" { 2.0 * number(ball, "radius_m") } else { 0.0 };
    (number(ball, "rebound_lo_m") - read_above, number(ball, "rebound_hi_m") - read_above)
}

/// The height to which a ball of this name rises after its drop, with or without the air, by a thousand frames a second: its top is missed
/// by 2 um at most.
fn rebound(ball: &serde_json::Value, air: &str) -> f64 {
    let (name, radius) = (ball["name"].as_str().expect("a name"), number(ball, "radius_m"));
    let scene = format!(
        "version = 1\nduration = 1.6\ngravity = [0, 0, -{G}]\n{air}\n[materials.floor]\nrestitution = \"ball\"\n\
         [[surfaces]]\nname = \"floor\"\nmaterial = \"floor\"\nshape = {{ plane = {{ coefficients = [0, 0, 1, 0] }} }}\n\
         [[balls]]\nball = \"{name}\"\nposition = [0, 0, {}]\n",
        number(ball, "drop_m") + radius
    );
    let folder = Folder::with(&[("scene.toml", scene.as_bytes())]);
    let output = folder.run(&["run", "scene.toml", "--frames", "-", "--fps", "1000", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", shown(&output));
    let frames: Vec<[f64; 2]> = csv::Reader::from_reader(output.stdout.as_slice())
        .records()
        .map(|row| row.expect("a frame"))
        .map(|row| [4, 7].map(|column| row[column].parse().expect("a number")))
        .collect();
    let up = frames.iter().position(|[_, v]| *v > 0.0).expect("it rebounds");
    frames[up..].iter().take_while(|[_, v]| *v > -0.1).map(|[z, _]| z - radius).fold(0.0, f64::max)
}

#[test]
fn r18_each_ball_rebounds_within_its_rule() {
    let air = format!("[air]\ndensity = {RHO}\ndrag = \"ball\"");
    let mut text = String::from("ball: rebound with drag, and without, of the allowed range, in m\n");
    for ball in balls() {
        let (lo, hi) = allowed(&ball);
        let (with, without) = (rebound(&ball, &air), rebound(&ball, ""));
        assert!(lo <= with && with <= hi, "{}: {with} is not in {lo}..{hi}", ball["name"]);
        let name = ball["name"].as_str().expect("a name");
        writeln!(text, "{name}: {with:.4}, {without:.4}, {lo:.4} to {hi:.4}").expect("a string grows");
    }
    insta::assert_snapshot!(text);
}

/// In quadratic drag v_in^2 = vt^2 (1 - e^(-2 g H / vt^2)) and v_out^2 = vt^2 (e^(2 g h / vt^2) - 1).
#[test]
fn r18_the_restitution_of_each_ball_is_fitted_to_the_middle_of_its_rule_with_drag() {
    for ball in balls() {
        let [m, r, c, drop] = ["mass_kg", "radius_m", "drag", "drop_m"].map(|key| number(&ball, key));
        let vt2 = 2.0 * m * G / (RHO * c * std::f64::consts::PI * r * r);
        let (lo, hi) = allowed(&ball);
        let v_in = (vt2 * -(-2.0 * G * drop / vt2).exp_m1()).sqrt();
        let v_out = (vt2 * (2.0 * G * 0.5 * (lo + hi) / vt2).exp_m1()).sqrt();
        let given = number(&ball, "restitution");
        // Given in four decimals.
        assert!((given - v_out / v_in).abs() <= 0.00005001, "{}: {given}, fitted {}", ball["name"], v_out / v_in);
    }
}

#[test]
fn the_table_of_balls() {
    insta::assert_snapshot!(shown(&Folder::with(&[]).run(&["balls"])));
    for ball in balls() {
        assert!(["source", "drag_source"].iter().all(|key| ball[*key].as_str().is_some_and(|s| !s.is_empty())));
    }
}

#[test]
fn what_a_scene_gives_goes_before_what_the_name_gives() {
    let scene = "version = 1\nduration = 1\n[[balls]]\nball = \"golf\"\nmass = 2.0\nposition = [0, 0, 0]\nvelocity = [1, 0, 0]\n";
    let folder = Folder::with(&[("scene.toml", scene.as_bytes())]);
    let output = folder.run(&["run", "scene.toml", "--summary", "-", "--quiet"]);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).expect("the summary is JSON");
    // 1/2 m v^2 with the mass of the scene.
    assert_eq!(summary["energy"]["start"], 1.0);
}
