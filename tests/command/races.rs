//! Threads that share memory: split as on the board, and watched.

use std::path::Path;

use harness::{Scratch, cc67};

const COUNT: &str = "#include \"KMotionDef.h\"\nmain()\n{\n    int i;\n    for (i = 0; i < 20000; i++)\n        \
     persist.UserData[40]++;\n    persist.UserData[40 + CurrentThread] = 1;\n    while (!persist.UserData[41] || \
     !persist.UserData[42])\n        WaitNextTimeSlice();\n    if (CurrentThread == 1)\n        printf(\"%d\\n\", \
     persist.UserData[40]);\n}\n";

#[test]
fn updates_are_lost_as_on_the_board_and_the_same_on_every_engine() {
    let scratch = Scratch::new("races-as-board");
    scratch.write("a.c", COUNT);
    let run = |options: &[&str]| {
        let output = cc67(&scratch, [&["run", "1:a.c", "2:a.c"], options].concat());
        assert_eq!(output.code, 0, "{options:?}: {}", output.stderr);
        output
    };
    for engine in ["bytecode", "native"] {
        let fast = run(&["--engine", engine]);
        assert_eq!(fast.stdout, "40000\n");
        assert!(fast.stderr.contains("Statements were not split"), "{}", fast.stderr);
    }
    let split = ["bytecode", "native"].map(|engine| run(&["--as", "board", "--engine", engine]));
    assert_eq!(split[0].stdout, split[1].stdout);
    assert_eq!(split[0].stderr, "");
    let count: i32 = split[0].stdout.trim().parse().expect("a number");
    assert!((20_000..39_500).contains(&count), "{count}");
    assert_eq!(run(&["--as", "board", "--no-shortcuts"]).stdout, split[0].stdout);
    let refused = cc67(&scratch, ["run", "a.c", "--as", "board", "--profile"]);
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("leave one out"), "{}", refused.stderr);
}

/// The rates at which the released firmware loses updates with this code, at three levels of optimisation, were measured
/// on it without waits for memory.
#[test]
fn code_of_the_processor_loses_as_much_as_on_the_released_firmware() {
    let scratch = Scratch::new("races-rate");
    scratch.write("a.c", COUNT.replace("20000", "1000000"));
    for (level, measured) in [("-O0", 0.301), ("-O1", 0.282), ("-O2", 0.0708)] {
        let lost = |engine: &str| {
            let options = ["--as", "board", "--timing", "cc67", "--wait-states", "none", "--engine", engine];
            let output = cc67(&scratch, ["run", "1:a.c", "2:a.c", level].into_iter().chain(options));
            assert_eq!(output.code, 0, "{}", output.render());
            let count: f64 = output.stdout.trim().parse().expect("a number");
            1.0 - count / 2_000_000.0
        };
        let lost = ["bytecode", "native"].map(lost);
        assert_eq!(lost[0], lost[1]);
        assert!((lost[0] - measured).abs() < 0.1 * measured, "{level}: {lost:?}");
    }
}

#[test]
fn a_race_is_reported_with_both_places_and_the_cell() {
    let scratch = Scratch::new("races-report");
    scratch.write("a.c", COUNT).write("b.c", COUNT.replace("40]++", "40] += 1"));
    let output = cc67(&scratch, ["run", "a.c", "b.c", "--races", "--as", "board"]);
    assert_eq!(output.code, 0, "{}", output.stderr);
    for part in ["a.c:6:", "b.c:6:", "both change persist.UserData[40]", "MutexLock"] {
        assert!(output.stderr.contains(part), "{part}: {}", output.stderr);
    }
    assert_eq!(cc67(&scratch, ["run", "a.c", "b.c", "--as", "board"]).stderr, "");
}

#[test]
fn a_test_as_on_the_board_fails_where_statements_must_not_be_split() {
    let scratch = Scratch::new("races-test");
    let test = |also: &str| format!("// cc67: run also 2:{also}\n{COUNT}");
    scratch.write("a.c", test("b.c")).write("a.expected", "40000\n").write("b.c", COUNT);
    assert_eq!(cc67(&scratch, ["test", "a.c"]).code, 0);
    let output = cc67(&scratch, ["test", "a.c", "--as", "board"]);
    assert_eq!(output.code, 1, "{}", output.stdout);
    assert!(output.stdout.contains("as on the board"), "{}", output.stdout);
}

