//! Files beside a program: its machine file, its stimulus, the options of its first line, the project file.

use std::fs;

use harness::{Scratch, cc67};

/// Prints whether the switch of the machine file is closed, and an element that options set.
const PROGRAM: &str = "// cc67: run --set persist.5=7 --stim \"persist 6 = 8\" also 2:other.c
#include \"KMotionDef.h\"
main()
{
    Delay_sec(0.01);
    printf(\"%d %d %d\\n\", ReadBit(136), persist.UserData[5], persist.UserData[6]);
}
";
const OTHER: &str = "#include \"KMotionDef.h\"\nmain() { printf(\"other\\n\"); }";
const MACHINE: &str = "[inputs]\nidle_high = [136]\nhints = false\n";

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let folder = scratch.path().join("sub");
    fs::create_dir_all(&folder).expect("a folder");
    for (name, text) in [("prog.c", PROGRAM), ("other.c", OTHER), ("prog.toml", MACHINE)] {
        fs::write(folder.join(name), text).expect("a file");
    }
    scratch
}

#[test]
fn a_run_uses_the_files_next_to_the_program_and_says_so() {
    let scratch = scratch("beside");
    let said = "cc67: running sub/prog.c with sub/prog.toml; its first line: --set persist.5=7 --stim \"persist 6 = 8\" also 2:other.c (--no-sidecar ignores it)\n";
    for (options, stdout, stderr) in [
        (&[][..], "other\n1 7 8\n", said),
        (&["--set", "persist.5=9"], "other\n1 9 8\n", said),
        (&["--no-sidecar", "--machine", "sub/prog.toml"], "1 0 0\n", ""),
    ] {
        let output = cc67(&scratch, [&["run", "sub/prog.c"], options].concat());
        assert_eq!((output.stdout.as_str(), output.code), (stdout, 0), "{}", output.stderr);
        assert_eq!(output.stderr, stderr);
    }
}

#[test]
fn a_debugger_uses_the_files_next_to_the_program_too() {
    let scratch = scratch("beside-debug");
    scratch.write("commands", "continue\n");
    for (option, stdout) in
        [(None, "Continuing.\nother\n1 7 8\n"), (Some("--no-sidecar"), "Continuing.\n0 0 0\n")]
    {
        let output = cc67(&scratch, ["debug", "sub/prog.c", "--batch", "commands"].into_iter().chain(option));
        assert_eq!(output.code, 0, "{}", output.stderr);
        assert!(output.stdout.starts_with(stdout), "{}", output.stdout);
        assert_eq!(output.stderr.contains("running sub/prog.c with sub/prog.toml"), option.is_none());
    }
}

#[test]
fn a_project_file_has_defaults_for_its_programs() {
    let scratch = scratch("project");
    let folder = scratch.path().join("sub");
    fs::write(
        folder.join("init.c"),
        "#include \"KMotionDef.h\"\nmain() { Delay_sec(1); printf(\"init\\n\"); }",
    )
    .expect("a file");
    fs::write(folder.join("plain.c"), OTHER).expect("a file");
    fs::write(
        scratch.path().join("cc67.toml"),
        "first = \"sub/init.c\"\n[run]\ntime = true\n[test]\njobs = 1\n",
    )
    .expect("a file");
    let output = cc67(&scratch, ["run", "sub/plain.c"]);
    let shown: Vec<_> =
        output.stdout.lines().filter_map(|line| line.split_once(' ')).map(|(_, text)| text).collect();
    assert_eq!((shown, output.code), (vec!["init", "other"], 0), "{}{}", output.stdout, output.stderr);
    assert!(output.stderr.contains("cc67.toml"), "{}", output.stderr);
    let output = cc67(&scratch, ["test", "--bless", "sub/plain.c"]);
    assert_eq!(output.code, 0, "{}{}", output.stdout, output.stderr);
    assert_eq!(fs::read_to_string(folder.join("plain.expected")).expect("a golden"), "init\nother\n");

    fs::write(scratch.path().join("cc67.toml"), "[run]\nfro = 5\n").expect("a file");
    let output = cc67(&scratch, ["run", "sub/plain.c"]);
    assert_eq!(output.code, 2, "{}", output.stderr);
    assert!(output.stderr.contains("cc67.toml") && output.stderr.contains("--fro"), "{}", output.stderr);
}

