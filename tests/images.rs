//! Images and firmware files as users meet them: building, linking, inspecting, loading.

use harness::{Output, Scratch, run_in, vendor};

fn cc67(scratch: &Scratch, arguments: &[&str]) -> Output {
    run_in(env!("CARGO_BIN_EXE_cc67-under-test"), scratch.path(), arguments)
}

const HELLO: &str = "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"hello\\n\");\n}\n";

#[test]
fn a_program_linked_against_the_firmwares_own_file_runs() {
    let scratch = Scratch::new("firmware-file");
    scratch.write("DSPKFLOP.out", vendor::board_firmware()).write("a.c", HELLO);
    let output = cc67(&scratch, &["run", "--firmware", "DSPKFLOP.out", "a.c"]);
    assert_eq!(output, Output { code: 0, stdout: "hello\n".into(), stderr: String::new() });
}

#[test]
fn names_that_the_firmware_file_lacks_are_undefined() {
    let scratch = Scratch::new("firmware-lacks");
    scratch.write("DSPKFLOP.out", vendor::board_firmware()).write(
        "a.c",
        "int Absent(void);\nint OnlyInTheFile(void);\nmain() { return Absent() + OnlyInTheFile(); }\n",
    );
    let output = cc67(&scratch, &["check", "--firmware", "DSPKFLOP.out", "a.c"]);
    assert_eq!(output.code, 1);
    assert!(output.stderr.contains("undefined symbol `Absent`"), "{}", output.stderr);
    assert!(!output.stderr.contains("`OnlyInTheFile`"), "{}", output.stderr);
}

#[test]
fn a_firmware_file_of_another_version_is_refused_with_both_versions() {
    let scratch = Scratch::new("firmware-version");
    let other = vendor::firmware_file("KFLOP 5.10 Build 10:00:00 Jan  2 2024\n");
    scratch.write("other.out", other).write("a.c", HELLO);
    let output = cc67(&scratch, &["run", "--firmware", "other.out", "a.c"]);
    assert_eq!(output.code, 2);
    assert_eq!(
        output.stderr,
        "cc67: `--firmware`: the firmware file is of `KFLOP 5.10 Build 10:00:00 Jan  2 2024`, \
         the simulated board runs `KFLOP 4.34 Build 16:07:06 Aug 14 2018`\n"
    );
}
