//! A simulated board on a page in the browser.
//!
//! A [`Server`] listens on this computer and serves the page, which is part of the binary. It then [runs](Server::run)
//! a [`Session`] in real time, on the caller's thread. Pages are views: they receive the board's
//! state and send the requests of a person. A [`LiveView`] shows a session that other code runs.
//!
//! ```text
//! server/    connections: the files of the page, access checks, sockets
//! board/     the session under the clock: frames, signals, threads, messages
//! control    what pages may do to the board and its time
//! hub       shared by connections and the board: requests in, messages and frames out
//! request    the requests of a page
//! names      the programs' names of bits
//! ```
//!
//! Invariants:
//! - Wall-clock time decides only how far the board runs before it serves the pages again: the run does not depend on
//!   it, or on the number of pages.
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

pub use board::{Company, LiveView, OwnerRequests, ShowEnd};
pub use control::TimeControl;
pub use server::{ListenError, Server};

use std::path::PathBuf;

use cc67_host::{Session, Target, UserProgram};
use kmotiondef::ThreadId;
use runtime::{Event, MachineFile};

/// A program of the board.
#[derive(Clone, Debug)]
pub struct Program {
    /// The thread it is in.
    pub thread: ThreadId,
    /// Its source, or its image.
    pub path: PathBuf,
    /// True if it is an image.
    pub is_image: bool,
    /// The program compiled, where it is loaded only when a page asks for it.
    pub waiting: Option<Box<UserProgram>>,
}

/// An option of `cc67 run`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TestOption {
    /// As it is.
    Text(String),
    /// An option and its file, which a test in another folder calls by another name.
    File(&'static str, PathBuf),
}

/// Somebody who sees what happens on a board before its pages do.
pub trait Keeper<T: Target>: std::fmt::Debug {
    /// Does what events demand; returns those that pages may show.
    fn keep(&mut self, session: &Session<T>, events: Vec<Event>) -> Vec<Event>;
}

/// The machine around a board that is shown.
#[derive(Debug)]
pub struct ShownMachine {
    /// The description.
    pub file: MachineFile,
    /// The path of its file, to be looked at while the board is shown.
    pub path: Option<PathBuf>,
    /// There can be another board when that file is saved.
    pub can_rebuild: bool,
}

/// The options with which a board is shown.
#[derive(Debug)]
pub struct Show {
    /// The title of the page: the names of the programs.
    pub title: String,
    /// The equipment that is connected to the board: names and units of axes, switches.
    pub machine: ShownMachine,
    /// The programs.
    pub programs: Vec<Program>,
    /// Folders in which included files are looked for.
    pub include_dirs: Vec<PathBuf>,
    /// The signals of the scope, as the list of `--watch`; empty for a choice of ours.
    pub watch: String,
    /// Seconds of board time in a second; 1 is the pace of the real board.
    pub speed: f64,
    /// True if the board waits until a page lets it run.
    pub is_paused: bool,
    /// True if a program that is saved without errors is loaded at once.
    pub reloads: bool,
    /// The command, which runs a test that is saved.
    pub command: PathBuf,
    /// The options with which `cc67 run` creates the same board.
    pub test_options: Vec<TestOption>,
    /// The control that pages have over its time.
    pub time: TimeControl,
    /// Seconds of board time after which the board is closed; `None` for never.
    pub limit: Option<f64>,
}

/// Does what pages ask for in messages, one after another, without a connection: for tests of them. Returns the reason
/// for each that was refused.
pub fn obey<T: Target>(session: &mut Session<T>, show: Show, messages: &[&str]) -> Vec<Option<String>> {
    board::obey(session, show, messages)
}
