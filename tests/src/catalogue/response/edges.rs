//! H28: the inner edges of a flat surface.

use super::check::Check;
use crate::catalogue::{Case, Figure};
use crate::stage::{Run, Stage, coulomb, rough};
use carom_dynamics::effects::friction::Friction;
use nalgebra::Point3;

pub(super) const CASES: &[Case] = &[
    Case {
        id: "H28",
        title: "rolling, sliding and bouncing over a flat grid of 32 x 32 cells, four triangulations",
        elsewhere: "rapier 0.36.1: a hop of 0.47 m, v -> (7.28, 1.19, 0.49); rapier #95, #404, Jolt #1155, bullet #383",
        bound: "events, path and normals as on the plane, to the bit",
        run: flat_grid,
    },
    Case {
        id: "H28",
        title: "down a ramp of two triangles",
        elsewhere: "the ball is turned aside at the shared edge (rapier #95)",
        bound: "no event on the ramp, and 0 m/s and 0 m to the side",
        run: ramp,
    },
];

/// Vertices and faces.
type Faces = (Vec<Point3<f64>>, Vec<[u32; 3]>);

/// A flat grid on [-16, 16]^2 with lines at `line(k)`, and its cells cut by `cut` into triangles of the corners (anticlockwise) and a
/// point inside.
fn grid(line: impl Fn(u32) -> f64, cut: impl Fn(u32, u32) -> Cut) -> Faces {
    const N: u32 = 32;
    let mut vertices: Vec<_> =
        (0..=N).flat_map(|j| (0..=N).map(move |i| (i, j))).map(|(i, j)| Point3::new(line(i), line(j), 0.0)).collect();
    let mut faces = Vec::new();
    for (i, j) in (0..N).flat_map(|j| (0..N).map(move |i| (i, j))) {
        let a = j * (N + 1) + i;
        let corners = [a, a + 1, a + N + 2, a + N + 1];
        let [p, q, r, s] = corners;
        match cut(i, j) {
            Cut::Rising => faces.extend([[p, q, r], [p, r, s]]),
            Cut::Falling => faces.extend([[p, q, s], [q, r, s]]),
            Cut::Inside(x, y) => {
                let [low, high] = [vertices[p as usize], vertices[r as usize]];
                let middle = vertices.len() as u32;
                vertices.push(Point3::new(low.x + x * (high.x - low.x), low.y + y * (high.y - low.y), 0.0));
                faces.extend((0..4).map(|k| [corners[k], corners[(k + 1) % 4], middle]));
            }
        }
    }
    (vertices, faces)
}

/// How a cell is cut.
enum Cut {
    Rising,
    Falling,
    /// Into four triangles around a point, given as parts of the cell's sides.
    Inside(f64, f64),
}

