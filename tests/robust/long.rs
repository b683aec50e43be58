//! Long runs: they take no more memory than short ones, and do not become slower.
//!
//! A normal test run takes a small part of the length. For the whole length, with the measurements: `CC67_LONG=1 cargo
//! test --release -p cc67-tests --test robust --test command -- --nocapture`.

#![cfg(target_os = "linux")]

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::thread;
use std::time::Duration;

use harness::usage::Usage;
use harness::{Scratch, is_long};

/// The memory limit in kilobytes for a run of programs of normal size, traced or not.
const MEMORY: u64 = 64 * 1024;

/// The memory limit for any run, as stated in the chapter on limits.
const MOST: u64 = 512 * 1024;

/// The allowed fluctuation between two measurements of a process, in kilobytes.
const BREATH: u64 = 1024;

fn start(scratch: &Scratch, arguments: &[&str]) -> Child {
    Command::new(harness::command())
        .args(arguments)
        .current_dir(scratch.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command under test starts")
}

#[test]
fn a_million_lines_on_the_console_take_no_more_memory_than_a_few() {
    let count = if is_long() { 1_000_000 } else { 10_000 };
    let scratch = Scratch::new("long-console");
    let source = "main() { int i; for (i = 0; i < COUNT; i++) printf(\"line %d of a console that nobody can read to its end\\n\", i); }\n";
    scratch.write(
        "lines.c",
        format!("#include \"KMotionDef.h\"\n{}", source.replace("COUNT", &count.to_string())),
    );
    let mut child = start(&scratch, &["run", "--for", "1000000", "lines.c"]);
    let lines = BufReader::new(child.stdout.take().expect("it is piped")).lines();
    let (mut first, mut last) = (None, None);
    for (index, line) in lines.enumerate() {
        assert_eq!(
            line.expect("it is text"),
            format!("line {index} of a console that nobody can read to its end")
        );
        // The remaining lines do not fit in a pipe, so the process still runs.
        if (index + 1) % (count / 10) == 0 && index < count / 10 * 8 {
            last = Some(Usage::of(child.id()));
            first = first.or(last);
        }
    }
    assert!(child.wait().expect("it ends").success());
    let (first, last) = first.zip(last).expect("there were lines");
    println!("{count} lines: {first:?} after a tenth, {last:?} after eight");
    assert!(last.peak < MEMORY, "{last:?}");
    assert!(last.peak <= first.peak + BREATH, "{first:?}, {last:?}");
}

/// Three programs that serve a machine forever: one checks a door in every slice, one blinks, one counts seconds.
const SERVICES: [(&str, &str); 3] = [
    (
        "door.c",
        "main() { int open = 0; for (;;) { WaitNextTimeSlice(); if (ReadBit(46) != open) { open = !open; SetStateBit(47, open); } } }",
    ),
    (
        "blink.c",
        "main() { for (;;) { Delay_sec(0.5); SetStateBit(48, !ReadBit(48)); persist.UserData[10]++; } }",
    ),
    (
        "lube.c",
        "main() { double next = Time_sec(); for (;;) { next += 10; while (Time_sec() < next) WaitNextTimeSlice(); persist.UserData[11]++; } }",
    ),
];

/// A conversation with a console: each line that is sent gets one line as its reply.
struct Conversation {
    child: Child,
    answers: BufReader<ChildStdout>,
}

impl Conversation {
    fn ask(&mut self, line: &str) -> String {
        let input = self.child.stdin.as_mut().expect("it is piped");
        writeln!(input, "{line}").expect("somebody reads");
        let mut answer = String::new();
        self.answers.read_line(&mut answer).expect("it is text");
        answer.trim().to_owned()
    }
}

#[test]
fn three_service_programs_serve_for_a_day_without_growing_or_slowing_down() {
    let hour = if is_long() { 3600 } else { 3 };
    let scratch = Scratch::new("long-day");
    for (name, source) in SERVICES {
        scratch.write(name, format!("#include \"KMotionDef.h\"\n{source}\n"));
    }
    let mut child = start(&scratch, &["console", "door.c", "blink.c", "lube.c"]);
    let answers = BufReader::new(child.stdout.take().expect("it is piped"));
    let mut console = Conversation { child, answers };
    let mut usages = Vec::new();
    for passed in 0..=24 {
        if passed > 0 {
            console.ask(&format!("wait {hour}\ntime"));
        }
        usages.push(Usage::of(console.child.id()));
    }
    // Each has done all its work.
    let seconds = 24 * hour;
    let count = |answer: String| answer.parse::<i32>().unwrap_or_else(|_| panic!("{answer}"));
    assert!((count(console.ask("GetPersistDec 11")) - seconds / 10).abs() <= 1);
    assert!((count(console.ask("GetPersistDec 10")) - seconds * 2).abs() <= seconds / 50 + 2);
    drop(console.child.stdin.take());
    // The programs never end: the console reports it, and stops.
    console.child.kill().expect("it runs");
    console.child.wait().expect("it ends");

    let cost = |index: usize| usages[index].cpu - usages[index - 1].cpu;
    println!("24 times {hour} s of board time: {:?} at the start, {:?} at the end", usages[0], usages[24]);
    println!("processor time of the first {:?}, of the last {:?}", cost(1), cost(24));
    assert!(usages[24].peak < MEMORY, "{usages:?}");
    assert!(usages[24].peak <= usages[1].peak + BREATH, "{usages:?}");
    // Another process may slow down a short period.
    let halves = [1..13, 13..25].map(|half| half.map(cost).sum::<Duration>());
    assert!(halves[1] < 2 * halves[0], "{halves:?}");
}

/// A run that takes much memory.
struct Heavy {
    name: &'static str,
    source: String,
    options: &'static [&'static str],
    /// The limit in kilobytes.
    most: u64,
}

