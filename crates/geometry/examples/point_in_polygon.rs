//! Where points lie in a concave polygon: inside, outside, or exactly on an edge or a vertex; and what is no polygon.
//!
//! `cargo run -p carom-geometry --example point_in_polygon`

use carom_geometry::error::PolygonError;
use carom_geometry::inside::Location;
use carom_geometry::nalgebra::Point3;
use carom_geometry::polygon::Polygon;

fn main() -> Result<(), PolygonError> {
    // A swimming pool in the form of an L, in metres.
    let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 9.0], [0.0, 9.0]];
    let pool = Polygon::new(corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec())?;
    println!("an L of {} m^2, concave at its corners {:?}", pool.area(), pool.reflex_vertices());
    assert_eq!((pool.area(), pool.reflex_vertices()), (60.0, &[3][..]));

    // Signs of determinants are decided exactly, so that "on the edge" means on the edge and not near it.
    let nudge = 2f64.powi(-52);
    for (x, y, expected) in [
        (2.0, 7.0, Location::Inside),
        (7.0, 7.0, Location::Outside),
        (4.0, 6.5, Location::OnEdge(3)),
        (4.0 + 4.0 * nudge, 6.5, Location::Outside),
        (4.0 - 4.0 * nudge, 6.5, Location::Inside),
        (4.0, 4.0, Location::OnVertex(3)),
    ] {
        let found = pool.locate(&Point3::new(x, y, 0.0));
        println!("({x:?}, {y:?}) is {found:?}");
        assert_eq!(found, expected);
    }

    // The triangles that cover it, for whoever draws it.
    println!("triangles: {:?}", pool.triangulate());

    // What crosses itself has no inside, and is refused with its place.
    let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    let refused = Polygon::new(bow_tie.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec());
    println!("a bow-tie: {}", refused.as_ref().map_or_else(ToString::to_string, |_| "a polygon".to_owned()));
    assert!(matches!(refused, Err(PolygonError::EdgesCross { .. })));
    Ok(())
}
