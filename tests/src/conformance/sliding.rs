//! Sliding and rest under Coulomb friction.

use super::pack::{Pack, Target, ball, material, plane, scene};
use crate::oracle::{Table, U};

const NAN: f64 = f64::NAN;
/// The slope of the triple 3, 4, 5: sin, cos and tan are as good as exact.
const SLOPE: [f64; 3] = [0.6, 0.8, 0.75];

pub(super) fn packs() -> Vec<Pack> {
    vec![held(), let_go(), to_a_stop(), uphill(), across()]
}

fn slope(e: f64, mu: f64, [sin, cos]: [f64; 2]) -> String {
    material("slope", e, &format!("{{ coulomb = {mu:?} }}")) + &plane("slope", "slope", [0.0; 3], [sin, 0.0, cos])
}

fn held() -> Pack {
    let [sin, cos, tan] = SLOPE;
    let mu = tan * (1.0 + 2f64.powi(-40));
    let text = scene(10.0, [0.0, 0.0, -9.81]) + &slope(0.5, mu, [sin, cos]) + &ball([0.0; 3], [0.0; 3], 0.0);
    let targets = vec![Target::rest(0.0).at([0.0; 3]).within(0.0, 0.0, 0.0), Target::impacts(0)];
    let source = "|F_t| <= mu |F_n|";
    Pack::new("slope-held", "on a slope with mu = tan (1 + 2^-40): it rests", source, text, targets)
}

/// It slides 10 m, then hits a wall across the slope, so that its time and speed are seen.
fn let_go() -> Pack {
    let [sin, cos, tan] = SLOPE;
    let (g, way) = (9.81, 10.0);
    let mu = tan * (1.0 - 2f64.powi(-10));
    let a = g * (sin - mu * cos);
    let (t, v) = ((2.0 * way / a).sqrt(), (2.0 * way * a).sqrt());
    let text = scene(1.01 * t, [0.0, 0.0, -g])
        + &slope(0.5, mu, [sin, cos])
        + &material("stop", 0.0, "")
        + &plane("stop", "stop", [way * cos, 0.0, -way * sin], [-cos, 0.0, sin])
        + &ball([0.0; 3], [0.0; 3], 0.0);
    // sin - mu cos is a thousandth of either.
    let rounding = 1024.0 * 16.0 * U;
    let hit = Target::impact(1, t).at([way * cos, 0.0, -way * sin]);
    let targets = vec![hit.within(rounding * t, 64.0 * U * way, rounding * v)];
    let source = "v = g (sin - mu cos) t, seen at a wall 10 m down";
    Pack::new("slope-let-go", "on a slope with mu = tan (1 - 2^-10): it slides", source, text, targets)
}

fn to_a_stop() -> Pack {
    let (g, mu, v) = (8.0, 0.25, 4.0);
    let text = scene(10.0, [0.0, 0.0, -g])
        + &material("floor", 0.5, "{ coulomb = 0.25 }")
        + &plane("floor", "floor", [0.0; 3], [0.0, 0.0, 1.0])
        + &ball([0.0, 0.0, 0.25], [v, 0.0, 0.0], 0.25);
    let (t, x) = (v / (mu * g), v * v / (2.0 * mu * g));
    let targets = vec![Target::rest(t).at([x, 0.0, 0.25]).ulps(64.0, [t, x, v]), Target::impacts(0)];
    Pack::new(
        "sliding-to-a-stop",
        "sliding on a level floor to a stop",
        "t = v / (mu g), x = v^2 / (2 mu g)",
        text,
        targets,
    )
}

fn uphill() -> Pack {
    let table = Table::read("slope_slide_1d");
    let row = table
        .rows()
        .find(|row| row.text("dir") == "up" && row.number("return_speed_at_start_0_if_stuck") == 0.0)
        .unwrap_or_else(|| panic!("none sticks"));
    let [g, angle, mu, v] = row.numbers(["g", "slope_deg", "mu", "v0"]);
    let [t, way] = row.numbers(["t_stop_or_turn", "distance"]);
    let (sin, cos) = angle.to_radians().sin_cos();
    let text = scene(4.0 * t + 4.0, [0.0, 0.0, -g])
        + &slope(0.5, mu, [sin, cos])
        + &ball([0.0; 3], [-v * cos, 0.0, v * sin], 0.0);
    let targets = vec![Target::rest(t).at([-way * cos, 0.0, way * sin]).within(1e-11 * t, 1e-11 * way, 0.0)];
    let source = "t = v0 / (g (sin + mu cos)), in 30 digits";
    Pack::new("sliding-uphill", "sliding up a slope to a stop that holds", source, text, targets)
}

fn across() -> Pack {
    let table = Table::read("slope_slide_2d");
    let groups = table.groups(6);
    let group = groups.iter().find(|group| group[0].text("t_stop").parse::<f64>().is_ok());
    let row = group.unwrap_or_else(|| panic!("none stops"))[0];
    let [g, angle, mu, v, psi, stop] = row.numbers(["g", "slope_deg", "mu", "v0", "psi0_deg_from_downhill", "t_stop"]);
    let (sin, cos) = angle.to_radians().sin_cos();
    let (across, along) = psi.to_radians().sin_cos();
    let velocity = [v * along * cos, v * across, -v * along * sin];
    let text = scene(2.0 * stop, [0.0, 0.0, -g])
        + &slope(0.5, mu, [sin, cos])
        + &ball([0.0; 3], velocity, 0.0)
        + "\n[rest]\nlength = 1e-24\n";
    let targets = vec![Target::rest(stop).at([NAN; 3]).within(1e-8 * stop, 0.0, 0.0)];
    let source = "t = v0 (beta + cos psi0) / (g sin a (beta^2 - 1)), beta = mu / tan a, in 30 digits";
    Pack::new("sliding-across", "sliding across a slope, on no straight line, to a stop", source, text, targets)
}
