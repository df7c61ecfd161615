//! Flights with air resistance that end in impacts.

use super::pack::{Pack, Target, material, plane, rest_length, scene};
use crate::oracle::{Row, Table};

const NAN: f64 = f64::NAN;
/// What an integration with error control may be off by, relative to the motion.
const RELATIVE: f64 = 1e-7;

pub(super) fn packs() -> Vec<Pack> {
    vec![linear(), wind(), quadratic()]
}

fn floor(e: f64) -> String {
    material("floor", e, "") + &plane("floor", "floor", [0.0; 3], [0.0, 0.0, 1.0])
}

fn heavy(position: [f64; 3], velocity: [f64; 3], radius: f64) -> String {
    super::pack::ball(position, velocity, radius) + "mass = 1.0\n"
}

fn linear() -> Pack {
    let table = Table::read("linear_drag_impact");
    let row = table.rows().next().unwrap_or_else(|| panic!("no row"));
    let [y0, vy0, g, k, t] = row.numbers(["y0", "vy0", "g", "k_per_s", "t_impact"]);
    let v = row.number("vy_impact");
    let text = scene(1.2 * t, [0.0, 0.0, -g])
        + &format!("\n[air]\ndrag = {{ linear = {k:?} }}\n")
        + &floor(0.5)
        + &heavy([0.0, 0.0, y0], [0.0, 0.0, vy0], 0.0);
    let hit = Target::impact(1, t).at([0.0; 3]).leaving([0.0, 0.0, -0.5 * v]);
    let targets = vec![hit.within(RELATIVE * t, RELATIVE * y0, RELATIVE * v.abs())];
    let source = "t = (W0(e^(a/b) / b) - a/b) / k, in 30 digits";
    Pack::new("drag-linear", "a drop in air with linear drag", source, text, targets)
}

/// Bounces of a table's group, whose columns of velocity are named.
fn bounces(group: &[Row], target: impl Fn(&Row) -> Target) -> (f64, Vec<Target>) {
    let rows = &group[..group.len().min(5)];
    let last = rows[rows.len() - 1].number("t_impact");
    (1.01 * last, rows.iter().map(target).collect())
}

fn wind() -> Pack {
    let table = Table::read("linear_drag_bounces");
    let groups = table.groups(6);
    let group = groups.iter().find(|group| group[0].number("wind_x") != 0.0).unwrap_or_else(|| panic!("no wind"));
    let [y0, vx0, g, k, wind, e] = group[0].numbers(["y0", "vx0", "g", "k_per_s", "wind_x", "e"]);
    let (duration, targets) = bounces(group, |row| {
        let [n, t, x, vy, vx] = row.numbers(["n", "t_impact", "x_impact", "vy_in", "vx_at_impact"]);
        let whole = vy.abs() + vx0.abs() + wind.abs();
        let target = Target::impact(n as u64, t).at([x, 0.0, 0.0]).leaving([vx, 0.0, -e * vy]);
        target.within(n * RELATIVE * t, n * RELATIVE * (x.abs() + t * whole), n * RELATIVE * whole)
    });
    let text = scene(duration, [0.0, 0.0, -g])
        + &format!("\n[air]\nwind = [{wind:?}, 0.0, 0.0]\ndrag = {{ linear = {k:?} }}\n")
        + &floor(e)
        + &heavy([0.0, 0.0, y0], [vx0, 0.0, 0.0], 0.0)
        + &rest_length(1e-20);
    let source = "a = -g - k (v - w), closed form in 30 digits";
    Pack::new("drag-in-wind", "bounces in wind with linear drag", source, text, targets)
}

fn quadratic() -> Pack {
    let table = Table::read("quad_drag_vertical");
    let groups = table.groups(4);
    let group = &groups[0];
    let [g, vt, h0, e] = group[0].numbers(["g", "v_terminal", "h0", "e"]);
    let r = 0.125;
    let (duration, targets) = bounces(group, |row| {
        let [n, t, v] = row.numbers(["n", "t_impact", "v_out"]);
        let target = Target::impact(n as u64, t).at([0.0, 0.0, r]).leaving([NAN, NAN, v]);
        target.within(n * RELATIVE * t, n * RELATIVE * h0, n * RELATIVE * v)
    });
    // At the terminal speed drag is g: 1/2 rho C A = m g / vt^2.
    let coefficient = 2.0 * g / (vt * vt * std::f64::consts::PI * r * r);
    let text = scene(duration, [0.0, 0.0, -g])
        + &format!("\n[air]\ndrag = {{ coefficient = {coefficient:?}, density = 1.0 }}\n")
        + &floor(e)
        + &heavy([0.0, 0.0, h0 + r], [0.0; 3], r)
        + &rest_length(1e-20);
    let source = "1 / v_(n+1)^2 = 1 / (e v_n)^2 + 1 / vt^2; times by atan and artanh, in 30 digits";
    Pack::new("drag-quadratic", "bounces with quadratic drag", source, text, targets)
}
