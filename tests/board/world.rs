//! The world around the board: stimulus, serial port, operator, and errors in their descriptions.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Command, Stdio};

use harness::{Output, Scratch, cc67, no_such_file, root};

/// A program that sends back each received character, followed by a mark, up to a full stop.
const ECHO: &str = "#include \"KMotionDef.h\"
main()
{
    char c;
    EnableRS232Cmds(RS232_BAUD_38400);
    DoRS232Cmds = FALSE;
    do
    {
        c = RS232_GetChar();
        RS232_PutChar(c);
    }
    while (c != '.');
    RS232_PutChar('!');
    while (pRS232TxOut != pRS232TxIn) WaitNextTimeSlice();
    Delay_sec(0.002);
    printf(\"done\\n\");
}
";

/// Runs a program with options in its own folder, with further files.
fn run(name: &str, program: &str, files: &[(&str, &[u8])], options: &[&str]) -> (Output, Scratch) {
    let scratch = Scratch::new(&format!("world-{name}"));
    fs::write(scratch.path().join("a.c"), program).expect("it is ours");
    for (name, bytes) in files {
        fs::write(scratch.path().join(name), bytes).expect("it is ours");
    }
    let arguments = ["run", "--no-sidecar"].iter().chain(options).chain(&["a.c"]);
    (cc67(&scratch, arguments), scratch)
}

#[test]
fn a_hundred_characters_at_38400_baud_take_26_ms() {
    let scratch = Scratch::new("world-baud");
    let trace = scratch.path().join("a.json");
    let program = root().join("c-programs/serial/send.c");
    let arguments = ["run".as_ref(), "--trace".as_ref(), trace.as_os_str(), program.as_os_str()];
    let output = cc67(&scratch, arguments);
    assert_eq!(output.code, 0, "{}", output.stderr);
    let text = fs::read_to_string(&trace).expect("it is written");
    let trace: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
    let marks = trace["traceEvents"].as_array().expect("a list").iter();
    let sent: Vec<f64> =
        marks.filter(|mark| mark["name"] == "A").filter_map(|mark| mark["ts"].as_f64()).collect();
    assert_eq!(sent.len(), 100);
    // From the first bit of the first character to the last bit of the last one.
    let character = (sent[99] - sent[0]) / 99.0;
    let whole = (sent[99] - sent[0] + character) / 1000.0;
    assert!((whole - 26.0).abs() < 0.26, "{whole} ms");
    assert!(sent.windows(2).all(|pair| pair[1] - pair[0] >= 259.0), "two came too soon");
}

#[test]
fn files_are_the_other_end_of_the_line() {
    let options = ["--uart-input", "in.txt", "--uart-output", "out.txt"];
    let (output, scratch) = run("files", ECHO, &[("in.txt", b"hello.")], &options);
    assert_eq!((output.code, output.stdout.as_str(), output.stderr.as_str()), (0, "done\n", ""));
    assert_eq!(fs::read(scratch.path().join("out.txt")).expect("it is written"), b"hello.!");
}

#[test]
fn an_echo_sends_back_what_it_gets() {
    let stimulus = "device echo; at 1ms uart \"x\"; at 50ms uart \".\"";
    let (output, _) = run("echo", ECHO, &[], &["--stim", stimulus]);
    // Each character is sent back forever; the full stop ends it.
    assert_eq!((output.code, output.stdout.as_str()), (0, "done\n"), "{}", output.stderr);
}

#[cfg(unix)]
#[test]
fn another_program_is_the_other_end_of_the_line() {
    let peer: &[u8] = b"printf 'hello.'\nread -r -n 7 text || cat > /dev/null\n";
    let options = ["--uart", "run:sh peer.sh", "--uart-output", "out.txt"];
    let (output, scratch) = run("program", ECHO, &[("peer.sh", peer)], &options);
    assert_eq!((output.code, output.stdout.as_str()), (0, "done\n"), "{}", output.stderr);
    assert_eq!(fs::read(scratch.path().join("out.txt")).expect("it is written"), b"hello.!");
}

#[test]
fn a_lost_peer_is_reported_once_and_the_run_continues() {
    let scratch = Scratch::new("world-vanishes");
    let program = "#include \"KMotionDef.h\"
main()
{
    int i;
    EnableRS232Cmds(RS232_BAUD_38400);
    DoRS232Cmds = FALSE;
    printf(\"got %c\\n\", RS232_GetChar());
    for (i = 0; i < 20; i++) { RS232_PutChar('x'); Delay_sec(0.01); }
    printf(\"done\\n\");
}
";
    fs::write(scratch.path().join("a.c"), program).expect("it is ours");
    let mut child = Command::new(harness::command())
        .args(["run", "--uart", "tcp:0", "a.c"])
        .current_dir(scratch.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut errors = BufReader::new(child.stderr.take().expect("it is piped"));
    let mut line = String::new();
    errors.read_line(&mut line).expect("it says where it waits");
    let address = line.trim_end().rsplit(' ').next().expect("an address");
    let mut peer = TcpStream::connect(address).expect("it listens");
    peer.write_all(b"A").expect("it is connected");
    drop(peer);
    let (mut stdout, mut rest) = (String::new(), String::new());
    child.stdout.take().expect("it is piped").read_to_string(&mut stdout).expect("it is text");
    errors.read_to_string(&mut rest).expect("it is text");
    assert!(child.wait().expect("it ends").success());
    assert_eq!(stdout, "got A\ndone\n");
    assert_eq!(rest.matches("is gone").count(), 1, "{rest}");
    assert_eq!(rest.lines().count(), 1, "{rest}");
}

#[cfg(unix)]
#[test]
fn a_terminal_is_the_other_end_of_the_line() {
    let scratch = Scratch::new("world-terminal");
    let program = ECHO.replace("Delay_sec(0.002)", "Delay_sec(1.0)");
    fs::write(scratch.path().join("a.c"), program).expect("it is ours");
    let mut child = Command::new(harness::command())
        .args(["run", "--uart", "pty", "a.c"])
        .current_dir(scratch.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut errors = BufReader::new(child.stderr.take().expect("it is piped"));
    let mut line = String::new();
    errors.read_line(&mut line).expect("it names its terminal");
    let name = line.trim_end().rsplit(' ').next().expect("a name");
    let mut terminal = fs::OpenOptions::new().read(true).write(true).open(name).expect("it is there");
    terminal.write_all(b"hello.").expect("it takes characters");
    let mut answer = [0; 7];
    terminal.read_exact(&mut answer).expect("the program answers");
    assert_eq!(&answer, b"hello.!");
    assert!(child.wait().expect("it ends").success());
}

#[test]
fn an_error_in_a_stimulus_or_machine_gives_one_message_with_its_place() {
    let files: &[(&str, &[u8])] = &[
        ("a.stim", b"# door\nat 1s set bit 4711\n"),
        ("b.stim", b"\xff\xfe"),
        ("a.toml", b"[[event]]\nat = 1\nset_bit = { 46 = 1 }\n"),
        ("b.toml", b"[cpu]\nservo_us = 30\n"),
    ];
    for (options, expect) in [
        (vec!["--stim", "a.stim"], "cc67: a.stim:2:15: expected a bit from 0 to 2047, found `4711`\n"),
        (
            vec!["--stim", "a.toml"],
            "cc67: a.toml:3:18: bit 46 (LED) is an output, only the board drives it\n",
        ),
        (
            vec!["--stim", "b.toml"],
            "cc67: b.toml: a stimulus has only [[event]] and [[device]]; the rest belongs to `--machine`\n",
        ),
        (vec!["--stim", "b.stim"], "cc67: b.stim is not text\n"),
        (vec!["--stim", "c.stim"], &format!("cc67: cannot read c.stim: {}\n", no_such_file())),
        (
            vec!["--stim", "t=0.5 bit 46=1"],
            "cc67: --stim:1:11: bit 46 (LED) is an output, only the board drives it in `t=0.5 bit 46=1`\n",
        ),
        (
            vec!["--stim", "device spi select=16"],
            "cc67: --stim:1:8: device `spi` needs `clock=…` in `device spi select=16`\n",
        ),
        (vec!["--uart", "modem"], "cc67: `--uart modem`: there are pty, tcp:PORT and run:COMMAND\n"),
        (
            vec!["--uart", "tcp:99999"],
            "cc67: `--uart tcp:99999`: not a port number: number too large to fit in target type\n",
        ),
        (vec!["--uart-input", "gone.txt"], &format!("cc67: cannot read gone.txt: {}\n", no_such_file())),
    ] {
        let (output, _) = run("wrong", "main() { }", files, &options);
        assert_eq!((output.code, output.stderr.as_str()), (2, expect), "{options:?}");
    }
}

#[test]
fn mistakes_of_programs_are_reported_and_do_no_harm() {
    let program = "#include \"KMotionDef.h\"
main()
{
    int i;
    for (i = 0; i < 2; i++) SetBit(2048);
    printf(\"%d %d\\n\", ReadBit(-1), GetBitDirection(9999));
    AddKonnect(8, &VirtualBits, VirtualBitsEx);
    printf(\"%d\\n\", ReadSnapAmp(0x3f));
    *(volatile int *)(0x91000002 + 4 * 0x130) = 0;
}
";
    let (output, _) = run("misuse", program, &[], &[]);
    assert_eq!((output.code, output.stdout.as_str()), (3, "0 0\n0\n"), "{}", output.stderr);
    for text in ["SetBit(2048): no such bit (0-2047)", "AddKonnect(8, …)", "ReadSnapAmp(0x3f)", "not aligned"]
    {
        assert!(output.stderr.contains(text), "{text} in {}", output.stderr);
    }
}

#[test]
fn expectations_look_at_axes_variables_and_times() {
    let program = "#include \"KMotionDef.h\"
int Parts;
main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    EnableAxisDest(0, 0);
    SetBit(1050);
    printf(\"start\\n\");
    Move(0, 500);
    while (!CheckDone(0)) ;
    Parts = 3;
    *(float *)&persist.UserData[20] = 1.25;
    printf(\"moved\\n\");
    ClearBit(1050);
    DisableAxis(0);
}
";
    for (stimulus, expect) in [
        ("at end expect axis 0 position = 500 ± 1", ""),
        ("at end expect axis 0 dest = 501", "axis 0 dest is 500, expected 501"),
        ("at end expect axis 0 disabled; expect thread 1 ended; expect bit 1050 = 0", ""),
        ("expect axis 0 enabled", "axis 0 is disabled, expected enabled"),
        ("expect persist 20 = f:1.25", ""),
        ("expect persist 20 = f:1.5 +- 0.1", "persist 20 is 1.25, expected 1.5 ± 0.1"),
        ("expect Parts = 3", ""),
        ("expect Parts > 3", "Parts is 3, expected > 3"),
        ("expect \"ch0->Dest - 200\" = 300 ± 1", ""),
        ("within 2s of printed \"start\" expect printed \"moved\"", ""),
        (
            "within 0.1s of printed \"start\" expect printed \"moved\"",
            "no line contains \"moved\", expected one, within 0.1 s of printed \"start\" at ",
        ),
        (
            "within 1s of printed \"go\" expect printed \"moved\"",
            "printed \"go\" never happened, so nothing was checked",
        ),
        ("always while bit 1050 = 1 expect axis 0 enabled", ""),
        ("always while bit 1050 = 1 expect axis 0 dest < 250", "axis 0 dest is 25"),
        ("never printed \"boom\"", ""),
        ("never printed \"move\"", "a line contains \"move\", expected none"),
        ("never axis 0 dest > 501; never axis 0 velocity > 4001", ""),
        ("never axis 0 dest > 100.5", ", expected never > 100.5"),
        ("never axis 0 velocity > 10", "axis 0 velocity is "),
    ] {
        for engine in ["bytecode", "native"] {
            let (output, _) = run("expects", program, &[], &["--engine", engine, "--stim", stimulus]);
            let code = if expect.is_empty() { 0 } else { 5 };
            assert_eq!(output.code, code, "{stimulus}: {}", output.stderr);
            assert!(output.stderr.contains(expect), "{stimulus}: {}", output.stderr);
            assert_eq!(
                output.stderr.lines().count(),
                usize::from(code != 0),
                "{stimulus}: {}",
                output.stderr
            );
        }
    }
    let (output, _) = run("expects", program, &[], &["--stim", "expect Prts = 3"]);
    assert_eq!(output.code, 2, "{}", output.stderr);
    assert!(output.stderr.starts_with("cc67: --stim:1:1: `Prts`: "), "{}", output.stderr);
}

#[test]
fn one_program_runs_after_the_other() {
    let first = "#include \"KMotionDef.h\"\nmain() { Delay_sec(0.01); printf(\"first\\n\"); }";
    let second = ("second.c", &b"#include \"KMotionDef.h\"\nmain() { printf(\"second\\n\"); }"[..]);
    for (stimulus, expect) in [
        ("once thread 1 ends run thread 2 \"second.c\"", "first\nsecond\n"),
        ("once thread 1 ends after 1s run thread 2 \"second.c\"", "first\nsecond\n"),
        ("once printed \"first\" run thread 2 \"second.c\"", "first\nsecond\n"),
        (
            "once thread 1 ends after 1s bit 1050 = 1; once bit 1050 rises run thread 1 \"second.c\"",
            "first\nsecond\n",
        ),
        // It can no longer happen.
        ("once thread 3 ends run thread 2 \"second.c\"", "first\n"),
        ("once thread 3 ends run thread 2 \"second.c\"; every 1s toggle bit 1050", "first\n"),
    ] {
        let (output, _) = run("after", first, &[second], &["--stim", stimulus]);
        assert_eq!((output.code, output.stdout.as_str()), (0, expect), "{stimulus}: {}", output.stderr);
    }
}

#[test]
fn an_expectation_that_is_not_met_fails_the_run() {
    for (stimulus, code, expect) in [
        ("expect bit 46 = 1", 0, ""),
        ("expect bit 46 = 0", 5, "cc67: --stim:1:1: at 0.01035 s bit 46 is 1, expected 0\n"),
        (
            "at 1ms expect printed \"done\"",
            5,
            "cc67: --stim:1:1: at 0.00108 s no line contains \"done\", expected one\n",
        ),
        ("at 99s expect printed \"done\"", 0, ""),
        (
            "expect not printed \"on\"",
            5,
            "cc67: --stim:1:1: at 0.01035 s a line contains \"on\", expected none\n",
        ),
        ("persist 7 = 5; expect persist 7 = 6", 5, "cc67: --stim:1:16: UserData[7] is 6, expected 5\n"),
        (
            "expect thread 1 active",
            5,
            "cc67: --stim:1:1: at 0.01035 s thread 1 is not active, expected active\n",
        ),
    ] {
        let program = "#include \"KMotionDef.h\"
main() { Delay_sec(0.01); persist.UserData[7]++; printf(\"done\\n\"); }";
        let (output, _) = run("expect", program, &[], &["--stim", stimulus]);
        if stimulus.contains("persist") {
            assert_eq!(output.code, 0, "{}", output.stderr);
            continue;
        }
        assert_eq!((output.code, output.stderr.as_str()), (code, expect), "{stimulus}");
    }
}

#[test]
fn events_happen_in_board_time_whatever_the_engine_skips() {
    let program = "#include \"KMotionDef.h\"
main()
{
    int n = 0, Before = 0;
    double T;
    while ((T = Time_sec()) < 0.3)
    {
        if (ReadBit(136) != Before) { Before = !Before; printf(\"%.5f\\n\", T); n++; }
        if (ReadBit(137)) ThreadDone();
        Delay_sec(0.001);
    }
}
";
    let stimulus = "every 10ms from 20ms until 60ms toggle bit 136; when bit 136 falls after 5ms pulse bit 1030 for 1ms; \
                    once bit 1030 rises after 100ms command \"SetBit1031\"; at 0.2s set bit 137; \
                    at end expect bit 1031 = 1";
    let short = run("time", program, &[], &["--stim", stimulus]).0;
    let full = run("time-full", program, &[], &["--stim", stimulus, "--no-shortcuts"]).0;
    assert_eq!((short.code, short.stderr.as_str()), (0, ""));
    assert_eq!(short.stdout, full.stdout);
    assert_eq!(short.stdout.lines().count(), 5, "{}", short.stdout);
}

#[test]
fn an_operator_helps_programs_that_wait() {
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
    let (output, _) = run("assist", program, &[], &["--assist", "--for", "20", "--time"]);
    assert_eq!(output.code, 0, "{}", output.stderr);
    let lines: Vec<_> = output.stdout.lines().collect();
    assert!(lines.len() == 2 && lines[0].starts_with("2.00") && lines[1].starts_with("4.10"), "{lines:?}");
    assert!(
        output.stderr.contains("a.c:4:13 in `main` waits, so --assist sets bit 136 to 1 for 0.1 s"),
        "{}",
        output.stderr
    );
}

#[test]
fn a_pwm_output_has_its_rate_and_duty() {
    let program = "#include \"KMotionDef.h\"
main()
{
    FPGA(IO_PWMS_PRESCALE) = 65;
    FPGA(IO_PWMS) = 128;
    FPGA(IO_PWMS + 1) = 1;
    Delay_sec(0.001);
}
";
    let options = ["--trace", "a.csv", "--trace-items", "iopwm0,iopwmhz0,bit26", "--trace-every", "10"];
    let (output, scratch) = run("pwm", program, &[], &options);
    assert_eq!(output.code, 0, "{}", output.stderr);
    let text = fs::read_to_string(scratch.path().join("a.csv")).expect("it is written");
    let last: Vec<f64> =
        text.lines().next_back().expect("a line").split(',').filter_map(|cell| cell.parse().ok()).collect();
    assert!((last[1] - 0.502).abs() < 0.001 && (last[2] - 986.0).abs() < 1.0 && last[3] == 1.0, "{last:?}");
}

#[test]
fn an_unknown_register_stores_and_is_reported_once_on_request() {
    let program = "#include \"KMotionDef.h\"
main()
{
    int i;
    for (i = 1; i < 4; i++) { FPGA(0x1f0) = i; FPGAW(0x1f2) = 500 * i; }
    printf(\"%d %d\\n\", FPGA(0x1f0), FPGAW(0x1f2));
}
";
    let remarks = "cc67: FPGA register 0x1f0 is unknown: it only stores what is written\n\
                   cc67: FPGA register 0x1f2 is unknown: it only stores what is written\n";
    for (options, expect) in [(vec![], ""), (vec!["--verbose"], remarks)] {
        let (output, _) = run("unknown", program, &[], &options);
        assert_eq!((output.code, output.stdout.as_str(), output.stderr.as_str()), (0, "3 1500\n", expect));
    }
}
