//! Generated blocks of a Markdown text: what stands between `<!-- generated: NAME -->` and `<!-- /generated -->`.

use crate::Result;
use std::ops::Range;

const OPEN: &str = "<!-- generated: ";
const OPEN_END: &str = " -->";
const CLOSE: &str = "<!-- /generated -->";

/// A generated block of a text.
#[derive(Debug, PartialEq)]
pub struct Block<'a> {
    /// What it is called.
    pub name: &'a str,
    /// Where in the text its body is, in bytes, without the marks.
    pub body: Range<usize>,
}

/// The blocks of a text, in order. Each mark has a line of its own.
pub fn find(text: &str) -> Result<Vec<Block<'_>>> {
    let mut blocks = Vec::new();
    let mut open: Option<(&str, usize)> = None;
    let mut start = 0;
    for (i, line) in text.split_inclusive('\n').enumerate() {
        let end = start + line.len();
        let mark = line.trim_end();
        if let Some(name) = mark.strip_prefix(OPEN).and_then(|rest| rest.strip_suffix(OPEN_END)) {
            if let Some((outer, _)) = open {
                return Err(format!("line {}: block `{name}` begins inside block `{outer}`", i + 1).into());
            }
            open = Some((name, end));
        } else if mark == CLOSE {
            let (name, from) = open.take().ok_or_else(|| format!("line {}: ends a block that did not begin", i + 1))?;
            blocks.push(Block { name, body: from..start });
        }
        start = end;
    }
    match open {
        Some((name, _)) => Err(format!("block `{name}` does not end; it needs a line `{CLOSE}`").into()),
        None => Ok(blocks),
    }
}

/// The text with the body of each block replaced by `make(name, body)`.
pub fn replace(text: &str, mut make: impl FnMut(&str, &str) -> String) -> Result<String> {
    let mut replaced = String::new();
    let mut from = 0;
    for block in find(text)? {
        replaced += &text[from..block.body.start];
        let body = make(block.name, &text[block.body.clone()]);
        if !body.is_empty() {
            replaced += body.trim_end();
            replaced.push('\n');
        }
        from = block.body.end;
    }
    Ok(replaced + &text[from..])
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "a\n<!-- generated: x y -->\nold\n<!-- /generated -->\nb\n<!-- generated: z -->\n<!-- /generated -->\n";

    #[test]
    fn blocks_are_found_with_their_bodies() {
        let blocks = find(TEXT).expect("well formed");
        let found: Vec<_> = blocks.iter().map(|block| (block.name, &TEXT[block.body.clone()])).collect();
        assert_eq!(found, [("x y", "old\n"), ("z", "")]);
    }

    #[test]
    fn only_bodies_are_replaced_and_twice_is_once() {
        let make = |name: &str, _: &str| format!("new {name}\n\n");
        let once = replace(TEXT, make).expect("well formed");
        assert_eq!(
            once,
            "a\n<!-- generated: x y -->\nnew x y\n<!-- /generated -->\nb\n<!-- generated: z -->\nnew z\n<!-- /generated -->\n"
        );
        assert_eq!(replace(&once, make).expect("well formed"), once);
    }

    #[test]
    fn marks_that_do_not_pair_are_refused() {
        for text in
            ["<!-- generated: x -->\n", "<!-- /generated -->\n", "<!-- generated: x -->\n<!-- generated: y -->\n"]
        {
            assert!(find(text).is_err(), "{text}");
        }
    }
}
