//! A client of a server, which speaks the protocol of host-protocol.md section 8.

use std::fs::{File, OpenOptions};
use std::io::{Read, Result, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicU32, Ordering};

/// Numbers of calls.
pub(super) const WRITE_LINE_READ_LINE: i32 = 0;
pub(super) const WRITE_LINE: i32 = 1;
pub(super) const WRITE_LINE_WITH_ECHO: i32 = 2;
pub(super) const READ_LINE: i32 = 3;
pub(super) const FAILED: i32 = 5;
pub(super) const DISCONNECT: i32 = 6;
pub(super) const CHECK_FOR_READY: i32 = 8;
pub(super) const LOCK: i32 = 9;
pub(super) const LOCATION: i32 = 10;
pub(super) const LOCK_RECOVERY: i32 = 11;
pub(super) const RELEASE: i32 = 12;
pub(super) const SERVICE_CONSOLE: i32 = 13;
pub(super) const SET_CONSOLE: i32 = 14;

/// A stream of bytes, or a pipe of Windows, that connects a client.
pub(super) trait Link: Read + Write + Send {
    /// Returns whether each write is a message; else the length of each comes before it.
    fn is_pipe(&self) -> bool {
        false
    }
}

impl Link for TcpStream {}

#[cfg(unix)]
impl Link for std::os::unix::net::UnixStream {}

/// The connection of most tests: over a port; or over a pipe where `CC67_TEST_PIPE` is in the environment.
#[derive(Debug)]
pub(super) enum Usual {
    Port(TcpStream),
    /// A pipe of Windows is opened like a file.
    Pipe(File),
}

impl Usual {
    /// Connects to a server by the place that it names.
    pub(super) fn connect(place: &str) -> Self {
        let Some(port) = place.strip_prefix("tcp:") else {
            return Self::Pipe(open_pipe(place));
        };
        let port: u16 = port.parse().expect("a number");
        Self::Port(TcpStream::connect(("127.0.0.1", port)).expect("it listens"))
    }

    /// Returns whether most tests go over a pipe.
    pub(super) fn is_over_pipe() -> bool {
        cfg!(windows) && std::env::var_os("CC67_TEST_PIPE").is_some()
    }

    /// An argument of a server, which names a pipe of its own in place of a free port if tests go over pipes.
    pub(super) fn address(word: &str) -> String {
        static PIPES: AtomicU32 = AtomicU32::new(0);
        if word == "tcp:0" && Self::is_over_pipe() {
            let number = PIPES.fetch_add(1, Ordering::Relaxed);
            return format!("pipe:cc67-test-{}-{number}", std::process::id());
        }
        word.to_owned()
    }
}

/// Opens a pipe, as soon as the server has made place for one more client.
fn open_pipe(path: &str) -> File {
    /// The system's number for a pipe that has no place yet.
    const BUSY: i32 = 231;
    loop {
        match OpenOptions::new().read(true).write(true).open(path) {
            Err(error) if error.raw_os_error() == Some(BUSY) => std::thread::yield_now(),
            opened => return opened.expect("it listens"),
        }
    }
}

impl Read for Usual {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        match self {
            Self::Port(stream) => stream.read(buffer),
            Self::Pipe(file) => file.read(buffer),
        }
    }
}

impl Write for Usual {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        match self {
            Self::Port(stream) => stream.write(bytes),
            Self::Pipe(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> Result<()> {
        match self {
            Self::Port(stream) => stream.flush(),
            Self::Pipe(file) => file.flush(),
        }
    }
}

impl Link for Usual {
    fn is_pipe(&self) -> bool {
        matches!(self, Self::Pipe(_))
    }
}

/// One connection.
pub(super) struct Client<S> {
    pub(super) stream: S,
    /// Console lines that came before replies, without their ends.
    pub(super) console: Vec<String>,
    /// Error texts that came before replies.
    pub(super) errors: Vec<String>,
}

impl<S: Link> Client<S> {
    pub(super) fn new(stream: S) -> Self {
        Self { stream, console: Vec::new(), errors: Vec::new() }
    }

