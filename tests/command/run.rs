//! The command as users meet it: exit codes, bad input, several threads, determinism.

use std::fmt::Write as _;

use harness::{Output, Scratch, cc67};

/// Runs with one file `a.c` of the given text.
fn run_source(name: &str, source: impl AsRef<[u8]>, arguments: &[&str]) -> Output {
    let scratch = Scratch::new(name);
    scratch.write("a.c", source);
    let mut all = vec!["run"];
    all.extend_from_slice(arguments);
    all.push("a.c");
    cc67(&scratch, &all)
}

/// A message for people: one finding, no trace of the implementation.
fn assert_plain(output: &Output, code: i32, expect: &str) {
    assert_eq!(output.code, code, "{output:?}");
    assert!(output.stderr.contains(expect), "expected {expect:?} in:\n{}", output.stderr);
    for trace in ["panicked", "RUST_BACKTRACE", ".rs:", "overflowed its stack", "unwrap", "os error"] {
        assert!(!output.stderr.contains(trace), "{}", output.stderr);
    }
    assert!(output.stderr.lines().count() <= 16, "more than one message:\n{}", output.stderr);
}

const HELLO: &str = "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"hello\\n\");\n}\n";

#[test]
fn hello_prints_and_succeeds() {
    let output = run_source("hello", HELLO, &[]);
    assert_eq!(output, Output { code: 0, stdout: "hello\n".into(), stderr: String::new() });
}

#[test]
fn a_missing_file_is_named() {
    let scratch = Scratch::new("missing");
    assert_plain(&cc67(&scratch, ["run", "nosuch.c"]), 2, "nosuch.c");
}

#[test]
fn a_folder_is_not_a_program() {
    let scratch = Scratch::new("folder");
    scratch.write("sub/x.c", "");
    assert_plain(&cc67(&scratch, ["run", "sub"]), 2, "sub");
}

#[test]
fn check_reads_machine_files_and_stimuli_beside_programs() {
    let scratch = Scratch::new("check-all");
    scratch.write("a.c", HELLO);
    scratch.write("mill.toml", "[axis.0]\nmodel = \"motor\"\n");
    scratch.write("a.stim", "at 1s bit 136 = 1\n");
    let all = ["check", "a.c", "mill.toml", "a.stim"];
    assert_eq!(cc67(&scratch, all).render(), "---- exit 0\n");
    scratch.write("mill.toml", "[axis.0]\nmodle = \"motor\"\n");
    scratch.write("a.stim", "at 1s bit 136\n");
    let output = cc67(&scratch, all);
    assert_plain(&output, 1, "mill.toml:2:1: unknown key `modle` in `axis.0`; did you mean `model`?");
    assert!(output.stderr.contains("a.stim:1:"), "{}", output.stderr);
}

#[test]
fn an_empty_file_has_no_main() {
    assert_plain(&run_source("empty", "", &[]), 1, "main");
}

