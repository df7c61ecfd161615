//! The tree as a serde source, so that every error of a scene's structure knows its place and what would be valid.

use super::problem::{Problem, choose};
use super::tree::{Entry, Node, Span, Value};
use serde::de::{
    self, Deserialize, DeserializeSeed, EnumAccess, Expected, IntoDeserializer, MapAccess, SeqAccess, Unexpected,
    VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use std::fmt;

/// Reads a `T` from `node`, or says what does not fit and where.
///
/// Unknown keys are all collected: each is taken out and the rest read again. Anything else ends the reading.
pub fn from_node<T: for<'de> Deserialize<'de>>(mut node: Node) -> Result<T, Vec<Problem>> {
    let mut problems = Vec::new();
    loop {
        match T::deserialize(&node) {
            Ok(value) if problems.is_empty() => return Ok(value),
            Ok(_) => return Err(problems),
            Err(Error { problem, kind }) => {
                let again = kind == Kind::UnknownKey && problem.span().is_some_and(|at| node.remove(at));
                // A key that is missing after an unknown one was probably that one, mistyped.
                if kind != Kind::MissingKey || problems.is_empty() {
                    problems.push(problem);
                }
                if !again {
                    return Err(problems);
                }
            }
        }
    }
}

/// A problem on its way up to where its place is known.
#[derive(Debug)]
pub struct Error {
    problem: Problem,
    kind: Kind,
}

/// What becomes of the reading after a problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    UnknownKey,
    MissingKey,
    Other,
}

impl Error {
    fn new(problem: Problem) -> Self {
        Self { problem, kind: Kind::Other }
    }

    fn at(self, span: &Span) -> Self {
        Self { problem: self.problem.at(span.clone()), ..self }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.problem)
    }
}

impl std::error::Error for Error {}

impl de::Error for Error {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::new(Problem::new(message.to_string()))
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::new(Problem::new(format!("expected {}, found {}", in_words(expected), found_in_words(&found))))
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        Self::new(Problem::new(format!("expected {}, found {length}", in_words(expected))))
    }

    fn unknown_field(field: &str, expected: &'static [&'static str]) -> Self {
        let problem = Problem::new(format!("unknown key `{field}`"));
        let problem = problem.help(choose(field, "valid keys here", expected.iter().copied()));
        Self { problem, kind: Kind::UnknownKey }
    }

    fn unknown_variant(variant: &str, expected: &'static [&'static str]) -> Self {
        let problem = Problem::new(format!("unknown choice `{variant}`"));
        Self::new(problem.help(choose(variant, "valid here", expected.iter().copied())))
    }

    fn missing_field(field: &'static str) -> Self {
        let problem = Problem::new(format!("the key `{field}` is missing"));
        let problem = match example(field) {
            Some(example) => problem.help(format!("add it, such as {example}")),
            None => problem,
        };
        Self { problem, kind: Kind::MissingKey }
    }
}

/// How a key that must be there may look.
fn example(field: &str) -> Option<&'static str> {
    Some(match field {
        "version" => "version = 1",
        "duration" => "duration = 3.0, in s",
        "restitution" => "restitution = 0.75, between 0 and 1",
        "name" => "name = \"floor\"",
        "shape" => "shape = { plane = { point = [0, 0, 0], normal = [0, 0, 1] } }",
        "file" => "file = \"hill.obj\"",
        "position" => "position = [0, 0, 1], in m",
        "count" => "count = [10, 10, 1]",
        "step" => "step = [1, 1, 1], in m",
        "integrator" => "integrator = \"exact\"",
        _ => return None,
    })
}

/// What serde expects, in the words of the scene file.
fn in_words(expected: &dyn Expected) -> String {
    match expected.to_string().as_str() {
        "f64" => "a number".to_owned(),
        "u32" | "u64" | "usize" => "a whole number, 0 or more".to_owned(),
        "a sequence" => "a list".to_owned(),
        "a map" => "a table".to_owned(),
        "an array of length 3" => "three numbers, [x, y, z]".to_owned(),
        "an array of length 4" => "four numbers, [A, B, C, D]".to_owned(),
        other => other.to_owned(),
    }
}

