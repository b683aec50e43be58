//! `--boot`: the user's own firmware file in place of the modelled firmware.
//!
//! Where `CC67_FIRMWARE` names a file, programs run on it; otherwise the test says so.

use std::path::PathBuf;
use std::{env, fs};

use harness::{Output, Scratch, cc67, cc67_with_input};

const HELLO: &str =
    "#include \"KMotionDef.h\"\nmain()\n{\n  persist.UserData[3] = 7;\n  printf(\"hello\\n\");\n}\n";

/// The firmware file, if there is one.
pub(crate) fn firmware() -> Option<String> {
    let Some(path) = env::var_os("CC67_FIRMWARE") else {
        println!("not run: CC67_FIRMWARE names no firmware file");
        return None;
    };
    Some(PathBuf::from(path).to_str().expect("a name of text").to_owned())
}

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write("hello.c", HELLO);
    scratch
}

/// One message, and the exit code of wrong input.
fn assert_refused(output: &Output, expect: &str) {
    assert_eq!(output.code, 2, "{output:?}");
    assert!(output.stderr.contains(expect), "expected {expect:?} in:\n{}", output.stderr);
    assert_eq!(output.stderr.lines().count(), 1, "{}", output.stderr);
}

#[test]
fn files_that_are_not_firmware_are_refused_with_one_message() {
    let scratch = scratch("boot-none");
    let run = |file: &str| cc67(&scratch, ["run", "--boot", file, "hello.c"]);
    assert_refused(&run("nosuch.out"), "nosuch.out");
    assert_refused(&run("hello.c"), "not a firmware file");
    assert_eq!(cc67(&scratch, ["build", "--target", "c67x", "hello.c", "-o", "hello.out"]).code, 0);
    assert_refused(&run("hello.out"), "a user program runs on a firmware");
    let console = cc67_with_input(&scratch, ["console", "--boot", "hello.out"], "Version\n");
    assert_refused(&console, "not a firmware file");
}

#[test]
fn options_that_a_booted_board_does_not_support_are_named() {
    let scratch = scratch("boot-options");
    let refused = |option: &[&str], name: &str| {
        let all = [&["run", "--boot", "x.out", "hello.c"], option].concat();
        assert_refused(&cc67(&scratch, all), &format!("`{name}` does not work with `--boot`"));
    };
    refused(&["--engine", "bytecode"], "--engine");
    refused(&["--board-faults"], "--board-faults");
    refused(&["--timing", "fast"], "--timing");
    refused(&["--target", "sim"], "--target sim");
    let on = |option: &[&str]| cc67(&scratch, [&["run", "--on", "usb:nosuch", "hello.c"], option].concat());
    for (option, value) in [("--timing", "fast"), ("--wait-states", "none"), ("--target", "sim")] {
        assert_refused(&on(&[option, value]), "does not work with `--on`");
    }
    let compare = ["compare", "--boot", "x.out", "--flash", "x", "hello.c"];
    assert_refused(&cc67(&scratch, compare), "`--flash` does not work with `cc67 compare`");
    let compare = cc67(&scratch, ["compare", "--boot", "x.out", "--board-faults", "hello.c"]);
    assert!(compare.stderr.contains("cannot read x.out"), "{}", compare.stderr);
    let test = cc67(&scratch, ["compare", "hello.c"]);
    assert_refused(&test, "needs `--boot FILE`");
}

#[test]
fn a_program_prints_the_same_on_the_real_firmware_and_the_model() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-hello");
    let run = cc67(&scratch, ["run", "--boot", &file, "hello.c"]);
    assert_eq!(run, Output { code: 0, stdout: "hello\n".into(), stderr: String::new() });
    let compare = cc67(&scratch, ["compare", "--boot", &file, "hello.c"]);
    assert_eq!(compare.code, 0, "{compare:?}");
    assert!(compare.stdout.contains("equal"), "{compare:?}");
}

