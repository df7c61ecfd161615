//! A scene file as a tree of values that know their place in the text, whether it was TOML or JSON.

use std::ops::Range;

/// Bytes of the source text.
pub type Span = Range<usize>;

/// A value and where it stands.
#[derive(Debug, Clone)]
pub struct Node {
    pub span: Span,
    pub value: Value,
}

/// What a value is.
#[derive(Debug, Clone)]
pub enum Value {
    Table(Vec<Entry>),
    Array(Vec<Node>),
    String(String),
    Integer(i64),
    Float(f64),
    Bool(bool),
    /// A TOML date or time, or JSON's null: no key of a scene takes one.
    Other(&'static str),
}

/// A key and its value in a table.
#[derive(Debug, Clone)]
pub struct Entry {
    pub key: String,
    pub key_span: Span,
    pub node: Node,
}

/// One step from a value to one inside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step<'a> {
    Key(&'a str),
    Index(usize),
}

impl<'a> From<&'a str> for Step<'a> {
    fn from(key: &'a str) -> Self {
        Self::Key(key)
    }
}

impl From<usize> for Step<'_> {
    fn from(index: usize) -> Self {
        Self::Index(index)
    }
}

impl Node {
    /// The span of the value at `path`, or of the deepest value on the way there that exists.
    pub fn locate(&self, path: &[Step<'_>]) -> Span {
        let Some((step, rest)) = path.split_first() else { return self.span.clone() };
        let inner = match (&self.value, step) {
            (Value::Table(entries), Step::Key(key)) => entries.iter().find(|e| e.key == *key).map(|e| &e.node),
            (Value::Array(items), Step::Index(i)) => items.get(*i),
            _ => None,
        };
        inner.map_or_else(|| self.span.clone(), |node| node.locate(rest))
    }

    /// Takes out the entry whose key stands at `key_span`; false if there is none.
    pub fn remove(&mut self, key_span: &Span) -> bool {
        match &mut self.value {
            Value::Table(entries) => {
                let before = entries.len();
                entries.retain(|e| e.key_span != *key_span);
                entries.len() != before || entries.iter_mut().any(|e| e.node.remove(key_span))
            }
            Value::Array(items) => items.iter_mut().any(|n| n.remove(key_span)),
            _ => false,
        }
    }

    /// The spans of all numbers that are not finite, each with the number.
    pub fn non_finite(&self) -> Vec<(Span, f64)> {
        match &self.value {
            Value::Table(entries) => entries.iter().flat_map(|e| e.node.non_finite()).collect(),
            Value::Array(items) => items.iter().flat_map(Node::non_finite).collect(),
            Value::Float(x) if !x.is_finite() => vec![(self.span.clone(), *x)],
            _ => Vec::new(),
        }
    }
}
