//! `--engine dsp`: sources become code of the controller's processor, and its faults are reported in words.

use harness::{Output, Scratch, cc67, cc67_with_input};
use serde_json::Value;

/// Runs the text as code of the processor.
fn run(name: &str, source: &str) -> Output {
    let scratch = Scratch::new(name);
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{source}"));
    cc67(&scratch, ["run", "--engine", "dsp", "a.c"])
}

/// Runs words that are called as a function.
fn run_words(name: &str, words: &str) -> Output {
    run(name, &format!("unsigned code[] = {{ {words} }};\nmain()\n{{\n    ((void (*)(void))code)();\n}}\n"))
}

/// The message of a run that stops its thread, with registers and code after its first line.
fn trap_and_scene(output: &Output) -> &str {
    assert_eq!(output.code, 3, "{output:?}");
    output.stderr.trim_end().rsplit_once("cc67: thread 1 stopped at ").expect("a trap").1
}

/// The message of a run that stops its thread.
fn trap(output: &Output) -> &str {
    trap_and_scene(output).lines().next().expect("a line")
}

const SUM: &str = "int main()\n{\n    int i; double sum = 0;\n    for (i = 0; i < 5; i++)\n        sum += i * 0.5;\n    printf(\"%g\\n\", sum);\n    return 0;\n}\n";

#[test]
fn sources_run_as_code_of_the_processor() {
    let output = run("dsp-sum", SUM);
    assert_eq!(output, Output { code: 0, stdout: "5\n".into(), stderr: String::new() });
    // Bytecode has a stack of its own: only the board's overflows here.
    let deep = "int Sum(int n)\n{\n    int a[20];\n    a[n % 20] = n;\n    return n ? Sum(n - 1) + a[n % 20] : 0;\n}\n\
                main()\n{\n    printf(\"%d\\n\", Sum(25));\n}\n";
    let output = run("dsp-deep", deep);
    assert!(trap(&output).contains(" in `Sum`: stack overflow: "), "{output:?}");
}

#[test]
fn the_engine_and_the_target_agree() {
    let scratch = Scratch::new("dsp-target");
    scratch.write("a.c", SUM);
    let output = cc67(&scratch, ["run", "--engine", "dsp", "--target", "sim", "a.c"]);
    assert_eq!(output.code, 2, "{output:?}");
    assert!(output.stderr.contains("leave one out"), "{}", output.stderr);
}

#[test]
fn a_console_loads_sources_for_the_engine_it_was_given() {
    let scratch = Scratch::new("dsp-console");
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{SUM}"));
    scratch.write("bad.c", "#include \"KMotionDef.h\"\nmain()\n{\n    ((void (*)(void))0x80050002)();\n}\n");
    let output = cc67_with_input(&scratch, ["console", "--engine", "dsp"], "run a.c\nwait 0.1\nrun bad.c\n");
    assert_eq!(output.stdout, "5\n", "{output:?}");
    assert!(output.stderr.contains("bad.c:4:5 in `main`: branch to 0x80050002"), "{}", output.stderr);
}

#[test]
fn tests_run_on_the_requested_engine() {
    let scratch = Scratch::new("dsp-test");
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{SUM}"));
    scratch.write("a.expected", "5\n");
    let output = cc67(&scratch, ["test", "--engine", "dsp", "."]);
    assert_eq!(output.code, 0, "{output:?}");
}

#[test]
fn a_word_that_is_not_an_instruction_stops_the_thread() {
    let output = run_words("dsp-word", "0x00000000, 0x10000000");
    let message = trap(&output);
    let (at, text) = message.split_once(": ").expect("a place");
    assert_eq!(text, format!("the word 10000000 at {at} is not an instruction of this processor"));
}

#[test]
fn an_odd_branch_stops_the_thread() {
    let source = "main()\n{\n    ((void (*)(void))0x80050002)();\n}\n";
    assert_eq!(
        trap(&run("dsp-odd", source)),
        "a.c:4:5 in `main`: branch to 0x80050002, which is not a multiple of 4"
    );
}

#[test]
fn a_write_into_code_stops_the_thread() {
    let source = "main()\n{\n    int *p = (int *)&main;\n    p[1] = 0;\n}\n";
    let output = run("dsp-code", source);
    assert!(
        trap(&output).ends_with("in `main`: write to 0x80050004, which holds program text"),
        "{output:?}"
    );
}

#[test]
fn two_results_for_one_register_stop_the_thread() {
    // ADD .L1 A1,A2,A3 || SUB .S1 A4,A5,A3
    let output = run_words("dsp-writers", "0x01882079, 0x01948DE0");
    assert!(trap(&output).contains("two results are written to A"), "{}", output.stderr);
}

