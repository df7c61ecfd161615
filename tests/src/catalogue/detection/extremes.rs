//! H11 to H14: far away, tiny, fast, and very large.

use super::super::{Bound, Case, Figure, Worst};
use super::rows::{Tally, rows};
use super::start::bits_from;
use crate::exact::{Exact, exact};
use crate::random::Random;
use crate::solids::cube;
use crate::stage::{Run, Stage, coulomb, rough, smooth};
use carom_dynamics::error::SceneError;
use carom_dynamics::events::Ending;
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::Method;
use carom_geometry::rounding::{UNIT_ROUNDOFF, scale};
use nalgebra::{Point3, Vector3};

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case {
            id: "H11",
            title: "a scene moved by whole metres, all arithmetic exact",
            elsewhere: "absolute tolerances change what happens with the place",
            bound: "the same events, bit for bit, up to 2^36 m away",
            run: moved_scenes,
        },
        Case {
            id: "H11",
            title: "floors and triangles 1e8 m from the origin, ulp 1.5e-8 m",
            elsewhere: "GJK casts lose what the coordinates have too much (parry #429)",
            bound: "16 u L/|v_n| on planes; none missed, none late, none beyond 8 u L on triangles",
            run: far_away,
        },
        Case {
            id: "H11",
            title: "a ball smaller than what its place resolves",
            elsewhere: "r = 1e-9 at 1e8 m cannot be represented above a plane; it is simulated anyway",
            bound: "refused by name below 16 u L, accepted from there on",
            run: below_resolution,
        },
        Case {
            id: "H12",
            title: "lengths scaled by 2^k, times by 2^m: k -300..300, m -80..80",
            elsewhere: "absolute epsilons: nothing collides below them",
            bound: "bounces, slides and rests the same, bit for bit",
            run: scaled_scenes,
        },
        Case {
            id: "H12",
            title: "scenes of 1e-160 m, radii of 5e-324 m, speeds of 6.9e-42 m/s",
            elsewhere: "parry #123: looped for ever; robust 1.2.0 decides wrongly below 1e-150",
            bound: "ends; hits where it should; nothing below the floor; meshes below 2^-450 m are refused by name",
            run: tiny_scenes,
        },
        Case {
            id: "H13",
            title: "a wall of no thickness at speeds up to 1e150 m/s",
            elsewhere: "rapier 0.36.1, r = 5 mm, 2 cm wall, with CCD: 34 of 50 behind it from 1e3 m/s on; bevy_rapier #129",
            bound: "0 crossings, planes and meshes; the same order of hits for every step",
            run: fast_balls,
        },
        Case {
            id: "H14",
            title: "a face of 1e2 to 1e11 m under a ball of 0.5 m",
            elsewhere: "parry #429: 139 mm early at 500 m in f32; in f64 0.39 m at 1e8; PhysX #610: 2.9975 for 3",
            bound: "level: 4 u whatever the extent; tilted: 16 u L/|v_n|, never late by more",
            run: large_faces,
        },
    ]
}

fn moved_scenes() -> Figure {
    let mut bound = Bound::default();
    let (mut scenes, mut events) = (0, 0);
    let (vertices, faces) = cube();
    let run = |by: Vector3<f64>, mesh: bool| {
        // Falls 4 m in 1 s, up for 1 s, 1/2 s and so on: binary fractions throughout.
        let stage = Stage::new(2.9).down(8.0);
        let stage = if mesh {
            let vertices = vertices.iter().map(|p| p * 8.0 + by).collect();
            stage.mesh("box", smooth(0.5), vertices, faces.clone())
        } else {
            let at = |x: f64, y: f64, z: f64| Point3::new(x, y, z) + by;
            let stage = stage.plane("floor", smooth(0.5), at(0.0, 0.0, -8.0), [0.0, 0.0, 1.0]);
            stage.plane("wall", smooth(0.5), at(8.0, 0.0, 0.0), [-1.0, 0.0, 0.0])
        };
        stage.ball(Point3::new(0.0, 1.0, -3.5) + by, [3.0, 0.25, 0.0], 0.5).run()
    };
    for mesh in [false, true] {
        let here = bits_from(&run(Vector3::zeros(), mesh), &Vector3::zeros());
        let times: Vec<f64> = here.iter().map(|e| e.0).collect();
        bound.keep(times == [1.0, 2.0, 2.5, 2.5, 2.75, 2.875], || format!("mesh {mesh}: events at {times:?}"));
        for power in [0, 10, 20, 30, 36] {
            for direction in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, -1.0, 1.0]] {
                let by = Vector3::from(direction) * (2f64.powi(power) + 3.0);
                let there = bits_from(&run(by, mesh), &by);
                bound.keep(there == here, || format!("mesh {mesh}, moved by {by:?}: {there:?}"));
                scenes += 1;
                events += there.len();
            }
        }
    }
    bound.figure(format!("{scenes} moved scenes, {events} events the same to the bit"))
}

