//! Which sides of faces lie on the same edge, and which faces lie around a vertex.

use super::fold::Fold;
use std::collections::BTreeSet;

/// For each half-edge, that is side i of face f under the number 3 f + i, the next one on the same edge, in ascending
/// order and from the last back to the first; and its fold.
#[derive(Debug, Clone)]
pub(crate) struct Topology {
    /// The next half-edge in the low 29 bits, the fold above.
    links: Vec<u32>,
}

const FOLD_SHIFT: u32 = 29;
const HALF_EDGE: u32 = (1 << FOLD_SHIFT) - 1;

impl Topology {
    /// For faces whose indices are all below `vertices`, and at most [`MOST_FACES`](super::MOST_FACES); every fold is
    /// still [`Fold::Rim`].
    pub(crate) fn of(vertices: usize, faces: &[[u32; 3]]) -> Self {
        Self::without(vertices, faces, &BTreeSet::new())
    }

    /// Of all faces but some, whose sides lie on no edge with others.
    pub(super) fn without(vertices: usize, faces: &[[u32; 3]], left_out: &BTreeSet<u32>) -> Self {
        // Half-edges by their lower vertex, and then sorted by the other: everything stays near what it belongs to.
        let count = 3 * faces.len() as u32;
        let ends = |h: u32| ends(faces, h);
        let kept = (0..count).filter(|h| !left_out.contains(&(h / 3)));
        let by_vertex = Buckets::of(vertices, kept.map(|h| (ends(h)[0].min(ends(h)[1]), h)));
        let mut links: Vec<u32> = (0..count).map(|h| h | Fold::Rim.bits() << FOLD_SHIFT).collect();
        let mut around = Vec::new();
        for vertex in 0..vertices {
            around.clear();
            let other = |h: u32| ends(h)[0].max(ends(h)[1]);
            around.extend(by_vertex.get(vertex).iter().map(|&h| (other(h), h)));
            around.sort_unstable();
            for ring in around.chunk_by(|a, b| a.0 == b.0) {
                for (k, &(_, h)) in ring.iter().enumerate() {
                    links[h as usize] = ring[(k + 1) % ring.len()].1 | Fold::Rim.bits() << FOLD_SHIFT;
                }
            }
        }
        Self { links }
    }

    /// The faces that have the corners of an earlier one, in whatever order.
    pub(super) fn repeats(&self, faces: &[[u32; 3]]) -> BTreeSet<u32> {
        let corners = |face: u32| {
            let mut corners = faces[face as usize];
            corners.sort_unstable();
            corners
        };
        let repeats = |&face: &u32| {
            let mut before = self.ring(3 * face).map(|h| h / 3).filter(|&other| other < face);
            before.any(|other| corners(other) == corners(face))
        };
        (0..faces.len() as u32).filter(repeats).collect()
    }

    /// How many half-edges there are.
    pub(crate) fn len(&self) -> u32 {
        self.links.len() as u32
    }

    /// The next half-edge of the same edge; `h` itself if there is no other.
    pub(crate) fn next(&self, h: u32) -> u32 {
        self.links[h as usize] & HALF_EDGE
    }

    /// All half-edges of the same edge, once round, `h` first.
    pub(crate) fn ring(&self, h: u32) -> impl Iterator<Item = u32> {
        let rest = std::iter::successors(Some(self.next(h)), |&g| Some(self.next(g)));
        std::iter::once(h).chain(rest.take_while(move |&g| g != h))
    }

    /// The first half-edge of the same edge.
    pub(crate) fn owner(&self, h: u32) -> u32 {
        // Ascending until it starts again, which for two is at once.
        let mut g = h;
        while self.next(g) > g {
            g = self.next(g);
        }
        self.next(g)
    }

    /// The other half-edge of an edge that has exactly two.
    pub(super) fn twin(&self, h: u32) -> Option<u32> {
        let g = self.next(h);
        (g != h && self.next(g) == h).then_some(g)
    }

    /// From where to where half-edge `h` runs.
    pub(crate) fn ends(&self, faces: &[[u32; 3]], h: u32) -> [u32; 2] {
        ends(faces, h)
    }

    pub(super) fn fold(&self, h: u32) -> Fold {
        Fold::from_bits(self.links[h as usize] >> FOLD_SHIFT)
    }

    pub(super) fn set_fold(&mut self, h: u32, fold: Fold) {
        self.links[h as usize] = self.next(h) | fold.bits() << FOLD_SHIFT;
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.links.as_slice())
    }
}

fn ends(faces: &[[u32; 3]], h: u32) -> [u32; 2] {
    let (face, side) = (faces[h as usize / 3], h as usize % 3);
    [face[side], face[(side + 1) % 3]]
}

/// The faces around each vertex, all but some.
#[derive(Debug, Clone)]
pub(super) struct VertexFaces(Buckets);

impl VertexFaces {
    pub(super) fn of(vertices: usize, faces: &[[u32; 3]], left_out: &BTreeSet<u32>) -> Self {
        let kept = faces.iter().zip(0..).filter(|(_, f)| !left_out.contains(f));
        let corners = kept.flat_map(|(&[a, b, c], f)| {
            // A face that has a vertex twice is around it once.
            [Some(a), (b != a).then_some(b), (c != a && c != b).then_some(c)].into_iter().flatten().map(move |v| (v, f))
        });
        Self(Buckets::of(vertices, corners))
    }

    pub(super) fn around(&self, vertex: u32) -> &[u32] {
        self.0.get(vertex as usize)
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.0.starts.as_slice()) + size_of_val(self.0.values.as_slice())
    }
}

/// Lists of numbers by key, one after the other.
#[derive(Debug, Clone)]
struct Buckets {
    starts: Vec<u32>,
    values: Vec<u32>,
}

impl Buckets {
    /// From pairs of a key below `keys` and a value; values keep their order.
    fn of(keys: usize, pairs: impl Iterator<Item = (u32, u32)> + Clone) -> Self {
        let mut starts = vec![0_u32; keys + 1];
        for (key, _) in pairs.clone() {
            starts[key as usize + 1] += 1;
        }
        for k in 0..keys {
            starts[k + 1] += starts[k];
        }
        let mut values = vec![0; starts[keys] as usize];
        // While filling, a start is where its next value goes; then it is the start of the next key.
        for (key, value) in pairs {
            values[starts[key as usize] as usize] = value;
            starts[key as usize] += 1;
        }
        starts.rotate_right(1);
        starts[0] = 0;
        Self { starts, values }
    }

    fn get(&self, key: usize) -> &[u32] {
        &self.values[self.starts[key] as usize..self.starts[key + 1] as usize]
    }
}
