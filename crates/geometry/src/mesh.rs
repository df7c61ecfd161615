//! Triangle meshes with their topology.

mod fold;
mod topology;
mod weld;

use nalgebra::{Point3, UnitVector3, Vector3};
use rayon::prelude::*;
use std::collections::BTreeSet;
use thiserror::Error;

use crate::bounds::Aabb;
use crate::bvh::Bvh;
use crate::normal::unit_normal;
use crate::polygon::Polygon;
pub use fold::Fold;
use fold::{folds, planar_folds, share_normals};
pub(crate) use topology::Topology;
use topology::VertexFaces;
pub(crate) use weld::first_at_same_place;
pub use weld::weld;

/// The most faces a mesh can have: the number of a half-edge leaves three bits of a u32 for its fold.
pub const MOST_FACES: usize = (1 << 29) / 3;

/// Why vertices and faces are not a mesh.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no face.
    #[error("the mesh has no faces; give at least one triangle")]
    Empty,
    /// There are more vertices or faces than can be numbered.
    #[error("the mesh has {count} {what}; at most {most} can be numbered")]
    TooLarge {
        /// `vertices` or `faces`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} has the coordinate {}{value}; all must be finite", ["x = ", "y = ", "z = "][*.axis])]
    NonFinite {
        /// The number of the vertex, from 0.
        vertex: usize,
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// The coordinate.
        value: f64,
    },
    /// A face names a vertex that is not there.
    #[error("corner {corner} of face {face} is vertex {index}, but there are {vertices} vertices, numbered from 0")]
    IndexOutOfRange {
        /// The number of the face, from 0.
        face: usize,
        /// 0, 1 or 2.
        corner: usize,
        /// The number it gives.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
}

impl MeshError {
    /// All that keeps `vertices` and `faces` from being a mesh, sizes first, then vertices, then faces.
    pub fn all(vertices: &[Point3<f64>], faces: &[[u32; 3]]) -> impl Iterator<Item = Self> {
        let size = |what, count, most| (count > most).then_some(Self::TooLarge { what, count, most });
        let count = vertices.len();
        let empty = faces.is_empty().then_some(Self::Empty);
        let points = vertices.iter().enumerate().flat_map(|(vertex, p)| {
            let bad = (0..3).filter(|&axis| !p[axis].is_finite());
            bad.map(move |axis| Self::NonFinite { vertex, axis, value: p[axis] })
        });
        let corners = faces.iter().enumerate().flat_map(move |(face, corners)| {
            let bad = (0..3).filter(move |&corner| corners[corner] as usize >= count);
            bad.map(move |corner| Self::IndexOutOfRange { face, corner, index: corners[corner], vertices: count })
        });
        let sizes = [empty, size("vertices", count, u32::MAX as usize), size("faces", faces.len(), MOST_FACES)];
        sizes.into_iter().flatten().chain(points).chain(corners)
    }
}

/// An edge of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edge {
    /// Its ends, the lower number first.
    pub vertices: [u32; 2],
    /// The face with the lowest number on it, and which of its sides it is.
    pub owner: (u32, usize),
    /// The next face on it, if there is one; the owner again where a face has the edge twice.
    pub other: Option<u32>,
    /// How many sides of faces lie on it.
    pub count: usize,
    /// How the surface goes on there, seen from the front of the owner.
    pub fold: Fold,
}

