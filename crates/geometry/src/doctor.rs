//! What is wrong with a mesh, face by face.

use std::fmt;

use nalgebra::Point3;

use crate::mesh::{MOST_FACES, MeshError, Topology, first_at_same_place};
use crate::predicates::collinear;

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// May be meant: an open terrain, a vertex to spare.
    Note,
    /// Works, but hardly as meant.
    Warning,
    /// Not a mesh: [`Mesh::new`](crate::mesh::Mesh::new) refuses it.
    Error,
}

/// Something about a mesh that its owner should know. Faces and vertices go by their numbers from 0; side i of a face
/// runs from its corner i to its corner i + 1.
///
/// ```
/// use carom_geometry::doctor::{Finding, Severity, diagnose};
/// use carom_geometry::nalgebra::Point3;
///
/// let vertices = [Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0), Point3::new(2.0, 0.0, 0.0)];
/// let findings = diagnose(&vertices, &[[0, 1, 2], [0, 1, 3]]);
/// // The second face has its corners on one line.
/// assert!(findings.contains(&Finding::ZeroArea { face: 1 }));
/// assert!(findings.iter().all(|finding| finding.severity() < Severity::Error), "it is a mesh all the same");
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Finding {
    /// What a mesh must not have: no faces or too many, a coordinate that is not finite, a vertex that does not exist.
    Invalid(MeshError),
    /// The corners lie exactly on one line, or coincide: the face has no normal.
    ZeroArea {
        /// The face.
        face: u32,
    },
    /// Two faces with corners at the same three places, in any order.
    DuplicateFace {
        /// The first face there.
        first: u32,
        /// The one that repeats it.
        again: u32,
    },
    /// An edge with more than two faces.
    NonManifold {
        /// Its ends, the lower number first.
        vertices: [u32; 2],
        /// The faces, ascending; one that has the edge twice is there twice.
        faces: Vec<u32>,
    },
    /// Two faces that run along their common edge in the same direction: their normals point to different sides.
    InconsistentWinding {
        /// The ends of the edge, the lower number first.
        vertices: [u32; 2],
        /// The faces, ascending.
        faces: [u32; 2],
    },
    /// Several vertices at the same place. Faces that use different ones of them are not neighbours; see
    /// [`weld`](crate::mesh::weld).
    DuplicateVertices {
        /// The vertices, ascending.
        vertices: Vec<u32>,
    },
    /// The edges with one face only.
    Open {
        /// Face and side of each, ascending.
        sides: Vec<(u32, usize)>,
    },
    /// No face uses the vertex.
    UnusedVertex {
        /// The vertex.
        vertex: u32,
    },
}

impl Finding {
    /// How much it matters.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Invalid(_) => Severity::Error,
            Self::Open { .. } | Self::UnusedVertex { .. } => Severity::Note,
            _ => Severity::Warning,
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(error) => error.fmt(f),
            Self::ZeroArea { face } => write!(f, "face {face} has no area: its corners lie on one line"),
            Self::DuplicateFace { first, again } => write!(f, "face {again} has the same corners as face {first}"),
            Self::NonManifold { vertices: [a, b], faces } => {
                write!(f, "the edge from vertex {a} to {b} has {} faces: {}", faces.len(), List(faces))
            }
            Self::InconsistentWinding { vertices: [a, b], faces: [g, h] } => {
                write!(f, "faces {g} and {h}, at the edge from vertex {a} to {b}, are wound differently")
            }
            Self::DuplicateVertices { vertices } => {
                write!(f, "{} vertices are at the same place: {}", vertices.len(), List(vertices))
            }
            Self::Open { sides } => {
                let mut faces: Vec<_> = sides.iter().map(|side| side.0).collect();
                faces.dedup();
                write!(f, "the mesh is open: {} edges have one face only, those of faces {}", sides.len(), List(&faces))
            }
            Self::UnusedVertex { vertex } => write!(f, "vertex {vertex} is in no face"),
        }
    }
}

/// The first numbers of a list, and how many more there are.
struct List<'a>(&'a [u32]);

impl fmt::Display for List<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 8;
        for (k, number) in self.0.iter().take(SHOWN).enumerate() {
            write!(f, "{}{number}", if k == 0 { "" } else { ", " })?;
        }
        match self.0.len().saturating_sub(SHOWN) {
            0 => Ok(()),
            more => write!(f, " and {more} more"),
        }
    }
}