/// Eight axes that move forever, and a bit that changes in every slice.
const AXES: &str = "main() { int i; for (i = 0; i < 8; i++) { chan[i].InputMode = NO_INPUT_MODE;
    chan[i].OutputMode = NO_OUTPUT_MODE; chan[i].Vel = 1000; chan[i].Accel = 1e4; chan[i].Jerk = 1e5; EnableAxisDest(i, 0); }
    for (i = 0;; i = 100 - i) { Move(0, i); Move(1, i); Move(2, i); Move(3, i); Move(4, i); Move(5, i); Move(6, i); Move(7, i);
    while (!CheckDone(7)) { SetBit(46); WaitNextTimeSlice(); ClearBit(46); } } }";

fn heavy() -> Vec<Heavy> {
    let statements = |count: usize| -> String {
        (0..count)
            .map(|index| format!("at[{}] = {index}.5 + at[{}];\n", index % 8, (index + 3) % 8))
            .collect()
    };
    let functions: String = (0..1200)
        .map(|n| format!("int f{n}(int x) {{ int j, s = 0; for (j = 0; j < x; j++) {{ s += at[j & 7] * {n}; if (s > {n}) s -= x; }} return s; }}\n"))
        .collect();
    let calls: String = (0..1200).map(|n| format!("s += f{n}({});\n", n % 9)).collect();
    let seconds: &[&str] = if is_long() { &["--for", "3600"] } else { &["--for", "1"] };
    let traced: &[&str] =
        if is_long() { &["--for", "600", "--trace", "a.vcd"] } else { &["--for", "0.3", "--trace", "a.vcd"] };
    let drawn: &[&str] =
        if is_long() { &["--for", "600", "--plot", "a.html"] } else { &["--for", "1", "--plot", "a.html"] };
    vec![
        Heavy { name: "axes", source: AXES.to_owned(), options: seconds, most: MEMORY },
        Heavy { name: "traced", source: AXES.to_owned(), options: traced, most: MEMORY },
        Heavy { name: "drawn", source: AXES.to_owned(), options: drawn, most: MOST },
        Heavy {
            name: "memory",
            source: "main() { char *p; for (p = (char *)0x80200000; p < (char *)0x80FE0000; p += 512) *p = 1; }".to_owned(),
            options: &[],
            most: MEMORY,
        },
        Heavy {
            name: "stacks",
            source: "int deep(int n) { int a[4]; a[n & 3] = n; if (n > 560) for (;;) ; return deep(n + 1) + a[n & 3]; }
                main() { deep(0); }"
                .to_owned(),
            options: &["--for", "1", "2:program.c", "3:program.c", "4:program.c", "5:program.c", "6:program.c", "7:program.c"],
            most: MEMORY,
        },
        Heavy {
            name: "long function",
            source: format!("double at[8];\nmain() {{ {} }}", statements(9000)),
            options: &[],
            most: MOST,
        },
        Heavy {
            name: "many functions",
            source: format!("double at[8];\n{functions}\nmain() {{ int s = 0; {calls} at[0] = s; }}"),
            options: &[],
            most: MOST,
        },
        Heavy {
            name: "flooded serial port",
            source: "main() { EnableRS232Cmds(RS232_BAUD_38400); DoRS232Cmds = FALSE; for (;;) RS232_GetChar(); }".to_owned(),
            options: &["--uart", "run:yes", "--for", "1"],
            most: MEMORY,
        },
        Heavy {
            name: "lines",
            source: "main() { char line[200]; int i; for (i = 0; i < 199; i++) line[i] = 'x'; line[199] = 0;
                for (i = 0; i < 5000; i++) printf(\"%s\\n\", line); }"
                .to_owned(),
            options: &["--stim", "at 0.1s expect not printed \"y\""],
            most: MEMORY,
        },
    ]
}

#[test]
fn runs_stay_within_their_memory_whatever_they_do() {
    for Heavy { name, source, options, most } in heavy() {
        let scratch = Scratch::new(&format!("long-{}", name.replace(' ', "-")));
        scratch.write("program.c", format!("#include \"KMotionDef.h\"\n{source}\n"));
        let arguments = [&["run"], options, &["1:program.c"]].concat();
        let mut child = start(&scratch, &arguments);
        let mut output = child.stdout.take().expect("it is piped");
        let reader = thread::spawn(move || std::io::copy(&mut output, &mut std::io::sink()));
        let mut peak = 0;
        let status = loop {
            if let Some(status) = child.try_wait().expect("it can be asked") {
                break status;
            }
            peak = Usage::of_running(child.id()).map_or(peak, |usage| usage.peak.max(peak));
            thread::sleep(Duration::from_millis(2));
        };
        reader.join().expect("it does not panic").expect("it reads");
        println!("{name}: {} MB", peak / 1024);
        assert!(status.success(), "{name}: {status}");
        assert!(peak < most, "{name}: {peak} kB");
    }
}