/// Triangles over shared vertices, with what a moving ball needs to know about them: normals, neighbours, how each edge
/// is folded, and a tree to find them by.
///
/// Faces and vertices go by their place in the lists it was made of; as with these, a place beyond their end panics. Side
/// i of a face runs from corner i to corner i + 1. Coordinates are any finite f64, in the user's unit, usually m. Every
/// set of faces is a mesh: open, with edges of many faces, with faces of no area, wound anyhow. A face with the three corners of an
/// earlier one adds nothing: no query finds it, and its sides are on no edge. What of this is meant is the question of
/// [`diagnose`](crate::doctor::diagnose).
///
/// Takes about 100 bytes a face beside the vertices.
///
/// ```
/// use carom_geometry::contact::MovingBall;
/// use carom_geometry::mesh::Mesh;
/// use carom_geometry::nalgebra::{Point3, Vector3};
/// use carom_geometry::path::Path;
/// use carom_geometry::rounding::SEGMENT_FRACTION_BOUND;
/// use carom_geometry::sweep::Work;
///
/// // A tetrahedron: four vertices, four faces that turn counter-clockwise seen from outside.
/// let vertices = vec![Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0), Point3::new(0.0, 0.0, 1.0)];
/// let mesh = Mesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// assert!(mesh.edges().all(|edge| edge.count == 2), "it is closed");
///
/// // What a segment from below meets first, and where: never late, early by the bound at most. The work says what that took.
/// let mut work = Work::default();
/// let pierced = mesh.first_pierced(&Point3::new(0.25, 0.25, -1.0), &Point3::new(0.25, 0.25, 1.0), &mut work);
/// assert!(pierced.is_some_and(|hit| hit.face == 0 && (0.5 - SEGMENT_FRACTION_BOUND..=0.5).contains(&hit.f)));
///
/// // When a ball of radius 1/4 on the same way first touches it.
/// let path = Path::line(Point3::new(0.25, 0.25, -1.0), Vector3::new(0.0, 0.0, 2.0));
/// let ball = MovingBall { path: &path, radius: 0.25, holds: &[] };
/// let contact = mesh.first_contact(&ball, 1.0, |_| 0.0, &mut work);
/// assert!(contact.is_some_and(|contact| (contact.f - 0.375).abs() < f64::EPSILON));
/// # Ok::<(), carom_geometry::mesh::MeshError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Mesh {
    vertices: Vec<Point3<f64>>,
    faces: Vec<[u32; 3]>,
    normals: Normals,
    topology: Topology,
    vertex_faces: VertexFaces,
    bvh: Bvh,
    face_size: f64,
}

/// Unit normals by face.
#[derive(Debug, Clone)]
enum Normals {
    /// All faces have this one.
    Shared(UnitVector3<f64>),
    /// One each; zero for a face of no area.
    Each(Vec<Vector3<f64>>),
}

impl Mesh {
    /// The mesh with these vertices and faces.
    ///
    /// Normals, areas of zero and folds are decided exactly. Faces that lie exactly in one plane and hang together by
    /// flat edges have one normal, bit for bit but for the sign that their winding gives it: that of the first of them.
    pub fn new(vertices: Vec<Point3<f64>>, faces: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        refuse_errors(&vertices, &faces)?;
        let normal = |f: &[u32; 3]| unit_normal(&corners(&vertices, f)).map_or_else(Vector3::zeros, |n| n.into_inner());
        let mut normals: Vec<_> = faces.par_iter().map(normal).collect();
        let (mut topology, repeats) = topology_without_repeats(vertices.len(), &faces);
        folds(&mut topology, &vertices, &faces, &normals);
        share_normals(&topology, &mut normals);
        Ok(Self::assemble(vertices, faces, Normals::Each(normals), topology, &repeats))
    }

    /// Faces that are declared to lie in one plane with the unit `normal`, such as the triangles of a polygon: it is the normal
    /// of each, whatever their winding and their last bits, and an edge between two is [`Fold::Flat`].
    pub fn from_planar(
        vertices: Vec<Point3<f64>>,
        faces: Vec<[u32; 3]>,
        normal: UnitVector3<f64>,
    ) -> Result<Self, MeshError> {
        refuse_errors(&vertices, &faces)?;
        Ok(Self::planar(vertices, faces, normal))
    }

