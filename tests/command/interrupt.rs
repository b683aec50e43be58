//! Ctrl-C ends a run after the tick in progress, and the run says how it ended.

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

use harness::Scratch;

const PROGRAM: &str = "#include \"KMotionDef.h\"\n\nmain()\n{\n    printf(\"ready\\n\");\n    while (!ReadBit(136)) WaitNextTimeSlice();\n}\n";

#[test]
fn an_interrupted_run_says_what_its_threads_wait_for() {
    let scratch = Scratch::new("interrupt");
    scratch.write("a.c", PROGRAM);
    let mut child = Command::new(harness::command())
        .args(["run", "--realtime", "--for", "100000", "a.c"])
        .current_dir(scratch.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command under test starts");
    let mut line = String::new();
    BufReader::new(child.stdout.take().expect("it is piped")).read_line(&mut line).expect("it prints");
    assert_eq!(line, "ready\n");
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("`kill` is a command of every Unix").success());
    let mut stderr = String::new();
    child.stderr.take().expect("it is piped").read_to_string(&mut stderr).expect("text");
    let exit = child.wait().expect("it ends");
    assert_eq!(exit.code(), Some(130), "{stderr}");
    assert!(stderr.contains("cc67: interrupted after "), "{stderr}");
    assert!(stderr.contains("a.c:6") && stderr.contains("bit 136"), "{stderr}");
}
