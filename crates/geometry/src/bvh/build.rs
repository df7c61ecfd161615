//! Building the tree: by the binned surface area heuristic, many items straight into wide nodes, few by way of cuts in two.

use super::collapse::Cuts;
use super::frame::Frame;
use super::leaves::{Content, MOST};
use super::{Bvh, Child, Node, WIDTH};
use crate::bounds::Aabb;
use rayon::prelude::*;
use smallvec::SmallVec;
use wide::f32x4;

/// A group of up to this many items is not worth the while of several cores.
const ON_ONE_CORE: usize = 4096;
/// Bins an axis is cut into.
const BINS: usize = 16;
/// Levels by the heuristic; below, halves by count, at most log2(2^29) / log2(8) levels more.
const HEURISTIC_LEVELS: usize = 16;

/// An item's box in the tree's coordinates, and its number in the fourth place of `lo`, where no coordinate is: half of a line of the cache.
#[derive(Debug, Clone, Copy)]
pub(super) struct Item {
    bounds: Box32,
}

impl Item {
    fn new(id: u32, [x, y, z]: [f32; 3], hi: [f32; 3]) -> Self {
        let lo = f32x4::new([x, y, z, f32::from_bits(id)]);
        Self { bounds: Box32 { lo, hi: f32x4::new([hi[0], hi[1], hi[2], 0.0]) } }
    }

    fn id(&self) -> u32 {
        self.bounds.lo.to_array()[3].to_bits()
    }
}

/// A box: its corners, each with a fourth number of no meaning.
#[derive(Debug, Clone, Copy)]
pub(super) struct Box32 {
    lo: f32x4,
    hi: f32x4,
}

impl Box32 {
    const EMPTY: Self = Self { lo: f32x4::new([f32::INFINITY; 4]), hi: f32x4::new([f32::NEG_INFINITY; 4]) };

    #[inline]
    fn add(&mut self, other: &Self) {
        // No coordinate is NaN.
        self.lo = other.lo.fast_min(self.lo);
        self.hi = other.hi.fast_max(self.hi);
    }

    fn of(items: &[Item]) -> Self {
        items.iter().fold(Self::EMPTY, |mut b, item| {
            b.add(&item.bounds);
            b
        })
    }

    /// Twice the centre: where an item counts as being.
    #[inline]
    fn middle(&self) -> f32x4 {
        self.lo + self.hi
    }

    /// The sides, 0 if empty.
    #[inline]
    fn sides(&self) -> [f32; 3] {
        let [x, y, z, _] = (self.hi - self.lo).fast_max(f32x4::splat(0.0)).to_array();
        [x, y, z]
    }

    /// How likely a part of it is to be met, up to a factor: by its surface, or where the whole has none by its sides.
    #[inline]
    pub(super) fn measure(&self) -> impl Fn(&Self) -> f32 + use<> {
        let has_area = self.area() > 0.0;
        move |part| if has_area { part.area() } else { part.girth() }
    }

    /// Half the surface; -infinity or NaN never, 0 if empty.
    #[inline]
    fn area(&self) -> f32 {
        let [x, y, z] = self.sides();
        x * y + y * z + z * x
    }

    /// Sum of the sides.
    #[inline]
    fn girth(&self) -> f32 {
        self.sides().iter().sum()
    }
}

/// A range of the items that becomes one child.
#[derive(Debug, Clone, Copy)]
pub(super) struct Group {
    start: usize,
    end: usize,
    pub(super) bounds: Box32,
    /// Whether it fits into a leaf.
    pub(super) fits: bool,
}

impl Group {
    fn of<C: Content>(content: &C, items: &[Item], start: usize, end: usize) -> Self {
        let own = &items[start..end];
        let fits = own.len() <= C::LARGEST && content.fit(own.iter().map(Item::id));
        Self { start, end, bounds: Box32::of(own), fits }
    }

    fn len(&self) -> usize {
        self.end - self.start
    }
}

pub(super) fn build<C: Content>(count: usize, content: &C) -> Bvh {
    // Infinite sides come in to the largest number: no finite segment can tell.
    let finite = |b: &Aabb| {
        let clamp = |c: f64| c.clamp(-f64::MAX, f64::MAX);
        Aabb::of_points(&[b.min().map(clamp), b.max().map(clamp)])
    };
    let kept = || {
        let all = (0..count.min(Child::MOST_ITEMS)).into_par_iter().with_min_len(ON_ONE_CORE);
        all.map(|i| (i as u32, content.bounds(i))).filter(|(_, b)| !b.is_empty()).map(|(i, b)| (i, finite(&b)))
    };
    let bounds = kept().map(|(_, b)| b).reduce(Aabb::empty, |all, b| all.union(&b));
    let frame = Frame::of(&bounds);
    let mut items: Vec<Item> = kept()
        .map(|(id, b)| {
            let (lo, hi) = frame.item_box(&b);
            Item::new(id, lo, hi)
        })
        .collect();
    let all = Group::of(content, &items, 0, items.len());
    let mut whole = if items.is_empty() { Part::default() } else { Part::of(content, &mut items, all, 1) };
    whole.nodes.shrink_to_fit();
    Bvh {
        bounds,
        frame,
        leaves: C::leaves(whole.units),
        len: items.len(),
        nodes: whole.nodes,
        // Each level leaves all children but one pending.
        stack: (WIDTH - 1) * whole.levels + WIDTH,
    }
}

