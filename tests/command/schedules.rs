//! Schedules: errors of order are found, minimised and replayed.

use std::fs;

use harness::{Scratch, cc67};

#[test]
fn errors_of_order_are_found_and_replayed() {
    let scratch = Scratch::new("schedules");
    let folder = harness::root().join("tests/data/orders");
    for entry in fs::read_dir(&folder).expect("the folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        scratch.write(&name, fs::read(&path).expect("it can be read"));
    }
    let plain = cc67(&scratch, ["test", "."]);
    assert_eq!(plain.code, 0, "{}", plain.render());
    let programs = harness::files(scratch.path(), "c");
    let tests: Vec<_> = programs.iter().filter(|path| path.with_extension("expected").exists()).collect();
    assert!(tests.len() >= 10, "{}", tests.len());
    for path in tests {
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
        let output = cc67(&scratch, ["test", name, "--schedules", "2000"]);
        assert_eq!(output.code, 1, "{name}: {}", output.render());
        let schedule = output.stdout.split("--schedule ").nth(1).and_then(|rest| rest.split('`').next());
        let schedule = schedule.expect("the smallest schedule");
        assert!(schedule.matches("switch").count() <= 3, "{name}: {schedule}");
        let expected = fs::read_to_string(path.with_extension("expected")).expect("the expected console");
        let replay = || cc67(&scratch, ["run", name, "--schedule", schedule]);
        let (first, second) = (replay(), replay());
        assert_eq!((&first.stdout, &first.stderr), (&second.stdout, &second.stderr), "{name}");
        let is_loss = first.stderr.contains("lost at") || first.stderr.contains("old at");
        assert!(first.stdout != expected || is_loss, "{name}: {}", first.render());
        let shown = cc67(&scratch, ["test", name, "--", "--schedule", schedule]);
        assert_eq!(shown.code, 1, "{name}: {}", shown.render());
    }
}

#[test]
fn correct_programs_lose_nothing_by_any_schedule() {
    let folder = harness::root().join("tests/data/races/correct");
    let scratch = Scratch::new("schedules-correct");
    scratch.write("none.expected", "");
    let golden = scratch.path().join("none.expected").to_string_lossy().into_owned();
    for path in harness::files(&folder, "c") {
        let first = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        // One program of this pair starts the other.
        if !first.ends_with(".1.c") || first.starts_with("start_thread") {
            continue;
        }
        let second = first.replace(".1.c", ".2.c");
        let number = 1 + usize::from(folder.join(&second).exists());
        let programs = [first.as_str(), second.as_str()].into_iter().take(number);
        let options = ["run", "--for", "0.5", "--explore", "1..9", "--golden", golden.as_str()];
        let output = cc67(&folder, options.into_iter().chain(programs));
        assert_eq!(output.code, 0, "{first}: {}", output.render());
        assert!(!output.stdout.contains("has seen a loss"), "{first}: {}", output.stdout);
    }
}

#[test]
fn a_schedule_is_named_by_its_seed_or_its_parts() {
    let scratch = Scratch::new("schedules-names");
    scratch
        .write("a.c", "#include \"KMotionDef.h\"\nmain() { persist.UserData[5]++; printf(\"done\\n\"); }\n");
    let run = |schedule: &str| cc67(&scratch, ["run", "a.c", "--schedule", schedule]);
    assert_eq!(run("0").stdout, "done\n");
    assert_eq!(run("plain").stderr, "");
    let switched = run("switch2");
    assert_eq!((switched.stdout.as_str(), switched.code), ("done\n", 0));
    let words = "another thread runs between the load and the store by this one of persist.UserData[5]";
    assert!(switched.stderr.contains(words), "{}", switched.stderr);
    assert!(switched.stderr.contains("a.c:2:"), "{}", switched.stderr);
    let refused = run("swich2");
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("`swich2` is not a part of a schedule"), "{}", refused.stderr);
    let script = "break main\ncontinue\ncontinue\nquit\n";
    let debugged = harness::cc67_with_input(&scratch, ["debug", "a.c", "--schedule", "switch2"], script);
    assert!(debugged.stdout.contains("done"), "{}", debugged.render());
}
