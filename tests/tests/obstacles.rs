//! One ball among surfaces of which everything is known: which it meets first, where it leaves what it touches, and in how much doubt.

use carom_dynamics::body::State;
use carom_dynamics::collision::Obstacles;
use carom_dynamics::contacts::Contact;
use carom_dynamics::counters::Counters;
use carom_dynamics::integrators::{Step, exact};
use carom_dynamics::plan::Plan;
use carom_geometry::mesh::Mesh;
use carom_geometry::path::Path;
use carom_geometry::rounding::contact_doubt;
use carom_geometry::site::Site;
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
        let returns = at.returns(&step, &[], &mut counters);
        let hit = at.earliest(&step, &[], &returns, &mut counters).unwrap();
        assert_eq!((hit.f, hit.surface, hit.rate, counters.clearances), (0.5, first, Some(-1.0), 2));
        // Known contacts are asked when they are entered again, and not once more.
        let touching = at.touching(&Point3::new(0.0, 0.0, 0.5), &Vector3::z(), 0.0, None, &mut counters);
        at.returns(&step, &touching, &mut counters);
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
    let returns = at.returns(&step, &[], &mut counters);
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
        let returns = at.returns(&step, &[leaving], &mut counters);
        let hit = at.earliest(&step, &[leaving], &returns, &mut counters).map(|hit| hit.f);
        let early = hit.map(|f| (back - f) * (1.0 + 2.0 * back + 3.0 * d * back.powi(2) + 4.0 * e * back.powi(3) - v));
        assert!(early.is_some_and(|gap| (-1e-15..contact_doubt(8.0 + v)).contains(&gap)), "{hit:?} with {d} and {e}");
    }
}
