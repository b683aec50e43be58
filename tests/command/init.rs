//! `cc67 init`: the project that it makes works with the command, an editor and CI.

use std::fs;

use harness::{Scratch, cc67};

fn project(name: &str) -> Scratch {
    let scratch = Scratch::new(&format!("init-{name}"));
    let output = cc67(&scratch, ["init", "machine"]);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{output:?}");
    scratch
}

#[test]
fn the_first_program_passes_its_test_without_a_warning() {
    let scratch = project("passes");
    assert_eq!(cc67(&scratch, ["test", "machine"]).stdout, "1 passed, 0 failed\n");
    assert_eq!(cc67(&scratch, ["check", "machine/first.c"]).render(), "---- exit 0\n");
    assert_eq!(
        cc67(&scratch, ["check", "-I", "machine/include", "machine/first.c"]).render(),
        "---- exit 0\n"
    );
}

#[test]
fn the_tasks_for_the_editor_find_what_is_reported() {
    let scratch = project("tasks");
    let text = fs::read_to_string(scratch.path().join("machine/.vscode/tasks.json")).expect("it was written");
    let tasks: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
    let check = &tasks["tasks"][0];
    let arguments: Vec<_> =
        check["args"].as_array().expect("arguments").iter().filter_map(|a| a.as_str()).collect();
    assert_eq!(arguments, ["check", "--message-format", "short", "${relativeFile}"]);
    // The pattern of the problem matcher, spelled out: file, line, column, severity, message.
    fs::write(scratch.path().join("wrong.c"), "main() { x = 1; }\n").expect("files can be written");
    let output = cc67(&scratch, ["check", "--message-format", "short", "wrong.c"]);
    assert_eq!(output.stderr, "wrong.c:1:10: error: `x` is not declared\n");
    // Of several files each message has its own, and no line is anything else.
    let program = "#include \"KMotionDef.h\"\n#include \"sub/part.c\"\nmain()\n{\n    int x = 5\n    if (x = 3) Delaysec(1);\n}\n";
    fs::create_dir(scratch.path().join("sub")).expect("folders can be made");
    fs::write(scratch.path().join("sub/part.c"), "int f(void) { return y; }\n")
        .expect("files can be written");
    fs::write(scratch.path().join("more.c"), program).expect("files can be written");
    let output = cc67(&scratch, ["check", "--message-format", "short", "more.c"]);
    let places: Vec<_> = output.stderr.lines().map(|line| line.splitn(5, ':').collect::<Vec<_>>()).collect();
    assert!(places.len() >= 4, "{}", output.stderr);
    for place in places {
        let [file, line, column, severity, message] = place[..] else { panic!("{place:?}") };
        assert!(["more.c", "sub/part.c"].contains(&file), "{place:?}");
        assert!(line.parse::<u32>().is_ok() && column.parse::<u32>().is_ok(), "{place:?}");
        assert!([" error", " warning", " note"].contains(&severity) && !message.is_empty(), "{place:?}");
    }
    assert_eq!(
        check["problemMatcher"]["pattern"]["regexp"],
        r"^(.+?):(\d+):(\d+): (error|warning|note): (.*)$"
    );
}

#[test]
fn nothing_that_is_there_is_overwritten() {
    let scratch = Scratch::new("init-there");
    fs::write(scratch.path().join("first.c"), "mine").expect("files can be written");
    let output = cc67(&scratch, ["init", "."]);
    assert_eq!(
        output.render(),
        "---- stderr\ncc67: ./first.c is there already; nothing was written\n---- exit 2\n"
    );
    let left = fs::read_dir(scratch.path()).expect("the folder is readable").count();
    assert_eq!(left, 1);
}

#[test]
fn the_header_of_a_project_is_c_for_other_compilers_too() {
    let scratch = project("clang");
    let folder = scratch.path().join("machine");
    let flags = fs::read_to_string(folder.join("compile_flags.txt")).expect("it was written");
    for compiler in ["clang", "gcc"] {
        let mut command = std::process::Command::new(compiler);
        command.args(flags.lines()).args(["-fsyntax-only", "first.c"]).current_dir(&folder);
        // Not every machine has both; where there is one it must be content.
        let Ok(output) = command.output() else { continue };
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{compiler}");
        assert!(output.status.success(), "{compiler}");
    }
}