/// The triangulations: regular, alternating, around points in the cells, and on uneven lines.
fn triangulations() -> [(&'static str, Faces); 4] {
    let even = |k: u32| f64::from(k) - 16.0;
    // Steps between 0.5 and 1.5, from one end to the other.
    let uneven =
        |k: u32| 16.0 * (f64::from(k) / 16.0 - 1.0) + 0.3 * f64::from(k * 7 % 5) * f64::from(u32::from(k % 32 != 0));
    let part = |i: u32, j: u32, by: u32| f64::from(1 + (i * by + j * 5) % 7) / 9.0;
    [
        ("regular", grid(even, |_, _| Cut::Rising)),
        ("alternating", grid(even, |i, j| if (i + j) % 2 == 0 { Cut::Rising } else { Cut::Falling })),
        ("around points", grid(even, |i, j| Cut::Inside(part(i, j, 3), part(j, i, 4)))),
        (
            "uneven",
            grid(|k| uneven(k) * 0.93, |i, j| if i % 3 == 0 { Cut::Rising } else { Cut::Inside(part(i, j, 2), 0.4) }),
        ),
    ]
}

/// What must be the same to the bit: kinds, and the bits of times, places, normals and velocities.
fn bits(run: &Run) -> Vec<(String, [u64; 10])> {
    let of = |e: &carom_dynamics::events::Event| {
        let (x, n, v) = (e.position, e.normal, e.velocity);
        // -0 is 0.
        let numbers = [e.time, x.x, x.y, x.z, n.x, n.y, n.z, v.x, v.y, v.z].map(|x| (x + 0.0).to_bits());
        (format!("{:?}", e.kind), numbers)
    };
    run.trajectory.events.iter().map(of).collect()
}

fn flat_grid() -> Figure {
    let mut check = Check::new();
    let r = 0.25;
    let (mut runs, mut events, mut samples) = (0, 0, 0);
    // Rolling as in the report; along lines and through vertices; braking; bouncing; bouncing onto vertices.
    let motions: [(&str, [f64; 3], [f64; 3], f64, Friction); 6] = [
        ("rolls", [-14.3, -4.2, r], [10.0, 3.1, 0.0], 0.5, Friction::None),
        ("rolls along a line", [-14.5, 2.0, r], [10.0, 0.0, 0.0], 0.5, Friction::None),
        ("rolls through vertices", [-12.0, -12.0, r], [8.0, 8.0, 0.0], 0.5, Friction::None),
        ("brakes", [-14.3, -4.2, r], [10.0, 3.1, 0.0], 0.5, coulomb(0.3)),
        ("bounces", [-14.3, -4.2, 2.0], [10.0, 3.1, 0.0], 0.8, coulomb(0.01)),
        ("bounces onto a line", [-14.3, 3.0, 2.0], [10.0, 0.0, 0.0], 0.8, Friction::None),
    ];
    for (motion, x, v, e, friction) in motions {
        let scene = || Stage::new(2.5).down(9.81).ball(x, v, r);
        let plane = scene().plane("ground", rough(e, friction), [0.0; 3], [0.0, 0.0, 1.0]).run();
        for (name, (vertices, faces)) in triangulations() {
            let run = scene().mesh("ground", rough(e, friction), vertices, faces).run();
            let same = bits(&run) == bits(&plane);
            check.that(same, || {
                let first = bits(&run).into_iter().zip(bits(&plane)).position(|(a, b)| a != b);
                let at = first.map(|i| (run.trajectory.events[i], plane.trajectory.events[i]));
                format!(
                    "{motion}, {name}: {} events, {} on the plane: {at:?} {:?} {:?}",
                    bits(&run).len(),
                    bits(&plane).len(),
                    run.kinds(),
                    run.trajectory.events.iter().map(|e| (e.time, e.position.x, e.normal)).take(8).collect::<Vec<_>>()
                )
            });
            for k in 0..=1000 {
                let t = 2.5 * f64::from(k) / 1000.0;
                let (a, b) = (run.at(t), plane.at(t));
                check.that(a == b, || format!("{motion}, {name}: at {a:?}, on the plane at {b:?}, after {t} s"));
                samples += 1;
            }
            runs += 1;
            events += run.trajectory.events.len();
        }
    }
    check.figure(format!("{runs} runs with {events} events and {samples} places, all the same bits"))
}

fn ramp() -> Figure {
    let mut check = Check::new();
    let mut steps = 0;
    for (rise, e) in [(1.0, 0.0), (0.5, 0.5), (3.0, 0.5)] {
        // From (0, 0, 8 rise) down to (8, 0, 0), 4 m wide, cut along a diagonal.
        let corner = |x: f64, y: f64| Point3::new(x, y, rise * (8.0 - x));
        let vertices = vec![corner(0.0, -2.0), corner(8.0, -2.0), corner(8.0, 2.0), corner(0.0, 2.0)];
        let normal = nalgebra::Vector3::new(rise, 0.0, 1.0).normalize();
        let r = 0.25;
        let start = Point3::new(1.0, 0.125, rise * 7.0) + normal * r;
        let run = Stage::new(0.5)
            .down(9.81)
            .mesh("ramp", rough(e, Friction::None), vertices, vec![[0, 1, 2], [0, 2, 3]])
            .ball(start, [0.0; 3], r)
            .run();
        let place = || format!("rise {rise}, e = {e}");
        let state = run.outcome.state;
        check.that(run.trajectory.events.len() <= 2, || format!("{}: {:?}", place(), run.kinds()));
        check.that(state.position.y == 0.125 && state.velocity.y == 0.0, || format!("{}: {state:?}", place()));
        let speed = 9.81 * 0.5 * rise / (1.0 + rise * rise).sqrt();
        check.within(0.0, (state.velocity.norm() / speed - 1.0).abs(), 1e-12, || format!("{}: speed", place()));
        steps += run.trajectory.segments.len();
    }
    check.figure(format!("straight down, in {steps} stretches"))
}
