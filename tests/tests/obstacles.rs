//! One ball among surfaces of which everything is known: which it meets first, where it leaves what it touches, and in how much doubt.

use carom_dynamics::body::State;
use carom_dynamics::collision::{Obstacles, Returns};
use carom_dynamics::contacts::{Contact, Contacts, MAX_CONTACTS};
use carom_dynamics::counters::Counters;
use carom_dynamics::events::Motion;
use carom_dynamics::integrators::{Step, euler, exact};
use carom_dynamics::plan::Plan;
use carom_geometry::mesh::Mesh;
use carom_geometry::path::Path;
use carom_geometry::rounding::contact_doubt;
use carom_geometry::site::{Bend, Site};
use carom_tests::solids;
use carom_tests::stage::{Stage, smooth};
use nalgebra::{Point3, Vector3};

const RADIUS: f64 = 0.5;

/// A second along the line from `x` with velocity `v`.
fn line(x: [f64; 3], v: [f64; 3]) -> Step {
    exact::step(&State { position: x.into(), velocity: v.into() }, Vector3::zeros(), 1.0)
}

fn obstacles<'a>(plan: &'a Plan, step: &Step) -> Obstacles<'a> {
    let state = State { position: step.path.start(), velocity: step.velocity[0] };
    Obstacles::new(plan, RADIUS, &state, &Vector3::zeros())
}

/// A mesh and a ball far from it.
fn stage(vertices: Vec<Point3<f64>>, faces: Vec<[u32; 3]>) -> Plan {
    Stage::new(1.0).mesh("mesh", smooth(1.0), vertices, faces).ball([9.0, 9.0, 9.0], [0.0; 3], RADIUS).plan()
}

fn resting(site: Site, normal: Vector3<f64>) -> Contact {
    Contact { surface: 0, site: Some(site), normal, rate: 0.0, lasting: false }
}

