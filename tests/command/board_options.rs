//! An option of a board means the same to every command that has a board.

use harness::{Scratch, cc67, cc67_with_input};

/// Prints what options decide: an element of UserData, a virtual bit.
const PROGRAM: &str = "\
#include \"KMotionDef.h\"
main()
{
  Delay_sec(0.02);
  printf(\"%d %d\\n\", persist.UserData[5], ReadBit(48));
}
";

/// The options, and the output of the program with them.
const CASES: &[(&[&str], &str)] = &[
    (&[], "0 0\n"),
    (&["--set", "persist.5=7"], "7 0\n"),
    (&["--mcode", "M101:5"], "101 0\n"),
    (&["--stim", "t=0.01 bit 48=1"], "0 1\n"),
    (&["--stim", "t=0.01 bit 48=1", "--set", "persist.5=7", "--no-shortcuts"], "7 1\n"),
    (&["--machine", "a.machine"], "0 1\n"),
];

/// Reads and writes through a pointer that is 0, and a word across its border.
const FAULTS: &str = "\
#include \"KMotionDef.h\"
struct S { int a; double d; };
int g[4] = {1, 2, 3, 4};
main()
{
  volatile int *p = 0;
  struct S *s = 0, t;
  char *q = (char *)g;
  t.a = 5;
  t = *s;
  printf(\"%d %d %d\\n\", *p, p[5], s->a);
  *p = 7;
  s->d = 1.5;
  printf(\"%d %g %d\\n\", *p, s->d, t.a);
  *(int *)(q + 6) = 9;
  printf(\"%d %d %d\\n\", g[1], *(int *)(q + 7), *(volatile short *)(q + 5));
  p = (volatile int *)0x70000000;
  printf(\"%d\\n\", *p);
}
";

#[test]
fn board_faults_makes_bad_accesses_answer_as_on_the_board() {
    let scratch = Scratch::new("board-options-faults");
    scratch.write("a.c", FAULTS).write("a.machine", "[cpu]\nboard_faults = true\n");
    for engine in ["bytecode", "native", "dsp"] {
        let stopped = cc67(&scratch, ["run", "a.c", "--engine", engine]);
        assert_eq!((stopped.code, stopped.stdout.as_str()), (3, ""), "{engine}");
        assert!(stopped.stderr.contains("a.c:10:3 in `main`: read of the unmapped address 0x00000000"));
        for option in [&["--board-faults"][..], &["--machine", "a.machine"]] {
            let answered = cc67(&scratch, [&["run", "a.c", "--engine", engine], option].concat());
            assert_eq!(answered.stdout, "0 0 0\n0 0 0\n9 9 9\n", "{engine} {option:?}: {}", answered.stderr);
            let beyond = "a.c:18:3 in `main`: read of the unmapped address 0x70000000";
            assert!(answered.code == 3 && answered.stderr.contains(beyond), "{engine}: {}", answered.stderr);
        }
    }
}

/// Divides by a variable that is 0.
const DIVISIONS: &str = "\
#include \"KMotionDef.h\"
int a[4] = {0, 5, -5, 65535};
int zero; unsigned none;
main()
{
  int i;
  for (i = 0; i < 4; i++) printf(\"%d %d %u %u\\n\", a[i] / zero, a[i] % zero, a[i] / none, a[i] % none);
}
";

#[test]
fn board_faults_makes_divisions_by_zero_yield_what_the_board_yields() {
    let scratch = Scratch::new("board-options-divisions");
    scratch.write("a.c", DIVISIONS);
    let board = "1 0 1 0\n15 5 15 5\n-15 -5 4294967295 0\n131071 32767 131071 32767\n";
    for engine in ["bytecode", "native", "dsp"] {
        let stopped = cc67(&scratch, ["run", "a.c", "--engine", engine]);
        assert_eq!((stopped.code, stopped.stdout.as_str()), (3, ""), "{engine}");
        assert!(stopped.stderr.contains("integer division by zero"), "{engine}: {}", stopped.stderr);
        let answered = cc67(&scratch, ["run", "a.c", "--engine", engine, "--board-faults"]);
        assert_eq!((answered.code, answered.stdout.as_str()), (0, board), "{engine}: {}", answered.stderr);
    }
}

/// Divides floating numbers.
const QUOTIENTS: &str = "\
#include \"KMotionDef.h\"
double zero, ten = 10, a; float three = 3;
main()
{
  printf(\"%d %d %d %d\\n\", 1 / zero > 0, 1 / zero < 0, 1 / zero == 1 / zero, (int)(1 / zero));
  a = 3; a /= ten;
  printf(\"%d %d %.9g\\n\", a > 0.3, 3.0 / 10 > 0.3, 1 / three);
}
";

#[test]
fn board_faults_divides_floating_numbers_by_the_functions_of_the_firmware() {
    let scratch = Scratch::new("board-options-quotients");
    scratch.write("a.c", QUOTIENTS).write("a.machine", "[cpu]\nboard_faults = true\n");
    for engine in ["bytecode", "native", "dsp"] {
        for level in ["-O0", "-O2"] {
            let run = |options: &[&str]| {
                let output = cc67(&scratch, [&["run", "a.c", "--engine", engine, level], options].concat());
                assert_eq!(output.code, 0, "{engine}: {}", output.stderr);
                output.stdout
            };
            assert_eq!(run(&[]), "1 0 1 2147483647\n0 0 0.333333343\n", "{engine} {level}");
            // 3/10 is 0x3FD3333333333334 there, a bit too much.
            let board = "0 0 0 2147483647\n1 0 0.333333343\n";
            for option in [&["--board-faults"][..], &["--machine", "a.machine"]] {
                assert_eq!(run(option), board, "{engine} {level} {option:?}");
            }
        }
    }
}

#[test]
fn cc67_timing_is_that_of_the_controller_code_on_every_engine() {
    let scratch = Scratch::new("board-options-timing");
    scratch.write(
        "a.c",
        "#include \"KMotionDef.h\"\ndouble a[50], s;\nmain()\n{\n  int i, n; double t; WaitNextTimeSlice();\n  \
         t = Time_sec();\n  for (n = 0; n < 3; n++) for (i = 0; i < 50; i++) s += a[i] * 0.5;\n  \
         printf(\"%.8f\\n\", Time_sec() - t);\n}\n",
    );
    let time = |options: &[&str]| {
        let output = cc67(&scratch, [&["run", "a.c"], options].concat());
        assert_eq!(output.code, 0, "{options:?}: {}", output.stderr);
        output.stdout.trim().parse::<f64>().expect("a number")
    };
    for level in ["-O0", "-O1", "-O2"] {
        let own = time(&["--engine", "dsp", level]);
        for engine in ["bytecode", "native", "dsp"] {
            let found = time(&["--timing", "cc67", "--engine", engine, level]);
            assert!((found - own).abs() < 1e-9, "{engine} {level}: {found}, {own}");
        }
    }
    assert!(time(&["--timing", "cc67", "-O2"]) < 0.5 * time(&["--timing", "vendor", "-O2"]));
    let refused = cc67(&scratch, ["run", "a.c", "--timing", "cc67", "--target", "sim"]);
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("`--target sim` makes none"), "{}", refused.stderr);
}

fn scratch(name: &str, arguments: &[&str], expect: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let test = format!("// cc67: run {}\n{PROGRAM}", arguments.join(" "));
    // A test has words without spaces.
    scratch.write("world.stim", "t=0.01 bit 48=1\n");
    scratch.write("a.c", PROGRAM).write("t.c", test.replace("t=0.01 bit 48=1", "world.stim"));
    scratch.write("t.expected", expect);
    scratch.write("a.machine", "[[event]]\nat = 0.01\nset_bit = { 48 = 1 }\n");
    scratch
}

#[test]
fn run_console_and_test_understand_the_same_options() {
    for (index, (arguments, expect)) in CASES.iter().enumerate() {
        let scratch = scratch(&format!("board-options-{index}"), arguments, expect);
        let run = cc67(&scratch, [&["run", "a.c"], *arguments].concat());
        let console = cc67_with_input(&scratch, [&["console", "a.c"], *arguments].concat(), "wait 0.1\n");
        for (command, output) in [("run", run), ("console", console)] {
            let shown = (output.code, output.stdout.as_str());
            assert_eq!(shown, (0, *expect), "{command} {arguments:?}: {}", output.stderr);
        }
        let test = cc67(&scratch, ["test", "t.c"]);
        assert_eq!(test.code, 0, "{arguments:?}: {}{}", test.stdout, test.stderr);
    }
}

#[test]
fn every_command_can_feed_the_serial_port_from_a_file() {
    let scratch = Scratch::new("board-options-uart");
    scratch.write(
        "a.c",
        "#include \"KMotionDef.h\"\nmain()\n{\n  SetBitDirection(45, 1);\n  FPGA(KAN_TRIG_REG) = 2;\n  \
         FPGA(RS232_BAUD_REG) = RS232_BAUD_115200;\n  while (!(FPGA(RS232_STATUS) & RS232_DATA_READY)) ;\n  \
         printf(\"%c\\n\", FPGA(RS232_DATA));\n}\n",
    );
    scratch.write("in", "x");
    for (command, input) in [("run", ""), ("console", "wait 0.1\n")] {
        let arguments = [command, "a.c", "--uart-input", "in", "--for", "0.1"];
        let output = cc67_with_input(&scratch, arguments, input);
        assert_eq!(output.stdout, "x\n", "{command}: {}", output.stderr);
    }
}
