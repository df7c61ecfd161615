//! What is in the leaves of a tree: items of which only a box is known, or faces with their corners, of which those that a query is certain to
//! miss are found all at once.

use super::Child;
use super::lanes::ShearedPoints;
use super::prism::Prism;
use crate::bounds::Aabb;
use bytemuck::cast;
use nalgebra::Point3;
use smallvec::SmallVec;

/// The most corners, and the most faces, in a leaf: a bit of a u16 for each.
pub(super) const MOST: usize = 16;
/// Units of a leaf that holds one face: its number, which points are its corners, and these.
const MOST_UNITS_OF_A_FACE: usize = 1 + MASK_UNITS + PAIR_UNITS * 2;
/// Units of a word of 16 bits for each face.
pub(super) const MASK_UNITS: usize = 2;
/// Units of two points: their x, their y, their z.
pub(super) const PAIR_UNITS: usize = 3;
/// Numbers of faces in a unit.
const NUMBERS: usize = 4;
/// Where the number of a face ends in its word, and the order of its corners begins.
const ORDER_SHIFT: u32 = 29;
/// The orders in which three corners of ascending place can be those of a face.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// What a tree is built of.
pub(super) trait Content: Sync {
    /// What leaves are stored in.
    type Unit: Send;
    /// The most items in a leaf.
    const LARGEST: usize;
    /// How many items are looked at as one.
    const AT_ONCE: usize;

    /// The box of an item.
    fn bounds(&self, item: usize) -> Aabb;

    /// Whether these items fit into one leaf; one alone does.
    fn fit(&self, items: impl Iterator<Item = u32>) -> bool;

    /// Stores a leaf with these items; returns it.
    fn store(&self, items: &[u32], units: &mut Vec<Self::Unit>) -> Child;

    /// All leaves.
    fn leaves(units: Vec<Self::Unit>) -> Leaves;
}

/// The leaves of a tree.
#[derive(Debug, Clone)]
pub(super) enum Leaves {
    /// The numbers of items.
    Boxes(Vec<u32>),
    /// Faces with their corners.
    Faces(Vec<Unit>),
}

impl Leaves {
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Boxes(items) => size_of_val(items.as_slice()),
            Self::Faces(units) => size_of_val(units.as_slice()),
        }
    }
}

/// Items of which only a box is known.
pub(super) struct Boxes<F>(pub(super) F);

impl<F: Fn(usize) -> Aabb + Sync> Content for Boxes<F> {
    type Unit = u32;
    const LARGEST: usize = 4;
    const AT_ONCE: usize = 1;

    fn bounds(&self, item: usize) -> Aabb {
        (self.0)(item)
    }

    fn fit(&self, items: impl Iterator<Item = u32>) -> bool {
        items.count() <= Self::LARGEST
    }

    fn store(&self, items: &[u32], units: &mut Vec<u32>) -> Child {
        units.extend(items);
        Child::leaf(units.len() - items.len(), items.len())
    }

    fn leaves(units: Vec<u32>) -> Leaves {
        Leaves::Boxes(units)
    }
}

/// Faces, of which the corners are known; one without a box is in no answer.
pub(super) struct Faces<B, C> {
    pub(super) bounds: B,
    pub(super) corners: C,
}

/// The most faces whose leaves can be told apart, if each were one of its own.
pub(super) const MOST_FACES: usize = Child::MOST_ITEMS / MOST_UNITS_OF_A_FACE;

/// 16 bytes of a leaf: two coordinates, or four numbers of faces, or eight words of 16 bits.
///
/// The leaf that begins at unit k has there the corners of each of its faces as bits, then its points in pairs, and the numbers of its
/// faces before k, backwards.
pub(super) type Unit = [u64; 2];

/// The points of the corners of faces, each once, and which of them each face has.
#[derive(Default)]
struct Corners {
    points: SmallVec<[[u64; 3]; MOST]>,
    of_faces: SmallVec<[[usize; 3]; MOST]>,
}

impl Corners {
    /// Adds a face; whether there was room.
    fn add(&mut self, triangle: &[Point3<f64>; 3]) -> bool {
        let places = triangle.map(|p| {
            let bits = [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()];
            self.points.iter().position(|q| *q == bits).unwrap_or_else(|| {
                self.points.push(bits);
                self.points.len() - 1
            })
        });
        self.of_faces.push(places);
        self.points.len() <= MOST && self.of_faces.len() <= MOST
    }
}

impl<B: Fn(usize) -> Aabb + Sync, C: Fn(u32) -> [Point3<f64>; 3] + Sync> Content for Faces<B, C> {
    type Unit = Unit;
    const LARGEST: usize = MOST;
    const AT_ONCE: usize = MOST;

    fn bounds(&self, item: usize) -> Aabb {
        (self.bounds)(item)
    }

    fn fit(&self, mut items: impl Iterator<Item = u32>) -> bool {
        let mut corners = Corners::default();
        items.all(|face| corners.add(&(self.corners)(face)))
    }

    fn store(&self, items: &[u32], units: &mut Vec<Unit>) -> Child {
        let mut corners = Corners::default();
        items.iter().for_each(|&face| _ = corners.add(&(self.corners)(face)));
        let (mut numbers, mut masks) = ([0; MOST], [0; MOST]);
        for (j, (&face, places)) in items.iter().zip(&corners.of_faces).enumerate() {
            let mask = places.iter().fold(0_u16, |mask, place| mask | 1 << place);
            let word = face | order(places) << ORDER_SHIFT;
            numbers[j] = word;
            masks[j] = mask;
        }
        let numbers: [Unit; MOST / NUMBERS] = cast(numbers);
        units.extend(numbers[..items.len().div_ceil(NUMBERS)].iter().rev());
        let start = units.len();
        units.extend(cast::<_, [Unit; MASK_UNITS]>(masks));
        for pair in corners.points.chunks(2) {
            let other = pair.last().copied().unwrap_or_default();
            units.extend((0..3).map(|i| [pair[0][i], other[i]]));
        }
        // What follows is read whole: there is nothing to count.
        Child::leaf(start, 1)
    }

