//! What is in the leaves of a tree: items of which only a box is known, or faces with their corners, of which those that a query is certain to
//! miss are found all at once.

use super::Child;
use super::prism::Prism;
use crate::bounds::Aabb;
use nalgebra::Point3;
use smallvec::SmallVec;
use wide::{f64x4, i16x8};

/// The most corners, and the most faces, in a leaf: a bit of a u16 for each.
const MOST: usize = 16;
/// Units of a leaf that holds one face: its number, its corners, and which are its.
const MOST_UNITS_OF_A_FACE: usize = 1 + MASK_UNITS + PAIR_UNITS * 2;
/// Units of a word of 16 bits for each face.
const MASK_UNITS: usize = 2;
/// Units of two points: their x, their y, their z.
const PAIR_UNITS: usize = 3;
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
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(16))]
pub(super) struct Unit([u64; 2]);

impl Unit {
    fn coordinates(self) -> [f64; 2] {
        self.0.map(f64::from_bits)
    }

    fn number(self, place: usize) -> u32 {
        (self.0[place / 2 % 2] >> (place % 2 * 32)) as u32
    }

    fn masks(self) -> i16x8 {
        let word = |place: usize| (self.0[place / 4] >> (place % 4 * 16)) as i16;
        i16x8::new([word(0), word(1), word(2), word(3), word(4), word(5), word(6), word(7)])
    }

    fn mask(self, place: usize) -> u16 {
        (self.0[place / 4 % 2] >> (place % 4 * 16)) as u16
    }
}

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
        let mut numbers = [Unit::default(); MOST / NUMBERS];
        let mut masks = [Unit::default(); MASK_UNITS];
        for (j, (&face, places)) in items.iter().zip(&corners.of_faces).enumerate() {
            let mask = places.iter().fold(0_u64, |mask, place| mask | 1 << place);
            let word = u64::from(face | order(places) << ORDER_SHIFT);
            numbers[j / NUMBERS].0[j / 2 % 2] |= word << (j % 2 * 32);
            masks[j / 8].0[j / 4 % 2] |= mask << (j % 4 * 16);
        }
        units.extend(numbers[..items.len().div_ceil(NUMBERS)].iter().rev());
        let start = units.len();
        units.extend(masks);
        for pair in corners.points.chunks(2) {
            let other = pair.last().copied().unwrap_or_default();
            units.extend((0..3).map(|i| Unit([pair[0][i], other[i]])));
        }
        Child::leaf(start, corners.points.len().div_ceil(4))
    }

    fn leaves(mut units: Vec<Unit>) -> Leaves {
        // The last leaf may be read as if it had another pair.
        units.extend([Unit::default(); PAIR_UNITS]);
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

/// The points of a leaf, as sheared for a query.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sheared {
    coordinates: [[f64; MOST]; 3],
}

impl Default for Sheared {
    fn default() -> Self {
        Self { coordinates: [[0.0; MOST]; 3] }
    }
}

/// A leaf of which a query has seen the points.
pub(super) struct Look<'a> {
    units: &'a [Unit],
    sheared: &'a Sheared,
    start: usize,
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
    look: &'a Look<'a>,
    places: [usize; 3],
}

impl SeenCorners<'_> {
    /// Where they are.
    #[inline]
    pub(crate) fn points(&self) -> [Point3<f64>; 3] {
        self.places.map(|place| {
            let first = self.look.start + MASK_UNITS + place / 2 * PAIR_UNITS;
            let unit = |i: usize| self.look.units[first + i].coordinates()[place % 2];
            Point3::new(unit(0), unit(1), unit(2))
        })
    }

    /// Across and along the query's segment.
    #[inline]
    pub(crate) fn sheared(&self) -> [[f64; 3]; 3] {
        let [next, last, along] = &self.look.sheared.coordinates;
        self.places.map(|place| [next[place % MOST], last[place % MOST], along[place % MOST]])
    }
}