fn far_away() -> Figure {
    let mut random = Random::new(0xb2);
    let (mut bound, mut worst) = (Bound::default(), Worst::new());
    let count = 2000;
    for _ in 0..count {
        let away = random.point(1.5e8);
        let n = random.vector(1.0).normalize();
        let start = away + n * random.within(1.0, 5.0) + random.vector(0.5);
        let velocity = random.vector(1.0) - n * 4.0;
        let radius = random.within(0.1, 0.5);
        let stage = Stage::new(8.0).plane("floor", smooth(1.0), away, n).ball(start, velocity, radius);
        let run = stage.run();
        // n.(start - p) - r + n.v t = 0 for the n that the plane has, without rounding.
        let normal = run.impacts().first().map_or(n, |e| e.normal);
        let dot = |v: [Exact; 3]| (0..3).map(|i| exact(normal[i]) * &v[i]).fold(Exact::ZERO, |sum, term| sum + term);
        let gap = dot([0, 1, 2].map(|i| exact(start[i]) - exact(away[i]))) - exact(radius);
        let rate = dot([0, 1, 2].map(|i| exact(velocity[i])));
        let expected = crate::exact::nearest(&(-gap / &rate));
        let Some(event) = run.impacts().first().copied() else {
            bound.keep(false, || format!("no impact at {expected}"));
            continue;
        };
        let allowed = 16.0 * UNIT_ROUNDOFF * start.coords.amax() / crate::exact::nearest(&rate).abs();
        worst.of((event.time - expected).abs() / allowed);
        bound.keep((event.time - expected).abs() <= allowed, || format!("t = {} of {expected}", event.time));
    }
    let tally = Tally::of(&rows(&["offset_1e8"]), 8.0, &mut bound);
    bound.keep(tally.missed.is_empty(), || format!("missed {:?}", tally.missed));
    bound.figure(format!("planes: {count} starts, {:.1e} of the bound; triangles: {}", worst.0, tally.text()))
}

fn below_resolution() -> Figure {
    let mut bound = Bound::default();
    let least = 16.0 * UNIT_ROUNDOFF * 1e8;
    let plan = |radius: f64| {
        let stage = Stage::new(1.0).plane("floor", smooth(0.5), [1e8, 0.0, 0.0], [0.0, 0.0, 1.0]);
        Plan::new(&stage.ball([1e8, 0.0, 1.0], [0.0, 0.0, -1.0], radius).0).map(|_| ())
    };
    for radius in [1e-9, least.next_down(), 5e-324] {
        let refused = plan(radius);
        let named = matches!(refused, Err(SceneError::RadiusBelowResolution { ball: 0, least: l, .. }) if l == least);
        bound.keep(named, || format!("r = {radius:e}: {refused:?}"));
    }
    for radius in [0.0, least, 1e-6] {
        let taken = plan(radius);
        bound.keep(taken.is_ok(), || format!("r = {radius:e}: {taken:?}"));
    }
    bound.figure(format!("refused below {least:.2e} m at 1e8 m, a point is taken"))
}

