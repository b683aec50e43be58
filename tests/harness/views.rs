//! Properties of the interfaces to a board from outside: for any data received, nothing panics, and a rejection has a
//! message.
//!
//! Editors and pages send JSON, usually known requests with wrong arguments; a controller sends bytes.

use std::io::{self, Cursor};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use cc67_debug::{Debugger, dap};
use cc67_host::{Session, Setup, UserProgram};
use cc67_live::{Show, ShownMachine, TimeControl};
use cc67_wire::{Decoder, Incoming};
use kmotiondef::{ThreadId, Ticks};
use runtime::MachineFile;

use crate::choices::Choices;

/// A program that ends soon, with something of every kind to inspect.
const PROGRAM: &str = "#include \"KMotionDef.h\"
int n, row[3] = { 10, -1, 255 };
struct { double x; char name[8]; } s = { 1.5, \"abc\" };
void count(int by) { n += by; s.x *= 0.5; row[n & 1]++; }
main() { for (n = 0; n < 9; n++) { count(0); WaitNextTimeSlice(); } printf(\"%d\\n\", n); }
";

/// The number of ticks after which a run ends.
const LIMIT: Ticks = Ticks::new(400);

/// A session with the program.
fn session() -> Session {
    static COMPILED: LazyLock<UserProgram> = LazyLock::new(|| {
        let (thread, text) = (ThreadId::new(1).expect("there are 7"), PROGRAM.as_bytes().to_vec());
        UserProgram::compile_text(Path::new("a.c"), text, thread, &Setup::default().options)
            .expect("a program")
    });
    let mut setup = Setup::default();
    setup.programs.push(COMPILED.clone().started());
    setup.session().expect("the default board exists")
}

/// Requests of editors.
const COMMANDS: &[&str] = &[
    "initialize",
    "attach",
    "setBreakpoints",
    "setFunctionBreakpoints",
    "setDataBreakpoints",
    "setInstructionBreakpoints",
    "setExceptionBreakpoints",
    "dataBreakpointInfo",
    "configurationDone",
    "continue",
    "next",
    "stepIn",
    "stepOut",
    "stepBack",
    "reverseContinue",
    "goto",
    "gotoTargets",
    "pause",
    "stackTrace",
    "scopes",
    "variables",
    "setVariable",
    "setExpression",
    "evaluate",
    "threads",
    "source",
    "loadedSources",
    "disassemble",
    "readMemory",
    "writeMemory",
    "completions",
    "restart",
    "exceptionInfo",
    "breakpointLocations",
    "terminate",
    "nosuch",
];
const REQUESTS: &[&str] = &[
    "rate", "run", "pause", "tick", "slice", "act", "command", "jog", "halt", "control", "start", "stop",
    "answer", "signals", "watch", "look", "load", "back", "go", "branch", "forget", "restart", "gather",
    "write", "machine", "source", "nosuch",
];

/// Names of arguments, and their values.
const KEYS: &[&str] = &[
    "threadId",
    "frameId",
    "variablesReference",
    "expression",
    "value",
    "name",
    "breakpoints",
    "source",
    "path",
    "line",
    "lines",
    "granularity",
    "memoryReference",
    "count",
    "offset",
    "instructionCount",
    "instructionOffset",
    "data",
    "context",
    "text",
    "column",
    "filters",
    "condition",
    "hitCondition",
    "logMessage",
    "dataId",
    "accessType",
    "start",
    "levels",
    "targetId",
    "frames",
    "speed",
    "thread",
    "axis",
    "velocity",
    "on",
    "from",
    "kind",
    "id",
    "tick",
    "list",
    "what",
];
const VALUES: &[&str] = &[
    "0",
    "1",
    "2",
    "7",
    "8",
    "-1",
    "1000",
    "4294967296",
    "1e300",
    "0.5",
    "null",
    "true",
    "false",
    "\"\"",
    "\"n\"",
    "\"row[1]\"",
    "\"s.name\"",
    "\"n = 5\"",
    "\"count\"",
    "\"a.c\"",
    "\"0x80050000\"",
    "\"0x12\"",
    "\"n/0\"",
    "\"AAAA\"",
    "\"readWrite\"",
    "[]",
    "{}",
    "[1, 3]",
    "[{\"line\": 4}]",
    "[{\"name\": \"count\", \"hitCondition\": \">1\"}]",
    "[{\"dataId\": \"n\"}]",
    "{\"path\": \"a.c\"}",
    "\"instruction\"",
    "\"double\"",
    "\"bit 46 = 1\"",
    "\"Version\"",
    "\"info threads\"",
    "\"x/9 &row\"",
    "\"SetPersistDec 1 2\"",
];

/// An object for a command with some arguments; `nested` is the name of the member that contains them.
fn message(choices: &mut Choices<'_>, (kind, all): (&str, &[&str]), nested: Option<&str>) -> String {
    let command = choices.pick(all);
    let count = choices.below(5);
    let members: Vec<_> =
        (0..count).map(|_| format!("\"{}\": {}", choices.pick(KEYS), choices.pick(VALUES))).collect();
    let members = members.join(", ");
    match nested {
        Some(name) => format!(
            "{{\"seq\": 1, \"type\": \"request\", \"{kind}\": \"{command}\", \"{name}\": {{{members}}}}}"
        ),
        None if members.is_empty() => format!("{{\"{kind}\": \"{command}\"}}"),
        None => format!("{{\"{kind}\": \"{command}\", {members}}}"),
    }
}

/// A message, occasionally with one byte changed.
fn damaged(choices: &mut Choices<'_>, message: String) -> Vec<u8> {
    let mut bytes = message.into_bytes();
    if choices.byte() < 24 {
        let at = choices.below(bytes.len());
        bytes[at] = choices.byte();
    }
    bytes
}

/// Messages of an editor to the debug adapter.
///
/// # Panics
/// A buffer does not accept the written data.
pub fn debug_adapter(bytes: &[u8]) {
    let mut choices = Choices::new(bytes);
    let mut input = Vec::new();
    let mut put = |body: &[u8]| {
        input.extend(format!("Content-Length: {}\r\n\r\n", body.len()).bytes());
        input.extend(body);
    };
    put(br#"{"seq": 1, "type": "request", "command": "launch", "arguments": {"program": "a.c"}}"#);
    while !choices.is_empty() {
        // It would connect to a server.
        let text = message(&mut choices, ("command", COMMANDS), Some("arguments"));
        let body = damaged(&mut choices, text.replace("\"attach\"", "\"launch\""));
        put(&body);
    }
    let mut launcher = |_: &dap::Launch| Ok(Debugger::new(session(), LIMIT));
    let mut output = io::sink();
    dap::serve(Cursor::new(input), &mut output, &mut launcher).expect("it takes all");
}

/// Messages of a page.
///
/// # Panics
/// A rejection has no message.
pub fn page(bytes: &[u8]) {
    let mut choices = Choices::new(bytes);
    let mut texts = Vec::new();
    while !choices.is_empty() {
        let text = message(&mut choices, ("do", REQUESTS), None);
        texts.push(String::from_utf8_lossy(&damaged(&mut choices, text)).into_owned());
    }
    // Requests that save files are not tried.
    let messages: Vec<&str> =
        texts.iter().map(String::as_str).filter(|text| !text.contains("save")).collect();
    let refused = cc67_live::execute_messages(&mut session(), show(), &messages);
    assert!(refused.iter().flatten().all(|reason| !reason.is_empty()), "{refused:?}");
}

fn show() -> Show {
    Show {
        title: "a.c".to_owned(),
        machine: ShownMachine { file: MachineFile::default(), path: None, can_rebuild: false },
        programs: Vec::new(),
        include_dirs: Vec::new(),
        watch: String::new(),
        speed: 1.0,
        is_paused: true,
        reloads: false,
        command: PathBuf::from("cc67"),
        test_options: Vec::new(),
        time: TimeControl::Full,
        limit: None,
    }
}

/// Bytes from a controller: the lines in them do not depend on the chunks in which they arrive.
///
/// # Panics
/// The lines differ.
pub fn wire(bytes: &[u8]) {
    let mut choices = Choices::new(bytes);
    let mut stream = Vec::new();
    let mut ends = Vec::new();
    while !choices.is_empty() {
        let piece = choices.pick(WIRE_PIECES);
        stream.extend(piece);
        if piece.is_empty() {
            stream.push(choices.byte());
            ends.push(stream.len());
        }
    }
    assert_eq!(lines(&stream, &ends), lines(&stream, &[]), "{stream:?}");
    let mut data = Vec::new();
    cc67_wire::ftdi::strip(&stream, ends.len(), &mut data);
    assert!(data.len() <= stream.len());
}

/// The items of a stream that arrives in chunks with these ends.
fn lines(stream: &[u8], ends: &[usize]) -> Vec<Incoming> {
    let mut decoder = Decoder::default();
    let mut items = Vec::new();
    let mut start = 0;
    for end in ends.iter().copied().chain([stream.len()]) {
        decoder.push(&stream[start..end]);
        items.extend(std::iter::from_fn(|| decoder.take()));
        start = end;
    }
    decoder.settle();
    items.extend(std::iter::from_fn(|| decoder.take()));
    items
}

const WIRE_PIECES: &[&[u8]] = &[
    b"", b"", b"\x1b", b"\x1bC\r", b"C", b"\r", b"\n", b"\r\n", b"\x01", b"\x04in.txt", b"\x07", b"\x08", b"KFLOP 4.34", b"0", b"\x03",
    b"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx",
];