/// `ThreadDone` takes the thread's number from a register that functions keep other values in.
#[test]
fn a_thread_that_keeps_values_in_registers_ends_itself() {
    let Some(file) = firmware() else { return };
    let scratch = Scratch::new("boot-thread-done");
    let main = "#include \"KMotionDef.h\"\nmain()\n{\n  double begin;\n  StartThread(2);\n  Delay_sec(0.01);\n  WaitNextTimeSlice();\n  begin = ServoTick;\n  WaitNextTimeSlice();\n  printf(\"%g ticks\\n\", ServoTick - begin);\n}\n";
    // Its loop has values for all registers that functions keep.
    let other = "#include \"KMotionDef.h\"\nmain()\n{\n  int n;\n  for (n = 0; n < 65; n++) {\n    if (n == 5) ThreadDone();\n    if (n == 16) persist.UserData[12] += -9;\n    if (n == 19) persist.UserData[10] += -4;\n    if (n == 22) persist.UserData[13] += 7;\n    WaitNextTimeSlice();\n  }\n}\n";
    scratch.write("main.c", main);
    scratch.write("other.c", other);
    let run = cc67(&scratch, ["run", "--boot", &file, "main.c", "--load", "2:other.c"]);
    assert_eq!((run.code, run.stdout.as_str()), (0, "2 ticks\n"), "a thread that is alone: {run:?}");
}

#[test]
fn random_scenarios_need_a_firmware_file_and_no_program() {
    let scratch = scratch("boot-random-none");
    assert_refused(&cc67(&scratch, ["compare", "--random"]), "needs `--boot FILE`");
    let both = cc67(&scratch, ["compare", "--boot", "x.out", "--random=moves", "hello.c"]);
    assert_eq!(both.code, 2, "{both:?}");
    assert!(both.stderr.contains("cannot be used with"), "{both:?}");
    let unknown = cc67(&scratch, ["compare", "--boot", "x.out", "--random=weather"]);
    assert!(unknown.stderr.contains("commands, moves, paths, servo, outputs, threads, text"), "{unknown:?}");
}

/// Two hundred an area where `CC67_LONG` is set. What differs is shown and kept; how much does is for a person to judge.
#[test]
fn random_scenarios_are_drawn_reduced_and_kept() {
    let Some(file) = firmware() else { return };
    let count = if harness::is_long() { "200" } else { "2" };
    let scratch = Scratch::new("boot-random");
    let compare =
        cc67(&scratch, ["compare", "--boot", &file, "--random", "--count", count, "--keep", "found.jsonl"]);
    print!("{}", compare.stdout);
    let table = compare.stdout.split_once("area ").map(|(_, table)| table.lines().skip(1)).expect("a table");
    let rows: Vec<Vec<&str>> = table.map(|row| row.split_whitespace().collect()).collect();
    let areas: Vec<_> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(areas, ["commands", "moves", "paths", "servo", "outputs", "threads", "text"]);
    assert!(rows.iter().all(|row| row[2] == count), "{rows:?}");
    let different = rows.iter().map(|row| number(row[2]) - number(row[1])).sum::<usize>();
    let kept = fs::read_to_string(scratch.path().join("found.jsonl")).unwrap_or_default();
    assert_eq!(kept.lines().count(), different, "each that differs is kept");
    assert!(kept.lines().all(|line| line.starts_with('{') && line.contains("\"note\":")), "{kept}");
    assert_eq!(compare.code, if different == 0 { 0 } else { 5 }, "{compare:?}");
    let again = cc67(&scratch, ["compare", "--boot", &file, "--random=moves", "--count", "2"]);
    assert!(
        compare.stdout.contains(again.stdout.split("area ").next().expect("text")),
        "a seed is a scenario"
    );
}

fn number(text: &str) -> usize {
    text.parse().expect("a number")
}

