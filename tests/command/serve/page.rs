//! A served board on a page: clients and page use the same one.

use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use harness::Scratch;
use serde_json::Value;
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

use super::client::{READ_LINE, WRITE_LINE_READ_LINE};
use super::{HELLO, Server, VERSION};

/// A page, without a browser.
struct Page(WebSocket<MaybeTlsStream<TcpStream>>);

impl Page {
    fn ask(&mut self, request: &str) {
        self.0.send(Message::text(request)).expect("it listens");
    }

    /// The next message for which `find` finds something.
    fn message<T>(&mut self, find: impl Fn(&Value) -> Option<T>) -> T {
        loop {
            let Message::Text(text) = self.0.read().expect("it continues") else { continue };
            let message = serde_json::from_str(&text).expect("it speaks JSON");
            if let Some(found) = find(&message) {
                return found;
            }
        }
    }

    /// Waits for an entry of the log.
    fn says(&mut self, voice: &str, expect: &str) {
        self.message(|message| {
            let entries = message["entries"].as_array()?;
            entries.iter().find(|entry| entry["voice"] == voice && entry["text"] == expect).map(drop)
        });
    }

    fn problem(&mut self) -> String {
        self.message(|message| {
            (message["kind"] == "problem").then(|| message["text"].as_str().unwrap_or_default().to_owned())
        })
    }

    /// The next frame: whether the clock runs, and the tick.
    fn frame(&mut self) -> (bool, f64) {
        loop {
            if let Message::Binary(frame) = self.0.read().expect("it continues") {
                let tick = f64::from_le_bytes(frame[8..16].try_into().expect("eight bytes"));
                return (frame[4] & 1 != 0, tick);
            }
        }
    }
}

/// A server with a page, and the page.
fn server(name: &str, arguments: &[&str]) -> (Server, Page) {
    let scratch = Scratch::new(name);
    scratch.write("a.c", HELLO);
    let mut command = Command::new(harness::command());
    command.args(["serve", "--live", "--no-open", "--port", "0", "--listen", "tcp:0"]).args(arguments);
    command.arg("a.c").current_dir(scratch.path()).stdout(Stdio::piped());
    let mut server = Server::spawn(command, scratch, 1);
    let mut url = String::new();
    let out = server.child.stdout.take().expect("it is piped");
    BufReader::new(out).read_line(&mut url).expect("it says where the page is");
    let socket = url.trim_end().replacen("http://", "ws://", 1).replacen("/?", "/socket?", 1);
    let (socket, _) = tungstenite::connect(socket).expect("it listens");
    (server, Page(socket))
}

#[test]
fn clients_and_page_use_the_same_board() {
    let (server, mut page) = server("serve-live", &["--log", "log.txt", "--watch", "bit46,persist.9"]);
    let time = page.message(|message| (message["kind"] == "hello").then(|| message["time"].clone()));
    assert_eq!(time, "forward");
    let names = page.message(|message| (message["kind"] == "signals").then(|| message["names"].clone()));
    assert_eq!(names, serde_json::json!(["bit46", "persist9"]));
    let mut client = server.client();
    assert_eq!(client.ask("ReadBit136"), "0");
    page.ask(r#"{"do":"act","text":"bit 136 = 1"}"#);
    while client.ask("ReadBit136") != "1" {}
    client.write_line("SetPersistDec 7 11");
    // What a page asks for, the page is answered, and a client only what it asks itself.
    page.ask(r#"{"do":"command","line":"GetPersistDec 7"}"#);
    page.says("reply", "11");
    assert_eq!(client.read_line(50), None);
    assert_eq!(client.ask("Version"), VERSION);
    // The past is not for a board that has clients.
    page.ask(r#"{"do":"goto","tick":1}"#);
    assert!(page.problem().contains("used by clients"));
    let log = std::fs::read_to_string(server.scratch.path().join("log.txt")).expect("a log");
    assert!(log.contains("\nbit 136 = 1\n") && log.contains("\nGETPERSISTDEC 7\n"), "{log}");
}

#[test]
#[expect(clippy::disallowed_methods, reason = "a client's wait is measured on the clock")]
fn clients_wait_while_a_page_has_stopped_the_clock() {
    let (server, mut page) = server("serve-live-pause", &[]);
    page.ask(r#"{"do":"rate","frames":60}"#);
    let mut client = server.client();
    // A line that is waited for, for 100 ms of a clock that runs.
    page.ask(r#"{"do":"pause"}"#);
    while page.frame().0 {}
    let (_, stopped) = page.frame();
    let begin = Instant::now();
    client.send(&[&READ_LINE.to_le_bytes()[..], &[0; 4], &100_i32.to_le_bytes()].concat());
    for _ in 0..10 {
        assert_eq!(page.frame(), (false, stopped));
    }
    page.ask(r#"{"do":"tick"}"#);
    while page.frame() == (false, stopped) {}
    assert_eq!(page.frame(), (false, stopped + 1.0));
    page.ask(r#"{"do":"run","speed":2}"#);
    assert_eq!(client.reply(), (2, vec![0]), "no line came");
    assert!(begin.elapsed() > Duration::from_millis(100), "{:?}", begin.elapsed());
    client.send(&[&WRITE_LINE_READ_LINE.to_le_bytes()[..], &[0; 4], b"Version\0"].concat());
    assert_eq!(client.reply().1, format!("{VERSION}\0").into_bytes());
    while !page.frame().0 {}
}

#[test]
fn a_page_cannot_pause_a_board_paced_by_its_clients() {
    let (server, mut page) = server("serve-live-fast", &["--pace", "fast"]);
    page.ask(r#"{"do":"pause"}"#);
    assert!(page.problem().contains("as its clients need it"));
    // A click and a command reach the board all the same.
    page.ask(r#"{"do":"act","text":"bit 136 = 1"}"#);
    page.ask(r#"{"do":"command","line":"ReadBit136"}"#);
    page.says("reply", "1");
    assert_eq!(server.client().ask("ReadBit136"), "1");
}
