//! How the surface goes on across an edge, decided exactly but for what the rounding of coordinates leaves of a plane.

use nalgebra::{Point2, Point3, Vector3};

use super::topology::Topology;
use crate::predicates::{Sign, orient2d, orient3d};
use crate::rounding::{LARGEST_ROUNDED_FOLD, exponent, fold_bound, scale};

/// How the surface goes on across an edge of a face, seen from the front of the face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fold {
    /// It ends: there is no other face, or the other has no area or lies back on this one.
    Rim,
    /// It goes on in the same plane, exactly or as nearly as rounded coordinates tell, or is declared to.
    Flat,
    /// It falls away, as at the ridge of a roof: a ball can touch the edge.
    Convex,
    /// It rises, as at the foot of a wall: a ball touches the faces before it could touch the edge.
    Concave,
    /// More than two faces meet.
    NonManifold,
}

impl Fold {
    const ALL: [Self; 5] = [Self::Rim, Self::Flat, Self::Convex, Self::Concave, Self::NonManifold];

    /// The same edge seen from the back of the face: convex and concave change places.
    pub fn from_back(self) -> Self {
        match self {
            Self::Convex => Self::Concave,
            Self::Concave => Self::Convex,
            other => other,
        }
    }

    pub(super) fn bits(self) -> u32 {
        self as u32
    }

    pub(super) fn from_bits(bits: u32) -> Self {
        Self::ALL.get(bits as usize).copied().unwrap_or(Self::NonManifold)
    }
}

/// Decides the fold of every edge; a face of no area has the normal zero.
pub(super) fn folds(topology: &mut Topology, vertices: &[Point3<f64>], faces: &[[u32; 3]], normals: &[Vector3<f64>]) {
    let at = |face: u32, corner: u32| &vertices[faces[face as usize][corner as usize % 3] as usize];
    let has_area = |face: u32| normals[face as usize] != Vector3::zeros();
    for h in 0..topology.len() {
        let (face, side) = (h / 3, h % 3);
        let Some(twin) = topology.twin(h) else {
            if topology.next(h) != h {
                topology.set_fold(h, Fold::NonManifold);
            }
            continue;
        };
        let other = twin / 3;
        if twin < h || other == face || !has_area(face) || !has_area(other) {
            // Already decided by its twin, or a rim as it stands.
            continue;
        }
        let triangle = [at(face, side), at(face, side + 1), at(face, side + 2)];
        let fold = fold(triangle, at(other, twin % 3 + 2));
        topology.set_fold(h, fold);
        // Neighbours wound alike run along their edge in opposite directions, and have their fronts on the same side.
        let alike = topology.ends(faces, h)[0] != topology.ends(faces, twin)[0];
        topology.set_fold(twin, if alike { fold } else { fold.from_back() });
    }
}

/// Declares every edge between two faces flat.
pub(super) fn planar_folds(topology: &mut Topology) {
    for h in 0..topology.len() {
        if topology.next(h) != h {
            topology.set_fold(h, if topology.twin(h).is_some() { Fold::Flat } else { Fold::NonManifold });
        }
    }
}

/// The fold of edge a b of the triangle a b c, of which the neighbour's third corner is d; neither has zero area.
fn fold([a, b, c]: [&Point3<f64>; 3], d: &Point3<f64>) -> Fold {
    if is_rounding([a, b, c], d) {
        return Fold::Flat;
    }
    match orient3d(a, b, c, d) {
        Sign::Positive => Fold::Concave,
        Sign::Negative => Fold::Convex,
        Sign::Zero => {
            // In one plane: on different sides of the edge, or one upon the other? Any projection in which a b c keeps an
            // area tells.
            let opposite = (0..3).find_map(|i| {
                let flat = |p: &Point3<f64>| Point2::new(p[i], p[(i + 1) % 3]);
                let own = orient2d(&flat(a), &flat(b), &flat(c));
                (own != Sign::Zero).then(|| orient2d(&flat(a), &flat(b), &flat(d)) == own.reverse())
            });
            if opposite == Some(true) { Fold::Flat } else { Fold::Rim }
        }
    }
}

/// Whether the triangles a b c and a b d, on different sides of a b, are in one plane as nearly as their rounded coordinates can tell: a
/// plane that was turned has folds of some u, and a ball that rolls over them must not know.
fn is_rounding([a, b, c]: [&Point3<f64>; 3], d: &Point3<f64>) -> bool {
    let edges = [b - a, c - a, d - a];
    let size = edges.iter().map(|e| e.amax()).fold(0.0, f64::max);
    let extent = [a, b, c, d].iter().map(|p| p.coords.amax()).fold(0.0, f64::max);
    // In a unit in which no product vanishes.
    let k = -exponent(size);
    let [ab, ac, ad] = edges.map(|e| e.map(|x| scale(x, k)));
    let (one, other) = (ab.cross(&ac), ab.cross(&ad));
    let length = ab.norm();
    let bound = fold_bound(scale(extent, k), one.norm() / length, other.norm() / length);
    let sine = (one.dot(&ad) * length).abs();
    bound <= LARGEST_ROUNDED_FOLD && one.dot(&other) < 0.0 && sine <= bound * one.norm() * other.norm()
}

/// Gives all faces that hang together by flat edges the normal of the first of them, with the sign of their own.
pub(super) fn share_normals(topology: &Topology, normals: &mut [Vector3<f64>]) {
    let mut first: Vec<u32> = (0..normals.len() as u32).collect();
    let root = |first: &mut [u32], mut f: u32| {
        while first[f as usize] != f {
            // Halving the way for those who come later.
            first[f as usize] = first[first[f as usize] as usize];
            f = first[f as usize];
        }
        f
    };
    for h in (0..topology.len()).filter(|&h| topology.fold(h) == Fold::Flat) {
        let (a, b) = (root(&mut first, h / 3), root(&mut first, topology.next(h) / 3));
        first[a.max(b) as usize] = a.min(b);
    }
    for f in 0..normals.len() {
        let shared = normals[root(&mut first, f as u32) as usize];
        // Both are within a few roundings of the same line, so that the sign is that of their windings.
        normals[f] = if shared.dot(&normals[f]) >= 0.0 { shared } else { -shared };
    }
}
