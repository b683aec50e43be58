//! A controller at the other end of a link: the model, or a firmware file, that is served on a pseudo-terminal or a port.

use std::env;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use harness::{Output, Scratch, cc67, cc67_with_input, command, files, root};
use serde_json::json;

use crate::attach::Editor;
use crate::serve::Server;

/// Prints, and changes an element of `persist.UserData`.
const PROGRAM: &str = "\
#include \"KMotionDef.h\"
main()
{
    int i;
    for (i = 0; i < 3; i++) printf(\"count %d\\n\", i);
    persist.UserData[5] = i;
}
";

/// Prints until somebody ends it.
const ENDLESS: &str = "\
#include \"KMotionDef.h\"
main()
{
    for (;;) { Delay_sec(0.01); persist.UserData[6]++; }
}
";

/// A board that is served on a link, and its address.
fn served(name: &str, options: &[&str]) -> (Server, String) {
    let listen = if cfg!(unix) { ["serve", "--listen", "pty"] } else { ["serve", "--listen", "tcp-raw:0"] };
    let arguments = [&listen[..], options, &["--load", "7:a.c"]].concat();
    let server = Server::start(name, &arguments, ENDLESS, 1);
    let place = server.places[0].clone();
    (server, place)
}

fn on(scratch: &Scratch, words: &[&str], place: &str, more: &[&str]) -> Output {
    let arguments = [words, &["--yes", "--on", place], more].concat();
    cc67(scratch, arguments)
}

#[test]
fn a_program_is_loaded_and_runs() {
    let scratch = Scratch::new("controller-run");
    scratch.write("a.c", PROGRAM);
    let (_server, place) = served("controller-run-board", &[]);
    for _ in 0..2 {
        let output = on(&scratch, &["run"], &place, &["a.c"]);
        assert_eq!((output.code, output.stdout.as_str()), (0, "count 0\ncount 1\ncount 2\n"), "{output:?}");
        assert!(output.stderr.starts_with("cc67: connected to "), "{}", output.stderr);
    }
    scratch.write("b.c", "#include \"KMotionDef.h\"\nmain() { printf(\"%d\\n\", persist.UserData[7]); }\n");
    let output = on(&scratch, &["run"], &place, &["--set", "persist.7=9", "b.c"]);
    assert_eq!(output.stdout, "9\n", "{output:?}");
    let output = on(&scratch, &["run"], &place, &["--time", "--for", "0.5", "3:a.c"]);
    assert_eq!((output.code, output.stdout.lines().count()), (0, 3), "{output:?}");
}

#[test]
fn a_controller_with_firmware_5_gets_programs_for_it_and_its_status_record_is_read() {
    let scratch = Scratch::new("controller-5");
    scratch.write("a.c", "#include \"KMotionDef.h\"\nmain() { Delay_sec(0.2); persist.UserData[5]++; printf(\"%d\\n\", persist.UserData[5]); }\n");
    let (_server, place) = served("controller-5-board", &["--board", "kflop-5.3.2"]);
    let output = on(&scratch, &["run"], &place, &["--set", "persist.5=41", "a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "42\n"), "{output:?}");
    assert!(output.stderr.contains("KFLOP 5.3.2"), "{output:?}");
}

/// A program of c-programs, and the words with which it runs.
struct Example {
    path: PathBuf,
    words: Vec<String>,
}

/// The programs of c-programs that need no stimulus and no machine.
fn examples() -> Vec<Example> {
    files(&root().join("c-programs"), "c").into_iter().filter_map(example).collect()
}

/// The program of a file whose first line says how it runs; `None` of one that needs more than a controller has.
fn example(path: PathBuf) -> Option<Example> {
    let text = fs::read_to_string(&path).expect("text");
    let options = text.lines().next()?.strip_prefix("// cc67: run")?;
    let has = |extension| path.with_extension(extension).exists();
    let is_left_out = OTHER.iter().any(|other| path.ends_with(other));
    if is_left_out || options.contains("--for") || !has("expected") || has("stim") || has("toml") {
        return None;
    }
    let mut words = vec![path.to_str().expect("text").to_owned()];
    let mut options = options.split_whitespace();
    while let Some(option) = options.next() {
        if option == "also" {
            let (thread, file) = options.next().expect("a file").split_once(':').expect("a thread");
            words.push(format!("{thread}:{}", path.with_file_name(file).display()));
        } else {
            words.push(option.to_owned());
        }
    }
    Some(Example { path, words })
}

/// Programs that are left out: one restarts the board, one is stopped when the primary thread is free of the PC's requests,
/// the others show board times.
const OTHER: &[&str] =
    &["start_up.c", "soft_limits.c", "signal_tower.c", "slices.c", "watchdog.c", "mailbox.c"];

/// The console that a program prints on the model.
fn expected(path: &Path) -> String {
    let text = fs::read_to_string(path.with_extension("expected")).expect("text");
    text.split("---- ").next().unwrap_or_default().to_owned()
}

/// Runs each program on a board of its own; returns how many there were.
fn run_all(name: &str, options: &[&str], left_out: &[&str]) -> usize {
    let scratch = Scratch::new(name);
    let mut all = examples();
    all.retain(|example| !left_out.iter().any(|other| example.path.ends_with(other)));
    let (next, wrong) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    thread::scope(|scope| {
        for worker in 0..4 {
            let (all, next, wrong, scratch) = (&all, &next, &wrong, &scratch);
            scope.spawn(move || {
                while let Some(Example { path, words }) = all.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let (_server, place) = served(&format!("{name}-board{worker}"), options);
                    let files = format!("files{worker}");
                    // Boxes stay open on a controller until they are answered.
                    let answers = ["--answer=msgbox=yes", "--answer=msgbox=ok"];
                    let more = [&["--for=20", "--files", &files], &answers[..]].concat();
                    let words: Vec<_> = more.into_iter().chain(words.iter().map(|word| &**word)).collect();
                    let output = on(scratch, &["run"], &place, &words);
                    if output.code != 0 || output.stdout != expected(path) {
                        wrong.lock().expect("no run panics").push(format!("{}: {output:?}", path.display()));
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().expect("no run panics");
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), all.len(), wrong.join("\n"));
    all.len()
}

#[test]
fn programs_print_behind_a_link_what_they_print_on_the_model() {
    let count = run_all("controller-all", &["--pace", "20"], &[]);
    assert!(count >= 60, "{count}");
}

#[test]
fn programs_print_the_same_on_the_firmware_behind_a_link() {
    let Ok(firmware) = env::var("CC67_FIRMWARE") else {
        println!("not tried: CC67_FIRMWARE names no firmware file");
        return;
    };
    // The firmware's own line and the program's come in either order.
    let left_out = ["following_error.c"];
    run_all("controller-boot", &["--pace", "1", "--boot", &firmware], &left_out);
}

#[test]
fn threads_that_were_active_before_are_neither_waited_for_nor_stopped() {
    let scratch = Scratch::new("controller-others");
    scratch.write("a.c", PROGRAM);
    let (_server, place) = served("controller-others-board", &[]);
    let console = |input: &str| cc67_with_input(&scratch, ["console", "--yes", "--on", &place], input);
    assert_eq!(console("Execute7\n").code, 0, "it ends, and thread 7 runs on");
    let output = on(&scratch, &["run"], &place, &["a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "count 0\ncount 1\ncount 2\n"), "{output:?}");
    assert_eq!(console("CheckThread7\n").stdout, "1\n");
}

#[test]
fn the_console_shows_replies_and_refusals() {
    let scratch = Scratch::new("controller-console");
    let (_server, place) = served("controller-console-board", &[]);
    let input = "Version\nSetPersistDec 5 42\nGetPersistDec 5\nBOGUS\nVersion;CheckThread1\n";
    let output = cc67_with_input(&scratch, ["console", "--yes", "--on", &place], input);
    let version = "KFLOP 4.34 Build 16:07:06 Aug 14 2018";
    let expect = format!("{version}\n42\nerror, invalid command\n{version}\n0\n");
    assert_eq!((output.code, output.stdout), (0, expect), "{}", output.stderr);
}

#[test]
fn programs_for_another_firmware_are_refused_unless_forced() {
    let scratch = Scratch::new("controller-firmware");
    scratch.write("a.c", PROGRAM);
    let (_server, place) = served("controller-firmware-board", &[]);
    let other = ["--board", "kflop-5.3.2", "a.c"];
    let output = on(&scratch, &["run"], &place, &other);
    assert_eq!(output.code, 2, "{output:?}");
    for text in ["another firmware", "board:   KFLOP 4.34", "program: KFLOP 5.3.2", "--force"] {
        assert!(output.stderr.contains(text), "{}", output.stderr);
    }
    scratch.write("pure.c", "main() { int i, n = 0; for (i = 0; i < 9; i++) n += i; }\n");
    let output = on(&scratch, &["run"], &place, &["--force", "--board", "kflop-5.3.2", "pure.c"]);
    assert_eq!(output.code, 0, "{output:?}");
    let built = cc67(&scratch, ["build", "--board", "kflop-5.3.2", "a.c", "-o", "a(1).out"]);
    assert_eq!(built.code, 0, "{built:?}");
    let output = on(&scratch, &["run"], &place, &["a(1).out"]);
    assert!(output.code == 2 && output.stderr.contains("another firmware"), "{output:?}");
    let built = cc67(&scratch, ["build", "--thread", "2", "a.c", "-o", "b.out"]);
    assert_eq!(built.code, 0, "{built:?}");
    let output = on(&scratch, &["run"], &place, &["1:b.out"]);
    assert!(output.code == 2 && output.stderr.contains("not for thread 1"), "{output:?}");
    assert_eq!(on(&scratch, &["run"], &place, &["2:b.out"]).code, 0, "the board is in order");
}

#[test]
fn options_of_a_simulated_board_and_missing_consent_are_refused_by_name() {
    let scratch = Scratch::new("controller-options");
    scratch.write("a.c", PROGRAM);
    for (option, value) in [
        ("--machine", Some("m.toml")),
        ("--races", None),
        ("--engine", Some("bytecode")),
        ("--flash", Some("flash.bin")),
    ] {
        let words: Vec<_> = [Some(option), value, Some("a.c")].into_iter().flatten().collect();
        let output = on(&scratch, &["run"], "tcp:localhost:1", &words);
        let expect = format!("`{option}` is about a simulated board");
        assert!(output.code == 2 && output.stderr.contains(&expect), "{output:?}");
    }
    let output = cc67(&scratch, ["run", "--on", "tcp:localhost:1", "a.c"]);
    assert!(output.code == 2 && output.stderr.contains("Switch the drives off"), "{output:?}");
    let output = cc67(&scratch, ["run", "--on", "lpt1", "a.c"]);
    assert!(output.code == 2 && output.stderr.contains("serial:PATH"), "{output:?}");
    for command in [&["serve"][..], &["console", "--serve=tcp:0"]] {
        let output = on(&scratch, command, "tcp:localhost:1", &["a.c"]);
        assert!(output.code == 2 && output.stderr.contains("does not work with `--on` yet"), "{output:?}");
    }
}

/// Variables for a debugger, and a loop that changes them.
const NAMED: &str = "\
#include \"KMotionDef.h\"
int ticks;
double level = 2.5;
struct Point { int a; float b; } point = {3, 4.5};
main()
{
    for (;;) { Delay_sec(0.01); ticks++; point.a += 2; level += point.b; }
}
";

#[test]
fn a_debugger_shows_and_sets_variables_of_a_running_program_and_controls_its_threads() {
    let scratch = Scratch::new("controller-debug");
    scratch.write("a.c", NAMED);
    let (_server, place) = served("controller-debug-board", &[]);
    let debug = ["debug", "--yes", "--on", &place, "--for", "1", "2:a.c"];
    let commands = "p ticks\np point\nset var level = 100\np level + 1\nrun\npause 2\ninfo threads\np ticks\np ticks\n\
                    p point.a - 2 * ticks\nresume 2\np level > 110\nkill 2\ninfo threads\nset var persist.UserData[3] = 7\n\
                    p persist.UserData[3]\np missing\nbreak 7\nstep\nwatch ticks\nrwatch ticks\np ReadBit(3)\nrc\nslice\n";
    let output = cc67_with_input(&scratch, debug, commands);
    assert_eq!(output.code, 0, "{output:?}");
    let lines: Vec<_> = output.stdout.lines().collect();
    let value = |number: usize| {
        let start = format!("${number} = ");
        lines.iter().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("{output:?}"))
    };
    // Before it runs.
    assert_eq!([value(1), value(2), value(3)], ["0", "{a = 3, b = 4.5}", "101"]);
    // A paused thread changes nothing, and continues.
    assert_eq!([value(4), value(6), value(7)], [value(5), "3", "1"]);
    assert!(value(4).parse::<u32>().expect("a number") > 20, "{output:?}");
    assert_eq!(value(8), "7");
    for state in ["* 2    paused      ", "* 2    not active  "] {
        assert!(lines.contains(&state), "{output:?}");
    }
    let refusals = "\
No symbol \"missing\" in current context.
a connected controller cannot stop at breakpoints
a connected controller cannot stop at breakpoints
a connected controller cannot stop where a variable changes
a connected controller cannot stop where a variable is read
a connected controller cannot call functions of a program from an expression
a connected controller cannot go back to an earlier state
a connected controller cannot stop its time
";
    assert!(output.stdout.ends_with(refusals), "{output:?}");
    assert!(output.stderr.contains("thread 7 holds cc67's monitor now"), "{output:?}");
}

#[test]
fn an_editor_shows_variables_of_a_running_program_and_ends_it() {
    let scratch = Scratch::new("controller-editor");
    scratch.write("a.c", NAMED);
    let (_server, place) = served("controller-editor-board", &[]);
    let mut debugger = Command::new(command());
    debugger.args(["debug", "--dap", "--yes", "--on", &place]).current_dir(scratch.path());
    let mut child = debugger.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it starts");
    let mut editor = Editor::of(&mut child);
    editor.ask("initialize", json!({ "adapterID": "cc67" }));
    editor.ask("launch", json!({ "program": scratch.path().join("a.c") }));
    let source = json!({ "path": scratch.path().join("a.c") });
    let set = editor.ask("setBreakpoints", json!({ "source": source, "breakpoints": [{ "line": 7 }] }));
    let breakpoint =
        json!({ "verified": false, "message": "a connected controller cannot stop at breakpoints" });
    assert_eq!(set["breakpoints"], json!([breakpoint]));
    editor.ask("configurationDone", json!({}));
    let first = editor.event("output")["output"].clone();
    assert_eq!(
        first,
        "The programs run on a controller: Pause stops this view, not them. Stop kills their threads.\n"
    );

    editor.ask("pause", json!({ "threadId": 1 }));
    assert_eq!(editor.event("stopped")["reason"], "pause");
    let stack = editor.ask("stackTrace", json!({ "threadId": 1 }));
    let frame = &stack["stackFrames"][0];
    assert_eq!((&stack["totalFrames"], &frame["name"]), (&json!(1), &json!("(running)")));
    let scopes = editor.ask("scopes", json!({ "frameId": frame["id"] }));
    let globals = scopes["scopes"][1]["variablesReference"].clone();
    let variables = editor.ask("variables", json!({ "variablesReference": globals }));
    let names: Vec<_> =
        variables["variables"].as_array().expect("a list").iter().map(|one| &one["name"]).collect();
    assert_eq!(names, ["level", "point", "ticks"]);
    // The program runs on meanwhile.
    let ticks = |editor: &mut Editor| {
        let value = editor.ask("evaluate", json!({ "expression": "ticks", "frameId": frame["id"] }));
        value["result"].as_str().and_then(|text| text.parse::<u32>().ok()).expect("a number")
    };
    let before = ticks(&mut editor);
    while ticks(&mut editor) == before {}

    editor.ask("disconnect", json!({}));
    loop {
        let output = editor.event("output");
        if output["output"] == "thread 1 of the controller was killed\n" {
            break;
        }
    }
    assert!(child.wait().expect("it ends").success());
    let output = cc67_with_input(&scratch, ["console", "--yes", "--on", &place], "CheckThread1\n");
    assert_eq!(output.stdout, "0\n", "{output:?}");
}

#[test]
fn a_load_is_compared_with_the_memory_of_the_controller() {
    let scratch = Scratch::new("controller-verify");
    scratch.write("a.c", PROGRAM);
    let spoils = "main() { for (;;) *(int *)0x80070010 += 1; }\n";
    scratch.write("spoils.c", spoils);
    let (_server, place) = served("controller-verify-board", &[]);
    let output = on(&scratch, &["run"], &place, &["--verify", "3:a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "count 0\ncount 1\ncount 2\n"), "{output:?}");
    let endless = on(&scratch, &["debug"], &place, &["--batch", "run.txt", "1:spoils.c"]);
    assert_eq!(endless.code, 2, "there is no such file: {endless:?}");
    scratch.write("run.txt", "run\n");
    let endless = on(&scratch, &["debug"], &place, &["--for", "0.1", "--batch", "run.txt", "1:spoils.c"]);
    assert!(endless.stderr.contains("thread 1 continues on the controller"), "{endless:?}");
    let output = on(&scratch, &["run"], &place, &["--verify", "3:a.c"]);
    assert!(output.code == 2 && output.stderr.contains("is not what was loaded"), "{output:?}");
    assert_eq!(output.stdout, "", "it was not started");
}

/// Moves an axis, and counts as long as it moves.
const MOVES: &str = "\
#include \"KMotionDef.h\"
int phase;
double level;
main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 5000; ch0->Accel = 100000; ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    phase = 1;
    MoveAtVel(0, 500, 4000);
    while (!CheckDone(0)) level += 0.5;
    phase = 2;
}
";

/// The values of a column from the first that is not 0 on, each once as long as it stays.
fn course(table: &str, column: &str) -> Vec<String> {
    let mut lines = table.lines();
    let at = lines.next().expect("a heading").split(',').position(|name| name == column).expect("the column");
    let values = lines.map(|line| line.split(',').nth(at).expect("a value").to_owned());
    let mut course: Vec<_> = values.skip_while(|value| value == "0").collect();
    course.dedup();
    course
}

#[test]
fn the_recorder_of_the_board_traces_every_tick() {
    let scratch = Scratch::new("controller-trace");
    scratch.write("a.c", MOVES);
    let (_server, place) = served("controller-trace-board", &[]);
    let trace = [
        "--trace",
        "board.csv",
        "--trace",
        "board.vcd",
        "--plot",
        "board.svg",
        "--watch",
        "axis0,phase,level",
    ];
    let output = on(&scratch, &["run"], &place, &[&trace[..], &["a.c"]].concat());
    assert_eq!(output.code, 0, "{output:?}");
    let own = cc67(&scratch, ["run", "--trace", "model.csv", "--watch", "axis0,phase,level", "a.c"]);
    assert_eq!(own.code, 0, "{own:?}");
    let table = |name: &str| fs::read_to_string(scratch.path().join(name)).expect("it was written");
    let (board, model) = (table("board.csv"), table("model.csv"));
    // The same board at the other end of the link: the same course, tick by tick.
    assert_eq!(course(&board, "dest0"), course(&model, "dest0"));
    assert_eq!(course(&board, "phase"), ["1", "2"]);
    assert!(course(&board, "level").len() > 1000, "it counts while the axis moves");
    let times: Vec<f64> = board
        .lines()
        .skip(1)
        .map(|line| line.split(',').next().expect("a time").parse().expect("it"))
        .collect();
    assert!(times.windows(2).all(|pair| (pair[1] - pair[0] - 0.00009).abs() < 1e-9), "a tick is missing");
    assert!(table("board.vcd").contains("$enddefinitions") && table("board.svg").contains("</svg>"));
    for (watch, words) in [("bit46", "a controller records"), ("phase + 1", "computes nothing")] {
        let output = on(&scratch, &["run"], &place, &["--trace", "a.csv", "--watch", watch, "a.c"]);
        assert!(output.code == 2 && output.stderr.contains(words), "{output:?}");
    }
    let output = on(&scratch, &["run"], &place, &["--plot", "a.svg", "a.c"]);
    assert!(output.code == 2 && output.stderr.contains("`--watch` names what is recorded"), "{output:?}");
    let own = MOVES.replace("phase = 1;", "SetupGatherAllOnAxis(0, 100); TriggerGather();");
    scratch.write("own.c", own);
    let output = on(&scratch, &["run"], &place, &["--trace", "a.csv", "--watch", "dest0", "own.c"]);
    assert!(output.stderr.contains("a program has used the board's data recorder"), "{output:?}");
}

#[test]
fn programs_on_the_model_and_on_a_controller_are_compared() {
    let scratch = Scratch::new("controller-compare");
    scratch.write("moves.c", MOVES);
    scratch.write("prints.c", PROGRAM);
    scratch.write(
        "keeps.c",
        "#include \"KMotionDef.h\"\nmain() { printf(\"%d\\n\", persist.UserData[90]++); }\n",
    );
    let (_server, place) = served("controller-compare-board", &[]);
    let output = on(&scratch, &["compare"], &place, &["moves.c", "prints.c", "keeps.c"]);
    assert_eq!((output.code, output.stdout.matches(" equal ").count()), (0, 3), "{output:?}");
    // The board was not reset: it has counted already.
    let output = on(&scratch, &["compare"], &place, &["keeps.c", "prints.c"]);
    assert_eq!(output.code, 5, "{output:?}");
    for text in ["keeps.c: line 1", "  board:    ", "1 of 2 programs differ"] {
        assert!(output.stdout.contains(text) || output.stderr.contains(text), "{text}: {output:?}");
    }
    let output = on(&scratch, &["compare"], &place, &["--random"]);
    assert!(output.code == 2 && output.stderr.contains("does not work with `--on`"), "{output:?}");
}

#[test]
fn a_recording_ends_where_the_buffer_is_full() {
    let scratch = Scratch::new("controller-full");
    scratch.write("a.c", "#include \"KMotionDef.h\"\nmain() { Delay_sec(3.2); }\n");
    let (_server, place) = served("controller-full-board", &["--pace", "20"]);
    let all: Vec<_> = (0..26).map(|index| format!("persist.{index}")).collect();
    let trace = ["--trace", "a.csv", "--trace-every", "100", "--watch", &all.join(",")];
    let output = on(&scratch, &["run"], &place, &[&trace[..], &["a.c"]].concat());
    assert!(output.stderr.contains("the recording ends after 2.596 s"), "{output:?}");
    let table = fs::read_to_string(scratch.path().join("a.csv")).expect("it was written");
    assert_eq!(table.lines().nth(1).map(|line| line.starts_with("0.009000,")), Some(true), "{output:?}");
    assert_eq!(table.lines().count(), 288);
}

#[test]
fn flash_holds_what_a_controller_starts_with() {
    let scratch = Scratch::new("controller-flash");
    scratch.write("init.c", "#include \"KMotionDef.h\"\nmain() { persist.UserData[9]++; printf(\"started %d\\n\", persist.UserData[9]); }\n");
    let kept = scratch.path().join("flash.bin");
    let (server, place) = served("controller-flash-board", &["--flash", kept.to_str().expect("text")]);

    let console =
        |typed: &str| cc67_with_input(&scratch, ["console", "--yes", "--for=1", "--on", &place], typed);
    console("Execute7\n");
    let output = on(&scratch, &["flash"], &place, &["2:init.c", "--startup", "2"]);
    assert_eq!(output.code, 2, "{output:?}");
    assert!(output.stderr.contains("active threads (7)") && output.stderr.contains("Kill7"), "{output:?}");

    let output = console("Kill7\nEnableAxis3\nSetPersistDec 9 40\nFlash\n");
    assert!(output.stderr.contains("`cc67 flash --on` saves to it"), "{output:?}");
    let output = on(&scratch, &["flash"], &place, &["2:init.c"]);
    assert!(
        output.stderr.contains("enabled axes (3)") && output.stderr.contains("DisableAxis3"),
        "{output:?}"
    );
    console("DisableAxis3\n");

    let output = cc67(&scratch, ["flash", "--on", &place, "--yes", "2:init.c", "--startup", "2"]);
    assert_eq!(output.code, 0, "{output:?}");
    assert!(output.stderr.contains("thread 2    init.c, loaded now"), "{output:?}");
    assert!(output.stderr.contains("compared it with its memory"), "{output:?}");
    let output = console("Reboot!\n");
    assert_eq!(output.stdout, "started 41\n", "{output:?}");
    drop(server);
    let output = cc67(&scratch, ["run", "--for", "1", "--flash", "flash.bin"]);
    assert_eq!(output.stdout, "started 41\n", "{output:?}");
}

#[test]
fn the_monitor_needs_a_free_thread() {
    let scratch = Scratch::new("controller-monitor");
    scratch.write("a.c", NAMED);
    scratch.write("b.c", "main() {}\n");
    let (_server, place) = served("controller-monitor-board", &[]);
    let loads: Vec<String> = (2..8).flat_map(|thread| ["--load".into(), format!("{thread}:b.c")]).collect();
    let words = ["debug", "--yes", "--on", &place, "1:a.c"].map(str::to_owned);
    let output = cc67_with_input(&scratch, words.into_iter().chain(loads), "p ticks\nset var ticks = 1\n");
    assert!(output.stdout.contains("no thread is free for cc67's monitor"), "{output:?}");
}

#[test]
fn a_box_stays_open_until_it_is_answered() {
    let scratch = Scratch::new("controller-box");
    let message =
        files(&root().join("c-programs/host"), "c").into_iter().find(|path| path.ends_with("message.c"));
    let message = message.expect("it is there").display().to_string();
    let (_server, place) = served("controller-box-board", &[]);
    let output = on(&scratch, &["run"], &place, &["--for", "1", &message]);
    for text in ["Is the tool length sensor in place?: waiting for an answer", "nobody is here to answer"] {
        assert!(output.stderr.contains(text), "{output:?}");
    }
    assert_eq!(output.stdout, "", "{output:?}");
    let answers = ["--answer", "msgbox=no", "--answer", "msgbox=ok", &message];
    let output = on(&scratch, &["run"], &place, &answers);
    assert!(output.code == 0 && output.stdout.contains("measuring is skipped"), "{output:?}");
}

#[test]
fn lines_of_the_console_come_while_the_program_runs() {
    let scratch = Scratch::new("controller-live");
    scratch.write(
        "a.c",
        "#include \"KMotionDef.h\"\nmain() { printf(\"first\\n\"); for (;;) Delay_sec(0.1); }\n",
    );
    let (_server, place) = served("controller-live-board", &[]);
    let mut child = Command::new(command())
        .args(["run", "--yes", "--on", &place, "a.c"])
        .current_dir(scratch.path())
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command starts");
    let mut line = String::new();
    let out = child.stdout.take().expect("it is piped");
    BufReader::new(out).read_line(&mut line).expect("a line comes");
    assert_eq!(line, "first\n");
    child.kill().expect("it runs");
    child.wait().expect("it ends");
}

#[test]
fn tests_run_on_a_controller_and_say_what_was_not_checked() {
    let scratch = Scratch::new("controller-test");
    scratch.write("a.c", PROGRAM);
    scratch.write("a.expected", "count 0\ncount 1\ncount 2\n---- notes\ncc67: a remark of the model\n");
    scratch.write("b.c", format!("// cc67: run --time\n{PROGRAM}"));
    scratch.write("b.expected", "0.001 count 0\n0.002 count 1\n0.003 count 2\n");
    scratch.write("c.c", PROGRAM);
    scratch.write("c.expected", "count 0\n");
    scratch.write("c.stim", "at 0.5s bit 136 = 1\n");
    let (_server, place) = served("controller-test-board", &[]);
    let output = on(&scratch, &["test"], &place, &["."]);
    let expect = "\
not checked on the controller: board times of b
not checked on the controller: remarks of a
skipped  c: c.stim:1:1: only the model of a machine does this: before the action, `manual \"press START\"` asks a person at \
the controller to do it
2 passed, 0 failed, 1 skipped
";
    assert_eq!((output.code, output.stdout.as_str()), (0, expect), "{output:?}");
    scratch.write("a.expected", "count 7\n");
    let output = on(&scratch, &["test"], &place, &["a.c"]);
    assert!(output.code == 1 && output.stdout.contains("- count 7"), "{output:?}");
}

/// Waits for a value from the PC, and for a door that a person closes.
const DOOR: &str = "\
#include \"KMotionDef.h\"
main()
{
    printf(\"ready\\n\");
    while (!persist.UserData[20]) WaitNextTimeSlice();
    printf(\"started %d\\n\", persist.UserData[20]);
    while (!ReadBit(1030)) WaitNextTimeSlice();
    printf(\"door closed\\n\");
}
";

#[test]
fn a_person_at_the_controller_is_asked_for_what_the_model_does() {
    let scratch = Scratch::new("controller-manual");
    scratch.write("door.c", DOOR);
    let stimulus = "\
at 0.3 persist 20 = 7
once printed \"started\" after 100ms manual \"close the door\" set bit 1030
expect printed \"door closed\"
expect bit 1030 = 1
never printed \"fault\"
";
    scratch.write("door.stim", stimulus);
    scratch.write("door.expected", "ready\nstarted 7\ndoor closed\n");
    let model = cc67(&scratch, ["test", "."]);
    assert_eq!((model.code, model.stdout.as_str()), (0, "1 passed, 0 failed\n"), "{model:?}");

    // The served board's own stimulus is the person.
    let person = ["--stim", "once printed \"started\" after 600ms set bit 1030"];
    let (_server, place) = served("controller-manual-board", &person);
    let output = on(&scratch, &["test"], &place, &["."]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "1 passed, 0 failed\n"), "{output:?}");
    let asked =
        "cc67: door: by hand: close the door\ncc67: door: not checked on the controller: door.stim:5:1\n";
    assert_eq!(output.stderr, asked);

    scratch.write("late.c", PROGRAM);
    scratch.write("late.stim", "expect printed \"count 3\"; expect persist 5 = 3\n");
    let output = on(&scratch, &["run"], &place, &["--stim", "late.stim", "late.c"]);
    let unmet = "no line contains \"count 3\", expected one";
    assert!(output.code == 5 && output.stderr.contains(unmet), "{output:?}");
    assert_eq!(output.stderr.matches("late.stim").count(), 1, "{output:?}");
}

#[cfg(unix)]
#[test]
fn a_port_without_access_rights_is_named_with_what_gives_them() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    use std::os::unix::process::CommandExt;

    let scratch = Scratch::new("controller-rights");
    scratch.write("a.c", PROGRAM);
    let (_server, place) = served("controller-rights-board", &[]);
    let path = place.strip_prefix("serial:").expect("a pseudo-terminal");
    fs::set_permissions(path, fs::Permissions::from_mode(0o000)).expect("it is ours");
    let mut run = Command::new(command());
    run.args(["run", "--yes", "--on", &place, "a.c"]).current_dir(scratch.path());
    if fs::metadata(path).expect("it is there").uid() == 0 {
        // The administrator may open every file.
        fs::set_permissions(scratch.path(), fs::Permissions::from_mode(0o777)).expect("it is ours");
        run.uid(65534).gid(65534);
    }
    let Ok(output) = run.output() else {
        println!("not tried: this user's commands cannot be executed by another one");
        return;
    };
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains(path) && stderr.contains("dialout"), "{stderr}");
}

#[test]
fn two_clients_of_the_vendors_server_share_a_board() {
    let scratch = Scratch::new("controller-shared");
    scratch.write("a.c", PROGRAM);
    let server = Server::start("controller-shared-board", &["serve", "--listen", "tcp:0"], PROGRAM, 1);
    let place = format!("server:127.0.0.1:{}", server.places[0].rsplit(':').next().expect("a port"));
    let outputs = thread::scope(|scope| {
        let runs =
            ["1:a.c", "2:a.c"].map(|program| scope.spawn(|| on(&scratch, &["run"], &place, &[program])));
        runs.map(|run| run.join().expect("no run panics"))
    });
    // The server hands each console line to one of its clients.
    let lines: usize = outputs.iter().map(|output| output.stdout.lines().count()).sum();
    assert_eq!((outputs.each_ref().map(|output| output.code), lines), ([0, 0], 6), "{outputs:?}");
}

#[test]
fn boards_lists_what_is_connected_or_says_where_it_looked() {
    let scratch = Scratch::new("controller-boards");
    let output = cc67(&scratch, ["boards", "--quiet", "--json"]);
    match output.code {
        0 => assert!(output.stdout.lines().all(|line| line.contains("\"address\"")), "{output:?}"),
        code => assert!(code == 1 && output.stderr.contains("no controller found: looked for"), "{output:?}"),
    }
}

#[test]
fn a_board_that_goes_away_ends_the_run_with_one_message() {
    let scratch = Scratch::new("controller-lost");
    scratch.write("endless.c", ENDLESS);
    let arguments = ["serve", "--listen", "tcp-raw:0", "--for", "1", "--load", "7:a.c"];
    let server = Server::start("controller-lost-board", &arguments, ENDLESS, 1);
    let place = server.places[0].clone();
    let output = on(&scratch, &["run"], &place, &["endless.c"]);
    assert_eq!(output.code, 2, "{output:?}");
    let lines: Vec<_> = output.stderr.lines().skip(1).collect();
    assert!(lines.len() == 1 && lines[0].contains("disconnected"), "{output:?}");
}