impl Node {
    fn set(&mut self, j: usize, child: Child, group: &Group) {
        self.child[j] = child;
        let (lo, hi) = (group.bounds.lo.to_array(), group.bounds.hi.to_array());
        for (i, [least, largest]) in self.planes.iter_mut().enumerate() {
            (least[j], largest[j]) = (lo[i], hi[i]);
        }
    }
}

/// A part of the tree: its nodes, the root first and counted from it, its leaves, and how many levels it goes down to from the top of the whole.
struct Part<C: Content> {
    nodes: Vec<Node>,
    units: Vec<C::Unit>,
    levels: usize,
}

impl<C: Content> Default for Part<C> {
    fn default() -> Self {
        Self { nodes: Vec::new(), units: Vec::new(), levels: 0 }
    }
}

impl<C: Content> Part<C> {
    /// The part over `items`, of which `all` are all.
    fn of(content: &C, items: &mut [Item], all: Group, level: usize) -> Self {
        let mut part = Self::default();
        part.add(content, items, all, level);
        part
    }

    /// Adds the node for `all` and what is below; returns its number.
    fn add(&mut self, content: &C, items: &mut [Item], all: Group, level: usize) -> u32 {
        if all.len() <= ON_ONE_CORE {
            let cuts = Cuts::of(content, items, all);
            return self.add_cuts(content, items, &cuts, cuts.root(), level);
        }
        let (groups, count) = groups(content, items, all, level);
        let number = self.add_node(level);
        let mut below = Self::in_parallel(content, items, &groups[..count], level);
        for (j, group) in groups[..count].iter().enumerate() {
            let child = match below[j].take() {
                Some(part) => Child(self.append(part)),
                None => self.add_leaf(content, items, group),
            };
            self.nodes[number].set(j, child, group);
        }
        number as u32
    }

    /// Adds the node for a cut that is no leaf, or is all, and what is below.
    fn add_cuts(&mut self, content: &C, items: &[Item], cuts: &Cuts, cut: usize, level: usize) -> u32 {
        let number = self.add_node(level);
        let (children, count) = cuts.children(cut);
        for (j, &child) in children[..count].iter().enumerate() {
            let group = cuts.group(child);
            let child = if group.fits {
                self.add_leaf(content, items, group)
            } else {
                Child(self.add_cuts(content, items, cuts, child, level + 1))
            };
            self.nodes[number].set(j, child, group);
        }
        number as u32
    }

    fn add_node(&mut self, level: usize) -> usize {
        self.levels = self.levels.max(level);
        self.nodes.push(Node {
            planes: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3],
            child: [Child::default(); WIDTH],
        });
        self.nodes.len() - 1
    }

    fn add_leaf(&mut self, content: &C, items: &[Item], group: &Group) -> Child {
        let mut ids: SmallVec<[u32; MOST]> = items[group.start..group.end].iter().map(Item::id).collect();
        ids.sort_unstable();
        content.store(&ids, &mut self.units)
    }

    /// The parts of the groups that get nodes, each on whatever core is free; the same ones as one after the other.
    fn in_parallel(content: &C, items: &mut [Item], groups: &[Group], level: usize) -> [Option<Self>; WIDTH] {
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
            let all = Group { start: 0, end: own.len(), ..groups[j] };
            (!all.fits).then(|| (j, Self::of(content, own, all, level + 1)))
        };
        let parts: Vec<_> = tasks.into_par_iter().filter_map(one).collect();
        let mut by_group = std::array::from_fn(|_| None);
        parts.into_iter().for_each(|(j, part)| by_group[j] = Some(part));
        by_group
    }

    /// Takes over the nodes and leaves of `part`; returns the number of its root.
    fn append(&mut self, part: Self) -> u32 {
        let (root, units) = (self.nodes.len() as u32, self.units.len() as u32);
        self.levels = self.levels.max(part.levels);
        self.nodes.extend(part.nodes.into_iter().map(|mut node| {
            node.child.iter_mut().for_each(|child| *child = child.after(root, units));
            node
        }));
        self.units.extend(part.units);
        root
    }
}

