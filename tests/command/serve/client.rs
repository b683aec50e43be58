//! A client of a server, which speaks the protocol of host-protocol.md section 8.

use std::io::{Read, Write};

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

/// One connection.
pub(super) struct Client<S> {
    pub(super) stream: S,
    /// Console lines that came before replies, without their ends.
    pub(super) console: Vec<String>,
    /// Error texts that came before replies.
    pub(super) errors: Vec<String>,
}

impl<S: Read + Write> Client<S> {
    pub(super) fn new(stream: S) -> Self {
        Self { stream, console: Vec::new(), errors: Vec::new() }
    }

    /// Sends a message.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        let length = u16::try_from(bytes.len()).expect("it is short").to_le_bytes();
        self.stream.write_all(&[&length[..], bytes].concat()).expect("the server reads");
    }

    /// Makes a call for the first board; its result, and what comes with it.
    pub(super) fn call(&mut self, code: i32, arguments: &[u8]) -> (i32, Vec<u8>) {
        self.send(&[&code.to_le_bytes()[..], &[0; 4], arguments].concat());
        self.reply()
    }

    /// The reply to the last call.
    pub(super) fn reply(&mut self) -> (i32, Vec<u8>) {
        loop {
            let mut length = [0; 2];
            self.stream.read_exact(&mut length).expect("a reply");
            let mut bytes = vec![0; usize::from(u16::from_le_bytes(length))];
            self.stream.read_exact(&mut bytes).expect("a whole reply");
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
    pub(super) fn try_ask(&mut self, line: &str) -> Result<String, i32> {
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

    /// Whether the server has ended the connection.
    pub(super) fn is_closed(&mut self) -> bool {
        matches!(self.stream.read(&mut [0; 1]), Ok(0) | Err(_))
    }
}