#[test]
fn a_loop_that_keeps_interrupts_off_stops_the_thread() {
    // Two branches to the first of them, five cycles apart: the shadow of one reaches that of the other.
    let output = run_words("dsp-shadow", "0x00000010, 0, 0, 0, 0, 0x00000010, 0x00006000");
    assert!(
        trap(&output)
            .ends_with("cycles without a place where an interrupt is possible: the board's servo stops"),
        "{}",
        output.stderr
    );
}

#[test]
fn a_remark_names_the_line_of_the_call() {
    let output = run("dsp-remark", "main()\n{\n    MoveRel(2, 100);\n}\n");
    assert_eq!(
        output.stderr,
        "cc67: thread 1 at a.c:4:5 in `main`: MoveRel: axis 2 is disabled, so nothing moves\n"
    );
}

#[test]
fn a_trap_shows_registers_and_the_code_around_it() {
    let scratch = Scratch::new("dsp-scene");
    scratch.write("a.c", "int *p = (int *)0x12345678;\nmain()\n{\n    *p = 7;\n}\n");
    let output = cc67(&scratch, ["run", "--engine", "dsp", "a.c"]);
    assert_eq!(trap(&output), "a.c:4:5 in `main`: write of the unmapped address 0x12345678");
    let lines: Vec<&str> = trap_and_scene(&output).lines().skip(1).collect();
    let registers: Vec<&str> = lines.iter().flat_map(|line| line.split_whitespace()).collect();
    assert!(registers.contains(&"A14=00000001"), "{}", output.stderr);
    assert!(registers.iter().any(|register| register.ends_with("=12345678")), "{}", output.stderr);
    let mut marked = lines.iter().filter(|line| line.starts_with("> 8005"));
    assert!(marked.next().is_some_and(|line| line.contains("STW .D")), "{}", output.stderr);
    assert!(marked.next().is_none(), "one place: {}", output.stderr);

    let output = cc67(&scratch, ["run", "--engine", "dsp", "--json", "a.c"]);
    let line: Value = serde_json::from_str(output.stdout.lines().next().expect("a line")).expect("JSON");
    assert_eq!((&line["type"], &line["registers"]["A14"]), (&Value::from("trap"), &Value::from(1)), "{line}");
    let code = line["code"].as_array().expect("words around the place");
    let place = code.iter().find(|word| word["at"] == line["at"]).expect("the place is among them");
    assert!(place["text"].as_str().is_some_and(|text| text.contains("STW .D")), "{line}");
    // Code that is not the processor's has neither.
    let output = cc67(&scratch, ["run", "--engine", "bytecode", "--json", "a.c"]);
    assert!(
        output.stdout.contains("\"type\":\"trap\"") && !output.stdout.contains("registers"),
        "{output:?}"
    );
}

/// Runs a program for 0.1 s and keeps its packets; the lines of the file without the first.
fn packets(scratch: &Scratch, arguments: &[&str]) -> Vec<String> {
    let output = cc67(scratch, ["run"].iter().chain(arguments));
    assert_eq!(output.code, 0, "{output:?}");
    let text = std::fs::read_to_string(scratch.path().join("p.csv")).expect("the file");
    let mut lines = text.lines().map(str::to_owned);
    assert_eq!(lines.next().as_deref(), Some("cycle,thread,address,cycles,packet"));
    lines.collect()
}

#[test]
fn packets_are_traced_with_cycle_address_and_text() {
    let scratch = Scratch::new("dsp-packets");
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{SUM}"));
    let lines = packets(&scratch, &["--engine", "dsp", "--trace-packets", "p.csv", "a.c"]);
    let first: Vec<&str> = lines[0].splitn(5, ',').collect();
    assert_eq!((first[1], first[2]), ("1", "0x80050000"), "{}", lines[0]);
    assert!(lines.iter().any(|line| line.contains(" || ")), "packets have several instructions");
    assert!(lines.iter().any(|line| line.contains("ADDDP .")), "{lines:#?}");
    // One after another, but where the firmware has worked or another thread had its turn.
    let times: Vec<(i64, i64)> = lines
        .iter()
        .map(|line| {
            let fields: Vec<&str> = line.splitn(5, ',').collect();
            (fields[0].parse().expect("a cycle"), fields[3].parse().expect("cycles"))
        })
        .collect();
    assert!(times.windows(2).all(|pair| pair[0].0 + pair[0].1 <= pair[1].0), "{lines:#?}");
    let gaps = times.windows(2).filter(|pair| pair[0].0 + pair[0].1 != pair[1].0).count();
    assert!(gaps > 0 && gaps < 5, "{gaps} gaps");
    let one = packets(&scratch, &["--engine", "dsp", "--trace-packets", "1:p.csv", "a.c"]);
    assert_eq!(one, lines, "there is no other thread");
}

