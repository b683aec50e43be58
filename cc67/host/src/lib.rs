//! A simulated KFLOP board under control, as a library.
//!
//! Everything here is a view of one thing, the [`session`]: a board with its programs, whose owner decides how far time
//! goes, looks at it and changes it in the words of its programs, and acts as the world around it. [`Session`] is that
//! board for one owner, as the command, tests, a debugger or a page want it. [`Board`] shares one among clients by the
//! operations of the vendor's library for PC programs under their names: compile and load, script commands and their
//! replies, status, console, the token that gives one client the board to itself. Below both are the simulated board
//! (`cc67-runtime`) and the compiler (`cc67-compiler`), which know nothing of each other.
//!
//! ```text
//! client     Board: one of several clients, with the token and the calls of the vendor's library
//! state      what the clients share: the session, replies and console lines that nobody has taken yet
//! session/   Session: setup, control of time, expressions, signals, what is done by hand, snapshots
//! remark     events of the board in words
//! message    texts in buffers of a caller
//! error      why a call did not do what it is for
//! ```
//!
//! No board time passes between calls; each exchange takes the time that was measured on the board, and
//! [`run_for`](Board::run_for) and [`run_until`](Board::run_until) let more of it pass. So a test of a PC program is as
//! deterministic as the board.
//!
//! ```
//! use cc67_host::Board;
//!
//! let mut board = Board::new();
//! board.write_line("SetPersistDec 5 42")?;
//! assert_eq!(board.write_line_read_line("GetPersistDec 5")?, "42");
//! # Ok::<(), cc67_host::HostError>(())
//! ```
//!
//! Source: host-protocol.md section 7 of the specification.
//!
//! Invariants:
//! - Who embeds a board builds no crate of terminals, pictures, web or command lines.
//! - Board time passes in calls alone, by what was asked for: no call looks at a clock.
//! - Nobody reaches around the session: what changes a board goes through it, so that a recording of a session is all
//!   that was done.
//! - A session is a function of its setup and of what was done at which tick, on any engine.

#![forbid(unsafe_code)]

mod client;
mod error;
mod message;
pub mod remark;
pub mod session;
mod state;

pub use client::{Board, Lock, Readiness};
pub use compiler::Options;
pub use error::{CompileError, HostError};
pub use message::fill;
pub use remark::SourceCall;
pub use session::{
    Attendant, End, Ending, EndingAxis, EndingThread, History, Idle, Input, Interrupter, Session, Setup,
    Snapshot, Timeline, TimelineError, Until, UserProgram, Watch, WatchError,
};
pub use state::{CONSOLE_LINES, REPLY_BYTES, Status};

/// The programs in the book are tests, too.
#[cfg(doctest)]
#[doc = include_str!("../../book/src/embedding.md")]
struct Book;