#[test]
fn binary_junk_is_refused_once() {
    let junk: Vec<u8> = (0..4096u32).map(|n| (n.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let output = run_source("junk", junk, &[]);
    assert_plain(&output, 1, "a.c is not C source text");
    assert_eq!(output.stderr.lines().count(), 2, "{}", output.stderr);
}

#[test]
fn an_unclosed_comment_points_at_its_start() {
    assert_plain(&run_source("comment", "main() { }\n/* never closed\n", &[]), 1, "a.c:2:1");
}

#[test]
fn a_file_that_includes_itself_hits_a_limit() {
    assert_plain(&run_source("itself", "#include \"a.c\"\nmain() { }\n", &[]), 1, "64");
}

#[test]
fn a_program_with_an_upper_case_suffix_runs() {
    let scratch = Scratch::new("upper-case");
    scratch.write("A.C", HELLO);
    let output = cc67(&scratch, ["run", "A.C"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "hello\n"), "{output:?}");
}

#[test]
fn files_with_windows_paths_are_written_appended_and_read() {
    let source = r#"#include "KMotionDef.h"
main()
{
    double x, y, z;
    int n;
    FILE *f = fopen("C:\\temp\\Points.txt", "wt");
    fprintf(f, "%f,%f,%f\n", 1.5, -2.0, 3.25);
    fclose(f);
    f = fopen("c:\\Temp\\points.txt", "at");
    fprintf(f, "42\n");
    fclose(f);
    f = fopen("c:\\temp\\points.txt", "rt");
    n = fscanf(f, "%lf,%lf,%lf", &x, &y, &z);
    printf("%d %.2f %.2f %.2f\n", n, x, y, z);
    fscanf(f, "%d", &n);
    printf("%d\n", n);
    fclose(f);
}
"#;
    let scratch = Scratch::new("windows-files");
    scratch.write("a.c", source).write("pc/Temp/other.txt", "the folder exists\n");
    let output = cc67(&scratch, ["run", "--files", "pc", "a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "3 1.50 -2.00 3.25\n42\n"), "{output:?}");
}

#[test]
fn a_header_in_the_current_folder_is_found() {
    let scratch = Scratch::new("current-folder");
    scratch.write("here.h", "#define HERE 5\n");
    scratch.write(
        "sub/a.c",
        "#include \"KMotionDef.h\"\n#include \"here.h\"\nmain() { printf(\"%d\\n\", HERE); }\n",
    );
    let output = cc67(&scratch, ["run", "sub/a.c"]);
    assert_eq!(output, Output { code: 0, stdout: "5\n".into(), stderr: String::new() });
}

#[cfg(target_os = "linux")] // Elsewhere two such files cannot exist.
#[test]
fn files_that_differ_only_in_letter_case_are_not_guessed() {
    let scratch = Scratch::new("letter-case");
    scratch.write("tool.h", "#define TOOL 1\n").write("TOOL.h", "#define TOOL 2\n");
    scratch.write("a.c", "#include \"Tool.h\"\nmain() { }\n");
    let output = cc67(&scratch, ["check", "a.c"]);
    assert_plain(&output, 1, "Tool.h");
    assert!(output.stderr.contains("`tool.h`") && output.stderr.contains("`TOOL.h`"), "{}", output.stderr);
    scratch.write("a.c", "#include \"TOOL.h\"\nmain() { return TOOL == 2 ? 0 : 1 / 0; }\n");
    assert_eq!(cc67(&scratch, ["check", "a.c"]).code, 0);
}

#[test]
fn a_header_next_to_the_program_wins_and_its_version_is_reported() {
    let scratch = Scratch::new("local-header");
    scratch.write("KMotionDef.h", "#include \"PC-DSP.h\"\nint printf(const char *format, ...);\n");
    scratch.write("PC-DSP.h", "#define KMOTION_VER \"4.32\"\n#define LOCAL 7\n");
    scratch.write("a.c", "#include \"KMotionDef.h\"\nmain() { printf(\"%d\\n\", LOCAL); }\n");
    let output = cc67(&scratch, ["run", "a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "7\n"), "{output:?}");
    assert!(output.stderr.contains("its version is 4.32"), "{}", output.stderr);
}

#[test]
fn deep_parentheses_have_a_limit() {
    let source = format!("main() {{ int x = {}1{}; }}\n", "(".repeat(10_000), ")".repeat(10_000));
    assert_plain(&run_source("parentheses", source, &[]), 1, "640");
}

#[test]
fn threads_are_one_to_seven_and_hold_one_program_each() {
    let scratch = Scratch::new("threads");
    scratch.write("a.c", HELLO);
    assert_plain(&cc67(&scratch, ["run", "0:a.c"]), 2, "invalid thread number 0");
    assert_plain(&cc67(&scratch, ["run", "8:a.c"]), 2, "invalid thread number 8");
    assert_plain(&cc67(&scratch, ["run", "2:a.c", "2:a.c"]), 2, "two programs for thread 2");
}

#[test]
fn options_that_do_not_exist_are_named() {
    let scratch = Scratch::new("options");
    scratch.write("a.c", HELLO);
    assert_plain(&cc67(&scratch, ["run", "--nosuch", "a.c"]), 2, "--nosuch");
    assert_plain(&cc67(&scratch, ["run", "--set", "persist.200=1", "a.c"]), 2, "persist.UserData");
}

#[test]
fn several_errors_are_reported_in_one_run() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  int x = 1\n  x = Readbit(46);\n  y = 2;\n}\n";
    let output = run_source("several", source, &[]);
    assert_eq!(output.code, 1);
    assert_eq!(output.stdout, "");
    insta::assert_snapshot!(output.stderr);
}

#[test]
fn an_error_inside_a_macro_shows_the_macro() {
    let source = "#include \"KMotionDef.h\"\n#define LAMP(n) SetBitt(46 + n)\nmain()\n{\n  LAMP(1);\n}\n";
    insta::assert_snapshot!(run_source("macro", source, &[]).stderr);
}

#[test]
fn editors_programs_and_the_vendors_software_have_their_own_format() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  int x;\n  if (x = 1) ;\n  y = 2;\n}\n";
    let stderr = |format| {
        let output = run_source(format, source, &["--message-format", format]);
        assert_eq!((output.code, output.stdout.as_str()), (1, ""), "{output:?}");
        output.stderr
    };
    let short = "a.c:5:7: warning: an assignment is used as a condition [assignment-condition]\n\
        a.c:5:14: warning: `if` with an empty body [empty-body]\n\
        a.c:6:3: error: `y` is not declared\n";
    assert_eq!(stderr("short"), short);
    assert!(stderr("vendor").starts_with("a.c:6: `y` is not declared\na.c:5: warning: an assignment"));
    let json = stderr("json");
    assert_eq!(json.lines().count(), 3);
    for line in json.lines() {
        let message: serde_json::Value = serde_json::from_str(line).expect("each line is JSON");
        assert_eq!(message["spans"][0]["file"], "a.c");
    }
}

#[test]
fn an_endless_loop_in_one_thread_does_not_stop_another() {
    let scratch = Scratch::new("endless");
    scratch.write("spin.c", "main() { for (;;) ; }\n").write("a.c", HELLO);
    let output = cc67(&scratch, ["run", "--for", "0.1", "spin.c", "a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "hello\n"), "{output:?}");
}

#[test]
fn the_default_time_limit_has_its_own_exit_code() {
    let output =
        run_source("limit", "#include \"KMotionDef.h\"\nmain() { for (;;) WaitNextTimeSlice(); }\n", &[]);
    assert_eq!(output.code, 4, "{output:?}");
    assert!(output.stderr.contains("60 s"), "{}", output.stderr);
}

#[test]
fn a_wild_pointer_stops_its_thread_only() {
    let scratch = Scratch::new("wild");
    scratch.write("wild.c", "main()\n{\n  int *p = 0;\n  *p = 5;\n}\n").write(
        "a.c",
        "#include \"KMotionDef.h\"\nmain()\n{\n  Delay_sec(0.01);\n  printf(\"alive\\n\");\n}\n",
    );
    let output = cc67(&scratch, ["run", "wild.c", "a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (3, "alive\n"), "{output:?}");
    assert!(output.stderr.contains("thread 1") && output.stderr.contains("wild.c:4"), "{}", output.stderr);
}

#[test]
fn an_unimplemented_function_names_itself() {
    // By its address: a name links to the one of cc67's library.
    let source = "#include \"KMotionDef.h\"\nvoid last(void) {}\nmain()\n{\n  ((int (*)(void (*)(void)))0x80025EDC)(last);\n}\n";
    let output = run_source("tocome", source, &[]);
    assert_eq!(output.code, 3, "{output:?}");
    assert!(output.stderr.contains("atexit"), "{}", output.stderr);
}

#[test]
fn settings_reach_the_program() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"%d %.2f %.1f\\n\", persist.UserData[5],\n    *(float *)&persist.UserData[6], *(double *)&persist.UserData[8]);\n}\n";
    let settings = ["--set", "persist.5=0x10", "--set", "persist.6=f:1.25", "--set", "persist.8=d:2.5"];
    assert_eq!(run_source("settings", source, &settings).stdout, "16 1.25 2.5\n");
}

#[test]
fn board_time_precedes_each_line_on_request() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  Delay_sec(0.5);\n  printf(\"half\\n\");\n}\n";
    let output = run_source("time", source, &["--time"]);
    assert!(output.stdout.starts_with("0.500"), "{}", output.stdout);
    assert!(output.stdout.ends_with(" half\n"), "{}", output.stdout);
}

#[test]
fn runs_are_byte_identical_with_and_without_shortcuts() {
    let mut source = String::from("#include \"KMotionDef.h\"\nmain()\n{\n  int i;\n  double t;\n");
    for n in 0..5 {
        let _ = writeln!(
            source,
            "  for (i = 0; i < 20; i++) {{ t = WaitNextTimeSlice(); persist.UserData[{n}] += i; }}\n  \
             Delay_sec(0.00{n}3); printf(\"%d %.9f %.9f\\n\", persist.UserData[{n}], t, Time_sec());"
        );
    }
    source.push_str("}\n");
    let scratch = Scratch::new("equal");
    scratch.write("a.c", &source).write("b.c", &source);
    let arguments = ["run", "--time", "a.c", "b.c"];
    let first = cc67(&scratch, arguments);
    assert_eq!(first.code, 0, "{first:?}");
    assert_eq!(first.stdout.lines().count(), 10);
    for _ in 0..9 {
        assert_eq!(cc67(&scratch, arguments), first);
    }
    assert_eq!(cc67(&scratch, ["run", "--no-shortcuts", "--time", "a.c", "b.c"]), first);
}

#[test]
fn every_warning_explains_itself() {
    let scratch = Scratch::new("explain");
    for arguments in [
        &["--explain", "stack-size"][..],
        &["check", "--explain", "Stack-Size"],
        &["run", "--explain", "-Wno-stack-size"],
    ] {
        let output = cc67(&scratch, arguments);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{arguments:?}");
        assert!(output.stdout.starts_with("# stack-size\n"), "{}", output.stdout);
        assert!(output.stdout.ends_with("Default: on.\n"), "{}", output.stdout);
    }
    let unknown = cc67(&scratch, ["--explain", "stack-siez"]);
    assert_plain(&unknown, 2, "no page is named `stack-siez`; did you mean `stack-size`?");
    assert_plain(&cc67(&scratch, ["check", "-Wno-formt", "a.c"]), 2, "did you mean `format`?");
}

#[test]
fn all_warnings_are_listed() {
    let scratch = Scratch::new("warnings");
    insta::assert_snapshot!(cc67(&scratch, ["--explain", "warnings"]).stdout);
}

#[test]
fn switches_silence_warnings_or_make_them_errors() {
    let scratch = Scratch::new("switches");
    scratch.write("a.c", "#include \"KMotionDef.h\"\nmain()\n{\n  int x = 0;\n  if (x = 1) SetBit(46);\n}\n");
    for (switch, code, said) in [
        ("-Wall", 0, "warning[assignment-condition]"),
        ("-Werror", 1, "error[assignment-condition]"),
        ("-Werror=assignment-condition", 1, "error[assignment-condition]"),
        ("-Wno-assignment-condition", 0, ""),
        ("-Wno-all", 0, ""),
        ("-w", 0, ""),
    ] {
        let output = cc67(&scratch, ["check", switch, "a.c"]);
        assert_eq!(output.code, code, "{switch}: {}", output.stderr);
        assert!(
            output.stderr.contains(said) && said.is_empty() == output.stderr.is_empty(),
            "{switch}: {}",
            output.stderr
        );
    }
}

#[test]
fn a_json_run_prints_one_object_per_line_and_a_summary() {
    let scratch = Scratch::new("json");
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"say \\\"hi\\\"\\n\");\n  MoveRel(0, 5);\n  *(int *)0 = 1;\n}\n";
    scratch.write("a.c", source);
    let output = cc67(&scratch, ["run", "--json", "a.c"]);
    assert_eq!((output.code, output.stderr.as_str()), (3, ""));
    let lines: Vec<serde_json::Value> =
        output.stdout.lines().map(|line| serde_json::from_str(line).expect(line)).collect();
    let field = |index: usize, name: &str| lines[index][name].clone();
    let kinds: Vec<_> = lines.iter().map(|line| line["type"].as_str().expect("a type")).collect();
    assert_eq!(kinds, ["remark", "trap", "console", "end"]);
    assert_eq!(field(2, "text"), "say \"hi\"");
    assert_eq!(field(0, "code"), "axis-disabled");
    let explained = cc67(&scratch, ["--explain", "axis-disabled"]).stdout;
    assert!(
        explained.starts_with("# axis-disabled\n\nA motion call names an axis that is disabled.\n"),
        "{explained}"
    );
    assert_eq!(field(1, "thread"), 1);
    assert!(field(1, "text").as_str().expect("a text").contains("a.c:6:3 in `main`"), "{}", output.stdout);
    assert!(field(0, "seconds").as_f64().expect("a time") < field(2, "seconds").as_f64().expect("a time"));
    let end = ["reason", "exit", "console_lines", "traps", "remarks"].map(|name| field(3, name).to_string());
    assert_eq!(end, ["\"trapped\"", "3", "1", "1", "1"]);
    assert_eq!(field(3, "active"), serde_json::json!([]));
}

#[test]
fn the_summary_tells_why_a_run_ended() {
    let scratch = Scratch::new("json-end");
    scratch
        .write("end.c", HELLO)
        .write("loop.c", "#include \"KMotionDef.h\"\nmain() { for (;;) WaitNextTimeSlice(); }\n");
    for (arguments, reason, exit, active) in [
        (&["end.c"][..], "ended", 0, "[]"),
        (&["--for", "0.1", "2:loop.c"], "limit", 0, "[2]"),
        // The name of the same in stimuli and in Python.
        (&["--until", "0.1", "2:loop.c"], "limit", 0, "[2]"),
        (&["3:loop.c"], "still running", 4, "[3]"),
        (&["--stim", "expect bit 46=0", "end.c"], "unmet", 5, "[]"),
    ] {
        let output = cc67(&scratch, [&["run", "--json"], arguments].concat());
        assert_eq!(output.code, exit, "{output:?}");
        let end = output.stdout.lines().next_back().expect("a line");
        assert!(
            end.starts_with(&format!("{{\"type\":\"end\",\"reason\":\"{reason}\",\"exit\":{exit},")),
            "{end}"
        );
        assert!(end.contains(&format!(",\"active\":{active},\"axes\":[],")), "{end}");
        assert!(end.ends_with(",\"persist\":{}}"), "{end}");
    }
}

#[test]
fn an_axis_still_jogging_is_named_when_the_run_is_cut_short() {
    let scratch = Scratch::new("jogs-on");
    let source = "#include \"KMotionDef.h\"\nmain() { ch2->OutputMode = STEP_DIR_MODE; EnableAxisDest(2, 0); Jog(2, 100); }\n";
    scratch.write("jog.c", source);
    let output = cc67(&scratch, ["run", "jog.c"]);
    assert_eq!(output.code, 4, "{output:?}");
    assert!(
        output.stderr.contains(
            "cc67: the programs have ended, but axis 2 still moves after 60 s of board time: `Jog(2, 0)` or \
             `DisableAxis(2)` ends a motion; `--for SECONDS` ends the run at a time of your choice, with exit code 0\n"
        ),
        "{output:?}"
    );
    let output = cc67(&scratch, ["run", "--for", "0.5", "jog.c"]);
    assert_eq!(output.code, 0);
    let told = "cc67: at the end, after 0.500 s of board time:\n  axis 2: enabled, Dest 48.225, Position 48, moves at 100 units/s";
    assert!(output.stderr.contains(told), "{output:?}");
}

#[test]
fn a_run_in_real_time_takes_real_time_and_prints_the_same() {
    let scratch = Scratch::new("realtime");
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  int i;\n  for (i = 0; i < 4; i++) { Delay_sec(0.1); printf(\"%f\\n\", Time_sec()); }\n}\n";
    scratch.write("a.c", source);
    let fast = cc67(&scratch, ["run", "--time", "a.c"]);
    #[expect(clippy::disallowed_methods, reason = "the pace is what is tested")]
    let start = std::time::Instant::now();
    let paced = cc67(&scratch, ["run", "--time", "--realtime", "a.c"]);
    let seconds = start.elapsed().as_secs_f64();
    assert_eq!(paced, fast);
    assert!(seconds >= 0.4, "0.4 s of board time took {seconds} s");
}

/// Checks the result of `cargo install`: one file, which contains its headers, its pages and its letters.
#[test]
#[cfg(unix)]
fn the_command_needs_no_file_but_itself() {
    let scratch = Scratch::new("command-alone");
    let command = scratch.path().join("cc67");
    harness::place_command(&command);
    scratch.write("a.c", "#include \"KMotionDef.h\"\nmain() { printf(\"alone %d\\n\", 7 * 6); }\n");
    let run = |arguments: &[&str]| {
        let output = std::process::Command::new(&command)
            .args(arguments)
            .current_dir(scratch.path())
            .env_clear()
            .output()
            .expect("it starts");
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        String::from_utf8(output.stdout).expect("it is text")
    };
    assert!(run(&["--version"]).ends_with("(models KFLOP firmware 4.34)\n"));
    assert_eq!(run(&["run", "--plot", "a.svg", "--watch", "dest0", "a.c"]), "alone 42\n");
    run(&["build", "a.c"]);
    assert_eq!(run(&["run", "a(1).out"]), "alone 42\n");
    assert!(run(&["--explain", "limits"]).contains("user threads"));
    run(&["init", "machine"]);
    assert!(run(&["test", "machine"]).contains("passed"));
}

#[test]
fn a_remark_that_comes_again_and_again_is_shown_once() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  int i, bit = 5000 + persist.UserData[9];\n\
                  for (i = 0; i < 1000; i++) SetBit(bit);\n  SetBit(bit + 1);\n}\n";
    let output = run_source("repeats", source, &[]);
    let remark =
        |place, bit| format!("thread 1 at a.c:{place} in `main`: SetBit({bit}): no such bit (0-2047)");
    let expected = format!(
        "cc67: {}\ncc67: {}\ncc67: repeated 999 times: {}\n",
        remark("5:28", 5000),
        remark("6:3", 5001),
        remark("5:28", 5000)
    );
    assert_eq!((output.code, output.stderr), (0, expected));
}

#[test]
fn a_missing_or_misspelt_subcommand_gets_a_suggestion() {
    let scratch = Scratch::new("suggestions");
    scratch.write("first.c", "main() { }").write("notes", "");
    for (word, expect) in [
        ("first.c", "cc67: `first.c` is not a subcommand; to run it: `cc67 run first.c`\n"),
        ("gone.C", "cc67: `gone.C` is not a subcommand; to run it: `cc67 run gone.C`\n"),
        ("notes", "cc67: `notes` is not a subcommand; to run it: `cc67 run notes`\n"),
        ("rnu", "cc67: `rnu` is not a subcommand; did you mean `run`?\n"),
        ("chekc", "cc67: `chekc` is not a subcommand; did you mean `check`?\n"),
    ] {
        let output = cc67(&scratch, [word]);
        assert_eq!((output.code, output.stderr.as_str()), (2, expect));
    }
}
