//! An editor attaches its debugger to a board that serves programs of the PC, or that a page shows, and leaves it again.
//!
//! The client here speaks the Debug Adapter Protocol from its description alone.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use harness::Scratch;
use harness::promptness::{answers_at_once, timed};
use serde_json::{Value, json};

/// A program that counts, a hundred times a second of board time.
const COUNTS: &str = "\
#include \"KMotionDef.h\"
int rounds;
main()
{
    for (;;)
    {
        rounds = rounds + 1;
        Delay_sec(0.01);
    }
}
";

/// A command that runs a board with this program; ended when it goes out of scope.
struct Running {
    child: Child,
    scratch: Scratch,
    port: u16,
}

impl Running {
    fn start(name: &str, arguments: &[&str]) -> Self {
        let scratch = Scratch::new(name);
        scratch.write("a.c", COUNTS);
        let mut command = Command::new(harness::command());
        command.args(arguments).args(["--debug", "0", "a.c"]).current_dir(scratch.path());
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
        let mut stderr = BufReader::new(child.stderr.take().expect("it is piped"));
        let port = loop {
            let mut line = String::new();
            assert_ne!(stderr.read_line(&mut line).expect("it is text"), 0, "it says where editors attach");
            if let Some((_, port)) = line.trim_end().split_once("an editor can attach at 127.0.0.1:") {
                break port.parse().expect("a number");
            }
        };
        // What it says later is nobody's.
        std::thread::spawn(move || std::io::copy(&mut stderr, &mut std::io::sink()));
        Self { child, scratch, port }
    }

    fn editor(&self) -> Editor {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        let input = BufReader::new(stream.try_clone().expect("a stream"));
        Editor { input: Box::new(input), output: Box::new(stream), number: 0, events: Vec::new() }
    }

