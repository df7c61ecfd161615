//! The page does what mouse, fingers and keys tell it.

use crate::Page;
use crate::browser::{Browser, DESK, HAND, Window};

/// The places on the screen of the middle of the picture, and of a ball.
const MIDDLE: &str = "(() => { const r = document.getElementById('view').getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()";
const BALL: &str = "(() => { const r = document.getElementById('view').getBoundingClientRect(); \
    const at = carom.camera.project(carom.camera.matrices().both, carom.run.position(BALL, carom.state.time)); \
    return [r.x + at.x * r.width, r.y + at.y * r.height]; })()";

fn place(browser: &mut Browser, expression: &str) -> (f64, f64) {
    let at = browser.eval(expression);
    (at[0].as_f64().expect("a number"), at[1].as_f64().expect("a number"))
}

/// The colour of the picture where a ball is, and whether it is the orange of a flying one.
fn is_drawn(browser: &mut Browser, ball: usize) -> bool {
    let look = format!(
        "(() => {{ carom.draw(); const view = document.getElementById('view'); \
         const at = carom.camera.project(carom.camera.matrices().both, carom.run.position({ball}, carom.state.time)); \
         const [x, y] = [Math.round(at.x * view.width), Math.round(at.y * view.height)]; \
         const gl = view.getContext('webgl2'); const p = new Uint8Array(4); \
         if (gl) gl.readPixels(x, view.height - y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, p); \
         else p.set(view.getContext('2d').getImageData(x, y, 1, 1).data); return Array.from(p); }})()"
    );
    let pixel = browser.eval(&look);
    let [red, green, blue] = [0, 1, 2].map(|k| pixel[k].as_f64().expect("a number"));
    red > 1.6 * green && green > 1.3 * blue
}