#[test]
fn h10_of_surfaces_met_at_once_the_first_by_name_is_hit() {
    for (names, first) in [(["a", "b"], 0), (["b", "a"], 1)] {
        let floors = names
            .iter()
            .fold(Stage::new(1.0), |stage, name| stage.plane(name, smooth(1.0), [0.0, 0.0, 0.0], Vector3::z()));
        let plan = floors.ball([0.0, 0.0, 2.0], [0.0; 3], RADIUS).plan();
        let (step, mut counters) = (line([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), Counters::default());
        let mut at = obstacles(&plan, &step);
        let mut returns = Returns::new();
        at.returns(&step, &[], &mut returns, &mut counters);
        let hit = at.earliest(&step, &[], &returns, &mut counters).unwrap();
        assert_eq!((hit.f, hit.surface, hit.rate, counters.clearances), (0.5, first, Some(-1.0), 2));
        // Known contacts are asked when they are entered again, and not once more.
        let mut touching = Contacts::new();
        at.touching(
            &State { position: Point3::new(0.0, 0.0, 0.5), velocity: Vector3::z() },
            0.0,
            None,
            &mut touching,
            &mut counters,
        );
        at.returns(&step, &touching, &mut returns, &mut counters);
        assert_eq!((touching.len(), counters.clearances), (1, 3), "one normal is one contact");
    }
}

#[test]
fn a_ball_leaves_a_face_where_its_path_first_leaves_the_region() {
    let (vertices, faces) = solids::cube();
    let plan = stage(vertices, faces);
    // Face 2 is the part x > y of the top, [-1, 1]^2; its bounds come as y = -1, x = 1 and the diagonal.
    let (x, y, diagonal) = (Site::Edge { face: 2, edge: 1 }, Site::Edge { face: 2, edge: 0 }, Site::Face(3));
    let top = resting(Site::Face(2), Vector3::z());
    for (start, v, f, next) in [
        ([0.5, -0.5], [1.0, -0.75], 0.5, x),
        ([0.5, -0.5], [0.75, -1.0], 0.5, y),
        ([0.0, -0.5], [-0.5, 0.5], 0.5, diagonal),
        ([0.25, -0.5], [-1.5, -1.0], 0.5, y),
    ] {
        let step = line([start[0], start[1], 1.5], [v[0], v[1], 0.0]);
        let mut counters = Counters::default();
        let (at, bound) = obstacles(&plan, &step).exit(&step, &top, 0.0, &mut counters).unwrap();
        assert_eq!((at, bound.next, counters.clearances), (f, next, 3), "{start:?} along {v:?}");
    }
    let inside = line([0.5, -0.5, 1.5], [0.125, 0.0, 0.0]);
    assert!(obstacles(&plan, &inside).exit(&inside, &top, 0.0, &mut Counters::default()).is_none());
}

#[test]
fn the_doubt_of_a_hit_grows_with_its_face_and_the_way_to_it() {
    let (vertices, faces) = solids::cube();
    let plan = stage(vertices, faces);
    let (step, mut counters) = (line([0.5, -0.5, 3.0], [0.0, 0.0, -2.0]), Counters::default());
    let mut at = obstacles(&plan, &step);
    let mut returns = Returns::new();
    at.returns(&step, &[], &mut returns, &mut counters);
    let hit = at.earliest(&step, &[], &returns, &mut counters).unwrap();
    assert_eq!((hit.f, hit.face), (0.75, Some(2)));
    // The farthest coordinate of the face from the start is 2, and the way is 1.5.
    assert_eq!(at.doubt(&step, &hit), contact_doubt(3.5));
}

#[test]
fn a_surface_continues_over_faces_of_one_normal_however_they_are_wound() {
    let corner = |x, y, z| Point3::new(x, y, z);
    let vertices = vec![
        corner(0.0, 0.0, 0.0),
        corner(1.0, 0.0, 0.0),
        corner(1.0, 1.0, 0.0),
        corner(0.0, 1.0, 0.0),
        corner(-1.0, 1.0, 0.0),
        corner(-1.0, 0.5, 1.0),
    ];
    // 0 and 1 alike, 2 against them in the same plane, 3 out of it.
    let faces = vec![[0, 1, 2], [0, 2, 3], [0, 4, 3], [0, 4, 5]];
    let mesh = Mesh::new(vertices.clone(), faces.clone()).unwrap();
    assert_eq!(mesh.normal(2).map(|n| -n.into_inner()), mesh.normal(0).map(|n| n.into_inner()));
    let plan = stage(vertices, faces);
    let step = line([0.5, 0.5, 0.5], [0.0; 3]);
    let at = obstacles(&plan, &step);
    let continues = |here, there| at.continues(&resting(Site::Face(here), Vector3::z()), Site::Face(there));
    assert_eq!([continues(0, 1), continues(0, 2), continues(2, 1), continues(0, 3)], [true, true, true, false]);
    assert!(!at.continues(&resting(Site::Face(0), Vector3::z()), Site::Edge { face: 0, edge: 0 }));
}

#[test]
fn r28_a_ball_that_leaves_an_edge_along_a_curve_is_back_on_time() {
    // A blade with its edge along y, and a ball that goes straight up from it by v f - f^2 - d f^3 - e f^4: back where that is 0.
    let blade = vec![Point3::new(0.0, -4.0, 0.0), Point3::new(0.0, 4.0, 0.0), Point3::new(0.0, 0.0, -4.0)];
    let (back, radius) = (0.75f64, RADIUS);
    let plan = stage(blade, vec![[0, 1, 2]]);
    for (d, e) in [(0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.25, 0.25), (16.0, 16.0)] {
        let v = back + d * back.powi(2) + e * back.powi(3);
        let terms = [v, -1.0, -d, -e].map(|z| Vector3::z() * z);
        let [v1, v2, v3, v4] = [0, 1, 2, 3].map(|k| terms[k] * (k + 1) as f64);
        let path = Path::from_terms(Point3::new(0.0, 0.0, radius), &terms);
        let step = Step { path, velocity: [v1, v2, v3, v4, Vector3::zeros()], seconds: 1.0, to: 1.0, exact: true };
        let leaving = Contact { rate: v, ..resting(Site::Edge { face: 0, edge: 0 }, Vector3::z()) };
        let (mut at, mut counters) = (obstacles(&plan, &step), Counters::default());
        let mut returns = Returns::new();
        at.returns(&step, &[leaving], &mut returns, &mut counters);
        let hit = at.earliest(&step, &[leaving], &returns, &mut counters).map(|hit| hit.f);
        let early = hit.map(|f| (back - f) * (1.0 + 2.0 * back + 3.0 * d * back.powi(2) + 4.0 * e * back.powi(3) - v));
        assert!(counters.clearances > 1, "what is asked of the way off the edge is counted");
        assert!(early.is_some_and(|gap| (-1e-15..contact_doubt(8.0 + v)).contains(&gap)), "{hit:?} with {d} and {e}");
    }
}

fn plane(surface: usize, normal: Vector3<f64>, rate: f64) -> Contact {
    Contact { surface, site: None, normal, rate, lasting: false }
}

/// What the ball hits along `step`, having `contacts` where it begins.
fn first_hit(plan: &Plan, step: &Step, contacts: &[Contact]) -> Option<(f64, usize)> {
    let (mut at, mut counters) = (obstacles(plan, step), Counters::default());
    let mut returns = Returns::new();
    at.returns(step, contacts, &mut returns, &mut counters);
    at.earliest(step, contacts, &returns, &mut counters).map(|hit| (hit.f, hit.surface))
}

#[test]
fn what_a_ball_leaves_hides_nothing_that_is_before_it() {
    // From a floor far from the origin, plane or mesh, up to a shelf that is below the origin or another plane.
    let level = |z: f64| [[-4.0, -4.0, z], [4.0, -4.0, z], [0.0, 4.0, z]].map(Point3::from).to_vec();
    let step = line([0.0, 0.0, -7.5], [0.0, 0.0, 4.0]);
    let far = |stage: Stage| stage.ball([9.0, 9.0, -5.0], [0.0; 3], RADIUS).plan();
    let shelf = |stage: Stage| stage.mesh("shelf", smooth(1.0), level(-5.0), vec![[0, 1, 2]]);
    let ceiling = Stage::new(1.0).plane("ceiling", smooth(1.0), [0.0, 0.0, 9.0], Vector3::z());
    let of_plane = far(shelf(ceiling.clone().plane("floor", smooth(1.0), [0.0, 0.0, -8.0], Vector3::z())));
    let from_plane = plane(1, Vector3::z(), 4.0);
    assert_eq!(first_hit(&of_plane, &step, &[from_plane]), Some((0.5, 2)));
    let of_mesh = far(shelf(ceiling.mesh("floor", smooth(1.0), level(-8.0), vec![[0, 1, 2]])));
    let from_mesh = Contact { surface: 1, rate: 4.0, ..resting(Site::Face(0), Vector3::z()) };
    assert_eq!(first_hit(&of_mesh, &step, &[from_mesh]), Some((0.5, 2)));
}

#[test]
fn what_a_ball_leaves_of_one_mesh_says_nothing_of_another() {
    // The last face of a cube is left for a mesh that has but one.
    let (vertices, faces) = solids::cube();
    let last = faces.len() - 1;
    let lid = [[-16.0, -16.0, 4.0], [16.0, -16.0, 4.0], [0.0, 16.0, 4.0]].map(Point3::from).to_vec();
    let scene = Stage::new(1.0).mesh("lid", smooth(1.0), lid, vec![[0, 1, 2]]);
    let plan = scene.mesh("cube", smooth(1.0), vertices.clone(), faces.clone()).ball([9.0; 3], [0.0; 3], RADIUS).plan();
    let step = line([0.5, -0.5, 1.5], [0.0, 0.0, 4.0]);
    for site in [Site::Face(last as u32), Site::Face(2), Site::Face(0)] {
        let leaving = Contact { surface: 1, rate: 4.0, ..resting(site, Vector3::z()) };
        assert_eq!(first_hit(&plan, &step, &[leaving]), Some((0.5, 0)), "from {site:?}");
        // On a hop that would be back after a second, at the height of 9 f - 9 f^2, it is first at 2.
        let start = State { position: step.path.start(), velocity: Vector3::z() * 9.0 };
        let hop = exact::step(&start, Vector3::z() * -18.0, 1.0);
        let (f, surface) = first_hit(&plan, &hop, &[Contact { rate: 9.0, ..leaving }]).unwrap();
        assert!((f - 1.0 / 3.0).abs() < 1e-15 && surface == 0, "from {site:?}: {f}");
    }
    // From the edge of a blade to the same face of another.
    let blade = |z: f64| [[0.0, -4.0, z], [0.0, 4.0, z], [0.0, 0.0, 4.0 * z.signum()]].map(Point3::from).to_vec();
    let blades = Stage::new(1.0).mesh("a", smooth(1.0), blade(-1.0), vec![[0, 1, 2]]).mesh(
        "b",
        smooth(1.0),
        blade(2.0),
        vec![[0, 1, 2]],
    );
    let plan = blades.ball([9.0; 3], [0.0; 3], RADIUS).plan();
    let leaving = Contact { rate: 4.0, ..resting(Site::Edge { face: 0, edge: 0 }, Vector3::z()) };
    assert_eq!(first_hit(&plan, &line([0.0, 0.0, -0.5], [0.0, 0.0, 4.0]), &[leaving]), Some((0.5, 1)));
}

#[test]
fn h01_what_is_left_along_itself_is_not_hit_at_once_whatever_the_rounding() {
    let (vertices, faces) = solids::cube();
    let plan = stage(vertices, faces);
    // Off the edge y = -1, z = 1 and the corner at its end, tangentially in all directions: a line never comes back.
    let (edge, corner) = (Point3::new(0.0, -1.0, 1.0), Point3::new(1.0, -1.0, 1.0));
    let at = |vertex: Point3<f64>, outwards: Vector3<f64>| vertex + outwards * RADIUS;
    for k in 0..200 {
        let (s, c) = (0.031 * f64::from(k)).sin_cos();
        for (place, out) in
            [(edge, Vector3::new(0.0, -0.3 - s * 0.2, 0.5)), (corner, Vector3::new(0.3, -0.4, 0.5 + 0.2 * s))]
        {
            let n = out.normalize();
            let x = at(place, n);
            let state = State { position: x, velocity: Vector3::zeros() };
            let (mut touched, mut counters) = (Contacts::new(), Counters::default());
            let at = Obstacles::new(&plan, RADIUS, &state, &n);
            at.touching(
                &State { position: x, velocity: Vector3::zeros() },
                contact_doubt(4.0),
                None,
                &mut touched,
                &mut counters,
            );
            let [contact] = touched[..] else { panic!("{touched:?} at {x}") };
            let across = n.cross(&Vector3::x()).normalize();
            let v = across * c + n.cross(&across) * s;
            let step = line(x.into(), v.into());
            assert_eq!(first_hit(&plan, &step, &[Contact { rate: 0.0, ..contact }]), None, "{contact:?} along {v}");
        }
    }
    // Along a plane in no special position, with an acceleration along it that is rounded.
    let n = Vector3::new(0.3, -0.5, 0.7).normalize();
    let slope = Stage::new(1.0).plane("slope", smooth(1.0), [0.0; 3], n).ball([9.0; 3], [0.0; 3], RADIUS).plan();
    for k in 0..200 {
        let (s, c) = (0.031 * f64::from(k)).sin_cos();
        let [u, w] = [Vector3::x(), Vector3::y()].map(|e| e - n * n.dot(&e));
        let state = State { position: Point3::from(n * RADIUS), velocity: u * c + w * s };
        let step = exact::step(&state, w * c - u * s, 1.0);
        assert_eq!(first_hit(&slope, &step, &[plane(0, n, 0.0)]), None, "along {}", state.velocity);
    }
}

#[test]
fn a_path_that_does_not_begin_with_the_velocity_leaves_at_its_own_slope() {
    let plan = Stage::new(1.0).floor(smooth(1.0)).ball([0.0, 0.0, 2.0], [0.0; 3], RADIUS).plan();
    // The semi-implicit method moves with v + a h: up at 4 - 2 it is gone, at 4 - 8 it is back at once, and that fast.
    let state = State { position: Point3::new(0.0, 0.0, RADIUS), velocity: Vector3::z() * 4.0 };
    for (g, expected) in [(8.0, None), (32.0, Some((0.0, -1.0)))] {
        let step = euler::semi_implicit(&state, Vector3::z() * -g, 0.25);
        let (mut at, mut counters) = (obstacles(&plan, &step), Counters::default());
        let leaving = [plane(0, Vector3::z(), 4.0)];
        let mut returns = Returns::new();
        at.returns(&step, &leaving, &mut returns, &mut counters);
        let hit = at.earliest(&step, &leaving, &returns, &mut counters);
        assert_eq!(hit.map(|hit| (hit.f, hit.rate.unwrap())), expected, "g = {g}");
    }
}

#[test]
fn contacts_are_one_where_the_tolerance_makes_their_normals_so_and_eight_at_most() {
    let (tolerance, angle) = (1e-9, 1e-6);
    let tilted = Vector3::new(angle, 0.0, 1.0).normalize();
    let touched = |stage: Stage| {
        let plan = stage.ball([0.0, 0.0, 2.0], [0.0; 3], RADIUS).plan();
        let step = line([0.0, 0.0, RADIUS], [0.0; 3]);
        let still = State { position: step.path.start(), velocity: Vector3::zeros() };
        let mut touched = Contacts::new();
        obstacles(&plan, &step).touching(&still, tolerance, None, &mut touched, &mut Counters::default());
        touched
    };
    let sharp = |x: f64| [[x, -4.0, 0.0], [x, 4.0, 0.0], [x, 0.0, -4.0]].map(Point3::from).to_vec();
    let blade = |stage: Stage, name: &str, x: f64| stage.mesh(name, smooth(1.0), sharp(x), vec![[0, 1, 2]]);
    let floor = Stage::new(1.0).floor(smooth(1.0));
    // Two planes are two, whatever the angle; two edges side by side, or an edge in a plane, are one.
    assert_eq!(touched(floor.clone().plane("tilted", smooth(1.0), [0.0; 3], tilted)).len(), 2);
    assert_eq!(touched(blade(blade(Stage::new(1.0), "a", 0.0), "b", -angle * RADIUS)).len(), 1);
    assert_eq!(touched(blade(floor, "b", -angle * RADIUS)).len(), 1);
    // A ball in a cone of twelve planes.
    let cone = (0..12).fold(Stage::new(20.0), |stage, k| {
        let (s, c) = (std::f64::consts::TAU * f64::from(k) / 12.0).sin_cos();
        let n = Vector3::new(0.6 * c, 0.6 * s, 0.8);
        stage.plane(&format!("side {k}"), smooth(0.5), Point3::new(0.0, 0.0, RADIUS) - n * RADIUS, n)
    });
    assert_eq!(touched(cone.clone()).len(), MAX_CONTACTS);
    // Dropped into it, it comes to rest.
    let end = cone.down(8.0).ball([0.0, 0.0, 2.0], [0.0; 3], RADIUS).run().outcome;
    assert_eq!((end.motion, end.state.velocity), (Motion::Resting, Vector3::zeros()));
    assert!((end.state.position - Point3::new(0.0, 0.0, RADIUS)).norm() < 1e-11, "{}", end.state.position);
}

#[test]
fn a_contact_knows_its_radius_its_shape_its_gap_and_its_hollows() {
    let (vertices, faces) = solids::cube();
    let scene = Stage::new(1.0).mesh("cube", smooth(1.0), vertices.clone(), faces.clone());
    let plan = scene.plane("floor", smooth(1.0), [0.0, 0.0, -4.0], Vector3::z()).ball([9.0; 3], [0.0; 3], 0.0).plan();
    let mesh = Mesh::new(vertices, faces).unwrap();
    let edge = Site::Edge { face: 2, edge: 0 };
    let (face, edge) = (resting(Site::Face(2), Vector3::z()), resting(edge, Vector3::z()));
    let floor = plane(1, Vector3::z(), 0.0);
    let state = State { position: Point3::new(0.0, 0.0, 4.0), velocity: Vector3::zeros() };
    // A point meets planes as what it is, and meshes as the ball that stands for it.
    for (radius, at_meshes) in [(0.0, plan.radius_at_meshes(&plan.balls()[0])), (RADIUS, RADIUS)] {
        let at = Obstacles::new(&plan, radius, &state, &Vector3::zeros());
        assert_eq!([face, edge, floor].map(|c| at.radius_at(&c)), [at_meshes, at_meshes, radius]);
        // Above the top, z = 1, by 3; above the floor by 8; from the edge y = -1, z = 1 the diagonal of 4 and 3.
        let over = Point3::new(0.0, 3.0, 4.0);
        assert_eq!(at.gap(&face, &over), Some(3.0 - at_meshes));
        assert_eq!(at.gap(&edge, &over), Some(5.0 - at_meshes));
        assert_eq!(at.gap(&floor, &over), Some(8.0 - radius));
        assert_eq!([face, edge, floor].map(|c| at.bend(&c)), [Bend::Flat, mesh.bend(edge.site.unwrap()), Bend::Flat]);
    }
    // The edge of a cube is a ridge from outside and a hollow from inside; its diagonals are neither.
    let at = Obstacles::new(&plan, RADIUS, &state, &Vector3::zeros());
    let hollow = |normal: Vector3<f64>, edge: u8| at.is_hollow(&resting(Site::Face(2), normal), 2, edge);
    assert_eq!([0, 1, 2].map(|edge| hollow(Vector3::z(), edge)), [false; 3]);
    assert_eq!([0, 1, 2].map(|edge| hollow(-Vector3::z(), edge)), [true, true, false]);
}