    /// The triangles of a polygon, all with its normal and with flat edges between them: a surface on which a ball notices
    /// no triangulation.
    pub fn from_polygon(polygon: &Polygon) -> Self {
        let faces = polygon.triangulate().into_iter().map(|corners| corners.map(|v| v as u32)).collect();
        Self::planar(polygon.vertices().to_vec(), faces, polygon.normal())
    }

    fn planar(vertices: Vec<Point3<f64>>, faces: Vec<[u32; 3]>, normal: UnitVector3<f64>) -> Self {
        let (mut topology, repeats) = topology_without_repeats(vertices.len(), &faces);
        planar_folds(&mut topology);
        Self::assemble(vertices, faces, Normals::Shared(normal), topology, &repeats)
    }

    fn assemble(
        vertices: Vec<Point3<f64>>,
        faces: Vec<[u32; 3]>,
        normals: Normals,
        topology: Topology,
        repeats: &BTreeSet<u32>,
    ) -> Self {
        let corners_of = |f: u32| corners(&vertices, &faces[f as usize]);
        let bounds_of = |f: usize| {
            if repeats.contains(&(f as u32)) { Aabb::empty() } else { Aabb::of_points(&corners_of(f as u32)) }
        };
        let bvh = Bvh::of_faces(faces.len(), bounds_of, corners_of);
        let vertex_faces = VertexFaces::of(vertices.len(), &faces, repeats);
        let face_size = bvh.bounds().extent().amax() / (faces.len() as f64).sqrt();
        Self { vertices, faces, normals, topology, vertex_faces, bvh, face_size }
    }

    /// The vertices, as given.
    pub fn vertices(&self) -> &[Point3<f64>] {
        &self.vertices
    }

    /// The three vertices of each face, as given.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// The corners of a face.
    pub fn triangle(&self, face: u32) -> [Point3<f64>; 3] {
        corners(&self.vertices, &self.faces[face as usize])
    }

    /// The corners of a face, where they are.
    #[inline]
    pub(crate) fn corners(&self, face: u32) -> [&Point3<f64>; 3] {
        let [a, b, c] = self.faces[face as usize];
        [&self.vertices[a as usize], &self.vertices[b as usize], &self.vertices[c as usize]]
    }

    /// The unit normal of a face, from whose tip its corners go round counter-clockwise; `None` if its area is exactly
    /// zero. Of a planar mesh, the declared normal, always.
    pub fn normal(&self, face: u32) -> Option<UnitVector3<f64>> {
        match &self.normals {
            Normals::Shared(n) => Some(*n),
            Normals::Each(all) => {
                let n = all[face as usize];
                (n != Vector3::zeros()).then(|| UnitVector3::new_unchecked(n))
            }
        }
    }

    /// [`normal`](Self::normal) without its promise of unit length: zero of a face of no area.
    #[inline]
    pub(crate) fn plain_normal(&self, face: u32) -> &Vector3<f64> {
        match &self.normals {
            Normals::Shared(n) => n,
            Normals::Each(all) => &all[face as usize],
        }
    }

    /// The corners of a face as seen from `origin`.
    #[inline]
    pub(crate) fn triangle_from(&self, face: u32, origin: &Point3<f64>) -> [Vector3<f64>; 3] {
        let [a, b, c] = self.faces[face as usize];
        let corner = |v: u32| self.vertices[v as usize] - origin;
        [corner(a), corner(b), corner(c)]
    }

    /// The least box around all faces.
    pub fn bounds(&self) -> &Aabb {
        self.bvh.bounds()
    }

    /// The tree over the faces' boxes; its items are the faces.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// About the length of a side of a face, from the size of the mesh and the number of faces.
    pub(crate) fn face_size(&self) -> f64 {
        self.face_size
    }

    /// How the surface goes on across `side` of `face`, seen from the front of `face`: the side its normal points to.
    pub fn fold(&self, face: u32, side: usize) -> Fold {
        self.topology.fold(half_edge(face, side))
    }

