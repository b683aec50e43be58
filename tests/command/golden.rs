//! `cc67 test`: what passes, what does not, and what a person, a tool and CI are told.

use std::fs;

use harness::{Output, Scratch, cc67};

const COUNT: &str = "#include \"KMotionDef.h\"\nmain()\n{\n    int i;\n    for (i = 1; i <= 3; i++)\n        printf(\"%d\\n\", i);\n}\n";

/// A folder with these files.
fn folder(name: &str, files: &[(&str, &str)]) -> Scratch {
    let scratch = Scratch::new(&format!("test-{name}"));
    for (file, text) in files {
        let path = scratch.path().join(file);
        fs::create_dir_all(path.parent().expect("it lies in a folder")).expect("folders can be made");
        fs::write(path, text).expect("files can be written");
    }
    scratch
}

fn test(scratch: &Scratch, arguments: &[&str]) -> Output {
    cc67(scratch, ["test"].iter().chain(arguments))
}

/// The command prints exactly this and ends with this code.
fn check(files: &[(&str, &str)], arguments: &[&str], code: i32, stdout: &str, name: &str) {
    let output = test(&folder(name, files), arguments);
    assert_eq!((output.stdout.as_str(), output.code), (stdout, code), "{}", output.stderr);
}

#[test]
fn a_program_with_the_expected_output_passes() {
    let files = [("a.c", COUNT), ("a.expected", "1\n2\n3\n"), ("part.c", "int unused;\n")];
    check(&files, &["."], 0, "1 passed, 0 failed\n", "passes");
}

#[test]
fn a_failure_shows_the_lines_that_differ() {
    let files =
        [("sub/a.c", COUNT), ("sub/a.expected", "1\n2\n4\n"), ("b.c", COUNT), ("b.expected", "1\n2\n3\n")];
    let expect = "\
FAILED   sub/a: - expected, + shown now
  line 1
    1
    2
  - 4
  + 3
1 passed, 1 failed
";
    check(&files, &["."], 1, expect, "differs");
}

#[test]
fn traps_and_exit_codes_are_part_of_the_expected_output() {
    let program =
        "#include \"KMotionDef.h\"\nmain()\n{\n    int *p = 0;\n    printf(\"before\\n\");\n    *p = 1;\n}\n";
    let scratch = folder("trap", &[("a.c", program)]);
    let asked = test(&scratch, &["--bless", "a.c"]);
    assert!(
        asked.code == 1 && asked.stdout.starts_with("REFUSED  a: ") && asked.stdout.contains("---- exit 3"),
        "{asked:?}"
    );
    assert!(!scratch.path().join("a.expected").exists());
    assert_eq!(
        test(&scratch, &["--bless", "--force", "a.c"]).stdout,
        "written  a.expected\n0 passed, 0 failed, 1 written\n"
    );
    let golden = fs::read_to_string(scratch.path().join("a.expected")).expect("it was written");
    let lines: Vec<_> = golden.lines().collect();
    assert_eq!((lines[0], lines[1]), ("before", "---- notes"), "{golden}");
    assert!(lines[2].contains("a.c:6"), "{golden}");
    assert_eq!(lines.last(), Some(&"---- exit 3"), "{golden}");
    assert_eq!(test(&scratch, &["a.c"]).stdout, "1 passed, 0 failed\n");
}

#[test]
fn blessing_writes_only_what_changed() {
    let files = [("a.c", COUNT), ("a.expected", "old\n"), ("b.c", COUNT), ("b.expected", "1\n2\n3\n")];
    let scratch = folder("bless", &files);
    assert_eq!(
        test(&scratch, &["--bless", "."]).stdout,
        harness::native("written  ./a.expected\n1 passed, 0 failed, 1 written\n")
    );
    assert_eq!(fs::read_to_string(scratch.path().join("a.expected")).expect("it is there"), "1\n2\n3\n");
}

#[test]
fn the_first_line_says_how_a_program_is_run() {
    let wait =
        "// cc67: run --for 0.001\n#include \"KMotionDef.h\"\nmain() { for (;;) WaitNextTimeSlice(); }\n";
    let ending = "---- notes\ncc67: at the end, after 0.001 s of board time:\n";
    check(&[("a.c", wait), ("a.expected", ending)], &["a.c"], 0, "1 passed, 0 failed\n", "head");
    let main = "// cc67: run also 2:b.c\n#include \"KMotionDef.h\"\nmain() { persist.UserData[5] = 7; }\n";
    let other = "// cc67: part of a.c\n#include \"KMotionDef.h\"\nmain() { while (persist.UserData[5] != 7) ; printf(\"seven\\n\"); }\n";
    let files = [("a.c", main), ("a.expected", "seven\n"), ("b.c", other)];
    check(&files, &["."], 0, "1 passed, 0 failed\n", "also");
}

#[test]
fn missing_tests_and_expectations_are_reported() {
    let output = test(&folder("none", &[("a.c", COUNT)]), &["."]);
    assert_eq!(output.code, 2);
    assert_eq!(
        output.stderr,
        "cc67: no tests there: a test is a program NAME.c with NAME.expected beside it, which `cc67 test --bless NAME.c` writes\n"
    );
    let expect =
        "FAILED   a: there is no a.expected; `cc67 test --bless a.c` writes it\n0 passed, 1 failed\n";
    check(&[("a.c", COUNT)], &["a.c"], 1, expect, "unknown");
    let head = "// cc67: ran\nmain() {}\n";
    let output = test(&folder("head-wrong", &[("a.c", head)]), &["a.c"]);
    assert_eq!(
        (output.code, output.stderr.as_str()),
        (
            2,
            "cc67: a.c, line 1: `ran` does not say how a test is run; write `run` with options, or `part of FILE`\n"
        )
    );
}