    /// Sets a breakpoint in the line that counts.
    fn breaks(&self, editor: &mut Editor, lines: &[u32]) -> Value {
        let source = json!({ "path": self.scratch.path().join("a.c") });
        let breakpoints: Vec<_> = lines.iter().map(|line| json!({ "line": line })).collect();
        editor.ask("setBreakpoints", json!({ "source": source, "breakpoints": breakpoints }))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // One that has ended is as good.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A client of the protocol.
pub(crate) struct Editor {
    input: Box<dyn BufRead>,
    output: Box<dyn Write>,
    number: u64,
    events: Vec<Value>,
}

impl Editor {
    /// A client of a debugger that was started with pipes.
    pub(crate) fn of(child: &mut Child) -> Self {
        let (input, output) = (child.stdout.take().expect("piped"), child.stdin.take().expect("piped"));
        Self {
            input: Box::new(BufReader::new(input)),
            output: Box::new(output),
            number: 0,
            events: Vec::new(),
        }
    }

    fn read(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert_ne!(self.input.read_line(&mut line).expect("it is text"), 0, "the board is gone");
            match line.trim_end().split_once(": ") {
                Some((_, value)) => length = value.parse().expect("a number"),
                None => break,
            }
        }
        let mut body = vec![0; length];
        self.input.read_exact(&mut body).expect("as long as it says");
        serde_json::from_slice(&body).expect("a message")
    }

    /// Asks something; the response, which is one of success.
    pub(crate) fn ask(&mut self, command: &str, arguments: Value) -> Value {
        self.number += 1;
        let message =
            json!({ "seq": self.number, "type": "request", "command": command, "arguments": arguments });
        let text = message.to_string();
        write!(self.output, "Content-Length: {}\r\n\r\n{text}", text.len()).expect("it is there");
        self.output.flush().expect("it is there");
        loop {
            let message = self.read();
            if message["type"] == "response" {
                assert_eq!(message["request_seq"], self.number);
                assert_eq!(message["success"], true, "{message}");
                return message["body"].clone();
            }
            self.events.push(message);
        }
    }

    /// The next event of this name.
    pub(crate) fn event(&mut self, name: &str) -> Value {
        loop {
            if let Some(at) = self.events.iter().position(|event| event["event"] == name) {
                return self.events.remove(at)["body"].clone();
            }
            let message = self.read();
            self.events.push(message);
        }
    }

    /// Begins a session on a board that runs.
    fn attach(&mut self, arguments: Value) -> Value {
        let able = self.ask("initialize", json!({ "adapterID": "cc67" }));
        self.ask("attach", arguments);
        self.event("initialized");
        able
    }

    /// The value of `rounds` where the board stands.
    fn rounds(&mut self) -> i64 {
        let stack = self.ask("stackTrace", json!({ "threadId": 1 }));
        let frame = stack["stackFrames"][0]["id"].clone();
        let value = self.ask("evaluate", json!({ "expression": "rounds", "frameId": frame }));
        value["result"].as_str().and_then(|text| text.parse().ok()).expect("a number")
    }
}

#[test]
fn a_served_board_stops_at_a_breakpoint_and_continues_after_the_editor() {
    let board = Running::start("attach-serve", &["serve", "--listen", "tcp:0"]);
    let mut editor = board.editor();
    let able = editor.attach(json!({}));
    // Its clients would not know.
    assert_eq!(able["supportsStepBack"], false);
    let set = board.breaks(&mut editor, &[7]);
    assert_eq!(
        (&set["breakpoints"][0]["verified"], &set["breakpoints"][0]["line"]),
        (&true.into(), &7.into())
    );
    editor.ask("configurationDone", json!({}));
    let stop = editor.event("stopped");
    assert_eq!((&stop["reason"], &stop["threadId"]), (&"breakpoint".into(), &1.into()));
    let first = editor.rounds();

    // While it is stopped it does not move; steps move it.
    assert_eq!(editor.rounds(), first);
    editor.ask("next", json!({ "threadId": 1 }));
    assert_eq!((editor.event("stopped")["reason"].as_str(), editor.rounds()), (Some("step"), first + 1));
    editor.ask("continue", json!({ "threadId": 1 }));
    assert_eq!(
        (editor.event("stopped")["reason"].as_str(), editor.rounds()),
        (Some("breakpoint"), first + 1)
    );
    editor.ask("stepBack", json!({ "threadId": 1 }));
    assert_eq!(editor.event("output")["output"], "others use this board: it does not go back\n");
    assert_eq!(editor.event("stopped")["reason"], "step");

    // One that vanishes leaves a board that runs, without breakpoints.
    drop(editor);
    let mut editor = board.editor();
    editor.attach(json!({}));
    editor.ask("configurationDone", json!({}));
    loop {
        editor.ask("pause", json!({ "threadId": 1 }));
        assert_eq!(editor.event("stopped")["reason"], "pause");
        if editor.rounds() > first + 20 {
            break;
        }
        editor.ask("continue", json!({ "threadId": 1 }));
    }
    editor.ask("disconnect", json!({}));
}

#[cfg(feature = "live")]
#[test]
fn an_editor_attaches_its_debugger_to_the_board_of_a_page() {
    let board = Running::start("attach-live", &["live", "--no-open", "--port", "0"]);
    let mut command = Command::new(harness::command());
    command.args(["debug", "--dap"]).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().expect("it starts");
    let mut editor = Editor::of(&mut child);
    editor.attach(json!({ "address": format!("127.0.0.1:{}", board.port) }));
    assert_eq!(editor.event("capabilities")["capabilities"]["supportsStepBack"], false);
    board.breaks(&mut editor, &[8]);
    editor.ask("configurationDone", json!({}));
    assert_eq!(editor.event("stopped")["reason"], "breakpoint");
    let first = editor.rounds();
    board.breaks(&mut editor, &[]);
    editor.ask("dataBreakpointInfo", json!({ "name": "rounds" }));
    editor.ask("setDataBreakpoints", json!({ "breakpoints": [{ "dataId": "1|0|rounds" }] }));
    editor.ask("continue", json!({ "threadId": 1 }));
    let stop = editor.event("stopped");
    assert_eq!(stop["reason"], "data breakpoint", "{stop}");
    assert_eq!(editor.rounds(), first + 1);
    editor.ask("disconnect", json!({}));
    drop(editor);
    assert!(child.wait().expect("it ends").success());
}

/// The time that a new editor waits for its answer beside a thousand connections that say nothing.
fn time_beside_silent_ones(board: &Running) -> Duration {
    let idle: Vec<_> =
        (0..1000).map(|_| TcpStream::connect(("127.0.0.1", board.port)).expect("it listens")).collect();
    let time = timed(|| {
        board.editor().ask("initialize", json!({}));
    });
    drop(idle);
    time
}

/// A thousand connections that say nothing keep no editor out: neither from a board that is served, nor from
/// `debug --listen`.
#[test]
fn silent_connections_keep_no_editor_out() {
    answers_at_once("serve", || {
        time_beside_silent_ones(&Running::start("attach-idle", &["serve", "--listen", "tcp:0"]))
    });
    answers_at_once("debug --listen", || time_beside_silent_ones(&debug_of_nothing()));
}

/// `debug --listen` without a program.
fn debug_of_nothing() -> Running {
    let scratch = Scratch::new("debug-idle");
    let mut command = Command::new(harness::command());
    command.args(["debug", "--listen", "0"]).current_dir(scratch.path());
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
    let mut line = String::new();
    let mut stderr = BufReader::new(child.stderr.take().expect("it is piped"));
    stderr.read_line(&mut line).expect("it is text");
    let port = line.trim_end().rsplit(':').next().and_then(|port| port.parse().ok()).expect(&line);
    Running { child, scratch, port }
}
