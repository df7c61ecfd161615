//! PLY, ASCII and binary: the elements `vertex` and `face`.

use super::polygonize::polygonize;
use super::{Fault, RawMesh};
use nalgebra::Point3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// Reads a PLY file.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let mut reader = Reader::new(bytes);
    let header = Parser::<Skipped>::new().read_header(&mut reader).map_err(fault)?;
    let lacks = |element: &str, names: &[&str]| {
        let definition = header.elements.get(element);
        names.iter().find(|name| definition.is_none_or(|d| !d.properties.contains_key(**name))).map(|name| {
            Fault::whole(format!("not a mesh in PLY: its header gives the element `{element}` no property `{name}`"))
        })
    };
    let fault_of_faces = lacks("face", &["vertex_index"]).and(lacks("face", &["vertex_indices"]));
    if let Some(fault) = lacks("vertex", &["x", "y", "z"]).or(fault_of_faces) {
        return Err(fault);
    }
    // An element takes up a byte or more; one without properties would take none, and a count of 10^18 no end.
    if let Some(element) = header.elements.values().find(|e| e.count > bytes.len()) {
        let (name, count) = (&element.name, element.count);
        return Err(Fault::whole(format!(
            "the header promises {count} elements `{name}`, but the file has {} bytes",
            bytes.len()
        )));
    }
    let mut mesh = RawMesh::default();
    let mut faces = Vec::new();
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => {
                let read = Parser::<Vertex>::new().read_payload_for_element(&mut reader, element, &header);
                mesh.vertices = read.map_err(fault)?.into_iter().map(|v| Point3::from(v.0)).collect();
            }
            "face" => {
                let read = Parser::<Face>::new().read_payload_for_element(&mut reader, element, &header);
                faces = read.map_err(fault)?;
            }
            _ => {
                Parser::<Skipped>::new().read_payload_for_element(&mut reader, element, &header).map_err(fault)?;
            }
        }
    }
    if let Some((i, v)) = mesh.vertices.iter().enumerate().find(|(_, v)| v.iter().any(|x| !x.is_finite())) {
        return Err(Fault::whole(format!("vertex {i} is ({}, {}, {}), which is not finite", v.x, v.y, v.z)));
    }
    for (number, Face(corners)) in faces.into_iter().enumerate() {
        let in_range = |i: i64| u32::try_from(i).ok().filter(|&i| (i as usize) < mesh.vertices.len());
        let corners = corners.into_iter().map(|i| in_range(i).ok_or(i)).collect::<Result<Vec<u32>, i64>>();
        let corners = corners.map_err(|i| {
            let n = mesh.vertices.len();
            Fault::whole(format!(
                "face {number} names vertex {i}, but the file has vertices 0 to {}",
                n.saturating_sub(1)
            ))
        })?;
        let faces = polygonize(&mesh.vertices, &corners);
        mesh.faces.extend(faces.map_err(|message| Fault::whole(format!("face {number}: {message}")))?);
    }
    Ok(mesh)
}

/// The library's errors quote the line in full and over several lines; the first one says it.
fn fault(error: ParseError) -> Fault {
    let line = error.line();
    let text = error.to_string();
    let text = text.strip_prefix(&line.map_or(String::new(), |n| format!("Line {n}: "))).unwrap_or(&text);
    let mut parts = text.lines().map(str::trim).filter(|part| !part.is_empty() && !part.starts_with("String:"));
    let first = parts.next().unwrap_or("unreadable");
    let cause = parts.next_back().map(|part| part.trim_start_matches("Error: "));
    let message = match cause {
        // What the grammar of the library would have liked better says nothing to a user.
        Some(cause) if !cause.starts_with("error at") => format!("not a valid PLY file: {first} {cause}"),
        _ => format!("not a valid PLY file: {first}"),
    };
    Fault { line, message: message.replace(char::is_control, " ") }
}

/// An element that says nothing about the shape.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }

    fn set_property(&mut self, _: &str, _: Property) -> PropertyAccessResult {
        PropertyAccessResult::Ignored
    }
}

struct Vertex([f64; 3]);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self([0.0; 3])
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let axis = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => return PropertyAccessResult::Ignored,
        };
        self.0[axis] = match value {
            Property::Char(x) => x.into(),
            Property::UChar(x) => x.into(),
            Property::Short(x) => x.into(),
            Property::UShort(x) => x.into(),
            Property::Int(x) => x.into(),
            Property::UInt(x) => x.into(),
            Property::Float(x) => x.into(),
            Property::Double(x) => x,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

struct Face(Vec<i64>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        self.0 = match value {
            Property::ListChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListInt(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUInt(list) => list.into_iter().map(i64::from).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ply\nformat FORMAT 1.0\ncomment a hill\nelement vertex 4\nproperty double x\nproperty double y\n\
        property double z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\nelement edge 1\n\
        property int vertex1\nend_header\n";

    const VERTICES: [[f64; 3]; 4] = [[0.0811990914301, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

    fn ascii() -> Vec<u8> {
        let mut text = HEADER.replace("FORMAT", "ascii");
        VERTICES.iter().for_each(|[x, y, z]| text.push_str(&format!("{x} {y} {z} 255\n")));
        text.push_str("4 0 1 2 3\n0\n");
        text.into_bytes()
    }

    /// The same in binary, its numbers in the order of bytes that the functions give.
    fn binary(format: &str, double: fn(f64) -> [u8; 8], int: fn(i32) -> [u8; 4]) -> Vec<u8> {
        let mut file = HEADER.replace("FORMAT", format).into_bytes();
        for vertex in VERTICES {
            vertex.iter().for_each(|x| file.extend(double(*x)));
            file.push(255);
        }
        file.push(4);
        [0, 1, 2, 3, 0].iter().for_each(|i| file.extend(int(*i)));
        file
    }

    #[test]
    fn all_three_encodings_say_the_same() {
        let little = binary("binary_little_endian", f64::to_le_bytes, i32::to_le_bytes);
        let big = binary("binary_big_endian", f64::to_be_bytes, i32::to_be_bytes);
        for file in [ascii(), little, big] {
            let mesh = read(&file).unwrap_or_else(|fault| panic!("{fault:?}"));
            assert_eq!(mesh.vertices, VERTICES.map(Point3::from));
            assert_eq!(mesh.faces.len(), 2);
        }
    }

    #[test]
    fn a_file_cut_off_anywhere_is_an_error_and_never_panics() {
        let little = binary("binary_little_endian", f64::to_le_bytes, i32::to_le_bytes);
        assert!((0..little.len()).all(|end| read(&little[..end]).is_err()));
        let ascii = ascii();
        // The last line may lack its end.
        assert!((0..ascii.len() - 1).all(|end| read(&ascii[..end]).is_err()));
    }
}