/// A thousand where `CC67_LONG` is set. A motion whose planning ends about the end of a tick begins in another tick on the
/// two boards, as they agree on what planning costs within a tenth: one in twenty programs may end a little elsewhere.
#[test]
fn random_motions_end_at_the_same_place_on_the_real_firmware() {
    let Some(file) = firmware() else { return };
    let count = if harness::is_long() { 1000 } else { 4 };
    let scratch = Scratch::new("boot-motions");
    let names: Vec<String> = (0..count).map(|seed| format!("m{seed:04}.c")).collect();
    for (seed, name) in (0..).zip(&names) {
        scratch.write(name, harness::motions::program(seed));
    }
    let mut differing = String::new();
    for some in names.chunks(50) {
        let fixed = ["compare", "--for", "60", "--boot", file.as_str()];
        let output = cc67(&scratch, fixed.into_iter().chain(some.iter().map(String::as_str)));
        assert!(matches!(output.code, 0 | 5), "{output:?}");
        let lines = output.stdout.lines().filter(|line| line.contains(" difference"));
        lines.for_each(|line| differing.push_str(&format!("{line}\n")));
    }
    assert!(20 * differing.lines().count() <= count, "{differing}");
}

#[test]
fn script_commands_are_answered_by_the_real_firmware() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-console");
    let script =
        "CheckThread1\nSetPersistDec 5 7\nGetPersistDec 5\nFoo\nrun hello.c\nwait 0.01\nGetPersistDec 3\n";
    let output = cc67_with_input(&scratch, ["console", "--boot", &file], script);
    assert_eq!(output.code, 0, "{output:?}");
    assert_eq!(output.stdout, "0\n7\nFOO\n^\nerror, invalid command\nhello\n7\n", "{output:?}");
}

#[test]
fn the_real_firmware_keeps_pace_with_the_clock() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-pace");
    let console = ["console", "--boot", &file, "--realtime"];
    let output = cc67_with_input(&scratch, console, "run hello.c\nwait 0.01\nGetPersistDec 3\n");
    assert_eq!(output, Output { code: 0, stdout: "hello\n7\n".into(), stderr: String::new() });
}

#[test]
fn a_program_that_crashes_the_firmware_is_shown_with_registers_and_code() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-crash");
    scratch.write("wild.c", "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"before\\n\");\n  Delay_sec(0.01);\n  *(int *)0x70000000 = 1;\n}\n");
    let output = cc67(&scratch, ["run", "--boot", &file, "wild.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (3, "before\n"), "{output:?}");
    for part in ["write of the unmapped address 0x70000000", "thread 1", "A0=", "B15=", "STW"] {
        assert!(output.stderr.contains(part), "{part} in {}", output.stderr);
    }
}

/// An axis of steps that moves by 100, with a bit that says so.
const MOVE: &str = "\
#include \"KMotionDef.h\"
main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 1000;
    ch0->Accel = 1e5;
    ch0->Jerk = 1e7;
    SetBitDirection(45, 1);
    EnableAxisDest(0, 0);
    SetBit(45);
    Move(0, 100);
    while (!CheckDone(0)) ;
    ClearBit(45);
    persist.UserData[5] = 42;
    printf(\"took %.3f s\\n\", Time_sec());
}
";

fn read(scratch: &Scratch, name: &str) -> String {
    fs::read_to_string(scratch.path().join(name)).expect("it was written")
}

/// The last value of each column of a table.
fn last_row(table: &str) -> Vec<(String, String)> {
    let names = table.lines().next().expect("a head").split(',');
    let values = table.lines().next_back().expect("a row").split(',');
    names.zip(values).map(|(name, value)| (name.to_owned(), value.to_owned())).collect()
}

#[test]
fn a_run_on_the_real_firmware_is_traced_and_drawn_as_on_the_model() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-trace");
    scratch.write("move.c", MOVE);
    let items = "dest0,pos0,step0,bit45,persist.5,ch0->Enable";
    let trace = |name: &str, boot: &[&str]| {
        let outputs = ["--plot", "a.svg", "--trace-bits", "bits.csv", "--trace", name, "--watch", items];
        let output = cc67(&scratch, [&["run"], boot, &outputs, &["move.c"]].concat());
        assert_eq!(output.code, 0, "{output:?}");
        read(&scratch, name)
    };
    let (booted, model) = (trace("a.csv", &["--boot", &file]), trace("b.csv", &[]));
    let (last, expect) = (last_row(&booted), last_row(&model));
    for ((name, value), (other, expected)) in last.iter().zip(&expect).skip(1) {
        let numbers: [f64; 2] = [value, expected].map(|text| text.parse().expect("a number"));
        assert!(name == other && (numbers[0] - numbers[1]).abs() < 0.13, "{name}: {numbers:?}");
    }
    assert!(last.iter().any(|(_, value)| value.trim() == "100"), "{booted}");
    let changes = read(&scratch, "bits.csv");
    assert!(changes.lines().any(|line| line.ends_with(",45,1,1")), "{changes}");
    assert!(read(&scratch, "a.svg").contains("<svg"));
    let command = ["run", "--boot", &file, "--trace", "c.csv", "--watch", "konnect3", "move.c"];
    assert_refused(
        &cc67(&scratch, command),
        "`konnect3` belongs to an option board that the firmware file does not have",
    );
}

