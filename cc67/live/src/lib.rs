//! A simulated board on a page in the browser.
//!
//! A [`Server`] listens on this computer and serves the page, which is part of the binary. It then [runs](Server::run)
//! a [`Session`] in real time, on the caller's thread. Pages are views: they receive the board's state and send the
//! requests of a user. A [`LiveView`] shows a session run by other code.
//!
//! ```text
//! server/    connections: the files of the page, access checks, sockets
//! board/     the session under the clock: frames, signals, threads, messages
//! control    the rights of pages over the board and its time
//! hub       shared by connections and the board: requests in, messages and frames out
//! request    the requests of a page
//! names      the programs' names for bits
//! ```
//!
//! Invariants:
//! - Wall-clock time decides only how far the board runs before it serves the pages again: the run itself depends
//!   neither on it nor on the number of pages.
//! - Every action of a page goes through the session, so it is recorded.
//! - The page loads nothing from elsewhere, and a request without the token gets no answer.
//! - A page that sends invalid data, or disappears, does not affect the board.

#![forbid(unsafe_code)]

mod board;
mod control;
mod hub;
mod names;
mod request;
mod server;

pub use board::{BoardUsers, LiveView, OwnerRequests, ShowEnd};
pub use control::TimeControl;
pub use server::{ListenError, Server};

use std::path::PathBuf;

use cc67_host::{Session, Target, UserProgram};
use kmotiondef::ThreadId;
use runtime::{Event, MachineFile};

/// A program of the board.
#[derive(Clone, Debug)]
pub struct Program {
    /// The thread in which it is loaded.
    pub thread: ThreadId,
    /// Its source, or its image.
    pub path: PathBuf,
    /// True if it is an image.
    pub is_image: bool,
    /// The compiled program, if it is loaded only on request.
    pub waiting: Option<Box<UserProgram>>,
}

/// An option of `cc67 run`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TestOption {
    /// An option without a file.
    Text(String),
    /// An option with a file, whose path is adapted for a test in another folder.
    File(&'static str, PathBuf),
}

/// A receiver of a board's events, before its pages.
pub trait Keeper<T: Target>: std::fmt::Debug {
    /// Handles events; returns those that pages may show.
    fn keep(&mut self, session: &Session<T>, events: Vec<Event>) -> Vec<Event>;
}

/// The machine around a shown board.
#[derive(Debug)]
pub struct ShownMachine {
    /// The description.
    pub file: MachineFile,
    /// The path of its file, which is watched while the board is shown.
    pub path: Option<PathBuf>,
    /// True if a new board can be made when that file is saved.
    pub can_rebuild: bool,
}

/// The options with which a board is shown.
#[derive(Debug)]
pub struct Show {
    /// The title of the page: the names of the programs.
    pub title: String,
    /// The equipment connected to the board: names and units of axes, switches.
    pub machine: ShownMachine,
    /// The programs.
    pub programs: Vec<Program>,
    /// Folders that are searched for included files.
    pub include_dirs: Vec<PathBuf>,
    /// The signals of the scope, as a list like that of `--watch`; empty for the default.
    pub watch: String,
    /// Seconds of board time per second; 1 is the speed of the real board.
    pub speed: f64,
    /// True if the board waits until a page lets it run.
    pub is_paused: bool,
    /// True if a program is loaded at once when it is saved without errors.
    pub reloads: bool,
    /// The path of the command, which runs saved tests.
    pub command: PathBuf,
    /// The options with which `cc67 run` creates the same board.
    pub test_options: Vec<TestOption>,
    /// The control of pages over its time.
    pub time: TimeControl,
    /// Seconds of board time after which the board is closed; `None` for never.
    pub limit: Option<f64>,
}

/// Executes the requests in messages of a page, one after another, without a connection: for tests of requests. Returns
/// the reason for each that was rejected.
pub fn execute_messages<T: Target>(
    session: &mut Session<T>,
    show: Show,
    messages: &[&str],
) -> Vec<Option<String>> {
    board::execute_messages(session, show, messages)
}
