//! `cc67 init`: the project that it makes works with the command, an editor and CI.

use std::fs;

use harness::{Scratch, cc67, cc67_with_input, root};

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
fn the_editor_tasks_recognise_the_reported_problems() {
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
fn the_debugger_accepts_the_editors_launch_configuration() {
    let scratch = project("launch");
    let folder = scratch.path().join("machine");
    let text = fs::read_to_string(folder.join(".vscode/launch.json")).expect("it was written");
    let launch: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
    let configurations = launch["configurations"].as_array().expect("a list");
    assert_eq!(configurations.len(), 2);
    let program = folder.join("first.c");
    let mut input = String::new();
    let last = configurations.last().expect("there are two").to_string();
    // What the editor puts in place of its variable is a text within JSON.
    let program = serde_json::Value::from(program.to_str().expect("a name in UTF-8")).to_string();
    let arguments = last.replace("${file}", program.trim_matches('"'));
    for request in [
        r#"{"type":"request","seq":1,"command":"initialize","arguments":{"adapterID":"cc67"}}"#.to_owned(),
        format!(r#"{{"type":"request","seq":2,"command":"launch","arguments":{arguments}}}"#),
        r#"{"type":"request","seq":3,"command":"configurationDone"}"#.to_owned(),
        r#"{"type":"request","seq":4,"command":"evaluate","arguments":{"expression":"ch0->Vel"}}"#.to_owned(),
    ] {
        input.push_str(&format!("Content-Length: {}\r\n\r\n{request}", request.len()));
    }
    let output = cc67_with_input(&scratch, ["debug", "--dap"], &input);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{}", output.stdout);
    assert!(
        output.stdout.contains(r#""command":"launch","request_seq":2,"seq":2,"success":true"#),
        "{}",
        output.stdout
    );
    let extensions = fs::read_to_string(folder.join(".vscode/extensions.json")).expect("it was written");
    let extensions: serde_json::Value = serde_json::from_str(&extensions).expect("it is JSON");
    let package = fs::read_to_string(root().join("cc67/editors/vscode/package.json")).expect("it is there");
    let package: serde_json::Value = serde_json::from_str(&package).expect("it is JSON");
    let id = format!(
        "{}.{}",
        package["publisher"].as_str().expect("a text"),
        package["name"].as_str().expect("a text")
    );
    assert_eq!(extensions["recommendations"][0], id);
    assert_eq!(package["contributes"]["debuggers"][0]["type"], configurations[0]["type"]);
}

#[test]
fn existing_files_are_not_overwritten() {
    let scratch = Scratch::new("init-there");
    fs::write(scratch.path().join("first.c"), "mine").expect("files can be written");
    let output = cc67(&scratch, ["init", "."]);
    assert_eq!(
        output.render(),
        harness::native("---- stderr\ncc67: ./first.c already exists; nothing was written\n---- exit 2\n")
    );
    let left = fs::read_dir(scratch.path()).expect("the folder is readable").count();
    assert_eq!(left, 1);
}

#[test]
fn the_header_of_a_project_compiles_with_other_compilers_too() {
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
