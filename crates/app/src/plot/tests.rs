//! Charts are well-formed, complete and the same every time.

use super::*;

fn precision() -> Chart {
    let mut chart = Chart::new(
        "What accuracy costs: a drop & its bounces",
        "Error falls as cost rises; <exact> is alone in the corner.",
        Axis::log("cost, ns per simulated second"),
        Axis::log("error of position, m"),
    );
    for (look, (name, order)) in
        [("textbook Euler", 1), ("own f", 1), ("robust", 1), ("semi-implicit", 1), ("RK4", 4), ("adaptive", 5)]
            .into_iter()
            .enumerate()
    {
        let point = |k: i32| {
            [
                800.0 * (1.0 + 0.13 * look as f64) * 2f64.powi(k),
                (2f64.powi(-k * order) * 0.3 / (1 + look) as f64).max(1e-15),
            ]
        };
        chart.series.push(Series::new(name, look, (0..9).map(point).collect()));
    }
    chart.series.push(Series::new("exact", 6, vec![[300.0, 2e-16]]));
    chart.rules.push(Rule { across: Across::Y, value: 1e-6, label: "target 1e-6 m".into() });
    chart
}

fn count(text: &str, what: &str) -> usize {
    text.matches(what).count()
}

#[test]
fn a_chart_has_a_title_a_description_and_both_schemes() {
    let svg = precision().svg();
    assert!(svg.contains("role=\"img\"") && svg.contains("prefers-color-scheme: dark"));
    assert!(svg.contains("drop &amp; its bounces</title>"), "{svg}");
    assert!(svg.contains("&lt;exact&gt; is alone in the corner.</desc>"), "{svg}");
    assert_eq!(svg, precision().svg());
}

#[test]
fn every_point_has_its_mark_and_every_series_its_name_and_own_look() {
    let svg = precision().svg();
    for look in 0..6 {
        // One at each point and one before the name.
        assert_eq!(count(&svg, &format!("class=\"mark{look}\"")), 10);
        assert_eq!(count(&svg, &format!("class=\"name name{look}\"")), 1);
    }
    let shapes: std::collections::BTreeSet<String> = (0..8).map(|k| look::mark(k, 0.0, 0.0).to_string()).collect();
    assert_eq!(shapes.len(), 8);
}

#[test]
fn what_cannot_be_drawn_breaks_the_line_and_is_left_out() {
    let mut chart = Chart::new("", "", Axis::linear("t"), Axis::log("e"));
    chart.series.push(Series::new("", 0, vec![[0.0, 1.0], [1.0, 0.0], [2.0, f64::NAN], [3.0, 1.0], [4.0, 2.0]]));
    let svg = chart.svg();
    assert_eq!(count(&svg, "class=\"mark0\""), 3);
    let line = svg.split("series line0\" d=\"").nth(1).and_then(|s| s.split('"').next()).expect("a line");
    assert_eq!((count(line, "M"), count(line, "L")), (2, 1));
    // Nothing at all is a chart, too.
    chart.series.clear();
    assert!(!chart.svg().contains("NaN"));
}

#[test]
fn equal_scales_are_equal() {
    let mut chart = Chart::new("", "", Axis::linear("x"), Axis::linear("z"));
    chart.equal = true;
    chart.series.push(Series::new("", 0, vec![[0.0, 0.0], [1.0, 1.0], [30.0, 2.0]]));
    let svg = chart.svg();
    let line = svg.split("series line0\" d=\"").nth(1).and_then(|s| s.split('"').next()).expect("a line");
    let xy: Vec<f64> = line.split(['M', 'L', ' ']).filter_map(|s| s.parse().ok()).collect();
    let (right, up) = (xy[2] - xy[0], xy[1] - xy[3]);
    assert!((right - up).abs() <= 0.2 && right > 10.0, "{right} {up}");
}

#[test]
fn names_do_not_cover_each_other() {
    let chart = precision();
    let svg = chart.svg();
    let mut boxes: Vec<[f64; 4]> = Vec::new();
    for part in svg.split("class=\"name name").skip(1) {
        let value = |key: &str| -> f64 {
            part.split(&format!("{key}=\"")).nth(1).and_then(|s| s.split('"').next()?.parse().ok()).expect(key)
        };
        let name = part.split('>').nth(1).and_then(|s| s.split('<').next()).expect("a name").trim();
        let (x, y) = (value(" x"), value(" y"));
        boxes.push([x, x + look::width(name, look::TEXT), y - look::TEXT, y]);
    }
    assert_eq!(boxes.len(), chart.series.len());
    for (k, a) in boxes.iter().enumerate() {
        let clear = |b: &[f64; 4]| a[1] <= b[0] || b[1] <= a[0] || a[3] <= b[2] || b[3] <= a[2];
        assert!(boxes[k + 1..].iter().all(clear), "{boxes:?}");
    }
}
