//! Building, linking and running images, as users do it.

use std::fs;

use harness::{Scratch, cc67, vendor};
use kmotiondef::boards::TargetBoard;

/// Runs the command, which must succeed, and returns its output.
#[track_caller]
fn succeed(scratch: &Scratch, arguments: &[&str]) -> String {
    let output = cc67(scratch, arguments);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{arguments:?}: {output:?}");
    output.stdout
}

const HELLO: &str = "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"hello\\n\");\n}\n";

/// Three sources and one that becomes an object; each has its own `count`.
fn four_files(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch
        .write(
            "main.c",
            "#include \"KMotionDef.h\"\nint up(int n), down(int n), half(int n);\nstatic int count = 100;\nint shared;\n\
             main()\n{\n  count++;\n  shared = 3;\n  printf(\"%d %d %d %d %d\\n\", count, up(1), down(1), half(1), shared);\n}\n",
        )
        .write("up.c", "static int count = 10;\nextern int shared;\nint up(int n)\n{\n  shared++;\n  return count += n;\n}\n")
        .write("down.c", "static int count;\nint shared;\nint down(int n)\n{\n  shared *= 2;\n  return count -= n;\n}\n")
        .write(
            "half.c",
            "static double count = 5;\nstatic int calls;\nstatic double table[2] = { 0.5, 2 };\ndouble *first = &table[0];\n\
             static int add(int a, int b) { return a + b; }\nstatic int (*adder)(int, int) = add;\n\
             int half(int n)\n{\n  int i;\n  for (i = 0; i < n; i++) calls++;\n  return adder(count * *first * 2, calls);\n}\n",
        );
    scratch
}

#[test]
fn units_and_objects_make_one_program_that_runs_on_every_engine() {
    let scratch = four_files("units");
    assert_eq!(succeed(&scratch, &["build", "-c", "half.c"]), "");
    let line = succeed(&scratch, &["build", "main.c", "up.c", "down.c", "half.o", "--thread", "2"]);
    assert!(line.starts_with("No Errors, No Warnings, text="), "{line}");
    let expect = "101 11 -1 6 8\n";
    assert_eq!(succeed(&scratch, &["run", "2:main(2).out"]), expect);
    let direct =
        succeed(&scratch, &["build", "main.c", "up.c", "down.c", "half.c", "-t2", "-o", "direct.out"]);
    assert_eq!(direct, line);
    assert_eq!(succeed(&scratch, &["run", "2:direct.out"]), expect);
    assert_eq!(succeed(&scratch, &["run", "--engine", "bytecode", "2:main(2).out"]), expect);
}

#[test]
fn an_object_links_to_the_same_bytes_as_its_source() {
    let scratch = four_files("object-bytes");
    succeed(&scratch, &["build", "-c", "main.c", "up.c", "down.c", "half.c"]);
    succeed(&scratch, &["build", "main.c", "up.c", "down.c", "half.c", "-o", "sources.out"]);
    succeed(&scratch, &["build", "main.o", "up.o", "down.o", "half.o", "-o", "objects.out"]);
    assert_eq!(succeed(&scratch, &["diff", "sources.out", "objects.out"]), "");
    let read = |name: &str| fs::read(scratch.path().join(name)).expect("it was written");
    assert_eq!(read("sources.out"), read("objects.out"));
}

#[test]
fn a_missing_unit_is_reported_by_name_with_all_its_callers() {
    let scratch = four_files("missing-unit");
    scratch.write("more.c", "int up(int n);\nint more(void)\n{\n  return up(2) + 1;\n}\n");
    succeed(&scratch, &["build", "-c", "main.c", "more.c"]);
    let output = cc67(&scratch, ["build", "--no-gc-sections", "main.o", "more.o", "down.c", "half.c"]);
    assert_eq!(output.code, 1, "{output:?}");
    assert!(output.stderr.contains("undefined symbol `up`"), "{}", output.stderr);
    assert!(output.stderr.contains("used by `main` (main.c:9), `more` (more.c:4)"), "{}", output.stderr);
    assert!(!scratch.path().join("main(1).out").exists());
}

