//! Bouncing on one plane: the chapter's barrier, drops, the infinitely many bounces before rest, friction, and scales.

use super::pack::{Pack, Target, ball, material, plane, polygon, rest_length, scene};
use crate::oracle::{Row, Table};

const TABLE: &str = "t_n = t1 (1 + 2 e (1 - e^(n-1)) / (1 - e)), v_n = e^(n-1) sqrt(2 g h), in 30 digits";
const NAN: f64 = f64::NAN;

pub(super) fn packs() -> Vec<Pack> {
    let mut packs = vec![barrier(), no_restitution(), zeno(), far(), notch(), fast()];
    packs.extend([drop("drop-elastic", "a drop, e = 1", 1.0), drop("drop-lossy", "a drop, e = 0.7", 0.7)]);
    packs.extend([friction("linear"), friction("book_coulomb"), friction("impulse_coulomb")]);
    packs.extend([scaled("scale-small", "a drop of 2^-200 m", -200), scaled("scale-large", "a drop of 2^200 m", 200)]);
    packs
}

fn floor(e: f64, friction: &str) -> String {
    material("floor", e, friction) + &plane("floor", "floor", [0.0; 3], [0.0, 0.0, 1.0])
}

fn barrier() -> Pack {
    let text = scene(2.0, [0.0; 3])
        + &material("barrier", 0.5, "")
        + &plane("barrier", "barrier", [0.0, 1.0, 0.0], [0.0, -1.0, 0.0])
        + &ball([0.0; 3], [0.0, 1.4, 0.0], 0.0);
    let targets = vec![
        Target::impact(1, 1.0 / 1.4).at([0.0, 1.0, 0.0]).leaving([0.0, -0.7, 0.0]).ulps(4.0, [1.0, 1.0, 1.0]),
        Target::impacts(1),
    ];
    Pack::new("barrier-1d", "the chapter's barrier in one dimension", "t = 1 / 1.4, v -> -v / 2", text, targets)
}

/// The first bounces of a table's group with this restitution.
fn drop(name: &'static str, title: &'static str, e: f64) -> Pack {
    let table = Table::read("bounce_plane");
    let groups = table.groups(3);
    let group = groups.iter().find(|group| group[0].number("e") == e).unwrap_or_else(|| panic!("no e = {e}"));
    let [g, h] = group[0].numbers(["g", "h0"]);
    let rows: Vec<&Row> =
        group.iter().filter(|row| [1.0, 2.0, 3.0, 5.0, 10.0, 20.0].contains(&row.number("n"))).collect();
    let last = rows.last().map_or(0.0, |row| row.number("t_impact"));
    let text =
        scene(1.01 * last, [0.0, 0.0, -g]) + &floor(e, "") + &ball([0.0, 0.0, h], [0.0; 3], 0.0) + &rest_length(1e-100);
    let targets = rows.iter().map(|row| {
        let [n, t, v] = row.numbers(["n", "t_impact", "v_out"]);
        Target::impact(n as u64, t).at([0.0; 3]).leaving([0.0, 0.0, v]).ulps(4.0 * n, [t, h, v])
    });
    Pack::new(name, title, TABLE, text, targets.collect())
}

fn friction(law: &'static str) -> Pack {
    let table = Table::read("bounce_friction");
    let groups = table.groups(6);
    let group = groups.iter().find(|group| group[0].text("law") == law).unwrap_or_else(|| panic!("no {law}"));
    let [g, h, vx, e, c] = group[0].numbers(["g", "h0", "vx0", "e", "c_f_or_mu"]);
    let (name, title, friction) = match law {
        "linear" => {
            ("friction-linear", "bounces with linear friction: v_t -> (1 - c) v_t", format!("{{ linear = {c:?} }}"))
        }
        "book_coulomb" => (
            "friction-coulomb",
            "bounces with the book's Coulomb friction: dv_t = mu |v_n|",
            format!("{{ coulomb = {c:?} }}"),
        ),
        _ => (
            "friction-impulse",
            "bounces with Coulomb friction of the impulse: dv_t = mu (1 + e) |v_n|",
            format!("{{ impulse = {c:?} }}"),
        ),
    };
    let rows = &group[..group.len().min(8)];
    let last = rows[rows.len() - 1].number("t_impact");
    let text = scene(1.01 * last, [0.0, 0.0, -g])
        + &floor(e, &friction)
        + &ball([0.0, 0.0, h], [vx, 0.0, 0.0], 0.0)
        + &rest_length(1e-100);
    let targets = rows.iter().map(|row| {
        let [n, t, x, vt] = row.numbers(["n", "t_impact", "x_impact", "vt_after"]);
        Target::impact(n as u64, t).at([x, 0.0, 0.0]).leaving([vt, NAN, NAN]).ulps(4.0 * n, [t, x + h, vx])
    });
    let source = "(1 - c)^n; v_x - mu v0 (1 - e^n) / (1 - e), times 1 + e for the impulse law, in 30 digits";
    Pack::new(name, title, source, text, targets.collect())
}

