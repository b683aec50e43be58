//! Firefox, by WebDriver BiDi.

use serde_json::{Value, json};

use super::{Mouse, Noted, Process, Protocol};

/// The possible paths of the browser.
const PATHS: [&str; 2] = ["/usr/bin/firefox-esr", "/usr/bin/firefox"];

pub(super) struct Firefox {
    process: Process,
    context: Value,
    noted: Noted,
}

impl Firefox {
    pub(super) fn start() -> Option<Self> {
        let process = Process::start(
            &PATHS,
            &[
                "--headless",
                "--no-remote",
                "--remote-debugging-port=0",
                "--width=1400",
                "--height=900",
                "--profile",
                "{profile}",
            ],
            "BiDi listening on ",
            "/session",
        )?;
        let mut browser = Self { process, context: Value::Null, noted: Noted::default() };
        browser.call("session.new", json!({ "capabilities": {} }));
        let events = ["log.entryAdded", "network.beforeRequestSent"];
        browser.call("session.subscribe", json!({ "events": events }));
        let tree = browser.call("browsingContext.getTree", json!({}));
        browser.context = tree["contexts"][0]["context"].clone();
        browser.resize(1400, 900);
        Some(browser)
    }
}

impl Noted {
    fn note_firefox(&mut self, event: &Value) {
        let parameters = &event["params"];
        match event["method"].as_str() {
            Some("log.entryAdded") if parameters["level"] == "error" => {
                self.complaints.push(parameters["text"].to_string());
            }
            Some("network.beforeRequestSent") => {
                self.requests.extend(parameters["request"]["url"].as_str().map(str::to_owned));
            }
            _ => {}
        }
    }
}

impl Protocol for Firefox {
    fn call(&mut self, method: &str, parameters: Value) -> Value {
        let noted = &mut self.noted;
        let call = json!({ "method": method, "params": parameters });
        self.process.call(call, |event| noted.note_firefox(event))
    }

    fn noted(&mut self) -> &mut Noted {
        &mut self.noted
    }

    fn open(&mut self, url: &str) {
        let open = json!({ "context": self.context, "url": url, "wait": "none" });
        self.call("browsingContext.navigate", open);
    }

    fn reload(&mut self) {
        self.call("browsingContext.reload", json!({ "context": self.context, "wait": "none" }));
    }

    fn preload(&mut self, script: &str) {
        let function = format!("() => {{ const script = {}; (0, eval)(script); }}", json!(script));
        self.call("script.addPreloadScript", json!({ "functionDeclaration": function }));
    }

    /// The value comes as JSON: the protocol's own form of it tells types apart.
    fn value(&mut self, expression: &str) -> Value {
        let expression = expression.trim_end_matches(';');
        let script = format!("(async () => JSON.stringify((await ({expression})) ?? null))()");
        let target = json!({ "context": self.context });
        let parameters = json!({ "expression": script, "target": target, "awaitPromise": true });
        let answer = self.call("script.evaluate", parameters);
        assert_eq!(answer["type"], "success", "{expression}: {answer}");
        let text = answer["result"]["value"].as_str().unwrap_or("null");
        serde_json::from_str(text).expect("it is JSON")
    }

    fn mouse(&mut self, kind: Mouse, x: f64, y: f64) {
        let (x, y) = (x.round() as i64, y.round() as i64);
        let to = json!({ "type": "pointerMove", "x": x, "y": y });
        let actions = match kind {
            Mouse::Move => vec![to],
            Mouse::Press => vec![to, json!({ "type": "pointerDown", "button": 0 })],
            Mouse::Release => vec![to, json!({ "type": "pointerUp", "button": 0 })],
        };
        let pointer = json!({ "type": "pointer", "id": "mouse", "actions": actions });
        self.call("input.performActions", json!({ "context": self.context, "actions": [pointer] }));
    }

    fn resize(&mut self, width: u32, height: u32) {
        let viewport = json!({ "width": width, "height": height });
        let size = json!({ "context": self.context, "viewport": viewport, "devicePixelRatio": 1 });
        self.call("browsingContext.setViewport", size);
    }

    fn heap(&mut self) -> Option<f64> {
        None
    }
}
