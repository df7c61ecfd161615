//! Edges, vertices, rims and inner edges of meshes and polygons.

use super::pack::{Pack, Target, ball, material, mesh, plane, polygon, scene};
use crate::oracle::Table;
use std::fmt::Write;

pub(super) fn packs() -> Vec<Pack> {
    vec![ridge(), tip(), rim_grazed(), rim(), inner_edges()]
}

fn obj(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> String {
    let mut text = String::new();
    for [x, y, z] in vertices {
        writeln!(text, "v {x:?} {y:?} {z:?}").unwrap_or_default();
    }
    for [a, b, c] in faces {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap_or_default();
    }
    text
}

/// A ball with its centre `beside` an edge or a vertex, falling along -z at speed `v` from `height` above it, e = `e`.
fn thrown_off(beside: [f64; 2], r: f64, height: f64, v: f64, e: f64) -> Target {
    let [x, y] = beside;
    let z = (r * r - x * x - y * y).sqrt();
    let n = [x / r, y / r, z / r];
    let speed = -v * n[2];
    let leaving = [0, 1, 2].map(|i| if i == 2 { -v } else { 0.0 } - (1.0 + e) * speed * n[i]);
    Target::impact(1, (height - z) / v).at([x, y, z]).leaving(leaving).ulps(32.0 * r / z, [height / v, 4.0, v])
}

fn ridge() -> Pack {
    let roof = obj(
        &[
            [0.0, -4.0, 0.0],
            [0.0, 4.0, 0.0],
            [-3.0, -4.0, -3.0],
            [-3.0, 4.0, -3.0],
            [3.0, -4.0, -3.0],
            [3.0, 4.0, -3.0],
        ],
        &[[0, 1, 2], [1, 3, 2], [0, 4, 1], [1, 4, 5]],
    );
    let text = scene(3.0, [0.0; 3])
        + &material("roof", 0.5, "")
        + &mesh("roof", "roof", "ridge.obj")
        + &ball([0.0, 0.0, 3.0], [0.0, 0.0, -2.0], 1.0)
        + &ball([0.25, 0.5, 3.0], [0.0, 0.0, -2.0], 1.0);
    let targets = vec![
        thrown_off([0.0, 0.0], 1.0, 3.0, 2.0, 0.5),
        thrown_off([0.25, 0.0], 1.0, 3.0, 2.0, 0.5).at([0.25, 0.5, 0.9375f64.sqrt()]).of(1),
    ];
    let source = "the normal is that from the edge to the centre; z = sqrt(r^2 - d^2)";
    Pack::new("mesh-edge", "balls on the ridge of a roof", source, text, targets).mesh("ridge.obj", roof)
}

fn tip() -> Pack {
    let pyramid = obj(
        &[[0.0, 0.0, 0.0], [3.0, 0.0, -3.0], [0.0, 3.0, -3.0], [-3.0, 0.0, -3.0], [0.0, -3.0, -3.0]],
        &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]],
    );
    let text = scene(3.0, [0.0; 3])
        + &material("stone", 1.0, "")
        + &mesh("pyramid", "stone", "pyramid.obj")
        + &ball([0.0, 0.0, 3.0], [0.0, 0.0, -2.0], 1.0)
        + &ball([0.125, 0.0625, 3.0], [0.0, 0.0, -2.0], 1.0);
    let targets =
        vec![thrown_off([0.0, 0.0], 1.0, 3.0, 2.0, 1.0), thrown_off([0.125, 0.0625], 1.0, 3.0, 2.0, 1.0).of(1)];
    let source = "the normal is that from the vertex to the centre";
    Pack::new("mesh-vertex", "balls on the tip of a pyramid", source, text, targets).mesh("pyramid.obj", pyramid)
}

/// A plate whose rim is the z axis.
fn plate() -> [[f64; 3]; 4] {
    [[0.0, 0.0, -8.0], [0.0, 0.0, 8.0], [0.0, -8.0, 8.0], [0.0, -8.0, -8.0]]
}

fn rim() -> Pack {
    let table = Table::read("toi_grazing");
    let mut text = scene(10.0, [0.0; 3]) + &material("plate", 1.0, "") + &polygon("plate", "plate", &plate());
    let mut targets = Vec::new();
    for row in table.rows().filter(|row| row.text("result") == "hit" && row.number("offset_b") < row.number("radius")) {
        let [r, along, b, speed, t] = row.numbers(["radius", "distance_along", "offset_b", "speed", "t_hit"]);
        let clearance = 1.0 - b / r;
        // A hit that is nearly none is a question of its own.
        if clearance < 1e-3 || r != 0.5 {
            continue;
        }
        text += &ball([-along, b, 0.0], [speed, 0.0, 0.0], r);
        targets.push(Target::impact(1, t).of(targets.len()).ulps(64.0 / clearance, [t, r, speed]));
    }
    Pack::new("rim", "balls that pass the rim of a plate at less than their radius", "900-digit roots", text, targets)
}

fn rim_grazed() -> Pack {
    let near = 2f64.powi(-20);
    let text = scene(10.0, [0.0; 3])
        + &material("plate", 0.5, "")
        + &polygon("plate", "plate", &plate())
        + &ball([-4.0, 0.5 * (1.0 + near), 0.0], [1.0, 0.0, 0.0], 0.5)
        + &ball([-4.0, 0.5 * (1.0 - near), 0.0], [1.0, 0.0, 0.0], 0.5);
    let targets = vec![Target::impacts(0), Target::impacts(1).of(1)];
    let source = "d = r (1 +- 2^-20)";
    Pack::new(
        "rim-grazed",
        "past the rim of a plate by a millionth of the radius, and not past it",
        source,
        text,
        targets,
    )
}

/// A ball slides without friction over a flat grid, then meets a wall.
fn inner_edges() -> Pack {
    let cells = 16u32;
    let at = |i: u32| f64::from(i) * 0.5 - 4.0;
    let vertices: Vec<_> = (0..=cells).flat_map(|j| (0..=cells).map(move |i| [at(i), at(j), 0.0])).collect();
    let number = |i: u32, j: u32| j * (cells + 1) + i;
    let cell = |i: u32, j: u32| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        if (i + j).is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let faces: Vec<_> = (0..cells).flat_map(|j| (0..cells).flat_map(move |i| cell(i, j))).collect();
    let text = scene(4.0, [0.0, 0.0, -8.0])
        + &material("ice", 0.5, "")
        + &mesh("ice", "ice", "grid.obj")
        + &plane("wall", "ice", [3.5, 0.0, 0.0], [-1.0, 0.0, 0.0])
        + &ball([-3.0, -1.0, 0.25], [2.0, 0.5, 0.0], 0.25);
    // 6.25 m at 2 m/s.
    let hit = Target::impact(1, 3.125).at([3.25, 0.5625, 0.25]).leaving([-1.0, 0.5, 0.0]);
    let targets = vec![hit.ulps(256.0, [4.0, 4.0, 2.0]), Target::impacts(1)];
    let source = "as on one plane: straight, and no impact but the wall's";
    Pack::new("inner-edges", "sliding over a flat triangulation", source, text, targets)
        .mesh("grid.obj", obj(&vertices, &faces))
}
