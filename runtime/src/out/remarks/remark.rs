//! A remark: its message, its subject and its place.

use std::fmt;

use kmotiondef::{CodeAddr, ThreadId};

use super::Message;

/// The weight of a remark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// A remark that is only shown when all remarks are requested.
    Detail,
    /// A step that a program may have forgotten; a machine file can switch these off.
    Hint,
    /// Something is not as it was meant.
    Warning,
}

/// The subject of a remark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Speaker {
    /// The board, or its surroundings.
    #[default]
    Board,
    /// A call of a thread.
    Thread(ThreadId),
    /// A call of the call-back.
    CallBack,
    /// A script command.
    Command,
}

impl From<Option<ThreadId>> for Speaker {
    /// The thread of a call; `None` means the call-back.
    fn from(thread: Option<ThreadId>) -> Self {
        thread.map_or(Self::CallBack, Self::Thread)
    }
}

impl fmt::Display for Speaker {
    /// The words in front of a text about it.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Board => Ok(()),
            Self::Thread(thread) => write!(formatter, "thread {thread}: "),
            Self::CallBack => formatter.write_str("call-back: "),
            Self::Command => formatter.write_str("command: "),
        }
    }
}

/// The second place of a remark about two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OtherPlace {
    /// The thread; `None` for the call-back.
    pub thread: Option<ThreadId>,
    /// The instruction.
    pub at: CodeAddr,
}

impl fmt::Display for OtherPlace {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.thread {
            Some(thread) => write!(formatter, "thread {thread} at {}", self.at),
            None => write!(formatter, "the call-back at {}", self.at),
        }
    }
}

/// A remark of the simulation that the real board would not make.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// The message.
    pub message: Message,
    /// The subject.
    pub speaker: Speaker,
    /// The code address, if known.
    pub place: Option<CodeAddr>,
}

impl Remark {
    /// The second place of a remark about two threads, or about a thread and a call-back.
    #[must_use]
    pub fn other_thread(&self) -> Option<OtherPlace> {
        let own = match self.speaker {
            Speaker::Thread(thread) => Some(thread),
            Speaker::CallBack | Speaker::Command | Speaker::Board => None,
        };
        self.message.other().filter(|other| other.thread != own)
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}{}", self.speaker, self.message)
    }
}
