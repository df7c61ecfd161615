//! STL, binary and ASCII, its equal vertices made one.
//!
//! Read here and not by a library: the one there is takes every binary file that starts with `solid` for ASCII, stops
//! after the first of several solids, and does not say where a fault is.

use super::{Fault, RawMesh};
use nalgebra::Point3;
use std::collections::HashMap;

const HEADER: usize = 80;
const COUNT: usize = 4;
const FACET: usize = 50;

/// Reads an STL file.
///
/// A file is binary if its length is the one that its header promises, and else ASCII if it starts with `solid`.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let promised = promised_length(bytes);
    if promised == Some(bytes.len()) {
        return read_binary(&bytes[HEADER + COUNT..]);
    }
    if bytes.trim_ascii_start().starts_with(b"solid") {
        return read_ascii(&String::from_utf8_lossy(bytes));
    }
    let length = bytes.len();
    Err(Fault::whole(match promised {
        Some(promised) if promised > length => {
            format!("not an STL file, or cut off: its header promises {promised} bytes, but it has {length}")
        }
        Some(promised) => format!("not an STL file: its header promises {promised} bytes, but it has {length}"),
        None => format!(
            "not an STL file: it does not start with `solid`, and a binary one has at least {} bytes, not {length}",
            HEADER + COUNT
        ),
    }))
}

/// The length that the header of a binary file promises.
fn promised_length(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER..HEADER + COUNT)?;
    let count = u32::from_le_bytes(count.try_into().ok()?) as usize;
    count.checked_mul(FACET)?.checked_add(HEADER + COUNT)
}

fn read_binary(facets: &[u8]) -> Result<RawMesh, Fault> {
    let mut welder = Welder::default();
    for (number, facet) in facets.chunks_exact(FACET).enumerate() {
        // A normal, which follows from the vertices, then three vertices, then two bytes that mean nothing.
        let float = |i: usize| {
            let mut word = [0; 4];
            word.copy_from_slice(&facet[4 * i..4 * i + 4]);
            f64::from(f32::from_le_bytes(word))
        };
        let corner = |c: usize| [float(3 + 3 * c), float(4 + 3 * c), float(5 + 3 * c)];
        let corners = [corner(0), corner(1), corner(2)];
        if let Some(x) = corners.iter().flatten().find(|x| !x.is_finite()) {
            let byte = HEADER + COUNT + FACET * number;
            return Err(Fault::whole(format!(
                "facet {number} (byte {byte}) has the coordinate {x}, which is not finite"
            )));
        }
        welder.facet(corners)?;
    }
    Ok(welder.mesh)
}

/// Reads the `vertex` lines of all solids, three to a facet.
fn read_ascii(text: &str) -> Result<RawMesh, Fault> {
    let mut welder = Welder::default();
    let mut corners: Vec<[f64; 3]> = Vec::with_capacity(3);
    // The keyword that opened the facet, its loop or the solid last, to see that they nest.
    let mut open: Vec<(&str, usize)> = Vec::new();
    for (line, words) in text.lines().enumerate().map(|(i, l)| (i + 1, l.split_ascii_whitespace())) {
        let words: Vec<&str> = words.collect();
        let Some(&word) = words.first() else { continue };
        match (word, open.last().map(|(word, _)| *word)) {
            ("solid", None) | ("facet", Some("solid")) | ("outer", Some("facet")) => open.push((word, line)),
            ("vertex", Some("outer")) => corners.push(vertex(&words[1..], line)?),
            ("endloop", Some("outer")) => {
                open.pop();
                let [a, b, c] = corners[..] else {
                    return Err(Fault::at(line, format!("a facet has three vertices, not {}", corners.len())));
                };
                welder.facet([a, b, c])?;
                corners.clear();
            }
            ("endfacet", Some("facet")) | ("endsolid", Some("solid")) => {
                open.pop();
            }
            _ => {
                let word: String = word.chars().take(20).collect();
                return Err(Fault::at(line, format!("`{}` does not belong here in an STL file", word.escape_debug())));
            }
        }
    }
    match open.last() {
        None => Ok(welder.mesh),
        Some((word, line)) => Err(Fault::at(*line, format!("the file is cut off: this `{word}` is never ended"))),
    }
}