/// A scene with a bit of everything: planes, a polygon, a mesh; bouncing, sliding, rest.
fn everything(k: i32, m: i32, [friction, c_r]: [f64; 2], radius: f64) -> Run {
    let length = |x: f64| scale(x, k);
    let (speed, acceleration) = (k - m, k - 2 * m);
    let at = |x: f64, y: f64, z: f64| Point3::new(length(x), length(y), length(z));
    let material = rough(c_r, coulomb(friction));
    let (vertices, faces) = cube();
    let pyramid =
        vec![at(-1.5, -1.0, 0.0), at(-0.5, -1.0, 0.0), at(-0.5, 1.0, 0.0), at(-1.5, 1.0, 0.0), at(-1.0, 0.0, 0.3)];
    let ramp = [at(0.3, -2.0, 0.0), at(1.9, -2.0, 0.8), at(1.9, 2.0, 0.8), at(0.3, 2.0, 0.0)].map(|p| [p.x, p.y, p.z]);
    let stage = Stage::new(scale(6.0, m)).gravity([0.0, scale(0.1, acceleration), scale(-9.81, acceleration)]);
    let stage = stage.plane("floor", material, at(0.0, 0.0, 0.0), [0.0, 0.0, 1.0]).polygon("ramp", material, &ramp);
    let stage = stage.mesh("pyramid", material, pyramid, vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);
    let walls = vertices.iter().map(|p| (p * 2.0).map(length)).collect();
    let stage = stage.mesh("walls", material, walls, faces);
    let velocity = Vector3::new(-0.9, 0.35, 0.2).map(|v| scale(v, speed));
    stage.ball(at(0.1, -0.05, 1.4), velocity, length(radius)).run()
}

fn scaled_scenes() -> Figure {
    let mut bound = Bound::default();
    let (mut runs, mut events) = (0, 0);
    for (friction, c_r, radius) in
        [(0.0, 0.8, 0.1), (0.3, 0.8, 0.1), (0.05, 0.5, 0.2), (0.6, 0.0, 0.05), (0.1, 0.7, 0.0)]
    {
        let here = everything(0, 0, [friction, c_r], radius);
        for (k, m) in
            [(-300, 0), (-300, -80), (-200, 80), (-100, 33), (-1, 0), (0, 1), (100, -7), (200, 80), (300, 0), (300, 80)]
        {
            let there = everything(k, m, [friction, c_r], radius);
            let (scaled, expected) = (&there.trajectory.events, &here.trajectory.events);
            let same = scaled.len() == expected.len()
                && scaled.iter().zip(expected).all(|(a, b)| {
                    (a.kind, a.surface, a.face, a.normal) == (b.kind, b.surface, b.face, b.normal)
                        && a.time == scale(b.time, m)
                        && a.position == b.position.map(|x| scale(x, k))
                        && a.velocity == b.velocity.map(|v| scale(v, k - m))
                });
            let first = scaled.iter().zip(expected).position(|(a, b)| a.time != scale(b.time, m) || a.kind != b.kind);
            bound.keep(same, || {
                format!(
                    "2^{k} m, 2^{m} s, mu {friction}: {} events of {}, first {first:?}",
                    scaled.len(),
                    expected.len()
                )
            });
            runs += 1;
            events += scaled.len();
        }
    }
    bound.figure(format!("{runs} scaled scenes, {events} events the same to the bit"))
}

