//! The host interface: a simulated board for programs that would drive a real one.
//!
//! [`Board`] offers the operations of the vendor's library for PC programs under their names: compile and load a
//! program, send script commands and read replies, poll status, receive console lines, share the board with other
//! clients by its token. What it adds is time: a simulated board stands still between calls, each exchange takes the
//! time that it was measured to take, and [`run_for`](Board::run_for) and [`run_until`](Board::run_until) let more
//! of it pass. So a test of a PC program is as deterministic as the board.
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

#![forbid(unsafe_code)]

mod client;
mod message;
mod program;
pub mod remark;
mod state;

pub use client::{Board, Lock, Readiness};
pub use message::fill;
pub use program::CompileError;
pub use state::{CONSOLE_LINES, REPLY_BYTES, Status};

use std::path::PathBuf;

use runtime::loader::LoadError;

/// The programs in the book are tests, too.
#[cfg(doctest)]
#[doc = include_str!("../../book/src/embedding.md")]
struct Book;

/// Why a call did not do what it is for.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    /// The connection was given up, by [`Board::failed`] or [`Board::disconnect`].
    #[error("not connected to the board")]
    NotConnected,
    /// No reply came in time.
    #[error("the board did not answer in time")]
    Timeout,
    /// Another client holds the token.
    #[error("another client has the board to itself")]
    InUse,
    /// There is no such thread.
    #[error("there is no thread {0}; there are 1 to 7")]
    Thread(i32),
    /// A file cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        error: std::io::Error,
    },
    /// The source has errors; the text is what the compiler says.
    #[error("{0}")]
    Compile(CompileError),
    /// The image is refused.
    #[error(transparent)]
    Load(#[from] LoadError),
}