/// Shears the points of a leaf; returns a bit for each face that is not certain to be off the prism.
#[inline(always)] // as a function of its own it would have the narrow registers
fn screen(units: &[Unit], start: usize, quads: usize, prism: &Prism, sheared: &mut Sheared) -> u32 {
    let beyond = match prism.shear.axis {
        0 => beyond::<0>(units, start, quads, prism, sheared),
        1 => beyond::<1>(units, start, quads, prism, sheared),
        _ => beyond::<2>(units, start, quads, prism, sheared),
    };
    let Some(masks) = units.get(start..start + MASK_UNITS) else { return 0 };
    let off = |masks: i16x8| {
        let mut off = i16x8::splat(0);
        for side in beyond {
            off |= (masks & i16x8::splat(side as i16)).simd_eq(masks);
        }
        off.to_bitmask()
    };
    !(off(masks[0].masks()) | off(masks[1].masks()) << 8) & 0xffff
}

/// For each side of the prism a bit for each point that is beyond it, for certain.
#[inline(always)]
fn beyond<const AXIS: usize>(
    units: &[Unit],
    start: usize,
    quads: usize,
    prism: &Prism,
    sheared: &mut Sheared,
) -> [u32; 6] {
    let (next, last) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    let [from_next, from_last, from_along] = prism.shear.origin.map(f64x4::splat);
    let [slope, other] = prism.slopes.map(f64x4::splat);
    let (least, most) = (prism.least.map(f64x4::splat), prism.most.map(f64x4::splat));
    let mut beyond = [0; 6];
    let first = start + MASK_UNITS;
    for k in 0..quads {
        let Some(pairs) = units.get(first + 2 * k * PAIR_UNITS..first + 2 * (k + 1) * PAIR_UNITS) else { break };
        let four = |i: usize| {
            let [[a, b], [c, d]] = [pairs[i], pairs[PAIR_UNITS + i]].map(Unit::coordinates);
            f64x4::new([a, b, c, d])
        };
        let along = four(AXIS) - from_along;
        let seen = [four(next) - from_next - slope * along, four(last) - from_last - other * along, along];
        for (i, coordinate) in seen.into_iter().enumerate() {
            sheared.coordinates[i][4 * k..4 * k + 4].copy_from_slice(&coordinate.to_array());
            beyond[2 * i] |= coordinate.simd_lt(least[i]).to_bitmask() << (4 * k);
            beyond[2 * i + 1] |= coordinate.simd_gt(most[i]).to_bitmask() << (4 * k);
        }
    }
    beyond
}

/// Shows `hit` the faces of a leaf that are not certain to be off the prism; returns the least that it returned.
#[inline(always)]
pub(super) fn show(
    units: &[Unit],
    leaf: Child,
    prism: &Prism,
    sheared: &mut Sheared,
    hit: &mut impl FnMut(Seen<'_>) -> f64,
) -> f64 {
    let places = leaf.range();
    let start = places.start;
    let mut met = screen(units, start, places.len(), prism, sheared);
    let look = Look { units, sheared, start };
    let mut limit = f64::INFINITY;
    while met != 0 {
        let j = met.trailing_zeros() as usize;
        met &= met - 1;
        let word = units[start - 1 - j / NUMBERS].number(j % NUMBERS);
        let corners = ORDERS.get((word >> ORDER_SHIFT) as usize).map(|order| {
            let mask = u32::from(units[start + j / 8].mask(j % 8));
            let rest = mask & mask.wrapping_sub(1);
            let places = [mask, rest, rest & rest.wrapping_sub(1)].map(|m| m.trailing_zeros() as usize);
            SeenCorners { look: &look, places: order.map(|k| places[k]) }
        });
        let s = hit(Seen { item: word & (Child::MOST_ITEMS as u32 - 1), corners });
        limit = if s < limit { s } else { limit };
    }
    limit
}
