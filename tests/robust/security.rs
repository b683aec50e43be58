//! The book's promises about programs and images from untrusted sources.

use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use harness::choices::{Choices, random_bytes};
use harness::oracles::{execute_everywhere, victim};
use harness::{Scratch, cc67, files, is_long};
use kmotiondef::Ticks;

/// The board time for a changed program.
const LIMIT: Ticks = Ticks::new(100);

/// The number of changed images that are tried; with `CC67_LONG=1` in the environment a hundred times as many.
const ROUNDS: u64 = 300;

#[test]
fn every_promise_has_its_test() {
    let chapter = fs::read_to_string(harness::root().join("cc67/book/src/security.md")).expect("it is there");
    let mut tests = BTreeSet::new();
    for file in files(&harness::root().join("tests"), "rs") {
        let path = file.strip_prefix(harness::root().join("tests")).expect("it is below that folder");
        let name = path.to_string_lossy().replace('\\', "/");
        for line in fs::read_to_string(&file).expect("it is readable").lines() {
            if let Some(test) = line.strip_prefix("fn ").and_then(|rest| rest.split('(').next()) {
                tests.insert(format!("{name}: {test}"));
            }
        }
    }
    let promises: Vec<_> =
        chapter.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| promise")).collect();
    assert!(promises.len() >= 8, "{chapter}");
    for promise in promises {
        let test = promise.split('`').rev().nth(1).unwrap_or_default();
        assert!(tests.contains(test), "no test of this name: {promise}");
    }
}

#[test]
fn a_program_cannot_ask_for_the_environment_other_programs_or_the_network() {
    let scratch = Scratch::new("security-names");
    for name in
        ["getenv", "system", "popen", "exec", "execve", "fork", "socket", "remove", "rename", "unlink"]
    {
        scratch.write("a.c", format!("main()\n{{\n    return {name}(\"PATH\");\n}}\n"));
        let output = cc67(&scratch, ["run", "a.c"]);
        assert_eq!(output.code, 1, "{name}: {output:?}");
        assert!(output.stderr.contains(name), "{name}: {output:?}");
    }
}

/// Reads a byte and writes a word at the address in element 0.
const PROBE: &str = r#"#include "KMotionDef.h"
main()
{
    int address = persist.UserData[0];

    persist.UserData[1] = *(char *)address;
    *(int *)(address & ~3) = persist.UserData[2];
    printf("ok\n");
}
"#;

#[test]
fn addresses_outside_guest_memory_trap() {
    let scratch = Scratch::new("security-addresses");
    scratch.write("a.c", PROBE);
    assert_eq!(cc67(&scratch, ["build", "--target", "sim", "a.c"]).code, 0);
    // All over four gigabytes; mapped addresses belong to the board.
    for page in 0..64_u32 {
        let setting = format!("persist.0={:#x}", (page << 26) | 0x3F_FFF8);
        for engine in ["bytecode", "native"] {
            let arguments = ["run", "--engine", engine, "--set", &setting, "a(1).out"];
            let output = cc67(&scratch, arguments);
            let is_trap = output.code == 3 && output.stderr.contains("a.c:");
            assert!(is_trap || output.stdout == "ok\n", "{setting}: {output:?}");
        }
    }
}

#[test]
fn a_changed_image_is_refused_or_runs_alike_on_every_engine() {
    let whole = victim();
    let rounds = if is_long() { 100 * ROUNDS } else { ROUNDS };
    let (mut refused, mut executed) = (0, 0);
    for round in 0..rounds {
        let random = random_bytes(round, 16);
        let mut choices = Choices::new(&random);
        let mut bytes = whole.clone();
        for _ in 0..=choices.below(3) {
            let at = choices.below(bytes.len());
            bytes[at] ^= 1 << choices.below(8);
        }
        match execute_everywhere(&bytes, LIMIT) {
            Ok(_) => executed += 1,
            Err(_) => refused += 1,
        }
    }
    println!("{rounds} changed images: {refused} refused, {executed} executed");
    assert!(refused > 0 && executed > 0);
}

#[test]
#[cfg(unix)]
fn the_serial_port_listens_on_this_computer_only() {
    let scratch = Scratch::new("security-loopback");
    scratch.write("a.c", "main() { }\n");
    let mut child = Command::new(harness::command())
        .args(["run", "--uart", "tcp:0", "a.c"])
        .current_dir(scratch.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command under test starts");
    let mut line = String::new();
    let errors = child.stderr.take().expect("it is piped");
    BufReader::new(errors).read_line(&mut line).expect("it says where it waits");
    child.kill().expect("it waits for a client");
    child.wait().expect("it ends");
    assert!(line.contains("waiting for a client on 127.0.0.1:"), "{line}");
}
