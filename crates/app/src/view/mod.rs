//! The page that shows a run: one HTML file that needs no network and no other file.

mod data;

use crate::replay::Replay;
use crate::stage::Stage;
use data::Data;

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");

/// The scripts in the order in which they build on each other.
const SCRIPTS: [&str; 10] = [
    include_str!("algebra.js"),
    include_str!("run.js"),
    include_str!("camera.js"),
    include_str!("lines.js"),
    include_str!("webgl.js"),
    include_str!("outline.js"),
    include_str!("chart.js"),
    include_str!("panel.js"),
    include_str!("player.js"),
    include_str!("hands.js"),
];

/// The page of a run that is called `title`.
pub fn page(title: &str, replay: &Replay) -> String {
    let data = Data::of(title, replay, &Stage::of(replay));
    // Nothing in it can fail to be JSON. What looks like a tag of HTML must not end the element it stands in.
    let data = serde_json::to_string(&data).unwrap_or_default().replace('<', "\\u003c");
    let scripts = SCRIPTS.concat();
    let mut page = String::with_capacity(PAGE.len() + STYLE.len() + scripts.len() + data.len());
    let mut rest = PAGE;
    for (mark, content) in [("/* style */", STYLE), ("{data}", &data), ("/* scripts */", &scripts)] {
        let (before, after) = rest.split_once(mark).unwrap_or((rest, ""));
        page.push_str(before);
        page.push_str(content);
        rest = after;
    }
    page + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_without_its_data_is_small_and_loads_nothing() {
        let parts = [PAGE, STYLE].into_iter().chain(SCRIPTS);
        assert!(parts.clone().map(str::len).sum::<usize>() < 100_000);
        for part in parts {
            for word in ["http:", "https:", "import(", "fetch(", "XMLHttpRequest", "@import", "url("] {
                assert!(!part.contains(word), "{word}");
            }
        }
    }

    #[test]
    fn the_page_has_each_mark_once_and_in_order() {
        let places = ["/* style */", "{data}", "/* scripts */"].map(|mark| {
            assert_eq!(PAGE.matches(mark).count(), 1, "{mark}");
            PAGE.find(mark)
        });
        assert!(places.is_sorted());
    }
}
