//! From the text of a scene file, TOML or JSON, to the tree.

use super::problem::Problem;
use super::tree::{Entry, Node, Span, Value};
use jsonc_parser::ast;
use jsonc_parser::common::Ranged;
use toml::de::{DeTable, DeValue};

/// The two notations of a scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Notation {
    Toml,
    Json,
}

/// Reads `text`; a syntax error is one problem, at its place.
pub fn parse(text: &str, notation: Notation) -> Result<Node, Problem> {
    match notation {
        Notation::Toml => parse_toml(text),
        Notation::Json => parse_json(text),
    }
}

fn parse_toml(text: &str) -> Result<Node, Problem> {
    let table = DeTable::parse(text).map_err(|e| {
        let at = e.span().unwrap_or(0..0);
        Problem::new(format!("not valid TOML: {}", e.message().trim_end())).at(at)
    })?;
    let span = table.span();
    Ok(Node { span, value: toml_table(table.into_inner()) })
}

fn toml_table(table: DeTable<'_>) -> Value {
    let mut entries: Vec<Entry> = table
        .into_iter()
        .map(|(key, value)| {
            let key_span = key.span();
            Entry { key: key.into_inner().into_owned(), key_span, node: toml_node(value.span(), value.into_inner()) }
        })
        .collect();
    entries.sort_by_key(|e| e.key_span.start);
    Value::Table(entries)
}

fn toml_node(span: Span, value: DeValue<'_>) -> Node {
    let value = match value {
        DeValue::String(s) => Value::String(s.into_owned()),
        DeValue::Integer(i) => match i64::from_str_radix(i.as_str(), i.radix()) {
            Ok(n) => Value::Integer(n),
            // Beyond i64: a decimal is still a number, rounded as any other.
            Err(_) => i.as_str().parse().map_or(Value::Other("an integer too large to read"), Value::Float),
        },
        DeValue::Float(x) => x.as_str().parse().map_or(Value::Other("an unreadable number"), Value::Float),
        DeValue::Boolean(b) => Value::Bool(b),
        DeValue::Datetime(_) => Value::Other("a date or time"),
        DeValue::Array(items) => {
            Value::Array(items.into_iter().map(|item| toml_node(item.span(), item.into_inner())).collect())
        }
        DeValue::Table(table) => toml_table(table),
    };
    Node { span, value }
}

fn parse_json(text: &str) -> Result<Node, Problem> {
    // Strict JSON: whatever else reads the file must read it the same.
    let strict = jsonc_parser::ParseOptions {
        allow_comments: false,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    let parsed = jsonc_parser::parse_to_ast(text, &Default::default(), &strict)
        .map_err(|e| Problem::new(format!("not valid JSON: {}", e.kind())).at(e.range().start..e.range().end))?;
    match parsed.value {
        Some(value) => json_node(value),
        None => Err(Problem::new("the file is empty").help("a scene is a JSON object with the keys of `carom schema`")),
    }
}

fn json_node(value: ast::Value<'_>) -> Result<Node, Problem> {
    let span = value.range().start..value.range().end;
    let value = match value {
        ast::Value::StringLit(s) => Value::String(s.value.into_owned()),
        ast::Value::NumberLit(n) => match n.value.parse::<i64>() {
            Ok(i) if n.value != "-0" => Value::Integer(i),
            _ => n.value.parse().map_or(Value::Other("an unreadable number"), Value::Float),
        },
        ast::Value::BooleanLit(b) => Value::Bool(b.value),
        ast::Value::NullKeyword(_) => Value::Other("null"),
        ast::Value::Array(a) => Value::Array(a.elements.into_iter().map(json_node).collect::<Result<_, _>>()?),
        ast::Value::Object(o) => {
            let mut entries: Vec<Entry> = Vec::with_capacity(o.properties.len());
            for property in o.properties {
                let range = property.name.range();
                let key_span = range.start..range.end;
                let key = property.name.into_string();
                if entries.iter().any(|e| e.key == key) {
                    return Err(Problem::new(format!("the key `{key}` is given twice")).at(key_span));
                }
                entries.push(Entry { key, key_span, node: json_node(property.value)? });
            }
            Value::Table(entries)
        }
    };
    Ok(Node { span, value })
}