#[test]
fn a_name_that_two_units_define_is_reported_with_both_places() {
    let scratch = Scratch::new("twice");
    scratch
        .write("a.c", "int f(void) { return 1; }\nmain() { return f(); }\n")
        .write("b.c", "\nint f(void) { return 2; }\n");
    let output = cc67(&scratch, ["build", "a.c", "b.c"]);
    assert_eq!(output.code, 1);
    assert!(output.stderr.contains("`f` is defined twice, in a.c:1 and in b.c:2"), "{}", output.stderr);
}

#[test]
fn builds_are_byte_identical_and_leave_no_other_files() {
    let scratch = Scratch::new("bytes");
    scratch.write("a.c", HELLO).write("again/a.c", HELLO);
    succeed(
        &scratch,
        &["build", "--target", "sim", "a.c", "--map", "--download-script", "--emit", "image,bytecode"],
    );
    succeed(&scratch, &["build", "--target", "sim", "again/a.c"]);
    let read = |name: &str| fs::read(scratch.path().join(name)).expect("it was written");
    assert_eq!(read("a(1).out"), read("again/a(1).out"));
    let mut names: Vec<_> = fs::read_dir(scratch.path())
        .expect("the folder is there")
        .map(|entry| entry.expect("it is readable").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, ["a(1).kmd", "a(1).map", "a(1).out", "a(1).txt", "a.c", "again"]);
}

#[test]
fn the_size_line_counts_as_the_vendors_editor_does() {
    let scratch = Scratch::new("sizes");
    scratch.write("a.c", "int data = 5;\nint bss[10];\nmain() { return bss[data] + data; }\n");
    let line = succeed(&scratch, &["build", "a.c"]);
    let json = succeed(&scratch, &["inspect", "--json", "a(1).out"]);
    let json: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
    let size = |index: usize| json["sections"][index]["size"].as_u64().expect("a number");
    let (text, data, bss) = (size(0), size(1), size(2));
    let total = (text.next_multiple_of(32) + data).next_multiple_of(32) + bss;
    assert_eq!(line, format!("No Errors, No Warnings, text={text}, bss={bss}, data={data}, total={total}\n"));
}

#[test]
fn code_unreachable_from_main_is_left_out_unless_it_is_kept() {
    let scratch = Scratch::new("gc");
    scratch.write("a.c", "int unused(void) { return 1; }\nint table[1000];\nmain() { return 0; }\n");
    let has_unused = |arguments: &[&str]| {
        succeed(&scratch, &[&["build", "a.c", "--map"], arguments].concat());
        fs::read_to_string(scratch.path().join("a(1).map")).expect("the map is written").contains("unused")
    };
    assert!(!has_unused(&[]));
    assert!(has_unused(&["--no-gc-sections"]));
    assert!(has_unused(&["-O0"]));
    assert!(!has_unused(&["-O0", "--gc-sections"]));
}

#[test]
fn using_another_threads_space_is_a_warning_and_too_large_an_error() {
    let scratch = Scratch::new("large");
    scratch
        .write("a.c", "char big[70000];\nmain() { return big[5]; }\n")
        .write("b.c", "char huge[800000];\nint small[10];\nmain() { return huge[5] + small[1]; }\n");
    let output = cc67(&scratch, ["build", "a.c"]);
    assert_eq!(output.code, 0, "{output:?}");
    assert!(output.stderr.contains("enters the space of thread 2"), "{}", output.stderr);
    assert!(output.stdout.starts_with("No Errors, 1 Warning, text="), "{}", output.stdout);
    let output = cc67(&scratch, ["build", "b.c"]);
    assert_eq!(output.code, 1);
    assert!(output.stderr.contains("bytes too large"), "{}", output.stderr);
    assert!(output.stderr.contains("the largest parts in bytes: huge (800000), "), "{}", output.stderr);
}