/// Cuts `all` into up to eight groups, the one most likely to be met first.
fn groups<C: Content>(content: &C, items: &mut [Item], all: Group, level: usize) -> ([Group; WIDTH], usize) {
    let mut groups = [all; WIDTH];
    let mut count = 1;
    while count < WIDTH {
        let by_count = level > HEURISTIC_LEVELS;
        let weight = |g: &Group| if by_count { g.len() as f32 } else { g.bounds.area() };
        let Some((chosen, _)) = (0..count)
            .filter(|&k| !groups[k].fits && groups[k].len() > 1)
            .map(|k| (k, weight(&groups[k])))
            .max_by(|(k, a), (l, b)| a.total_cmp(b).then(l.cmp(k)))
        else {
            break;
        };
        [groups[chosen], groups[count]] = cut(content, items, &groups[chosen], by_count);
        count += 1;
    }
    (groups, count)
}

/// Cuts a group in two, by the heuristic or by count.
pub(super) fn cut<C: Content>(content: &C, items: &mut [Item], group: &Group, by_count: bool) -> [Group; 2] {
    let &Group { start, end, bounds, .. } = group;
    let own = &mut items[start..end];
    let cut = if by_count { None } else { best_cut(own, &bounds, C::AT_ONCE) };
    let middle = start + if let Some(cut) = cut { cut.divide(own) } else { halve(own) };
    [Group::of(content, items, start, middle), Group::of(content, items, middle, end)]
}

/// How the axes are cut into bins.
#[derive(Debug, Clone, Copy)]
struct Binning {
    from: f32x4,
    per_length: f32x4,
    count: usize,
}

impl Binning {
    /// The bins of an item by axis; the fourth means nothing.
    #[inline]
    fn bins(&self, item: &Item) -> [usize; 4] {
        let bins = (item.bounds.middle() - self.from) * self.per_length;
        // NaN, from 0 times infinity when the axis is shorter than f32 can divide by, becomes bin 0.
        bins.to_array().map(|bin| (bin as usize).min(self.count - 1))
    }
}

/// Items in bins of `axis` below `first_right` go left.
struct Cut {
    binning: Binning,
    axis: usize,
    first_right: usize,
}

impl Cut {
    /// Moves the left items to the front; returns how many there are.
    fn divide(&self, items: &mut [Item]) -> usize {
        let mut left = 0;
        for k in 0..items.len() {
            if self.binning.bins(&items[k])[self.axis] < self.first_right {
                items.swap(left, k);
                left += 1;
            }
        }
        left
    }
}

/// The cut with the least sum of measure times looks, of which each is at up to `at_once` items; `None` if all items are at one place.
fn best_cut(items: &[Item], bounds: &Box32, at_once: usize) -> Option<Cut> {
    let looks = |count: usize| count.div_ceil(at_once) as f32;
    let measure = bounds.measure();
    let places = items.iter().fold(Box32::EMPTY, |mut b, item| {
        let middle = item.bounds.middle();
        b.add(&Box32 { lo: middle, hi: middle });
        b
    });
    // Few items: few bins find as good a cut.
    let count = (2 * items.len()).min(BINS);
    let lengths = places.hi - places.lo;
    let binning = Binning { from: places.lo, per_length: f32x4::splat(count as f32) / lengths, count };
    // All axes at once: of what takes long, the items are looked at once.
    let mut all_bins = [[(Box32::EMPTY, 0usize); BINS]; 3];
    for item in items {
        for (bins, bin) in all_bins.iter_mut().zip(binning.bins(item)) {
            let (bounds, number) = &mut bins[bin];
            bounds.add(&item.bounds);
            *number += 1;
        }
    }
    let mut best: Option<(f32, Cut)> = None;
    for (axis, bins) in all_bins.iter().enumerate() {
        if lengths.to_array()[axis] <= 0.0 {
            continue;
        }
        let mut right = [0.0; BINS];
        let mut sum = (Box32::EMPTY, 0);
        for k in (1..count).rev() {
            sum.0.add(&bins[k].0);
            sum.1 += bins[k].1;
            right[k] = measure(&sum.0) * looks(sum.1);
        }
        let mut sum = (Box32::EMPTY, 0);
        for first_right in 1..count {
            sum.0.add(&bins[first_right - 1].0);
            sum.1 += bins[first_right - 1].1;
            let cost = measure(&sum.0) * looks(sum.1) + right[first_right];
            if (1..items.len()).contains(&sum.1) && best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, Cut { binning, axis, first_right }));
            }
        }
    }
    best.map(|(_, cut)| cut)
}

/// Puts the half with the lower places, along the axis on which they differ most, to the front; returns its size.
fn halve(items: &mut [Item]) -> usize {
    let bounds = Box32::of(items);
    let lengths = (bounds.hi - bounds.lo).to_array();
    let length = |i: usize| lengths[i];
    let axis = (1..3).fold(0, |best, i| if length(i) > length(best) { i } else { best });
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| {
        let place = |item: &Item| item.bounds.middle().to_array()[axis];
        place(a).total_cmp(&place(b)).then(a.id().cmp(&b.id()))
    });
    half
}
