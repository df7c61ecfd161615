//! A headless Chromium, spoken to over pipes in its DevTools protocol.

use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;
use tempfile::TempDir;

/// What Chromium is called where it is installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// An answer that takes longer will not come.
const PATIENCE: Duration = Duration::from_secs(120);

/// A browser with one page.
pub struct Browser {
    child: Child,
    to: ChildStdin,
    from: Receiver<Value>,
    events: VecDeque<Value>,
    session: String,
    calls: u64,
    /// Its profile, which goes with it.
    _profile: TempDir,
}

/// A window: what a page is shown in.
#[derive(Clone, Copy)]
pub struct Window {
    /// In CSS pixels.
    pub width: u32,
    /// In CSS pixels.
    pub height: u32,
    /// Whether it is touched and not clicked.
    pub touch: bool,
    /// Whether the user prefers dark.
    pub dark: bool,
    /// Whether the user prefers little motion.
    pub calm: bool,
}

/// A window as on a desk.
pub const DESK: Window = Window { width: 1280, height: 800, touch: false, dark: false, calm: false };

/// A window as in a hand.
pub const HAND: Window = Window { width: 390, height: 844, touch: true, dark: false, calm: false };

impl Browser {
    /// Starts Chromium with further arguments; none, and a word on standard error, where there is none.
    pub fn start(arguments: &[&str]) -> Option<Self> {
        let Some(program) = NAMES.iter().find_map(|name| installed(name)) else {
            // Not by a macro, whose output a passing test swallows.
            let _ = writeln!(std::io::stderr(), "SKIP: no Chromium here, so the page is not tried in a browser");
            return None;
        };
        let profile = TempDir::new().expect("a temporary folder can be made");
        // The protocol's pipes are 3 and 4: the shell makes them of standard input and output.
        let mut child = Command::new("sh")
            .args(["-c", r#"exec "$@" 3<&0 4>&1 </dev/null >/dev/null 2>&1"#, "sh"])
            .arg(program)
            .args(["--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--no-first-run", "--hide-scrollbars"])
            .args(["--disable-background-networking", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("Chromium can be started");
        let to = child.stdin.take().expect("a pipe");
        let stdout = child.stdout.take().expect("a pipe");
        let (sender, from) = channel();
        std::thread::spawn(move || {
            for message in BufReader::new(stdout).split(0) {
                let message = message.ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
                if message.is_none_or(|message| sender.send(message).is_err()) {
                    return;
                }
            }
        });
        let mut browser =
            Self { child, to, from, events: VecDeque::new(), session: String::new(), calls: 0, _profile: profile };
        let target = browser.call("Target.createTarget", &json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        browser.session = text(&browser.call("Target.attachToTarget", &attach)["sessionId"]);
        for domain in ["Page.enable", "Runtime.enable", "Log.enable"] {
            browser.call(domain, &json!({}));
        }
        Some(browser)
    }

    /// Calls a method of the protocol and gives its result.
    pub fn call(&mut self, method: &str, params: &Value) -> Value {
        self.calls += 1;
        let id = self.calls;
        let mut message = json!({ "id": id, "method": method, "params": params });
        if !self.session.is_empty() {
            message["sessionId"] = json!(self.session);
        }
        self.to.write_all(format!("{message}\0").as_bytes()).expect("Chromium listens");
        loop {
            let answer = self.from.recv_timeout(PATIENCE).unwrap_or_else(|e| panic!("{method}: {e}"));
            if answer["id"] == json!(id) {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
            self.events.push_back(answer);
        }
    }

    /// Opens a file in a window and waits until it is loaded.
    pub fn open(&mut self, file: &std::path::Path, window: Window) {
        let Window { width, height, touch, dark, calm } = window;
        let metrics = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": touch });
        self.call("Emulation.setDeviceMetricsOverride", &metrics);
        self.call("Emulation.setTouchEmulationEnabled", &json!({ "enabled": touch }));
        let scheme = if dark { "dark" } else { "light" };
        let motion = if calm { "reduce" } else { "no-preference" };
        let features = json!([
            { "name": "prefers-color-scheme", "value": scheme },
            { "name": "prefers-reduced-motion", "value": motion },
        ]);
        self.call("Emulation.setEmulatedMedia", &json!({ "features": features }));
        self.events.clear();
        self.call("Page.navigate", &json!({ "url": format!("file://{}", file.display()) }));
        while !self.events.iter().any(|event| event["method"] == "Page.loadEventFired") {
            let event = self.from.recv_timeout(PATIENCE).expect("the page is loaded");
            self.events.push_back(event);
        }
    }

    /// The value of an expression in the page; a promise is waited for.
    pub fn eval(&mut self, expression: &str) -> Value {
        let params = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let result = self.call("Runtime.evaluate", &params);
        assert!(result["exceptionDetails"].is_null(), "{expression}: {}", result["exceptionDetails"]);
        result["result"]["value"].clone()
    }

    /// The number that an expression is.
    pub fn number(&mut self, expression: &str) -> f64 {
        let value = self.eval(expression);
        value.as_f64().unwrap_or_else(|| panic!("{expression} is {value}"))
    }

    /// Waits until two more pictures have been drawn.
    pub fn draw(&mut self) {
        self.eval("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(0))))");
    }

    /// Presses and releases a key.
    pub fn key(&mut self, key: &str) {
        let letter = if key.chars().count() == 1 { key } else { "" };
        self.call("Input.dispatchKeyEvent", &json!({ "type": "keyDown", "key": key, "text": letter }));
        self.call("Input.dispatchKeyEvent", &json!({ "type": "keyUp", "key": key }));
        self.draw();
    }

    /// Presses the button of the mouse, moves it along the places, and lets go.
    pub fn drag(&mut self, places: &[(f64, f64)]) {
        let mut send = |kind: &str, (x, y): (f64, f64), buttons: u32| {
            let params = json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1 });
            self.call("Input.dispatchMouseEvent", &params);
        };
        send("mousePressed", places[0], 1);
        places[1..].iter().for_each(|place| send("mouseMoved", *place, 1));
        send("mouseReleased", places[places.len() - 1], 0);
        self.draw();
    }

    /// Turns the wheel over a place.
    pub fn wheel(&mut self, (x, y): (f64, f64), by: f64) {
        let params = json!({ "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": by });
        self.call("Input.dispatchMouseEvent", &params);
        self.draw();
    }

    /// Puts fingers down, moves each along its places, and lifts them.
    pub fn touch(&mut self, fingers: &[&[(f64, f64)]]) {
        let points = |k: usize| -> Value { fingers.iter().map(|f| json!({ "x": f[k].0, "y": f[k].1 })).collect() };
        self.call("Input.dispatchTouchEvent", &json!({ "type": "touchStart", "touchPoints": points(0) }));
        for k in 1..fingers[0].len() {
            self.call("Input.dispatchTouchEvent", &json!({ "type": "touchMove", "touchPoints": points(k) }));
        }
        self.call("Input.dispatchTouchEvent", &json!({ "type": "touchEnd", "touchPoints": [] }));
        self.draw();
    }

    /// Keeps a picture of the page among what the tests leave behind, for people to look at.
    pub fn screenshot(&mut self, name: &str) {
        let picture = text(&self.call("Page.captureScreenshot", &json!({ "format": "png" }))["data"]);
        let bytes = base64::Engine::decode(&base64::engine::general_purpose::STANDARD, picture).expect("base64");
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
        std::fs::write(&path, bytes).expect("the picture can be kept");
    }

    /// What the page has complained about since it was opened: exceptions, errors and warnings.
    pub fn complaints(&mut self) -> Vec<String> {
        // What happened before this answer has been told by then.
        self.eval("0");
        let complains = |event: &&Value| match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => true,
            Some("Runtime.consoleAPICalled") => {
                ["error", "warning", "assert"].contains(&&*text(&event["params"]["type"]))
            }
            Some("Log.entryAdded") => ["error", "warning"].contains(&&*text(&event["params"]["entry"]["level"])),
            _ => false,
        };
        self.events.iter().filter(complains).map(|event| event["params"].to_string()).collect()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Closing the pipe would do; this does not wait for it.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The path of a program, if it is installed.
fn installed(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders).map(|folder| folder.join(name)).find(|path| path.is_file())
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}
