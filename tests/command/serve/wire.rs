//! The board's own bytes at a pseudo-terminal and over TCP. The client here speaks the protocol from its description
//! alone (host-protocol.md sections 1 to 6).

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use harness::promptness::{answers_at_once, timed};
use harness::{Scratch, cc67};

use super::{Server, VERSION};

/// A client of the wire, and what it has received and not looked at.
struct Wire<S> {
    stream: S,
    received: Vec<u8>,
}

impl Wire<TcpStream> {
    /// A client of a server that listens on a raw port.
    fn over_tcp(server: &Server) -> Self {
        let address = server.places[0].strip_prefix("tcp:").expect("a port");
        let stream = TcpStream::connect(address).expect("it listens");
        stream.set_read_timeout(Some(Duration::from_secs(30))).expect("a time-out");
        Self { stream, received: Vec::new() }
    }
}

impl<S: Read + Write> Wire<S> {
    fn send(&mut self, bytes: &[u8]) {
        self.stream.write_all(bytes).expect("the board reads");
    }

    /// Sends a command line without echo.
    fn command(&mut self, line: &str) {
        self.send(format!("\x1b\x01{line}\r").as_bytes());
    }

    /// Waits until these bytes have come, and returns what came before them.
    fn until(&mut self, end: &[u8]) -> String {
        loop {
            if let Some(at) = self.received.windows(end.len()).position(|part| part == end) {
                let before = self.received.drain(..at + end.len()).take(at).collect();
                return String::from_utf8(before).expect("text");
            }
            let mut buffer = [0; 4096];
            match self.stream.read(&mut buffer) {
                Ok(0) => panic!("the board is gone"),
                Ok(count) => self.received.extend(&buffer[..count]),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => panic!("{error}: {:?}", String::from_utf8_lossy(&self.received)),
            }
        }
    }

    /// Sends a command and waits for these bytes after it.
    fn asks(&mut self, line: &str, answer: &str) {
        self.command(line);
        assert_eq!(self.until(answer.as_bytes()), "", "{line}");
    }

    /// Checks all that a client may see: an abort, a reply, an echo, an error, a console line, a file request.
    fn sees_the_board(&mut self) {
        self.send(b"half a command\x03");
        assert_eq!(self.until(b"\x1bC\r"), "half a command", "echoed, and then dropped");
        self.asks("Version;CheckThread1", &format!("{VERSION}\r\n0\r\n"));
        self.send(b"ReadBit46\r");
        assert_eq!(self.until(b"Ready\r\n"), "ReadBit46\r\n1\r\nKFLOP 4.34\r\n");
        self.asks("Bogus", "\x1bBOGUS\r\n\x1b^\r\n\x1berror, invalid command\r\n");
        self.command("Execute1");
        assert_eq!(self.until(b"\x1b\x04in.txt\r\n"), "\x1bC\r\n");
        self.command("ReadDiskData 1 5");
        self.command("66 69 72 73 74");
        assert_eq!(self.until(b"\x1bfirst\r\n"), "\x1b\x05\r\n");
    }
}

/// Prints the letter that an abort is answered with, then reads a line of a file, which is on the other side of the wire.
const PROGRAM: &str = r#"#include "KMotionDef.h"
main()
{
    char line[80];
    FILE *f;
    printf("C\n");
    f = fopen("in.txt", "rt");
    fgets(line, 80, f);
    printf("%s\n", line);
}
"#;

#[test]
fn one_client_over_tcp_has_the_link_of_the_board() {
    let arguments = ["serve", "--listen", "tcp-raw:0", "--once", "--load", "a.c"];
    let mut server = Server::start("wire-tcp", &arguments, PROGRAM, 1);
    // One that has sent nothing gives the link to the next.
    let mut silent = Wire::over_tcp(&server);
    let mut wire = Wire::over_tcp(&server);
    server.says("client 2: has the link of client 1, which has sent nothing");
    assert_eq!(silent.stream.read(&mut [0; 1]).expect("it is closed"), 0);
    wire.sees_the_board();
    let mut second = Wire::over_tcp(&server);
    server.says("client 3: refused, another one has the link");
    assert_eq!(second.stream.read(&mut [0; 1]).expect("it is closed"), 0);
    drop(wire);
    assert_eq!(server.ends().code(), Some(0), "the client is gone");
}