fn tiny_scenes() -> Figure {
    let mut bound = Bound::default();
    let mut runs = 0;
    // parry #123, its subnormal speed as an f32.
    let triangle = [[12.0, 5.0, 0.0], [11.0, 5.0, 0.0], [11.0, 6.0, 0.0]].map(Point3::from).to_vec();
    let stage = Stage::new(1e300).mesh("triangle", smooth(1.0), triangle.clone(), vec![[0, 1, 2]]);
    let run = stage.ball([0.0; 3], [0.0, 6.925e-42, 0.0], 0.375).run();
    bound.keep(run.trajectory.events.is_empty() && run.outcome.ending == Ending::Completed, || {
        format!("parry #123: {:?}", run.outcome)
    });
    for size in [1e-9, 1e-80, 1e-135, 1e-160, 1e-300] {
        for mesh in [false, true] {
            for radius in [0.0, 0.1 * size] {
                let stage = Stage::new(4.0).gravity([0.0, 0.0, -9.81 * size]);
                let quad = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                    .map(|[x, y]| Point3::new(x * size, y * size, 0.0));
                let stage = if mesh {
                    stage.mesh("quad", smooth(0.5), quad.to_vec(), vec![[0, 1, 2], [0, 2, 3]])
                } else {
                    stage.floor(smooth(0.5))
                };
                let stage = stage.ball([0.3 * size, 0.2 * size, size + radius], [0.0; 3], radius);
                let what = format!("size {size:e}, mesh {mesh}, r {radius:e}");
                runs += 1;
                if mesh && size < 1e-140 {
                    // The distance to a triangle is a root of squares, which f64 does not have there.
                    let refused = Plan::new(&stage.0).map(|_| ());
                    let named = matches!(refused, Err(SceneError::OutOfRange { .. }));
                    bound.keep(named, || format!("{what}: {refused:?}"));
                    continue;
                }
                let run = stage.run();
                let expected = (2.0f64 / 9.81).sqrt();
                let first = run.impacts().first().map(|e| e.time);
                bound.keep(first.is_some_and(|t| (t - expected).abs() < 1e-11), || {
                    format!("{what}: first impact {first:?}")
                });
                bound.keep(run.outcome.ending == Ending::Completed, || format!("{what}: {:?}", run.outcome.ending));
                bound.keep(run.outcome.state.position.z >= radius * (1.0 - 1e-12), || {
                    format!("{what}: ends at {:?}", run.outcome.state)
                });
            }
        }
    }
    // The smallest radius there is, in a scene of nothing but it.
    for (z, v) in [(5e-324, 0.0), (1e-323, -5e-324), (2.5e-320, -1e-320)] {
        let run = Stage::new(1.0).down(9.81).floor(smooth(0.5)).ball([0.0, 0.0, z], [0.0, 0.0, v], 5e-324).run();
        bound.keep(run.outcome.ending == Ending::Completed, || format!("z = {z:e}: {:?}", run.outcome));
        bound.keep(run.outcome.state.position.z >= 0.0, || format!("z = {z:e}: ends at {:?}", run.outcome.state));
        runs += 1;
    }
    bound.figure(format!("{} scenes end as they should", runs + 1))
}

fn fast_balls() -> Figure {
    let mut bound = Bound::default();
    let mut runs = 0;
    let wall = [[5.0, -50.0, -50.0], [5.0, 50.0, -50.0], [5.0, 50.0, 50.0], [5.0, -50.0, 50.0]];
    for power in [0, 2, 3, 4, 6, 8, 20, 50, 100, 150] {
        let speed = 10f64.powi(power);
        // Time for 1000 crossings of the 10 m between the walls.
        let duration = 1e4 / speed;
        for radius in [0.0, 0.005] {
            for shape in ["planes", "polygons", "mesh"] {
                let stage = Stage::new(duration);
                let stage = match shape {
                    "planes" => stage.plane("east", smooth(1.0), [5.0, 0.0, 0.0], [-1.0, 0.0, 0.0]).plane(
                        "west",
                        smooth(1.0),
                        [-5.0, 0.0, 0.0],
                        [1.0, 0.0, 0.0],
                    ),
                    "polygons" => {
                        let west = wall.map(|[x, y, z]| [-x, y, z]);
                        stage.polygon("east", smooth(1.0), &wall).polygon("west", smooth(1.0), &west)
                    }
                    _ => {
                        let (vertices, faces) = cube();
                        stage.mesh("room", smooth(1.0), vertices.iter().map(|p| p * 5.0).collect(), faces)
                    }
                };
                let run = stage.ball([0.0, 0.1, 0.2], [speed, 0.001 * speed, 0.0], radius).run();
                let what = format!("{speed:e} m/s, r {radius}, {shape}");
                let impacts = run.impacts();
                let sides = impacts
                    .windows(2)
                    .all(|w| w[0].normal.x * w[1].normal.x < 0.0 || w[0].normal.y != 0.0 || w[1].normal.y != 0.0);
                bound.keep(sides, || format!("{what}: not from wall to wall"));
                let crossings = (1e4 + 5.0) / (10.0 - 2.0 * radius);
                let hits = impacts.iter().filter(|e| e.normal.x != 0.0).count();
                bound.keep((hits as f64 - crossings).abs() <= 1.0, || {
                    format!("{what}: {hits} impacts, not {crossings}")
                });
                let far = run.trajectory.segments.iter().map(|s| s.step.at(s.to).position.x.abs()).fold(0.0, f64::max);
                bound.keep(far <= 5.0 + 1e-12, || format!("{what}: at {far}"));
                runs += 1;
            }
        }
    }
    // Whatever the step of a method whose paths are straight, the hits are the same ones.
    let order = |method: Method, duration: f64, speed: f64| {
        let stage = Stage::new(duration).room(smooth(1.0), [10.0, 7.0, 5.0]).method(method);
        let run = stage.ball([1.0, 2.0, 3.0], [speed, 0.37 * speed, -0.61 * speed], 0.005).run();
        (run.impacts().iter().map(|e| e.surface).collect::<Vec<_>>(), run.impacts().last().map(|e| e.position))
    };
    for speed in [10.0, 1e8] {
        let duration = 500.0 / speed;
        let (hits, last) = order(Method::Exact, duration, speed);
        for step in [duration, duration / 3.0, duration / 60.0, duration / 1000.0] {
            let (other, end) = order(Method::Euler { step }, duration, speed);
            bound.keep(other == hits, || format!("{speed:e} m/s, h {step:e}: other walls"));
            let off = last.zip(end).map_or(f64::INFINITY, |(a, b)| (a - b).amax());
            bound.keep(off <= 1e-11, || format!("{speed:e} m/s, h {step:e}: off by {off:e}"));
            runs += 1;
        }
    }
    bound.figure(format!("{runs} runs up to 1e150 m/s, no wall crossed"))
}

