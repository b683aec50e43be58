//! A newcomer's first steps with a machine, from `init` to a homing run that is blessed, then broken, then caught; each
//! step uses no more than the output of the steps before.

use std::fs;

use harness::{Output, Scratch, cc67};

/// A folder in which one works.
struct Bench {
    scratch: Scratch,
}

impl Bench {
    /// Does a step; what it ends with.
    fn step<'a>(&self, arguments: impl AsRef<[&'a str]>, code: i32) -> Output {
        let arguments = arguments.as_ref();
        let output = cc67(&self.scratch, arguments);
        assert_eq!(output.code, code, "{arguments:?}: {}{}", output.stdout, output.stderr);
        output
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.scratch.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn replace(&self, name: &str, from: &str, to: &str) {
        let text = self.read(name);
        assert!(text.contains(from), "{from} in {name}");
        fs::write(self.scratch.path().join(name), text.replace(from, to)).expect("it is ours");
    }
}

#[test]
fn a_homing_run_is_blessed_then_broken_then_caught() {
    let bench = Bench { scratch: Scratch::new("trial") };

    // 1. A project with a homing program; the answer says how to go on.
    let made = bench.step(["init", "--example", "homing", "mill"], 0);
    assert!(
        made.stdout.contains(&harness::native("cc67 run mill/homing.c"))
            && made.stdout.contains("cc67 test mill"),
        "{}",
        made.stdout
    );

    // 2. It runs with its machine and its stimulus, and says that it uses them.
    let run = bench.step(["run", "mill/homing.c"], 0);
    assert_eq!(run.stdout, "1300 counts from the switch to the index\nX waits at 2000\n");
    assert!(
        run.stderr.contains("mill/homing.toml; mill/homing.stim (--no-sidecar ignores it)"),
        "{}",
        run.stderr
    );

    // 3. Its tests pass.
    assert_eq!(bench.step(["test", "mill"], 0).stdout, "2 passed, 0 failed\n");

    // 4. Without its machine the axis waits for a switch that nobody closes.
    assert!(bench.step(["run", "--no-sidecar", "mill/homing.c"], 4).stderr.contains("bit 136"));

    // 5. The program or a misspelt word in place of a subcommand gets an answer.
    assert!(bench.step(["mill/homing.c"], 2).stderr.contains("cc67 run mill/homing.c"));
    assert!(bench.step(["rnu", "mill/homing.c"], 2).stderr.contains("`run`"));

    // 6. The state in which it leaves the machine, for people and for tools.
    let state = bench.step(["run", "--state", "mill/homing.c"], 0).stderr;
    assert!(state.contains("cc67: final state: axis 0 enabled, dest 2000"), "{state}");
    let json = bench.step(["run", "--json", "mill/homing.c"], 0).stdout;
    let end: serde_json::Value =
        serde_json::from_str(json.lines().last().unwrap_or_default()).expect("an object");
    assert_eq!((&end["type"], &end["axes"][0]["dest"]), (&"end".into(), &2000.0.into()), "{end}");

    // 7. It is changed, and the new console is blessed.
    bench.replace("mill/homing.c", "X waits at", "X is at");
    let failed = bench.step(["test", "mill"], 1).stdout;
    assert!(failed.contains("  - X waits at 2000\n  + X is at 2000\n"), "{failed}");
    assert!(
        bench.step(["test", "--bless", "mill/homing.c"], 0).stdout.contains("written  mill/homing.expected")
    );
    bench.step(["test", "mill"], 0);

    // 8. A new expectation that is met.
    let stimulus =
        bench.read("mill/homing.stim") + "within 5s of printed \"switch\" expect printed \"X is at\"\n";
    fs::write(bench.scratch.path().join("mill/homing.stim"), stimulus).expect("it is ours");
    bench.step(["test", "mill"], 0);

    // 9. The machine breaks: the switch has moved, and the run is caught with what was and what should be.
    bench.replace("mill/homing.toml", "<= -9300", "<= -15000");
    let broken = bench.step(["run", "mill/homing.c"], 5).stderr;
    assert!(broken.contains("axis 0 load is -"), "{broken}");
    assert!(broken.contains(", expected never < -10000"), "{broken}");
    let failed = bench.step(["test", "--junit", "report.xml", "mill"], 1).stdout;
    assert!(failed.contains("FAILED   mill/homing") && failed.contains("---- exit 5"), "{failed}");

    // 10. The report of CI names it, with its class and its time.
    let report = bench.read("report.xml");
    assert!(report.contains("<testcase classname=\"mill\" name=\"homing\" time=\""), "{report}");
    assert!(report.contains("expected never"), "{report}");

    // 11. What is broken is not blessed unless one insists.
    let refused = bench.step(["test", "--bless", "mill/homing.c"], 1).stdout;
    assert!(refused.contains("--force") && refused.contains("axis 0 load is -"), "{refused}");
    bench.replace("mill/homing.toml", "<= -15000", "<= -9300");
    bench.step(["test", "mill"], 0);

    // 12. A program with a mistake is not blessed at all.
    bench.replace("mill/homing.c", "Zero(AXIS);", "Zero(AXS);");
    let refused = bench.step(["test", "--bless", "--force", "mill/homing.c"], 1).stdout;
    assert!(refused.contains("it does not compile") && refused.contains("`AXS`"), "{refused}");
    let json = bench.step(["run", "--json", "mill/homing.c"], 1).stdout;
    assert!(json.starts_with("{\"type\":\"end\",\"reason\":\"compile error\",\"exit\":1,"), "{json}");
    bench.replace("mill/homing.c", "Zero(AXS);", "Zero(AXIS);");

    // 13. Options that are wrong say what is wanted.
    let set = bench.step(["run", "--set", "persist.10=1,5", "mill/homing.c"], 2).stderr;
    assert!(set.contains("write f:1.5 for a float"), "{set}");
    let trace = bench.step(["run", "--trace", "a.xlsx", "mill/homing.c"], 2).stderr;
    assert!(trace.contains("known: .csv, .txt, .vcd, .json and .json.gz"), "{trace}");

    // 14. A project file for the whole folder, and a program that runs before.
    fs::write(bench.scratch.path().join("mill/cc67.toml"), "first = \"first.c\"\n[test]\njobs = 1\n")
        .expect("it is ours");
    let run = bench.step(["run", "mill/homing.c"], 0);
    assert!(
        run.stdout.starts_with("at 2000 after ") && run.stdout.ends_with("X is at 2000\n"),
        "{}",
        run.stdout
    );
    fs::remove_file(bench.scratch.path().join("mill/cc67.toml")).expect("it is there");

    // 15. Other examples come with the command and stand alone.
    assert!(bench.step(["examples"], 0).stdout.contains("\n  tool_length "));
    for example in ["probe", "spindle", "toolchange"] {
        bench.step(["init", "--example", example, example], 0);
        assert_eq!(bench.step(["test", example], 0).stdout, "2 passed, 0 failed\n", "{example}");
    }
    bench.step(["examples", "css", "copies"], 0);
    assert_eq!(bench.step(["test", "copies"], 0).stdout, "1 passed, 0 failed\n");
}
