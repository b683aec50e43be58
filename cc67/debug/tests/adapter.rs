//! The debug adapter as an editor uses it: requests in, responses and events out.

use std::fs;
use std::io::{self, BufReader, PipeWriter, Write};

use cc67_debug::{Debugger, dap};
use cc67_host::{Setup, UserProgram};
use compiler::passes::Level;
use kmotiondef::{ThreadId, Ticks};
use serde_json::{Value, json};

const PROGRAM: &str = "#include \"KMotionDef.h\"
int n, row[3] = { 10, -1, 255 };
int *wild = (int *)0x12;
void count(int by)
{
    n += by;
    if (n < 0) row[1] = *wild;
}
int stepped(int by)
{
    return 10 * by;
}
main()
{
    if (n) stepped(n);
    for (;;)
    {
        count(1);
        WaitNextTimeSlice();
    }
}
";

/// The messages sent by the adapter; the editor disconnects after the answer to its last request.
struct Sent {
    bytes: Vec<u8>,
    /// The editor's end of the pipe, and the number of its last request.
    editor: Option<(PipeWriter, usize)>,
}

impl Write for &mut Sent {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let is_last = self.editor.as_ref().is_some_and(|(_, last)| {
            let mark = format!("\"request_seq\":{last},");
            self.bytes.windows(mark.len()).any(|window| window == mark.as_bytes())
        });
        if is_last {
            self.editor = None;
        }
        Ok(())
    }
}

/// Lets an adapter answer requests, and returns all its messages.
fn serve(name: &str, requests: &[Value]) -> Vec<Value> {
    let path = std::env::temp_dir().join(format!("cc67-debug-adapter-{}-{name}.c", std::process::id()));
    fs::write(&path, PROGRAM).expect("a file");
    let mut input = Vec::new();
    for (number, request) in requests.iter().enumerate() {
        let mut request = request.clone();
        request["seq"] = json!(number + 1);
        request["type"] = json!("request");
        let text = request.to_string();
        input.extend(format!("Content-Length: {}\r\n\r\n{text}", text.len()).bytes());
    }
    let (reader, mut editor) = io::pipe().expect("a pipe");
    editor.write_all(&input).expect("a pipe takes some thousand bytes");
    let mut output = Sent { bytes: Vec::new(), editor: Some((editor, requests.len())) };
    let launched = path.clone();
    let mut launcher = move |_: &dap::Launch| {
        let mut setup = Setup::default();
        setup.options.level = Level::None;
        let thread = ThreadId::new(1).expect("there are 7");
        let program =
            UserProgram::compile(&launched, thread, &setup.options).map_err(|error| error.to_string())?;
        setup.programs.push(program.started());
        let session = setup.session().map_err(|error| error.to_string())?;
        Ok(Debugger::new(session, Ticks::new(10_000)))
    };
    dap::serve(BufReader::new(reader), &mut output, &mut launcher).expect("a buffer takes all");
    fs::remove_file(&path).expect("it is ours");
    let text = String::from_utf8(output.bytes).expect("it is text");
    let bodies = text.split("Content-Length: ").skip(1).filter_map(|part| part.split_once("\r\n\r\n"));
    bodies.map(|(_, body)| serde_json::from_str(body).expect("it is JSON")).collect()
}

/// Requests up to a stop at `count`, at the second call.
fn stopped(hits: &str, then: &[Value]) -> Vec<Value> {
    let breakpoint = json!({ "breakpoints": [{ "name": "count", "hitCondition": hits }] });
    let mut requests = vec![
        json!({ "command": "initialize", "arguments": {} }),
        json!({ "command": "launch", "arguments": { "program": "x" } }),
        json!({ "command": "setFunctionBreakpoints", "arguments": breakpoint }),
        json!({ "command": "configurationDone" }),
    ];
    requests.extend_from_slice(then);
    requests
}

fn evaluate(expression: &str, context: &str) -> Value {
    json!({ "command": "evaluate", "arguments": { "expression": expression, "context": context, "frameId": 100_000 } })
}

/// The responses to requests of a kind, in order.
fn responses<'a>(sent: &'a [Value], command: &str) -> Vec<&'a Value> {
    sent.iter().filter(|one| one["type"] == "response" && one["command"] == command).collect()
}

fn events<'a>(sent: &'a [Value], name: &str) -> Vec<&'a Value> {
    sent.iter().filter(|one| one["event"] == name).collect()
}

#[test]
fn conditions_on_hits_stop_where_they_say_or_are_refused() {
    for (hits, expect) in [("2", Some("1")), ("== 3", Some("2")), ("> 3", Some("3")), ("% 4", Some("3"))] {
        let sent = serve("hits", &stopped(hits, &[evaluate("n", "watch")]));
        let value = responses(&sent, "evaluate").first().and_then(|one| one["body"]["result"].as_str());
        assert_eq!(value, expect, "{hits}");
    }
    let sent = serve("wrong", &stopped("abc", &[]));
    let breakpoint = &responses(&sent, "setFunctionBreakpoints")[0]["body"]["breakpoints"][0];
    assert_eq!(breakpoint["verified"], false);
    assert!(breakpoint["message"].as_str().is_some_and(|text| text.contains("`abc`")), "{breakpoint}");
}

