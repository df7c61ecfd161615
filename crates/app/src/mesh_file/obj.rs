//! Wavefront OBJ: the `v` and `f` lines, in f64, each fault with its line.
//!
//! Read here and not by a library, because what a collision mesh needs is what the libraries drop: indices of the file as
//! they are (a vertex on a texture seam or in two groups stays one vertex), f64, and the line of every fault.

use super::polygonize::polygonize;
use super::{Fault, RawMesh};
use nalgebra::Point3;
use std::str::SplitAsciiWhitespace;

/// The keywords that a mesh file may hold beside `v` and `f`; they say nothing about where the faces are.
const SKIPPED: [&str; 19] = [
    "vt",
    "vn",
    "vp",
    "o",
    "g",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "l",
    "p",
    "lod",
    "bevel",
    "c_interp",
    "d_interp",
    "maplib",
    "usemap",
    "shadow_obj",
    "trace_obj",
];

/// Reads an OBJ file.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let text = String::from_utf8_lossy(bytes);
    let mut mesh = RawMesh::default();
    let mut faces: Vec<(usize, Vec<u32>)> = Vec::new();
    let mut joined = String::new();
    for (number, line) in text.lines().enumerate().map(|(i, line)| (i + 1, line)) {
        let line = line.split('#').next().unwrap_or("").trim_end();
        // A backslash continues the line.
        if let Some(start) = line.strip_suffix('\\') {
            joined.push_str(start);
            joined.push(' ');
            continue;
        }
        joined.push_str(line);
        let mut words = joined.split_ascii_whitespace();
        match words.next() {
            None => {}
            Some("v") => mesh.vertices.push(vertex(words, number)?),
            Some("f") => faces.push((number, face(words, mesh.vertices.len(), number)?)),
            Some(word) if SKIPPED.contains(&word) => {}
            Some(word) => {
                let word: String = word.chars().take(20).collect();
                return Err(Fault::at(number, format!("`{}` is no statement of an OBJ mesh", word.escape_debug())));
            }
        }
        joined.clear();
    }
    // A face may name vertices of later lines, so the upper bound is known only now.
    for (line, corners) in &faces {
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= mesh.vertices.len()) {
            let n = mesh.vertices.len();
            return Err(Fault::at(
                *line,
                format!("the face names vertex {}, but the file has {n} vertices", u64::from(index) + 1),
            ));
        }
    }
    for (line, corners) in faces {
        mesh.faces.extend(polygonize(&mesh.vertices, &corners).map_err(|message| Fault::at(line, message))?);
    }
    Ok(mesh)
}

fn vertex(mut words: SplitAsciiWhitespace<'_>, line: usize) -> Result<Point3<f64>, Fault> {
    let mut coordinate = || {
        let word = words.next().ok_or_else(|| Fault::at(line, "a vertex needs three coordinates: v x y z"))?;
        match word.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            Ok(_) => Err(Fault::at(line, format!("the coordinate `{word}` is not finite"))),
            Err(_) => Err(Fault::at(line, format!("the coordinate `{word}` is not a number"))),
        }
    };
    // A weight or a colour may follow; the shape does not depend on it.
    Ok(Point3::new(coordinate()?, coordinate()?, coordinate()?))
}

/// The corners of a face from 0; indices count from 1, or back from the last vertex if negative.
fn face(words: SplitAsciiWhitespace<'_>, vertices: usize, line: usize) -> Result<Vec<u32>, Fault> {
    words
        .map(|word| {
            let index = word.split('/').next().unwrap_or(word);
            let fault = |why: &str| Fault::at(line, format!("the vertex index `{word}` of the face {why}"));
            match index.parse::<i64>() {
                Err(_) => Err(fault("is not a whole number")),
                Ok(0) => Err(fault("is 0, but indices count from 1")),
                Ok(i) if i > 0 => u32::try_from(i - 1).map_err(|_| fault("is too large")),
                Ok(i) => {
                    let before = i64::try_from(vertices).ok().and_then(|n| n.checked_add(i)).filter(|&n| n >= 0);
                    let before = before.and_then(|n| u32::try_from(n).ok());
                    before
                        .ok_or_else(|| fault(&format!("goes back beyond the first of the {vertices} vertices so far")))
                }
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reads(text: &str) -> RawMesh {
        read(text.as_bytes()).unwrap_or_else(|fault| panic!("{fault:?}"))
    }

    #[test]
    fn coordinates_are_the_nearest_f64_and_indices_those_of_the_file() {
        let mesh = reads(
            "v 0.0811990914301 -0 1e-310\nv 1 0 0 # a comment\nv 0 1 0 0.5 0.5 0.5\nvt 0 0\nvt 1 1\ng other\nf 1/1 2/2 3/1\n",
        );
        assert_eq!(mesh.vertices[0], Point3::new(0.0811990914301, -0.0, 1e-310));
        assert_eq!((mesh.vertices.len(), mesh.faces), (3, vec![[0, 1, 2]]));
    }

    #[test]
    fn indices_may_count_back_name_later_vertices_and_run_over_lines() {
        let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        assert_eq!(reads(&format!("{vertices}f -3//1 -2//1 -1//1\n")).faces, [[0, 1, 2]]);
        assert_eq!(reads(&format!("f 1 2 3\r\n{vertices}")).faces, [[0, 1, 2]]);
        assert_eq!(reads(&format!("{vertices}f 1 \\\n2 3")).faces, [[0, 1, 2]]);
    }

    #[test]
    fn a_file_cut_off_anywhere_never_panics() {
        let text = b"# \xff\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nv -1 0.5 0\nf 1 2 3 4 \\\n5\nf -1 -2 -3 -4\n";
        for end in 0..=text.len() {
            // Whether it is an error depends on where it is cut.
            let _ = read(&text[..end]);
        }
        assert_eq!(read(text).map(|mesh| mesh.faces.len()).ok(), Some(5));
    }
}
