//! Several planes: a corridor, a box, corners and wedges.

use super::pack::{Pack, Target, ball, material, plane, rest_length, scene};
use crate::oracle::{Table, U};

const NAN: f64 = f64::NAN;

pub(super) fn packs() -> Vec<Pack> {
    vec![
        two_walls(),
        box_billiard(),
        corner("corner-elastic", 1.0),
        corner("corner", 0.5),
        thin_wedge("wedge-thin-2", 100.0),
        thin_wedge("wedge-thin-3", 1000.0),
        gravity_wedge(),
        slope(),
        groove(),
    ]
}

fn two_walls() -> Pack {
    let table = Table::read("two_walls");
    let groups = table.groups(3);
    let group = &groups[0][..groups[0].len().min(10)];
    let [gap, v0, e] = group[0].numbers(["gap_minus_2r", "v0", "e"]);
    let r = 0.125;
    let last = group[group.len() - 1].number("t_hit_n");
    let text = scene(1.001 * last, [0.0; 3])
        + &material("wall", e, "")
        + &plane("left", "wall", [0.0; 3], [1.0, 0.0, 0.0])
        + &plane("right", "wall", [gap + 2.0 * r, 0.0, 0.0], [-1.0, 0.0, 0.0])
        + &ball([r, 0.0, 0.0], [v0, 0.0, 0.0], r);
    let targets = group.iter().map(|row| {
        let [n, t, speed] = row.numbers(["n", "t_hit_n", "speed_after"]);
        let (x, v) = if n % 2.0 == 1.0 { (gap + r, -speed) } else { (r, speed) };
        Target::impact(n as u64, t).at([x, 0.0, 0.0]).leaving([v, 0.0, 0.0]).ulps(4.0 * n, [t, gap, v0])
    });
    Pack::new(
        "two-walls",
        "between two walls",
        "t_n = (D / v) (e^-n - 1) / (1/e - 1), in 30 digits",
        text,
        targets.collect(),
    )
}

