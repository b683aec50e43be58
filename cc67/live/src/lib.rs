//! A simulated board on a page in the browser.
//!
//! A [`Server`] listens on this computer and hands out the page, which is part of the binary. It then
//! [runs](Server::run) a [`Session`](cc67_host::Session) at the pace of a clock, on the thread of the caller. Pages are
//! views: they are sent what the board does, and ask for what a person wants done. A session that somebody else runs is
//! shown by a [`LiveView`].
//!
//! ```text
//! server/    connections: the files of the page, the check of who asks, the sockets
//! board/     the session under the clock: frames, signals, threads, messages
//! control    what pages may do to the time of the board
//! desk       what connections and the board share: requests in, messages and frames out
//! request    what a page may ask for
//! names      what the programs call their bits
//! ```
//!
//! Invariants:
//! - Wall time decides only how far the board goes before the next look at the pages: what happens in a run does not
//!   depend on it, nor on how many pages look.
//! - What is done from a page goes through the session, so it is recorded.
//! - Nothing is loaded from elsewhere, and nobody without the token is answered.
//! - A page that sends nonsense, or vanishes, costs the board nothing.

#![forbid(unsafe_code)]

mod board;
mod control;
mod desk;
mod names;
mod request;
mod server;

pub use board::{LiveView, Wishes};
pub use control::TimeControl;
pub use server::{ListenError, Server};

use std::path::PathBuf;

use kmotiondef::ThreadId;
use runtime::MachineFile;

/// A program of the board.
#[derive(Clone, Debug)]
pub struct Program {
    /// The thread it is in.
    pub thread: ThreadId,
    /// Its source, or its image.
    pub path: PathBuf,
    /// Whether it is an image.
    pub is_image: bool,
}

/// An option of `cc67 run`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TestOption {
    /// As it is.
    Text(String),
    /// An option and its file, which a test in another folder calls by another name.
    File(&'static str, PathBuf),
}

/// What a board is shown with.
#[derive(Debug)]
pub struct Show {
    /// What the page is called: the names of the programs.
    pub title: String,
    /// What is connected to the board: names and units of axes, switches.
    pub machine: MachineFile,
    /// The programs.
    pub programs: Vec<Program>,
    /// Folders in which included files are looked for.
    pub include_dirs: Vec<PathBuf>,
    /// The signals of the scope, as the list of `--watch`; empty for a choice of ours.
    pub watch: String,
    /// Seconds of board time in a second; 1 is the pace of the real board.
    pub speed: f64,
    /// Whether the board waits until a page lets it run.
    pub is_paused: bool,
    /// Whether a program that is saved without errors is loaded at once.
    pub reloads: bool,
    /// The command, which runs a test that is saved.
    pub command: PathBuf,
    /// What `cc67 run` has to be told for the same board.
    pub test_options: Vec<TestOption>,
    /// What pages may do to its time.
    pub time: TimeControl,
    /// Seconds of board time after which the board is closed; `None` for never.
    pub limit: Option<f64>,
}