#[test]
fn expected_outputs_without_a_program_are_named() {
    let files =
        [("door.c", COUNT), ("doors.expected", "1\n"), ("sub/b.c", COUNT), ("sub/b.expected", "1\n2\n3\n")];
    let output = test(&folder("orphans", &files), &["."]);
    assert_eq!((output.stdout.as_str(), output.code), ("1 passed, 0 failed\n", 0), "{}", output.stderr);
    let expect = harness::native(
        "cc67: ./doors.expected belongs to no program: there is no doors.c beside it; did you mean door.expected?\n",
    );
    assert_eq!(output.stderr, expect);
}

#[test]
fn a_first_line_that_is_not_the_first_is_reported() {
    let program = format!("// home.c - homes\n// cc67: run --for 2\n{COUNT}");
    let files = [("home.c", program.as_str()), ("blank.c", "//cc67: run\nmain() {}\n")];
    let scratch = folder("head-below", &files);
    let below = "cc67: home.c:2: `// cc67: …` counts in the first line only: move it there\n";
    let blank = "cc67: blank.c:1: a first line that says how a program is run begins with `// cc67: `\n";
    let output = test(&scratch, &["."]);
    assert!(output.stderr.contains(below) && output.stderr.contains(blank), "{}", output.stderr);
    for command in ["run", "check"] {
        let output = cc67(&scratch, [command, "home.c"]);
        assert_eq!((output.code, output.stderr.as_str()), (0, below), "{command}");
    }
    // A line that only tells of it is none, and what is in the first line counts.
    let text = "// cc67: run\n// cc67: run is what the first line begins with\nmain() {}\n";
    let other = "// The first line may be `cc67: run`.\n// as in // cc67: run\nmain() {}\n";
    let scratch =
        folder("head-told", &[("a.c", text), ("b.c", other), ("b.expected", ""), ("a.expected", "")]);
    let output = test(&scratch, &["."]);
    assert_eq!((output.stdout.as_str(), output.stderr.as_str()), ("2 passed, 0 failed\n", ""));
}

#[test]
fn every_program_of_a_folder_is_checked() {
    let files = [
        ("a.c", "#include \"KMotionDef.h\"\n#include \"axes.c\"\nmain() { if (ch0->Enable = 0) Use(1); }\n"),
        ("axes.c", "void Use(int axis) { DisableAxis(axis); } // domain(), main\n"),
        ("sub/b.c", "// cc67: part of a.c\n#include \"KMotionDef.h\"\nvoid main (void) { Jogg(0, 5.0); }\n"),
        ("empty/notes.txt", "main()\n"),
    ];
    let scratch = folder("check-folder", &files);
    let output = cc67(&scratch, ["check", ".", "--message-format", "short"]);
    let lines: Vec<_> = output.stderr.lines().filter_map(|line| line.split(": ").next()).collect();
    assert_eq!(
        (output.code, lines),
        (1, vec!["a.c:3:14", &harness::native("sub/b.c:3:20")]),
        "{}",
        output.stderr
    );
    let output = cc67(&scratch, ["check", "empty"]);
    let none = "cc67: no programs in empty: a program is a .c file with a function `main`\n";
    assert_eq!((output.code, output.stderr.as_str()), (2, none));
    let examples = cc67(harness::root(), ["check", "c-programs"]);
    assert_eq!((examples.code, examples.stderr.as_str()), (0, ""));
}

#[test]
fn a_program_that_does_not_compile_fails_with_its_messages() {
    let output = test(&folder("errors", &[("a.c", "main() { x = 1; }\n"), ("a.expected", "")]), &["a.c"]);
    assert_eq!(output.code, 1);
    assert!(output.stdout.contains("`x` is not declared"), "{}", output.stdout);
    assert!(output.stdout.contains("  + ---- exit 1\n0 passed, 1 failed\n"), "{}", output.stdout);
}

#[test]
fn tools_read_json_and_junit() {
    let files =
        [("good.c", COUNT), ("good.expected", "1\n2\n3\n"), ("bad.c", COUNT), ("bad.expected", "<\n")];
    let scratch = folder("reports", &files);
    let output = test(&scratch, &["--json", "--engine", "bytecode", "--junit", "report.xml", "."]);
    let report: serde_json::Value = serde_json::from_str(&output.stdout).expect("it is JSON");
    assert_eq!((&report["passed"], &report["failed"]), (&1.into(), &1.into()));
    assert_eq!(report["tests"][0]["name"], "bad");
    assert_eq!(report["tests"][0]["shown"], "1\n2\n3\n");
    let junit = fs::read_to_string(scratch.path().join("report.xml")).expect("it was written");
    // How long a test took differs.
    let parts = junit.split(" time=\"").enumerate();
    let untimed = parts.map(|(index, part)| match index {
        0 => part.to_owned(),
        _ => part.split_once('"').map_or(part, |(_, rest)| rest).to_owned(),
    });
    let junit: String = untimed.collect();
    insta::assert_snapshot!(junit, @r#"
    <?xml version="1.0" encoding="UTF-8"?>
    <testsuite name="cc67" tests="2" failures="1">
      <testcase classname="cc67" name="bad">
        <failure message="differs">- expected, + shown
      line 1
      - &lt;
      + 1
      + 2
      + 3
    </failure>
      </testcase>
      <testcase classname="cc67" name="good"/>
    </testsuite>
    "#);
}
