//! The numbers in the page are the program's.

use crate::Page;
use crate::browser::{Browser, DESK};
use serde_json::Value;

/// The share of the scene's size that single precision may be off, with room for a few roundings.
const SINGLE: f64 = 4e-7;

#[test]
fn balls_are_where_the_program_has_them() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    // Parabolas; quartics of the adaptive pair; lines of Euler's method, whose velocity is not the slope of its path.
    for scene in ["ramp.toml", "room.toml", "barrier-1d.toml", "cow.toml", "topspin.toml", "roll.toml"] {
        let page = Page::of(scene);
        browser.open(&page.path(), DESK);
        let frames = page.carom(&["run", "--quiet", "--fps", "7", "--frames", "-"]);
        let rows: Vec<Vec<&str>> = frames.lines().skip(1).map(|line| line.split(',').collect()).collect();
        let times: Vec<&str> = rows.iter().map(|row| row[0]).collect();
        let balls: Vec<&str> = rows.iter().map(|row| row[1]).collect();
        let told = browser.eval(&format!(
            "(() => {{ const {{ run }} = carom, times = [{}], balls = [{}]; \
             return times.map((t, i) => [...run.position(balls[i], t).map((x, k) => x + run.origin[k]), \
             ...run.velocity(balls[i], t), run.motionOf(balls[i], t)]); }})()",
            times.join(","),
            balls.join(","),
        ));
        let size = browser.number("carom.run.size");
        let fastest = rows.iter().map(|row| speed(row)).fold(0.0, f64::max);
        for (row, told) in rows.iter().zip(told.as_array().expect("a list")) {
            for k in 0..6 {
                let scale = if k < 3 { size } else { fastest };
                let (ours, theirs) = (number(row[2 + k]), told[k].as_f64().expect("a number"));
                assert!((ours - theirs).abs() <= SINGLE * scale, "{scene} {row:?}: {told}");
            }
            assert_eq!(told[6], row[8], "{scene} {row:?}");
        }
        assert_eq!(browser.complaints(), Vec::<String>::new(), "{scene}");
    }
}

#[test]
fn energy_is_the_summarys() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    for scene in ["ramp.toml", "room.toml", "barrier-1d.toml", "ball-drops.toml", "topspin.toml", "roll.toml"] {
        let page = Page::of(scene);
        browser.open(&page.path(), DESK);
        let summary: Value = serde_json::from_str(&page.carom(&["run", "--quiet", "--summary", "-"])).expect("JSON");
        let energy = &summary["energy"];
        assert_eq!(browser.eval("carom.run.unit"), energy["unit"], "{scene}");
        let start = energy["start"].as_f64().expect("a number");
        for (when, key) in [("0", "start"), ("carom.run.duration", "end")] {
            let told = browser.eval(&format!("carom.run.totalEnergy({when})"));
            let told = told["kinetic"].as_f64().expect("a number") + told["potential"].as_f64().expect("a number");
            let ours = energy[key].as_f64().expect("a number");
            // Single precision of heights over the floor, of which energies are made.
            assert!((told - ours).abs() <= 1e-5 * start, "{scene}, {key}: {told} and {ours}");
        }
    }
}

#[test]
fn balls_turn_as_the_program_has_them() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    for scene in ["topspin.toml", "roll.toml"] {
        let page = Page::of(scene);
        browser.open(&page.path(), DESK);
        let frames = page.carom(&["run", "--quiet", "--fps", "7", "--frames", "-"]);
        for row in frames.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>()) {
            let told = browser.eval(&format!("carom.run.turning({}, {}).spin", row[1], row[0]));
            for axis in 0..3 {
                let (ours, theirs) = (number(row[9 + axis]), told[axis].as_f64().expect("a number"));
                assert!((ours - theirs).abs() <= SINGLE * 500.0, "{scene} {row:?}: {told}");
            }
        }
        // What a stretch of motion ends with, by the page's own sum, is what the next one begins with, by the program's.
        let worst = browser.number(
            "(() => { const { run } = carom; let worst = 0; \
             for (let ball = 0; ball < run.count; ball++) \
               for (let i = run.firstSegment[ball]; i + 1 < run.firstSegment[ball + 1]; i++) { \
                 const end = run.turningIn(ball, i, run.segmentEnd(ball, i)).orientation; \
                 const begin = run.orientations.subarray(4 * (i + 1), 4 * (i + 1) + 4); \
                 worst = Math.max(worst, 1 - Math.abs(end.reduce((sum, x, k) => sum + x * begin[k], 0))); } \
             return worst; })()",
        );
        assert!(worst < 1e-6, "{scene}: {worst}");
        assert_eq!(browser.complaints(), Vec::<String>::new(), "{scene}");
    }
}

#[test]
fn events_are_the_programs() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    let page = Page::of("ramp.toml");
    browser.open(&page.path(), DESK);
    let events = page.carom(&["run", "--quiet", "--events", "-"]);
    let rows: Vec<Vec<&str>> = events.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert!(rows.len() > 20);
    for (i, row) in rows.iter().enumerate() {
        let told = browser.eval(&format!("carom.run.event({i}, {})", row[1]));
        assert_eq!(told["time"], number(row[0]), "{row:?}");
        assert_eq!((&told["kind"], &told["surface"]), (&Value::from(row[2]), &Value::from(row[3])), "{row:?}");
        for (k, key) in [(8, "normal"), (11, "velocityIn"), (14, "velocityOut")] {
            for axis in 0..3 {
                assert_eq!(told[key][axis], f64::from(number(row[k + axis]) as f32), "{row:?} {key}");
            }
        }
    }
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("{cell}"))
}

fn speed(row: &[&str]) -> f64 {
    (5..8).map(|k| number(row[k]).abs()).fold(0.0, f64::max)
}