#[test]
fn it_plays_and_pauses_and_steps() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    let page = Page::of("ramp.toml");
    browser.open(&page.path(), DESK);
    assert_eq!(browser.eval("carom.state.playing"), true);
    let (begun, start) = (browser.number("carom.state.time"), browser.eval("carom.run.position(2, carom.state.time)"));
    while browser.number("carom.state.time") < begun + 0.2 {
        browser.draw();
    }
    assert_ne!(browser.eval("carom.run.position(2, carom.state.time)"), start);
    browser.key(" ");
    assert_eq!(browser.eval("carom.state.playing"), false);
    let paused = browser.number("carom.state.time");
    browser.draw();
    assert_eq!(browser.number("carom.state.time"), paused);
    browser.key(".");
    assert!(browser.number("carom.state.time") > paused);
    browser.key(",");
    assert!((browser.number("carom.state.time") - paused).abs() < 1e-9);
    // The slider.
    let set = "(() => { const t = document.getElementById('time'); t.value = 0.25; \
               t.dispatchEvent(new Event('input', { bubbles: true })); return carom.state.time; })()";
    assert_eq!(browser.number(set), 0.25);
    browser.draw();
    for ball in 0..3 {
        assert!(is_drawn(&mut browser, ball), "ball {ball} is not where it should be in the picture");
    }
    // The events of a ball, one after the other, and back.
    browser.eval("carom.chooseBall(1)");
    browser.key("]");
    let first = browser.number("carom.run.eventTime[carom.run.eventsOf(1)[0]]");
    assert_eq!(browser.number("carom.state.time"), first);
    assert!(browser.eval("document.getElementById('event').textContent").to_string().contains("impact"));
    browser.key("]");
    assert!(browser.number("carom.state.time") > first);
    browser.key("[");
    assert_eq!(browser.number("carom.state.time"), first);
    // Faster and slower.
    browser.key(">");
    assert_eq!(browser.number("carom.state.speed"), 2.0);
    browser.key("<");
    browser.key("<");
    assert_eq!(browser.number("carom.state.speed"), 0.5);
    // At its end it stops, and begins anew.
    browser.eval("carom.seek(carom.run.duration - 0.001); carom.play(true); 0");
    while browser.eval("carom.state.playing") == true {
        browser.draw();
    }
    assert_eq!(browser.number("carom.state.time"), 10.0);
    browser.key(" ");
    assert!(browser.number("carom.state.time") < 10.0);
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn a_mouse_turns_zooms_and_chooses() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    let page = Page::of("ramp.toml");
    browser.open(&page.path(), Window { calm: true, ..DESK });
    assert_eq!(browser.eval("carom.state.playing"), false, "what moves by itself asks first");
    let (x, y) = place(&mut browser, MIDDLE);
    let turn = browser.number("carom.camera.turn");
    browser.drag(&[(x, y), (x + 60.0, y + 20.0)]);
    assert!(browser.number("carom.camera.turn") < turn);
    let distance = browser.number("carom.camera.distance");
    browser.wheel((x, y), -240.0);
    assert!(browser.number("carom.camera.distance") < distance);
    let target = browser.eval("carom.camera.target");
    browser.eval("document.getElementById('view').focus()");
    browser.call("Input.dispatchKeyEvent", &serde_json::json!({ "type": "keyDown", "key": "ArrowUp", "modifiers": 8 }));
    assert_ne!(browser.eval("carom.camera.target"), target);
    browser.key("Home");
    assert_eq!(browser.eval("carom.camera.target"), serde_json::json!([0, 0, 0]));
    for ball in ["2", "1"] {
        let at = place(&mut browser, &BALL.replace("BALL", ball));
        browser.drag(&[at]);
        assert_eq!(browser.eval("String(carom.state.ball)"), ball);
    }
    // An event on its path, by its mark in the picture.
    browser.eval("carom.chooseBall(2)");
    let mark = "(() => { const r = document.getElementById('view').getBoundingClientRect(); const { run, camera } = carom; \
                const at = camera.project(camera.matrices().both, run.event(run.eventsOf(2)[0], 2).position); \
                return [r.x + at.x * r.width, r.y + at.y * r.height]; })()";
    let at = place(&mut browser, mark);
    browser.drag(&[at]);
    assert_eq!(browser.number("carom.state.time"), browser.number("carom.run.eventTime[carom.run.eventsOf(2)[0]]"));
    // Following: the ball stays in the middle.
    browser.key("f");
    browser.eval("carom.seek(0.4)");
    browser.draw();
    assert_eq!(browser.eval("carom.camera.target"), browser.eval("carom.run.position(2, 0.4)"));
    // All controls by name, and by the keyboard: nothing that can be pressed is without words.
    let nameless = "[...document.querySelectorAll('button, input, select, canvas')].filter(e => \
                    !(e.getAttribute('aria-label') || e.labels?.[0]?.textContent.trim() || e.textContent.trim())).map(e => e.id)";
    assert_eq!(browser.eval(nameless), serde_json::json!([]));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn fingers_turn_zoom_and_choose() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    let page = Page::of("ramp.toml");
    browser.open(&page.path(), Window { calm: true, ..HAND });
    let (x, y) = place(&mut browser, MIDDLE);
    let turn = browser.number("carom.camera.turn");
    browser.touch(&[&[(x, y), (x - 40.0, y), (x - 80.0, y)]]);
    assert!(browser.number("carom.camera.turn") > turn);
    let distance = browser.number("carom.camera.distance");
    let left = [(x - 20.0, y), (x - 50.0, y), (x - 80.0, y)];
    let right = [(x + 20.0, y), (x + 50.0, y), (x + 80.0, y)];
    browser.touch(&[&left, &right]);
    assert!(browser.number("carom.camera.distance") < distance);
    browser.key("Home");
    let at = place(&mut browser, &BALL.replace("BALL", "1"));
    browser.touch(&[&[at]]);
    assert_eq!(browser.number("carom.state.ball"), 1.0);
    // Nothing is wider than the screen.
    assert!(browser.number("document.documentElement.scrollWidth") <= 390.0);
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn it_is_drawn_in_outline_without_webgl() {
    let Some(mut browser) = Browser::start(&["--disable-3d-apis"]) else { return };
    let page = Page::of("ramp.toml");
    browser.open(&page.path(), Window { calm: true, ..DESK });
    let notice =
        browser.eval("document.getElementById('notice').hidden ? '' : document.getElementById('notice').textContent");
    assert!(notice.to_string().contains("outline"), "{notice}");
    browser.eval("carom.seek(0.25)");
    browser.draw();
    assert!(is_drawn(&mut browser, 2));
    let (x, y) = place(&mut browser, MIDDLE);
    let turn = browser.number("carom.camera.turn");
    browser.drag(&[(x, y), (x + 60.0, y)]);
    assert!(browser.number("carom.camera.turn") < turn);
    browser.screenshot("outline");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn light_and_dark_follow_the_user_and_the_button() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    let page = Page::of("ramp.toml");
    let dark = "getComputedStyle(document.body).backgroundColor";
    browser.open(&page.path(), Window { calm: true, dark: true, ..DESK });
    let night = browser.eval(dark);
    browser.key("l");
    assert_ne!(browser.eval(dark), night);
    browser.key("l");
    assert_eq!(browser.eval(dark), night);
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn pictures_at_two_sizes_in_light_and_dark() {
    let Some(mut browser) = Browser::start(&[]) else { return };
    for (scene, time) in
        [("ramp", 1.2), ("room", 1.5), ("cow", 1.0), ("topspin", 1.0), ("roll", 0.8), ("jacksboro", 25.0)]
    {
        let page = Page::of(&format!("{scene}.toml"));
        for (name, window) in [("desk", DESK), ("hand", HAND)] {
            for (light, dark) in [("light", false), ("dark", true)] {
                browser.open(&page.path(), Window { calm: true, dark, ..window });
                browser.eval(&format!("carom.seek({time})"));
                browser.draw();
                browser.screenshot(&format!("{scene}-{name}-{light}"));
                assert_eq!(browser.complaints(), Vec::<String>::new(), "{scene}-{name}-{light}");
            }
        }
    }
}
