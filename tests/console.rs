//! `cc67 console` as scripts meet it, and lines that nobody would type.

use harness::{Output, Scratch, run_with_input};
use kmotiondef::Ticks;
use proptest::prelude::*;
use proptest::test_runner::{Config as Cases, TestRunner};
use runtime::commands::{Argument, COMMANDS};
use runtime::{Board, Config, EventKind};

/// Runs a script in a folder with these files.
fn console(name: &str, files: &[(&str, &str)], arguments: &[&str], script: &str) -> Output {
    let scratch = Scratch::new(name);
    for (file, text) in files {
        scratch.write(file, text);
    }
    let mut all = vec!["console"];
    all.extend_from_slice(arguments);
    run_with_input(env!("CARGO_BIN_EXE_cc67-under-test"), scratch.path(), all, script)
}

fn check(name: &str, files: &[(&str, &str)], arguments: &[&str], script: &str, expect: &str) {
    let output = console(name, files, arguments, script);
    assert_eq!(output.render(), expect, "{script}");
}

const HELLO: (&str, &str) = (
    "hello.c",
    "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"hello %d\\n\", persist.UserData[5]++);\n}\n",
);

#[test]
fn a_script_loads_programs_and_talks_to_the_board() {
    let script = "Version\n# a comment\n\nSetPersistDec 5 7\nload 2:hello.c\nExecute2\nExecute 2;CheckThread2\n\
                  wait 0.01\nGetPersistDec 5\nCheckThread2;bogus;Version\n";
    let expect = "KFLOP 4.34 Build 16:07:06 Aug 14 2018\nhello 7\n1\nhello 8\n9\n0\nBOGUS\n^\nerror, invalid command\n---- exit 0\n";
    check("console-load", &[HELLO], &[], script, expect);
}

#[test]
fn programs_on_the_command_line_run_to_their_end_behind_the_script() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  Delay_sec(3);\n  printf(\"done\\n\");\n}\n";
    let expect = "1\ndone\n---- exit 0\n";
    check("console-end", &[("slow.c", source)], &["slow.c"], "CheckThread1\n", expect);
}

#[test]
fn a_download_written_as_commands_runs() {
    let scratch = Scratch::new("console-download");
    scratch.write(HELLO.0, HELLO.1);
    let binary = env!("CARGO_BIN_EXE_cc67-under-test");
    let arguments = ["build", "hello.c", "--thread", "3", "--download-script", "-o", "hello.kfs"];
    let output = run_with_input(binary, scratch.path(), arguments, "");
    assert_eq!(output.code, 0, "{output:?}");
    let script = std::fs::read_dir(scratch.path())
        .expect("the folder is there")
        .filter_map(|entry| std::fs::read_to_string(entry.expect("an entry").path()).ok())
        .find(|text| text.starts_with("Kill"))
        .expect("the download is written");
    let script = format!("{script}Execute3\nwait 0.01\nExecute3\n");
    let output = run_with_input(binary, scratch.path(), ["console"], &script);
    assert_eq!(output.render(), "hello 0\nhello 1\n---- exit 0\n");
}

#[test]
fn a_download_that_is_no_program_is_not_started() {
    let script =
        "LoadData 80050000 4\n1 2 3 4\nEntryPoint1 80050000\nExecute1\nwait 0.01\nCheckThread1\nVersion\n";
    let output = console("console-junk", &[], &[], script);
    assert_eq!(output.stdout, "0\nKFLOP 4.34 Build 16:07:06 Aug 14 2018\n");
    assert!(output.stderr.contains("thread 1 is not started"), "{}", output.stderr);
}

#[test]
fn mistakes_in_own_words_and_sources_do_not_end_the_session() {
    let script = "wait x\nload nosuch.c\nrun bad.c\nkill all but 9\nEcho on\n";
    let output = console("console-mistakes", &[("bad.c", "main() { retrun 1; }\n")], &[], script);
    assert_eq!((output.code, output.stdout.as_str()), (0, "ON\n"), "{output:?}");
    for message in ["`x` is not a number of seconds", "cannot read nosuch.c", "error", "`9` is no thread"] {
        assert!(output.stderr.contains(message), "{message}: {}", output.stderr);
    }
}