fn large_faces() -> Figure {
    let mut random = Random::new(0xe1);
    let mut bound = Bound::default();
    let (mut level, mut tilted) = (Worst::new(), Worst::new());
    let mut drops = 0;
    for power in [2, 3, 4, 6, 8, 10, 11] {
        let size = 10f64.powi(power);
        for k in 0..20 {
            let speed = random.octave(-2, 6);
            let (x, y) = (random.within(-1.0, 1.0), random.within(-1.0, 1.0));
            let r = 0.5;
            // Level: the coordinates across do not enter.
            let flat = [[-size, -size, 0.0], [size, -size, 0.0], [0.0, size, 0.0]].map(Point3::from).to_vec();
            let stage = Stage::new(100.0).mesh("face", smooth(1.0), flat, vec![[0, 1, 2]]);
            let run = stage.ball([x, y, 3.5], [0.0, 0.0, -speed], r).run();
            match run.impacts().first() {
                Some(event) => {
                    let error = (event.time - 3.0 / speed).abs() / (3.0 / speed) / UNIT_ROUNDOFF;
                    level.of(error);
                    bound.keep(error <= 4.0, || format!("level, {size:e} m: {error:.1} u"));
                }
                None if size > 2.0 => bound.keep(false, || format!("level, {size:e} m: no impact")),
                None => {}
            }
            if size > 2.0 {
                // Tilted: exactly the triangle of its rounded corners.
                let turn = nalgebra::Rotation3::from_euler_angles(0.3 + 0.1 * f64::from(k), 0.7, -0.2);
                let triangle =
                    [[-size, -size, 0.0], [size, -size, 0.0], [0.0, size, 0.0]].map(|p| turn * Point3::from(p));
                let n = turn * Vector3::z();
                let start = turn * Point3::new(x, y, 3.5);
                let stage = Stage::new(100.0).mesh("face", smooth(1.0), triangle.to_vec(), vec![[0, 1, 2]]);
                let run = stage.ball(start, -n * speed, r).run();
                let Some(event) = run.impacts().first().copied() else {
                    bound.keep(false, || format!("tilted, {size:e} m: no impact"));
                    continue;
                };
                let x = crate::exact::on_path(&start, &[-n * speed], event.time);
                let gap = crate::exact::clearance(&triangle, &x, r);
                tilted.of(gap.abs() / (UNIT_ROUNDOFF * size));
                bound.keep(gap.abs() <= 16.0 * UNIT_ROUNDOFF * size, || format!("tilted, {size:e} m: off by {gap:e}"));
            }
            drops += 1;
        }
    }
    bound.figure(format!(
        "{drops} sizes and speeds: level off by {:.1} u, tilted by {:.1} u L at worst",
        level.0, tilted.0
    ))
}