    /// Sends a message.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        let length = u16::try_from(bytes.len()).expect("it is short").to_le_bytes();
        let length = if self.stream.is_pipe() { &[] } else { &length[..] };
        self.stream.write_all(&[length, bytes].concat()).expect("the server reads");
    }

    /// Makes a call for the first board; its result, and what comes with it.
    pub(super) fn call(&mut self, code: i32, arguments: &[u8]) -> (i32, Vec<u8>) {
        self.send(&[&code.to_le_bytes()[..], &[0; 4], arguments].concat());
        self.reply()
    }

    /// The next message of the server.
    fn message(&mut self) -> Vec<u8> {
        if self.stream.is_pipe() {
            let mut bytes = vec![0; 4096];
            let length = self.stream.read(&mut bytes).expect("a reply");
            bytes.truncate(length);
            return bytes;
        }
        let mut length = [0; 2];
        self.stream.read_exact(&mut length).expect("a reply");
        let mut bytes = vec![0; usize::from(u16::from_le_bytes(length))];
        self.stream.read_exact(&mut bytes).expect("a whole reply");
        bytes
    }

    /// The reply to the last call.
    pub(super) fn reply(&mut self) -> (i32, Vec<u8>) {
        loop {
            let bytes = self.message();
            assert!(bytes.len() <= 2561, "a client has no more room");
            if bytes[0] == 0 {
                let result = i32::from_le_bytes(bytes[1..5].try_into().expect("four bytes"));
                return (result, bytes[5..].to_vec());
            }
            let text = String::from_utf8(bytes[1..].to_vec()).expect("text");
            let text = text.strip_suffix('\0').expect("its end");
            match bytes[0] {
                1 => self.console.push(text.strip_suffix("\r\n").expect("a line").to_owned()),
                2 => self.errors.push(text.to_owned()),
                other => panic!("a message of kind {other}"),
            }
            self.stream.write_all(&[0xAA]).expect("the server waits for it");
        }
    }

    /// A line and the first line of its answer; the result, if that is not 0.
    pub(super) fn try_ask(&mut self, line: &str) -> std::result::Result<String, i32> {
        let (result, text) = self.call(WRITE_LINE_READ_LINE, format!("{line}\0").as_bytes());
        let text = String::from_utf8(text).expect("text").trim_end_matches('\0').to_owned();
        if result == 0 { Ok(text) } else { Err(result) }
    }

    /// A line and the first line of its answer.
    pub(super) fn ask(&mut self, line: &str) -> String {
        self.try_ask(line).expect(line)
    }

    pub(super) fn write_line(&mut self, line: &str) {
        assert_eq!(self.call(WRITE_LINE, format!("{line}\0").as_bytes()), (0, Vec::new()), "{line}");
    }

    /// The next line of an answer with its end, if it comes in time.
    pub(super) fn read_line(&mut self, milliseconds: i32) -> Option<String> {
        let (result, text) = self.call(READ_LINE, &milliseconds.to_le_bytes());
        let text = String::from_utf8(text).expect("text");
        let text = text.strip_suffix('\0').expect("its end");
        assert!(result == 0 || (result == 2 && text.is_empty()), "{result}, {text}");
        (result == 0).then(|| text.to_owned())
    }

    pub(super) fn lock(&mut self) -> i32 {
        self.call(LOCK, b"a test\0").0
    }

    pub(super) fn release(&mut self) {
        assert_eq!(self.call(RELEASE, b""), (0, Vec::new()));
    }

    /// Returns whether the server has ended the connection.
    pub(super) fn is_closed(&mut self) -> bool {
        matches!(self.stream.read(&mut [0; 1]), Ok(0) | Err(_))
    }
}