#[test]
fn threads_are_stopped_all_but_one() {
    let endless = "#include \"KMotionDef.h\"\nmain()\n{\n  for (;;) WaitNextTimeSlice();\n}\n";
    let script = "CheckThread1;CheckThread2;CheckThread3\nkill all but 2\nCheckThread1;CheckThread2;CheckThread3\nkill all\nCheckThread2\n";
    let expect = "1\n1\n1\n0\n1\n0\n0\n---- exit 0\n";
    check("console-kill", &[("a.c", endless)], &["a.c", "a.c", "a.c"], script, expect);
}

#[test]
fn a_trap_is_the_exit_code() {
    let trap = "main()\n{\n  *(int *)0 = 1;\n}\n";
    assert_eq!(console("console-trap", &[("a.c", trap)], &["a.c"], "Version\n").code, 3);
}

/// Numbers as people and line noise write them; no large ones, whose replies would take long.
fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        (-10..3000_i32).prop_map(|number| number.to_string()),
        (0..10_000_u32).prop_map(|number| format!("{number:X}")),
        any::<f64>().prop_map(|number| format!("{number:e}")),
        "[-+.eE0-9xX]{0,6}",
        Just("80050000".to_owned()),
    ]
}

/// A line: noise, or a command with what may follow it.
fn line() -> impl Strategy<Value = Vec<u8>> {
    let separator = prop_oneof![Just(" "), Just("="), Just(" = "), Just(""), Just(","), Just(";")];
    let arguments = prop::collection::vec((separator, number()), 0..24);
    let command = (0..COMMANDS.len(), arguments).prop_map(|(index, arguments)| {
        let arguments = arguments.into_iter().map(|(separator, number)| format!("{separator}{number}"));
        format!("{}{}", COMMANDS[index].name, arguments.collect::<String>()).into_bytes()
    });
    let fitting = (0..COMMANDS.len(), prop::collection::vec(0..100_i32, 24)).prop_map(|(index, numbers)| {
        let mut text = COMMANDS[index].name.to_owned();
        for (argument, number) in COMMANDS[index].arguments.iter().zip(numbers) {
            text += &match argument {
                Argument::Integer(lo, hi) => {
                    format!(" {}", (*lo).max(0) + number % (hi.min(&300) - (*lo).max(0) + 1))
                }
                Argument::Equals | Argument::OptionalEquals | Argument::Assign => "=".to_owned(),
                _ => format!(" {number}"),
            };
        }
        text.into_bytes()
    });
    prop_oneof![
        2 => command,
        3 => fitting,
        1 => prop::collection::vec(any::<u8>(), 0..300),
    ]
}

/// Sends bytes and returns the last line of a reply within some ticks.
fn answer(board: &mut Board, bytes: &[u8]) -> Option<Vec<u8>> {
    board.receive(bytes);
    let mut last = None;
    let mut ticks = 0;
    while board.is_receiving() && ticks < 10_000 {
        let limit = Ticks::new(board.tick().get() + 2);
        board.run_until(limit, &mut |event| {
            if let EventKind::Reply(line) = event.kind {
                last = Some(line);
            }
            false
        });
        ticks += 2;
    }
    last
}

#[test]
fn ten_thousand_random_lines_leave_a_board_that_answers() {
    let cases = Cases { cases: 100, ..Cases::default() };
    let result = TestRunner::new(cases).run(&prop::collection::vec(line(), 100), |lines| {
        let mut board = Board::new(Config::default());
        for line in lines {
            // What stops the released firmware stops this one too: such a board is switched off and on.
            let mut stopped = false;
            board.receive(&[b"\x1b\x01", &line[..], b"\r"].concat());
            let limit = Ticks::new(board.tick().get() + 40);
            board.run_until(limit, &mut |event| {
                stopped |=
                    matches!(&event.kind, EventKind::Diagnostic(text) if text.contains("firmware stops"));
                false
            });
            if stopped {
                board = Board::new(Config::default());
            }
            // A command may wait for data lines, and replies may go to the UART: both are left first.
            answer(&mut board, b"\x03\x1b\x01USB\r");
            let version = answer(&mut board, b"\x1b\x01Version\r");
            prop_assert_eq!(version.as_deref(), Some(&b"KFLOP 4.34 Build 16:07:06 Aug 14 2018"[..]));
        }
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
}
