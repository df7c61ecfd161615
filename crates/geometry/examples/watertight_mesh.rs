//! Questions to a closed triangle mesh: is it sound, what is nearest, and does anything slip through between two triangles?
//!
//! `cargo run -p carom-geometry --example watertight_mesh`

use carom_geometry::bvh::FatSegment;
use carom_geometry::closest::closest_point;
use carom_geometry::doctor::{Severity, diagnose};
use carom_geometry::mesh::{Mesh, MeshError};
use carom_geometry::nalgebra::Point3;
use carom_geometry::segment::{SegmentHit, segment_hits_triangle};

fn main() -> Result<(), MeshError> {
    // A tetrahedron with corners that no f64 but these has.
    let corners = [[0.1, 0.2, 0.3], [2.7, 0.1, 0.4], [0.9, 2.3, 0.2], [1.1, 0.8, 1.9]];
    let vertices = corners.map(Point3::from).to_vec();
    let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let findings = diagnose(&vertices, &faces);
    assert!(findings.iter().all(|finding| finding.severity() < Severity::Warning), "{findings:?}");
    let mesh = Mesh::new(vertices, faces)?;
    assert!(mesh.edges().all(|edge| edge.count == 2), "closed: every edge has two faces");

    // The nearest point of the surface, by asking every face; for one question that is enough.
    let outside = Point3::new(3.0, 3.0, 3.0);
    let distance = |face: u32| (closest_point(&mesh.triangle(face), &outside).point - outside).norm();
    let nearest = (0..4).min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(0);
    println!("the nearest face is {nearest}, {:.6} m away", distance(nearest));

    // From a point inside, every way out meets the surface: also those aimed at edges and corners, where a test that first rounds the
    // point at which it meets the plane lets one in ten through.
    let inside = Point3::new(1.2, 0.9, 0.7);
    let (mut aimed, mut met) = (0, 0);
    for edge in mesh.edges() {
        let [a, b] = edge.vertices.map(|v| mesh.vertices()[v as usize]);
        for k in 0..=1000 {
            let at = a + (b - a) * (f64::from(k) / 1000.0);
            let far = inside + (at - inside) * 4.0;
            aimed += 1;
            met += u32::from(hits(&mesh, &inside, &far) > 0);
        }
    }
    println!("{met} of {aimed} segments through the edges meet the surface");
    assert_eq!(met, aimed);

    // How often a segment to a point outside meets the surface tells on which side its start is.
    let beyond = Point3::new(5.0, 4.0, 6.0);
    assert_eq!((hits(&mesh, &inside, &beyond) % 2, hits(&mesh, &outside, &beyond) % 2), (1, 0));
    Ok(())
}

/// How many faces the segment meets; the tree over their boxes leaves most of them out.
fn hits(mesh: &Mesh, from: &Point3<f64>, to: &Point3<f64>) -> u32 {
    let mut hits = 0;
    mesh.bvh().visit(&FatSegment { from: *from, to: *to, radius: 0.0 }, |face| {
        hits += u32::from(segment_hits_triangle(from, to, &mesh.triangle(face)) != SegmentHit::Miss);
        // Up to the end: all of them are wanted, and not the first.
        1.0
    });
    hits
}
