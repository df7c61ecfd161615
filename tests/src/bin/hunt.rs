//! The soak: random scenes of one ball each, run and checked without end. `hunt FAMILY FROM COUNT`, or `hunt FAMILY SEED show`.

use carom_dynamics::body::Ball;
use carom_dynamics::effects::drag::Drag;
use carom_dynamics::effects::friction::Friction;
use carom_dynamics::effects::gravity::Gravity;
use carom_dynamics::effects::restitution::Restitution;
use carom_dynamics::events::Ending;
use carom_dynamics::events::Event;
use carom_dynamics::observer::{Observer, Segment, Trajectory};
use carom_dynamics::plan::Plan;
use carom_dynamics::scene::{Method, Scene};
use carom_dynamics::simulate::simulate;
use carom_dynamics::surface::{Material, Shape, Surface};
use carom_geometry::mesh::Mesh;
use carom_geometry::plane::Plane;
use carom_geometry::polygon::Polygon;
use carom_tests::checker::Checker;
use carom_tests::obj;
use carom_tests::world::World;
use nalgebra::{Point3, Vector3};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

const SPOT: &str = include_str!("../../../crates/app/scenes/meshes/spot_triangulated.obj");
const BUNNY: &str = include_str!("../../../crates/app/scenes/meshes/low_poly_bunny.obj");
const STAIRS: &str = include_str!("../../../crates/app/scenes/meshes/stairs.obj");
const TERRAIN: &str = include_str!("../../../crates/app/scenes/meshes/bullet_terrain.obj");
const JACKSBORO: &str = include_str!("../../../crates/app/scenes/meshes/jacksboro_dem_quarter.obj");

/// Gives up after a while.
struct Impatient {
    run: Trajectory,
    calls: u64,
    end: Instant,
}

impl Observer for Impatient {
    fn event(&mut self, e: &Event) {
        self.run.event(e);
    }
    fn segment(&mut self, s: &Segment) {
        self.run.segment(s);
        self.calls += 1;
        if self.calls % 256 == 0 && Instant::now() > self.end {
            let events = self.run.events.len();
            if std::env::args().nth(3).as_deref() == Some("show") {
                for e in self.run.events.iter().take(12) {
                    println!("{e:?}");
                }
                for s in self.run.segments.iter().take(20) {
                    println!("{s:?}");
                }
                println!("...");
                for e in self.run.events.iter().rev().take(12) {
                    println!("{e:?}");
                }
                for s in self.run.segments.iter().rev().take(20) {
                    println!("{s:?}");
                }
            }
            panic!("out of patience ({})", if events > 10_000 { "events" } else { "segments" });
        }
    }
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
    fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.unit()
    }
    fn log(&mut self, a: f64, b: f64) -> f64 {
        self.between(a.ln(), b.ln()).exp()
    }
    fn pick<T: Clone>(&mut self, all: &[T]) -> T {
        all[(self.next() % all.len() as u64) as usize].clone()
    }
    fn vector(&mut self) -> Vector3<f64> {
        loop {
            let v = Vector3::new(self.between(-1., 1.), self.between(-1., 1.), self.between(-1., 1.));
            if v.norm() < 1.0 && v.norm() > 0.1 {
                return v.normalize();
            }
        }
    }
    fn in_box(&mut self, a: &Point3<f64>, b: &Point3<f64>) -> Point3<f64> {
        Point3::new(self.between(a.x, b.x), self.between(a.y, b.y), self.between(a.z, b.z))
    }
}

fn mesh(text: &str) -> Arc<Mesh> {
    let (v, f) = obj::read(text);
    Arc::new(Mesh::new(v, f).unwrap())
}

struct Store {
    spot: Arc<Mesh>,
    bunny: Arc<Mesh>,
    stairs: Arc<Mesh>,
    terrain: Arc<Mesh>,
    jacksboro: Arc<Mesh>,
    worlds: BTreeMap<&'static str, World>,
}

fn material(r: &mut Random) -> Material {
    let e = r.pick(&[0.0, 0.3, 0.7, 0.9, 1.0]);
    let friction = match r.next() % 5 {
        0 => Friction::None,
        1 => Friction::linear(r.pick(&[0.1, 0.5, 1.0])).unwrap(),
        2 => Friction::coulomb(r.pick(&[0.05, 0.3, 0.8, 2.0])).unwrap(),
        3 => Friction::impulse(r.pick(&[0.05, 0.3, 0.8])).unwrap(),
        _ => Friction::None,
    };
    Material { restitution: Restitution::new(e).unwrap(), friction }
}

