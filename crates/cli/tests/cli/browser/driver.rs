//! A browser that is steered through `WebDriver`: the few commands of the protocol that the tests of the pages need.
//!
//! A client of its own because those at hand (fantoccini, thirtyfour) bring an asynchronous runtime and TLS, some sixty packages,
//! for eight requests in JSON to a port of the same machine.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use serde_json::{Value, json};
use test_support::outside::skip;

/// Seconds that a request may take: printing 200 tails is the slowest.
const PATIENCE_S: u64 = 120;

/// A browser without a window, and the driver between it and the test.
pub(super) struct Browser {
    driver: Child,
    session: String,
}

impl Browser {
    /// A browser; `None`, said visibly, where no driver is installed.
    pub(super) fn start() -> Option<Self> {
        let started = Command::new("chromedriver")
            .arg("--port=0")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let Ok(mut driver) = started else {
            skip("chromedriver is not installed (Debian: chromium-driver)");
            return None;
        };
        let lines = BufReader::new(driver.stdout.take().unwrap()).lines();
        let port: u16 = lines
            .map_while(Result::ok)
            .find_map(|line| {
                line.split_once("successfully on port ")?.1.trim_end_matches('.').parse().ok()
            })
            .unwrap();
        let mut browser = Self { driver, session: format!("http://127.0.0.1:{port}/session") };
        let opened = browser.send("", &json!({ "capabilities": { "alwaysMatch": {
            "browserName": "chrome",
            "goog:chromeOptions": {
                "args": ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1280,900"],
            },
            "goog:loggingPrefs": { "browser": "ALL", "performance": "ALL" },
        } } }));
        browser.session = format!("{}/{}", browser.session, opened["sessionId"].as_str().unwrap());
        Some(browser)
    }

    /// Opens a file.
    pub(super) fn open(&self, page: &Path) {
        self.visit(&format!("file://{}", page.display()));
    }

    /// Opens an address.
    pub(super) fn visit(&self, address: &str) {
        self.send("/url", &json!({ "url": address }));
    }

    /// What the body of a function in the page returns.
    pub(super) fn run(&self, script: &str) -> Value {
        self.send("/execute/sync", &json!({ "script": script, "args": [] }))
    }

    /// What the body of an asynchronous function in the page returns.
    pub(super) fn run_waiting(&self, script: &str, argument: &str) -> Value {
        let script = format!(
            "const [given, done] = arguments; (async () => {{ {script} }})().then(done, (error) => done(`failed: ${{error}}`));"
        );
        self.send("/execute/async", &json!({ "script": script, "args": [argument] }))
    }

    /// A picture of the first element that a selector finds, PNG in base64.
    pub(super) fn picture(&self, selector: &str) -> String {
        let found = self.send("/element", &json!({ "using": "css selector", "value": selector }));
        let element = found.as_object().unwrap().values().next().unwrap().as_str().unwrap();
        let path = format!("/element/{element}/screenshot");
        self.answer(minreq::get(format!("{}{path}", self.session)), &path)
            .as_str()
            .unwrap()
            .to_owned()
    }

    /// The page printed, PDF in base64.
    pub(super) fn print(&self) -> String {
        self.send("/print", &json!({})).as_str().unwrap().to_owned()
    }

    /// Presses keys one after the other.
    pub(super) fn press(&self, keys: &[char]) {
        let strokes: Vec<Value> = keys
            .iter()
            .flat_map(|key| {
                ["keyDown", "keyUp"].map(|kind| json!({ "type": kind, "value": key.to_string() }))
            })
            .collect();
        self.send(
            "/actions",
            &json!({ "actions": [{ "type": "key", "id": "keys", "actions": strokes }] }),
        );
    }

    /// Moves the pointer to a place of the window.
    pub(super) fn point(&self, x: f64, y: f64) {
        self.mouse(&[move_to((x, y))]);
    }

    /// Drags from one place of the window to another.
    pub(super) fn drag(&self, from: (f64, f64), to: (f64, f64)) {
        let halfway = (f64::midpoint(from.0, to.0), f64::midpoint(from.1, to.1));
        self.mouse(&[move_to(from), button("Down"), move_to(halfway), move_to(to), button("Up")]);
    }

    /// A double click at a place of the window.
    pub(super) fn double_click(&self, at: (f64, f64)) {
        let click = || [button("Down"), button("Up")];
        self.mouse(&[&[move_to(at)][..], &click(), &click()].concat());
    }

    fn mouse(&self, steps: &[Value]) {
        self.send(
            "/actions",
            &json!({ "actions": [{ "type": "pointer", "id": "mouse", "actions": steps }] }),
        );
    }

    /// A command of the browser's own tools.
    pub(super) fn tool(&self, command: &str, parameters: &Value) -> Value {
        self.send("/goog/cdp/execute", &json!({ "cmd": command, "params": parameters }))
    }

    /// What was written to the console since the last question, and the addresses that were asked for.
    pub(super) fn console_and_requests(&self) -> (Vec<String>, Vec<String>) {
        let entries = |kind: &str| -> Vec<String> {
            let log = self.send("/se/log", &json!({ "type": kind }));
            let messages = log.as_array().unwrap().iter();
            messages.map(|entry| entry["message"].as_str().unwrap().to_owned()).collect()
        };
        let requests = entries("performance").into_iter().filter_map(|message| {
            let event: Value = serde_json::from_str(&message).unwrap();
            (event["message"]["method"] == "Network.requestWillBeSent")
                .then(|| event["message"]["params"]["request"]["url"].as_str().unwrap().to_owned())
        });
        (entries("browser"), requests.collect())
    }

    fn send(&self, path: &str, body: &Value) -> Value {
        let request = minreq::post(format!("{}{path}", self.session)).with_body(body.to_string());
        self.answer(request, path)
    }

    #[expect(clippy::unused_self, reason = "an answer is one of this browser")]
    fn answer(&self, request: minreq::Request, path: &str) -> Value {
        let answer = request.with_timeout(PATIENCE_S).send().unwrap();
        let mut answered: Value = serde_json::from_slice(answer.as_bytes()).unwrap();
        let value = answered["value"].take();
        assert!(value.get("error").is_none_or(Value::is_null), "{path}: {value}");
        value
    }
}

fn move_to((x, y): (f64, f64)) -> Value {
    json!({ "type": "pointerMove", "duration": 0, "x": x.round(), "y": y.round() })
}

fn button(way: &str) -> Value {
    json!({ "type": format!("pointer{way}"), "button": 0 })
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The browser ends with its session; a failing test must not leave it behind.
        let _ = minreq::delete(self.session.as_str()).with_timeout(10).send();
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}
