//! The command loop: lines in, replies out.
//!
//! The primary thread takes one line in each of its slices. A line that was echoed is followed by the board's name and
//! `Ready`. While a command waits for its data lines the board sends no console text. Rules: host-protocol.md sections 1
//! and 2.

use std::collections::VecDeque;
use std::ops::Range;

use kmotiondef::boards::TargetBoard;
use vm::firmware::TickContext;

use super::arguments::{LineReader, Message as MistakeText, Mistake, Values};
use super::data::Data;
use super::memory::{Experiment, Geometry};
use super::session::{Answer, Session};
use super::{Command, absent, find};
use crate::firmware::parts::Parts;
use crate::firmware::serial;
use crate::out::{EventKind, Message};
use crate::pc::{ByteLink, Pc, ReceivedItem};

/// Characters of a line; the last of them ends it.
const LINE_LIMIT: usize = 2560;
/// The length of `Echo` and the character after it.
const ECHO: usize = 5;
/// Characters of a data line.
const DATA_LIMIT: usize = 256;

/// The state of the command loop for one end of the link: the USB port, or the UART.
#[derive(Clone, Debug, Default)]
pub(crate) struct Link {
    /// The line buffer, with a 0 after each line: the rest of an earlier, longer line remains after that.
    buffer: Vec<u8>,
    /// The ranges of its commands that are still to be executed.
    parts: VecDeque<Range<usize>>,
    /// The data for which the command in progress waits.
    data: Option<Data>,
    /// True if name and `Ready` are sent when the line is done.
    prompts: bool,
    geometry: Geometry,
}

impl Link {
    /// Returns whether a command is in progress, so that no console text may be sent.
    pub(crate) const fn is_in_command(&self) -> bool {
        self.data.is_some()
    }

    /// Puts a line into the buffer: a 0 ends each of its commands.
    fn load_line(&mut self, line: &[u8]) {
        let mut start = 0;
        for part in line.split(|&byte| byte == b';') {
            self.parts.push_back(start..start + part.len());
            start += part.len() + 1;
        }
        self.buffer.resize(self.buffer.len().max(start), 0);
        for (place, &byte) in self.buffer.iter_mut().zip(line.iter().chain([&0])) {
            *place = if byte == b';' { 0 } else { byte };
        }
    }

    /// The text of the buffer from an offset on.
    fn text_from(&self, from: usize) -> Vec<u8> {
        let rest = self.buffer.get(from..).unwrap_or_default();
        rest.iter().copied().take_while(|&byte| byte != 0).collect()
    }

    /// Takes the next line; `None` when the bytes run out before its end.
    fn take_line(&mut self, line: &mut ByteLink, out: &mut Vec<Output>) -> Option<Vec<u8>> {
        loop {
            let (mut echo, is_data) = (Vec::new(), self.data.is_some());
            let arrival = line.next(if is_data { DATA_LIMIT } else { LINE_LIMIT }, &mut echo);
            if !echo.is_empty() {
                out.push(Output::Echo(echo));
            }
            match arrival? {
                ReceivedItem::Abort => {
                    let buffer = std::mem::take(&mut self.buffer);
                    *self = Self { geometry: self.geometry, buffer, ..Self::default() };
                    out.push(Output::Aborted);
                }
                ReceivedItem::Line(text, is_echoed) => {
                    self.prompts |= is_echoed && !is_data;
                    return Some(text);
                }
            }
        }
    }
}

/// A text that is sent to the PC.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Output {
    Echo(Vec<u8>),
    Aborted,
    Reply(Vec<u8>),
    Console(Vec<u8>),
}

impl Output {
    fn into_event(self) -> EventKind {
        match self {
            Self::Echo(bytes) => EventKind::Echo(bytes),
            Self::Aborted => EventKind::Aborted,
            Self::Reply(line) => EventKind::Reply(line),
            Self::Console(line) => EventKind::ConsoleLine(line),
        }
    }
}

/// Returns the board's name for itself: its version up to the build.
fn board_name(board: &TargetBoard) -> &'static str {
    board.version.split_once(" Build").map_or(board.version, |(name, _)| name)
}

/// One end of the link, with the bytes on their way to it.
type Side = fn(&mut Pc) -> &mut ByteLink;

/// Executes at most one line from one end of the link, in the primary thread's slice.
pub(super) fn slice(
    link: &mut Link,
    side: Side,
    experiment: &mut Option<Experiment>,
    parts: &mut Parts,
    context: &mut TickContext<'_>,
) {
    let mut out = Vec::new();
    if let Some(line) = link.take_line(side(&mut parts.pc), &mut out) {
        parts.note_external_change();
        Turn { parts, experiment, context, link, side, out: &mut out }.line(&line);
    }
    let to_uart = serial::has_commands(parts, context.memory);
    for output in out {
        if to_uart {
            let bytes = output.into_event().on_wire().unwrap_or_default();
            serial::write(parts, context.memory, &bytes);
        } else {
            parts.out.emit(context.now, output.into_event());
        }
    }
}

