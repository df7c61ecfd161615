//! What series look like: colours for light and dark paper, marks, dashes; and the style sheet that holds them.

use std::fmt::Write;
use svg::node::element::Path;

/// Colours on white; each has a contrast of at least 4.5 to it, so that the names can have them too.
const LIGHT: [&str; 8] = ["#0b62b0", "#b3400c", "#00734d", "#7a3da8", "#7d5300", "#a1145c", "#006a78", "#4d4d4d"];

/// Colours on nearly black, in the same order.
const DARK: [&str; 8] = ["#6cb6ff", "#ff9f6b", "#56d4a0", "#cf9bff", "#e3b341", "#ff8ac0", "#4fd0e0", "#c4c4c4"];

const DASHES: [&str; 8] = ["none", "7 3", "2 3", "9 3 2 3", "none", "4 2", "12 4", "1 2"];

/// Size of the names and numbers, in pixels.
pub const TEXT: f64 = 13.0;

/// Size of the title, in pixels.
pub const TITLE: f64 = 17.0;

/// Half the width of a mark, in pixels.
const MARK: f64 = 4.5;

/// How wide `text` is at most at the size `size`, whatever the font, as near as one can know.
pub fn width(text: &str, size: f64) -> f64 {
    0.58 * size * text.chars().count() as f64
}

/// The style sheet.
pub fn css() -> String {
    let mut css = String::new();
    // A string takes everything that is written to it.
    let _ = write!(
        css,
        "\n.carom-chart {{ max-width: 100%; height: auto; }}\n.carom-chart text {{ font: {TEXT}px system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif; fill: #1f2328; }}\n\
         .carom-chart .title {{ font-size: {TITLE}px; font-weight: 600; }}\n\
         .carom-chart .name {{ font-weight: 600; paint-order: stroke; stroke: #ffffff; stroke-width: 4px; stroke-linejoin: round; }}\n\
         .carom-chart .series {{ fill: none; stroke-width: 2px; stroke-linejoin: round; stroke-linecap: round; }}\n\
         .carom-chart .leader {{ fill: none; stroke-width: 1px; stroke-opacity: 0.7; }}\n\
         .carom-chart .rule {{ fill: none; stroke: #59636e; stroke-width: 1.5px; stroke-dasharray: 5 4; }}\n\
         .carom-chart .grid {{ fill: none; stroke: #e3e7eb; stroke-width: 1px; }}\n\
         .carom-chart .frame {{ fill: none; stroke: #59636e; stroke-width: 1px; }}\n\
         .carom-chart .paper {{ fill: #ffffff; }}\n"
    );
    for (k, dash) in DASHES.iter().enumerate() {
        let _ = writeln!(css, ".carom-chart .series.line{k} {{ stroke-dasharray: {dash}; }}");
    }
    colours(&mut css, &LIGHT, "#ffffff");
    css.push_str(
        "@media (prefers-color-scheme: dark) {\n\
         .carom-chart text { fill: #e6edf3; }\n\
         .carom-chart .name { stroke: #0d1117; }\n\
         .carom-chart .rule { stroke: #9aa4af; }\n\
         .carom-chart .grid { stroke: #262c34; }\n\
         .carom-chart .frame { stroke: #9aa4af; }\n\
         .carom-chart .paper { fill: #0d1117; }\n",
    );
    colours(&mut css, &DARK, "#0d1117");
    css.push_str("}\n");
    css
}

fn colours(css: &mut String, colours: &[&str; 8], paper: &str) {
    for (k, colour) in colours.iter().enumerate() {
        let inside = if is_hollow(k) { paper } else { colour };
        let _ = writeln!(css, ".carom-chart .line{k} {{ stroke: {colour}; }}");
        let _ = writeln!(css, ".carom-chart .mark{k} {{ stroke: {colour}; stroke-width: 1.5px; fill: {inside}; }}");
        let _ = writeln!(css, ".carom-chart .name{k} {{ fill: {colour}; }}");
    }
}

/// Marks that are empty inside.
fn is_hollow(look: usize) -> bool {
    look % 2 == 1
}

/// The look that `number` has.
pub fn look(number: usize) -> usize {
    number % LIGHT.len()
}

/// The mark of a look at a place: disc, square, triangle, diamond, triangle on its tip, plus, star of six, cross.
pub fn mark(look: usize, x: f64, y: f64) -> Path {
    let m = MARK;
    let polygon = |points: &[[f64; 2]]| {
        let mut d = String::new();
        for (k, [dx, dy]) in points.iter().enumerate() {
            let _ = write!(d, "{}{:.1} {:.1}", if k == 0 { "M" } else { "L" }, x + dx * m, y + dy * m);
        }
        d + "Z"
    };
    let strokes = |strokes: &[[f64; 4]]| {
        strokes.iter().fold(String::new(), |mut d, [ax, ay, bx, by]| {
            let _ = write!(d, "M{:.1} {:.1}L{:.1} {:.1}", x + ax * m, y + ay * m, x + bx * m, y + by * m);
            d
        })
    };
    let d = match look {
        0 => format!("M{:.1} {y:.1}a{m} {m} 0 1 0 {} 0a{m} {m} 0 1 0 -{} 0Z", x - m, 2.0 * m, 2.0 * m),
        1 => polygon(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]),
        2 => polygon(&[[0.0, -1.2], [1.1, 0.8], [-1.1, 0.8]]),
        3 => polygon(&[[0.0, -1.3], [1.3, 0.0], [0.0, 1.3], [-1.3, 0.0]]),
        4 => polygon(&[[0.0, 1.2], [1.1, -0.8], [-1.1, -0.8]]),
        5 => strokes(&[[-1.2, 0.0, 1.2, 0.0], [0.0, -1.2, 0.0, 1.2]]),
        6 => strokes(&[[0.0, -1.2, 0.0, 1.2], [-1.0, -0.6, 1.0, 0.6], [-1.0, 0.6, 1.0, -0.6]]),
        _ => strokes(&[[-1.0, -1.0, 1.0, 1.0], [-1.0, 1.0, 1.0, -1.0]]),
    };
    Path::new().set("class", format!("mark{look}")).set("d", d)
}