/// The remarks of the detector, and what they name: both places and the cell.
#[test]
fn twenty_racy_programs_are_reported_with_both_lines_and_twenty_correct_ones_are_not() {
    for (folder, is_racy) in [("racy", true), ("correct", false)] {
        let folder = harness::root().join("tests/data/races").join(folder);
        let firsts =
            harness::files(&folder, "c").into_iter().filter(|path| path.to_string_lossy().ends_with(".1.c"));
        let firsts: Vec<_> = firsts.collect();
        assert!(firsts.len() >= 20, "{}", firsts.len());
        for first in firsts {
            let name = first.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
            let second = name.replace(".1.c", ".2.c");
            let has_second = folder.join(&second).exists();
            let programs = [&name, &second].into_iter().take(1 + usize::from(has_second));
            let texts: Vec<_> = programs
                .map(|name| (name, std::fs::read_to_string(folder.join(name)).expect("it is there")))
                .collect();
            for options in [&["--as", "board"][..], &["--as", "board", "-O0"], &[]] {
                let found = reports(&folder, texts.iter().map(|(name, _)| name.as_str()), options);
                if !is_racy {
                    assert_eq!(found, [""; 0], "{name} {options:?}");
                    continue;
                }
                let (code, cell) = texts[0]
                    .1
                    .lines()
                    .next()
                    .and_then(|line| line[3..].split_once(':'))
                    .expect("the expected report");
                let names_lines = |line: &String| {
                    texts.iter().all(|(name, text)| {
                        let mut places = text
                            .lines()
                            .zip(1..)
                            .filter(|(line, _)| line.contains("// <-"))
                            .map(|(_, number)| format!("{name}:{number}:"))
                            .peekable();
                        places.peek().is_none() || places.any(|place| line.contains(&place))
                    })
                };
                let is_expected = |line: &String| {
                    line.contains(&format!("\"{code}\"")) && line.contains(cell.trim()) && names_lines(line)
                };
                assert!(found.iter().any(is_expected), "{name} {options:?}: {found:#?}");
            }
        }
    }
}

#[test]
fn the_texts_of_programs_are_compared() {
    let folder = harness::root().join("tests/data/races");
    let advice = |first: &str| {
        let second = first.replace(".1.c", ".2.c");
        let programs = [format!("1:{first}"), format!("2:{second}")];
        let number = 1 + usize::from(folder.join(second).exists());
        let output = cc67(&folder, ["check".to_owned()].into_iter().chain(programs.into_iter().take(number)));
        assert_eq!(output.code, 0, "{first}: {}", output.stderr);
        output.stderr
    };
    for path in harness::files(&folder.join("correct"), "c") {
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
        if name.ends_with(".1.c") {
            assert_eq!(advice(&format!("correct/{name}")), "", "{name}");
        }
    }
    for (name, parts) in [
        (
            "counter",
            ["persist.UserData[5] is changed by a load and a store", "racy/counter.2.c:7:5", "MutexLock"],
        ),
        ("bit_word", ["VirtualBits is changed", "racy/bit_word.2.c:11:9", "AtomicSet"]),
        (
            "bit_field",
            ["persist.UserData[55] is changed", "racy/bit_field.2.c:16:9", "an update can be lost"],
        ),
        (
            "float_total",
            ["persist.UserData[70] is changed", "racy/float_total.2.c:9:9", "an update can be lost"],
        ),
        (
            "half_word",
            ["persist.UserData[50] is changed", "racy/half_word.2.c:11:13", "an update can be lost"],
        ),
        (
            "callback",
            ["pulses is changed", "the call-back at racy/callback.1.c:8:5", "must not wait for a lock"],
        ),
        ("reset", ["persist.UserData[42] is changed", "racy/reset.2.c:11:9", "is wiped out"]),
        (
            "torn_double",
            ["the eight bytes of persist.UserData[60]", "racy/torn_double.2.c:11:9", "half of the value"],
        ),
        ("counter_pointer", ["persist.UserData[90] is changed", "racy/counter_pointer.2.c:5:5", "MutexLock"]),
        ("lock_forgotten", ["persist.UserData[5] is changed", "racy/lock_forgotten.2.c:10:9", "MutexLock"]),
    ] {
        let said = advice(&format!("racy/{name}.1.c"));
        assert!(parts.iter().all(|part| said.contains(part)), "{name}: {said}");
    }
}

