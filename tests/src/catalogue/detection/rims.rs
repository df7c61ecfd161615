//! H31: the rim of an open mesh, ridges, and both sides of a face.

use super::super::{Bound, Case, Figure, Worst};
use super::watertight::permutations;
use crate::random::Random;
use crate::stage::{Run, Stage, coulomb, rough, smooth};
use carom_geometry::rounding::UNIT_ROUNDOFF;
use nalgebra::{Point3, Vector3};

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case {
            id: "H31",
            title: "an open terrain from above and from below, its faces wound either way",
            elsewhere: "back faces are culled: through from behind",
            bound: "both sides collide; from below the mirror image, bit for bit; winding changes no bit",
            run: both_sides,
        },
        Case {
            id: "H31",
            title: "grazing a ridge and a rim from everywhere around them",
            elsewhere: "parry #171: a graze of a ridge reports a back face; PhysX #501: wrong at exactly 0 degrees",
            bound: "n = (c - q)/|c - q| from the point q of the edge to 64 u, at the time of the closed form",
            run: around_an_edge,
        },
    ]
}

/// An open sheet of 4 x 4 cells with heights.
fn terrain() -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    for i in 0..5 {
        for j in 0..5 {
            let (x, y) = (f64::from(i) - 2.0, f64::from(j) - 2.0);
            vertices.push(Point3::new(x, y, 0.4 * (1.7 * x).sin() * (1.1 * y + 0.3).cos()));
        }
    }
    let cell = |i: u32, j: u32| {
        let v = 5 * i + j;
        [[v, v + 5, v + 6], [v, v + 6, v + 1]]
    };
    let faces = (0..4).flat_map(|i| (0..4).flat_map(move |j| cell(i, j))).collect();
    (vertices, faces)
}

fn both_sides() -> Figure {
    let mut random = Random::new(0x311);
    let mut bound = Bound::default();
    let (mut runs, mut impacts) = (0, 0);
    let (vertices, faces) = terrain();
    for k in 0..80 {
        let start = Point3::new(random.within(-1.8, 1.8), random.within(-1.8, 1.8), 2.0);
        let velocity = Vector3::new(random.within(-0.5, 0.5), random.within(-0.5, 0.5), -1.0);
        let radius = [0.0, 0.05, 0.3][k % 3];
        let material = if k % 2 == 0 { smooth(0.8) } else { rough(0.6, coulomb(0.2)) };
        // From below everything is upside down; wound the other way, faces look the other way.
        let run = |side: f64, reversed: bool| {
            let vertices = vertices.iter().map(|p| Point3::new(p.x, p.y, side * p.z)).collect();
            let faces = faces.iter().map(|&[a, b, c]| if reversed { [a, c, b] } else { [a, b, c] }).collect();
            let stage = Stage::new(4.0).gravity([0.0, 0.0, -9.81 * side]).mesh("terrain", material, vertices, faces);
            stage.ball([start.x, start.y, side * start.z], [velocity.x, velocity.y, side * velocity.z], radius).run()
        };
        let above = run(1.0, false);
        let upright = |run: &Run, side: f64| {
            let turned = |v: Vector3<f64>| Vector3::new(v.x, v.y, side * v.z);
            let of = |e: &carom_dynamics::events::Event| {
                (e.time, e.kind, turned(e.position.coords), turned(e.normal), turned(e.velocity))
            };
            run.trajectory.events.iter().map(of).collect::<Vec<_>>()
        };
        for (side, reversed) in [(1.0, true), (-1.0, false), (-1.0, true)] {
            let other = run(side, reversed);
            let same = upright(&other, side) == upright(&above, 1.0);
            bound.keep(same, || format!("ball {k}, side {side}, reversed {reversed}: another run"));
            runs += 1;
        }
        bound.keep(!above.impacts().is_empty(), || format!("ball {k}: through"));
        impacts += above.impacts().len();
    }
    bound.figure(format!("{runs} runs of {impacts} impacts the same to the bit"))
}

fn around_an_edge() -> Figure {
    let mut bound = Bound::default();
    let (mut normal_off, mut time_off) = (Worst::new(), Worst::new());
    let mut runs = 0;
    let p = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    // The edge from (0, -2, 0) to (0, 2, 0): of a roof, of a single sheet, and of a sheet standing on end.
    let roof =
        (vec![p(0.0, -2.0, 0.0), p(0.0, 2.0, 0.0), p(-2.0, 0.0, -2.0), p(2.0, 0.0, -2.0)], vec![[0, 1, 2], [1, 0, 3]]);
    let sheet = (vec![p(0.0, -2.0, 0.0), p(0.0, 2.0, 0.0), p(-2.0, 0.0, 0.0)], vec![[0, 1, 2]]);
    let upright = (vec![p(0.0, -2.0, 0.0), p(0.0, 2.0, 0.0), p(0.0, 0.0, -2.0)], vec![[0, 1, 2]]);
    for (name, (vertices, faces), reach) in [("ridge", roof, 0.7), ("rim", sheet, 0.99), ("upright", upright, 0.99)] {
        for k in -20..=20 {
            let r = 0.25;
            // Dropped so that it touches the edge beside its middle, from straight above to a graze.
            let offset = reach * r * f64::from(k) / 20.0;
            if name == "rim" && offset < 0.0 {
                continue; // over the sheet
            }
            for order in permutations(faces.len()) {
                let faces = order.iter().map(|&i| faces[i]).collect();
                let stage = Stage::new(2.0).mesh(name, smooth(1.0), vertices.clone(), faces);
                let run = stage.ball([offset, 0.25, 1.0], [0.0, 0.0, -1.0], r).run();
                let Some(hit) = run.impacts().first().copied() else {
                    bound.keep(false, || format!("{name}, {offset}: no impact"));
                    continue;
                };
                let height = (r * r - offset * offset).sqrt();
                // The offset's rounding moves the height by its slope.
                let slope = (offset / height).abs().max(1.0);
                let time = (hit.time - (1.0 - height)).abs() / UNIT_ROUNDOFF / slope;
                let n = Vector3::new(offset, 0.0, height) / r;
                let normal = (hit.normal - n).amax() / UNIT_ROUNDOFF / slope;
                time_off.of(time);
                normal_off.of(normal);
                // The rounding of positions of 2 m, and of a direction over 0.25 m.
                bound.keep(time <= 64.0 && normal <= 8.0 * 64.0, || {
                    format!("{name}, {offset}: t {time} u, n {normal} u, {:?}", hit.normal)
                });
                runs += 1;
            }
        }
    }
    bound.figure(format!("{runs} drops: t off by {:.1} u, normal by {:.1} u at worst", time_off.0, normal_off.0))
}