fn vertex(words: &[&str], line: usize) -> Result<[f64; 3], Fault> {
    let mut corner = [0.0; 3];
    if words.len() != corner.len() {
        return Err(Fault::at(line, format!("a vertex has three coordinates, not {}", words.len())));
    }
    for (x, word) in corner.iter_mut().zip(words) {
        *x = match word.parse::<f64>() {
            Ok(x) if x.is_finite() => x,
            Ok(_) => return Err(Fault::at(line, format!("the coordinate `{word}` is not finite"))),
            Err(_) => return Err(Fault::at(line, format!("the coordinate `{word}` is not a number"))),
        };
    }
    Ok(corner)
}

/// Gives vertices with equal coordinates one number.
#[derive(Default)]
struct Welder {
    mesh: RawMesh,
    numbers: HashMap<[u64; 3], u32>,
}

impl Welder {
    fn facet(&mut self, corners: [[f64; 3]; 3]) -> Result<(), Fault> {
        let mut face = [0; 3];
        for (number, corner) in face.iter_mut().zip(corners) {
            // -0 + 0 is 0: both zeros are one coordinate.
            let bits = corner.map(|x| (x + 0.0).to_bits());
            let vertices = &mut self.mesh.vertices;
            let next = u32::try_from(vertices.len()).map_err(|_| Fault::whole("the mesh has 2^32 vertices or more"))?;
            *number = *self.numbers.entry(bits).or_insert_with(|| {
                vertices.push(Point3::from(corner));
                next
            });
        }
        self.mesh.faces.push(face);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASCII: &str = "solid a hill\n facet normal 0 0 1\n  outer loop\n   vertex 0 -0 0\n   vertex 1e0 0 0\n   vertex 0 1 0.1\n\
        endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n   vertex 1 0 0\n   vertex 1 1 0\n   vertex 0 1 0.1\n  endloop\n\
        endfacet\nendsolid a hill\nsolid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid\n";

    /// The facets of `ASCII` in binary, behind a header that looks like ASCII.
    fn binary() -> Vec<u8> {
        let mut bytes = b"solid but binary".to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend(3_u32.to_le_bytes());
        let facets: [[f32; 9]; 3] = [
            [0., -0., 0., 1., 0., 0., 0., 1., 0.1],
            [1., 0., 0., 1., 1., 0., 0., 1., 0.1],
            [0., 0., 0., 1., 0., 0., 0., 0., 1.],
        ];
        for facet in facets {
            bytes.extend([0; 12]);
            facet.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            bytes.extend([7; 2]);
        }
        bytes
    }

    #[test]
    fn equal_vertices_are_one_in_all_solids_and_zeros_are_equal() {
        let mesh = read(ASCII.as_bytes()).unwrap_or_else(|fault| panic!("{fault:?}"));
        assert_eq!(mesh.faces, [[0, 1, 2], [1, 3, 2], [0, 1, 4]]);
        assert_eq!(mesh.vertices[2], Point3::new(0.0, 1.0, 0.1));
        let same = read(&binary()).unwrap_or_else(|fault| panic!("{fault:?}"));
        assert_eq!(same.faces, mesh.faces);
        // A binary file holds f32.
        assert_eq!(same.vertices[2].z, f64::from(0.1_f32));
    }

    #[test]
    fn a_file_cut_off_anywhere_is_an_error_and_never_panics() {
        let binary = binary();
        assert!((0..binary.len()).all(|end| read(&binary[..end]).is_err()));
        for end in 0..ASCII.len() {
            // Between its solids an ASCII file is complete.
            let depth = ASCII[..end].matches("solid").count() - 2 * ASCII[..end].matches("endsolid").count();
            assert!(read(&ASCII.as_bytes()[..end]).is_err() || depth == 0, "{end}");
        }
    }
}