#[test]
fn programs_that_run_together_are_compared() {
    let scratch = Scratch::new("races-advice");
    scratch.write("a.c", COUNT).write("b.c", COUNT).write("cc67.toml", "programs = [\"1:a.c\", \"3:b.c\"]");
    let output = cc67(&scratch, ["check"]);
    assert!(output.stderr.contains("thread 3 at b.c:6:"), "{}", output.stderr);
    scratch.write("c.c", format!("// cc67: run also 2:b.c\n{COUNT}"));
    let output = cc67(&scratch, ["check", "c.c"]);
    assert!(output.stderr.contains("thread 2 at b.c:6:"), "{}", output.stderr);
    assert_eq!(cc67(&scratch, ["check", "1:c.c", "2:b.c", "-W", "no-races"]).stderr, "");
    let boss = "#include \"KMotionDef.h\"\nmain()\n{\n    int i;\n    for (i = 1; i <= 3; i++)\n    {\n        \
                persist.UserData[51] = 1;\n        persist.UserData[50] = i * 1000;\n        \
                while (persist.UserData[51]) WaitNextTimeSlice();\n    }\n}\n";
    let mover = "#include \"KMotionDef.h\"\nmain()\n{\n    for (;;)\n    {\n        if (persist.UserData[51])\n        \
                 {\n            Move(0, persist.UserData[50]);\n            persist.UserData[51] = 0;\n        }\n        \
                 WaitNextTimeSlice();\n    }\n}\n";
    scratch.write("boss.c", boss).write("mover.c", mover);
    let output = cc67(&scratch, ["check", "1:boss.c", "2:mover.c"]);
    let early =
        "persist.UserData[51] is set before persist.UserData[50], which thread 2 at mover.c:8:13 reads";
    assert!(output.stderr.contains(early) && output.stderr.contains("boss.c:7:9"), "{}", output.stderr);
    let [flag, value] = ["persist.UserData[51] = 1;", "persist.UserData[50] = i * 1000;"];
    scratch.write("boss.c", boss.replace(flag, "@").replace(value, flag).replace('@', value));
    assert_eq!(cc67(&scratch, ["check", "1:boss.c", "2:mover.c"]).stderr, "");
    let measure = "#include \"KMotionDef.h\"\nmain()\n{\n    *(float *)&persist.UserData[60] = ch0->Position / 80.0;\n}\n";
    let drill = "#include \"KMotionDef.h\"\nmain()\n{\n    double mm = persist.UserData[60];\n    MoveRel(2, mm * 80.0);\n}\n";
    scratch.write("measure.c", measure).write("drill.c", drill);
    let output = cc67(&scratch, ["check", "1:measure.c", "2:drill.c"]);
    let other =
        "persist.UserData[60] is read as an integer, and thread 1 at measure.c:4:5 stores a `float` there";
    assert!(output.stderr.contains(other) && output.stderr.contains("drill.c:4:12"), "{}", output.stderr);
    scratch.write("drill.c", drill.replace("= persist.UserData[60]", "= *(float *)&persist.UserData[60]"));
    assert_eq!(cc67(&scratch, ["check", "1:measure.c", "2:drill.c"]).stderr, "");
    let waits = "#include \"KMotionDef.h\"\nint n;\nvoid f(void)\n{\n    n = 1;\n}\nmain()\n{\n    UserCallBack = f;\n    \
                 while (!n)\n        ;\n}\n";
    scratch.write("w.c", waits);
    let output = cc67(&scratch, ["check", "w.c"]);
    assert!(output.stderr.contains("not `volatile`"), "{}", output.stderr);
    scratch.write("w.c", waits.replace("int n", "volatile int n"));
    assert_eq!(cc67(&scratch, ["check", "w.c"]).stderr, "");
    for path in harness::files(&harness::root().join("c-programs/threads"), "c") {
        let output = cc67(harness::root(), ["check".into(), path.clone().into_os_string()]);
        assert!(!output.stderr.contains("[races]"), "{}: {}", path.display(), output.stderr);
    }
}

/// The reports of the detector in a run of programs, as JSON.
fn reports<'a>(folder: &Path, programs: impl Iterator<Item = &'a str>, options: &[&str]) -> Vec<String> {
    let programs = programs.zip(1..).map(|(program, thread)| format!("{thread}:{program}"));
    let arguments = ["run", "--races", "--json", "--for", "3"].map(str::to_owned).into_iter().chain(programs);
    let arguments: Vec<_> = arguments.chain(options.iter().map(|option| (*option).to_owned())).collect();
    let run = |engine: &str| {
        let engine = ["--engine", engine].map(str::to_owned);
        let output = cc67(folder, arguments.iter().cloned().chain(engine));
        assert_eq!(output.code, 0, "{}", output.render());
        output
    };
    let output = run("native");
    assert_eq!(output.stdout, run("bytecode").stdout, "{arguments:?}");
    let codes = [
        "race-",
        "order-early",
        "read-early",
        "pause-overtaken",
        "lock-order",
        "lock-kept",
        "thread-restarted",
    ];
    let is_report = |line: &&str| codes.iter().any(|code| line.contains(&format!("\"code\":\"{code}")));
    output.stdout.lines().filter(is_report).map(str::to_owned).collect()
}

#[test]
fn the_example_programs_have_no_races_but_those_they_show() {
    let output = cc67(harness::root(), ["test", "c-programs", "--engine", "bytecode", "--", "--races"]);
    assert_eq!(output.code, 0, "{}", output.render());
}
