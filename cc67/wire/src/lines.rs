//! Lines in the bytes that a board sends. Source: host-protocol.md sections 1, 4 and 6; wire.md section 2.5.

use std::collections::VecDeque;

/// The byte before a console line.
const ESCAPE: u8 = 0x1B;
/// Codes of disk requests.
const DISK: std::ops::RangeInclusive<u8> = 1..=7;
/// The longest line that is kept; the board's own limit is 2560 characters.
const LINE_LIMIT: usize = 4096;

/// An item sent by the board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Incoming {
    /// A line of a reply, without its end.
    Reply(Vec<u8>),
    /// A line of the console, without its end.
    Console(Vec<u8>),
    /// A request for a file: its code from 1 to 7, and the text after it.
    Disk(u8, Vec<u8>),
    /// The answer to the abort byte.
    Aborted,
}

/// Splits a stream of bytes into lines.
#[derive(Clone, Debug, Default)]
pub struct Decoder {
    line: Vec<u8>,
    /// True if the line began with an escape.
    is_console: bool,
    /// True after `ESC C CR`, until the next byte: LF makes it a console line.
    is_undecided: bool,
    ready: VecDeque<Incoming>,
}

impl Decoder {
    /// Adds received bytes.
    pub fn push(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.byte(*byte));
    }

    /// Returns the next item.
    pub fn take(&mut self) -> Option<Incoming> {
        self.ready.pop_front()
    }

    /// Returns whether the answer to an abort has come, unless a line feed follows.
    #[must_use]
    pub const fn may_be_aborted(&self) -> bool {
        self.is_undecided
    }

    /// Notes that nothing more has come: a possible answer to an abort is one.
    pub fn settle(&mut self) {
        if std::mem::take(&mut self.is_undecided) {
            self.ready.push_back(Incoming::Aborted);
        }
    }

    /// Returns whether an item waits.
    #[must_use]
    pub fn has_item(&self) -> bool {
        !self.ready.is_empty()
    }

    /// Drops everything received.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    fn byte(&mut self, byte: u8) {
        if std::mem::take(&mut self.is_undecided) {
            if byte == b'\n' {
                self.ready.push_back(Incoming::Console(b"C".to_vec()));
                return;
            }
            self.ready.push_back(Incoming::Aborted);
        }
        match byte {
            // A line that another one interrupts was truncated before it arrived.
            ESCAPE => {
                self.line.clear();
                self.is_console = true;
            }
            b'\r' if self.is_console && self.line == b"C" => {
                self.line.clear();
                self.is_console = false;
                self.is_undecided = true;
            }
            b'\n' => self.end(),
            byte if self.line.len() < LINE_LIMIT => self.line.push(byte),
            _ => {}
        }
    }

    fn end(&mut self) {
        let mut line = std::mem::take(&mut self.line);
        line.pop_if(|last| *last == b'\r');
        let item = match (std::mem::take(&mut self.is_console), line.first()) {
            (false, _) => Incoming::Reply(line),
            (true, Some(code)) if DISK.contains(code) => Incoming::Disk(*code, line.split_off(1)),
            (true, _) => Incoming::Console(line),
        };
        self.ready.push_back(item);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All items of a stream that arrives in chunks of one size.
    fn items(bytes: &[u8], size: usize) -> Vec<Incoming> {
        let mut decoder = Decoder::default();
        bytes.chunks(size).for_each(|piece| decoder.push(piece));
        decoder.settle();
        std::iter::from_fn(|| decoder.take()).collect()
    }

    #[test]
    fn replies_console_lines_and_requests_are_told_apart() {
        let stream = b"0\r\n\x1bHELLO\r\n\x1b\x04in.txt\r\n\x1b\x05\r\n\r\n\x1b\r\n";
        let expect = [
            Incoming::Reply(b"0".to_vec()),
            Incoming::Console(b"HELLO".to_vec()),
            Incoming::Disk(4, b"in.txt".to_vec()),
            Incoming::Disk(5, Vec::new()),
            Incoming::Reply(Vec::new()),
            Incoming::Console(Vec::new()),
        ];
        for size in [1, 2, 3, 100] {
            assert_eq!(items(stream, size), expect, "pieces of {size}");
        }
    }

    #[test]
    fn the_answer_to_an_abort_is_found_among_console_lines() {
        let stream = b"\x1bone\r\n\x1bC\r\x1btwo\r\n\x1bC\r\n\x1bC\r";
        let line = |text: &[u8]| Incoming::Console(text.to_vec());
        let expect = [line(b"one"), Incoming::Aborted, line(b"two"), line(b"C"), Incoming::Aborted];
        for size in [1, 2, 3, 100] {
            assert_eq!(items(stream, size), expect, "pieces of {size}");
        }
    }

    #[test]
    fn a_line_that_was_cut_is_dropped() {
        let stream = b"half a li\x1bC\r1\r\n";
        assert_eq!(items(stream, 4), [Incoming::Aborted, Incoming::Reply(b"1".to_vec())]);
    }

    #[test]
    fn an_endless_line_takes_bounded_memory() {
        let mut decoder = Decoder::default();
        (0..1000).for_each(|_| decoder.push(&[b'x'; 1000]));
        assert_eq!(decoder.line.len(), LINE_LIMIT);
    }
}