#[test]
fn an_image_goes_into_the_thread_that_it_is_linked_for() {
    let scratch = Scratch::new("wrong-thread");
    scratch.write("a.c", HELLO);
    succeed(&scratch, &["build", "a.c", "-t", "3"]);
    assert_eq!(succeed(&scratch, &["run", "3:a(3).out"]), "hello\n");
    let output = cc67(&scratch, ["run", "1:a(3).out"]);
    assert_eq!(output.code, 2);
    assert!(output.stderr.contains("linked for thread 3, not for thread 1"), "{}", output.stderr);
    succeed(&scratch, &["build", "-c", "a.c"]);
    assert_eq!(succeed(&scratch, &["run", "a.o"]), "hello\n");
    fs::rename(scratch.path().join("a.o"), scratch.path().join("o.out")).expect("it can be renamed");
    let output = cc67(&scratch, ["run", "o.out"]);
    assert!(output.stderr.contains("an object that is not linked yet"), "{}", output.stderr);
}

#[test]
fn files_of_other_tools_are_described_by_their_kind() {
    let scratch = Scratch::new("foreign");
    let mut elf = vec![0; 64];
    elf[..7].copy_from_slice(b"\x7fELF\x02\x01\x01");
    elf[16..21].copy_from_slice(&[1, 0, 62, 0, 1]);
    elf[52] = 64;
    scratch
        .write("elf.out", &elf)
        .write("elf.o", elf)
        .write("text.out", "hello\n")
        .write("vendor(1).out", vendor::image());
    let check = |arguments: &[&str], expect: &str| {
        let output = cc67(&scratch, arguments);
        assert_eq!(output.code, 2, "{output:?}");
        assert!(output.stderr.contains(expect), "{}", output.stderr);
    };
    check(&["run", "elf.out"], "elf.out is an ELF object file for x86-64, not an image of `cc67 build`");
    check(&["inspect", "elf.out"], "elf.out is an ELF object file for x86-64, not a TI COFF image");
    check(&["build", "elf.o"], "elf.o is an ELF object file for x86-64, not an object of `cc67 build -c`");
    check(&["inspect", "text.out"], "text.out is a text file, not a TI COFF image");
    check(&["build", "vendor(1).out"], "is linked from sources and objects");
}

#[test]
fn a_program_linked_against_the_firmwares_own_file_runs() {
    let scratch = Scratch::new("firmware-file");
    scratch.write("DSPKFLOP.out", vendor::board_firmware()).write("a.c", HELLO);
    assert_eq!(succeed(&scratch, &["run", "--firmware", "DSPKFLOP.out", "a.c"]), "hello\n");
    succeed(&scratch, &["firmware", "export", "exported.out"]);
    assert_eq!(succeed(&scratch, &["run", "--firmware", "exported.out", "a.c"]), "hello\n");
}

#[test]
fn names_missing_from_the_firmware_file_are_undefined() {
    let scratch = Scratch::new("firmware-lacks");
    scratch.write("DSPKFLOP.out", vendor::board_firmware()).write(
        "a.c",
        "int Absent(void);\nint OnlyInTheFile(void);\nmain() { return Absent() + OnlyInTheFile(); }\n",
    );
    let output = cc67(&scratch, ["check", "--firmware", "DSPKFLOP.out", "a.c"]);
    assert_eq!(output.code, 1);
    assert!(output.stderr.contains("undefined symbol `Absent`"), "{}", output.stderr);
    assert!(!output.stderr.contains("`OnlyInTheFile`"), "{}", output.stderr);
}

#[test]
fn a_firmware_file_of_another_version_is_refused_with_both_versions() {
    let scratch = Scratch::new("firmware-version");
    let other = vendor::firmware_file("KFLOP 5.10 Build 10:00:00 Jan  2 2024\n");
    scratch.write("other.out", other).write("a.c", HELLO);
    let output = cc67(&scratch, ["run", "--firmware", "other.out", "a.c"]);
    assert_eq!(output.code, 2);
    assert_eq!(
        output.stderr,
        "cc67: `--firmware`: the firmware file is of `KFLOP 5.10 Build 10:00:00 Jan  2 2024`, \
         the simulated board runs `KFLOP 4.34 Build 16:07:06 Aug 14 2018`\n"
    );
    let output = cc67(&scratch, ["build", "--firmware", "other.out", "a.c"]);
    assert_eq!(output.code, 0);
    assert!(
        output.stderr.contains("5.10 Build 10:00:00 Jan  2 2024`, which cc67 does not know"),
        "{}",
        output.stderr
    );
    let output = cc67(&scratch, ["run", "a(1).out"]);
    assert!(
        output.stderr.contains("linked against firmware of version 5.10; the board runs KFLOP 4.34"),
        "{}",
        output.stderr
    );
}