    /// The edge at `side` of `face`.
    pub fn edge(&self, face: u32, side: usize) -> Edge {
        let ring = || self.topology.ring(half_edge(face, side));
        let owner = self.topology.owner(half_edge(face, side));
        let [a, b] = self.topology.ends(&self.faces, owner);
        let other = self.topology.next(owner);
        Edge {
            vertices: [a.min(b), a.max(b)],
            owner: (owner / 3, (owner % 3) as usize),
            other: (other != owner).then_some(other / 3),
            count: ring().count(),
            fold: self.topology.fold(owner),
        }
    }

    /// Every edge once, in the order of their owners.
    pub fn edges(&self) -> impl Iterator<Item = Edge> {
        let own = (0..self.topology.len()).filter(|&h| self.topology.owner(h) == h && !self.is_repeat(h / 3));
        own.map(|h| self.edge(h / 3, (h % 3) as usize))
    }

    /// Whether an earlier face has the same three corners.
    fn is_repeat(&self, face: u32) -> bool {
        !self.vertex_faces(self.faces[face as usize][0]).contains(&face)
    }

    /// The other faces at `side` of `face`: one inside a well-formed surface, none at its rim.
    pub fn neighbours(&self, face: u32, side: usize) -> impl Iterator<Item = u32> {
        self.topology.ring(half_edge(face, side)).skip(1).map(|h| h / 3)
    }

    /// Whether the edge at `side` is counted as this face's: exactly one face owns an edge, the one with the lowest number.
    pub fn owns_edge(&self, face: u32, side: usize) -> bool {
        let h = half_edge(face, side);
        self.topology.owner(h) == h
    }

    /// Whether the vertex at `corner` is counted as this face's: exactly one face owns a used vertex, the one with the
    /// lowest number.
    pub fn owns_vertex(&self, face: u32, corner: usize) -> bool {
        self.vertex_faces(self.faces[face as usize][corner]).first() == Some(&face)
    }

    /// The faces around a vertex, each once, in ascending order.
    pub fn vertex_faces(&self, vertex: u32) -> &[u32] {
        self.vertex_faces.around(vertex)
    }

    /// Whether all faces around a vertex lie in one plane and go all the way round it.
    pub fn is_level(&self, vertex: u32) -> bool {
        let ends_here = |face: u32, side: usize| {
            let corners = self.faces[face as usize];
            corners[side] == vertex || corners[(side + 1) % 3] == vertex
        };
        let level = |face: u32| (0..3).all(|side| !ends_here(face, side) || self.fold(face, side) == Fold::Flat);
        self.vertex_faces(vertex).iter().all(|&face| level(face))
    }

    /// The memory it takes beside the vertices, in bytes.
    pub fn bytes(&self) -> usize {
        let normals = match &self.normals {
            Normals::Shared(_) => 0,
            Normals::Each(all) => size_of_val(all.as_slice()),
        };
        size_of_val(self.faces.as_slice())
            + normals
            + self.topology.bytes()
            + self.vertex_faces.bytes()
            + self.bvh.bytes()
    }
}

/// How the faces hang together when none is there twice, and those that would be.
fn topology_without_repeats(vertices: usize, faces: &[[u32; 3]]) -> (Topology, BTreeSet<u32>) {
    let all = Topology::of(vertices, faces);
    let repeats = all.repeats(faces);
    let topology = if repeats.is_empty() { all } else { Topology::without(vertices, faces, &repeats) };
    (topology, repeats)
}

fn refuse_errors(vertices: &[Point3<f64>], faces: &[[u32; 3]]) -> Result<(), MeshError> {
    MeshError::all(vertices, faces).next().map_or(Ok(()), Err)
}

fn corners(vertices: &[Point3<f64>], face: &[u32; 3]) -> [Point3<f64>; 3] {
    face.map(|v| vertices[v as usize])
}

fn half_edge(face: u32, side: usize) -> u32 {
    3 * face + side as u32
}

#[cfg(test)]
mod tests;
