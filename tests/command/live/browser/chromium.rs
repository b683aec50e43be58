//! Chromium, by its DevTools protocol.

use serde_json::{Value, json};

use super::{Mouse, Noted, Process, Protocol};

/// The possible paths of the browser.
const PATHS: [&str; 3] = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

pub(super) struct Chromium {
    process: Process,
    session: String,
    noted: Noted,
}

impl Chromium {
    pub(super) fn start() -> Option<Self> {
        let process = Process::start(
            &PATHS,
            &[
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-background-networking",
                "--no-first-run",
                "--hide-scrollbars",
                "--window-size=1400,900",
                "--remote-debugging-port=0",
                "--user-data-dir={profile}",
            ],
            "DevTools listening on ",
            "",
        )?;
        let mut browser = Self { process, session: String::new(), noted: Noted::default() };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", attach);
        browser.session = session["sessionId"].as_str().expect("a session").to_owned();
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        Some(browser)
    }
}

impl Noted {
    fn note_chromium(&mut self, event: &Value) {
        let parameters = &event["params"];
        match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => self.complaints.push(parameters.to_string()),
            Some("Runtime.consoleAPICalled") if parameters["type"] == "error" => {
                self.complaints.push(parameters.to_string());
            }
            Some("Log.entryAdded") if parameters["entry"]["level"] == "error" => {
                self.complaints.push(parameters.to_string());
            }
            Some("Network.requestWillBeSent") => {
                self.requests.extend(parameters["request"]["url"].as_str().map(str::to_owned));
            }
            _ => {}
        }
    }
}

impl Protocol for Chromium {
    fn call(&mut self, method: &str, parameters: Value) -> Value {
        let mut call = json!({ "method": method, "params": parameters });
        if !self.session.is_empty() {
            call["sessionId"] = json!(self.session);
        }
        let noted = &mut self.noted;
        self.process.call(call, |event| noted.note_chromium(event))
    }

    fn noted(&mut self) -> &mut Noted {
        &mut self.noted
    }

    fn open(&mut self, url: &str) {
        self.call("Page.navigate", json!({ "url": url }));
    }

    fn reload(&mut self) {
        self.call("Page.reload", json!({}));
    }

    fn preload(&mut self, script: &str) {
        self.call("Page.addScriptToEvaluateOnNewDocument", json!({ "source": script }));
    }

    fn value(&mut self, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let result = self.call("Runtime.evaluate", parameters);
        assert!(result["exceptionDetails"].is_null(), "{expression}: {}", result["exceptionDetails"]);
        result["result"]["value"].clone()
    }

    fn mouse(&mut self, kind: Mouse, x: f64, y: f64) {
        let kind = match kind {
            Mouse::Move => "mouseMoved",
            Mouse::Press => "mousePressed",
            Mouse::Release => "mouseReleased",
        };
        let buttons = u8::from(kind != "mouseReleased");
        let event =
            json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1 });
        self.call("Input.dispatchMouseEvent", event);
    }

    fn resize(&mut self, width: u32, height: u32) {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    fn heap(&mut self) -> Option<f64> {
        self.call("HeapProfiler.collectGarbage", json!({}));
        let heap = self.call("Runtime.getHeapUsage", json!({}));
        Some(heap["usedSize"].as_f64()? + heap["backingStorageSize"].as_f64()?)
    }
}