#[test]
fn a_trace_of_the_real_firmware_shows_the_slices_of_threads() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-slices");
    scratch.write("move.c", MOVE);
    let command = ["run", "--boot", &file, "--trace", "a.json", "1:move.c", "2:hello.c"];
    assert_eq!(cc67(&scratch, command).code, 0);
    let trace = read(&scratch, "a.json");
    assert!(trace.contains("thread 1") && trace.contains("thread 2"), "{}", &trace[..1000]);
}

#[test]
fn the_state_at_the_end_is_that_of_the_real_firmware() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-state");
    scratch.write("move.c", MOVE);
    let output = cc67(&scratch, ["run", "--boot", &file, "--state", "move.c"]);
    for part in ["axis 0 enabled, dest 100, ", "persist 5 = 42"] {
        assert!(output.stderr.contains(part), "{part} in {output:?}");
    }
}

const COUNT: &str = "#include \"KMotionDef.h\"\nint count = 5;\nmain()\n{\n  printf(\"count %d, data %d\\n\", count++, \
                     persist.UserData[7]);\n}\n";

#[test]
fn the_real_firmware_starts_from_the_flash_that_it_has_written() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-flash");
    scratch.write("a.c", COUNT);
    let script = "run a.c\nwait 0.01\nSetPersistDec 7 77;Vel3=1234\nSetStartupThread1 1\nFlash\n\
                  SetPersistDec 7 1;Vel3=1\nReboot!\nwait 0.5\nVel3;GetPersistDec 7\n";
    let console = ["console", "--boot", &file, "--flash", "board.flash"];
    let output = cc67_with_input(&scratch, console, script);
    assert_eq!(output.code, 0, "{output:?}");
    let expect =
        "count 5, data 0\nProgram Flash Image Complete\nVerify Complete\ncount 6, data 77\n1234.000000\n77\n";
    assert_eq!(output.stdout, expect, "{output:?}");
    // The next power-up: no PC says anything, no program is named.
    for _ in 0..2 {
        let output = cc67(&scratch, ["run", "--boot", &file, "--flash", "board.flash"]);
        let expect = "count 6, data 77\n".to_owned();
        assert_eq!(output, Output { code: 0, stdout: expect, stderr: String::new() });
    }
    scratch.write("other.flash", vec![0xFF; 1 << 21]);
    let other = cc67(&scratch, ["run", "--boot", &file, "--flash", "other.flash", "hello.c"]);
    assert_refused(
        &other,
        "the flash other.flash does not work with `--boot`: it belongs to the modelled board",
    );
}

#[test]
fn a_profile_of_the_real_firmware_shows_functions_and_program_lines() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-profile");
    let work = "#include \"KMotionDef.h\"\nint sum;\nmain()\n{\n  int i;\n  for (i = 0; i < 100000; ++i)\n    sum += i * i;\n  Delay_sec(0.01);\n}\n";
    scratch.write("work.c", work);
    let output = cc67(&scratch, ["run", "--boot", &file, "--profile=flame.svg", "work.c"]);
    assert_eq!(output.code, 0, "{output:?}");
    for part in
        ["thread 1: computing", "work.c:7 in main", "Delay_sec", "the firmware's own thread", "the servo"]
    {
        assert!(output.stderr.contains(part), "{part} in {}", output.stderr);
    }
    assert!(read(&scratch, "flame.svg").contains("<svg"));
}

