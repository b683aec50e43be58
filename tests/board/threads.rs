//! Rotation, slices and time functions, compared with measurements of the released firmware.
//!
//! `data/vectors/threads.jsonl` is a copy of those measurements. Times include the cost of single instructions, which
//! differs on the simulated board; they are compared with a tolerance of 2 µs, tick counts and orders exactly.

use std::fmt::Write as _;
use std::fs;

use harness::{Output, Scratch, cc67};
use serde_json::Value;

/// The allowed difference between a measured and a simulated duration.
const TOLERANCE: f64 = 2e-6;

/// A servo sample.
const TICK: f64 = 90e-6;

/// The allowed difference for the first time of a series, which begins where the code before it has ended.
const FIRST_TOLERANCE: f64 = 10e-6;

/// A reading directly after a slice of thread 0. On the board the length of that slice is the firmware's work; here it
/// is constant: the reading comes 13.3 µs after the tick on the board, 9.9 µs here.
const AFTER_THREAD_0: &str = "Time_sec after WaitNextTimeSlice minus ServoTick*TIMEBASE";
const THREAD_0_TOLERANCE: f64 = 4e-6;

fn vectors(kind: &str) -> Vec<Value> {
    let path = harness::root().join("tests/data/vectors/threads.jsonl");
    let text = fs::read_to_string(path).expect("the measurements are there");
    let lines = text.lines().map(|line| serde_json::from_str(line).expect("each line is JSON"));
    lines.filter(|value: &Value| value["kind"] == kind).collect()
}

fn run(scratch: &Scratch, arguments: &[String]) -> Output {
    let mut all = vec!["run".to_owned()];
    all.extend_from_slice(arguments);
    cc67(scratch, all)
}

/// A program that keeps a thread busy forever.
const BUSY: &str = "main() { for (;;) ; }\n";

/// Runs `statements` in thread 1 while other threads are busy; they fill `g[]`, whose first `count` values are printed.
fn times(statements: &str, others: &[u64], count: usize) -> Vec<f64> {
    let name: String =
        statements.bytes().map(u32::from).fold(0u32, |a, b| a.wrapping_mul(31) + b).to_string();
    let scratch = Scratch::new(&format!("times-{name}-{}", others.len()));
    let source = format!(
        "#include \"KMotionDef.h\"\ndouble g[200];\nmain()\n{{\n  int i, t0; double T;\n  \
         {statements}\n  for (i = 0; i < {count}; i++) printf(\"%.9f\\n\", g[i]);\n  persist.UserData[9] = 1;\n}}\n"
    );
    // The other threads end with thread 1, so that the run ends by itself.
    let busy = "#include \"KMotionDef.h\"\nmain() { while (!persist.UserData[9]) ; }\n";
    scratch.write("a.c", source).write("busy.c", busy);
    let mut arguments = vec!["1:a.c".to_owned()];
    arguments.extend(others.iter().map(|thread| format!("{thread}:busy.c")));
    let output = run(&scratch, &arguments);
    assert_eq!(output.code, 0, "{output:?}");
    output.stdout.lines().map(|line| line.parse().expect("a number a line")).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|v| v.as_f64().expect("a number")).collect()
}

#[test]
fn slices_rotate_as_on_the_board() {
    let vectors = vectors("rotation");
    assert_eq!(vectors.len(), 10);
    for vector in vectors {
        let active: Vec<u64> =
            vector["active"].as_array().expect("threads").iter().filter_map(Value::as_u64).collect();
        let expect = vector["slices"].as_str().expect("digits");
        if active.is_empty() {
            continue; // without a program nothing can observe the primary thread's slices
        }
        // Every thread notes the tick of each of its slices; the order of ticks is the order of slices.
        let scratch = Scratch::new(&format!("rotation-{expect}"));
        let mut source = String::from("#include \"KMotionDef.h\"\nmain()\n{\n  int n; double last = 0;\n");
        source.push_str("  for (n = 0; n < 60; ) if (ServoTick != last) { last = ServoTick; n++;\n");
        source.push_str(
            "    if (last >= 1000) gather_buffer[(int)last - 1000] = CurrentThread; else n = 0; }\n",
        );
        // Only one thread prints: a newline from another thread would also end its line.
        source.push_str("  Delay_sec(1.0); if (CurrentThread != FIRST) return; for (n = 0; n < 40; n++)\n");
        source.push_str("    printf(\"%d\", (int)gather_buffer[10 + n]);\n  printf(\"\\n\");\n}\n");
        scratch.write("a.c", source);
        let mut arguments = vec![format!("-DFIRST={}", active[0])];
        arguments.extend(active.iter().map(|thread| format!("{thread}:a.c")));
        let output = run(&scratch, &arguments);
        let seen = output.stdout.lines().find(|line| !line.is_empty()).unwrap_or_default();
        // The measurement begins anywhere in the rotation; so does this one.
        let period = active.len() + 1;
        let matches =
            (0..period).any(|shift| seen.get(shift..shift + 30).is_some_and(|part| expect.starts_with(part)));
        assert!(matches, "active {active:?}: measured {expect}, simulated {seen}\n{output:?}");
    }
}

