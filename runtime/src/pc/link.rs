//! Bytes in transit to the board, and the lines that they form.
//!
//! A line that begins with an escape is taken without echo; the byte after the escape is discarded. Any other line is
//! echoed. 0x03 drops the line in progress, wherever it appears. Rules: host-protocol.md sections 1 and 2.

use std::collections::VecDeque;

use crate::out::ESCAPE;

/// Drops the line and the command in progress.
const ABORT: u8 = 0x03;
/// Ends a line.
const END: u8 = b'\r';

/// The position of the link in a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum LineState {
    /// Before its first byte.
    #[default]
    Start,
    /// After the escape: the next byte is discarded.
    Escaped,
    /// In its text.
    Silent,
    /// In the text of a line that is echoed.
    Echoed,
}

/// An item that has arrived.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ReceivedItem {
    /// 0x03: the line in progress is dropped.
    Abort,
    /// A line, and whether it was echoed.
    Line(Vec<u8>, bool),
}

/// The board's end of a line: the USB port, or the UART.
#[derive(Clone, Debug, Default)]
pub(crate) struct ByteLink {
    input: VecDeque<u8>,
    intake: LineState,
    line: Vec<u8>,
    /// True if the bytes are no longer taken.
    is_dead: bool,
}

impl ByteLink {
    /// Bytes arrive from the PC.
    pub(crate) fn receive(&mut self, bytes: &[u8]) {
        if !self.is_dead {
            self.input.extend(bytes);
        }
    }

    /// Takes all bytes that have arrived, for a board that reads its link by itself.
    pub(crate) fn take_all(&mut self) -> Vec<u8> {
        self.input.drain(..).collect()
    }

    /// Returns whether there are bytes to be taken.
    pub(crate) fn is_busy(&self) -> bool {
        !self.input.is_empty()
    }

    /// Takes bytes up to the end of a line, at most `limit` of its text, or to an abort; `None` if there are too few.
    /// Characters to be echoed are added to `echo`.
    pub(crate) fn next(&mut self, limit: usize, echo: &mut Vec<u8>) -> Option<ReceivedItem> {
        loop {
            let byte = self.input.pop_front()?;
            if byte == ABORT {
                self.intake = LineState::Start;
                self.line.clear();
                self.is_dead = false;
                return Some(ReceivedItem::Abort);
            }
            match self.intake {
                LineState::Start if byte == ESCAPE => {
                    self.intake = LineState::Escaped;
                    continue;
                }
                LineState::Escaped => {
                    self.intake = LineState::Silent;
                    continue;
                }
                LineState::Start => self.intake = LineState::Echoed,
                LineState::Silent | LineState::Echoed => {}
            }
            let is_echoed = self.intake == LineState::Echoed;
            if is_echoed {
                echo.push(byte);
            }
            let ends = byte == END;
            if !ends {
                self.line.push(byte);
            }
            if ends || self.line.len() == limit {
                echo.extend(is_echoed.then_some(b'\n'));
                self.intake = LineState::Start;
                return Some(ReceivedItem::Line(std::mem::take(&mut self.line), is_echoed));
            }
        }
    }

    /// Stops taking bytes: waiting and future bytes are lost.
    pub(crate) fn die(&mut self) {
        self.input.clear();
        self.is_dead = true;
    }

    /// Returns whether the board takes no more bytes.
    pub(crate) const fn is_dead(&self) -> bool {
        self.is_dead
    }
}