#[test]
fn inputs_of_the_real_firmware_are_driven_at_the_prompt() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-press");
    let script = "ReadBit15\npress 15\nwait 0.001\nReadBit15\nrelease 15\nwait 0.001\nReadBit15\n";
    let output = cc67_with_input(&scratch, ["console", "--boot", &file], script);
    assert_eq!((output.code, output.stdout.as_str()), (0, "0\n1\n0\n"), "{output:?}");
}

#[test]
fn printed_times_may_differ_within_the_tolerance() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-numbers");
    scratch.write("time.c", "#include \"KMotionDef.h\"\nmain()\n{\n  double t = Time_sec();\n  Delay_sec(0.01);\n  printf(\"took %.7f s\\n\", Time_sec() - t);\n}\n");
    let compare = cc67(&scratch, ["compare", "--boot", &file, "time.c"]);
    assert_eq!(compare.code, 0, "{compare:?}");
    assert!(compare.stdout.contains("time.c: line 1: its numbers differ by"), "{compare:?}");
    let exact = cc67(&scratch, ["compare", "--boot", &file, "--exact", "time.c"]);
    assert_eq!(exact.code, 5, "{exact:?}");
}

#[test]
fn the_others_are_compared_when_one_program_does_not_compile() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-compare-broken");
    scratch.write("broken.c", "main() { printf(\"no end\") }\n");
    scratch.write("hello.c", HELLO);
    let compare = cc67(&scratch, ["compare", "--boot", &file, "broken.c", "hello.c"]);
    assert_eq!(compare.code, 1, "{compare:?}");
    let rows: Vec<_> =
        compare.stdout.lines().skip(1).map(|row| row.split_whitespace().collect::<Vec<_>>()).collect();
    assert_eq!(rows[0], ["broken.c", "-", "does", "not", "compile"], "{compare:?}");
    assert_eq!(rows[1][..3], ["hello.c", "1", "equal"], "{compare:?}");
    assert!(compare.stderr.contains("1 of 2 programs do not compile"), "{compare:?}");
}

#[test]
fn tests_of_a_project_run_on_the_real_firmware() {
    let Some(file) = firmware() else { return };
    let scratch = scratch("boot-test");
    scratch.write("move.c", MOVE);
    scratch.write("engine.c", format!("// cc67: run --engine bytecode\n{HELLO}"));
    for (name, text) in [("hello", "hello\n"), ("engine", "hello\n"), ("move", "other\n")] {
        scratch.write(&format!("{name}.expected"), text);
    }
    let test = cc67(&scratch, ["test", "--boot", &file, "."]);
    assert_eq!(test.code, 1, "{test:?}");
    let skipped = "skipped  engine: `--engine` does not work with `--boot`\n";
    assert!(test.stdout.starts_with(skipped), "{}", test.stdout);
    assert!(test.stdout.ends_with("1 passed, 1 failed, 1 skipped\n"), "{}", test.stdout);
}