#[test]
fn waits_and_delays_take_the_measured_times() {
    let mut compared = 0;
    for vector in vectors("times") {
        let (name, program) =
            (vector["name"].as_str().expect("text"), vector["program"].as_str().expect("text"));
        let others: Vec<u64> =
            vector["other_threads"].as_array().expect("threads").iter().filter_map(Value::as_u64).collect();
        let measured = numbers(&vector["values"]);
        if name == "ServoTick growth over Delay_sec(0.09)" || name == "CurrentThread as read by thread 1" {
            assert_eq!(times(program, &others, 1), measured, "{name}");
            compared += 1;
            continue;
        }
        let simulated = times(program, &others, measured.len());
        let (measured, simulated) = if name == "WaitNextTimeSlice returns" {
            (differences(&measured), differences(&simulated))
        } else if name == "TIMER0 per WaitNextTimeSlice" {
            // Counts of 20 ns; the first is the counter itself.
            (scaled(&measured[1..], 20e-9), scaled(&simulated[1..], 20e-9))
        } else {
            (measured, simulated)
        };
        for (index, (measured, simulated)) in measured.iter().zip(&simulated).enumerate() {
            // The time at which a busy loop loses the processor depends on the cost of its instructions.
            if name.starts_with("consecutive") && (*measured > TICK || *simulated > TICK) {
                continue;
            }
            let difference = (measured - simulated).abs();
            let allowed = if index == 0 {
                FIRST_TOLERANCE
            } else if name == AFTER_THREAD_0 {
                THREAD_0_TOLERANCE
            } else {
                TOLERANCE
            };
            assert!(
                difference < allowed,
                "{name}, others {others:?}, value {index}: measured {measured}, simulated {simulated}"
            );
        }
        compared += 1;
    }
    assert_eq!(compared, 23);
}

fn differences(values: &[f64]) -> Vec<f64> {
    values.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

/// The program of thread 2 in the measured scenarios: it counts starts in a global and a static, then counts forever.
const SECOND: &str = "#include \"KMotionDef.h\"\nint g = 5; int s = 7;\nmain()\n{\n  g++; s++;\n  \
    persist.UserData[20] = g; persist.UserData[21] = s; persist.UserData[22] = 0;\n  persist.UserData[23]++;\n";

#[test]
fn start_pause_resume_and_locks_behave_as_measured() {
    for vector in vectors("scenario") {
        let name = vector["name"].as_str().expect("text");
        let program = vector["program"].as_str().expect("text");
        let scratch = Scratch::new(&format!("scenario-{}", name.len() * 1000 + program.len()));
        // In the scenarios about threads that ended, thread 2's program returns.
        let ends = name.contains("re-run") || name.contains("ended");
        let second = if ends {
            format!("{SECOND}}}\n")
        } else {
            format!("{SECOND}  for (;;) persist.UserData[24]++;\n}}\n")
        };
        let mut report = String::new();
        let expected = vector["UserData"].as_object().expect("an object");
        // The value of a busy counter depends on instruction costs, so it cannot be the same here.
        let compared: Vec<_> =
            expected.iter().filter(|(_, value)| value.as_i64().is_some_and(|v| v < 20_000)).collect();
        for (index, _) in &compared {
            let _ = write!(report, "printf(\"{index}=%d\\n\", persist.UserData[{index}]); ");
        }
        // ThreadDone ends the caller; then a third thread reports.
        let source = format!("#include \"KMotionDef.h\"\nmain()\n{{\n  {program}\n}}\n");
        let reporter = format!("#include \"KMotionDef.h\"\nmain()\n{{\n  Delay_sec(0.2); {report}\n}}\n");
        scratch.write("a.c", source).write("second.c", second).write("report.c", reporter);
        let arguments = ["--for", "0.3", "1:a.c", "--load", "2:second.c", "7:report.c"].map(str::to_owned);
        let output = run(&scratch, &arguments);
        let mut expect = String::new();
        for (index, value) in compared {
            let _ = writeln!(expect, "{index}={value}");
        }
        // The board stops, so no thread reports.
        if name.contains("never ran") {
            assert!(output.stderr.contains("the released firmware stops"), "{name}: {output:?}");
            expect.clear();
        }
        assert_eq!(output.stdout, expect, "{name}: {output:?}");
    }
}

#[test]
fn a_lock_makes_increments_of_two_threads_add_up() {
    let scratch = Scratch::new("locked");
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  int i, x;\n  for (i = 0; i < 20000; i++) {\n    \
        MutexLock(&persist.UserData[1]); x = persist.UserData[0]; x++; persist.UserData[0] = x;\n    \
        MutexUnlock(&persist.UserData[1]);\n  }\n  persist.UserData[2]++;\n  while (persist.UserData[2] < 2) ;\n  \
        printf(\"%d\\n\", persist.UserData[0]);\n}\n";
    scratch.write("a.c", source);
    let output = run(&scratch, &["a.c".to_owned(), "a.c".to_owned()]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "40000\n40000\n"), "{output:?}");
}

#[test]
fn a_busy_thread_does_not_block_another() {
    let scratch = Scratch::new("busy");
    scratch
        .write("a.c", BUSY)
        .write("b.c", "#include \"KMotionDef.h\"\nmain() { printf(\"through\\n\"); }\n");
    let output = run(&scratch, &["--for", "0.01", "a.c", "b.c"].map(str::to_owned));
    assert_eq!(output.stdout, "through\n");
}