fn found_in_words(found: &Unexpected<'_>) -> String {
    match found {
        Unexpected::Bool(b) => format!("`{b}`"),
        Unexpected::Signed(i) => format!("the integer {i}"),
        Unexpected::Float(x) => format!("the number {x:?}"),
        Unexpected::Str(s) => format!("the string {s:?}"),
        Unexpected::Seq => "a list".to_owned(),
        Unexpected::Map => "a table".to_owned(),
        other => other.to_string(),
    }
}

impl<'de> de::Deserializer<'de> for &'de Node {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.value {
            Value::Table(entries) => visitor.visit_map(Entries { rest: entries.iter(), current: None }),
            Value::Array(items) => read_array(items, visitor),
            Value::String(s) => visitor.visit_borrowed_str(s),
            Value::Integer(i) => visitor.visit_i64(*i),
            Value::Float(x) => visitor.visit_f64(*x),
            Value::Bool(b) => visitor.visit_bool(*b),
            Value::Other(what) => Err(de::Error::invalid_type(Unexpected::Other(what), &visitor)),
        }
        .map_err(|e| e.at(&self.span))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match &self.value {
            Value::String(s) => visitor.visit_enum(de::value::StrDeserializer::new(s)),
            Value::Table(entries) => match entries.as_slice() {
                [entry] => visitor.visit_enum(Choice { entry }),
                _ => Err(Error::new(
                    Problem::new(format!("expected exactly one key, found {}", entries.len())).help(choose(
                        "",
                        "one of",
                        variants.iter().copied(),
                    )),
                )),
            },
            _ => self.deserialize_any(visitor),
        }
        .map_err(|e| e.at(&self.span))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple tuple_struct
        map struct identifier ignored_any
    }
}

/// Reads a list; a list longer than what takes it is an error, not a loss.
fn read_array<'de, V: Visitor<'de>>(items: &'de [Node], visitor: V) -> Result<V::Value, Error> {
    struct Items<'de> {
        rest: std::slice::Iter<'de, Node>,
    }
    impl<'de> SeqAccess<'de> for &mut Items<'de> {
        type Error = Error;
        fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
            self.rest.next().map(|node| seed.deserialize(node)).transpose()
        }
    }
    let expected = in_words(&Expectation(&visitor));
    let mut access = Items { rest: items.iter() };
    let value = visitor.visit_seq(&mut access)?;
    match access.rest.len() {
        0 => Ok(value),
        _ => Err(Error::new(Problem::new(format!("expected {expected}, found {}", items.len())))),
    }
}

/// A visitor as an expectation; serde implements this only for visitors by value.
struct Expectation<'a, V>(&'a V);

impl<'de, V: Visitor<'de>> Expected for Expectation<'_, V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.expecting(f)
    }
}

struct Entries<'de> {
    rest: std::slice::Iter<'de, Entry>,
    current: Option<&'de Entry>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        self.current = self.rest.next();
        let Some(entry) = self.current else { return Ok(None) };
        let key: de::value::StrDeserializer<'_, Error> = entry.key.as_str().into_deserializer();
        seed.deserialize(key).map(Some).map_err(|e| e.at(&entry.key_span))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        match self.current.take() {
            Some(entry) => seed.deserialize(&entry.node),
            None => Err(de::Error::custom("a value was asked for before its key")),
        }
    }
}

/// A table with one key, which names a choice: `{ coulomb = 0.6 }`.
struct Choice<'de> {
    entry: &'de Entry,
}

impl<'de> EnumAccess<'de> for Choice<'de> {
    type Error = Error;
    type Variant = &'de Node;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self::Variant), Error> {
        let key: de::value::StrDeserializer<'_, Error> = self.entry.key.as_str().into_deserializer();
        let value = seed.deserialize(key).map_err(|e| e.at(&self.entry.key_span))?;
        Ok((value, &self.entry.node))
    }
}

impl<'de> VariantAccess<'de> for &'de Node {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        Err(Error::new(Problem::new("this choice is a plain string, without a value")).at(&self.span))
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        de::Deserializer::deserialize_any(self, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        de::Deserializer::deserialize_any(self, visitor)
    }
}