#[test]
fn an_operator_helps_waiting_programs_on_the_real_firmware() {
    let Some(file) = firmware() else { return };
    let scratch = Scratch::new("boot-assist");
    let program = "#include \"KMotionDef.h\"
main()
{
    while (!ReadBit(136)) WaitNextTimeSlice();
    printf(\"start\\n\");
    Jog(0, -1000.0);
    while (!ReadBit(10) && !ReadBit(11)) ;
    printf(\"home\\n\");
}
";
    scratch.write("wait.c", program);
    let run = |options: &[&str]| {
        cc67(&scratch, [&["run", "wait.c", "--assist", "--for", "7", "--time"], options].concat())
    };
    let (model, real) = (run(&[]), run(&["--boot", &file]));
    assert_eq!(real.code, 0, "{real:?}");
    let helps = |output: &Output| -> Vec<String> {
        output.stderr.lines().filter(|line| line.contains(" waits: ")).map(str::to_owned).collect()
    };
    assert_eq!(helps(&real), helps(&model), "what the operator does, to whom and where");
    assert!(
        real.stderr.contains("wait.c:4:13 in `main` waits, so --assist sets bit 136 to 1 for 0.1 s"),
        "{real:?}"
    );
    let times = |output: &Output| -> Vec<f64> {
        let times = output.stdout.lines().filter_map(|line| line.split_whitespace().next()?.parse().ok());
        times.collect()
    };
    let (model, real) = (times(&model), times(&real));
    assert_eq!(real.len(), 2);
    assert!(model.iter().zip(&real).all(|(one, other)| (one - other).abs() < 0.002), "{model:?} {real:?}");
}

#[test]
fn packets_of_programs_on_the_real_firmware_are_traced() {
    let Some(file) = firmware() else { return };
    let scratch = Scratch::new("boot-packets");
    let program = "#include \"KMotionDef.h\"
int ticks;
void count(void) { ++ticks; }
main()
{
    UserCallBack = count;
    Delay_sec(0.001);
    UserCallBack = 0;
    printf(\"%d\\n\", ticks > 5);
}
";
    scratch.write("count.c", program);
    let run = |name: &str, more: &[&str]| {
        let output = cc67(&scratch, [&["run", "count.c", "--trace-packets", name], more].concat());
        assert_eq!((output.code, output.stdout.as_str()), (0, "1\n"), "{output:?}");
        let file = name.trim_start_matches("1:");
        let text = fs::read_to_string(scratch.path().join(file)).expect("it is written");
        text.lines().map(|line| line.splitn(5, ',').map(str::to_owned).collect()).collect::<Vec<Vec<_>>>()
    };
    let real = run("real.csv", &["--boot", &file]);
    assert_eq!(real[0], ["cycle", "thread", "address", "cycles", "packet"]);
    let of_model = run("model.csv", &["--engine", "dsp"]);
    // The same packets in the same order, wherever the firmware waits; the linker knows other addresses there.
    let path = |rows: &[Vec<String>], thread: &str| -> Vec<String> {
        let own = rows.iter().filter(|row| row[1] == thread);
        own.map(|row| row[2].clone()).collect()
    };
    assert_eq!(path(&real, "1"), path(&of_model, "1"));
    let (calls, of_model) = (path(&real, "0"), path(&of_model, "0"));
    assert!(calls.len() > 20 && calls.len().abs_diff(of_model.len()) <= of_model.len() / 5, "{calls:?}");
    assert_eq!(calls[..4], of_model[..4]);
    assert!(run("1:one.csv", &["--boot", &file])[1..].iter().all(|row| row[1] == "1"));
}

/// Mistakes of wiring, which a board shows by what does not move: the model and the firmware come to the same.
#[test]
fn wrong_channels_move_as_little_on_the_firmware_as_on_the_model() {
    let Some(firmware) = firmware() else { return };
    let folder = harness::root().join("tests/filetests/mistakes");
    for (machine, program) in [
        ("parts/slow_motor.toml", "encoder_on_another_input.c"),
        ("parts/wired.toml", "motor_on_another_dac.c"),
        ("parts/heavy.toml", "sign_of_the_output_wrong_without_integrator.c"),
        ("parts/motor.toml", "max_output_0.c"),
        ("parts/motor.toml", "position_written_while_enabled.c"),
        ("parts/pushed.toml", "axis_enabled_at_a_place_where_it_is_not.c"),
        ("parts/disables.toml", "axis_disabled_while_it_is_waited_for.c"),
    ] {
        let output = cc67(
            &folder,
            ["compare", "--boot", &firmware, "--machine", machine, "--for", "3", "-w", program],
        );
        assert_eq!(output.code, 0, "{program}: {output:?}");
    }
    let twins = harness::root().join("tests/filetests/twins");
    let wired = "../mistakes/parts/wired.toml";
    for program in ["encoder_on_its_own_input.c", "dac_written_by_a_program.c"] {
        let output =
            cc67(&twins, ["compare", "--boot", &firmware, "--machine", wired, "--for", "3", program]);
        assert_eq!(output.code, 0, "{program}: {output:?}");
    }
}
