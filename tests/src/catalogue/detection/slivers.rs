//! H7 and H8: slivers, faces of no area, and faces that are there twice.

use super::super::{Bound, Case, Figure};
use super::rows::{Tally, rows};
use super::start::{bits, keep_events_apart};
use crate::random::Random;
use crate::solids::{Solid, cube};
use crate::stage::{Run, Stage, coulomb, rough, smooth};
use carom_dynamics::events::Ending;
use carom_geometry::rounding::UNIT_ROUNDOFF;
use nalgebra::{Point3, Vector3};

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case {
            id: "H7",
            title: "needles, and the triangles of two bug reports",
            elsewhere: "Jolt #886: false hit; PhysX #597: missed hit; Jolt #1348: normal not of length 1",
            bound: "none missed, none late, none answered farther than 8 u L from touching",
            run: needles,
        },
        Case {
            id: "H7",
            title: "a triangle of no area: a segment, a point",
            elsewhere: "parry #310: NaN from two equal vertices",
            bound: "the ball bounces off it as off the segment or point; no NaN",
            run: no_area,
        },
        Case {
            id: "H7",
            title: "a closed box with slivers of height 1e-9 to 1e-15, and of none, in its faces",
            elsewhere: "normalised normals of needles are noise",
            bound: "0 of the balls aimed at the slivers get out",
            run: box_with_slivers,
        },
        Case {
            id: "H8",
            title: "every face twice, and in any order",
            elsewhere: "two ids at one time: reversed twice, and through",
            bound: "the same bits as once; the face reported is the lowest",
            run: every_face_twice,
        },
        Case {
            id: "H8",
            title: "two floors an ulp apart",
            elsewhere: "godot-jolt #511: random normal",
            bound: "as many impacts as on one, each answered once",
            run: an_ulp_apart,
        },
    ]
}

fn needles() -> Figure {
    let mut bound = Bound::default();
    let rows = rows(&["needle", "jolt886", "physx597"]);
    let tally = Tally::of(&rows, 8.0, &mut bound);
    bound.keep(tally.missed.is_empty(), || format!("missed {:?}", tally.missed));
    bound.keep(tally.doubtful == 0, || format!("{} false", tally.doubtful));
    bound.figure(tally.text())
}

fn no_area() -> Figure {
    let mut bound = Bound::default();
    let mut runs = 0;
    let p = |x: f64, y: f64| Point3::new(x, y, 0.0);
    // parry's (40,0) (0,80) (0,80), a segment along x with its middle given, and a point.
    let shapes = [
        ("parry #310", vec![p(40.0, 0.0), p(0.0, 80.0), p(0.0, 80.0)], p(20.0, 40.0)),
        ("segment", vec![p(-1.0, 0.0), p(0.25, 0.0), p(1.0, 0.0)], p(0.5, 0.0)),
        ("end of it", vec![p(-1.0, 0.0), p(0.25, 0.0), p(1.0, 0.0)], p(1.0, 0.0)),
        ("point", vec![p(0.5, 0.5); 3], p(0.5, 0.5)),
    ];
    for (name, vertices, target) in shapes {
        for radius in [0.0, 1e-6, 0.5, 100.0] {
            for g in [0.0, 8.0] {
                let z = radius + 1.0;
                let stage = Stage::new(1.0).down(g).mesh("thin", smooth(1.0), vertices.clone(), vec![[0, 1, 2]]);
                let run = stage.ball([target.x, target.y, z], [0.0, 0.0, -4.0], radius).run();
                let what = format!("{name}, r {radius}, g {g}");
                let Some(hit) = run.impacts().first().copied() else {
                    bound.keep(false, || format!("{what}: no impact"));
                    continue;
                };
                let t = if g == 0.0 { 0.25 } else { 2.0 / (4.0 + 32f64.sqrt()) };
                // To the rounding of the position, and what stands for a point.
                let length = 81.0 + radius;
                let least = carom_geometry::rounding::point_radius(length);
                let off = (hit.time - t).abs() * 4.0;
                bound.keep(off <= least + 64.0 * UNIT_ROUNDOFF * length, || format!("{what}: t = {}", hit.time));
                bound.keep((hit.normal - Vector3::z()).amax() <= 1e-9, || format!("{what}: normal {:?}", hit.normal));
                let back = hit.velocity + hit.velocity_in;
                bound.keep(back.amax() <= 1e-8, || format!("{what}: {:?} after {:?}", hit.velocity, hit.velocity_in));
                runs += 1;
            }
        }
    }
    bound.figure(format!("{runs} drops, straight back, finite"))
}

/// The cube with each face cut again at a point `height` beside the middle of its diagonal: two of four triangles are slivers.
fn slit_cube(height: f64) -> (Solid, Vec<Point3<f64>>) {
    let (mut vertices, faces) = cube();
    let (mut cut, mut targets) = (Vec::new(), Vec::new());
    for pair in faces.chunks(2) {
        // [a, b, c] and [a, c, d], with the diagonal a c.
        let ([a, b, c], [.., d]) = (pair[0], pair[1]);
        let at = |v: u32| vertices[v as usize];
        let middle = nalgebra::center(&at(a), &at(c)) + (at(b) - at(d)) * height;
        targets.extend([nalgebra::center(&at(a), &middle), middle, at(a)]);
        let m = vertices.len() as u32;
        vertices.push(middle);
        cut.extend([[a, b, m], [b, c, m], [a, m, c], [a, c, d]]);
    }
    ((vertices, cut), targets)
}

