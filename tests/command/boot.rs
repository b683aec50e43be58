//! `--boot`: the user's own firmware file in place of the modelled firmware.
//!
//! Where `CC67_FIRMWARE` names a file, programs run on it; where not, this is said.

use std::env;
use std::path::PathBuf;

use harness::{Output, Scratch, cc67, cc67_with_input};

const HELLO: &str =
    "#include \"KMotionDef.h\"\nmain()\n{\n  persist.UserData[3] = 7;\n  printf(\"hello\\n\");\n}\n";

/// The firmware file, if there is one.
fn firmware() -> Option<String> {
    let Some(path) = env::var_os("CC67_FIRMWARE") else {
        println!("not run: CC67_FIRMWARE names no firmware file");
        return None;
    };
    Some(PathBuf::from(path).to_str().expect("a name of text").to_owned())
}

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write("hello.c", HELLO);
    scratch
}

/// One message, and the exit code of wrong input.
fn assert_refused(output: &Output, expect: &str) {
    assert_eq!(output.code, 2, "{output:?}");
    assert!(output.stderr.contains(expect), "expected {expect:?} in:\n{}", output.stderr);
    assert_eq!(output.stderr.lines().count(), 1, "{}", output.stderr);
}

#[test]
fn what_is_no_firmware_file_is_refused_with_one_message() {
    let scratch = scratch("boot-none");
    let run = |file: &str| cc67(&scratch, ["run", "--boot", file, "hello.c"]);
    assert_refused(&run("nosuch.out"), "nosuch.out");
    assert_refused(&run("hello.c"), "not a firmware file");
    assert_eq!(cc67(&scratch, ["build", "--target", "c67x", "hello.c", "-o", "hello.out"]).code, 0);
    assert_refused(&run("hello.out"), "a user program runs on a firmware");
    let console = cc67_with_input(&scratch, ["console", "--boot", "hello.out"], "Version\n");
    assert_refused(&console, "not a firmware file");
}

#[test]
fn options_that_a_booted_board_does_not_know_are_named() {
    let scratch = scratch("boot-options");
    let refused = |option: &[&str], name: &str| {
        let all = [&["run", "--boot", "x.out", "hello.c"], option].concat();
        assert_refused(&cc67(&scratch, all), &format!("`{name}` does not work with `--boot` yet"));
    };
    refused(&["--assist"], "--assist");
    refused(&["--uart", "pty"], "--uart");
    refused(&["--profile"], "--profile");
    refused(&["--plot", "a.svg"], "--plot");
    for (option, name) in [(&["--flash", "x"][..], "--flash"), (&["--live"], "--live")] {
        let serve = [&["serve", "--boot", "x.out", "hello.c"], option].concat();
        assert_refused(&cc67(&scratch, serve), &format!("`{name}` does not work with `--boot` yet"));
    }
    let test = cc67(&scratch, ["compare", "hello.c"]);
    assert_refused(&test, "needs `--boot FILE`");
}

#[test]
fn a_program_prints_on_the_real_firmware_and_as_on_the_model() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-hello");
    let run = cc67(&scratch, ["run", "--boot", &file, "hello.c"]);
    assert_eq!(run, Output { code: 0, stdout: "hello\n".into(), stderr: String::new() });
    let compare = cc67(&scratch, ["compare", "--boot", &file, "hello.c"]);
    assert_eq!(compare.code, 0, "{compare:?}");
    assert!(compare.stdout.contains("equal"), "{compare:?}");
}

#[test]
fn script_commands_are_answered_by_the_real_firmware() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-console");
    let script =
        "CheckThread1\nSetPersistDec 5 7\nGetPersistDec 5\nFoo\nrun hello.c\nwait 0.01\nGetPersistDec 3\n";
    let output = cc67_with_input(&scratch, ["console", "--boot", &file], script);
    assert_eq!(output.code, 0, "{output:?}");
    assert_eq!(output.stdout, "0\n7\nFOO\n^\nerror, invalid command\nhello\n7\n", "{output:?}");
}

#[test]
fn a_program_that_takes_the_firmware_away_is_told_with_registers_and_code() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-crash");
    scratch.write("wild.c", "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"before\\n\");\n  Delay_sec(0.01);\n  *(int *)0x70000000 = 1;\n}\n");
    let output = cc67(&scratch, ["run", "--boot", &file, "wild.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (3, "before\n"), "{output:?}");
    for part in ["write of the unmapped address 0x70000000", "thread 1", "A0=", "B15=", "STW"] {
        assert!(output.stderr.contains(part), "{part} in {}", output.stderr);
    }
}
