//! The lines sent by a firmware to the PC. Source: host-protocol.md sections 1 and 4.

/// The byte before a console line.
const ESCAPE: u8 = 0x1B;
/// The answer to an abort: the only line that ends with just a carriage return. With a line feed after it, it is a
/// console line with the text `C`.
const ABORTED: &[u8] = b"\x1bC\r";

/// The kind of a sent line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SentKind {
    /// Console text.
    Console,
    /// A reply to a command.
    Reply,
    /// A request to the PC about files; the bytes begin with its code.
    Request,
    /// The answer to an abort, without text.
    Aborted,
}

/// A sent line, without its line end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SentLine {
    /// The cycle of its first byte, since power-up.
    pub cycle: u64,
    /// The kind of line.
    pub kind: SentKind,
    /// Its text.
    pub text: Vec<u8>,
}

/// Splits the bytes sent by a firmware into lines.
#[derive(Clone, Debug, Default)]
pub(crate) struct SentLines {
    /// The cycle of the first byte of the incomplete line.
    first: u64,
    unfinished: Vec<u8>,
    lines: Vec<SentLine>,
    /// Bytes for a PC outside this process; `None` if there is none.
    wire: Option<Vec<u8>>,
}

impl SentLines {
    /// From now on also keeps the bytes themselves.
    pub(crate) fn keep_bytes(&mut self) {
        self.wire.get_or_insert_default();
    }

    /// The bytes since the last call.
    pub(crate) fn take_wire(&mut self) -> Vec<u8> {
        self.wire.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Takes bytes with their cycles and returns the lines that are complete.
    pub(crate) fn take(&mut self, bytes: Vec<(u64, u8)>) -> Vec<SentLine> {
        // No byte follows what looks like the answer to an abort.
        if bytes.is_empty() && self.unfinished == ABORTED {
            self.end_line(SentKind::Aborted, 0);
        }
        for (cycle, byte) in bytes {
            if let Some(wire) = &mut self.wire {
                wire.push(byte);
            }
            self.byte(cycle, byte);
        }
        std::mem::take(&mut self.lines)
    }

    fn byte(&mut self, cycle: u64, byte: u8) {
        if byte != b'\n' && self.unfinished == ABORTED {
            self.end_line(SentKind::Aborted, 0);
        }
        if byte == b'\n' {
            match self.unfinished[..] {
                [ESCAPE, 1..=7, ..] => self.end_line(SentKind::Request, 1),
                [ESCAPE, ..] => self.end_line(SentKind::Console, 1),
                _ => self.end_line(SentKind::Reply, 0),
            }
            return;
        }
        if self.unfinished.is_empty() {
            self.first = cycle;
        }
        self.unfinished.push(byte);
    }

    /// Completes the line; `from` is the beginning of its text.
    fn end_line(&mut self, kind: SentKind, from: usize) {
        let line = std::mem::take(&mut self.unfinished);
        let text = line.strip_suffix(b"\r").unwrap_or(&line);
        let text = if kind == SentKind::Aborted { &[] } else { text.get(from..).unwrap_or_default() };
        self.lines.push(SentLine { cycle: self.first, kind, text: text.to_vec() });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines of a stream that arrives in chunks of one size and then ends.
    fn lines(stream: &[u8], size: usize) -> Vec<(SentKind, String)> {
        let mut sent = SentLines::default();
        sent.keep_bytes();
        let pieces = stream.chunks(size).chain([&[][..]]);
        let lines: Vec<_> =
            pieces.flat_map(|piece| sent.take(piece.iter().map(|byte| (0, *byte)).collect())).collect();
        assert_eq!(sent.take_wire(), stream);
        let text = |line: SentLine| (line.kind, String::from_utf8(line.text).expect("text"));
        lines.into_iter().map(text).collect()
    }

    #[test]
    fn the_answer_to_an_abort_is_not_a_console_line_with_the_same_letter() {
        let stream = b"1\r\n\x1bC\r\x1bC\r\n\x1b\x04a.txt\r\n\r\n\x1bC\r";
        let expect = [
            (SentKind::Reply, "1"),
            (SentKind::Aborted, ""),
            (SentKind::Console, "C"),
            (SentKind::Request, "\x04a.txt"),
            (SentKind::Reply, ""),
            (SentKind::Aborted, ""),
        ];
        for size in [1, 2, 3, 100] {
            let found = lines(stream, size);
            let found: Vec<_> = found.iter().map(|(kind, text)| (*kind, text.as_str())).collect();
            assert_eq!(found, expect, "pieces of {size}");
        }
    }
}
