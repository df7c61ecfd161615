//! The project's own Rust sources, for the tests that read them.

use std::fs;
use std::path::{Path, PathBuf};

/// A file of the project.
#[derive(Debug)]
pub struct Source {
    /// Its path relative to the project's root, with forward slashes.
    pub path: String,
    /// Its text.
    pub text: String,
}

impl Source {
    /// The lines outside `#[cfg(test)]` modules, numbered from 1, without what stands behind `//`. A file `tests.rs` is such
    /// a module as a whole.
    pub fn code(&self) -> Vec<(usize, &str)> {
        let mut code = Vec::new();
        if self.path.ends_with("/tests.rs") {
            return code;
        }
        let mut lines = (1..).zip(self.text.lines()).peekable();
        while let Some((number, line)) = lines.next() {
            let opens = |next: &&(usize, &str)| next.1.trim_start().starts_with("mod ") && next.1.ends_with('{');
            if line.trim_start() == "#[cfg(test)]" && lines.peek().as_ref().is_some_and(opens) {
                // rustfmt closes a module at the indentation of its attribute.
                let end = format!("{}}}", &line[..line.len() - line.trim_start().len()]);
                for (_, line) in lines.by_ref() {
                    if line == end {
                        break;
                    }
                }
            } else {
                code.push((number, without_comment(line)));
            }
        }
        code
    }
}

/// The root of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The files below `folder` (relative to the root) whose names end in one of `endings`, by path. Nothing is looked at below
/// a hidden folder or one that cargo builds into.
pub fn files(folder: &str, endings: &[&str]) -> Vec<Source> {
    let mut found = Vec::new();
    collect(&root().join(folder), folder, endings, &mut found);
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// Every Rust file of the project, by path.
pub fn rust() -> Vec<Source> {
    ["crates", "tests", "xtask"].iter().flat_map(|folder| files(folder, &[".rs"])).collect()
}

fn collect(folder: &Path, path: &str, endings: &[&str], found: &mut Vec<Source>) {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries {
        let entry = entry.expect("a readable folder");
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = if path.is_empty() { name.clone() } else { format!("{path}/{name}") };
        if entry.path().is_dir() {
            if !name.starts_with('.') && !entry.path().join("CACHEDIR.TAG").exists() {
                collect(&entry.path(), &path, endings, found);
            }
        } else if endings.iter().any(|ending| name.ends_with(ending)) {
            let text = fs::read_to_string(entry.path()).unwrap_or_else(|error| panic!("{path}: {error}"));
            found.push(Source { path, text });
        }
    }
}

/// The line up to its comment. Slashes inside a string are no comment; a quote that is a character is rare enough to
/// be read as the start of a string, which at worst keeps a comment.
fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    let mut previous = ' ';
    for (i, c) in line.char_indices() {
        match c {
            '"' if previous != '\\' => quoted = !quoted,
            '/' if !quoted && line[i..].starts_with("//") => return &line[..i],
            _ => {}
        }
        previous = if previous == '\\' { ' ' } else { c };
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_is_what_is_neither_comment_nor_test() {
        let text = "//! Doc.\nlet url = \"http://x\"; // why\n#[cfg(test)]\nmod tests {\n    fn f() {\n    }\n}\nlet y = 1;\n#[cfg(test)]\nuse x;\n";
        let source = Source { path: "a.rs".into(), text: text.into() };
        let code = source.code();
        let lines: Vec<_> = code.iter().map(|(number, line)| (*number, line.trim_end())).collect();
        assert_eq!(
            lines,
            [(1, ""), (2, "let url = \"http://x\";"), (8, "let y = 1;"), (9, "#[cfg(test)]"), (10, "use x;")]
        );
    }

    #[test]
    fn this_file_is_among_the_sources() {
        assert!(rust().iter().any(|source| source.path == "tests/src/sources.rs"));
    }
}
