//! Requests and replies as bytes. Source: host-protocol.md section 8.
//!
//! Numbers have four bytes, texts end with a 0. A request consists of the number of a call, the number of a board and
//! the arguments of the call; a reply consists of a 0, the result and the output of the call. The
//! [connection](super::connection) separates messages.

/// The maximum size of a message to a client.
const LONGEST_REPLY: usize = 2561;
/// The first byte of a normal reply.
pub(super) const REPLY: u8 = 0;
/// The first byte of a console line.
const CONSOLE: u8 = 1;
/// The first byte of an error text.
const ERROR: u8 = 2;

/// The requested call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Call {
    WriteLineReadLine(Vec<u8>),
    WriteLine(Vec<u8>),
    WriteLineWithEcho(Vec<u8>),
    /// With the time limit in milliseconds.
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

impl Call {
    /// Its name in the vendor's library, with the line sent.
    pub(super) fn name(&self) -> String {
        let line = |name: &str, line: &[u8]| format!("{name}({})", String::from_utf8_lossy(line));
        match self {
            Self::WriteLineReadLine(text) => line("WriteLineReadLine", text),
            Self::WriteLine(text) => line("WriteLine", text),
            Self::WriteLineWithEcho(text) => line("WriteLineWithEcho", text),
            Self::ReadLine(milliseconds) => format!("ReadLineTimeOut({milliseconds})"),
            Self::ListLocations => "ListLocations".to_owned(),
            Self::Failed => "Failed".to_owned(),
            Self::Disconnect => "Disconnect".to_owned(),
            Self::FirmwareVersion => "FirmwareVersion".to_owned(),
            Self::CheckForReady => "CheckForReady".to_owned(),
            Self::Lock => "KMotionLock".to_owned(),
            Self::Location => "USBLocation".to_owned(),
            Self::Release => "ReleaseToken".to_owned(),
            Self::ServiceConsole => "ServiceConsole".to_owned(),
            Self::SetConsole => "SetConsole".to_owned(),
        }
    }
}

/// A request of a client.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Request {
    pub(super) call: Call,
    /// 0, -1 … for the first, second … connected board; otherwise the [location] of a board.
    board: i32,
}

/// The location of a board, by its index.
pub(super) fn location(index: usize) -> i32 {
    i32::try_from(index + 1).unwrap_or(i32::MAX)
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
            // A recovery call also requests the token.
            9 | 11 => Call::Lock,
            10 => Call::Location,
            12 => Call::Release,
            13 => Call::ServiceConsole,
            14 => Call::SetConsole,
            _ => return None,
        };
        Some(Self { call, board })
    }

    /// Its name for a log, including its board if that does not exist.
    pub(super) fn name(&self, boards: usize) -> String {
        let name = self.call.name();
        if self.index(boards).is_some() {
            name
        } else {
            format!("{name} for board {}, which is not there", self.board)
        }
    }

    /// Returns the index of its board, if there are that many.
    pub(super) fn index(&self, boards: usize) -> Option<usize> {
        let index = match usize::try_from(self.board) {
            Ok(0) => 0,
            Ok(location) => location - 1,
            Err(_) => self.board.unsigned_abs() as usize,
        };
        (index < boards).then_some(index)
    }
}

fn number(rest: &mut &[u8]) -> Option<i32> {
    let (bytes, tail) = rest.split_first_chunk()?;
    *rest = tail;
    Some(i32::from_le_bytes(*bytes))
}

fn text(bytes: &[u8]) -> Vec<u8> {
    bytes.split(|byte| *byte == 0).next().unwrap_or_default().to_vec()
}

/// The reply to a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Reply(Vec<u8>);

impl Reply {
    /// A reply with only a result.
    pub(super) fn number(result: i32) -> Self {
        Self([&[REPLY][..], &result.to_le_bytes()].concat())
    }

    /// A reply with a result and a text.
    pub(super) fn text(result: i32, text: &[u8]) -> Self {
        let mut reply = Self::number(result);
        let room = LONGEST_REPLY - reply.0.len() - 1;
        reply.0.extend(text.iter().copied().take(room).chain([0]));
        reply
    }

    /// A reply with a list of numbers.
    pub(super) fn numbers(list: &[i32]) -> Self {
        let mut reply = Self::number(0);
        let count = i32::try_from(list.len()).unwrap_or(0);
        reply.0.extend([count].iter().chain(list).flat_map(|number| number.to_le_bytes()));
        reply
    }

    pub(super) fn bytes(self) -> Vec<u8> {
        self.0
    }
}

/// A console line as a message.
pub(super) fn console_line(line: &[u8]) -> Vec<u8> {
    let room = LONGEST_REPLY - 4;
    [&[CONSOLE][..], line.get(..room).unwrap_or(line), b"\r\n\0"].concat()
}

/// An error text as a message.
pub(super) fn error_text(text: &str) -> Vec<u8> {
    [&[ERROR][..], text.as_bytes(), b"\0"].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The request of the specification's example, without its length.
    const VERSION: &[u8] = b"\0\0\0\0\0\0\0\0Version\0";

    #[test]
    fn the_example_of_the_specification_is_a_request() {
        let request = Request::read(VERSION).expect("a request");
        assert_eq!(request, Request { call: Call::WriteLineReadLine(b"Version".to_vec()), board: 0 });
        // The library of version 4.32 requests the token without a name.
        assert!(Request::read(&[9, 0, 0, 0, 0, 0, 0, 0]).is_some_and(|request| request.call == Call::Lock));
    }

    #[test]
    fn a_board_is_the_first_or_second_or_at_a_location() {
        for (board, boards, expect) in [
            (0, 1, Some(0)),
            (1, 1, Some(0)),
            (-1, 1, None),
            (2, 1, None),
            (-1, 2, Some(1)),
            (2, 2, Some(1)),
            (i32::MIN, 2, None),
        ] {
            assert_eq!(Request { call: Call::Lock, board }.index(boards), expect, "{board} of {boards}");
        }
    }

    #[test]
    fn invalid_requests_are_refused() {
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
    }

    #[test]
    fn a_list_is_preceded_by_its_length() {
        assert_eq!(Reply::numbers(&[7]).bytes(), b"\0\0\0\0\0\x01\0\0\0\x07\0\0\0");
        assert_eq!(Reply::text(0, &[b'x'; 9999]).bytes().len(), LONGEST_REPLY);
    }
}