fn box_with_slivers() -> Figure {
    let mut random = Random::new(0x73);
    let mut bound = Bound::default();
    let (mut balls, mut impacts) = (0, 0);
    for height in [1e-9, 1e-12, 1e-15, 2f64.powi(-53), 0.0] {
        let (solid, targets) = slit_cube(height);
        for (k, target) in targets.iter().enumerate() {
            for radius in [0.0, 1e-3, 0.3] {
                let start = Point3::from(random.vector(0.6));
                // The centre goes to where a ball of this radius touches there.
                let aim = target * (1.0 - radius) - start;
                let g = if k % 2 == 0 { Vector3::zeros() } else { random.vector(1.0) };
                let (vertices, faces) = solid.clone();
                let stage = Stage::new(10.0).gravity(g).mesh("box", smooth(0.9), vertices, faces);
                let run = stage.ball(start, aim - g * 0.5, radius).run();
                let what = format!("height {height:e}, target {k}, r {radius}");
                keep_events_apart(&mut bound, &run, &what);
                bound.keep(!run.impacts().is_empty(), || format!("{what}: no impact"));
                bound.keep(run.outcome.ending == Ending::Completed, || format!("{what}: {:?}", run.outcome.ending));
                // Within the rounding of a flight of a few metres.
                let most = 1.0 - radius + 1e-14;
                let far = farthest(&run);
                bound.keep(far <= most, || format!("{what}: {far} from the middle, of {most}"));
                balls += 1;
                impacts += run.impacts().len();
            }
        }
    }
    bound.figure(format!("{balls} balls, {impacts} impacts, none through"))
}

/// The largest |coordinate| of the centre, from 32 places of each segment.
fn farthest(run: &Run) -> f64 {
    let segments = run.trajectory.segments.iter();
    let seen =
        segments.flat_map(|s| (0..=32).map(move |k| s.step.at(s.to * f64::from(k) / 32.0).position.coords.amax()));
    seen.fold(0.0, |most, x| if x.is_nan() { f64::NAN } else { f64::max(most, x) })
}

fn every_face_twice() -> Figure {
    let mut random = Random::new(0x81);
    let mut bound = Bound::default();
    let (mut runs, mut events) = (0, 0);
    let (vertices, faces) = cube();
    for k in 0..60 {
        let friction = coulomb(if k % 2 == 0 { 0.0 } else { 0.3 });
        let (start, velocity) = (Point3::from(random.vector(0.5)), random.vector(3.0));
        let radius = [0.0, 0.1, 0.4][k % 3];
        let run = |faces: Vec<[u32; 3]>| {
            let stage = Stage::new(6.0).down(9.81).mesh("box", rough(0.8, friction), vertices.clone(), faces);
            stage.ball(start, velocity, radius).run()
        };
        let once = run(faces.clone());
        let twice = run(faces.iter().chain(&faces).copied().collect());
        let mut shuffled: Vec<[u32; 3]> = faces.iter().chain(&faces).copied().collect();
        for i in (1..shuffled.len()).rev() {
            shuffled.swap(i, random.below(i + 1));
        }
        let shuffled = run(shuffled);
        bound.keep(bits(&once) == bits(&twice), || format!("ball {k}: twice is another run"));
        bound.keep(bits(&once) == bits(&shuffled), || format!("ball {k}: in another order another run"));
        let lowest = twice.trajectory.events.iter().all(|e| e.face.is_none_or(|f| (f as usize) < faces.len()));
        bound.keep(lowest, || format!("ball {k}: a repeated face is reported"));
        runs += 3;
        events += once.trajectory.events.len();
    }
    bound.figure(format!("{runs} runs of {events} events the same to the bit"))
}

fn an_ulp_apart() -> Figure {
    let mut bound = Bound::default();
    let mut runs = 0;
    for z in [0.0, 1.0, 1e3] {
        for radius in [0.0, 0.25] {
            for slope in [0.0, 0.25] {
                let floor = |z: f64| {
                    [
                        [-50.0, -50.0, z],
                        [50.0, -50.0, z],
                        [50.0, 50.0, z + 100.0 * slope],
                        [-50.0, 50.0, z + 100.0 * slope],
                    ]
                };
                let stage = Stage::new(2.0).down(9.81);
                let stage = stage.ball([0.3, 0.2, z + 50.0 * slope + 1.0 + 2.0 * radius], [0.1, 0.0, 0.0], radius);
                let one = stage.clone().polygon("upper", smooth(0.5), &floor(z)).run();
                let beside = |other: f64| {
                    stage
                        .clone()
                        .polygon("upper", smooth(0.5), &floor(z))
                        .polygon("lower", smooth(0.5), &floor(other))
                        .run()
                };
                for other in [z, z.next_down(), z.next_up()] {
                    let both = beside(other);
                    let what = format!("z {z}, other {other:e}, r {radius}, slope {slope}");
                    keep_events_apart(&mut bound, &both, &what);
                    let (n, m) = (one.impacts().len(), both.impacts().len());
                    // The lowest hop may fall on the other side of the rest length.
                    bound.keep(n.abs_diff(m) <= usize::from(other != z), || format!("{what}: {m} impacts, not {n}"));
                    if other == z {
                        bound.keep(bits(&one) == bits(&both), || format!("{what}: another run"));
                    }
                    let still = |run: &Run| run.outcome.state.velocity.z.abs() <= 1e-9 || slope > 0.0;
                    bound.keep(still(&both), || format!("{what}: {:?}", both.outcome.state));
                    runs += 1;
                }
            }
        }
    }
    bound.figure(format!("{runs} runs, as many impacts as on one"))
}
