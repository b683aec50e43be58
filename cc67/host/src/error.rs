//! Errors of calls.

use std::fmt;
use std::path::PathBuf;

use boot::FlashError;
use kmotiondef::{GuestAddr, ThreadId};
use runtime::loader::LoadError;
use runtime::stimulus::StimulusError;
use vm::engine::ForeignSnapshot;

use crate::capability::Unsupported;

/// The reason for which a call failed.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    /// The connection was closed, by [`Board::failed`](crate::Board::failed) or
    /// [`Board::disconnect`](crate::Board::disconnect).
    #[error("not connected to the board")]
    NotConnected,
    /// No reply came in time.
    #[error("the board did not answer in time")]
    Timeout,
    /// Another client holds the token.
    #[error("another client holds the token of the board")]
    InUse,
    /// There is no such thread.
    #[error("no such thread {0} (1-7)")]
    Thread(i32),
    /// A file cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        error: std::io::Error,
    },
    /// The source has errors; the text contains the compiler's messages.
    #[error("{0}")]
    Compile(CompileError),
    /// The image was rejected.
    #[error("{program}: {error}")]
    Refused {
        /// The file of the program.
        program: String,
        /// The reason.
        error: LoadError,
    },
    /// The file was made by another tool.
    #[error("{program} is {what}, not an image of `cc67 build`")]
    Foreign {
        /// The file.
        program: String,
        /// The kind of file.
        what: String,
    },
    /// A thread has no program that could be started.
    #[error("no program is loaded in thread {0}")]
    NotLoaded(ThreadId),
    /// An expression of the stimulus is wrong.
    #[error(transparent)]
    Stimulus(#[from] StimulusError),
    /// An address is outside memory.
    #[error("there is no memory at {0}")]
    Unmapped(GuestAddr),
    /// A firmware file does not start, or rejects its settings.
    #[error("{0}")]
    Firmware(String),
    /// A connected controller does not execute a command, or has been disconnected.
    #[error("{0}")]
    Link(String),
    /// A firmware file does not start from the contents of a flash.
    #[error("the flash does not work with this firmware: {0}")]
    Flash(#[from] FlashError),
    /// The target cannot do that.
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    /// A snapshot cannot be taken or restored.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// The requested operation on the board is not possible.
    #[error("{0}")]
    Act(String),
}

/// The reason for which a snapshot cannot be taken or restored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SnapshotError {
    /// The target has no snapshots.
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    /// The snapshot was taken with another engine, whose threads cannot continue here.
    #[error(transparent)]
    Foreign(#[from] ForeignSnapshot),
    /// The snapshot belongs to another kind of target.
    #[error("the snapshot is from another kind of board")]
    OtherTarget,
}

/// The compiler's messages about a source with errors: lines of `file:line: message`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompileError {
    text: String,
    messages: Vec<CompileMessage>,
}

/// An error in a source, with its position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompileMessage {
    /// The file, as named in messages.
    pub file: Option<String>,
    /// The line in it, from 1.
    pub line: Option<u32>,
    /// The column in it, from 1.
    pub column: Option<u32>,
    /// The message alone.
    pub message: String,
    /// The message as a terminal shows it: with the source line, the marked range, notes and help.
    pub report: String,
}

impl CompileMessage {
    /// A message without a position.
    #[must_use]
    pub fn new(message: String) -> Self {
        Self { file: None, line: None, column: None, report: message.clone(), message }
    }
}

impl CompileError {
    pub(crate) fn new(text: String) -> Self {
        let messages = vec![CompileMessage::new(text.clone())];
        Self { text, messages }
    }

    pub(crate) const fn of_messages(text: String, messages: Vec<CompileMessage>) -> Self {
        Self { text, messages }
    }

    /// The errors, in the order of the program.
    #[must_use]
    pub fn messages(&self) -> &[CompileMessage] {
        &self.messages
    }
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text.trim_end())
    }
}
