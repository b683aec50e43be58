//! The byte link between the PC and the board: lines in, replies out.
//!
//! The primary thread takes one line in each of its slices. A line that begins with an escape is taken without echo;
//! the byte behind the escape is thrown away. Any other line is echoed and followed by the board's name and `Ready`.
//! 0x03 drops what is under way, wherever it comes. While a command waits for its data lines the board sends no
//! console text. Rules: host-protocol.md sections 1 and 2.

use std::collections::VecDeque;

use vm::firmware::TickContext;

use super::arguments::{Message, Mistake, Reader, Values};
use super::data::Data;
use super::path::Geometry;
use super::{Answer, Command, Session, absent, find};
use crate::firmware::serial;
use crate::kernel::Kernel;
use crate::out::EventKind;

/// Drops the line and the command in progress.
const ABORT: u8 = 0x03;
/// Begins a line that is not echoed.
const ESCAPE: u8 = 0x1B;
/// Ends a line.
const END: u8 = b'\r';
/// Characters of a line; the last of them ends it.
const LINE_LIMIT: usize = 2560;
/// Characters of a data line.
const DATA_LIMIT: usize = 256;

/// Where in a line the link stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Intake {
    /// Before its first byte.
    #[default]
    Start,
    /// Behind the escape: the next byte is thrown away.
    Escaped,
    /// In its text.
    Silent,
    /// In the text of a line that is echoed.
    Echoed,
}

/// One end of the link: the USB port, or the UART.
#[derive(Clone, Debug, Default)]
pub(crate) struct Link {
    input: VecDeque<u8>,
    intake: Intake,
    line: Vec<u8>,
    /// Commands of the line that are still to be executed.
    parts: VecDeque<Vec<u8>>,
    /// What the command in progress waits for.
    data: Option<Data>,
    /// Whether name and `Ready` are due when the line is done.
    prompts: bool,
    /// Whether a command of the line has stopped the board's command loop, for good.
    is_stopped: bool,
    pub(super) geometry: Geometry,
}

impl Link {
    /// Bytes arrive from the PC.
    pub(crate) fn receive(&mut self, bytes: &[u8]) {
        if !self.is_stopped {
            self.input.extend(bytes);
        }
    }

    /// Whether bytes wait to be taken.
    pub(crate) fn is_busy(&self) -> bool {
        !self.input.is_empty()
    }

    /// Whether a command is in progress, so that no console text may be sent.
    pub(crate) const fn is_in_command(&self) -> bool {
        self.data.is_some()
    }

    /// Takes bytes up to the end of a line; `None` when they run out before.
    fn take_line(&mut self, out: &mut Vec<Output>) -> Option<Vec<u8>> {
        let mut echo = Vec::new();
        let line = loop {
            let Some(byte) = self.input.pop_front() else { break None };
            if byte == ABORT {
                flush(&mut echo, out);
                self.abort();
                out.push(Output::Aborted);
                continue;
            }
            match self.intake {
                Intake::Start if byte == ESCAPE => {
                    self.intake = Intake::Escaped;
                    continue;
                }
                Intake::Escaped => {
                    self.intake = Intake::Silent;
                    continue;
                }
                Intake::Start => self.intake = Intake::Echoed,
                Intake::Silent | Intake::Echoed => {}
            }
            let is_echoed = self.intake == Intake::Echoed;
            if is_echoed {
                echo.push(byte);
            }
            let ends = byte == END;
            if !ends {
                self.line.push(byte);
            }
            let limit = if self.data.is_some() { DATA_LIMIT } else { LINE_LIMIT };
            if ends || self.line.len() == limit {
                echo.extend(is_echoed.then_some(b'\n'));
                self.prompts |= is_echoed && self.data.is_none();
                self.intake = Intake::Start;
                break Some(std::mem::take(&mut self.line));
            }
        };
        flush(&mut echo, out);
        line
    }

    fn abort(&mut self) {
        *self = Self { input: std::mem::take(&mut self.input), geometry: self.geometry, ..Self::default() };
    }
}

fn flush(echo: &mut Vec<u8>, out: &mut Vec<Output>) {
    if !echo.is_empty() {
        out.push(Output::Echo(std::mem::take(echo)));
    }
}

