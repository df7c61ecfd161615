//! Segments against the terrain: Carom, certified, beside parry3d in f64 and Embree's robust mode in f32, which are not.

use crate::{RUNS, Row, embree::Embree, parry};
use carom_benches::clock::seconds;
use carom_benches::random::Random;
use carom_benches::scenes::Result;
use carom_benches::terrain::{HALF, height, terrain};
use carom_geometry::mesh::Mesh;
use carom_geometry::sweep::Work;
use nalgebra::{Point3, Vector3};
use std::hint::black_box;

/// Where each begins, and how far it goes.
pub type Segments = Vec<(Point3<f64>, Vector3<f64>)>;

/// Segments of a set.
const COUNT: usize = 100_000;

/// The sets: a metre, which is a bounce or so, and longer than the hills are; in random order, and neighbours together.
const SETS: [&str; 4] = ["short", "short, sorted", "long", "long, sorted"];

/// The rows of the terrain of `squares` x `squares` squares.
pub fn rows(squares: u32, embree: Option<&Embree>) -> Result<Vec<Row>> {
    let (vertices, faces) = terrain(squares);
    let sets = [short(), sorted(short()), long(), sorted(long())];
    let embree = embree.map(|embree| embree.times(&vertices, &faces, &sets)).transpose()?;
    let parry = parry::Obstacle::new(&vertices, &faces)?;
    let triangles = faces.len();
    let mesh = Mesh::new(vertices, faces)?;
    let mut rows = Vec::new();
    for (k, segments) in sets.iter().enumerate() {
        let meets = |(from, along): &(Point3<f64>, Vector3<f64>)| {
            mesh.first_pierced(from, &(from + along), &mut Work::default()).is_some()
        };
        let ours = || segments.iter().filter(|s| meets(s)).count();
        let theirs = || segments.iter().filter(|(from, along)| parry.segment(from, along).is_some()).count();
        let (hits, of_parry) = (ours(), theirs());
        let of_embree = embree.as_ref().and_then(|sets| sets.get(k));
        eprintln!(
            "{triangles} triangles, {}: Carom meets {hits}, parry {of_parry}, Embree {:?} of {COUNT}",
            SETS[k],
            of_embree.map(|(_, hits)| hits)
        );
        // By turns, so that both have the same neighbours on the machine.
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for _ in 0..RUNS {
            a.push(seconds(|| _ = black_box(ours())));
            b.push(seconds(|| _ = black_box(theirs())));
        }
        a.sort_by(f64::total_cmp);
        b.sort_by(f64::total_cmp);
        let each = |seconds: f64| 1.0e9 * seconds / COUNT as f64;
        let row = |peer, theirs| Row {
            work: format!("segments against {triangles} triangles, {}, certified", SETS[k]),
            unit: "ns",
            carom: each(a[RUNS / 2]),
            peer,
            theirs: Some(each(theirs)),
        };
        rows.push(row("parry3d-f64, not certified", b[RUNS / 2]));
        if let Some((seconds, _)) = of_embree {
            rows.push(row("Embree, robust, f32, not certified", *seconds));
        }
    }
    Ok(rows)
}

/// From half a metre above the terrain, a metre down or so.
fn short() -> Segments {
    let mut random = Random::new(3);
    let mut one = || {
        let (x, y) = (random.within(1.0 - HALF, HALF - 1.0), random.within(1.0 - HALF, HALF - 1.0));
        let along = random.vector(0.6);
        (Point3::new(x, y, height(x, y) + 0.5), Vector3::new(along.x, along.y, -1.0))
    };
    (0..COUNT).map(|_| one()).collect()
}

/// From above the hills to a point below them somewhere else, up to 10 m along each axis away.
fn long() -> Segments {
    let mut random = Random::new(4);
    let mut one = || {
        let (x, y) = (random.within(1.0 - HALF, HALF - 1.0), random.within(1.0 - HALF, HALF - 1.0));
        let along = random.vector(10.0);
        (Point3::new(x, y, 1.0), Vector3::new(along.x, along.y, -2.0))
    };
    (0..COUNT).map(|_| one()).collect()
}

/// The segments in the order of a curve through their starts that fills the plane (G. M. Morton, 1966).
fn sorted(mut segments: Segments) -> Segments {
    const CELLS: f64 = 1024.0;
    let cell = |x: f64| ((x + HALF) / (2.0 * HALF) * CELLS) as u32;
    let place = |(from, _): &(Point3<f64>, Vector3<f64>)| {
        let (x, y) = (cell(from.x), cell(from.y));
        (0..10).fold(0, |code, bit| code | (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1))
    };
    segments.sort_by_key(place);
    segments
}