fn no_restitution() -> Pack {
    let text =
        scene(5.0, [0.0, 0.0, -8.0]) + &floor(0.0, "{ coulomb = 0.5 }") + &ball([0.0, 0.0, 1.25], [0.0; 3], 0.25);
    let targets = vec![
        Target::impact(1, 0.5).at([0.0, 0.0, 0.25]).leaving([0.0; 3]).ulps(4.0, [0.5, 1.0, 4.0]),
        Target::rest(0.5).at([0.0, 0.0, 0.25]).ulps(4.0, [0.5, 1.0, 4.0]),
        Target::impacts(1),
    ];
    Pack::new("no-restitution", "a drop with e = 0: one impact, then rest", "t = sqrt(2 h / g)", text, targets)
}

fn zeno() -> Pack {
    let table = Table::read("bounce_zeno");
    let row = table.rows().next().unwrap_or_else(|| panic!("no row"));
    let [g, h, e, t] = row.numbers(["g", "h0", "e", "t_zeno"]);
    let text = scene(100.0, [0.0, 0.0, -g]) + &floor(e, "") + &ball([0.0, 0.0, h], [0.0; 3], 0.0);
    let targets = vec![Target::rest(t).at([0.0; 3]).within(1e-13 * t, 0.0, 0.0)];
    let source = "rest at sqrt(2 h / g) (1 + e) / (1 - e), on the floor to the bit";
    Pack::new("zeno", "infinitely many bounces in a finite time", source, text, targets)
}

fn scaled(name: &'static str, title: &'static str, k: i32) -> Pack {
    let s = 2f64.powi(k);
    let text = scene(8.0, [0.0, 0.0, -8.0 * s]) + &floor(0.5, "") + &ball([0.0, 0.0, 4.25 * s], [0.0; 3], 0.25 * s);
    let targets = (1..=4).map(|n: u64| {
        let shares = 2f64.powi(1 - n as i32);
        // It falls 4 lengths in 1 s, lands at 8 lengths a second, and hops for 1 s, 1/2 s, 1/4 s: 1, 2, 2.5, 2.75.
        Target::impact(n, 3.0 - 2.0 * shares)
            .at([0.0, 0.0, 0.25 * s])
            .leaving([0.0, 0.0, 4.0 * s * shares])
            .ulps(8.0, [3.0, s, 8.0 * s])
    });
    Pack::new(name, title, "powers of two: every number is exact", text, targets.collect())
}

fn far() -> Pack {
    let x = 1e8;
    let text = scene(4.0, [0.0, 0.0, -8.0])
        + &material("floor", 0.5, "")
        + &plane("floor", "floor", [x, x, x], [0.0, 0.0, 1.0])
        + &ball([x, x, x + 4.25], [0.5, 0.0, 0.0], 0.25);
    let targets = vec![
        Target::impact(1, 1.0).at([x + 0.5, x, x + 0.25]).leaving([0.5, 0.0, 4.0]).ulps(8.0, [2.0, x, 8.0]),
        Target::impact(2, 2.0).at([x + 1.0, x, x + 0.25]).leaving([0.5, 0.0, 2.0]).ulps(8.0, [2.0, x, 8.0]),
        Target::impact(3, 2.5).at([x + 1.25, x, x + 0.25]).leaving([0.5, 0.0, 1.0]).ulps(8.0, [2.0, x, 8.0]),
    ];
    Pack::new("far-away", "a drop 1e8 m from the origin", "all numbers exact in f64", text, targets)
}

fn notch() -> Pack {
    let l = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 2.0, 0.0], [2.0, 2.0, 0.0], [2.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
    let r = 0.015625;
    let text = scene(1.5, [0.0, 0.0, -8.0])
        + &material("plate", 0.5, "")
        + &polygon("plate", "plate", &l)
        + &ball([1.0, 3.0, 1.0 + r], [0.0; 3], r)
        + &ball([3.0, 3.0, 1.0 + r], [0.0; 3], r)
        + &ball([3.0, 1.0, 1.0 + r], [0.0; 3], r);
    let hit = |k: usize, x: f64, y: f64| {
        Target::impact(1, 0.5).of(k).at([x, y, r]).leaving([0.0, 0.0, 2.0]).ulps(64.0, [0.5, 4.0, 4.0])
    };
    let targets = vec![hit(0, 1.0, 3.0), Target::impacts(0).of(1), hit(2, 3.0, 1.0)];
    let title = "balls over an L: two hit it, one falls through its notch";
    Pack::new("concave-polygon", title, "t = sqrt(2 h / g)", text, targets)
}

fn fast() -> Pack {
    let v = 1e8;
    let wall = [[1.0, -4.0, -4.0], [1.0, 4.0, -4.0], [1.0, 4.0, 4.0], [1.0, -4.0, 4.0]];
    let text = scene(1.0, [0.0; 3])
        + &material("wall", 0.5, "")
        + &polygon("wall", "wall", &wall)
        + &ball([0.0, 0.5, 0.25], [v, 0.0, 0.0], 0.0078125);
    let t = (1.0 - 0.0078125) / v;
    let hit = Target::impact(1, t).at([0.9921875, 0.5, 0.25]).leaving([-0.5 * v, 0.0, 0.0]);
    let targets = vec![hit.ulps(64.0, [t, 4.0, v]), Target::impacts(1)];
    Pack::new("fast-thin-wall", "1e8 m/s against a wall of no thickness", "t = (x - r) / v", text, targets)
}
