//! `cc67 serve`: clients on sockets, as the vendor's library talks to its server. The client here speaks the protocol
//! from its description alone.

mod boards;
mod calls;
mod client;
#[cfg(unix)]
mod failures;
#[cfg(unix)]
mod home;
mod hostile;
mod page;
mod wire;

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use harness::{Scratch, cc67};

use client::{Client, Usual};

/// A server and its folder; ended when it goes out of scope.
pub(crate) struct Server {
    child: Child,
    scratch: Scratch,
    /// Its addresses, in the order in which it prints them.
    pub(crate) places: Vec<String>,
    /// The rest of its output.
    lines: Receiver<String>,
}

impl Server {
    /// A server for a program `a.c` with these arguments, which listens at `count` places.
    pub(crate) fn start(name: &str, arguments: &[&str], source: &str, count: usize) -> Self {
        let scratch = Scratch::new(name);
        scratch.write("a.c", source);
        Self::start_in(scratch, arguments, count)
    }

    fn start_in(scratch: Scratch, arguments: &[&str], count: usize) -> Self {
        let mut command = Command::new(harness::command());
        command.args(arguments.iter().map(|word| Usual::address(word))).current_dir(scratch.path());
        Self::spawn(command, scratch, count)
    }

    fn spawn(command: Command, scratch: Scratch, count: usize) -> Self {
        Self::spawn_after(command, scratch, 0, count)
    }

    /// A server that says this many lines before its places.
    fn spawn_after(mut command: Command, scratch: Scratch, skipped: usize, count: usize) -> Self {
        // Where it keeps the token of a page.
        let state = scratch.path().join(".state");
        command.env("XDG_STATE_HOME", &state).env("LOCALAPPDATA", &state);
        let mut child = command.stderr(Stdio::piped()).spawn().expect("the command under test starts");
        let stderr = BufReader::new(child.stderr.take().expect("it is piped"));
        let (sender, lines) = channel();
        thread::spawn(move || {
            // Whoever started the server may be gone.
            stderr.lines().map_while(Result::ok).try_for_each(|line| sender.send(line).ok())
        });
        let place = || {
            let line = lines.recv().expect("it says where it listens");
            line.strip_prefix("cc67: a board is served on ").expect(&line).to_owned()
        };
        (0..skipped).for_each(|_| drop(lines.recv().expect("it says something")));
        let places = (0..count).map(|_| place()).collect();
        Self { child, scratch, places, lines }
    }

    /// A server of a program on a port, whose board time passes in exchanges only.
    fn fast(name: &str, source: &str) -> Self {
        Self::start(name, &["serve", "--pace", "fast", "--listen", "tcp:0", "a.c"], source, 1)
    }

