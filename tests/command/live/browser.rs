//! A browser without a screen, driven through its protocol: Chromium, or Firefox where `CC67_BROWSER` is `firefox`.

mod chromium;
mod firefox;

use std::env;
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use chromium::Chromium;
use firefox::Firefox;
use harness::Scratch;
use serde_json::{Value, json};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

/// The requests of a page, and its errors.
#[derive(Debug, Default)]
struct Noted {
    requests: Vec<String>,
    complaints: Vec<String>,
}

/// The protocol of a browser.
trait Protocol {
    /// Calls a function in the page's session; what happens meanwhile is noted.
    fn call(&mut self, method: &str, parameters: Value) -> Value;

    /// Requests and errors of the page so far.
    fn noted(&mut self) -> &mut Noted;

    /// Opens a page.
    fn open(&mut self, url: &str);

    /// Loads the page again.
    fn reload(&mut self);

    /// Executes a script at the beginning of each page that is opened.
    fn preload(&mut self, script: &str);

    /// The value of an expression in the page; of a promise, what it is resolved with.
    fn value(&mut self, expression: &str) -> Value;

    /// Moves, presses or releases the mouse at a place.
    fn mouse(&mut self, kind: Mouse, x: f64, y: f64);

    /// Gives the page a size.
    fn resize(&mut self, width: u32, height: u32);

    /// Bytes of the page's heap after garbage collection; `None` of a browser that does not tell.
    fn heap(&mut self) -> Option<f64>;
}

/// An action of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mouse {
    Move,
    Press,
    Release,
}

/// A browser with one page.
pub(super) struct Browser {
    protocol: Box<dyn Protocol>,
}

impl Browser {
    /// Starts one; `None` where there is none.
    pub(super) fn start() -> Option<Self> {
        let is_firefox = env::var("CC67_BROWSER").is_ok_and(|name| name == "firefox");
        let browser = if is_firefox { Self::firefox() } else { Self::chromium() };
        if browser.is_none() {
            println!("no {} here: the page is not opened", if is_firefox { "Firefox" } else { "Chromium" });
        }
        browser
    }

    fn chromium() -> Option<Self> {
        Some(Self { protocol: Box::new(Chromium::start()?) })
    }

    /// Starts Firefox; `None` where there is none.
    pub(super) fn firefox() -> Option<Self> {
        Some(Self { protocol: Box::new(Firefox::start()?) })
    }

    /// The addresses that the page has requested.
    pub(super) fn requests(&mut self) -> &[String] {
        &self.protocol.noted().requests
    }

    /// Errors of the page: exceptions, and what is in the browser's console.
    pub(super) fn complaints(&mut self) -> &[String] {
        &self.protocol.noted().complaints
    }

    /// Opens a page.
    pub(super) fn open(&mut self, url: &str) {
        self.protocol.open(url);
    }

    /// Loads the page again.
    pub(super) fn reload(&mut self) {
        self.protocol.reload();
    }

    /// Executes a script at the beginning of each page that is opened.
    pub(super) fn preload(&mut self, script: &str) {
        self.protocol.preload(script);
    }

    /// Bytes of the page's heap after garbage collection; `None` of a browser that does not tell.
    pub(super) fn heap(&mut self) -> Option<f64> {
        self.protocol.heap()
    }

    /// The value of an expression in the page; of a promise, what it is resolved with.
    pub(super) fn value(&mut self, expression: &str) -> Value {
        self.protocol.value(expression)
    }

    /// Waits until an expression is true, and fails with the state of the page if it does not in two minutes.
    pub(super) fn until(&mut self, condition: &str) {
        let loaded = "document.readyState === 'complete'";
        let script = format!(
            "new Promise((done) => {{ const end = Date.now() + 120000; const look = () => {{ let is = false; \
             try {{ is = {loaded} && ({condition}); }} catch {{}} \
             if (is || Date.now() > end) done(Boolean(is)); else setTimeout(look, 20); }}; look(); }})"
        );
        let is_met = self.value(&script) == true;
        if !is_met {
            let text = self.value("document.body.innerText");
            panic!("`{condition}` does not come true; {:?}; the page shows\n{text}", self.complaints());
        }
    }

    /// The middle of an element.
    fn middle(&mut self, selector: &str) -> (f64, f64) {
        let script = format!(
            "(() => {{ const e = document.querySelector({selector:?}); e.scrollIntoView({{ block: 'center' }}); \
             const r = e.getBoundingClientRect(); return [r.left + r.width / 2, r.top + r.height / 2]; }})()"
        );
        let place = self.value(&script);
        (place[0].as_f64().expect("a number"), place[1].as_f64().expect("a number"))
    }

    /// Presses or releases the mouse on an element.
    pub(super) fn mouse(&mut self, kind: Mouse, selector: &str) {
        let (x, y) = self.middle(selector);
        self.mouse_at(kind, x, y);
    }

    /// Moves, presses or releases the mouse at a place.
    pub(super) fn mouse_at(&mut self, kind: Mouse, x: f64, y: f64) {
        self.protocol.mouse(kind, x, y);
    }

    /// Gives the page a size.
    pub(super) fn resize(&mut self, width: u32, height: u32) {
        self.protocol.resize(width, height);
    }

    /// Clicks on an element.
    pub(super) fn click(&mut self, selector: &str) {
        self.mouse(Mouse::Move, selector);
        self.mouse(Mouse::Press, selector);
        self.mouse(Mouse::Release, selector);
    }
}

/// The process of a browser, and the connection to it.
struct Process {
    child: Child,
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
    calls: u64,
    _profile: Scratch,
}

impl Process {
    /// Starts the first of these programs that exists, with a profile of its own, whose folder replaces `{profile}` in the
    /// arguments; it prints the address after `mark`, to which `path` is added.
    fn start(programs: &[&str], arguments: &[&str], mark: &str, path: &str) -> Option<Self> {
        let program = programs.iter().find(|program| Path::new(program).is_file())?;
        let profile = Scratch::new("browser");
        let folder = profile.path().display().to_string();
        let mut child = Command::new(program)
            .args(arguments.iter().map(|argument| argument.replace("{profile}", &folder)))
            .arg("about:blank")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .ok()?;
        let errors = BufReader::new(child.stderr.take().expect("it is piped"));
        let mut lines = errors.lines().map_while(Result::ok);
        let address = lines.find_map(|line| Some(line.split_once(mark)?.1.to_owned()));
        let address = address.expect("it says where it listens") + path;
        let (socket, _) = tungstenite::connect(address).expect("it listens");
        // What else it says is of no interest, but it must be able to say it.
        std::thread::spawn(move || lines.for_each(drop));
        Some(Self { child, socket, calls: 0, _profile: profile })
    }

    /// Sends a call, and returns its answer; `note` is called for every event before it.
    fn call(&mut self, mut call: Value, mut note: impl FnMut(&Value)) -> Value {
        self.calls += 1;
        call["id"] = json!(self.calls);
        self.socket.send(Message::text(call.to_string())).expect("the browser listens");
        loop {
            let Message::Text(text) = self.socket.read().expect("the browser answers") else { continue };
            let answer: Value = serde_json::from_str(&text).expect("it speaks JSON");
            if answer["id"] == json!(self.calls) {
                assert!(answer["error"].is_null(), "{}: {answer}", call["method"]);
                return answer["result"].clone();
            }
            note(&answer);
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
