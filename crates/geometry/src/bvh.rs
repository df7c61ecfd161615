//! A bounding-volume tree over boxes or faces, asked by fat segments.

mod build;
mod collapse;
mod frame;
mod lanes;
mod leaves;
mod prism;

use frame::{Frame, LocalSegment};
use lanes::ShearedPoints;
pub(crate) use leaves::Seen;
use leaves::{Boxes, Faces, Leaves, Show, ShowBoxes, ShowFaces, Unit};
use multiversion::multiversion;
use multiversion::target::match_target;
use nalgebra::Point3;
use prism::Prism;

use crate::bounds::Aabb;
use crate::shear::Shear;
use wide::f32x8;

/// Children of a node: two SSE registers, one AVX register.
const WIDTH: usize = 8;
/// Stack entries that need no heap; enough for a well-shaped tree of 2^24 items.
const INLINE_STACK: usize = 64;

/// All points within `radius` of the segment from `from` to `to`: what a ball sweeps on a straight path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FatSegment {
    /// The end where s = 0.
    pub from: Point3<f64>,
    /// The end where s = 1; may equal `from`.
    pub to: Point3<f64>,
    /// The distance from the segment that still counts, with every margin the caller wants; below 0 is taken as 0.
    pub radius: f64,
}

/// For each axis the least and the largest coordinate of each child of a node.
type Planes = [[[f32; WIDTH]; 2]; 3];

/// Eight boxes and what is in them, in arrays that one loop of vector instructions reads.
#[derive(Debug, Clone)]
#[repr(align(32))]
struct Node {
    /// For each axis the least and the largest coordinate of each child; +infinity and -infinity where there is none.
    planes: Planes,
    child: [Child; WIDTH],
}

impl Node {
    /// A bit for each child whose box meets the one from `lo` to `hi`.
    #[inline]
    fn meets(&self, lo: &[f32; 3], hi: &[f32; 3]) -> u32 {
        let meets = |i: usize| {
            let [least, largest] = self.planes[i].map(f32x8::new);
            least.simd_le(f32x8::splat(hi[i])) & largest.simd_ge(f32x8::splat(lo[i]))
        };
        (meets(0) & meets(1) & meets(2)).to_bitmask()
    }

    /// The first child of those that are `met`, no longer among them.
    #[inline(always)]
    fn take(&self, met: &mut u32, entries: &[f32; WIDTH]) -> Pending {
        let j = met.trailing_zeros() as usize % WIDTH;
        *met &= *met - 1;
        Pending::new(entries[j], self.child[j])
    }
}

/// A child of a node: the index of a node, or `LEAF`, a count from 1 to 4 less one, and a place among the leaves.
#[derive(Debug, Clone, Copy, Default)]
struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const COUNT_SHIFT: u32 = 29;
    const MOST_ITEMS: usize = 1 << Self::COUNT_SHIFT;

    fn leaf(start: usize, count: usize) -> Self {
        debug_assert!((1..=4).contains(&count) && start < Self::MOST_ITEMS);
        Self(Self::LEAF | ((count as u32 - 1) << Self::COUNT_SHIFT) | start as u32)
    }

    #[inline(always)]
    fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// The same child after so many more nodes and units of leaves before it.
    fn after(self, nodes: u32, units: u32) -> Self {
        Self(self.0 + if self.is_leaf() { units } else { nodes })
    }

    /// The place of a leaf, and from there on its count.
    #[inline(always)]
    fn range(self) -> std::ops::Range<usize> {
        let start = (self.0 & (Self::MOST_ITEMS as u32 - 1)) as usize;
        let count = ((self.0 >> Self::COUNT_SHIFT) & 3) as usize + 1;
        start..start + count
    }
}

/// What is still to be looked at: a lower bound of the s at which the segment enters it, in the upper half, and a child. Not below 0, such a number
/// is in the order of its bits, so that the least of these is the nearest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Pending(u64);

