//! The first contact of a ball with a mesh is that of the triangle it touches first, bit for bit, and what it touches is what is near.

use carom_geometry::closest::closest_point;
use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::mesh::Mesh;
use carom_geometry::path::Path;
use carom_geometry::rounding::point_radius;
use carom_geometry::sweep::{FirstContact, Work};
use carom_tests::obj;
use carom_tests::random::Random;
use nalgebra::{Point3, Vector3};

const SCENES: [(&str, &str); 5] = [
    ("spot", include_str!("../../crates/app/scenes/meshes/spot_triangulated.obj")),
    ("bunny", include_str!("../../crates/app/scenes/meshes/low_poly_bunny.obj")),
    ("stairs", include_str!("../../crates/app/scenes/meshes/stairs.obj")),
    ("terrain", include_str!("../../crates/app/scenes/meshes/bullet_terrain.obj")),
    ("jacksboro", include_str!("../../crates/app/scenes/meshes/jacksboro_dem_quarter.obj")),
];

fn scene(text: &str) -> Mesh {
    let (vertices, faces) = obj::read(text);
    Mesh::new(vertices, faces).unwrap()
}

/// The first contact by asking every face.
fn brute_force(mesh: &Mesh, ball: &MovingBall, to: f64) -> Option<FirstContact> {
    let mut best: Option<FirstContact> = None;
    for face in 0..mesh.faces().len() as u32 {
        if let Contact::At { f, .. } = first_contact(ball, &mesh.triangle(face), 0.0, to, &mut 0)
            && best.is_none_or(|found| f < found.f)
        {
            best = Some(FirstContact { f, face });
        }
    }
    best
}

/// A path from around the mesh, in or out of it, towards a point of it or near it: straight, a parabola or a quartic.
fn aimed(random: &mut Random, mesh: &Mesh, degree: usize) -> Path {
    let (centre, extent) = (mesh.bounds().centre(), mesh.bounds().extent());
    let size = extent.amax();
    let start = centre + random.vector(1.0).component_mul(&extent) + random.vector(0.2 * size);
    let face = random.below(mesh.faces().len()) as u32;
    let target = random.in_triangle(&mesh.triangle(face)) + random.vector(0.05 * size) * random.octave(-10, 0);
    let overshoot = random.octave(-1, 2);
    let mut terms: Vec<Vector3<f64>> = (1..degree).map(|_| random.vector(size)).collect();
    // So that the path is at the target at f = 1 / overshoot.
    let f = 1.0 / overshoot;
    let further = terms.iter().rev().fold(Vector3::zeros(), |sum, t| (sum + t) * f) * f;
    terms.insert(0, (target - start - further) / f);
    Path::from_terms(start, &terms)
}

#[derive(Default)]
struct Tally { cases: u32, hits: u32, bad: u32 }

fn compare(name: &str, mesh: &Mesh, path: &Path, radius: f64, tally: &mut Tally) {
    let ball = MovingBall { path, radius, holds: &[] };
    let want = brute_force(mesh, &ball, 1.0);
    let mut work = Work::default();
    let got = mesh.first_contact(&ball, 1.0, |_| 0.0, &mut work);
    tally.cases += 1;
    tally.hits += u32::from(want.is_some());
    if got != want {
        tally.bad += 1;
        println!("{name} deg {} r={radius:e}: got {got:?} want {want:?} diff {:?}", path.terms().len(), got.zip(want).map(|(a,b)| a.f-b.f));
    }
}

#[test]
fn explore_scenes() {
    let mut random = Random::new(7);
    for (name, text) in SCENES {
        let mesh = scene(text);
        let size = mesh.bounds().extent().amax();
        let n = (400_000 / mesh.faces().len()).clamp(40, 4000);
        for degree in [1, 2, 4] {
            let mut tally = Tally::default();
            let t0 = std::time::Instant::now();
            for _ in 0..n {
                let path = aimed(&mut random, &mesh, degree);
                let least = point_radius(mesh.vertices().iter().fold(0.0, |m, v| f64::max(m, v.coords.amax())));
                let radius = if random.unit() < 0.2 { least } else { size * random.octave(-16, -2) };
                compare(name, &mesh, &path, radius, &mut tally);
            }
            println!("{name} degree {degree}: {} cases {} hits {} bad {:?}", tally.cases, tally.hits, tally.bad, t0.elapsed());
        }
    }
}

#[test]
fn explore_lattice() {
    // ties: a flat and a stepped grid with integer coordinates, balls over lattice points and edges
    let n = 12u32;
    for bumpy in [false, true] {
        let at = |k: u32| Point3::new(f64::from(k % (n + 1)), f64::from(k / (n + 1)), if bumpy { f64::from((k * 7 + k / 5) % 3) } else { 0.0 });
        let square = |k: u32| { let a = k / n * (n + 1) + k % n; [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]] };
        let mesh = Mesh::new((0..(n + 1) * (n + 1)).map(at).collect(), (0..n * n).flat_map(square).collect()).unwrap();
        let mut random = Random::new(3);
        for degree in [1, 2, 4] {
            let mut tally = Tally::default();
            for _ in 0..3000 {
                let half = |random: &mut Random, n: usize| random.below(n) as f64 / 2.0;
                let start = Point3::new(half(&mut random, 26) , half(&mut random, 26), half(&mut random, 12) + 0.25);
                let mut terms = vec![Vector3::new(half(&mut random, 21) - 5.0, half(&mut random, 21) - 5.0, half(&mut random, 21) - 8.0)];
                if degree > 1 { terms.push(Vector3::new(0.0, 0.0, -4.0)); }
                if degree > 2 { terms.push(Vector3::new(1.0, 0.0, -2.0)); terms.push(Vector3::new(0.5, 0.25, 1.0)); }
                let path = Path::from_terms(start, &terms);
                let radius = [0.25, 0.5, 1.0, 0.1, 1.0 / 3.0, point_radius(12.0)][random.below(6)];
                compare("lattice", &mesh, &path, radius, &mut tally);
            }
            println!("lattice bumpy {bumpy} degree {degree}: {} cases {} hits {} bad", tally.cases, tally.hits, tally.bad);
        }
    }
}
