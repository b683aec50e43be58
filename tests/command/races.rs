//! Threads that share memory: split as on the board, and watched.

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
