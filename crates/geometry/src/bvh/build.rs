//! Building the tree: binned surface area heuristic, straight into wide nodes.

use super::frame::Frame;
use super::{Bvh, Child, Node, WIDTH};
use crate::bounds::Aabb;
use rayon::prelude::*;

/// A group of up to this many items is not split while there is room in the node.
const LEAF: usize = 2;
/// A group of up to this many items is not worth a node of its own.
const LARGEST_LEAF: usize = 4;
/// A group of up to this many items is not worth the while of several cores.
const ON_ONE_CORE: usize = 4096;
/// Bins an axis is cut into.
const BINS: usize = 16;
/// Levels by the heuristic; below, halves by count, at most log2(2^29) / log2(8) levels more.
const HEURISTIC_LEVELS: usize = 16;

/// An item's box in the tree's coordinates.
#[derive(Debug, Clone, Copy)]
struct Item {
    bounds: Box32,
    id: u32,
}

#[derive(Debug, Clone, Copy)]
struct Box32 {
    lo: [f32; 3],
    hi: [f32; 3],
}

impl Box32 {
    const EMPTY: Self = Self { lo: [f32::INFINITY; 3], hi: [f32::NEG_INFINITY; 3] };

    fn add(&mut self, other: &Self) {
        for i in 0..3 {
            self.lo[i] = if other.lo[i] < self.lo[i] { other.lo[i] } else { self.lo[i] };
            self.hi[i] = if other.hi[i] > self.hi[i] { other.hi[i] } else { self.hi[i] };
        }
    }

    fn of(items: &[Item]) -> Self {
        items.iter().fold(Self::EMPTY, |mut b, item| {
            b.add(&item.bounds);
            b
        })
    }

    /// Twice the centre: where an item counts as being.
    fn middle(&self) -> [f32; 3] {
        [0, 1, 2].map(|i| self.lo[i] + self.hi[i])
    }

    /// Half the surface, to which the chance of being met is proportional; -infinity or NaN never, 0 if empty.
    fn area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|i| (self.hi[i] - self.lo[i]).max(0.0));
        x * y + y * z + z * x
    }

    /// Sum of the sides, the measure where there is no surface.
    fn girth(&self) -> f32 {
        (0..3).map(|i| (self.hi[i] - self.lo[i]).max(0.0)).sum()
    }
}

/// A range of the items that becomes one child.
#[derive(Debug, Clone, Copy)]
struct Group {
    start: usize,
    end: usize,
    bounds: Box32,
}

impl Group {
    fn of(items: &[Item], start: usize, end: usize) -> Self {
        Self { start, end, bounds: Box32::of(&items[start..end]) }
    }

    fn len(&self) -> usize {
        self.end - self.start
    }
}

pub(super) fn build(count: usize, box_of: impl Fn(usize) -> Aabb + Sync) -> Bvh {
    // Infinite sides come in to the largest number: no finite segment can tell.
    let finite = |b: &Aabb| {
        let clamp = |c: f64| c.clamp(-f64::MAX, f64::MAX);
        Aabb::of_points(&[b.min().map(clamp), b.max().map(clamp)])
    };
    let kept = || {
        let all = (0..count.min(Child::MOST_ITEMS)).into_par_iter().with_min_len(ON_ONE_CORE);
        all.map(|i| (i as u32, box_of(i))).filter(|(_, b)| !b.is_empty()).map(|(i, b)| (i, finite(&b)))
    };
    let bounds = kept().map(|(_, b)| b).reduce(Aabb::empty, |all, b| all.union(&b));
    let frame = Frame::of(&bounds);
    let mut items: Vec<Item> = kept()
        .map(|(id, b)| {
            let (lo, hi) = frame.item_box(&b);
            Item { bounds: Box32 { lo, hi }, id }
        })
        .collect();
    let all = Group::of(&items, 0, items.len());
    let mut whole = if items.is_empty() { Part::default() } else { Part::of(&mut items, 0, all, 1) };
    whole.nodes.shrink_to_fit();
    Bvh {
        bounds,
        frame,
        items: items.iter().map(|item| item.id).collect(),
        nodes: whole.nodes,
        // Each level leaves all children but one pending.
        stack: (WIDTH - 1) * whole.levels + WIDTH,
    }
}

