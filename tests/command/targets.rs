//! One trial of every board that the command controls, in every view: run, console, test, debugger, editor, page.
//!
//! The boards are the model on its engines, and the firmware files that `CC67_FIRMWARE` and `CC67_FIRMWARE_5` name.

use std::env;
use std::process::{Command, Stdio};

use harness::{Output, Scratch, cc67, cc67_with_input};
use serde_json::json;

use super::attach::Editor;

const PROGRAM: &str = "\
#include \"KMotionDef.h\"
int total;
int twice(int n)
{
    return n + n;
}
main()
{
    int k;
    for (k = 1; k < 4; k++)
    {
        total += twice(k);
        printf(\"total %d\\n\", total);
    }
    persist.UserData[5] = total;
}
";

/// The options that select a board, each with its name.
fn boards() -> Vec<(String, Vec<String>)> {
    let fixed = [
        ("bytecode", &["--engine", "bytecode"][..]),
        ("native", &["--engine", "native"]),
        ("as board", &["--as", "board"]),
    ];
    let owned = |options: &[&str]| options.iter().map(|&option| option.to_owned()).collect();
    let mut boards: Vec<_> = fixed.map(|(name, options)| (name.to_owned(), owned(options))).into();
    for variable in ["CC67_FIRMWARE", "CC67_FIRMWARE_5"] {
        match env::var(variable) {
            Ok(file) => boards.push((variable.to_owned(), owned(&["--boot", &file]))),
            Err(_) => println!("not tried: {variable} names no firmware file"),
        }
    }
    boards
}

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write("twice.c", PROGRAM);
    scratch
}

/// Checks the output of a view on each board; board times are left out by `without_times`.
fn each(view: impl Fn(&str, &[String]) -> Output, expect: &str) {
    for (name, options) in boards() {
        let output = view(&name, &options);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{name}: {output:?}");
        assert_eq!(without_times(&output.stdout), expect, "{name}");
    }
}

/// The text without `, 0.000103 s` in brackets.
fn without_times(text: &str) -> String {
    let line = |line: &str| match line.rsplit_once(", 0.") {
        Some((before, time)) if time.ends_with(" s]") => format!("{before}]\n"),
        _ => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

fn arguments<'a>(words: &[&'a str], options: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    words.iter().copied().chain(options.iter().map(String::as_str)).chain(more.iter().copied()).collect()
}

#[test]
fn a_program_runs_the_same_on_every_board() {
    let scratch = scratch("targets-run");
    let run = |_: &str, options: &[String]| cc67(&scratch, arguments(&["run"], options, &["twice.c"]));
    each(run, "total 2\ntotal 6\ntotal 12\n");
}

#[test]
fn the_console_of_every_board_answers_the_same() {
    let scratch = scratch("targets-console");
    let script = "run twice.c\nwait 0.01\nGetPersistDec 5\nFoo\n";
    let console = |_: &str, options: &[String]| {
        cc67_with_input(&scratch, arguments(&["console"], options, &[]), script)
    };
    each(console, "total 2\ntotal 6\ntotal 12\n12\nFOO\n^\nerror, invalid command\n");
}

#[test]
fn a_golden_output_holds_on_every_board() {
    let scratch = scratch("targets-test");
    scratch.write("twice.stim", "at end expect persist 5 = 12\n");
    let blessed = cc67(&scratch, ["test", "--bless", "twice.c"]);
    assert_eq!(blessed.code, 0, "{blessed:?}");
    for (name, options) in boards() {
        let output = cc67(&scratch, arguments(&["test"], &options, &["twice.c"]));
        assert_eq!(output.code, 0, "{name}: {output:?}");
    }
}

/// The words of the debugger that all boards have in common: the arguments of a call and its result are shown where the
/// board executes bytecode, and the addresses of the code are its own.
fn in_common(text: &str) -> String {
    let words = |line: &str| {
        let mut parts = line.split("0x800");
        let first = parts.next().unwrap_or_default().to_owned();
        let hex = |c: char| c.is_ascii_hexdigit();
        let line = parts.fold(first, |text, part| text + "ADDRESS" + part.trim_start_matches(hex));
        let line = line.replace("ADDRESS in ", "").replace("$4 =", "$N =").replace("$5 =", "$N =");
        ["1", "2", "3"]
            .iter()
            .fold(line, |line, n| line.replace(&format!("twice (n={n})"), "twice ()"))
            .replace("$6 =", "$N =")
    };
    let lines = text.lines().filter(|line| !line.starts_with("Value returned is"));
    lines.map(|line| words(line) + "\n").collect()
}