#[test]
fn a_program_is_built_for_another_board() {
    let scratch = Scratch::new("boards");
    scratch.write("a.c", "#include \"KMotionDef.h\"\nmain() { MoveAtVelAccel(0, 1.0, 2.0, 3.0); }\n");
    let output = cc67(&scratch, ["check", "a.c"]);
    assert_eq!(output.code, 1);
    let expect = "`MoveAtVelAccel` is of KFLOP firmware 5.3.2; this program is built for KFLOP firmware 4.34";
    assert!(output.stderr.contains(expect), "{}", output.stderr);
    assert!(output.stderr.contains("`--board kflop-5.3.2`"), "{}", output.stderr);
    succeed(&scratch, &["build", "--board", "kflop-5.3.2", "a.c"]);
    let refused = cc67(&scratch, ["run", "a(1).out"]);
    let expect = "linked against firmware of version 5.3.2; the board runs KFLOP 4.34";
    assert!(refused.stderr.contains(expect), "{}", refused.stderr);
    let output = cc67(&scratch, ["build", "--board", "kogna-5.3.2", "--thread", "2", "a.c"]);
    assert!(output.stderr.ends_with("was never compared with a board\n"), "{}", output.stderr);
    let shown = cc67(&scratch, ["inspect", "a(2).out"]).stdout.to_lowercase();
    assert!(shown.contains("c00c0000"), "{shown}");
}

#[test]
fn the_board_of_a_project_is_that_of_its_programs() {
    let scratch = Scratch::new("board-of-project");
    let source = "#include \"KMotionDef.h\"\nmain() { printf(\"%p %g\\n\", &persist, 0.05); }\n";
    scratch.write("cc67.toml", "board = \"kflop-5.3.2\"\n").write("a.c", source);
    let persist = TargetBoard::named("kflop-5.3.2").and_then(|board| board.variable("persist"));
    let expect = format!("{:x} 0.05\n", persist.expect("it has one").get());
    for engine in ["native", "bytecode", "dsp"] {
        let output = cc67(&scratch, ["run", "--engine", engine, "a.c"]);
        assert_eq!(output.stdout, expect, "{engine}: {}", output.stderr);
    }
}

#[test]
fn a_firmware_file_of_a_known_version_brings_the_header_of_its_board() {
    let scratch = Scratch::new("firmware-of-board");
    succeed(&scratch, &["firmware", "export", "--board", "kflop-5.3.2", "new.out"]);
    scratch
        .write("a.c", "#include \"KMotionDef.h\"\nchar size[sizeof(SPINDLE) == 120 ? 1 : -1];\nmain() {}\n");
    succeed(&scratch, &["build", "--firmware", "new.out", "a.c"]);
    let output = cc67(&scratch, ["build", "--firmware", "new.out", "--board", "kogna-5.3.2", "a.c"]);
    assert_eq!(output.code, 2);
    assert!(output.stderr.contains("and `--board kogna-5.3.2` is `KOGNA 5.3.2"), "{}", output.stderr);
}

#[test]
fn an_image_of_another_build_of_the_firmware_is_refused() {
    let scratch = Scratch::new("other-build");
    scratch.write("a.c", HELLO);
    succeed(&scratch, &["build", "--target", "sim", "a.c"]);
    let mut bytes = fs::read(scratch.path().join("a(1).out")).expect("it was built");
    // The time stamp in the file header.
    bytes[4..8].copy_from_slice(&1_534_288_031_u32.to_le_bytes());
    scratch.write("a(1).out", bytes);
    let output = cc67(&scratch, ["run", "a(1).out"]);
    assert!(output.stderr.contains("time stamp 1534288031, not 1534288030"), "{}", output.stderr);
}

