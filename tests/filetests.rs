//! Runs every program of `filetests/` and holds it to the directives it states.
//!
//! A directive is a line `//@ name: value`:
//!
//! | directive | meaning |
//! |---|---|
//! | `args: …` | arguments before the file's name (`check` instead of `run` as the first word is possible) |
//! | `prints: …` | the next line of stdout; together these lines are all of stdout |
//! | `exit: n` | exit code, 0 if not stated |
//! | `says: …` | stderr contains this |
//! | `snapshot` | stderr as a whole is the snapshot of the file's name |
//!
//! Without `says` or `snapshot`, stderr must be empty.

use std::fs;
use std::path::Path;

use harness::{Output, files, run_in};

/// What a file demands.
#[derive(Default)]
struct Expectation {
    arguments: Vec<String>,
    stdout: String,
    exit: i32,
    says: Vec<String>,
    snapshot: bool,
}

fn expectation(path: &Path) -> Expectation {
    let text = String::from_utf8_lossy(&fs::read(path).expect("the file is readable")).into_owned();
    let mut expectation = Expectation::default();
    for line in text.lines() {
        let Some(directive) = line.trim_start().strip_prefix("//@ ") else { continue };
        let (name, value) = directive.split_once(':').unwrap_or((directive, ""));
        let value = value.strip_prefix(' ').unwrap_or(value);
        match name.trim() {
            "args" => expectation.arguments = value.split_whitespace().map(str::to_owned).collect(),
            "prints" => expectation.stdout.push_str(&format!("{value}\n")),
            "exit" => expectation.exit = value.trim().parse().expect("`exit` takes a number"),
            "says" => expectation.says.push(value.to_owned()),
            "snapshot" => expectation.snapshot = true,
            other => panic!("{}: no directive `{other}`", path.display()),
        }
    }
    expectation
}

/// Runs one file in its folder, so that messages name it without a path.
fn run(path: &Path, expectation: &Expectation) -> Output {
    let mut arguments = expectation.arguments.clone();
    if !matches!(arguments.first().map(String::as_str), Some("run" | "check")) {
        arguments.insert(0, "run".to_owned());
    }
    arguments.push(path.file_name().expect("a file has a name").to_string_lossy().into_owned());
    run_in(env!("CARGO_BIN_EXE_cc67-under-test"), path.parent().expect("a file has a folder"), arguments)
}

/// What is wrong with a run; `None` if nothing is.
fn complaint(path: &Path) -> Option<String> {
    let expectation = expectation(path);
    let output = run(path, &expectation);
    let complain = |what: &str| Some(format!("{}: {what}\n{}", path.display(), output.render()));
    if output.stdout != expectation.stdout {
        return complain(&format!("expected to print\n{}", expectation.stdout));
    }
    if output.code != expectation.exit {
        return complain(&format!("expected exit code {}", expectation.exit));
    }
    if let Some(missing) = expectation.says.iter().find(|text| !output.stderr.contains(*text)) {
        return complain(&format!("expected to say {missing:?}"));
    }
    if expectation.says.is_empty() && !expectation.snapshot && !output.stderr.is_empty() {
        return complain("expected to say nothing");
    }
    if expectation.snapshot {
        let name = path.file_stem().expect("a file has a name").to_string_lossy().into_owned();
        insta::assert_snapshot!(name, output.stderr);
    }
    None
}

fn check_folder(folder: &str) {
    let files = files(&harness::root().join("tests/filetests").join(folder), "c");
    assert!(!files.is_empty(), "no tests in {folder}");
    let complaints: Vec<_> = files.iter().filter_map(|file| complaint(file)).collect();
    assert!(
        complaints.is_empty(),
        "{} of {} files fail\n\n{}",
        complaints.len(),
        files.len(),
        complaints.join("\n")
    );
}

#[test]
fn the_language_means_what_it_says() {
    check_folder("language");
}

#[test]
fn mistakes_get_messages() {
    check_folder("diagnostics");
}

#[test]
fn the_board_answers() {
    check_folder("board");
}