#[test]
fn tracing_packets_of_bytecode_is_refused_by_name() {
    let scratch = Scratch::new("dsp-no-packets");
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{SUM}"));
    assert_eq!(cc67(&scratch, ["build", "--thread", "2", "a.c"]).code, 0);
    let run = |arguments: &[&str]| cc67(&scratch, ["run", "--trace-packets"].iter().chain(arguments));
    for (arguments, thread) in [(&["p.csv", "a.c"][..], 1), (&["1:p.csv", "a.c", "2:a(2).out"], 1)] {
        let output = run(arguments);
        assert_eq!(output.code, 2, "{output:?}");
        assert!(output.stderr.contains(&format!("thread {thread} runs bytecode")), "{}", output.stderr);
    }
    assert!(run(&["9:p.csv", "a.c"]).stderr.contains("no such thread 9"));
    // Beside bytecode, only the real code has packets.
    let lines = packets(&scratch, &["--trace-packets", "p.csv", "a.c", "2:a(2).out"]);
    assert!(!lines.is_empty() && lines.iter().all(|line| line.contains(",2,0x8006")), "{lines:#?}");
}

#[test]
fn a_program_of_thread_7_has_all_the_space_that_the_board_has() {
    let scratch = Scratch::new("dsp-thread-7");
    let large = "#include \"KMotionDef.h\"\nchar big[300000];\nmain()\n{\n    int i, bad = 0;\n    \
                 for (i = 0; i < 300000; i++)\n        big[i] = i * 7;\n    persist.UserData[5] = 1;\n    \
                 while (persist.UserData[5] != 2)\n        WaitNextTimeSlice();\n    for (i = 0; i < 300000; i++)\n        \
                 bad += big[i] != (char)(i * 7);\n    printf(\"%d bad up to %p\\n\", bad, big + 300000);\n}\n";
    let deep = "#include \"KMotionDef.h\"\nint Sum(int n)\n{\n    int a[100];\n    a[n] = n;\n    \
                return n ? Sum(n - 1) + a[n] : 0;\n}\nmain()\n{\n    while (persist.UserData[5] != 1)\n        \
                WaitNextTimeSlice();\n    printf(\"%d\\n\", Sum(60));\n    persist.UserData[5] = 2;\n}\n";
    scratch.write("large.c", large);
    scratch.write("deep.c", deep);
    let built = cc67(&scratch, ["build", "--thread", "7", "large.c"]);
    assert_eq!((built.code, built.stderr.as_str()), (0, ""));
    // The stack of bytecode in thread 1 was where this program is.
    let output = cc67(&scratch, ["run", "1:deep.c", "7:large(7).out"]);
    assert_eq!(output.code, 0, "{output:?}");
    assert!(output.stdout.starts_with("1830\n0 bad up to 800f"), "{output:?}");
    scratch.write("larger.c", large.replace("300000", "330000"));
    let built = cc67(&scratch, ["build", "--thread", "7", "larger.c"]);
    assert_eq!(built.code, 1, "{built:?}");
    assert!(
        built.stderr.contains("bytes too large for the 327680 bytes after its address"),
        "{}",
        built.stderr
    );
}

/// Accesses of several lines whose instructions share packets; that of one of them goes wrong.
fn shared_packets(wrong: usize) -> String {
    format!(
        "int x, y;\ndouble d;\nint g(int *a, int *b, int *c, int *e)\n{{\n    *a = 1;\n    *b = 2;\n    x = *c;\n    \
         *e = 4;\n    y = x * 3;\n    d = d + x;\n    return x + y;\n}}\nmain()\n{{\n    int l[4], i;\n    int *q[4];\n    \
         for (i = 0; i < 4; i++)\n        q[i] = &l[i];\n    q[{wrong}] = (int *)0x12345678;\n    \
         y = g(q[0], q[1], q[2], q[3]);\n}}\n"
    )
}

#[test]
fn an_access_is_named_by_its_own_line_whatever_shares_its_packet() {
    for (wrong, line) in [(0, 5), (1, 6), (2, 7), (3, 8)] {
        for level in ["-O0", "-O1", "-O2", "-Os"] {
            let scratch = Scratch::new(&format!("dsp-shared-{wrong}{level}"));
            scratch.write("a.c", shared_packets(wrong));
            let output = cc67(&scratch, ["run", "--engine", "dsp", level, "a.c"]);
            let message = trap(&output);
            assert!(message.starts_with(&format!("a.c:{line}:")), "{level}: {message}");
        }
    }
}