/// A part of the tree: its nodes, the root first and counted from it, and how many levels it goes down to from the top of the whole.
#[derive(Default)]
struct Part {
    nodes: Vec<Node>,
    levels: usize,
}

impl Part {
    /// The part over `items`, of which the first has the place `first` in the whole. `all` are all of them.
    fn of(items: &mut [Item], first: usize, all: Group, level: usize) -> Self {
        let mut part = Self::default();
        part.add(items, first, all, level);
        part
    }

    /// Adds the node for `all` and what is below; returns its number.
    fn add(&mut self, items: &mut [Item], first: usize, all: Group, level: usize) -> u32 {
        self.levels = self.levels.max(level);
        let (groups, count) = groups(items, all, level);
        let number = self.nodes.len();
        self.nodes.push(Node {
            planes: std::array::from_fn(|i| [if i < 3 { f32::INFINITY } else { f32::NEG_INFINITY }; WIDTH]),
            child: [Child::default(); WIDTH],
        });
        let mut below = if all.len() > ON_ONE_CORE {
            Self::in_parallel(items, first, &groups[..count], level)
        } else {
            std::array::from_fn(|_| None)
        };
        for (j, group) in groups[..count].iter().enumerate() {
            let child = if group.len() <= LARGEST_LEAF {
                items[group.start..group.end].sort_unstable_by_key(|item| item.id);
                Child::leaf(first + group.start, group.len())
            } else if let Some(part) = below[j].take() {
                Child(self.append(part))
            } else {
                Child(self.add(items, first, *group, level + 1))
            };
            let node = &mut self.nodes[number];
            node.child[j] = child;
            for i in 0..3 {
                node.planes[i][j] = group.bounds.lo[i];
                node.planes[i + 3][j] = group.bounds.hi[i];
            }
        }
        number as u32
    }

    /// The parts of the groups that get nodes, each on whatever core is free; the same ones as one after the other.
    fn in_parallel(items: &mut [Item], first: usize, groups: &[Group], level: usize) -> [Option<Self>; WIDTH] {
        let mut order: Vec<usize> = (0..groups.len()).collect();
        order.sort_unstable_by_key(|&j| groups[j].start);
        let mut tasks = Vec::with_capacity(groups.len());
        let mut rest = items;
        for j in order {
            let (own, others) = rest.split_at_mut(groups[j].len());
            tasks.push((j, own));
            rest = others;
        }
        let one = |(j, own): (usize, &mut [Item])| {
            let all = Group { start: 0, end: own.len(), bounds: groups[j].bounds };
            (own.len() > LARGEST_LEAF).then(|| (j, Self::of(own, first + groups[j].start, all, level + 1)))
        };
        let parts: Vec<_> = tasks.into_par_iter().filter_map(one).collect();
        let mut by_group = std::array::from_fn(|_| None);
        parts.into_iter().for_each(|(j, part)| by_group[j] = Some(part));
        by_group
    }

    /// Takes over the nodes of `part`; returns the number of its root.
    fn append(&mut self, part: Self) -> u32 {
        let root = self.nodes.len() as u32;
        self.levels = self.levels.max(part.levels);
        self.nodes.extend(part.nodes.into_iter().map(|mut node| {
            node.child.iter_mut().for_each(|child| *child = child.after(root));
            node
        }));
        root
    }
}