#[test]
fn a_thousand_silent_clients_do_not_have_the_link() {
    answers_at_once("serve of the link", || {
        let server =
            Server::start("wire-idle", &["serve", "--listen", "tcp-raw:0", "--load", "a.c"], PROGRAM, 1);
        let idle: Vec<_> = (0..1000).map(|_| Wire::over_tcp(&server)).collect();
        let time = timed(|| Wire::over_tcp(&server).asks("Version", &format!("{VERSION}\r\n")));
        drop(idle);
        time
    });
}

#[cfg(unix)]
#[test]
fn a_terminal_has_the_link_of_the_board() {
    for pace in ["1", "fast"] {
        let arguments = ["serve", "--listen", "pty", "--pace", pace, "--load", "a.c"];
        let server = Server::start("wire-pty", &arguments, PROGRAM, 1);
        let path = server.places[0].strip_prefix("serial:").expect("a terminal");
        let stream = std::fs::File::options().read(true).write(true).open(path).expect("it is there");
        let mut wire = Wire { stream, received: Vec::new() };
        if pace == "1" {
            wire.sees_the_board();
        } else {
            wire.asks("Version", &format!("{VERSION}\r\n"));
        }
    }
}

/// Prints a line each millisecond, and says when one has waited longer than a second.
const WATCHES: &str = r#"#include "KMotionDef.h"
main()
{
    int i = 0;
    double before;
    for (;;) {
        Delay_sec(0.001);
        before = Time_sec();
        printf("%d\n", i++);
        if (Time_sec() - before > 1.0) printf("waited\n");
    }
}
"#;

#[test]
fn a_program_waits_while_nobody_is_connected() {
    let arguments = ["serve", "--listen", "tcp-raw:0", "--pace", "100", "--load", "a.c"];
    let server = Server::start("wire-unread", &arguments, WATCHES, 1);
    let mut wire = Wire::over_tcp(&server);
    wire.command("Execute1");
    let seen = wire.until(b"\x1b999\r\n");
    assert!(!seen.contains("waited"), "{seen}");
    drop(wire);
    // The queue of the board is full after a quarter of a second of board time; here pass many seconds.
    std::thread::sleep(Duration::from_millis(300));
    let mut wire = Wire::over_tcp(&server);
    let seen = wire.until(b"\x1bwaited\r\n");
    let numbers: Vec<u32> =
        seen.lines().skip(1).filter_map(|line| line.trim_start_matches('\x1b').parse().ok()).collect();
    assert!(numbers.len() > 200, "the queue is kept: {seen}");
    assert!(numbers.windows(2).all(|pair| pair[0] + 1 == pair[1]), "nothing in it is lost: {seen}");
}

#[test]
fn a_wire_is_not_combined_with_what_it_excludes() {
    let scratch = Scratch::new("wire-wrong");
    for (arguments, expect) in [
        (&["--listen", "pty", "--listen", "tcp:0"][..], "the board has one link: `--listen pty tcp:0`"),
        (&["--listen", "pty", "--once"], "`--once`: who has opened a terminal is not known"),
        (&["--listen", "tcp-raw:0", "--log", "log.txt"], "`--log` writes calls of the vendor's library"),
        (&["--listen", "tcp-raw:x"], "`--listen tcp-raw:x`: `x` is not a port number"),
    ] {
        let wrong = cc67(&scratch, [&["serve"], arguments].concat());
        assert_eq!(wrong.code, 2, "{arguments:?}: {}", wrong.stderr);
        assert!(wrong.stderr.contains(expect), "{arguments:?}: {}", wrong.stderr);
    }
}

#[test]
fn the_users_own_firmware_is_at_the_other_end_of_a_wire() {
    let Some(firmware) = std::env::var_os("CC67_FIRMWARE") else {
        println!("not run: CC67_FIRMWARE names no firmware file");
        return;
    };
    let firmware = firmware.to_str().expect("a name of text").to_owned();
    let arguments = ["serve", "--boot", &firmware, "--listen", "tcp-raw:0", "--load", "a.c"];
    let server = Server::start("wire-boot", &arguments, PROGRAM, 1);
    Wire::over_tcp(&server).sees_the_board();
}