/// Everything about the mesh that its owner should know, in the order of the variants of [`Finding`], each by ascending
/// number. There is an [error](Severity::Error) if and only if [`Mesh::new`](crate::mesh::Mesh::new) refuses the mesh;
/// faces with a vertex that does not exist are left out of the rest.
pub fn diagnose(vertices: &[Point3<f64>], faces: &[[u32; 3]]) -> Vec<Finding> {
    let mut findings: Vec<_> = MeshError::all(vertices, faces).map(Finding::Invalid).collect();
    if faces.len() > MOST_FACES || vertices.len() > u32::MAX as usize {
        return findings;
    }
    let (numbers, faces): (Vec<u32>, Vec<[u32; 3]>) =
        (0..).zip(faces).filter(|(_, f)| f.iter().all(|&v| (v as usize) < vertices.len())).unzip();
    let first_there = first_at_same_place(vertices);
    findings.extend(zero_areas(vertices, &numbers, &faces));
    findings.extend(duplicate_faces(&first_there, &numbers, &faces));
    let topology = Topology::of(vertices.len(), &faces);
    findings.extend(edges(&topology, &numbers, &faces));
    findings.extend(vertices_at_one_place(&first_there));
    findings.extend(open_sides(&topology, &numbers));
    findings.extend(unused_vertices(vertices.len(), &faces));
    findings
}

fn zero_areas(vertices: &[Point3<f64>], numbers: &[u32], faces: &[[u32; 3]]) -> Vec<Finding> {
    let flat = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| &vertices[v as usize]);
        [a, b, c].iter().all(|p| p.iter().all(|x| x.is_finite())) && collinear(a, b, c)
    };
    let found = numbers.iter().zip(faces).filter(|(_, corners)| flat(corners));
    found.map(|(&face, _)| Finding::ZeroArea { face }).collect()
}

fn duplicate_faces(first_there: &[u32], numbers: &[u32], faces: &[[u32; 3]]) -> Vec<Finding> {
    let places = |corners: &[u32; 3]| {
        let mut places = corners.map(|v| first_there[v as usize]);
        places.sort_unstable();
        places
    };
    let mut sorted: Vec<_> = numbers.iter().zip(faces).map(|(&face, corners)| (places(corners), face)).collect();
    sorted.sort_unstable();
    let groups = sorted.chunk_by(|a, b| a.0 == b.0);
    let mut pairs: Vec<_> = groups.flat_map(|g| g[1..].iter().map(|again| (g[0].1, again.1))).collect();
    pairs.sort_unstable();
    pairs.into_iter().map(|(first, again)| Finding::DuplicateFace { first, again }).collect()
}

/// Edges of too many faces, then those with two that are wound differently.
fn edges(topology: &Topology, numbers: &[u32], faces: &[[u32; 3]]) -> Vec<Finding> {
    let number = |h: u32| numbers[h as usize / 3];
    let (mut crowded, mut wound) = (Vec::new(), Vec::new());
    for h in (0..topology.len()).filter(|&h| topology.owner(h) == h) {
        let [a, b] = topology.ends(faces, h);
        let ends = [a.min(b), a.max(b)];
        match topology.ring(h).collect::<Vec<_>>()[..] {
            [_] => {}
            [g, h] if g / 3 != h / 3 && topology.ends(faces, g) == topology.ends(faces, h) && a != b => {
                wound.push(Finding::InconsistentWinding { vertices: ends, faces: [number(g), number(h)] });
            }
            [_, _] => {}
            ref ring => {
                crowded.push(Finding::NonManifold { vertices: ends, faces: ring.iter().map(|&g| number(g)).collect() })
            }
        }
    }
    crowded.append(&mut wound);
    crowded
}

fn vertices_at_one_place(first_there: &[u32]) -> Vec<Finding> {
    let mut moved: Vec<(u32, u32)> =
        first_there.iter().zip(0..).filter(|&(&first, v)| first != v).map(|(&first, v)| (first, v)).collect();
    moved.sort_unstable();
    let groups = moved.chunk_by(|a, b| a.0 == b.0);
    let all = groups.map(|g| std::iter::once(g[0].0).chain(g.iter().map(|m| m.1)).collect());
    all.map(|vertices| Finding::DuplicateVertices { vertices }).collect()
}

fn open_sides(topology: &Topology, numbers: &[u32]) -> Option<Finding> {
    let rim = (0..topology.len()).filter(|&h| topology.next(h) == h);
    let sides: Vec<_> = rim.map(|h| (numbers[h as usize / 3], h as usize % 3)).collect();
    (!sides.is_empty()).then_some(Finding::Open { sides })
}

fn unused_vertices(count: usize, faces: &[[u32; 3]]) -> Vec<Finding> {
    let mut used = vec![false; count];
    faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    used.iter().zip(0..).filter(|(used, _)| !**used).map(|(_, vertex)| Finding::UnusedVertex { vertex }).collect()
}

#[cfg(test)]
mod tests;
