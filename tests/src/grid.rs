//! A uniform grid over boxes: the plainest broad phase there is, so that a check of the tree does not lean on the tree.

use nalgebra::{Point3, Vector3};
use std::collections::HashMap;

/// Numbers of boxes by the cells they overlap.
#[derive(Debug, Clone, Default)]
pub struct Grid {
    origin: Point3<f64>,
    cell: f64,
    low: [i64; 3],
    high: [i64; 3],
    cells: HashMap<[i64; 3], Vec<u32>>,
    count: usize,
}

impl Grid {
    /// A grid over boxes, each given by its least and greatest corner.
    pub fn new(boxes: &[(Point3<f64>, Point3<f64>)]) -> Self {
        let Some(&first) = boxes.first() else { return Self::default() };
        let (low, high) = boxes.iter().fold(first, |(low, high), (a, b)| (low.inf(a), high.sup(b)));
        // As many cells along the longest side as spread the boxes of a surface over about one cell each.
        let cell = (high - low).amax() / (boxes.len() as f64).sqrt().ceil();
        let mut grid = Self { origin: low, cell, count: boxes.len(), ..Self::default() };
        (grid.low, grid.high) = (grid.cell_of(&low), grid.cell_of(&high));
        for (i, (a, b)) in boxes.iter().enumerate() {
            for cell in between(grid.cell_of(a), grid.cell_of(b)) {
                grid.cells.entry(cell).or_default().push(i as u32);
            }
        }
        grid
    }

    fn cell_of(&self, p: &Point3<f64>) -> [i64; 3] {
        let cell = |x: f64| if self.cell > 0.0 { (x / self.cell).floor() as i64 } else { 0 };
        let d: Vector3<f64> = p - self.origin;
        [cell(d.x), cell(d.y), cell(d.z)]
    }

    /// The numbers of boxes that may meet the box from `low` to `high`, each once, in ascending order.
    pub fn near(&self, low: &Point3<f64>, high: &Point3<f64>) -> Vec<u32> {
        let (mut a, mut b) = (self.cell_of(low), self.cell_of(high));
        for i in 0..3 {
            (a[i], b[i]) = (a[i].max(self.low[i]), b[i].min(self.high[i]));
        }
        let cells: i64 = (0..3).map(|i| (b[i] - a[i] + 1).max(0)).product();
        let mut found: Vec<u32> = if cells as usize > self.count.max(self.cells.len()) {
            (0..self.count as u32).collect()
        } else {
            between(a, b).filter_map(|cell| self.cells.get(&cell)).flatten().copied().collect()
        };
        found.sort_unstable();
        found.dedup();
        found
    }
}

fn between(a: [i64; 3], b: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (a[0]..=b[0]).flat_map(move |x| (a[1]..=b[1]).flat_map(move |y| (a[2]..=b[2]).map(move |z| [x, y, z])))
}