#[test]
fn the_debugger_goes_forwards_and_backwards_on_every_board() {
    let scratch = scratch("targets-debug");
    // At a call everything before it is in memory, also in code for the processor, where lines overlap otherwise.
    let commands = "\
break twice
continue
print total
continue
continue
print total
backtrace
reverse-continue
print total
reverse-continue
finish
delete
continue
print total
reverse-continue
print total
";
    scratch.write("commands", commands);
    let debug = |name: &str, options: &[String]| {
        // The interpreter is what the debugger holds on the model, whatever runs programs elsewhere.
        let options = if name == "native" { &[] } else { options };
        cc67(&scratch, arguments(&["debug", "-O0", "--batch", "commands"], options, &["twice.c"]))
    };
    let expect = "\
Breakpoint 1 at ADDRESS: file twice.c, line 5.
Continuing.

Breakpoint 1, twice () at twice.c:5 [thread 1]
5\t    return n + n;
$1 = 0
Continuing.

Breakpoint 1, twice () at twice.c:5 [thread 1]
5\t    return n + n;
Continuing.

Breakpoint 1, twice () at twice.c:5 [thread 1]
5\t    return n + n;
$2 = 6
#0  twice () at twice.c:5
#1  main () at twice.c:12
Continuing.

Breakpoint 1, twice () at twice.c:5 [thread 1]
5\t    return n + n;
$3 = 2
Continuing.

Breakpoint 1, twice () at twice.c:5 [thread 1]
5\t    return n + n;
Run till exit from #0  twice () at twice.c:5
main () at twice.c:12 [thread 1]
12\t        total += twice(k);
Continuing.
[All threads have ended]
$N = 12
Continuing.
No more reverse-execution history.
";
    for (name, options) in boards() {
        let output = debug(&name, &options);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{name}: {output:?}");
        let text = without_times(&output.stdout);
        // The PC reads a line some time after it was printed, so where a line stands among the stops differs.
        let (console, text): (Vec<_>, Vec<_>) =
            text.split_inclusive('\n').partition(|line| line.starts_with("total "));
        assert_eq!(console.concat(), "total 2\ntotal 6\ntotal 12\n", "{name}");
        let text = in_common(&text.concat());
        // The board's start differs: its first instant ends the way back.
        let known = text.split_inclusive("No more reverse-execution history.\n").next();
        assert_eq!(known, Some(expect), "{name}");
        assert!(text.ends_with("$N = 0\n"), "{name}: {text}");
    }
}

#[test]
fn an_editor_stops_and_steps_back_on_every_board() {
    let scratch = scratch("targets-editor");
    for (name, options) in boards() {
        // As in the terminal, the debugger holds the model's interpreter.
        let options = if name == "native" { Vec::new() } else { options };
        let mut command = Command::new(harness::command());
        command.args(["debug", "--dap", "-O0"]).args(&options).current_dir(scratch.path());
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it starts");
        let mut editor = Editor::of(&mut child);
        editor.ask("initialize", json!({ "adapterID": "cc67" }));
        let path = scratch.path().join("twice.c");
        editor.ask("launch", json!({ "program": path }));
        let breakpoints = json!({ "source": { "path": path }, "breakpoints": [{ "line": 5 }] });
        let set = editor.ask("setBreakpoints", breakpoints);
        assert_eq!(set["breakpoints"][0]["verified"], true, "{name}: {set}");
        editor.ask("configurationDone", json!({}));
        for (request, reason, line, total) in [
            ("", "breakpoint", 5, "0"),
            ("continue", "breakpoint", 5, "2"),
            ("stepOut", "step", 12, "2"),
            ("reverseContinue", "breakpoint", 5, "2"),
            ("reverseContinue", "breakpoint", 5, "0"),
        ] {
            if !request.is_empty() {
                editor.ask(request, json!({ "threadId": 1 }));
            }
            assert_eq!(editor.event("stopped")["reason"], reason, "{name}: {request}");
            let stack = editor.ask("stackTrace", json!({ "threadId": 1 }));
            let frame = &stack["stackFrames"][0];
            assert_eq!(frame["line"], line, "{name}: {request}");
            let value = editor.ask("evaluate", json!({ "expression": "total", "frameId": frame["id"] }));
            assert_eq!(value["result"], total, "{name}: {request}");
        }
        editor.ask("disconnect", json!({}));
        drop(editor);
        assert!(child.wait().expect("it ends").success(), "{name}");
    }
}

#[cfg(feature = "live")]
#[test]
fn the_page_shows_the_console_of_every_board() {
    use tungstenite::Message;

    let scratch = scratch("targets-live");
    for (name, options) in boards() {
        let words: Vec<_> = options.iter().map(String::as_str).chain(["twice.c"]).collect();
        let live = super::live::Live::start(&scratch, &words);
        let (mut socket, _) = tungstenite::connect(live.socket()).expect(&name);
        let mut seen = String::new();
        while !seen.contains("total 12") {
            if let Message::Text(text) = socket.read().expect(&name) {
                seen.push_str(&text);
            }
        }
    }
}