/// Cuts `all` into up to eight groups, the one most likely to be met first.
fn groups(items: &mut [Item], all: Group, level: usize) -> ([Group; WIDTH], usize) {
    let mut groups = [all; WIDTH];
    let mut count = 1;
    while count < WIDTH {
        let by_count = level > HEURISTIC_LEVELS;
        let weight = |g: &Group| if by_count { g.len() as f32 } else { g.bounds.area() };
        let Some(chosen) = (0..count)
            .filter(|&k| groups[k].len() > LEAF)
            .max_by(|&k, &l| weight(&groups[k]).total_cmp(&weight(&groups[l])).then(l.cmp(&k)))
        else {
            break;
        };
        let Group { start, end, bounds } = groups[chosen];
        let own = &mut items[start..end];
        let cut = if by_count { None } else { best_cut(own, &bounds) };
        let middle = start + if let Some(cut) = cut { cut.divide(own) } else { halve(own) };
        groups[chosen] = Group::of(items, start, middle);
        groups[count] = Group::of(items, middle, end);
        count += 1;
    }
    (groups, count)
}

/// How an axis is cut into bins.
#[derive(Debug, Clone, Copy)]
struct Binning {
    axis: usize,
    from: f32,
    per_length: f32,
    count: usize,
}

impl Binning {
    fn bin(&self, item: &Item) -> usize {
        let middle = item.bounds.lo[self.axis] + item.bounds.hi[self.axis];
        // NaN, from 0 times infinity when the axis is shorter than f32 can divide by, becomes bin 0.
        (((middle - self.from) * self.per_length) as usize).min(self.count - 1)
    }
}

/// Items in bins below `first_right` go left.
struct Cut {
    binning: Binning,
    first_right: usize,
}

impl Cut {
    /// Moves the left items to the front; returns how many there are.
    fn divide(&self, items: &mut [Item]) -> usize {
        let mut left = 0;
        for k in 0..items.len() {
            if self.binning.bin(&items[k]) < self.first_right {
                items.swap(left, k);
                left += 1;
            }
        }
        left
    }
}

/// The cut with the least sum of measure times count; `None` if all items are at one place.
fn best_cut(items: &[Item], bounds: &Box32) -> Option<Cut> {
    let measure = if bounds.area() > 0.0 { Box32::area } else { Box32::girth };
    let places = items.iter().fold(Box32::EMPTY, |mut b, item| {
        let middle = item.bounds.middle();
        b.add(&Box32 { lo: middle, hi: middle });
        b
    });
    // Few items: few bins find as good a cut.
    let count = (2 * items.len()).min(BINS);
    let mut best: Option<(f32, Cut)> = None;
    for axis in 0..3 {
        let length = places.hi[axis] - places.lo[axis];
        if length <= 0.0 {
            continue;
        }
        let binning = Binning { axis, from: places.lo[axis], per_length: count as f32 / length, count };
        let mut bins = [(Box32::EMPTY, 0usize); BINS];
        for item in items {
            let (bounds, number) = &mut bins[binning.bin(item)];
            bounds.add(&item.bounds);
            *number += 1;
        }
        let mut right = [0.0; BINS];
        let mut sum = (Box32::EMPTY, 0);
        for k in (1..count).rev() {
            sum.0.add(&bins[k].0);
            sum.1 += bins[k].1;
            right[k] = measure(&sum.0) * sum.1 as f32;
        }
        let mut sum = (Box32::EMPTY, 0);
        for first_right in 1..count {
            sum.0.add(&bins[first_right - 1].0);
            sum.1 += bins[first_right - 1].1;
            let cost = measure(&sum.0) * sum.1 as f32 + right[first_right];
            if (1..items.len()).contains(&sum.1) && best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, Cut { binning, first_right }));
            }
        }
    }
    best.map(|(_, cut)| cut)
}

/// Puts the half with the lower places, along the axis on which they differ most, to the front; returns its size.
fn halve(items: &mut [Item]) -> usize {
    let bounds = Box32::of(items);
    let length = |i: usize| bounds.hi[i] - bounds.lo[i];
    let axis = (1..3).fold(0, |best, i| if length(i) > length(best) { i } else { best });
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| {
        a.bounds.middle()[axis].total_cmp(&b.bounds.middle()[axis]).then(a.id.cmp(&b.id))
    });
    half
}
