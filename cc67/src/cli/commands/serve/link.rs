//! Data received from the board over its link and not read yet.
//!
//! Lines of replies, echoes and the console are read in the order in which they came. Source: host-protocol.md sections
//! 4, 7 and 9.

use std::collections::VecDeque;
use std::mem;

use cc67_host::REPLY_BYTES;

/// The number of console lines kept while no client is the console; older ones are dropped.
pub(in crate::cli::commands) const UNHEARD_LINES: usize = 256;
/// The number of console lines waiting for the console's client from which the board is no longer read, and programs
/// that print have to wait, as on a board whose PC reads nothing.
pub(in crate::cli::commands) const CONSOLE_LINES: usize = 10_000;

/// A line of the board, without its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum LinkLine {
    /// A line of a reply, or the echo of a command.
    Reply(Vec<u8>),
    /// A line of the console.
    Console(Vec<u8>),
}

/// The unread lines.
#[derive(Debug, Default)]
pub(super) struct UnreadLines {
    /// Each line with its number in the order of arrival.
    replies: VecDeque<(u64, Vec<u8>)>,
    console: VecDeque<(u64, Vec<u8>)>,
    /// The incomplete echo of a line.
    partial: Vec<u8>,
    lines: u64,
    reply_bytes: usize,
    lost_replies: bool,
}

impl UnreadLines {
    /// Adds a line of a reply.
    pub(super) fn reply(&mut self, line: &[u8]) {
        let mut whole = mem::take(&mut self.partial);
        whole.extend(line);
        if self.reply_bytes + whole.len() > REPLY_BYTES {
            self.lost_replies = true;
            return;
        }
        self.reply_bytes += whole.len();
        self.lines += 1;
        self.replies.push_back((self.lines, whole));
    }

    /// Adds characters that the board has echoed.
    pub(super) fn echo(&mut self, bytes: &[u8]) {
        for byte in bytes {
            match byte {
                b'\n' => self.reply(&[]),
                b'\r' => {}
                byte => self.partial.push(*byte),
            }
        }
    }

    /// Adds a console line; `is_heard` is true if a client is the console.
    pub(super) fn console(&mut self, line: Vec<u8>, is_heard: bool) {
        while !is_heard && self.console.len() >= UNHEARD_LINES {
            self.console.pop_front();
        }
        self.lines += 1;
        self.console.push_back((self.lines, line));
    }

    /// Returns the number of waiting console lines.
    pub(super) fn console_lines(&self) -> usize {
        self.console.len()
    }

    /// Returns whether any line waits.
    pub(super) fn has_line(&self) -> bool {
        !self.replies.is_empty() || !self.console.is_empty()
    }

    /// Returns whether a line has begun.
    pub(super) fn has_partial_line(&self) -> bool {
        !self.partial.is_empty()
    }

    /// The next line of either kind.
    pub(super) fn next(&mut self) -> Option<LinkLine> {
        let reply = self.replies.front().map_or(u64::MAX, |(number, _)| *number);
        if self.console.front().is_some_and(|(number, _)| *number < reply) {
            return self.console.pop_front().map(|(_, line)| LinkLine::Console(line));
        }
        let (_, line) = self.replies.pop_front()?;
        self.reply_bytes -= line.len();
        Some(LinkLine::Reply(line))
    }

    /// Drops everything, as when the link is reopened.
    pub(super) fn clear(&mut self) {
        self.replies.clear();
        self.console.clear();
        self.partial.clear();
        self.reply_bytes = 0;
    }

    /// Returns once whether unread replies were lost.
    pub(super) fn take_lost_replies(&mut self) -> bool {
        mem::take(&mut self.lost_replies)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read_in_their_order() {
        let mut link = UnreadLines::default();
        link.console(b"one".to_vec(), true);
        link.echo(b"Read");
        assert!(link.has_partial_line());
        link.echo(b"Bit46\r\n");
        link.console(b"two".to_vec(), true);
        link.reply(b"1");
        let order: Vec<_> = std::iter::from_fn(|| link.next()).collect();
        let console = |text: &[u8]| LinkLine::Console(text.to_vec());
        let reply = |text: &[u8]| LinkLine::Reply(text.to_vec());
        assert_eq!(order, [console(b"one"), reply(b"ReadBit46"), console(b"two"), reply(b"1")]);
        assert!(!link.has_line());
    }

    #[test]
    fn unread_lines_and_replies_are_limited() {
        let mut link = UnreadLines::default();
        for number in 0..UNHEARD_LINES + 10 {
            link.console(number.to_string().into_bytes(), false);
        }
        assert_eq!(link.next(), Some(LinkLine::Console(b"10".to_vec())));
        for _ in 0..=REPLY_BYTES / 1000 {
            link.reply(&[b'x'; 1000]);
        }
        assert!(link.take_lost_replies());
        assert!(!link.take_lost_replies());
    }
}
