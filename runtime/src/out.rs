//! What a run tells the outside, with the board time at which it happened.

use std::sync::Arc;

use kmotiondef::{Bit, CodeAddr, Cycles, ThreadId};
use vm::trap::Trap;

use crate::world::trace::Record;

/// One event and its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The instant; power-up is 0.
    pub at: Cycles,
    /// What happened.
    pub kind: EventKind,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// The PC received a line of console text, without its line end.
    ConsoleLine(Vec<u8>),
    /// The PC received a line of a reply, without its line end.
    Reply(Vec<u8>),
    /// The PC received back what it sent: the characters of a line without an escape.
    Echo(Vec<u8>),
    /// The PC received the answer to 0x03: the line or command in progress is dropped.
    Aborted,
    /// A program read an input that nothing drives; once for each bit.
    UndrivenInput {
        /// The bit.
        bit: Bit,
        /// The thread that read it; `None` for the call-back.
        thread: Option<ThreadId>,
        /// Where the program stands, as far as known.
        place: Option<CodeAddr>,
    },
    /// The operator gives an input the other level for a while.
    Assisted {
        /// The input.
        bit: Bit,
        /// Its level for that while.
        level: bool,
        /// The thread that waits for it.
        thread: Option<ThreadId>,
        /// Where the program stands, as far as known.
        place: Option<CodeAddr>,
    },
    /// A remark of the simulation that the real board would not make.
    Diagnostic(String),
    /// A remark that is only worth making to who asks for all of them.
    Detail(String),
    /// A stimulus has loaded the program of this name.
    Loaded(ThreadId, Arc<str>),
    /// A thread was stopped by a trap.
    Trap(Trap),
    /// Something that was asked to be recorded.
    Trace(Record),
    /// The UART has sent a character; told to who asked for it.
    UartSent(u8),
    /// Something that the stimulus expects is not so.
    Unmet(String),
    /// The PC did something that a program asked for.
    Host(String),
}
