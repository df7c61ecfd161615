//! The first contact of a ball with a mesh is that of the triangle it touches first, bit for bit, and what it touches is what is near.

use carom_geometry::closest::{Feature, closest_point};
use carom_geometry::contact::{Contact, MovingBall, first_contact};
use carom_geometry::mesh::Mesh;
use carom_geometry::path::Path;
use carom_geometry::rounding::{UNIT_ROUNDOFF, contact_doubt, point_radius};
use carom_geometry::site::Site;
use carom_geometry::sweep::{FirstContact, Surroundings, Work};
use carom_tests::obj;
use carom_tests::random::Random;
use nalgebra::{Point3, Vector3};
use std::collections::BTreeSet;

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

/// The first contact by asking every face, and how many faces are met at the same f.
fn brute_force(mesh: &Mesh, ball: &MovingBall, to: f64) -> (Option<FirstContact>, u32) {
    let (mut best, mut ties): (Option<FirstContact>, u32) = (None, 0);
    for face in 0..mesh.faces().len() as u32 {
        let Contact::At { f, .. } = first_contact(ball, &mesh.triangle(face), 0.0, to, &mut 0) else { continue };
        match best {
            Some(found) if found.f < f => {}
            Some(found) if found.f == f => ties += 1,
            _ => (best, ties) = (Some(FirstContact { f, face }), 1),
        }
    }
    (best, ties)
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

/// How a series of queries went.
#[derive(Debug, Default)]
struct Tally {
    cases: u32,
    hits: u32,
    /// Hits at which two faces or more are met at the very same f.
    ties: u32,
    /// Hits at which something is found to be touched.
    touches: u32,
}

impl Tally {
    /// Asks both ways and fails on the first bit that differs; and what is touched there, of what the search has left and of the tree.
    fn compare(&mut self, mesh: &Mesh, path: &Path, radius: f64, to: f64) {
        let ball = MovingBall { path, radius, holds: &[] };
        let (want, ties) = brute_force(mesh, &ball, to);
        let extent = mesh.bounds().extent().amax() + path.start().coords.amax() + radius;
        let (mut around, mut work) = (Surroundings::new(extent), Work::default());
        let got = mesh.first_contact_around(&ball, to, |_| 0.0, &mut around, &mut work);
        assert_eq!(got, want, "r = {radius:e}, to {to}, {path:?}");
        if let Some(FirstContact { f, .. }) = got {
            let (centre, heading, tolerance) = (path.at(f), path.derivative(f), contact_doubt(extent));
            let nodes = work.nodes;
            let known = mesh.touches_at(f, &around, &centre, &heading, radius, tolerance, &mut work);
            assert_eq!(work.nodes, nodes, "the tree is not asked again");
            let all = mesh.touches(&centre, &heading, radius, tolerance, &mut work);
            assert_eq!(known, all, "r = {radius:e}, to {to}, {path:?}");
            self.touches += u32::from(!all.is_empty());
        }
        self.cases += 1;
        self.hits += u32::from(want.is_some());
        self.ties += u32::from(ties > 1);
    }
}

#[test]
fn h06_first_contacts_with_the_scene_meshes_are_those_of_brute_force() {
    let mut random = Random::new(7);
    for (name, text) in SCENES {
        let mesh = scene(text);
        let size = mesh.bounds().extent().amax();
        let farthest = mesh.vertices().iter().fold(0.0, |m, v| f64::max(m, v.coords.amax()));
        // Quartics take ten times as long.
        for (degree, work) in [(1, 400_000), (2, 400_000), (4, 50_000)] {
            let mut tally = Tally::default();
            for _ in 0..(work / mesh.faces().len()).clamp(8, 1000) {
                let path = aimed(&mut random, &mesh, degree);
                let points = random.below(5) == 0;
                let radius = if points { point_radius(farthest) } else { size * random.octave(-16, -2) };
                tally.compare(&mesh, &path, radius, if random.below(4) == 0 { random.unit() } else { 1.0 });
            }
            println!("{name}, degree {degree}: {tally:?}");
            assert!(tally.hits * 3 > tally.cases, "too few hits prove little: {tally:?}");
            assert!(tally.touches * 20 > tally.hits * 19, "a hit is a touch: {tally:?}");
        }
    }
}

#[test]
fn h06_ties_between_neighbours_go_to_the_lowest_face() {
    // A flat and a rugged grid with integer coordinates: balls meet several faces at once, at edges and at vertices.
    const N: u32 = 12;
    let square = |k: u32| {
        let a = k / N * (N + 1) + k % N;
        [[a, a + 1, a + N + 2], [a, a + N + 2, a + N + 1]]
    };
    for rugged in [0, 1] {
        let height = |k: u32| f64::from(rugged * ((k * 7 + k / 5) % 3));
        let at = |k: u32| Point3::new(f64::from(k % (N + 1)), f64::from(k / (N + 1)), height(k));
        let vertices = (0..(N + 1) * (N + 1)).map(at).collect();
        let mesh = Mesh::new(vertices, (0..N * N).flat_map(square).collect()).unwrap();
        let mut random = Random::new(3);
        for degree in [1, 2, 4] {
            let mut tally = Tally::default();
            for _ in 0..if degree == 4 { 600 } else { 3000 } {
                let mut half = |n: usize| random.below(n) as f64 / 2.0;
                let start = Point3::new(half(26), half(26), half(12) + 0.25);
                let falling = Vector3::new(half(21) - 5.0, half(21) - 5.0, half(21) - 8.0);
                let further =
                    [Vector3::new(0.0, 0.0, -4.0), Vector3::new(1.0, 0.0, -2.0), Vector3::new(0.5, 0.25, 1.0)];
                let terms: Vec<_> = std::iter::once(falling).chain(further).take(degree).collect();
                let radius = [0.25, 0.5, 1.0, 0.1, 1.0 / 3.0, point_radius(f64::from(N))][random.below(6)];
                tally.compare(&mesh, &Path::from_terms(start, &terms), radius, 1.0);
            }
            println!("grid, rugged {rugged}, degree {degree}: {tally:?}");
            assert!(tally.ties * 20 > tally.hits, "the case is too easy: {tally:?}");
        }
    }
}

/// What of the mesh is within `reach` of `centre`, each place once, by asking every face; and nothing that is the border of another.
fn distance_by_brute_force(mesh: &Mesh, centre: &Point3<f64>) -> f64 {
    let distance = |face: u32| {
        let local = mesh.triangle(face).map(|v| Point3::from(v - centre));
        closest_point(&local, &Point3::origin()).offset.norm()
    };
    (0..mesh.faces().len() as u32).map(distance).fold(f64::INFINITY, f64::min)
}

fn touched_by_brute_force(mesh: &Mesh, centre: &Point3<f64>, reach: f64) -> BTreeSet<Site> {
    let mut sites = BTreeSet::new();
    for face in 0..mesh.faces().len() as u32 {
        let closest = closest_point(&mesh.triangle(face).map(|v| Point3::from(v - centre)), &Point3::origin());
        if closest.offset.norm() <= reach {
            sites.insert(match closest.feature {
                Feature::Face => Site::Face(face),
                Feature::Edge(side) => {
                    let (face, edge) = mesh.edge(face, side.into()).owner;
                    Site::Edge { face, edge: edge as u8 }
                }
                Feature::Vertex(corner) => {
                    let vertex = mesh.faces()[face as usize][usize::from(corner)];
                    Site::Vertex { vertex, face: mesh.vertex_faces(vertex)[0] }
                }
            });
        }
    }
    let faces = |site: &Site| mesh.faces_at(*site);
    let larger = |site: &Site, other: &Site| match (site, other) {
        (Site::Edge { .. } | Site::Vertex { .. }, Site::Face(face)) => faces(site).contains(face),
        (Site::Vertex { vertex, .. }, Site::Edge { face, edge }) => {
            mesh.edge(*face, (*edge).into()).vertices.contains(vertex)
        }
        _ => false,
    };
    sites.iter().filter(|site| !sites.iter().any(|other| larger(site, other))).copied().collect()
}

#[test]
fn h28_touches_are_those_of_brute_force() {
    let mut random = Random::new(11);
    for (name, text) in SCENES {
        let mesh = scene(text);
        let size = mesh.bounds().extent().amax();
        let mut touching = 0;
        for _ in 0..(600_000 / mesh.faces().len()).clamp(40, 2000) {
            let face = random.below(mesh.faces().len()) as u32;
            let corners = mesh.triangle(face);
            let on = if random.below(4) == 0 { corners[random.below(3)] } else { random.in_triangle(&corners) };
            // As a hit leaves it: at the distance of the mesh, but for rounding.
            let centre = on + random.vector(1.0).normalize() * (size * random.octave(-12, -2));
            let distance = distance_by_brute_force(&mesh, &centre);
            let radius = distance * (1.0 + f64::from(random.below(5) as u32) * UNIT_ROUNDOFF);
            let tolerance = radius * random.octave(-46, -40);
            let touches = mesh.touches(&centre, &nalgebra::Vector3::zeros(), radius, tolerance, &mut Work::default());
            let sites: Vec<Site> = touches.iter().map(|touch| touch.site).collect();
            let want: Vec<Site> = touched_by_brute_force(&mesh, &centre, radius + tolerance).into_iter().collect();
            assert_eq!(sites, want, "r = {radius:e} + {tolerance:e} at {centre}");
            for touch in touches {
                assert!((touch.normal.norm() - 1.0).abs() <= 8.0 * UNIT_ROUNDOFF);
                let (foot, _) = mesh.foot(touch.site, &centre).unwrap();
                assert!(touch.normal.dot(&(centre - foot)) > 0.0, "{touch:?} points away from the ball");
            }
            touching += usize::from(!sites.is_empty());
        }
        println!("{name}: {touching} balls touch it");
        assert!(touching > 10);
    }
}

#[test]
fn h03_grazes_beside_the_whole_mesh_are_those_of_brute_force() {
    // A square of two faces; the ball flies by, beside its rim or above it, by a few roundings more or less than its radius.
    let vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
    let mesh = Mesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let mut tally = Tally::default();
    for radius in [0.5, 0.25, 1.0 / 3.0] {
        for rounding in -400..400 {
            let beside = -radius - f64::from(rounding) * UNIT_ROUNDOFF;
            let line = Path::line(Point3::new(0.25, beside, 2.0), Vector3::new(0.25, 0.0, -4.0));
            tally.compare(&mesh, &line, radius, 1.0);
            let rising = Path::parabola(
                Point3::new(0.25, 0.25, 1.0 - beside),
                Vector3::new(0.5, 0.0, -4.0),
                Vector3::new(0.0, 0.0, 4.0),
            );
            tally.compare(&mesh, &rising, radius, 1.0);
        }
    }
    println!("grazes: {tally:?}");
    assert!(tally.hits > 0 && tally.hits < tally.cases);
}