fn method(r: &mut Random) -> (Option<Method>, Option<Drag>) {
    let drag = |r: &mut Random| {
        let d = if r.unit() < 0.5 { Drag::linear(0.05).unwrap() } else { Drag::quadratic(0.47, 1.2).unwrap() };
        if r.unit() < 0.5 { d.in_wind(r.vector() * 3.0).unwrap() } else { d }
    };
    match r.next() % 12 {
        0 => (Some(Method::Rk4 { step: r.pick(&[0.001, 0.01, 0.05]) }), None),
        1 => (Some(Method::Rk4 { step: 0.01 }), Some(drag(r))),
        2 => (Some(Method::Adaptive { tolerance: 1e-9 }), Some(drag(r))),
        3 => (Some(Method::Adaptive { tolerance: 1e-6 }), None),
        4 => (Some(Method::Euler { step: r.pick(&[0.001, 0.01, 0.03]) }), None),
        5 => (Some(Method::SemiImplicitEuler { step: r.pick(&[0.001, 0.01, 0.03]) }), None),
        _ => (None, None),
    }
}

fn surface(name: &str, m: Material, shape: Shape) -> Surface {
    Surface { name: name.into(), material: m, shape }
}

/// The scene of a family and a seed; none if the seed found no free place to start.
fn scene(family: &str, seed: u64, store: &Store) -> Option<(Scene, World)> {
    let mut r = Random(seed.wrapping_mul(0x1234_5678_9abc_def1) ^ 0x5bd1_e995);
    let m = material(&mut r);
    let (method, drag) = method(&mut r);
    let mut gravity = if r.unit() < 0.8 {
        if r.unit() < 0.6 { Vector3::new(0.0, 0.0, -9.81) } else { r.vector() * 9.81 }
    } else {
        Vector3::zeros()
    };
    let (mut surfaces, mut low, mut high, mut inside) = (Vec::new(), Point3::origin(), Point3::origin(), None);
    let mut radius = if r.unit() < 0.15 { 0.0 } else { r.log(1e-3, 0.1) };
    let mut speed = r.pick(&[0.0, 0.5, 3.0, 10.0]);
    let mut duration = r.pick(&[1.0, 5.0]);
    let body = |mesh: &Arc<Mesh>, low: &mut Point3<f64>, high: &mut Point3<f64>, grow: f64| {
        let e = mesh.bounds().extent() * grow;
        (*low, *high) = (mesh.bounds().min() - e, mesh.bounds().max() + e);
        Shape::Mesh(Arc::clone(mesh))
    };
    match family {
        "spot" => {
            surfaces.push(surface("spot", m, body(&store.spot, &mut low, &mut high, 0.0)));
            inside = Some(true);
        }
        "bunny" => {
            inside = Some(r.unit() < 0.5);
            let grow = if inside == Some(true) { 0.0 } else { 0.2 };
            surfaces.push(surface("bunny", m, body(&store.bunny, &mut low, &mut high, grow)));
            if inside == Some(false) {
                let n = -gravity;
                if n.norm() > 0.0 {
                    let p = store.bunny.bounds().centre() - n.normalize() * 3.0;
                    surfaces.push(surface(
                        "floor",
                        material(&mut r),
                        Shape::Plane(Plane::from_point_normal(p, n).unwrap()),
                    ));
                }
            }
        }
        "stairs" => {
            inside = if r.unit() < 0.3 { Some(true) } else { Some(false) };
            let grow = if inside == Some(true) { 0.0 } else { 0.1 };
            surfaces.push(surface("stairs", m, body(&store.stairs, &mut low, &mut high, grow)));
            if r.unit() < 0.5 {
                gravity = r.pick(&[
                    Vector3::new(0., 0., -9.81),
                    Vector3::new(0., -9.81, 0.),
                    Vector3::new(-9.81, 0., 0.),
                    Vector3::new(0., 9.81, 0.),
                ]);
            }
        }
        "terrain" => {
            surfaces.push(surface("terrain", m, body(&store.terrain, &mut low, &mut high, 0.0)));
            high.z += 3.0;
            gravity = Vector3::new(0., 0., -9.81);
            if r.unit() < 0.8 {
                low.z = high.z - 2.0;
            }
            radius *= 5.0;
        }
        "jacksboro" => {
            surfaces.push(surface("dem", m, body(&store.jacksboro, &mut low, &mut high, 0.0)));
            low.z = high.z + 400.0;
            high.z += 1000.0;
            gravity = Vector3::new(0., 0., -9.81);
            radius = r.pick(&[0.0, 0.1, 1.0, 10.0, 100.0, 400.0]);
            speed = r.pick(&[0.0, 10.0, 100.0]);
            duration = r.pick(&[30.0, 120.0]);
        }
        "soup" => {
            let count = 1 + r.next() % 12;
            let (mut v, mut f) = (Vec::new(), Vec::new());
            for i in 0..count as u32 {
                let c = Point3::from(r.vector() * r.unit());
                let size = r.log(1e-2, 2.0);
                let thin = if r.unit() < 0.3 { r.log(1e-9, 1e-1) } else { 1.0 };
                let a = r.vector();
                v.extend([c, c + a * size, c + a * (size * r.unit()) + r.vector() * (size * thin)]);
                f.push([3 * i, 3 * i + 1, 3 * i + 2]);
            }
            surfaces.push(surface("soup", m, Shape::Mesh(Arc::new(Mesh::new(v, f).unwrap()))));
            let n = if gravity.norm() > 0.0 { -gravity } else { r.vector() };
            surfaces.push(surface(
                "floor",
                material(&mut r),
                Shape::Plane(Plane::from_point_normal(Point3::origin() - n.normalize() * 1.5, n).unwrap()),
            ));
            (low, high) = (Point3::new(-2., -2., -2.), Point3::new(2., 2., 2.));
            radius = if r.unit() < 0.2 { 0.0 } else { r.log(1e-3, 1.0) };
        }
        "wedge" => {
            // Two to four planes through about the origin, acute on purpose, some as polygons.
            let axis = r.vector();
            let count = 2 + r.next() % 3;
            let up = r.vector();
            gravity = -up * 9.81;
            let mut side = up.cross(&axis);
            side = side.try_normalize(1e-3)?;
            let mut half = r.log(1e-3, 1.2);
            for k in 0..count {
                let lean = if k % 2 == 0 { half } else { -half };
                if k == 1 && r.unit() < 0.5 {
                    half = r.log(1e-3, 1.5);
                }
                // The plane contains roughly the axis and leans `lean` from up.
                let along = axis.cross(&side).normalize();
                let mut n = side * lean.cos() - along * lean.sin();
                if n.dot(&side) * (if k % 2 == 0 { 1.0 } else { -1.0 }) > 0.0 {
                    n = -n;
                }
                let n = if k >= 2 { axis * (if k == 2 { 1.0 } else { -1.0 }) + up * 0.2 } else { n };
                let p =
                    if k >= 2 { Point3::origin() - axis * (if k == 2 { 1.0 } else { -1.0 }) } else { Point3::origin() };
                let shape = if r.unit() < 0.5 {
                    Shape::Plane(Plane::from_point_normal(p, n).unwrap())
                } else {
                    let n = n.normalize();
                    let a = n.cross(&r.vector()).try_normalize(1e-3)?;
                    let b = n.cross(&a);
                    Shape::Polygon(
                        Polygon::new(vec![
                            p - a * 4.0 - b * 4.0,
                            p + a * 4.0 - b * 4.0,
                            p + a * 4.0 + b * 4.0,
                            p - a * 4.0 + b * 4.0,
                        ])
                        .ok()?,
                    )
                };
                surfaces.push(surface(&format!("w{k}"), if r.unit() < 0.5 { m } else { material(&mut r) }, shape));
            }
            (low, high) = (Point3::new(-1., -1., -1.), Point3::new(1., 1., 1.));
        }
        "box" => {
            // A closed box of axis-aligned polygons or planes, sometimes tilted; exact ties and corners.
            let q = [1.0, 2.0, 1.5];
            let shift = r.pick(&[0.0, 0.0, 1e3, 1e6]);
            for k in 0..6 {
                let axis = k % 3;
                let mut n = Vector3::zeros();
                n[axis] = if k < 3 { 1.0 } else { -1.0 };
                let mut p = Point3::new(shift, shift, shift);
                if k >= 3 {
                    p[axis] += q[axis];
                }
                let shape = if r.unit() < 0.5 {
                    Shape::Plane(Plane::from_point_normal(p, n).unwrap())
                } else {
                    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                    let mut v = vec![p; 4];
                    v[1][i] += q[i];
                    v[2][i] += q[i];
                    v[2][j] += q[j];
                    v[3][j] += q[j];
                    Shape::Polygon(Polygon::new(v).unwrap())
                };
                surfaces.push(surface(&format!("s{k}"), if r.unit() < 0.8 { m } else { material(&mut r) }, shape));
            }
            (low, high) = (Point3::new(shift, shift, shift), Point3::new(shift + 1., shift + 2., shift + 1.5));
            radius = r.pick(&[0.0, 0.125, 0.25, 0.1, 0.3]);
        }
        _ => panic!("family {family}"),
    }
    let mass = Some(0.1);
    let velocity = r.vector() * speed;
    let velocity = if family == "box" && r.unit() < 0.4 {
        r.pick(&[Vector3::new(1., 1., 1.), Vector3::new(1., 0., 0.), Vector3::new(-1., 1., 0.), Vector3::zeros()])
    } else {
        velocity
    };
    let ball = |p| Ball::new(p, velocity, radius, mass).unwrap();
    let mut made = Scene {
        duration,
        gravity: (gravity.norm() > 0.0).then(|| Gravity::uniform(gravity).unwrap()),
        drag,
        surfaces,
        balls: vec![ball(low)],
        rest: None,
        method,
    };
    let world = match family {
        "spot" | "stairs" | "terrain" | "jacksboro" => store.worlds[family].clone(),
        _ => World::of(&made),
    };
    for _ in 0..200 {
        let mut p = r.in_box(&low, &high);
        if family == "box" && r.unit() < 0.5 {
            p = low + (high - low) * 0.5;
        }
        let free = world.distance(&p, 2.0 * radius + 1e-6) > radius
            && world.planes.iter().all(|(q, n, _)| {
                let d = n.dot(&(p - q));
                if family == "soup" { d.abs() > radius + 1e-9 } else { d > radius + 1e-9 }
            });
        if !free {
            continue;
        }
        if let Some(want) = inside
            && (world.winding(&p).round() != 0.0) != want
        {
            continue;
        }
        made.balls = vec![ball(p)];
        return Some((made, world));
    }
    None
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let [_, family, from, count] = &args[..] else { panic!("hunt FAMILY FROM COUNT") };
    let from: u64 = from.parse().unwrap();
    let show = count == "show";
    let count: u64 = if show { 1 } else { count.parse().unwrap() };
    let mut store = Store {
        spot: mesh(SPOT),
        bunny: mesh(BUNNY),
        stairs: mesh(STAIRS),
        terrain: mesh(TERRAIN),
        jacksboro: mesh(JACKSBORO),
        worlds: BTreeMap::new(),
    };
    for (name, mesh) in
        [("spot", &store.spot), ("stairs", &store.stairs), ("terrain", &store.terrain), ("jacksboro", &store.jacksboro)]
    {
        let m = material(&mut Random(1));
        let s = Scene {
            duration: 1.0,
            gravity: None,
            drag: None,
            surfaces: vec![surface(name, m, Shape::Mesh(Arc::clone(mesh)))],
            balls: vec![],
            rest: None,
            method: None,
        };
        store.worlds.insert(name, World::of(&s));
    }
    if !show {
        std::panic::set_hook(Box::new(|_| {}));
    }
    let families: Vec<&str> = if family == "all" {
        vec!["spot", "bunny", "stairs", "terrain", "jacksboro", "soup", "wedge", "box"]
    } else {
        vec![family]
    };
    for family in families {
        let mut tally: BTreeMap<String, Vec<u64>> = BTreeMap::new();
        let mut worst: BTreeMap<String, f64> = BTreeMap::new();
        let (mut ran, mut events, mut hangs) = (0, 0, 0);
        for seed in from..from + count {
            let Some((scene, world)) = scene(family, seed, &store) else { continue };
            let plan = match Plan::new(&scene) {
                Ok(p) => p,
                Err(e) => {
                    tally.entry(format!("refused {e}")).or_default().push(seed);
                    continue;
                }
            };
            ran += 1;
            if show {
                println!("{:?} {:?} {:?} {:?}", scene.method, scene.drag, scene.gravity, scene.balls);
            }
            let began = Instant::now();
            // A thread of its own: a ball that never ends is left to itself.
            let (send, receive) = std::sync::mpsc::channel();
            let shared = plan.clone();
            let thread = std::thread::spawn(move || {
                let mut t =
                    Impatient { run: Trajectory::default(), calls: 0, end: Instant::now() + Duration::from_secs(2) };
                let o = simulate(&shared, &shared.balls()[0], &mut t);
                let _ = send.send((t.run, o));
            });
            let result = receive.recv_timeout(Duration::from_secs(4));
            let result = match result {
                Ok(r) => Ok(r),
                Err(std::sync::mpsc::RecvTimeoutError::Timeout) => {
                    tally.entry("HANG".into()).or_default().push(seed);
                    hangs += 1;
                    if hangs > 2 {
                        break;
                    }
                    continue;
                }
                Err(_) => Err(()),
            };
            let message = thread
                .join()
                .err()
                .and_then(|e| e.downcast_ref::<String>().cloned().or(e.downcast_ref::<&str>().map(|s| s.to_string())));
            let took = began.elapsed();
            let mut bad = |what: String| tally.entry(what).or_default().push(seed);
            let Ok((run, outcome)) = result else {
                bad(format!("panic {}", message.unwrap_or_default()));
                continue;
            };
            events += run.events.len();
            if took > Duration::from_millis(1000) {
                bad(format!("slow"));
            }
            if outcome.ending != Ending::Completed {
                bad(format!("{:?}", outcome.ending));
            }
            if run.events.len() > 10_000 {
                bad("many events".into());
            }
            if run.segments.len() > 100_000 {
                bad("many segments".into());
            }
            if show {
                println!(
                    "{:?} {:?} {:?} {:?} m {:?} took {took:?}",
                    scene.method,
                    scene.drag,
                    scene.gravity,
                    scene.balls,
                    scene.surfaces.iter().map(|s| s.material).collect::<Vec<_>>()
                );
                println!("{outcome:?}");
                let n = run.events.len();
                for (i, e) in run.events.iter().enumerate() {
                    if i < 12 || i + 20 > n {
                        println!(
                            "  {i} t={} {:?} s{} {:?} x={:?} n={:?} {:?} -> {:?}",
                            e.time,
                            e.kind,
                            e.surface,
                            e.face,
                            e.position,
                            e.normal.data.0[0],
                            e.velocity_in.data.0[0],
                            e.velocity.data.0[0]
                        );
                    }
                }
                let n = run.segments.len();
                println!("  {n} segments");
                for (i, s) in run.segments.iter().enumerate() {
                    if i < 8 || i + 12 > n || (12..44).contains(&i) {
                        println!(
                            "  {i} t={} {:?} to {} of {} s, x={:?} v={:?} a={:?}",
                            s.time,
                            s.motion,
                            s.to,
                            s.step.seconds,
                            s.step.path.start(),
                            s.step.velocity[0].data.0[0],
                            (s.step.velocity[1] / s.step.seconds).data.0[0]
                        );
                    }
                }
            }
            if run.segments.len() > 300_000 {
                continue;
            }
            let checker = Checker::run(&world, &scene, &scene.balls[0], &run, &outcome);
            let mut seen = std::collections::BTreeSet::new();
            for f in &checker.findings {
                if seen.insert(f.flaw) {
                    bad(format!("{:?}", f.flaw));
                }
            }
            for (flaw, ratio) in &checker.worst {
                let w = worst.entry(format!("{flaw:?}")).or_insert(0.0);
                *w = w.max(*ratio);
            }
            if show {
                for f in checker.findings.iter().take(20) {
                    println!("  {:?} t={} {:e} > {:e}: {}", f.flaw, f.time, f.amount, f.allowed, f.note);
                }
            }
        }
        println!("{family}: {ran} balls, {events} events");
        for (what, seeds) in &tally {
            println!("   {what}: {} {:?}", seeds.len(), &seeds[..seeds.len().min(14)]);
        }
        println!("   worst/allowed {:?}", worst.iter().map(|(k, v)| format!("{k} {v:.2e}")).collect::<Vec<_>>());
    }
}
