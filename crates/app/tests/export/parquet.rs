//! Tables in Parquet, read by the crate `parquet2`, which shares no code with the crate that writes them.

use crate::Job;
use parquet2::deserialize::{BinaryPageState, DefLevelsDecoder, HybridEncoded, NativePageState};
use parquet2::encoding::hybrid_rle::HybridRleDecoder;
use parquet2::page::{DataPage, DictPage, Page};
use parquet2::read::{decompress, get_page_iterator, read_metadata};
use parquet2::schema::types::PhysicalType;
use std::fmt::Debug;
use std::io::Cursor;

/// The cells of a table as `carom run` writes them in CSV, column by column under their names.
fn cells(bytes: &[u8]) -> Vec<(String, Vec<String>)> {
    let mut file = Cursor::new(bytes);
    let metadata = read_metadata(&mut file).expect("metadata");
    assert!(metadata.created_by.as_deref().is_some_and(|by| by.starts_with("carom ")));
    let names = metadata.schema().fields().iter().map(|field| field.name().to_owned());
    let mut columns: Vec<(String, Vec<String>)> = names.map(|name| (name, Vec::new())).collect();
    for group in &metadata.row_groups {
        for (column, (_, cells)) in group.columns().iter().zip(&mut columns) {
            let pages = get_page_iterator(column, &mut file, None, Vec::new(), usize::MAX).expect("pages");
            let mut dictionary = None;
            for page in pages {
                match decompress(page.expect("a page"), &mut Vec::new()).expect("a page") {
                    Page::Dict(page) => dictionary = Some(page),
                    Page::Data(page) => cells.extend(values(&page, dictionary.as_ref())),
                }
            }
        }
    }
    columns
}

fn values(page: &DataPage, dictionary: Option<&DictPage>) -> Vec<String> {
    match page.descriptor.primitive_type.physical_type {
        PhysicalType::Double => numbers(page, dictionary, |bytes| format!("{:?}", f64::from_le_bytes(bytes))),
        PhysicalType::Int64 => numbers(page, dictionary, |bytes| i64::from_le_bytes(bytes).to_string()),
        PhysicalType::ByteArray => words(page, dictionary),
        other => panic!("{other:?}"),
    }
}

/// Numbers of eight bytes.
fn numbers(page: &DataPage, dictionary: Option<&DictPage>, show: impl Fn([u8; 8]) -> String) -> Vec<String> {
    let known: Vec<String> = dictionary.map_or(Vec::new(), |d| {
        d.buffer.chunks_exact(8).map(|chunk| show(chunk.try_into().expect("eight bytes"))).collect()
    });
    let shown = |x: i64| show(x.to_le_bytes());
    match NativePageState::<i64, _>::try_new(page, dictionary.map(|_| ())).expect("a page of numbers") {
        NativePageState::Required(values) => values.map(shown).collect(),
        NativePageState::Optional(there, values) => spread(there, values.map(shown)),
        NativePageState::RequiredDictionary(it) => looked_up(it.indexes, &known).collect(),
        NativePageState::OptionalDictionary(there, it) => spread(there, looked_up(it.indexes, &known)),
    }
}

fn words(page: &DataPage, dictionary: Option<&DictPage>) -> Vec<String> {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("text");
    let mut known = Vec::new();
    let mut rest = dictionary.map_or(&[][..], |d| &d.buffer);
    while let Some((length, after)) = rest.split_first_chunk::<4>() {
        let (word, after) = after.split_at(u32::from_le_bytes(*length) as usize);
        known.push(text(word));
        rest = after;
    }
    match BinaryPageState::try_new(page, dictionary.map(|_| ())).expect("a page of words") {
        BinaryPageState::Required(values) => values.map(|word| text(word.expect("a word"))).collect(),
        BinaryPageState::RequiredDictionary(it) => looked_up(it.indexes, &known).collect(),
        _ => panic!("no column of words is optional"),
    }
}

fn looked_up<'a>(indexes: HybridRleDecoder<'a>, known: &'a [String]) -> impl Iterator<Item = String> + 'a {
    indexes.map(|i| known[i.expect("an index") as usize].clone())
}

/// The values, and an empty cell where there is none.
fn spread(there: DefLevelsDecoder<'_>, mut values: impl Iterator<Item = String>) -> Vec<String> {
    let mut cells = Vec::new();
    let mut put = |there: bool| cells.push(if there { values.next().expect("a value") } else { String::new() });
    match there {
        // Optional and not nested: a bit for each row.
        DefLevelsDecoder::Bitmap(levels) => {
            for level in levels {
                match level.expect("a level") {
                    HybridEncoded::Bitmap(bits, length) => {
                        (0..length).for_each(|i| put(bits[i / 8] & (1 << (i % 8)) != 0));
                    }
                    HybridEncoded::Repeated(is_there, length) => (0..length).for_each(|_| put(is_there)),
                }
            }
        }
        DefLevelsDecoder::Levels(levels, most) => levels.for_each(|level| put(level.expect("a level") == most)),
    }
    cells
}

/// Holds a table in Parquet against the same in CSV, cell by cell and so bit by bit.
#[track_caller]
fn same(job: &Job, table: &str) {
    job.carom(&["run", "--quiet", "--fps", "30", table, "table.parquet"]);
    let text = job.carom(&["run", "--quiet", "--fps", "30", table, "-"]);
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let columns = cells(&job.read("table.parquet"));
    let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, header);
    for (k, (name, cells)) in columns.iter().enumerate() {
        let expected: Vec<&str> = rows.iter().map(|row| row[k]).collect();
        differ(name, cells, &expected);
    }
}

#[track_caller]
fn differ<T: PartialEq<U> + Debug, U: Debug>(name: &str, found: &[T], expected: &[U]) {
    assert_eq!(found.len(), expected.len(), "{name}");
    if let Some((i, (a, b))) = found.iter().zip(expected).enumerate().find(|(_, (a, b))| *a != *b) {
        panic!("{name}, row {i}: {a:?} and not {b:?}");
    }
}

#[test]
fn events_and_frames_read_back_to_the_same_bits() {
    // Polygons have no faces; a mesh has some; planes and a mesh together have both.
    for scene in ["ramp.toml", "cow.toml", "room.toml"] {
        let job = Job::on(scene);
        same(&job, "--events");
        same(&job, "--frames");
    }
}

#[test]
fn a_table_of_several_groups_reads_back() {
    let job = Job::on("jacksboro.toml");
    let args = ["run", "--quiet", "--fps", "1/2", "--frames"];
    job.carom(&[&args[..], &["table.parquet"]].concat());
    let columns = cells(&job.read("table.parquet"));
    let rows = job.table(&[&args[..], &["-"]].concat());
    assert!(rows.len() > 150_000);
    for (k, (name, cells)) in columns.iter().enumerate() {
        let expected: Vec<&String> = rows.iter().map(|row| &row[k]).collect();
        differ(name, &cells.iter().collect::<Vec<_>>(), &expected);
    }
}