    fn leaves(mut units: Vec<Unit>) -> Leaves {
        // Leaves are read as if they had all the points they may.
        units.extend([Unit::default(); MOST / 2 * PAIR_UNITS]);
        units.shrink_to_fit();
        Leaves::Faces(units)
    }
}

/// Which order three places are in; one more than there are if two are the same.
fn order(places: &[usize; 3]) -> u32 {
    let mut sorted = *places;
    sorted.sort_unstable();
    let is = |order: &[usize; 3]| order.map(|k| sorted[k]) == *places;
    let distinct = sorted[0] < sorted[1] && sorted[1] < sorted[2];
    ORDERS.iter().position(is).filter(|_| distinct).unwrap_or(ORDERS.len()) as u32
}

/// A face, or an item of which only a box is known, that a query may meet.
pub(crate) struct Seen<'a> {
    /// Its number.
    pub(crate) item: u32,
    /// Its corners, unless they are to be asked of whoever has them.
    pub(crate) corners: Option<SeenCorners<'a>>,
}

/// The corners of a face that a query may meet.
pub(crate) struct SeenCorners<'a> {
    points: &'a [Unit],
    sheared: &'a ShearedPoints,
    /// The places of the corners among the points, ascending.
    places: [usize; 3],
    /// Which of these is the first corner of the face, which the next.
    order: &'a [usize; 3],
    /// A bound on the error of x1 y2 - x2 y1 of two of [`sheared`](Self::sheared).
    pub(crate) turn_bound: f64,
}

impl SeenCorners<'_> {
    /// Where they are.
    #[inline]
    pub(crate) fn points(&self) -> [Point3<f64>; 3] {
        self.order.map(|k| {
            let place = self.places[k];
            let pair = &self.points[place / 2 * PAIR_UNITS..][..PAIR_UNITS];
            Point3::from([0, 1, 2].map(|i| f64::from_bits(pair[i][place % 2])))
        })
    }

    /// Across the query's segment, in any order.
    #[inline]
    pub(crate) fn sheared(&self) -> [[f64; 2]; 3] {
        let [next, last, _] = &self.sheared.coordinates;
        self.places.map(|place| [next[place], last[place]])
    }
}

/// What a query shows of the leaves it comes to.
pub(super) trait Show {
    /// Shows a leaf, whose faces `screen` may leave out; returns the least that came back.
    fn show(&mut self, leaf: Child, screen: impl FnOnce(&[Unit], &Prism, &mut ShearedPoints) -> u32) -> f64;
}

/// Shows all items of a leaf.
pub(super) struct ShowBoxes<'a, H> {
    pub(super) items: &'a [u32],
    pub(super) hit: H,
}

impl<H: FnMut(Seen<'_>) -> f64> Show for ShowBoxes<'_, H> {
    #[inline(always)] // for the registers of the caller
    fn show(&mut self, leaf: Child, _: impl FnOnce(&[Unit], &Prism, &mut ShearedPoints) -> u32) -> f64 {
        self.items[leaf.range()].iter().fold(f64::INFINITY, |limit, &item| {
            let s = (self.hit)(Seen { item, corners: None });
            if s < limit { s } else { limit }
        })
    }
}

/// Shows the faces of a leaf that are not certain to be off a prism.
pub(super) struct ShowFaces<'a, H> {
    pub(super) units: &'a [Unit],
    pub(super) prism: Prism,
    pub(super) sheared: ShearedPoints,
    pub(super) hit: H,
}

impl<H: FnMut(Seen<'_>) -> f64> Show for ShowFaces<'_, H> {
    #[inline(always)] // for the registers of the caller
    fn show(&mut self, leaf: Child, screen: impl FnOnce(&[Unit], &Prism, &mut ShearedPoints) -> u32) -> f64 {
        let Some((before, rest)) = self.units.split_at_checked(leaf.range().start) else { return f64::INFINITY };
        let Some(own) = rest.get(..MASK_UNITS + MOST / 2 * PAIR_UNITS) else { return f64::INFINITY };
        let mut met = screen(own, &self.prism, &mut self.sheared);
        let Some((masks, points)) = own.split_first_chunk::<MASK_UNITS>() else { return f64::INFINITY };
        let masks: &[u16; MOST] = bytemuck::cast_ref(masks);
        let mut limit = f64::INFINITY;
        while met != 0 {
            let j = met.trailing_zeros() as usize % MOST;
            met &= met - 1;
            let numbers: [u32; NUMBERS] = cast(before[before.len() - 1 - j / NUMBERS]);
            let word = numbers[j % NUMBERS];
            let mask = u32::from(masks[j]);
            let rest = mask & mask.wrapping_sub(1);
            let places = [mask, rest, rest & rest.wrapping_sub(1)].map(|m| m.trailing_zeros() as usize % MOST);
            let corners = ORDERS.get((word >> ORDER_SHIFT) as usize).map(|order| SeenCorners {
                points,
                sheared: &self.sheared,
                places,
                order,
                turn_bound: self.prism.turn_bound,
            });
            let s = (self.hit)(Seen { item: word & (Child::MOST_ITEMS as u32 - 1), corners });
            limit = if s < limit { s } else { limit };
        }
        limit
    }
}

#[cfg(test)]
mod tests;