/// In numbers of which all sums and quotients are exact.
fn box_billiard() -> Pack {
    let (size, start, velocity, r) = ([2.0, 1.5, 1.0], [0.5, 0.75, 0.375], [1.0, 0.5, 0.25], 0.125);
    let wall = |name: &str, point: [f64; 3], normal: [f64; 3]| plane(name, "wall", point, normal);
    let text = scene(1000.0, [0.0; 3])
        + &material("wall", 1.0, "")
        + &wall("west", [0.0; 3], [1.0, 0.0, 0.0])
        + &wall("east", [size[0], 0.0, 0.0], [-1.0, 0.0, 0.0])
        + &wall("south", [0.0; 3], [0.0, 1.0, 0.0])
        + &wall("north", [0.0, size[1], 0.0], [0.0, -1.0, 0.0])
        + &wall("floor", [0.0; 3], [0.0, 0.0, 1.0])
        + &wall("roof", [0.0, 0.0, size[2]], [0.0, 0.0, -1.0])
        + &ball(start, velocity, r);
    // Unfolded, each coordinate is a tooth of a saw.
    let place = |axis: usize, t: f64| -> (f64, f64) {
        let width = size[axis] - 2.0 * r;
        let way = (start[axis] - r + velocity[axis] * t).rem_euclid(2.0 * width);
        if way < width { (r + way, velocity[axis]) } else { (r + 2.0 * width - way, -velocity[axis]) }
    };
    let mut times: Vec<f64> = Vec::new();
    for axis in 0..3 {
        let width = size[axis] - 2.0 * r;
        let hits = (1..).map(|k| (f64::from(k) * width - (start[axis] - r)) / velocity[axis]);
        times.extend(hits.take_while(|t| *t < 1000.0));
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    let targets =
        times.iter().enumerate().filter(|(i, _)| [0, 1, 2, 3, 9, 99, 999].contains(i) || i + 1 == times.len());
    let targets = targets.map(|(i, &t)| {
        // Just after the hit, a speed is that of the tooth that begins.
        let after = [0, 1, 2].map(|axis| place(axis, t));
        let hit = Target::impact(i as u64 + 1, t).at(after.map(|(x, _)| x)).leaving(after.map(|(_, v)| v));
        hit.ulps(4.0 * (i + 1) as f64, [t, 2.0, 1.0])
    });
    let mut targets: Vec<Target> = targets.collect();
    targets.push(Target::impacts(times.len() as u64));
    Pack::new(
        "box-billiard",
        "a ball in a box without gravity, e = 1, for 1000 s",
        "unfolding; every number is exact",
        text,
        targets,
    )
}

fn corner(name: &'static str, e: f64) -> Pack {
    let text = scene(2.0, [0.0; 3])
        + &material("wall", e, "")
        + &plane("x", "wall", [0.0; 3], [1.0, 0.0, 0.0])
        + &plane("y", "wall", [0.0; 3], [0.0, 1.0, 0.0])
        + &plane("z", "wall", [0.0; 3], [0.0, 0.0, 1.0])
        + &ball([1.0; 3], [-1.0, -1.0, -1.0], 0.25);
    let targets =
        vec![Target::impact(1, 0.75).at([0.25; 3]).leaving([e; 3]).ulps(4.0, [1.0, 1.0, 1.0]), Target::impacts(1)];
    Pack::new(
        name,
        "three walls at the same instant: v -> -e v",
        "t = 3/4; one answer for any order of the walls",
        text,
        targets,
    )
}

/// In along -x between y = 0 and y = x / m; hit j is where the straight way past the apex crosses the angle j phi.
fn thin_wedge(name: &'static str, m: f64) -> Pack {
    let (counts, hits) = (Table::read("thin_wedge_counts"), Table::read("thin_wedge_hits"));
    let row = counts.rows().find(|row| row.number("M") == m).unwrap_or_else(|| panic!("no M = {m}"));
    let [x0, y0, speed, total, phi, last] = row.numbers(["x0", "y0", "speed", "hits_total", "phi", "t_last_hit"]);
    let text = scene(4.0 * last, [0.0; 3])
        + &material("wall", 1.0, "")
        + &plane("A", "wall", [0.0; 3], [0.0, 1.0, 0.0])
        + &plane("B", "wall", [0.0; 3], [1.0, -m, 0.0])
        + &ball([x0, y0, 0.0], [-speed, 0.0, 0.0], 0.0);
    let groups = hits.groups(5);
    let group = groups.iter().find(|group| group[0].number("M") == m).unwrap_or_else(|| panic!("no M = {m}"));
    let mut targets: Vec<Target> = group
        .iter()
        .map(|row| {
            let [hit, t, vx, vy] = row.numbers(["hit", "t_hit", "vx_after", "vy_after"]);
            // Each hit turns the motion by a few u, and the line crosses it at that angle.
            let turned = 4.0 * U * (hit + 1.0);
            let crossing = y0 / (hit * phi).sin().powi(2);
            let target = Target::impact(hit as u64, t).leaving([vx, vy, 0.0]);
            target.within(turned * crossing / speed + 4.0 * U * t, 0.0, turned * speed)
        })
        .collect();
    targets.push(Target::impacts(total as u64));
    Pack::new(
        name,
        "a thin wedge, e = 1: the digits of pi",
        "unfolding: t = (x0 - d cot(j phi)) / v, in 30 digits",
        text,
        targets,
    )
}

fn gravity_wedge() -> Pack {
    let table = Table::read("wedge_billiard");
    let groups = table.groups(6);
    let group = &groups[0];
    let [g, angle, x0, y0, vx0, vy0] = group[0].numbers(["g", "half_angle_deg", "x0", "y0", "vx0", "vy0"]);
    let (sin, cos) = angle.to_radians().sin_cos();
    let rows: Vec<_> = group.iter().filter(|row| row.number("hit") <= 12.0).collect();
    let last = rows.last().map_or(0.0, |row| row.number("t"));
    let text = scene(1.001 * last, [0.0, -g, 0.0])
        + &material("wall", 1.0, "")
        + &plane("R", "wall", [0.0; 3], [-cos, sin, 0.0])
        + &plane("L", "wall", [0.0; 3], [cos, sin, 0.0])
        + &ball([x0, y0, 0.0], [vx0, vy0, 0.0], 0.0);
    let speed = (2.0 * g * y0).sqrt();
    let mut worst = 0.0f64;
    let targets = rows.into_iter().map(|row| {
        let [hit, t, x, y] = row.numbers(["hit", "t", "x", "y"]);
        let [vx, vy, growth] = row.numbers(["vx_after", "vy_after", "log10_error_growth"]);
        worst = worst.max(growth);
        let bound = 4.0 * U * hit * 10f64.powf(worst);
        let target = Target::impact(hit as u64, t).at([x, y, 0.0]).leaving([vx, vy, 0.0]);
        target.within(bound * (1.0 + t), bound * y0, bound * speed)
    });
    let source = "400-digit arithmetic; the tolerance grows with the amplification of an error of the start";
    Pack::new("wedge-gravity", "a point in a wedge under gravity, e = 1: chaotic", source, text, targets.collect())
}

fn slope() -> Pack {
    let table = Table::read("incline_bounces");
    let groups = table.groups(4);
    let group = groups.iter().find(|group| group[0].number("e") < 1.0).unwrap_or_else(|| panic!("none is lossy"));
    let [g, h, angle, e] = group[0].numbers(["g", "h_drop", "slope_deg", "e"]);
    let (sin, cos) = angle.to_radians().sin_cos();
    let rows = &group[..group.len().min(8)];
    let first = (2.0 * h / g).sqrt();
    let last = first + rows[rows.len() - 1].number("t_since_first_impact");
    let text = scene(1.001 * last, [0.0, 0.0, -g])
        + &material("slope", e, "")
        + &plane("slope", "slope", [0.0; 3], [sin, 0.0, cos])
        + &ball([0.0, 0.0, h], [0.0; 3], 0.0)
        + &rest_length(1e-60);
    let targets = rows.iter().map(|row| {
        let [k, t, range] = row.numbers(["k", "t_since_first_impact", "distance_down_slope"]);
        let target = Target::impact(k as u64 + 1, first + t).at([range * cos, NAN, -range * sin]);
        target.ulps(16.0 * (k + 1.0), [first + t, range + h, 1.0])
    });
    let source = "T_k = 2 e^k v0 / g, R_k = w_k T_k + g sin(a) T_k^2 / 2, in 30 digits";
    Pack::new("slope-bounces", "bounces down a smooth slope", source, text, targets.collect())
}

fn groove() -> Pack {
    let root = 0.5f64.sqrt();
    let (r, h) = (0.5, 1.0);
    // It touches both walls when its centre is r sqrt(2) above the edge.
    let low = r / root;
    let text = scene(10.0, [0.0, 0.0, -8.0])
        + &material("wall", 0.0, "{ coulomb = 0.5 }")
        + &plane("left", "wall", [0.0; 3], [1.0, 0.0, 1.0])
        + &plane("right", "wall", [0.0; 3], [-1.0, 0.0, 1.0])
        + &ball([0.0, 0.0, low + h], [0.0; 3], r);
    let rest = [0.0, 0.0, low];
    let targets = vec![
        Target::impact(1, 0.5).at(rest).leaving([0.0; 3]).ulps(16.0, [1.0, 1.0, 4.0]),
        Target::rest(0.5).at(rest).ulps(16.0, [1.0, 1.0, 4.0]),
    ];
    Pack::new("groove", "a drop into a V-groove with e = 0: at rest on two planes", "t = sqrt(2 h / g)", text, targets)
}
