//! Reading the test data that lies in `tests/data`.

use carom_geometry::triangle::Feature;
use std::path::PathBuf;

/// The text of a file in `tests/data`; panics with its name if it cannot be read.
pub fn read(path: &str) -> String {
    let full: PathBuf = [env!("CARGO_MANIFEST_DIR"), "data", path].iter().collect();
    std::fs::read_to_string(&full).unwrap_or_else(|e| panic!("{}: {e}", full.display()))
}

/// The rows of a table without quotes, each split at its commas; the header is checked and left out.
pub fn csv(path: &str, header: &str) -> Vec<Vec<String>> {
    let text = read(path);
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(header), "header of {path}");
    lines.map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// The number in a cell; panics with the cell if it is none.
pub fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|e| panic!("{cell:?}: {e}"))
}

/// What the tables of cases call a part of a triangle.
pub fn feature_name(feature: Feature) -> &'static str {
    match feature {
        Feature::Face => "face",
        Feature::Edge(0) => "edgeAB",
        Feature::Edge(1) => "edgeBC",
        Feature::Edge(_) => "edgeCA",
        Feature::Vertex(0) => "vertexA",
        Feature::Vertex(1) => "vertexB",
        Feature::Vertex(_) => "vertexC",
    }
}