#[test]
fn first_programs_run_to_their_end_before_the_others_start() {
    let scratch = Scratch::new("first");
    for (name, text) in [("a", "Delay_sec(0.2)"), ("b", "Delay_sec(0.1)"), ("c", ""), ("d", "")] {
        let text = format!("#include \"KMotionDef.h\"\nmain() {{ {text}; printf(\"{name}\\n\"); }}");
        fs::write(scratch.path().join(format!("{name}.c")), text).expect("a file");
    }
    let output = cc67(&scratch, ["run", "--first", "a.c", "--first", "b.c", "c.c", "d.c"]);
    assert_eq!((output.stdout.as_str(), output.stderr.as_str(), output.code), ("a\nb\nc\nd\n", "", 0));
}

#[test]
fn a_first_program_that_never_ends_is_named() {
    let scratch = Scratch::new("first-endless");
    scratch.write(
        "a.c",
        "#include \"KMotionDef.h\"\nmain() { EnableRS232Cmds(RS232_BAUD_9600); RS232_GetChar(); }\n",
    );
    scratch.write("b.c", "main() {}\n");
    let output = cc67(&scratch, ["run", "--for", "0.1", "--first", "a.c", "b.c"]);
    for part in [
        "never happened: a.c:1:1: once thread 2 ends, which still runs: thread 1 was not started",
        "for RS232_GetChar, which waits while no character has been received",
    ] {
        assert!(output.stderr.contains(part), "{part}: {}", output.stderr);
    }
}

#[test]
fn commands_that_compile_find_the_included_files_of_a_project() {
    let scratch = Scratch::new("project-include");
    fs::create_dir_all(scratch.path().join("inc")).expect("a folder");
    scratch.write("cc67.toml", "include = [\"inc\"]\nprograms = [\"1:a.c\", \"2:b.c\"]\n");
    scratch.write("inc/shared.h", "#define READY persist.UserData[20]\n");
    scratch.write("a.c", "#include \"KMotionDef.h\"\n#include \"shared.h\"\nmain() { READY = 1; }\n");
    scratch.write(
        "b.c",
        "#include \"KMotionDef.h\"\n#include \"shared.h\"\nmain() { while (!READY) WaitNextTimeSlice(); printf(\"ready\\n\"); }\n",
    );
    for words in [&["check"][..], &["check", "a.c"], &["build", "a.c"], &["cycles", "a.c"]] {
        let output = cc67(&scratch, words);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{words:?}");
    }
    let output = cc67(&scratch, ["run"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "ready\n"), "{}", output.stderr);
}

#[test]
fn a_file_that_a_checked_program_includes_is_not_checked_as_one() {
    let scratch = Scratch::new("check-part");
    scratch.write("part.c", "void Ready(void) { persist.UserData[20] = 1; }\n");
    scratch.write("a.c", "#include \"KMotionDef.h\"\n#include \"part.c\"\nmain() { Ready(); }\n");
    let output = cc67(&scratch, ["check", "a.c", "part.c"]);
    assert_eq!(
        (output.code, output.stderr.as_str()),
        (0, "cc67: part.c is a part of a.c, which is checked\n")
    );
    let output = cc67(&scratch, ["check", "part.c"]);
    assert_eq!(output.code, 1);
    assert!(output.stderr.contains("it is included by a.c"), "{}", output.stderr);
}

#[test]
fn first_programs_that_are_shorter_than_a_tick_may_start_late() {
    let scratch = Scratch::new("first-late");
    scratch.write("init.c", "#include \"KMotionDef.h\"\nmain() { persist.UserData[5] = 7; }\n");
    scratch.write("a.c", "#include \"KMotionDef.h\"\nmain() { printf(\"%d\\n\", persist.UserData[5]); }\n");
    for schedule in [&[][..], &["--schedule", "start7+1"], &["--schedule", "start7+20"]] {
        let output = cc67(&scratch, [&["run", "--first", "7:init.c", "a.c"], schedule].concat());
        assert_eq!(
            (output.code, output.stdout.as_str(), output.stderr.as_str()),
            (0, "7\n", ""),
            "{schedule:?}"
        );
    }
}