/// One line being executed.
struct Turn<'a, 'c> {
    parts: &'a mut Parts,
    experiment: &'a mut Option<Experiment>,
    context: &'a mut TickContext<'c>,
    link: &'a mut Link,
    side: Side,
    out: &'a mut Vec<Output>,
}

impl Turn<'_, '_> {
    /// A command line, or a data line of the command in progress.
    fn line(&mut self, line: &[u8]) {
        let line = line.to_ascii_uppercase();
        if let Some(data) = self.link.data.take() {
            self.data(data, &line);
        } else {
            self.link.load_line(&line);
        }
        while self.link.data.is_none() {
            let Some(part) = self.link.parts.pop_front() else { break };
            if !part.is_empty() {
                let text = self.link.buffer.get(part.clone()).unwrap_or_default().to_vec();
                let rest = self.link.text_from(part.start + ECHO);
                self.part(&text, &rest);
            }
        }
        // The board queues console text, and sends it after the replies to the line.
        self.out.sort_by_key(|output| matches!(output, Output::Console(_)));
        let is_alive = !(self.side)(&mut self.parts.pc).is_dead();
        if self.link.data.is_none() && std::mem::take(&mut self.link.prompts) && is_alive {
            for line in [board_name(self.parts.level.board()), "Ready"] {
                self.out.push(Output::Reply(line.into()));
            }
        }
    }

    fn data(&mut self, mut data: Data, line: &[u8]) {
        match data.line(self.context.memory, line) {
            Ok(()) if data.is_complete() => {
                data.finish(&mut self.parts.pc.downloads, self.context);
            }
            Ok(()) => self.link.data = Some(data),
            Err(mistake) => self.print_mistake(line, &mistake),
        }
    }

    /// Executes one command; `rest` is the text after the word, if that is `Echo`.
    fn part(&mut self, part: &[u8], rest: &[u8]) {
        let set = self.parts.level.behaviour().commands;
        let Some((command, length)) = find(part, set) else {
            if let Some(message) = absent::explain(part, self.parts.level.board()) {
                self.parts.out.remark(self.context.now, message);
            }
            return self.print_mistake(part, &Mistake { column: 0, message: MistakeText::InvalidCommand });
        };
        match Values::read(command.arguments, set, &mut LineReader::new(part, length)) {
            Ok(values) => self.execute(command, &values, rest),
            Err(mistake) => self.print_mistake(part, &mistake),
        }
    }

    fn execute(&mut self, command: &Command, values: &Values, rest: &[u8]) {
        self.parts.out.is_commanding = true;
        let mut session = Session {
            parts: self.parts,
            experiment: self.experiment,
            context: self.context,
            geometry: &mut self.link.geometry,
            rest,
        };
        let answer = (command.run)(&mut session, values);
        self.parts.out.is_commanding = false;
        self.answer(command, answer);
    }

    fn answer(&mut self, command: &Command, answer: Answer) {
        match answer {
            Answer::Nothing => {}
            Answer::Line(line) => self.out.push(Output::Reply(line.into())),
            Answer::Lines(lines) => {
                self.out.extend(lines.into_iter().map(|line| Output::Reply(line.into())));
            }
            Answer::Console(line) => self.out.push(Output::Console(line)),
            Answer::LineAndConsole(line, console) => {
                self.out.push(Output::Reply(line.into()));
                self.out.push(Output::Console(console.into()));
            }
            Answer::Data(data) => self.link.data = Some(data),
            Answer::Refused(text) => {
                self.out.push(Output::Console(text.into()));
                self.link.parts.clear();
            }
            Answer::Stopped(last) => {
                self.answer(command, *last);
                self.stop(command);
            }
        }
    }

    /// Stops the link, as the released firmware hangs here, and makes a remark.
    fn stop(&mut self, command: &Command) {
        self.link.parts.clear();
        (self.side)(&mut self.parts.pc).die();
        let message = Message::FirmwareStops { command: command.name };
        self.parts.out.remark(self.context.now, message);
    }

    /// Prints the three console lines of a mistake; the rest of the line is dropped.
    fn print_mistake(&mut self, text: &[u8], mistake: &Mistake) {
        let caret = [" ".repeat(mistake.column).into_bytes(), b"^".to_vec()].concat();
        let message = mistake.message.text().into_bytes();
        let lines = if mistake.message == MistakeText::Equals {
            [message, text.to_vec(), caret]
        } else {
            [text.to_vec(), caret, message]
        };
        self.out.extend(lines.map(Output::Console));
        self.link.parts.clear();
    }
}
