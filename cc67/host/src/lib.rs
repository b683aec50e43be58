//! A simulated KFLOP board under control, as a library.
//!
//! Everything here is a view of a [`session`]: a board with its programs. Its owner controls time, reads and changes
//! the board by the names in its programs, and acts as the world around it. [`Session`] is for a single owner: the
//! command, a test, a debugger or a page. [`Board`] shares a session among clients, with the operations of the vendor's
//! library for PC programs: compile and load, script commands and their replies, status, console, and the token, which
//! reserves the board for one client. Both use the simulated board (`cc67-runtime`) and the compiler (`cc67-compiler`),
//! which are independent of each other.
//!
//! ```text
//! client     Board: one of several clients, with the token and the calls of the vendor's library
//! state      shared by the clients: the session, replies and console lines that wait
//! session/   Session: setup, control of time, expressions, signals, manual actions, snapshots
//! remark     text for events of the board
//! message    texts in a caller's buffers
//! error      errors of calls
//! seats      connections of a server: a new one always gets a place
//! ```
//!
//! Board time does not pass between calls. Each exchange takes the time that was measured on a real board;
//! [`run_for`](Board::run_for) and [`run_until`](Board::run_until) let more time pass. So a test of a PC program is as
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
//! - Embedding a board needs no crate for terminals, pictures, web or command lines.
//! - Board time passes only in calls, as much as the call requests: no call reads a clock.
//! - Every change of a board goes through its session, so the recording of a session is complete.
//! - A session is a function of its setup and of the actions with their ticks, on any engine.

#![forbid(unsafe_code)]

mod capability;
mod client;
mod error;
mod message;
pub mod remark;
mod schedule;
pub mod seats;
pub mod session;
mod setup;
mod state;
pub mod target;
mod user_program;

pub use capability::{Capability, Unsupported};
pub use client::{Board, Lock, Readiness};
pub use compiler::Options;
pub use error::{CompileError, CompileMessage, HostError, SnapshotError};
pub use message::fill;
pub use remark::SourceCall;
pub use schedule::Schedule;
pub use session::{
    Attendant, AxisReport, Branch, BranchId, End, EndReport, History, IdleWork, Input, Interrupter, Session,
    Setup, Snapshot, ThreadReport, Timeline, TimelineError, Until, Watch, WatchError,
};
pub use state::{REPLY_BYTES, Status};
pub use target::{
    AnyTarget, BootedFirmware, BootedTarget, CONSOLE_LINES, ConnectedTarget, EventSink, FirmwareError,
    NoSnapshot, Target, TargetSnapshot,
};
pub use user_program::UserProgram;
/// The crates whose types appear in this interface, for programs that depend on none of our other crates.
pub use {kmotiondef, runtime};

/// The programs in the book are also tests.
#[cfg(doctest)]
#[doc = include_str!("../../book/src/embedding.md")]
struct Book;
