//! `cc67 console` as a person at a terminal meets it: history, completion, Ctrl-C.
#![cfg(unix)]

use std::fs::File;
use std::io::{Read, Write};
use std::process::{Child, Command};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use harness::Scratch;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

/// The time limit for an answer by the clock, on a computer under load.
const PATIENCE: Duration = Duration::from_secs(30);

/// A terminal with a console on it.
struct Terminal {
    child: Child,
    keyboard: File,
    shown: Receiver<Vec<u8>>,
    /// The output that was not compared yet.
    text: String,
}

impl Terminal {
    fn new(scratch: &Scratch, arguments: &[&str]) -> Self {
        let controller = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a terminal");
        grantpt(&controller).expect("the terminal is ours");
        unlockpt(&controller).expect("it opens");
        let name = ptsname(&controller, Vec::new()).expect("it has a name").to_string_lossy().into_owned();
        let line = File::options().read(true).write(true).open(name).expect("it opens");
        let child = Command::new(harness::command())
            .arg("console")
            .args(arguments)
            .current_dir(scratch.path())
            .env("TERM", "xterm")
            .env("NO_COLOR", "1")
            .stdin(line.try_clone().expect("one more handle"))
            .stderr(line.try_clone().expect("one more handle"))
            .stdout(line)
            .spawn()
            .expect("the command under test starts");
        let keyboard = File::from(controller);
        let mut screen = keyboard.try_clone().expect("one more handle");
        let (sender, shown) = channel();
        thread::spawn(move || {
            let mut buffer = [0; 1024];
            // A terminal whose other side is closed ends, or fails; both are the end.
            while let Ok(count @ 1..) = screen.read(&mut buffer) {
                if sender.send(buffer[..count].to_vec()).is_err() {
                    break;
                }
            }
        });
        let mut terminal = Self { child, keyboard, shown, text: String::new() };
        terminal.wait("KFLOP> ");
        terminal
    }

    /// Presses keys.
    fn press(&mut self, keys: &str) {
        self.keyboard.write_all(keys.as_bytes()).expect("somebody reads the terminal");
    }

    /// Presses Ctrl-C at the prompt that comes next; between two prompts nobody reads single keys.
    fn interrupt(&mut self) {
        self.wait("KFLOP> ");
        self.press("\x03");
    }

    /// Waits for the end; whether it was success.
    fn ends_well(mut self) -> bool {
        for _ in 0..PATIENCE.as_millis() / 10 {
            if let Some(status) = self.child.try_wait().expect("it can be asked") {
                return status.success();
            }
            thread::sleep(Duration::from_millis(10));
        }
        false
    }

    /// Waits until a text is shown after what was looked for before.
    fn wait(&mut self, expect: &str) {
        while !self.text.contains(expect) {
            let Ok(bytes) = self.shown.recv_timeout(PATIENCE) else {
                panic!("{expect:?} is not shown, only {:?}", self.text)
            };
            self.text += &String::from_utf8_lossy(&bytes);
        }
        let end = self.text.find(expect).expect("just seen") + expect.len();
        self.text.drain(..end);
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

const VERSION: &str = "KFLOP 4.34 Build 16:07:06 Aug 14 2018\r\n";

#[test]
fn lines_are_remembered_and_completed() {
    let scratch = Scratch::new("keyboard-lines");
    let mut terminal = Terminal::new(&scratch, &[]);
    terminal.press("Version\r");
    terminal.wait(VERSION);
    // Up brings the line back.
    terminal.press("\x1b[A\r");
    terminal.wait(VERSION);
    terminal.press("GetStopS\t\r");
    terminal.wait("GetStopState");
    terminal.wait("0\r\n");
    terminal.press("help Jo\t\r");
    terminal.wait("moves an axis at a speed; 0 stops it");
    terminal.press("help SetStateB\t\x15help SetStateBit\r");
    terminal.wait("void SetStateBit(int bit, int state)");
    terminal.press("quit\r");
    assert!(terminal.ends_well());
}

#[test]
fn the_first_ctrl_c_stops_the_programs_and_the_second_one_leaves() {
    let scratch = Scratch::new("keyboard-ctrl-c");
    scratch.write(
        "a.c",
        "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"begun\\n\");\n  for (;;) WaitNextTimeSlice();\n}\n",
    );
    let mut terminal = Terminal::new(&scratch, &["a.c"]);
    terminal.wait("begun");
    terminal.interrupt();
    terminal.wait("all threads are stopped; Ctrl-C again leaves");
    terminal.press("CheckThread1\r");
    terminal.wait("0\r\n");
    // A line in between counts from the start.
    terminal.interrupt();
    terminal.wait("all threads are stopped");
    terminal.interrupt();
    assert!(terminal.ends_well());
}

/// For an hour where tests take their long form.
#[test]
#[cfg(target_os = "linux")]
fn a_board_left_at_a_prompt_uses_hardly_any_time_or_memory() {
    let seconds = if harness::is_long() { 3600 } else { 2 };
    let scratch = Scratch::new("keyboard-idle");
    let source = "main() { for (;;) { Delay_sec(0.1); SetStateBit(47, !ReadBit(47)); } }\n";
    scratch.write("blink.c", format!("#include \"KMotionDef.h\"\n{source}"));
    let mut terminal = Terminal::new(&scratch, &["blink.c"]);
    terminal.press("Version\r");
    terminal.wait(VERSION);
    // The next prompt comes behind the reply.
    while terminal.shown.recv_timeout(Duration::from_millis(500)).is_ok() {}
    let before = harness::usage::Usage::of(terminal.child.id());
    let shown = terminal.shown.recv_timeout(Duration::from_secs(seconds));
    assert!(shown.is_err(), "nothing happens, so nothing is shown");
    let after = harness::usage::Usage::of(terminal.child.id());
    let cpu = after.cpu - before.cpu;
    println!("{seconds} s at a prompt: {cpu:?} of processor time, {before:?}, {after:?}");
    assert!(cpu < Duration::from_millis(20) + Duration::from_secs(seconds) / 20, "{cpu:?}");
    assert!(after.peak <= before.peak + 1024, "{before:?}, {after:?}");
    terminal.press("quit\r");
    assert!(terminal.ends_well());
}
