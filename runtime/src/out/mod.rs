//! Events of a run, with the board time at which they happened.
//!
//! Every part of the board can report events. Events have no effect on the simulation, except for console lines for
//! which a stimulus waits.

mod console;
mod record;
mod remarks;

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use kmotiondef::{CodeAddr, Cycles, ThreadId};
use vm::firmware::Caller;
use vm::trap::Trap;

pub(crate) use console::{Console, LINE_LIMIT};
pub use record::Record;
pub(crate) use remarks::LOST_AT;
pub use remarks::{Message, OtherPlace, REMARKS, Remark, RemarkRow, Severity, Speaker};

/// Begins a console line on the wire, and a line to the board that is not echoed.
pub(crate) const ESCAPE: u8 = 0x1B;

/// The output of a run: console text in transit, events not yet taken, requests to the board.
#[derive(Clone, Debug)]
pub(crate) struct Out {
    pub(crate) console: Console,
    events: Vec<Event>,
    requests: Vec<Request>,
    /// Console lines that a stimulus has not seen; `None` if there is none.
    lines: Option<VecDeque<(Cycles, Vec<u8>)>>,
    /// Bytes not yet sent to the remote PC; `None` without one.
    wire: Option<Vec<u8>>,
    /// True if hints are reported: remarks about steps that a program may have forgotten.
    pub(crate) hints: bool,
    /// True while a script command is executed.
    pub(crate) is_commanding: bool,
    /// Codes of remarks that are switched off.
    unwanted: BTreeSet<&'static str>,
    /// Remarks made once that have already been made: code and distinguishing key.
    made: BTreeSet<(&'static str, u64)>,
}

impl Default for Out {
    fn default() -> Self {
        Self {
            console: Console::default(),
            events: Vec::new(),
            requests: Vec::new(),
            lines: None,
            wire: None,
            hints: true,
            is_commanding: false,
            unwanted: BTreeSet::new(),
            made: BTreeSet::new(),
        }
    }
}

impl Out {
    /// Records an event.
    pub(crate) fn emit(&mut self, at: Cycles, kind: EventKind) {
        if let (EventKind::ConsoleLine(line), Some(lines)) = (&kind, &mut self.lines) {
            lines.push_back((at, line.clone()));
        }
        if let (Some(wire), Some(bytes)) = (&mut self.wire, kind.on_wire()) {
            wire.extend(bytes);
        }
        self.events.push(Event { at, kind });
    }

    /// Makes a remark about the board or its surroundings.
    pub(crate) fn remark(&mut self, at: Cycles, message: Message) {
        self.remark_of(at, Speaker::Board, None, message);
    }

    /// Switches remarks of this code off.
    pub(crate) fn disable_remark(&mut self, code: &'static str) {
        self.unwanted.insert(code);
    }

    /// A remark about a call.
    pub(crate) fn diagnose(&mut self, caller: &Caller<'_>, message: Message) {
        let speaker = match caller.thread {
            Some(thread) => Speaker::Thread(thread),
            None if self.is_commanding => Speaker::Command,
            None => Speaker::CallBack,
        };
        self.remark_of(caller.now(), speaker, caller.at, message);
    }

    /// Makes a remark about a subject, unless it was already made or is switched off.
    pub(crate) fn remark_of(
        &mut self,
        at: Cycles,
        speaker: Speaker,
        place: Option<CodeAddr>,
        message: Message,
    ) {
        let is_hint = message.severity() == Severity::Hint;
        let is_wanted = (self.hints || !is_hint) && !self.unwanted.contains(message.code());
        let is_new = |key| self.made.insert((message.code(), key));
        if is_wanted && message.once().is_none_or(is_new) {
            self.emit(at, EventKind::Remark(Remark { message, speaker, place }));
        }
    }

    /// Allows remarks of these codes to be made again.
    pub(crate) fn forget_remarks(&mut self, codes: &[&str]) {
        self.made.retain(|(code, _)| !codes.contains(code));
    }

    /// The events since the last call.
    pub(crate) fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// Requests an action of the board as a whole, to be executed after this tick.
    pub(crate) fn ask(&mut self, request: Request) {
        self.requests.push(request);
    }

    /// Takes the requests since the last call.
    pub(crate) fn take_requests(&mut self) -> Vec<Request> {
        std::mem::take(&mut self.requests)
    }

    /// Keeps the bytes on the wire from now on.
    pub(crate) fn tap_wire(&mut self) {
        self.wire.get_or_insert_default();
    }

    /// The bytes on the wire since the last call.
    pub(crate) fn take_wire(&mut self) -> Vec<u8> {
        self.wire.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Keeps console lines for a stimulus from now on.
    pub(crate) fn keep_lines(&mut self) {
        self.lines.get_or_insert_default();
    }

    /// The next console line that a stimulus has not seen.
    pub(crate) fn next_line(&mut self) -> Option<(Cycles, Vec<u8>)> {
        self.lines.as_mut()?.pop_front()
    }

    /// Returns whether a stimulus has seen every console line.
    pub(crate) fn has_shown_lines(&self) -> bool {
        self.lines.as_ref().is_none_or(VecDeque::is_empty)
    }
}

/// A request to the board as a whole, which holds the programs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Request {
    /// Make a program from the download into a thread that was started.
    Load(ThreadId),
    /// Save programs and settings in flash.
    Flash,
    /// Restart from flash.
    Reboot,
    /// Load a program that was offered and start it.
    Run(ThreadId, Arc<str>),
}

/// One event and its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The instant; power-up is 0.
    pub at: Cycles,
    /// The kind and contents of the event.
    pub kind: EventKind,
}

/// The kind and contents of an event.
#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// The PC received a line of console text, without its line end.
    ConsoleLine(Vec<u8>),
    /// The PC received a line of a reply, without its line end.
    Reply(Vec<u8>),
    /// The echo to the PC: the characters of a line that did not begin with an escape.
    Echo(Vec<u8>),
    /// The PC received the answer to 0x03: the line or command in progress is dropped.
    Aborted,
    /// A remark of the simulation that the real board would not make.
    Remark(Remark),
    /// A stimulus has loaded the program of this name.
    Loaded(ThreadId, Arc<str>),
    /// A thread was stopped by a trap.
    Trap(Trap),
    /// A record of a requested recording.
    Trace(Record),
    /// The UART has sent a character; reported on request.
    UartSent(u8),
    /// An expectation of the stimulus is not met.
    Unmet(String),
    /// An action of the PC that a program requested.
    Host(String),
    /// The processor of the board has stopped for good: why, where, and its registers.
    Halted(String),
}

impl EventKind {
    /// The bytes that the PC receives; `None` where it receives none. Source: host-protocol.md sections 1 and 4.
    pub(crate) fn on_wire(&self) -> Option<Vec<u8>> {
        match self {
            Self::ConsoleLine(line) => Some([&[ESCAPE][..], line, b"\r\n"].concat()),
            Self::Reply(line) => Some([&line[..], b"\r\n"].concat()),
            Self::Echo(bytes) => Some(bytes.clone()),
            Self::Aborted => Some(vec![ESCAPE, b'C', b'\r']),
            Self::Remark(_)
            | Self::Loaded(..)
            | Self::Trap(_)
            | Self::Trace(_)
            | Self::UartSent(_)
            | Self::Unmet(_)
            | Self::Host(_)
            | Self::Halted(_) => None,
        }
    }
}
