//! The page in Firefox, driven through WebDriver BiDi, where it is installed.

use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;

use harness::Scratch;
use serde_json::{Value, json};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

use super::Live;
use super::page::{PROGRAM, axis, shows};

/// The possible paths of the browser.
const PATHS: [&str; 2] = ["/usr/bin/firefox-esr", "/usr/bin/firefox"];

/// A browser with one page.
struct Firefox {
    child: Child,
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
    calls: u64,
    context: Value,
    /// Errors of the page.
    complaints: Vec<String>,
    _profile: Scratch,
}

impl Firefox {
    /// Starts one; `None` where there is none.
    fn start() -> Option<Self> {
        let path = PATHS.iter().find(|path| Path::new(path).is_file())?;
        let profile = Scratch::new("firefox");
        let mut child = Command::new(path)
            .args(["--headless", "--no-remote", "--remote-debugging-port=0", "--profile"])
            .arg(profile.path())
            .arg("about:blank")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .ok()?;
        let errors = BufReader::new(child.stderr.take().expect("it is piped"));
        let mut lines = errors.lines().map_while(Result::ok);
        let address = lines.find_map(|line| Some(line.split_once("BiDi listening on ")?.1.to_owned()));
        let address = address.expect("it says where it listens") + "/session";
        let (socket, _) = tungstenite::connect(address).expect("it listens");
        // What else it says is of no interest, but it must be able to say it.
        thread::spawn(move || lines.for_each(drop));
        let (context, complaints) = (Value::Null, Vec::new());
        let mut browser = Self { child, socket, calls: 0, context, complaints, _profile: profile };
        browser.call("session.new", json!({ "capabilities": {} }));
        browser.call("session.subscribe", json!({ "events": ["log.entryAdded"] }));
        browser.context =
            browser.call("browsingContext.getTree", json!({}))["contexts"][0]["context"].clone();
        Some(browser)
    }

    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.calls += 1;
        let call = json!({ "id": self.calls, "method": method, "params": parameters });
        self.socket.send(Message::text(call.to_string())).expect("the browser listens");
        loop {
            let Message::Text(text) = self.socket.read().expect("the browser answers") else { continue };
            let answer: Value = serde_json::from_str(&text).expect("it speaks JSON");
            if answer["id"] == json!(self.calls) {
                assert_eq!(answer["type"], "success", "{method}: {answer}");
                return answer["result"].clone();
            }
            if answer["params"]["level"] == "error" {
                self.complaints.push(answer["params"]["text"].to_string());
            }
        }
    }

    /// The value of an expression in the page.
    fn value(&mut self, expression: &str) -> Value {
        let target = json!({ "context": self.context });
        let parameters = json!({ "expression": expression, "target": target, "awaitPromise": true });
        let answer = self.call("script.evaluate", parameters);
        assert_eq!(answer["type"], "success", "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    /// Waits until an expression is true, at most two minutes.
    fn until(&mut self, expression: &str) {
        let script = format!(
            "new Promise((done) => {{ const end = Date.now() + 120000; const look = () => {{ let is = false; \
             try {{ is = {expression}; }} catch {{}} \
             if (is || Date.now() > end) done(Boolean(is)); else setTimeout(look, 20); }}; look(); }})"
        );
        assert_eq!(self.value(&script), true, "{expression}");
    }
}

impl Drop for Firefox {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn the_page_works_in_firefox() {
    let Some(mut browser) = Firefox::start() else {
        println!("no Firefox here: the page is not opened in it");
        return;
    };
    let folder = Scratch::new("live-firefox");
    folder.write("home.c", PROGRAM);
    folder.write("x.toml", "[axis.0]\nname = \"X\"\nunits = \"steps\"\n");
    let live = Live::start(&folder, &["home.c", "--machine", "x.toml", "--watch", "dest0,bit136"]);
    let open = json!({ "context": browser.context, "url": live.url, "wait": "complete" });
    browser.call("browsingContext.navigate", open);
    browser.until(&shows("#console", "homing"));
    browser.until(&shows("#threads", "ReadBit(HOME)"));
    browser.until(&format!("{} < -40", axis("Dest")));
    browser.value("document.querySelector('[aria-label=HOME]').click()");
    browser.until(&shows("#console", "home at 250"));
    browser.until(&format!("{} === 250", axis("Dest")));
    let is_drawn = "(() => { const canvas = document.querySelector('#scope canvas'); \
        const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height); \
        return data.some((byte) => byte !== 0); })()";
    browser.until(is_drawn);
    assert_eq!(browser.complaints, [""; 0]);
    assert_eq!(live.end(), "");
}