#[test]
fn the_console_has_the_commands_of_the_terminal() {
    let then = [
        evaluate("info threads", "repl"),
        evaluate("n += 10", "repl"),
        evaluate("n", "repl"),
        evaluate("catch when n > 14", "repl"),
        evaluate("tick 2", "repl"),
        evaluate("-exec continue", "repl"),
        evaluate("goto", "repl"),
    ];
    let sent = serve("console", &stopped("2", &then));
    let answers = responses(&sent, "evaluate");
    let results: Vec<_> = answers.iter().map(|one| one["body"]["result"].as_str().unwrap_or("")).collect();
    assert!(
        results[0].contains("* 1    running     count () at") || results[0].contains("count (by=1)"),
        "{results:?}"
    );
    assert_eq!((results[1], results[2]), ("11", "11"));
    assert!(results[3].starts_with("Catchpoint 2 (when n > 14)"), "{results:?}");
    assert!(results[5].contains("\nBreakpoint 1, count"), "{results:?}");
    assert!(
        answers[6]["message"].as_str().is_some_and(|text| text.contains("needs an argument")),
        "{:?}",
        answers[6]
    );
    // The editor is informed that the board has moved, and of its position.
    assert_eq!(events(&sent, "continued").len(), 2);
    let reasons: Vec<_> = events(&sent, "stopped").iter().map(|one| one["body"]["reason"].clone()).collect();
    assert_eq!(reasons, ["breakpoint", "step", "breakpoint"]);
}

#[test]
fn values_are_shown_as_the_editor_wants_them_and_failures_are_quiet() {
    let hex = json!({ "command": "evaluate",
        "arguments": { "expression": "row[2]", "context": "watch", "format": { "hex": true } } });
    let then = [
        json!({ "command": "stackTrace", "arguments": { "threadId": 1 } }),
        evaluate("row[2],x", "watch"),
        hex,
        evaluate("nothing", "hover"),
        evaluate("*wild", "watch"),
        json!({ "command": "readMemory", "arguments": { "memoryReference": "0x12", "count": 4 } }),
    ];
    let sent = serve("values", &stopped("2", &then));
    let frames = &responses(&sent, "stackTrace")[0]["body"]["stackFrames"];
    assert_eq!((frames[0]["name"].as_str(), frames[1]["name"].as_str()), (Some("count(by=1)"), Some("main")));
    let answers = responses(&sent, "evaluate");
    assert_eq!(
        (&answers[0]["body"]["result"], &answers[1]["body"]["result"]),
        (&json!("0xff"), &json!("0xff"))
    );
    assert_eq!(answers[2]["body"]["error"]["showUser"], false);
    assert_eq!(answers[3]["message"], "Cannot access memory at address 0x12");
    let memory = &responses(&sent, "readMemory")[0]["body"];
    assert_eq!((&memory["data"], &memory["unreadableBytes"]), (&json!(""), &json!(4)));
}

#[test]
fn only_the_console_of_an_editor_calls_functions() {
    let then = [
        evaluate("count(5)", "hover"),
        evaluate("count(5)", "watch"),
        evaluate("n", "watch"),
        evaluate("count(5)", "repl"),
        evaluate("n", "watch"),
        evaluate("count(-9)", "repl"),
        evaluate("n", "watch"),
        evaluate("stepped(3) + stepped(4),x", "repl"),
    ];
    let sent = serve("calls", &stopped("2", &then));
    let answers = responses(&sent, "evaluate");
    assert!(
        !answers[0]["success"].as_bool().unwrap_or(true) && !answers[1]["success"].as_bool().unwrap_or(true)
    );
    assert_eq!((&answers[2]["body"]["result"], &answers[3]["body"]["result"]), (&json!("1"), &json!("void")));
    assert_eq!(answers[4]["body"]["result"], "6");
    let message = answers[5]["message"].as_str().unwrap_or_default();
    assert!(
        message.contains("count at")
            && message.ends_with("read of the unmapped address 0x00000012; nothing has changed"),
        "{message}"
    );
    assert_eq!((&answers[6]["body"]["result"], &answers[7]["body"]["result"]), (&json!("6"), &json!("0x46")));
}

#[test]
fn data_breakpoints_stop_at_reads_as_well() {
    let info = json!({ "command": "dataBreakpointInfo", "arguments": { "name": "n" } });
    let breakpoints = |access: &str| {
        json!({ "command": "setDataBreakpoints",
        "arguments": { "breakpoints": [{ "dataId": "0|0|n", "accessType": access }] } })
    };
    let clear = json!({ "command": "setFunctionBreakpoints", "arguments": { "breakpoints": [] } });
    let go = json!({ "command": "continue", "arguments": { "threadId": 1 } });
    for (access, expect) in [
        ("read", ["n: 1, accessed by thread 1, count at", "n: 2, accessed by thread 1, count at"]),
        ("readWrite", ["n: 1, accessed by thread 1, count at", "n: 1 → 2, accessed by thread 1, count at"]),
        ("write", ["n: 1 → 2, written by thread 1, count at", "n: 2 → 3, written by thread 1, count at"]),
    ] {
        let then = [
            info.clone(),
            breakpoints(access),
            clear.clone(),
            go.clone(),
            go.clone(),
            evaluate("n", "watch"),
        ];
        let sent = serve("data", &stopped("2", &then));
        let types = &responses(&sent, "dataBreakpointInfo")[0]["body"]["accessTypes"];
        assert_eq!(types, &json!(["read", "write", "readWrite"]));
        let stops: Vec<_> = events(&sent, "stopped").iter().map(|one| one["body"].clone()).collect();
        for (stop, expect) in stops[1..].iter().zip(expect) {
            assert_eq!(stop["reason"], "data breakpoint");
            assert!(stop["text"].as_str().is_some_and(|text| text.starts_with(expect)), "{access}: {stop}");
        }
    }
}
