//! Clients that mean no good: the board continues, and says in one line that something is wrong.

use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;

use harness::Scratch;
use harness::promptness::{answers_at_once, timed};
use serde_json::Value;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Bytes, Message};

use super::Live;

/// Counts forever.
const PROGRAM: &str =
    "#include \"KMotionDef.h\"\nmain() { for (;;) { WaitNextTimeSlice(); persist.UserData[9]++; } }\n";

fn board(name: &str) -> (Scratch, Live) {
    let folder = Scratch::new(name);
    fs::write(folder.path().join("a.c"), PROGRAM).expect("files can be written");
    let live = Live::start(&folder, &["a.c"]);
    (folder, live)
}

/// The status line that a plain request is answered with.
fn status(live: &Live, request: &str) -> String {
    let mut stream = TcpStream::connect(live.host()).expect("it listens");
    stream.write_all(request.replace("HOST", live.host()).as_bytes()).expect("it reads");
    let mut answer = String::new();
    // A connection that is cut is an answer, too.
    let _ = stream.read_to_string(&mut answer);
    answer.lines().next().unwrap_or_default().to_owned()
}

/// The board still shows frames in which time continues.
fn is_alive(live: &Live) {
    let (mut socket, _) = tungstenite::connect(live.socket()).expect("a page may come");
    socket.send(Message::text(r#"{"do":"rate","frames":60}"#)).expect("it listens");
    let mut ticks = Vec::new();
    while ticks.len() < 5 {
        if let Message::Binary(frame) = socket.read().expect("it goes on") {
            let tick = frame[8..16].try_into().expect("eight bytes");
            ticks.push(f64::from_le_bytes(tick));
        }
    }
    assert!(ticks.is_sorted() && ticks[0] < ticks[4], "{ticks:?}");
}

#[test]
fn requests_without_the_token_or_from_other_origins_are_refused() {
    let (_folder, live) = board("live-gate");
    let token = live.url.split("token=").nth(1).expect("there is one").to_owned();
    let get =
        |path: &str, more: &str| status(&live, &format!("GET {path} HTTP/1.1\r\nHost: HOST\r\n{more}\r\n"));
    assert_eq!(get(&format!("/?token={token}"), ""), "HTTP/1.1 200 OK");
    assert_eq!(get("/", ""), "HTTP/1.1 403 Forbidden");
    assert_eq!(get("/?token=0123456789abcdef0123456789abcdef", ""), "HTTP/1.1 403 Forbidden");
    assert_eq!(get(&format!("/?token={token}"), "Origin: http://evil.example\r\n"), "HTTP/1.1 403 Forbidden");
    assert_eq!(get(&format!("/..%2f..%2fetc/passwd?token={token}"), ""), "HTTP/1.1 404 Not Found");
    let renamed = format!("GET /?token={token} HTTP/1.1\r\nHost: evil.example\r\n\r\n");
    assert_eq!(status(&live, &renamed), "HTTP/1.1 403 Forbidden");
    assert_eq!(status(&live, "\x16\x03\x01 hello\r\n\r\n"), "HTTP/1.1 400 Bad Request");
    let mut other = live.socket().into_client_request().expect("an address");
    other.headers_mut().insert("Origin", "http://evil.example".parse().expect("a value"));
    assert!(tungstenite::connect(other).is_err());
    is_alive(&live);
    let said = live.end();
    assert_eq!(said.lines().filter(|line| line.contains("wrong token")).count(), 1, "{said}");
    assert_eq!(said.lines().filter(|line| line.contains("another site")).count(), 1, "{said}");
}

#[test]
fn nonsense_floods_and_disconnects_do_not_stop_the_board() {
    let (_folder, live) = board("live-flood");
    // Ten thousand messages, as fast as they go, without a look at the answers; then it vanishes.
    let (mut flood, _) = tungstenite::connect(live.socket()).expect("it listens");
    for _ in 0..10_000 {
        if flood.send(Message::text(r#"{"do":"act","text":"persist 5 = 1"}"#)).is_err() {
            break;
        }
    }
    drop(flood);
    let nonsense = [
        Message::text("{}"),
        Message::text("[".repeat(10_000)),
        Message::text(r#"{"do":"start","thread":99999999999}"#),
        Message::Binary(Bytes::from(vec![0; 1000])),
        Message::text("x".repeat(100_000)),
    ];
    for message in nonsense {
        let (mut socket, _) = tungstenite::connect(live.socket()).expect("it listens");
        // It may be cut off while it sends.
        let _ = socket.send(message);
        while socket.read().is_ok() {}
    }
    // Frames that are none, and half a frame.
    for bytes in [&[0xff; 64][..], &[0x81, 0xfe, 0xff, 0xff], &[0x82, 0x7f]] {
        let (mut socket, _) = tungstenite::connect(live.socket()).expect("it listens");
        let tungstenite::stream::MaybeTlsStream::Plain(stream) = socket.get_mut() else { panic!("no TLS") };
        stream.write_all(bytes).expect("it reads");
    }
    // What cannot be done is answered.
    let (mut socket, _) = tungstenite::connect(live.socket()).expect("it listens");
    for request in [
        r#"{"do":"start","thread":9}"#,
        r#"{"do":"act","text":"bit 46 = 1"}"#,
        r#"{"do":"act","text":"bit 136 = 1\nat end expect bit 1 = 1"}"#,
        r#"{"do":"watch","list":"nothing"}"#,
        r#"{"do":"save","name":"../../x"}"#,
    ] {
        socket.send(Message::text(request)).expect("it listens");
        let problem = loop {
            let Message::Text(text) = socket.read().expect("it answers") else { continue };
            let message: Value = serde_json::from_str(&text).expect("it speaks JSON");
            if message["kind"] == "problem" {
                break message["text"].to_string();
            }
        };
        assert!(problem.len() > 10, "{request}: {problem}");
    }
    is_alive(&live);
    let said = live.end();
    assert_eq!(said.lines().filter(|line| line.contains("what is not a request")).count(), 1, "{said}");
}

#[test]
#[cfg(unix)]
fn flash_that_a_page_was_told_of_is_in_the_file_when_the_board_is_killed() {
    let folder = Scratch::new("live-flash");
    fs::write(folder.path().join("a.c"), PROGRAM).expect("files can be written");
    let live = Live::start(&folder, &["--flash", "board.flash", "a.c"]);
    let (mut socket, _) = tungstenite::connect(live.socket()).expect("a page may come");
    for line in ["SetPersistDec 7 77", "Flash"] {
        let request = serde_json::json!({"do": "command", "line": line}).to_string();
        socket.send(Message::text(request)).expect("it listens");
    }
    loop {
        if let Message::Text(text) = socket.read().expect("it goes on")
            && text.contains("Program Flash Image Complete")
        {
            break;
        }
    }
    live.end();
    let arguments = ["console", "--flash", "board.flash"];
    let output = harness::cc67_with_input(&folder, arguments, "GetPersistDec 7\n");
    assert!(output.render().starts_with("77\n"), "{}", output.render());
}

#[test]
fn a_thousand_silent_clients_keep_no_page_out() {
    answers_at_once("live", || {
        let (_folder, live) = board("live-idle");
        let idle: Vec<_> = (0..1000).map(|_| TcpStream::connect(live.host()).expect("it listens")).collect();
        let token = live.url.split("token=").nth(1).expect("there is one").to_owned();
        let request = format!("GET /?token={token} HTTP/1.1\r\nHost: HOST\r\n\r\n");
        let time = timed(|| assert_eq!(status(&live, &request), "HTTP/1.1 200 OK"));
        is_alive(&live);
        drop(idle);
        time
    });
}
