//! The wide nodes over some items: cut in two as often as it takes, and the cuts then put together so that least is expected to be looked at.

use super::WIDTH;
use super::build::{Box32, Group, Item, cut};
use super::leaves::Content;

/// Cuts by the heuristic, one upon the other; below, halves by count.
const HEURISTIC_CUTS: usize = 16;

/// A tree of cuts, leaves first.
pub(super) struct Cuts {
    cuts: Vec<Cut>,
}

/// A group, and what becomes of it.
struct Cut {
    group: Group,
    halves: Option<[usize; 2]>,
    /// The least cost of the group as up to so many children of a node, from one on; what is looked at is proportional to the surfaces of nodes
    /// and leaves.
    costs: [f32; WIDTH],
}

impl Cuts {
    /// The cuts of `all`, which are the `items`.
    pub(super) fn of<C: Content>(content: &C, items: &mut [Item], all: Group) -> Self {
        let measure = all.bounds.measure();
        let mut cuts = Self { cuts: Vec::new() };
        cuts.add(content, items, all, 1, &measure);
        cuts
    }

    /// The number of the cut of all.
    pub(super) fn root(&self) -> usize {
        self.cuts.len() - 1
    }

    pub(super) fn group(&self, cut: usize) -> &Group {
        &self.cuts[cut].group
    }

    /// Adds what becomes of a group; returns its number.
    fn add<C: Content>(
        &mut self,
        content: &C,
        items: &mut [Item],
        group: Group,
        level: usize,
        measure: &impl Fn(&Box32) -> f32,
    ) -> usize {
        let own = measure(&group.bounds);
        let (halves, costs) = if group.fits {
            (None, [own; WIDTH])
        } else {
            let halves = cut(content, items, &group, level > HEURISTIC_CUTS)
                .map(|half| self.add(content, items, half, level + 1, measure));
            let mut costs = [own + self.shared(halves, WIDTH).1; WIDTH];
            for k in 1..WIDTH {
                let shared = self.shared(halves, k + 1).1;
                costs[k] = if shared < costs[k - 1] { shared } else { costs[k - 1] };
            }
            (Some(halves), costs)
        };
        self.cuts.push(Cut { group, halves, costs });
        self.cuts.len() - 1
    }

    /// How many of `children` the first half best has, and the cost of both.
    fn shared(&self, [a, b]: [usize; 2], children: usize) -> (usize, f32) {
        let cost = |k: usize| self.cuts[a].costs[k - 1] + self.cuts[b].costs[children - k - 1];
        (2..children).fold((1, cost(1)), |best, k| if cost(k) < best.1 { (k, cost(k)) } else { best })
    }

    /// The cuts that are best the children of the node for `cut`.
    pub(super) fn children(&self, cut: usize) -> ([usize; WIDTH], usize) {
        let mut children = ([cut; WIDTH], 0);
        match self.cuts[cut].halves {
            Some(halves) => self.share(halves, WIDTH, &mut children),
            None => children.1 = 1,
        }
        children
    }

    fn share(&self, halves: [usize; 2], room: usize, children: &mut ([usize; WIDTH], usize)) {
        let (first, _) = self.shared(halves, room);
        for (half, mut room) in halves.into_iter().zip([first, room - first]) {
            let Cut { halves, costs, .. } = &self.cuts[half];
            // No more room than is of use.
            let as_good = |&room: &usize, halves| room > 1 && self.shared(halves, room).1 > costs[room - 2];
            while halves.is_some_and(|halves| as_good(&room, halves)) {
                room -= 1;
            }
            match halves {
                Some(halves) if room > 1 => self.share(*halves, room, children),
                _ => {
                    children.0[children.1] = half;
                    children.1 += 1;
                }
            }
        }
    }
}
