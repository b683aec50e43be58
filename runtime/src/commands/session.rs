//! The context of a command, and the forms of its answer.

use kmotiondef::Cycles;
use vm::call::CallArguments;
use vm::firmware::{Caller, TickContext};
use vm::memory::GuestMemory;

use super::data::Data;
use super::memory::{Experiment, Geometry};
use crate::firmware::parts::Parts;

/// The answer to a command.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use]
pub(super) enum Answer {
    /// No reply, as for every command that sets a value.
    Nothing,
    /// A reply of one line.
    Line(String),
    /// A reply of several lines.
    Lines(Vec<String>),
    /// A console line.
    Console(Vec<u8>),
    /// A reply of one line, and after it a console line.
    LineAndConsole(&'static str, &'static str),
    /// The command continues with data lines.
    Data(Data),
    /// A console line with the reason for which the command was not executed.
    Refused(&'static str),
    /// The released firmware stops here, with a last answer.
    Stopped(Box<Answer>),
}

impl From<String> for Answer {
    fn from(line: String) -> Self {
        Self::Line(line)
    }
}

impl From<i32> for Answer {
    fn from(number: i32) -> Self {
        Self::Line(number.to_string())
    }
}

/// The board, for one command.
pub(super) struct Session<'a, 'c> {
    pub(super) parts: &'a mut Parts,
    /// The recorded motion in progress, if there is one.
    pub(super) experiment: &'a mut Option<Experiment>,
    pub(super) context: &'a mut TickContext<'c>,
    /// The state of the commands of coordinated motion.
    pub(super) geometry: &'a mut Geometry,
    /// The text after the word of `Echo` and the character that ends it, in upper case.
    pub(super) rest: &'a [u8],
}

impl Session<'_, '_> {
    /// Guest memory.
    pub(super) fn memory(&mut self) -> &mut GuestMemory {
        self.context.memory
    }

    /// Calls a firmware function as the primary thread, which never waits.
    pub(super) fn call<R>(&mut self, function: impl FnOnce(&mut Parts, &mut Caller<'_>) -> R) -> R {
        let mut budget = Cycles::PER_TICK;
        let mut caller = Caller {
            thread: None,
            memory: self.context.memory,
            threads: self.context.threads,
            tick: self.context.tick,
            slice_start: self.context.now,
            slice: budget,
            budget: &mut budget,
            woken: None,
            arguments: CallArguments::NONE,
            at: None,
        };
        function(self.parts, &mut caller)
    }
}
