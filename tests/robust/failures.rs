//! External failures: full disks, folders that cannot be written, readers that close early, names that are not UTF-8,
//! and a command that is killed.
//!
//! There is one message, the correct exit code, and never an incomplete file under its final name.

#![cfg(unix)]

use std::ffi::OsStr;
use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use harness::{Output, Scratch, cc67, is_long, run_in};

/// Prints a few thousand lines and moves an axis, so that there are data to lose.
const PROGRAM: &str = r#"#include "KMotionDef.h"
main()
{
    int i;

    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    EnableAxisDest(0, 0);
    MoveRel(0, 1000);
    for (i = 0; i < 3000; i++)
        printf("line %d\n", i);
    while (!CheckDone(0))
        ;
    DisableAxis(0);
}
"#;

/// Writes to the users' half of flash memory.
const FLASHING: &str = r#"#include "KMotionDef.h"
double table[2] = { 1.5, -2.5 };
main()
{
    SetFlashBank(FLASH_USER);
    ProgramFlash((char *)table, 8, FLASH_USER, "written\n");
}
"#;

fn with_program(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write("a.c", PROGRAM).write("flash.c", FLASHING);
    scratch
}

/// Runs the command through a shell that changes the environment first; `"$@"` in `script` is the command.
fn run_shell(folder: &Path, script: &str, arguments: &[&str]) -> Output {
    let all = ["-c", script, "sh", harness::command()].into_iter().chain(arguments.iter().copied());
    run_in("sh", folder, all)
}

/// Asserts that there is one readable message.
#[track_caller]
fn assert_one_message(output: &Output, code: i32, expect: &str) {
    assert_eq!(output.code, code, "{output:?}");
    assert!(output.stderr.contains(expect), "expected {expect:?} in:\n{}", output.stderr);
    assert_eq!(output.stderr.lines().count(), 1, "{}", output.stderr);
    for trace in ["panicked", "os error", ".rs:"] {
        assert!(!output.stderr.contains(trace), "{}", output.stderr);
    }
}