impl Pending {
    #[inline(always)]
    fn new(entry: f32, child: Child) -> Self {
        // Adding 0 turns -0 into 0.
        Self((u64::from((entry + 0.0).to_bits()) << 32) | u64::from(child.0))
    }

    #[inline(always)]
    fn entry(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

/// A tree over items: boxes or the faces of a mesh. A node has eight children; a leaf holds four boxes at most, or up to sixteen faces with their
/// corners, in f64, each once: a query looks at all of these together, and leaves out the faces that it is certain to miss.
///
/// Node boxes are f32, rounded outwards, relative to the centre of everything and scaled to its extent by a power of
/// two: scaling the input by a power of two changes nothing, bit for bit, while coordinates stay normal. An answer may
/// hold items that are near misses, of boxes by about 1e-6 of the extent of everything, and never lacks one.
///
/// The tree is a function of the items and their order alone, and an answer does not depend on the registers of the processor.
#[derive(Debug, Clone)]
pub struct Bvh {
    bounds: Aabb,
    frame: Frame,
    nodes: Vec<Node>,
    leaves: Leaves,
    /// How many items there are.
    len: usize,
    /// The most entries a traversal can have pending.
    stack: usize,
}

impl Bvh {
    /// The tree over `boxes`; item i is `boxes[i]`. Empty boxes are in no answer, an infinite box is one of the largest
    /// finite numbers. Boxes from number 2^29 on are not taken: callers with so many refuse them first.
    ///
    /// Takes time n log n, on all cores, and is the same tree on however many. Splits by the surface area heuristic over bins (Wald 2007, "On fast construction of
    /// SAH-based bounding volume hierarchies"), and by the median where that would get too deep.
    pub fn build(boxes: &[Aabb]) -> Self {
        build::build(boxes.len(), &Boxes(|i| boxes[i]))
    }

    /// The tree over triangles with the corners `vertices[faces[i]]`; item i is `faces[i]`. Its leaves have the corners, so that a query is shown few that it
    /// misses. As with the lists, a place beyond their end panics.
    ///
    /// ```
    /// use carom_geometry::bvh::{Bvh, FatSegment};
    /// use carom_geometry::nalgebra::Point3;
    ///
    /// let vertices = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [4.0, 4.0], [8.0, 0.0]].map(|[x, y]| Point3::new(x, y, 0.0));
    /// let tree = Bvh::of_triangles(&vertices, &[[0, 1, 2], [1, 4, 3]]);
    /// let down = FatSegment { from: Point3::new(1.0, 1.0, 1.0), to: Point3::new(1.0, 1.0, -1.0), radius: 0.0 };
    /// let mut met = Vec::new();
    /// tree.visit(&down, |triangle| {
    ///     met.push(triangle);
    ///     f64::INFINITY
    /// });
    /// assert_eq!(met, [0]);
    /// ```
    pub fn of_triangles(vertices: &[Point3<f64>], faces: &[[u32; 3]]) -> Self {
        let corners = |face: u32| faces[face as usize].map(|v| vertices[v as usize]);
        Self::of_faces(faces.len(), |face| Aabb::of_points(&corners(face as u32)), corners)
    }

    /// The tree over `count` faces with these boxes and corners, which are computed as often as they are needed. A face whose box is empty is in no answer.
    pub(crate) fn of_faces(
        count: usize,
        bounds: impl Fn(usize) -> Aabb + Sync,
        corners: impl Fn(u32) -> [Point3<f64>; 3] + Sync,
    ) -> Self {
        if count <= leaves::MOST_FACES {
            build::build(count, &Faces { bounds, corners })
        } else {
            build::build(count, &Boxes(bounds))
        }
    }

    /// The least box around all items, exactly.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// How many items it holds.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether it holds nothing.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The memory it takes, in bytes.
    pub fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>() + self.leaves.bytes()
    }

    /// Shows `hit` every item, a box or a face, that meets `segment`, and some near misses, nearly front to back; returns the number
    /// of nodes looked at.
    ///
    /// `hit` returns the s, from 0 at `from` to 1 at `to`, beyond which nothing is of interest any more: boxes that the
    /// segment enters later are left out. The limit never grows again; return infinity to set none. A segment with a
    /// coordinate that is not finite is shown everything.
    pub fn visit(&self, segment: &FatSegment, mut hit: impl FnMut(u32) -> f64) -> u64 {
        self.look_along(segment, &Shear::new(&segment.from, &segment.to), |seen| hit(seen.item))
    }

    /// [`visit`](Self::visit) with what is known of the items; `shear` is that of the segment.
    #[inline]
    pub(crate) fn look_along(&self, segment: &FatSegment, shear: &Shear, hit: impl FnMut(Seen<'_>) -> f64) -> u64 {
        let Some(local) = self.frame.segment(segment, &self.bounds) else { return 0 };
        let (mut inline, mut heap) = ([Pending::default(); INLINE_STACK], Vec::new());
        let stack = self.stack(&mut inline, &mut heap);
        match &self.leaves {
            Leaves::Boxes(items) => walk(&self.nodes, &local, stack, &mut ShowBoxes { items, hit }),
            Leaves::Faces(units) => {
                let prism = Prism::around(segment, shear, &self.bounds);
                walk(
                    &self.nodes,
                    &local,
                    stack,
                    &mut ShowFaces { units, prism, sheared: ShearedPoints::default(), hit },
                )
            }
        }
    }

    /// Shows `hit` every item whose box meets `query`, and some near misses; returns the number of nodes looked at.
    pub fn visit_box(&self, query: &Aabb, mut hit: impl FnMut(u32)) -> u64 {
        if !self.bounds.intersects(query) {
            return 0;
        }
        let (lo, hi) = self.frame.outer_box(query);
        let hit = |seen: Seen<'_>| {
            hit(seen.item);
            f64::INFINITY
        };
        let (mut inline, mut heap) = ([Pending::default(); INLINE_STACK], Vec::new());
        let stack = self.stack(&mut inline, &mut heap);
        match &self.leaves {
            Leaves::Boxes(items) => walk_box(&self.nodes, (&lo, &hi), stack, &mut ShowBoxes { items, hit }),
            Leaves::Faces(units) => {
                let prism = Prism::of_box(query);
                let mut leaves = ShowFaces { units, prism, sheared: ShearedPoints::default(), hit };
                walk_box(&self.nodes, (&lo, &hi), stack, &mut leaves)
            }
        }
    }

    /// Room for what can be pending: `inline` if that is enough. The first entry is the root, which is Child(0).
    #[inline]
    fn stack<'a>(&self, inline: &'a mut [Pending], heap: &'a mut Vec<Pending>) -> &'a mut [Pending] {
        if self.stack <= inline.len() {
            return inline;
        }
        heap.resize(self.stack, Pending::default());
        heap
    }
}

/// Goes through the nodes that meet the box from `lo` to `hi`, and shows the leaves that are in them; returns how many nodes there were.
#[multiversion(targets("x86_64+avx2"))]
fn walk_box(nodes: &[Node], bounds: (&[f32; 3], &[f32; 3]), stack: &mut [Pending], leaves: &mut impl Show) -> u64 {
    match_target! {
        "x86_64+avx2" => walk_box_by(
            nodes,
            bounds,
            stack,
            leaves,
            |leaf: &[Unit], prism: &Prism, sheared: &mut ShearedPoints| lanes::avx2::screen(leaf, prism, sheared),
        ),
        _ => walk_box_by(nodes, bounds, stack, leaves, lanes::narrow::screen),
    }
}

#[inline(always)] // so that it is compiled with `walk_box`
fn walk_box_by(
    nodes: &[Node],
    (lo, hi): (&[f32; 3], &[f32; 3]),
    stack: &mut [Pending],
    leaves: &mut impl Show,
    screen: impl Fn(&[Unit], &Prism, &mut ShearedPoints) -> u32,
) -> u64 {
    let (mut pending, mut visited) = (1, 0);
    while pending > 0 {
        pending -= 1;
        let child = stack[pending].child();
        if child.is_leaf() {
            leaves.show(child, &screen);
            continue;
        }
        let Some(node) = nodes.get(child.0 as usize) else { continue };
        visited += 1;
        let mut met = node.meets(lo, hi);
        while met != 0 {
            stack[pending] = node.take(&mut met, &[0.0; WIDTH]);
            pending += 1;
        }
    }
    visited
}

/// [`walk_by`] the widest registers that the processor has: by the same operations in the same order, which round alike.
#[multiversion(targets("x86_64+avx2"))]
fn walk(nodes: &[Node], segment: &LocalSegment, stack: &mut [Pending], leaves: &mut impl Show) -> u64 {
    match_target! {
        "x86_64+avx2" => walk_by(
            nodes,
            segment,
            stack,
            leaves,
            |planes: &Planes, limit| lanes::avx2::entries(segment, planes, limit),
            |leaf: &[Unit], prism: &Prism, sheared: &mut ShearedPoints| lanes::avx2::screen(leaf, prism, sheared),
        ),
        _ => walk_narrow(nodes, segment, stack, leaves),
    }
}

// In a program that is compiled for AVX2, only tests call it.
#[cfg_attr(target_feature = "avx2", allow(dead_code))]
fn walk_narrow(nodes: &[Node], segment: &LocalSegment, stack: &mut [Pending], leaves: &mut impl Show) -> u64 {
    let entries = |planes: &Planes, limit| lanes::narrow::entries(segment, planes, limit);
    walk_by(nodes, segment, stack, leaves, entries, lanes::narrow::screen)
}

/// Goes through the nodes that the segment enters, and shows the leaves that are in them; returns how many nodes there were.
#[inline(always)] // so that it is compiled with `walk`
fn walk_by(
    nodes: &[Node],
    segment: &LocalSegment,
    stack: &mut [Pending],
    leaves: &mut impl Show,
    entries: impl Fn(&Planes, f32) -> ([f32; WIDTH], u32),
    screen: impl Fn(&[Unit], &Prism, &mut ShearedPoints) -> u32,
) -> u64 {
    let (mut pending, mut visited) = (0, 0);
    // The limit that a leaf gave last, and the same in the part of the segment that is near the tree.
    let (mut last, mut limit) = (f64::INFINITY, 1.0_f32);
    let mut child = Child::default();
    loop {
        if child.is_leaf() {
            let s = leaves.show(child, &screen);
            if s < last {
                last = s;
                let until = segment.local_limit(s);
                limit = if until < limit { until } else { limit };
            }
        } else if let Some(node) = nodes.get(child.0 as usize) {
            visited += 1;
            let (entered, mut met) = entries(&node.planes, limit);
            if met != 0 {
                let first = pending;
                let mut nearest = node.take(&mut met, &entered);
                while met != 0 {
                    let next = node.take(&mut met, &entered);
                    let farther = if next > nearest { next } else { nearest };
                    nearest = if next > nearest { nearest } else { next };
                    // The nearer the later, so that it is popped the sooner.
                    let mut place = pending;
                    while place > first && stack[place - 1] < farther {
                        stack[place] = stack[place - 1];
                        place -= 1;
                    }
                    stack[place] = farther;
                    pending += 1;
                }
                child = nearest.child();
                continue;
            }
        }
        loop {
            if pending == 0 {
                return visited;
            }
            pending -= 1;
            if stack[pending].entry() <= limit {
                break;
            }
        }
        child = stack[pending].child();
    }
}

#[cfg(test)]
mod tests;
