//! Segments against the terrain, by Carom, by parry3d-f64 and, where it is installed, by Embree.

use crate::{RUNS, Row, embree, parry};
use carom_benches::clock::seconds;
use carom_benches::scenes::Result;
use carom_benches::segments::{Segment, long, short, sorted};
use carom_benches::terrain::{SQUARES, terrain};
use carom_geometry::mesh::Mesh;
use carom_geometry::sweep::Work;
use std::hint::black_box;

/// Segments of one kind.
const COUNT: usize = 100_000;

/// Squares along a side for which the terrain has 999 698 triangles.
const MANY_SQUARES: u32 = 707;

/// A row for each kind of segments and each peer, on either terrain.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for squares in [SQUARES, MANY_SQUARES] {
        let (vertices, faces) = terrain(squares);
        let kinds = [
            ("short segments, random order", short(COUNT)),
            ("short segments, sorted", sorted(short(COUNT))),
            ("long segments, random order", long(COUNT)),
            ("long segments, sorted", sorted(long(COUNT))),
        ];
        let sets: Vec<&[Segment]> = kinds.iter().map(|(_, segments)| segments.as_slice()).collect();
        let embree = embree::segments(&vertices, &faces, &sets, RUNS)?;
        let theirs = parry::Obstacle::new(&vertices, &faces)?;
        let mesh = Mesh::new(vertices, faces)?;
        for (k, (kind, segments)) in kinds.iter().enumerate() {
            let work = format!("{kind}, against {} triangles", mesh.faces().len());
            let (ours, parry) = by_turns(&mesh, &theirs, segments);
            let row = |peer, theirs| Row { work: work.clone(), unit: "ns", carom: ours, peer, theirs: Some(theirs) };
            rows.push(row("parry3d-f64, not certified", parry));
            rows.extend(embree.as_ref().map(|times| row("Embree 3, f32, robust mode", times[k])));
        }
    }
    Ok(rows)
}

/// The time in ns of a segment by Carom and by parry, by turns, so that both have the same neighbours on the machine.
fn by_turns(mesh: &Mesh, theirs: &parry::Obstacle, segments: &[Segment]) -> (f64, f64) {
    let ours = || {
        let hits = |(from, along): &Segment| mesh.first_pierced(from, &(from + along), &mut Work::default()).is_some();
        segments.iter().filter(|s| hits(s)).count()
    };
    let others = || segments.iter().filter(|(from, along)| theirs.segment(from, along).is_some()).count();
    eprintln!("segments: Carom meets {}, parry {} of {}", ours(), others(), segments.len());
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for _ in 0..RUNS {
        a.push(seconds(|| _ = black_box(ours())));
        b.push(seconds(|| _ = black_box(others())));
    }
    let each = |mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        1.0e9 * times[RUNS / 2] / segments.len() as f64
    };
    (each(a), each(b))
}