    /// One more client, over the first port; or over the first pipe, where they are tested.
    fn client(&self) -> Client<Usual> {
        let is_usual = |place: &&String| place.starts_with("tcp:") || place.starts_with(r"\\.\pipe\");
        Client::new(Usual::connect(self.places.iter().find(is_usual).expect("a port or a pipe")))
    }

    /// Waits for a line that has this text.
    fn says(&self, text: &str) {
        while !self.lines.recv().expect(text).contains(text) {}
    }

    /// Its folder, for another server.
    #[cfg(unix)]
    fn take_folder(&mut self) -> Scratch {
        std::mem::replace(&mut self.scratch, Scratch::new("serve-none"))
    }

    /// Waits for the end.
    fn ends(&mut self) -> ExitStatus {
        self.child.wait().expect("it is a child")
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

const HELLO: &str = "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"hello\\n\");\n  for (;;) { WaitNextTimeSlice(); persist.UserData[9]++; }\n}\n";

const VERSION: &str = "KFLOP 4.34 Build 16:07:06 Aug 14 2018";

#[test]
fn a_client_over_tcp_talks_to_the_board() {
    let server = Server::fast("serve-tcp", HELLO);
    let mut client = server.client();
    assert_eq!(client.call(client::SET_CONSOLE, b""), (0, Vec::new()));
    assert_eq!(client.ask("Version"), VERSION);
    assert_eq!(client.ask("CheckThread1"), "1");
    assert_eq!(client.console, ["hello"]);
    client.write_line("GetGatherHex 0 9");
    let words = ["00000000"; 8].join(" ");
    assert_eq!(client.read_line(100), Some(format!("{words}\r\n")));
    assert_eq!(client.read_line(100).as_deref(), Some("00000000\r\n"));
    assert_eq!(client.read_line(100), None, "the time has passed");
    assert_eq!(client.call(2, b"Version\0").0, 0);
    assert_eq!(client.call(8, b"").0, 2, "Ready came");
    assert_eq!(client.call(7, b"").0, 2, "the generation of the firmware");
    let location = client.call(10, b"").0;
    client.send(&4_i32.to_le_bytes());
    assert_eq!(client.reply(), (0, [1_i32.to_le_bytes(), location.to_le_bytes()].concat()));
    // A board that is not there.
    client.send(&[&client::LOCK.to_le_bytes()[..], &(-1_i32).to_le_bytes(), b"\0"].concat());
    assert_eq!(client.reply().0, 2);
    // A call that does not exist ends the connection, and nothing else.
    client.send(&[&99_i32.to_le_bytes()[..], &[0; 4]].concat());
    assert!(client.is_closed());
    assert_eq!(server.client().ask("Version"), VERSION);
}

#[test]
fn real_code_can_be_served_and_downloaded() {
    let scratch = Scratch::new("serve-real");
    scratch.write("a.c", HELLO);
    scratch
        .write("b.c", "#include \"KMotionDef.h\"\nint n;\nmain()\n{\n  printf(\"again %d\\n\", n++);\n}\n");
    assert_eq!(cc67(&scratch, ["build", "b.c", "--thread", "3", "--emit", "download"]).code, 0);
    let download = std::fs::read_to_string(scratch.path().join("b(3).kmd")).expect("it is written");
    let arguments = ["serve", "--engine", "dsp", "--pace", "fast", "--listen", "tcp:0", "a.c"];
    let server = Server::start_in(scratch, &arguments, 1);
    let mut client = server.client();
    assert_eq!(client.call(client::SET_CONSOLE, b"").0, 0);
    assert_eq!(client.ask("Version"), VERSION);
    assert_ne!(client.ask("GetPersistDec 9"), "0");
    download.lines().for_each(|line| client.write_line(line));
    for _ in 0..2 {
        client.write_line("Execute3");
        while client.ask("CheckThread3") != "0" {}
    }
    assert_eq!(client.ask("Version"), VERSION);
    assert_eq!(client.console, ["hello", "again 0", "again 1"]);
}

#[cfg(unix)]
#[test]
fn clients_over_a_socket_share_the_board_by_its_token() {
    use std::os::unix::net::UnixStream;

    let arguments = ["console", "--fast", "--serve", "socket", "a.c"];
    let server = Server::start("serve-unix", &arguments, HELLO, 1);
    assert_eq!(server.places, ["socket"]);
    let path = server.scratch.path().join("socket");
    let connect = || Client::new(UnixStream::connect(&path).expect("it listens"));
    let (mut first, mut second) = (connect(), connect());
    assert_eq!(first.lock(), 0);
    assert_eq!(second.lock(), 1);
    assert_eq!(first.ask("Version"), VERSION);
    first.release();
    assert_eq!(second.lock(), 0);
    // A client that dies loses the token.
    drop(second);
    while first.lock() != 0 {}
    first.release();
    // Time passes in exchanges only, so this is the same every time.
    let count: i32 = first.ask("GetPersistDec 9").parse().expect("a number");
    assert!(count > 0, "{count}");
    drop(first);
    // The place of a server that serves is not taken over.
    let again = Command::new(harness::command())
        .args(["serve", "--listen", "socket"])
        .current_dir(server.scratch.path())
        .output()
        .expect("the command under test starts");
    assert_eq!(again.status.code(), Some(2));
    let message = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(message.contains("another server listens there"), "{message}");
}

#[cfg(unix)]
#[test]
fn a_socket_and_a_port_are_served_together_and_the_socket_is_removed() {
    use std::os::unix::net::{UnixListener, UnixStream};

    let scratch = Scratch::new("serve-both");
    scratch.write("a.c", HELLO);
    let path = scratch.path().join("socket");
    // What a server that was killed has left is replaced.
    drop(UnixListener::bind(&path).expect("a socket"));
    let arguments = ["serve", "--once", "--listen", "socket", "--listen", "tcp:0", "a.c"];
    let mut server = Server::start_in(scratch, &arguments, 2);
    let mut here = Client::new(UnixStream::connect(&path).expect("it listens"));
    let mut there = server.client();
    here.write_line("SetPersistDec 7 11");
    assert_eq!(there.ask("GetPersistDec 7"), "11");
    drop(here);
    assert_eq!(there.ask("CheckThread1"), "1", "another client is still there");
    drop(there);
    assert_eq!(server.ends().code(), Some(0), "the last client is gone");
    assert!(!path.exists(), "the socket is removed");
}

#[cfg(unix)]
#[test]
fn a_termination_signal_shuts_the_server_down_cleanly() {
    for signal in ["-TERM", "-INT"] {
        let arguments = ["serve", "--listen", "tcp:0", "--log", "log.txt", "--flash", "board.flash", "a.c"];
        let mut server = Server::start("serve-signal", &arguments, HELLO, 1);
        let mut client = server.client();
        assert_eq!(client.ask("ProgFlashImage"), "Program Flash Image Complete");
        client.write_line("SetPersistDec 7 11");
        let id = server.child.id().to_string();
        let killed = Command::new("kill").args([signal, &id]).status().expect("there is a kill");
        assert!(killed.success());
        assert_eq!(server.ends().code(), Some(0), "{signal}");
        let log = std::fs::read_to_string(server.scratch.path().join("log.txt")).expect("a log");
        assert!(log.contains("\nSETPERSISTDEC 7 11\n"), "{log}");
    }
}

#[test]
fn flash_is_saved_as_soon_as_a_client_writes_it() {
    let arguments = ["serve", "--pace", "fast", "--listen", "tcp:0", "--flash", "board.flash", "a.c"];
    let mut server = Server::start("serve-flash", &arguments, HELLO, 1);
    let mut client = server.client();
    client.write_line("SetPersistDec 7 77");
    assert_eq!(client.ask("Flash"), "Program Flash Image Complete", "a reply, and then a console line");
    assert_eq!(client.ask("GetPersistDec 7"), "77");
    // A server that is killed now has lost nothing.
    server.child.kill().expect("it runs");
    server.ends();
    let script = "GetPersistDec 7\n";
    let output = harness::cc67_with_input(&server.scratch, ["console", "--flash", "board.flash"], script);
    assert_eq!(output.stdout, "77\n", "{}", output.stderr);
}

#[test]
fn the_log_is_a_script_that_repeats_the_session() {
    let arguments = ["serve", "--pace", "fast", "--once", "--listen", "tcp:0", "--log", "log.txt", "a.c"];
    let mut server = Server::start("serve-log", &arguments, HELLO, 1);
    let mut client = server.client();
    assert_eq!(client.lock(), 0);
    let answers = ["Version", "ReadBit46", "Dest0"].map(|line| client.ask(line));
    client.write_line("SetGatherHex 5 2");
    client.write_line("AB CD");
    let words = client.ask("GetGatherHex 5 2");
    assert_eq!(words, "000000AB 000000CD");
    client.release();
    drop(client);
    assert_eq!(server.ends().code(), Some(0));
    let log = std::fs::read_to_string(server.scratch.path().join("log.txt")).expect("a log");
    assert!(log.contains("client 1: KMotionLock\n"), "{log}");
    let again = harness::cc67_with_input(&server.scratch, ["console", "--for", "0", "a.c"], &log);
    let expect = format!("hello\n{}\n{words}\n", answers.join("\n"));
    let lines = |text: &str| {
        let mut lines: Vec<_> = text.lines().map(str::to_owned).collect();
        lines.sort();
        lines
    };
    assert_eq!(lines(&again.stdout), lines(&expect), "{log}");
}

#[test]
fn the_log_names_requests_that_have_no_answer() {
    let arguments = ["serve", "--pace", "fast", "--listen", "tcp:0", "--log", "log.txt", "a.c"];
    let server = Server::start("serve-unanswered", &arguments, HELLO, 1);
    let mut client = server.client();
    assert_eq!(client.try_ask("bogus"), Err(1));
    client.send(&[&client::LOCK.to_le_bytes()[..], &4711_i32.to_le_bytes(), b"\0"].concat());
    assert_eq!(client.reply().0, 2);
    assert_eq!(client.ask("Version"), VERSION);
    client.send(&[&99_i32.to_le_bytes()[..], &[0; 4]].concat());
    server.says("client 1: there is no call 99 with these arguments, its connection is closed");
    let log = std::fs::read_to_string(server.scratch.path().join("log.txt")).expect("a log");
    for text in [
        "the board: error, invalid command\n",
        "client 1: the board has not answered\n",
        "client 1: KMotionLock for board 4711, which is not there\n",
    ] {
        assert!(log.contains(text), "{text}{log}");
    }
}

#[test]
fn a_server_ends_after_the_time_that_it_was_given() {
    let scratch = Scratch::new("serve-end");
    scratch.write("a.c", HELLO);
    let output = cc67(&scratch, ["serve", "--listen", "tcp:0", "--pace", "10", "--for", "0.05", "a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, ""));
    assert!(output.stderr.starts_with("cc67: a board is served on tcp:"), "{}", output.stderr);
    for (arguments, expect) in [
        (&["console", "--serve", "tcp:x"][..], "`--serve tcp:x`: `x` is not a port number"),
        (
            &["serve", "--listen", "usb:1"],
            "`--listen usb:1`: neither tcp:PORT, tcp-raw:PORT, pty, pipe[:NAME] nor the path of a socket",
        ),
        #[cfg(not(windows))]
        (
            &["serve", "--listen", "pipe"],
            r"`--listen pipe`: \\.\pipe\kmotionpipe is a named pipe, which only Windows has",
        ),
        (&["serve", "--pace", "0"], "expected a number from 0.01 to 1000, or `fast`"),
        (&["serve", "--no-open"], "--live"),
    ] {
        let wrong = cc67(&scratch, arguments);
        assert_eq!(wrong.code, 2);
        assert!(wrong.stderr.contains(expect), "{arguments:?}: {}", wrong.stderr);
    }
}

#[test]
fn clients_talk_to_the_users_own_firmware() {
    let Some(firmware) = std::env::var_os("CC67_FIRMWARE") else {
        println!("not run: CC67_FIRMWARE names no firmware file");
        return;
    };
    let firmware = firmware.to_str().expect("a name of text").to_owned();
    let words = ["serve", "--boot", &firmware, "--pace", "fast", "--listen", "tcp:0", "a.c"];
    let server = Server::start("serve-boot", &words, HELLO, 1);
    let mut client = server.client();
    assert_eq!(client.call(client::SET_CONSOLE, b"").0, 0);
    assert_eq!(client.ask("Version"), VERSION);
    assert_eq!(client.ask("CheckThread1"), "1");
    while client.console != ["hello"] {
        assert_eq!(client.ask("Version"), VERSION);
    }
    client.write_line("SetGatherHex 5 2");
    client.write_line("AB CD");
    assert_eq!(client.ask("GetGatherHex 5 2"), "000000AB 000000CD");
    assert_eq!(client.call(client::WRITE_LINE_WITH_ECHO, b"bogus\0").0, 0);
    assert_eq!(client.call(client::CHECK_FOR_READY, b"").0, 3);
    assert_eq!(client.call(client::DISCONNECT, b"").0, 0);
    assert_eq!(client.ask("Version"), VERSION);
    drop(server);

    let words = ["console", "--boot", &firmware, "--fast", "--serve", "tcp:0", "a.c"];
    let server = Server::start("console-boot", &words, HELLO, 1);
    let mut client = server.client();
    assert_eq!(client.call(client::SET_CONSOLE, b"").0, 0);
    while client.console != ["hello"] {
        assert_eq!(client.ask("Version"), VERSION);
    }
}

/// The first block of a kind in the chapter on PC applications, for another port than the usual one.
#[cfg(unix)]
fn of_the_book(kind: &str, port: &str) -> String {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../cc67/book/src/pc-applications.md");
    let page = std::fs::read_to_string(page).expect("the chapter is there");
    let block = page.split(&format!("```{kind}\n")).nth(1).and_then(|rest| rest.split("```").next());
    block.expect("a block").replace("57777", port)
}

#[cfg(unix)]
#[test]
fn the_clients_of_the_book_talk_to_the_board() {
    let server = Server::fast("serve-book", HELLO);
    let port = server.places[0].strip_prefix("tcp:").expect("a port");
    let folder = server.scratch.path();
    server.scratch.write("client.py", of_the_book("python", port));
    let python = harness::run_in("python3", folder, ["client.py"]);
    assert_eq!((python.code, python.stdout.as_str()), (0, format!("hello\n(0, b'{VERSION}')\n").as_str()));
    server.scratch.write("client.c", of_the_book("c host", port));
    let compiled = harness::run_in("cc", folder, ["-Wall", "-Werror", "-o", "client", "client.c"]);
    assert_eq!((compiled.code, compiled.stderr.as_str()), (0, ""));
    let client = folder.join("client");
    let answer = harness::run_in(client.to_str().expect("a name in UTF-8"), folder, [""; 0]);
    assert_eq!((answer.code, answer.stdout), (0, format!("{VERSION}\n")));
}
