//! Requests and replies as bytes. Source: host-protocol.md section 8.
//!
//! A message is its length, two bytes with the low one first, and this many bytes. Numbers have four bytes, texts end with
//! a 0. A request is the number of a call, the number of a board and what the call takes; a reply is a 0, the result and
//! what the call yields.

use std::io::{Read, Write};

/// Bytes of a message to us at most.
const LONGEST: usize = 4096;
/// Bytes of a message from us at most.
const LONGEST_REPLY: usize = 2561;
/// Begins a normal reply.
const REPLY: u8 = 0;
/// Begins a console line.
const CONSOLE: u8 = 1;

/// What is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Call {
    WriteLineReadLine(String),
    WriteLine(String),
    WriteLineWithEcho(String),
    /// With the time it may take, in milliseconds.
    ReadLine(u32),
    ListLocations,
    Failed,
    Disconnect,
    FirmwareVersion,
    CheckForReady,
    Lock,
    Location,
    Release,
    ServiceConsole,
    SetConsole,
}

/// A request of a client.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Request {
    pub(super) call: Call,
    /// 0, -1 … for the first, second … board that is connected; else the identifier of one.
    board: i32,
}

impl Request {
    /// Reads a request; `None` if there is no such call.
    pub(super) fn read(bytes: &[u8]) -> Option<Self> {
        let mut rest = bytes;
        let code = number(&mut rest)?;
        let board = if code == 4 { 0 } else { number(&mut rest)? };
        let call = match code {
            0 => Call::WriteLineReadLine(text(rest)),
            1 => Call::WriteLine(text(rest)),
            2 => Call::WriteLineWithEcho(text(rest)),
            3 => Call::ReadLine(u32::try_from(number(&mut rest)?).unwrap_or(0)),
            4 => Call::ListLocations,
            5 => Call::Failed,
            6 => Call::Disconnect,
            7 => Call::FirmwareVersion,
            8 => Call::CheckForReady,
            // Recovery asks for the token as well.
            9 | 11 => Call::Lock,
            10 => Call::Location,
            12 => Call::Release,
            13 => Call::ServiceConsole,
            14 => Call::SetConsole,
            _ => return None,
        };
        Some(Self { call, board })
    }

    /// Whether it is for the first of the boards that are connected, the only one there is.
    pub(super) fn is_for(&self, locations: &[i32]) -> bool {
        self.board == 0 || locations.first() == Some(&self.board)
    }
}

fn number(rest: &mut &[u8]) -> Option<i32> {
    let (bytes, tail) = rest.split_first_chunk()?;
    *rest = tail;
    Some(i32::from_le_bytes(*bytes))
}

fn text(bytes: &[u8]) -> String {
    let bytes = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
    String::from_utf8_lossy(bytes).into_owned()
}

/// What a request is answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Reply(Vec<u8>);

impl Reply {
    /// A result alone.
    pub(super) fn number(result: i32) -> Self {
        Self([&[REPLY][..], &result.to_le_bytes()].concat())
    }

    /// A result and a text.
    pub(super) fn text(result: i32, text: &str) -> Self {
        let mut reply = Self::number(result);
        let room = LONGEST_REPLY - reply.0.len() - 1;
        reply.0.extend(text.bytes().take(room).chain([0]));
        reply
    }

    /// A list of numbers.
    pub(super) fn numbers(list: &[i32]) -> Self {
        let mut reply = Self::number(0);
        let count = i32::try_from(list.len()).unwrap_or(0);
        reply.0.extend([count].iter().chain(list).flat_map(|number| number.to_le_bytes()));
        reply
    }

    /// Its bytes.
    pub(super) fn bytes(self) -> Vec<u8> {
        self.0
    }
}

/// A console line as a message.
pub(super) fn console_line(line: &str) -> Vec<u8> {
    [&[CONSOLE][..], line.as_bytes(), b"\r\n\0"].concat()
}

/// Reads a message; `None` if the client is gone, or sends what cannot be one.
pub(super) fn read(stream: &mut impl Read) -> Option<Vec<u8>> {
    let mut length = [0; 2];
    stream.read_exact(&mut length).ok()?;
    let mut bytes = vec![0; usize::from(u16::from_le_bytes(length))];
    if bytes.len() > LONGEST {
        return None;
    }
    stream.read_exact(&mut bytes).ok()?;
    Some(bytes)
}

/// Sends a message; `None` if the client is gone.
pub(super) fn write(stream: &mut impl Write, bytes: &[u8]) -> Option<()> {
    let length = u16::try_from(bytes.len()).ok()?;
    stream.write_all(&[&length.to_le_bytes()[..], bytes].concat()).and_then(|()| stream.flush()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The request of the specification's example, without its length.
    const VERSION: &[u8] = b"\0\0\0\0\0\0\0\0Version\0";

    #[test]
    fn the_example_of_the_specification_is_read_and_answered() {
        let mut stream = &[&[0x10, 0][..], VERSION].concat()[..];
        let bytes = read(&mut stream).expect("a message");
        let request = Request::read(&bytes).expect("a request");
        assert_eq!(request, Request { call: Call::WriteLineReadLine("Version".to_owned()), board: 0 });
        let mut sent = Vec::new();
        let reply = Reply::text(0, "KFLOP 4.34 Build 16:07:06 Aug 14 2018").bytes();
        assert_eq!(write(&mut sent, &reply), Some(()));
        assert_eq!(&sent[..7], [0x2B, 0, 0, 0, 0, 0, 0]);
        assert_eq!(sent.len(), 2 + 0x2B);
    }

    #[test]
    fn requests_that_are_none_are_refused() {
        for bytes in [
            &b""[..],
            b"\0\0\0",
            b"\0\0\0\0",
            b"\x0F\0\0\0\0\0\0\0",
            b"\x03\0\0\0\0\0\0\0",
            b"\xFF\xFF\xFF\xFF\0\0\0\0",
        ] {
            assert_eq!(Request::read(bytes), None, "{bytes:?}");
        }
        assert_eq!(read(&mut &b"\xFF\xFF"[..]), None);
        assert_eq!(read(&mut &b"\x05\0abc"[..]), None);
    }

    #[test]
    fn a_list_has_its_length_in_front() {
        assert_eq!(Reply::numbers(&[7]).bytes(), b"\0\0\0\0\0\x01\0\0\0\x07\0\0\0");
        assert_eq!(Reply::text(0, &"x".repeat(9999)).bytes().len(), LONGEST_REPLY);
    }
}