/// What goes back to the PC.
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

    /// The bytes on the wire.
    fn into_wire(self) -> Vec<u8> {
        match self {
            Self::Echo(bytes) => bytes,
            Self::Aborted => vec![ESCAPE, b'C', END],
            Self::Reply(line) => [&line[..], b"\r\n"].concat(),
            Self::Console(line) => [&[ESCAPE][..], &line, b"\r\n"].concat(),
        }
    }
}

/// What the primary thread does for one end of the link in its slice: at most one line.
pub(crate) fn slice(kernel: &mut Kernel, context: &mut TickContext<'_>, end: fn(&mut Kernel) -> &mut Link) {
    let mut link = std::mem::take(end(kernel));
    let mut out = Vec::new();
    if let Some(line) = link.take_line(&mut out) {
        kernel.disturb();
        let mut turn = Turn { kernel, context, link: &mut link, out: &mut out };
        turn.line(&line);
    }
    *end(kernel) = link;
    let to_uart = serial::has_commands(kernel, context.memory);
    for output in out {
        if to_uart {
            serial::write(kernel, context.memory, &output.into_wire());
        } else {
            kernel.tell(context.now, output.into_event());
        }
    }
}

/// One line being executed.
struct Turn<'a, 'c> {
    kernel: &'a mut Kernel,
    context: &'a mut TickContext<'c>,
    link: &'a mut Link,
    out: &'a mut Vec<Output>,
}

impl Turn<'_, '_> {
    /// A command line, or a data line of the command in progress.
    fn line(&mut self, line: &[u8]) {
        let line = line.to_ascii_uppercase();
        if let Some(data) = self.link.data.take() {
            self.data(data, &line);
        } else {
            self.link.parts = line.split(|&byte| byte == b';').map(<[u8]>::to_vec).collect();
        }
        while self.link.data.is_none() {
            let Some(part) = self.link.parts.pop_front() else { break };
            if !part.is_empty() {
                self.part(&part);
            }
        }
        if self.link.data.is_none() && std::mem::take(&mut self.link.prompts) && !self.link.is_stopped {
            for line in ["KFLOP 4.34", "Ready"] {
                self.out.push(Output::Reply(line.into()));
            }
        }
    }

    fn data(&mut self, mut data: Data, line: &[u8]) {
        match data.line(self.context.memory, line) {
            Ok(()) if data.is_complete() => {
                let kernel = &mut *self.kernel;
                data.finish(kernel, self.context);
            }
            Ok(()) => self.link.data = Some(data),
            Err(mistake) => self.mistake(line, &mistake),
        }
    }

    /// One command.
    fn part(&mut self, part: &[u8]) {
        let Some((command, length)) = find(part) else {
            if let Some(text) = absent::explain(part) {
                self.kernel.tell(self.context.now, EventKind::Diagnostic(text));
            }
            return self.mistake(part, &Mistake { column: 0, message: Message::InvalidCommand });
        };
        match Values::read(command.arguments, &mut Reader::new(part, length)) {
            Ok(values) => self.execute(command, &values, part),
            Err(mistake) => self.mistake(part, &mistake),
        }
    }

    fn execute(&mut self, command: &Command, values: &Values, part: &[u8]) {
        self.kernel.is_commanding = true;
        let mut session =
            Session { kernel: self.kernel, context: self.context, geometry: &mut self.link.geometry, part };
        let answer = (command.run)(&mut session, values);
        self.kernel.is_commanding = false;
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

    /// The released firmware hangs here; so does the link, and the user is told.
    fn stop(&mut self, command: &Command) {
        self.link.parts.clear();
        self.link.input.clear();
        self.link.is_stopped = true;
        let name = command.name;
        let text = format!(
            "the released firmware stops at this use of `{name}`: it answers nothing until it is restarted"
        );
        self.kernel.tell(self.context.now, EventKind::Diagnostic(text));
    }

    /// Three console lines; what was to come of the line is dropped.
    fn mistake(&mut self, text: &[u8], mistake: &Mistake) {
        let caret = [" ".repeat(mistake.column).into_bytes(), b"^".to_vec()].concat();
        let message = mistake.message.text().into_bytes();
        let lines = if mistake.message == Message::Equals {
            [message, text.to_vec(), caret]
        } else {
            [text.to_vec(), caret, message]
        };
        self.out.extend(lines.map(Output::Console));
        self.link.parts.clear();
    }
}