#[test]
fn a_full_disk_gives_one_message_and_keeps_the_old_file() {
    // A limit on the size of files that does not kill the process makes the disk appear full after the first kilobyte.
    const FULL: &str = "trap '' XFSZ; ulimit -f 1; exec \"$@\"";
    let scratch = with_program("full-disk");
    for (arguments, file) in [
        (&["build", "-o", "out.out", "a.c"][..], "out.out"),
        (&["run", "--trace", "out.vcd", "a.c"], "out.vcd"),
        (&["run", "--trace", "out.json", "a.c"], "out.json"),
        (&["run", "--plot", "out.svg", "a.c"], "out.svg"),
        (&["firmware", "export", "out.fw"], "out.fw"),
    ] {
        scratch.write(file, "old");
        let output = run_shell(scratch.path(), FULL, arguments);
        assert_one_message(&output, 2, &format!("cannot write {file}: "));
        assert_eq!(fs::read(scratch.path().join(file)).expect("it is still there"), b"old", "{file}");
    }
    let mut names: Vec<_> = fs::read_dir(scratch.path())
        .expect("the folder is readable")
        .map(|entry| entry.expect("it is readable").file_name())
        .collect();
    names.sort();
    assert_eq!(
        names,
        ["a.c", "flash.c", "out.fw", "out.json", "out.out", "out.svg", "out.vcd"],
        "nothing is left over"
    );
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_standard_output_gives_one_message() {
    let scratch = with_program("full-output");
    for arguments in [
        &["run", "a.c"][..],
        &["build", "a.c"],
        &["firmware", "list"],
        &["completions", "bash"],
        &["--explain", "machine"],
    ] {
        let output = run_shell(scratch.path(), "exec \"$@\" >/dev/full", arguments);
        assert_one_message(&output, 2, "cannot write to standard output: ");
    }
    // No message can be written; the exit code is still correct.
    let output = run_shell(scratch.path(), "exec \"$@\" 2>/dev/full", &["check", "nosuch.c"]);
    assert_eq!(output.code, 2, "{output:?}");
}

#[test]
fn an_unwritable_folder_gives_one_message() {
    let scratch = with_program("read-only");
    // No user can create files in /dev/null, not even root, whom permissions do not stop.
    for arguments in [
        &["build", "-o", "/dev/null/a.out", "a.c"][..],
        &["run", "--trace", "/dev/null/a.vcd", "a.c"],
        &["run", "--plot", "/dev/null/a.svg", "a.c"],
        &["run", "--uart-output", "/dev/null/a.txt", "a.c"],
    ] {
        let output = run_shell(scratch.path(), "exec \"$@\" >/dev/null", arguments);
        assert_one_message(&output, 2, "cannot write /dev/null/a.");
    }
}

#[test]
fn a_reader_that_goes_away_is_not_an_error() {
    let scratch = with_program("head");
    for arguments in [&["run", "a.c"][..], &["firmware", "list"], &["completions", "bash"]] {
        let mut child = Command::new(harness::command())
            .args(arguments)
            .current_dir(scratch.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command under test starts");
        let mut line = String::new();
        let mut reader = BufReader::new(child.stdout.take().expect("it is piped"));
        reader.read_line(&mut line).expect("it prints something");
        drop(reader);
        let output = child.wait_with_output().expect("it ends");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && errors.is_empty(), "{arguments:?}: {} {errors}", output.status);
    }
}

#[test]
#[cfg(target_os = "linux")] // Elsewhere such names cannot exist.
fn file_names_that_are_not_utf_8_are_accepted() {
    let scratch = Scratch::new("no-text");
    let name = |bytes| OsStr::from_bytes(bytes);
    let (source, image) = (name(b"caf\xe9.c"), name(b"caf\xe9.out"));
    fs::write(scratch.path().join(source), "main() { }\n").expect("the folder is writable");
    for arguments in [
        vec![OsStr::new("check"), source],
        vec![OsStr::new("run"), source],
        vec![OsStr::new("build"), OsStr::new("-o"), image, source],
        vec![OsStr::new("run"), image],
        vec![OsStr::new("inspect"), image],
    ] {
        let output = cc67(&scratch, &arguments);
        assert_eq!(output.code, 0, "{arguments:?}: {output:?}");
        assert!(output.stderr.is_empty(), "{arguments:?}: {output:?}");
    }
    let output = cc67(&scratch, [OsStr::new("check"), name(b"nosuch\xe9.c")]);
    assert_one_message(&output, 2, "cannot read nosuch\u{fffd}.c: ");
}

#[cfg(target_os = "linux")]
#[test]
fn limits_of_the_system_are_messages() {
    let scratch = with_program("host-limits");
    scratch.write("b.c", "#include \"KMotionDef.h\"\nmain() { printf(\"here\\n\"); }\n");
    // The stack of the process may be small: the command uses its own.
    let output = run_shell(scratch.path(), "ulimit -s 128; exec \"$@\"", &["run", "b.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "here\n"), "{output:?}");
    // Memory for the compiler's stack may not be available.
    let output = run_shell(scratch.path(), "ulimit -v 500000; exec \"$@\"", &["run", "b.c"]);
    assert_eq!(output.code, 1, "{output:?}");
    assert!(output.stderr.contains("the system starts no thread with a stack of 512 MiB"), "{output:?}");
    assert!(!output.stderr.contains("panicked"), "{output:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_system_without_descriptors_threads_or_a_terminal_is_a_message() {
    let scratch = with_program("host-few");
    scratch.write("b.c", "#include \"KMotionDef.h\"\nmain() { printf(\"here\\n\"); }\n");
    let cases: &[(&str, &[&str])] = &[
        ("ulimit -n 4; exec \"$@\"", &["run", "b.c"]),
        ("ulimit -n 4; exec \"$@\"", &["build", "b.c"]),
        ("ulimit -n 4; exec \"$@\"", &["serve", "--listen", "tcp:0", "--for", "0", "b.c"]),
        ("ulimit -n 4; exec \"$@\"", &["live", "--no-browser", "--for", "0", "b.c"]),
        ("ulimit -v 400000; exec \"$@\"", &["serve", "--listen", "tcp:0", "--for", "0", "b.c"]),
        ("ulimit -v 400000; exec \"$@\"", &["live", "--for", "0", "b.c"]),
        ("ulimit -v 400000; exec \"$@\"", &["test", "b.c"]),
        ("ulimit -v 400000; exec \"$@\"", &["debug", "b.c"]),
        ("ulimit -s 64; exec \"$@\"", &["check", "b.c"]),
        ("exec \"$@\" <&-", &["console"]),
        ("exec \"$@\" <&-", &["debug", "b.c"]),
        ("exec \"$@\" <&- >&-", &["run", "b.c"]),
        ("unset TERM; exec \"$@\"", &["console"]),
        ("TERM=nosuch exec \"$@\"", &["debug", "b.c"]),
    ];
    for (script, arguments) in cases {
        let output = run_shell(scratch.path(), script, arguments);
        let is_known = (0..=2).contains(&output.code);
        assert!(is_known, "{script} {arguments:?}: {output:?}");
        let is_told = output.code == 0 || !output.stderr.is_empty() || !output.stdout.is_empty();
        assert!(is_told, "{script} {arguments:?}: {output:?}");
        for trace in ["panicked", "RUST_BACKTRACE", ".rs:"] {
            assert!(!output.stderr.contains(trace), "{script} {arguments:?}: {}", output.stderr);
        }
    }
}

/// Starts the command, kills it after `delay` and reaps it.
fn kill_after(folder: &Path, arguments: &[&str], delay: Duration) {
    let mut child = Command::new(harness::command())
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command under test starts");
    thread::sleep(delay);
    // An error means that it has already ended.
    let _ = child.kill();
    child.wait().expect("it ends");
}

/// The number of kills of each command: a dozen, or a hundred in long runs.
fn kills() -> u32 {
    if is_long() { 100 } else { 12 }
}

/// Kills a command at times distributed over its run, in random order and a little beyond its end, and checks the files
/// after each.
#[expect(clippy::disallowed_methods, reason = "the process is killed at moments of the host's time")]
fn kill_at_moments(
    scratch: &Scratch,
    arguments: &[&str],
    mut before: impl FnMut(),
    mut after: impl FnMut(u32),
) {
    let started = Instant::now();
    let output = cc67(scratch, arguments);
    let duration = started.elapsed();
    assert_eq!(output.code, 0, "{output:?}");
    let mut random = 12_345_u32;
    for round in 0..kills() {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        before();
        // The first one is killed at once.
        let part = if round == 0 { 0 } else { random >> 16 };
        kill_after(scratch.path(), arguments, duration * part / 52_000);
        after(round);
    }
    // The next run with the same output removes files left by killed runs.
    let output = cc67(scratch, arguments);
    assert_eq!(output.code, 0, "{output:?}");
    let names = fs::read_dir(scratch.path()).expect("it is there");
    let left: Vec<_> = names
        .map(|entry| entry.expect("an entry").file_name())
        .filter(|name| name.to_string_lossy().ends_with(".tmp"))
        .collect();
    assert!(left.is_empty(), "left behind: {left:?}");
}

/// Kills the command that writes `file` at many times.
///
/// At any time, the file has its previous contents or those that the complete run writes.
fn assert_whole(name: &str, arguments: &[&str], file: &str, before: &[u8]) {
    let scratch = with_program(name);
    let path = scratch.path().join(file);
    assert_eq!(cc67(&scratch, arguments).code, 0);
    let whole = fs::read(&path).expect("the run writes it");
    let (mut old, mut new) = (0, 0);
    let renew = || {
        fs::remove_file(&path).expect("it is there, whole or not yet replaced");
        fs::write(&path, before).expect("the folder is writable");
    };
    kill_at_moments(&scratch, arguments, renew, |round| {
        let found = fs::read(&path).expect("there is always a file");
        if found == whole {
            new += 1;
        } else {
            assert!(found == before, "round {round}: {} bytes of {}", found.len(), whole.len());
            old += 1;
        }
    });
    println!("{name}: {old} old, {new} new");
    assert!(old > 0, "no kill came before the end");
}

#[test]
fn a_build_that_is_killed_leaves_the_old_image_or_the_new() {
    assert_whole("kill-build", &["build", "-o", "a.out", "a.c"], "a.out", b"old");
}

#[test]
fn a_run_killed_while_saving_flash_leaves_the_old_file_or_the_new_one() {
    let erased = vec![0xFF; 2 << 20];
    assert_whole("kill-flash", &["run", "--flash", "board.flash", "flash.c"], "board.flash", &erased);
}

#[test]
fn a_trace_that_is_killed_leaves_the_old_file_or_the_new() {
    assert_whole("kill-vcd", &["run", "--trace", "a.vcd", "a.c"], "a.vcd", b"old");
    assert_whole("kill-json", &["run", "--trace", "a.json", "a.c"], "a.json", b"old");
}

#[test]
fn pictures_tables_and_maps_that_are_killed_are_the_old_or_the_new() {
    let outputs: &[(&str, &[&str], &str)] = &[
        ("kill-csv", &["run", "--trace", "a.csv", "a.c"], "a.csv"),
        ("kill-bits", &["run", "--trace-bits", "bits.csv", "a.c"], "bits.csv"),
        (
            "kill-packets",
            &["run", "--engine", "dsp", "--trace-packets", "packets.txt", "flash.c"],
            "packets.txt",
        ),
        ("kill-svg", &["run", "--plot", "a.svg", "a.c"], "a.svg"),
        ("kill-html", &["run", "--plot", "a.html", "a.c"], "a.html"),
        ("kill-profile", &["run", "--profile=profile.svg", "a.c"], "profile.svg"),
        ("kill-export", &["firmware", "export", "names.fw"], "names.fw"),
        ("kill-map", &["build", "--map", "-o", "a.out", "a.c"], "a.map"),
        ("kill-asm", &["build", "--asm", "-o", "a.out", "a.c"], "a.asm"),
        ("kill-download", &["build", "--emit", "download", "a.c"], "a(1).kmd"),
        ("kill-object", &["build", "-c", "a.c"], "a.o"),
    ];
    for (name, arguments, file) in outputs {
        assert_whole(name, arguments, file, b"old");
    }
}

/// The values that a console has acknowledged as saved, and those that it was given.
struct Flashing {
    acknowledged: usize,
    /// The number that is saved first; each further number is one higher.
    first: usize,
}

/// Starts a console that saves one number after another, and kills it after `delay`.
fn kill_flashing_console(scratch: &Scratch, first: usize, delay: Duration) -> Flashing {
    use std::io::{Read, Write};

    let mut child = Command::new(harness::command())
        .args(["console", "--flash", "board.flash"])
        .current_dir(scratch.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command under test starts");
    let commands: String =
        (0..SAVES).map(|index| format!("SetPersistDec 7 {}\nFlash\n", first + index)).collect();
    let mut input = child.stdin.take().expect("it is piped");
    let mut output = child.stdout.take().expect("it is piped");
    let reader = thread::spawn(move || {
        let mut text = String::new();
        output.read_to_string(&mut text).expect("it is text");
        text
    });
    // A console that is killed early reads nothing.
    let _ = input.write_all(commands.as_bytes());
    thread::sleep(delay);
    // An error means that it has already ended.
    let _ = child.kill();
    child.wait().expect("it ends");
    let text = reader.join().expect("it does not panic");
    Flashing {
        acknowledged: text.lines().filter(|line| *line == "Program Flash Image Complete").count(),
        first,
    }
}

/// The number of values that each console saves.
const SAVES: usize = 20;

#[test]
fn flash_that_was_acknowledged_survives_a_kill_at_any_moment() {
    let scratch = Scratch::new("kill-console-flash");
    let (mut least, mut acknowledged) = (0, 0);
    let mut random = 54_321_u32;
    for round in 1..=kills() as usize {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let delay = Duration::from_micros(u64::from(random >> 16) * 8);
        let saved = kill_flashing_console(&scratch, 1000 * round, delay);
        acknowledged += saved.acknowledged;
        if saved.acknowledged > 0 {
            least = saved.first + saved.acknowledged - 1;
        }
        let output =
            harness::cc67_with_input(&scratch, ["console", "--flash", "board.flash"], "GetPersistDec 7\n");
        assert_eq!(output.code, 0, "round {round}: {output:?}");
        let found: usize = output.stdout.trim().parse().expect("a number");
        assert!(
            least <= found && found < saved.first + SAVES,
            "round {round}: {found}, acknowledged {least}"
        );
    }
    println!("{} kills, {acknowledged} acknowledged", kills());
    assert!(acknowledged > 0, "every kill came too early");
}

#[test]
fn golden_output_that_is_killed_is_the_old_or_the_new() {
    assert_whole("kill-golden", &["test", "--bless", "--force", "a.c"], "a.expected", b"old\n");
}

/// Writes lines to a file of the PC, and prints a confirmation after each.
const LINES: &str = r#"#include "KMotionDef.h"
main()
{
    int i;
    FILE *f = fopen("log.txt", "wt");

    for (i = 0; i < 300; i++)
        fprintf(f, "line %d\n", i);
    fclose(f);
}
"#;

#[test]
fn files_of_programs_that_are_killed_hold_whole_lines_in_order() {
    let scratch = Scratch::new("kill-files");
    scratch.write("a.c", LINES);
    let arguments = ["run", "--files", "disk", "a.c"];
    let path = scratch.path().join("disk/log.txt");
    assert_eq!(cc67(&scratch, arguments).code, 0);
    let whole = fs::read_to_string(&path).expect("the run writes it");
    assert_eq!(whole.lines().count(), 300);
    let renew = || fs::write(&path, "").expect("the folder is writable");
    kill_at_moments(&scratch, &arguments, renew, |round| {
        let found = fs::read_to_string(&path).expect("there is always a file");
        let is_whole_line = found.is_empty() || found.ends_with('\n');
        assert!(whole.starts_with(&found) && is_whole_line, "round {round}: {} bytes", found.len());
    });
}
