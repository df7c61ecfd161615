//! What is wrong with a scene, where, and what would be right; and how that is shown.

use super::tree::Span;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// It must be mended.
    Error,
    /// It is allowed, but probably not meant.
    Warning,
    /// It is good to know.
    Note,
}

/// Something in a scene file that keeps it from being simulated.
#[derive(Debug, Clone)]
pub struct Problem {
    message: String,
    span: Option<Span>,
    help: Option<String>,
}

impl Problem {
    /// What is wrong, in a sentence without its full stop.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), span: None, help: None }
    }

    /// Where in the text; the innermost place that is told stays.
    pub fn at(mut self, span: Span) -> Self {
        self.span.get_or_insert(span);
        self
    }

    /// What would be right.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    pub fn message(&self) -> &str {
        &self.message
    }

    pub fn span(&self) -> Option<&Span> {
        self.span.as_ref()
    }

    /// Shows the finding with its source line: file, line, column, a caret, and what would be valid.
    pub fn render(&self, path: &str, text: &str, styled: bool) -> String {
        let span = clip(text, self.span.clone().unwrap_or(0..0));
        let snippet = Snippet::source(text).path(path).annotation(AnnotationKind::Primary.span(span));
        let mut group = Level::ERROR.primary_title(self.message.as_str()).element(snippet);
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        renderer(styled).render(&[group])
    }
}

/// Shows what has no place in a text.
pub fn render_plain(severity: Severity, message: &str, help: Option<&str>, styled: bool) -> String {
    let level = match severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    };
    let mut groups = vec![Group::with_title(level.primary_title(message))];
    if let Some(help) = help {
        groups.push(Group::with_title(Level::HELP.secondary_title(help)));
    }
    renderer(styled).render(&groups)
}

fn renderer(styled: bool) -> Renderer {
    if styled { Renderer::styled() } else { Renderer::plain() }
}

/// The part of `span` on its first line, so that a whole table does not fill the screen, within `text` and never empty of
/// meaning at its end.
fn clip(text: &str, span: Span) -> Span {
    let floor = |mut i: usize| {
        i = i.min(text.len());
        while !text.is_char_boundary(i) {
            i -= 1;
        }
        i
    };
    let start = floor(span.start);
    let line_end = text[start..].find(['\n', '\r']).map_or(text.len(), |n| start + n);
    start..floor(span.end).clamp(start, line_end)
}

/// The one of `known` that a mistyped `word` probably means, if one is near enough.
fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    known
        .into_iter()
        .map(|k| (strsim::damerau_levenshtein(&word.to_lowercase(), &k.to_lowercase()), k))
        .filter(|(distance, k)| *distance <= k.len().max(word.len()) / 3)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, k)| k)
}

/// Help for a word that is none of `known`: the nearest one, and all of them.
pub fn choose<'a>(word: &str, what: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> String {
    let all = known.clone().into_iter().map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", ");
    let all = if all.is_empty() { "none".to_owned() } else { all };
    match suggestion(word, known) {
        Some(near) => format!("did you mean `{near}`? {what}: {all}"),
        None => format!("{what}: {all}"),
    }
}