#[test]
fn the_facts_of_the_next_firmware_come_from_its_file() {
    let scratch = Scratch::new("facts");
    succeed(&scratch, &["firmware", "export", "--board", "kflop-5.3.2", "known.out"]);
    let known = fs::read(scratch.path().join("known.out")).expect("it was written");
    let at = known.windows(5).position(|bytes| bytes == b"5.3.2").expect("it states its version");
    let mut next = known;
    next[at + 4] = b'3';
    scratch.write("next.out", next);
    let facts = cc67(&scratch, ["firmware", "facts", "next.out"]).stdout;
    let file = harness::root().join("kmotiondef/boards/kflop-5.3.2.facts");
    let facts_of = |text: &str| {
        let mut lines: Vec<String> =
            text.lines().filter(|line| !line.is_empty()).map(str::to_owned).collect();
        lines.retain(|line| !line.starts_with('#'));
        lines.sort();
        lines
    };
    let expect = fs::read_to_string(file).expect("the file is there").replace("5.3.2", "5.3.3");
    assert_eq!(facts_of(&facts), facts_of(&expect));
    // Until the file of facts is part of cc67, programs are linked with the symbols, with a warning.
    scratch.write("a.c", HELLO);
    let output = cc67(&scratch, ["build", "--firmware", "next.out", "a.c"]);
    assert_eq!(output.code, 0, "{}", output.stderr);
    assert!(output.stderr.contains("which cc67 does not know"), "{}", output.stderr);
}

#[test]
fn two_boards_are_compared() {
    let scratch = Scratch::new("two-boards");
    scratch.write(
        "a.c",
        "main() { free(malloc(Spindle.Type)); JogAtAccel(0, 1.0, 2.0); printf(KMOTION_VER); }\n",
    );
    let output = cc67(&scratch, ["diff", "--boards", "kflop-4.34", "kflop-5.3.2", "a.c"]);
    assert_eq!(output.code, 1);
    for line in [
        "JogAtAccel                   only in kflop-5.3.2\n",
        "free                         only in kflop-4.34\n",
    ] {
        assert!(output.stdout.contains(line), "{}", output.stdout);
    }
    assert!(!output.stdout.contains("malloc") && !output.stdout.contains("printf "), "{}", output.stdout);
}

#[test]
fn traps_in_included_sources_name_their_file_and_line() {
    let scratch = Scratch::new("included");
    scratch
        .write("a.c", "#include \"helper.c\"\nmain()\n{\n  wild();\n}\n")
        .write("helper.c", "int *nowhere;\nvoid wild(void)\n{\n  *nowhere = 5;\n}\n");
    succeed(&scratch, &["build", "a.c"]);
    let output = cc67(&scratch, ["run", "a(1).out"]);
    assert_eq!(output.code, 3);
    assert!(output.stderr.contains("helper.c:4 in `wild`"), "{}", output.stderr);
    let listing = succeed(&scratch, &["inspect", "--lines", "a(1).out"]);
    assert!(listing.contains("wild in helper.c\n"), "{listing}");
}

#[test]
fn functions_of_an_object_are_in_the_file_that_defines_them() {
    let scratch = Scratch::new("object-files");
    scratch
        .write("a.c", "#include \"KMotionDef.h\"\n#include \"helper.c\"\nmain()\n{\n  half(4);\n}\n")
        .write("helper.c", "int half(int x)\n{\n  return x / 2;\n}\n");
    succeed(&scratch, &["build", "-c", "a.c"]);
    let lines = succeed(&scratch, &["inspect", "--lines", "a.o"]);
    assert!(lines.contains("half in helper.c\n") && lines.contains("main in a.c\n"), "{lines}");
}

#[test]
fn an_included_body_has_the_line_of_its_include() {
    let scratch = Scratch::new("body");
    scratch
        .write("a.c", "int *nowhere;\nmain()\n{\n  int x = 1;\n#include \"body.inc\"\n}\n")
        .write("body.inc", "\n\n\n\n\n\n\n  *nowhere = x;\n");
    let output = cc67(&scratch, ["run", "a.c"]);
    assert!(output.stderr.contains("a.c:5:10 in `main`"), "{}", output.stderr);
}
