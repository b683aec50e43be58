//! What the book promises about programs and images from strangers.

use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use cc67::pp::Disk;
use cc67::{Options, image};
use harness::{Scratch, files, run_in};
use kmotiondef::{ThreadId, Ticks};
use runtime::loader::LoadError;
use runtime::{Board, Config, Event};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;

const BINARY: &str = env!("CARGO_BIN_EXE_cc67-under-test");

/// The board time that a changed program gets.
const LIMIT: Ticks = Ticks::new(100);

/// How many changed images are tried; with `CC67_LONG=1` in the environment a hundred times as many.
const ROUNDS: usize = 300;

#[test]
fn every_promise_has_its_test() {
    let chapter = fs::read_to_string(harness::root().join("cc67/book/src/security.md")).expect("it is there");
    let mut tests = BTreeSet::new();
    for file in files(&harness::root().join("tests"), "rs") {
        let name = file.file_name().expect("a name").to_string_lossy().into_owned();
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
        let output = run_in(BINARY, scratch.path(), ["run", "a.c"]);
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
    assert_eq!(run_in(BINARY, scratch.path(), ["build", "a.c"]).code, 0);
    // Everywhere in four gigabytes; what lies at the mapped ones is the board's.
    for page in 0..64_u32 {
        let setting = format!("persist.0={:#x}", (page << 26) | 0x3F_FFF8);
        for engine in ["bytecode", "native"] {
            let arguments = ["run", "--engine", engine, "--set", &setting, "a(1).out"];
            let output = run_in(BINARY, scratch.path(), arguments);
            let is_trap = output.code == 3 && output.stderr.contains("a.c:");
            assert!(is_trap || output.stdout == "ok\n", "{setting}: {output:?}");
        }
    }
}

/// Loops, calls, memory, floating point and printing: something of everything to break.
const VICTIM: &str = r#"#include "KMotionDef.h"
int table[16];
double sum;
int mix(int a, int b) { return a * 31 + (b ^ table[a & 15]); }
main()
{
    int i, n = 1;

    for (i = 0; i < 40; i++)
    {
        n = mix(n, i);
        table[i & 15] = n;
        sum += n * 0.5;
        switch (n & 3)
        {
            case 0: n++; break;
            case 1: n ^= 5; break;
            default: n -= i;
        }
    }
    printf("%d %g\n", n, sum);
}
"#;

/// Executes an image; what was seen, and what memory holds then.
fn execute<E: Engine>(image: &[u8]) -> Result<(Vec<Event>, Board<E>), LoadError> {
    let mut board = Board::<E>::new(Config::default());
    let thread = ThreadId::new(1).expect("1 is a thread");
    board.load(thread, image)?;
    board.start(thread).expect("it was loaded");
    let mut events = Vec::new();
    board.run(LIMIT, &mut |event| events.push(event));
    Ok((events, board))
}

#[test]
fn a_changed_image_is_refused_or_runs_alike_on_every_engine() {
    let options = Options::default();
    let mut compilation = cc67::compile("a.c".as_ref(), VICTIM.into(), &options, &Disk);
    let linked = compilation.link(ThreadId::new(1).expect("1 is a thread"), &options).expect("it links");
    let whole = image::write(&linked).expect("it fits");
    let mut state = 0x5EED_u64;
    let mut below = |limit: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % limit
    };
    let rounds = if std::env::var_os("CC67_LONG").is_some() { 100 * ROUNDS } else { ROUNDS };
    let (mut refused, mut executed) = (0, 0);
    for round in 0..rounds {
        let mut bytes = whole.clone();
        for _ in 0..=below(3) {
            let at = below(bytes.len());
            bytes[at] ^= 1 << below(8);
        }
        let Ok((events, board)) = execute::<BytecodeEngine>(&bytes) else {
            refused += 1;
            continue;
        };
        executed += 1;
        #[cfg(feature = "native")]
        {
            let native = execute::<vm::native::NativeEngine>(&bytes).expect("both engines take it");
            assert_eq!(native.0, events, "round {round}: the engines differ");
            assert!(native.1.memory() == board.memory(), "round {round}: the engines leave different memory");
        }
        #[cfg(not(feature = "native"))]
        let _ = (round, board, events);
    }
    println!("{rounds} changed images: {refused} refused, {executed} executed");
    assert!(refused > 0 && executed > 0);
}

#[test]
#[cfg(unix)]
fn the_serial_port_listens_on_this_computer_only() {
    let scratch = Scratch::new("security-loopback");
    scratch.write("a.c", "main() { }\n");
    let mut child = Command::new(BINARY)
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
