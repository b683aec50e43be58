//! `cc67 serve`: a board for PC programs, in place of the vendor's server process.
//!
//! The vendor's client library communicates over a socket with a process that owns the board; this is that process.
//!
//! ```text
//! listen    sockets and ports; a thread for each connection
//! desk      takes one request after another, keeps the board's time
//! calls     what each request does
//! boards    several boards of one server
//! board     the served board, with its link and its recordings
//! served    the session of the board, with its page
//! page      the plan of the page
//! connection messages over a stream of bytes
//! pipe      messages over a pipe of Windows
//! link      data from the board that are still unread
//! carry     a thread for a client of the board's own bytes
//! wire      the board's own bytes for one client
//! message   requests and replies as bytes
//! log       the exchanges as a script for the console
//! home      the folder for the vendor's library
//! ```

mod board;
mod boards;
mod calls;
mod carry;
mod connection;
mod desk;
pub(super) mod home;
mod link;
mod listen;
mod log;
mod message;
#[cfg(feature = "live")]
mod page;
mod pipe;
mod served;
mod wire;

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};

use anyhow::{Context, Result, bail, ensure};
use cc67_debug::dap::AttachPoint;
use cc67_host::Target;
use clap::Args;

use crate::cli::args::attach::AttachArguments;
use crate::cli::args::board::BoardArguments;
use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::time::seconds;
use crate::cli::args::trace::TraceArguments;
use crate::cli::io::exit::Exit;
use crate::cli::io::{output, terminal};
use crate::cli::session::{BoardSession, Setup, Work};
use board::ServedBoard;
use boards::BoardFile;
use desk::{BoardSlot, Dispatcher, DispatcherMessage};
pub(super) use link::{CONSOLE_LINES, UNHEARD_LINES};
pub(super) use listen::MOST_CLIENTS;
use listen::SocketFiles;
use served::UsableBoard;
pub(super) use wire::{LOST_BYTES, UNREAD_BYTES};

/// The default addresses of the vendor's server.
const USUAL: &[&str] =
    if cfg!(windows) { &["pipe", "tcp:57777"] } else { &["/tmp/kmotionsocket", "tcp:57777"] };

/// Arguments of `cc67 serve`.
#[derive(Debug, Args)]
pub(super) struct ServeArguments {
    /// Programs to load and start: FILE runs in the lowest free thread, N:FILE in thread N
    #[arg(value_name = "[N:]FILE")]
    programs: Vec<OsString>,
    /// Listen on this socket, port or Windows pipe; may be repeated [default: /tmp/kmotionsocket and tcp:57777, on
    /// Windows pipe and tcp:57777, like the vendor's server]. With pty or tcp-raw:PORT, one client speaks the board's
    /// own byte protocol, as over USB
    #[arg(long, value_name = "PATH|pipe[:NAME]|tcp:PORT|pty|tcp-raw:PORT")]
    listen: Vec<String>,
    /// Serve this board, too; repeat it for several, at the locations 1, 2, … in this order. `--board NAME=MACHINE.toml`
    /// is the same
    #[arg(long, value_name = "NAME=MACHINE.toml", value_parser = BoardFile::parse)]
    serves: Vec<BoardFile>,
    /// Speed of board time: 1 is real time, N is N times as fast; with `fast`, time passes only while a client waits
    /// for a reply
    #[arg(long, value_name = "1|N|fast", default_value = "1", value_parser = pace)]
    pace: PaceName,
    /// Stop when the last client disconnects
    #[arg(long)]
    once: bool,
    /// Write the clients' requests to FILE, as a script for `cc67 console`
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// Create the folder that the vendor's library reads, with compiler and server, and print how to use it
    #[arg(long, value_name = "DIR")]
    home: Option<PathBuf>,
    /// Folder of your M code programs; linked into the folder of --home as `MCodes`
    #[arg(long, value_name = "DIR", requires = "home")]
    mcodes: Option<PathBuf>,
    /// Stop after SECONDS of board time
    #[arg(long = "for", alias = "until", value_name = "SECONDS", value_parser = seconds)]
    limit: Option<f64>,
    #[cfg(feature = "live")]
    #[command(flatten)]
    page: page::PageArguments,
    #[command(flatten)]
    attach: AttachArguments,
    #[command(flatten)]
    board: BoardArguments,
    #[command(flatten)]
    trace: TraceArguments,
    #[command(flatten)]
    compiler: CompilerArguments,
}

/// The speed of board time.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PaceName {
    /// This many times the speed of a clock.
    Clock(f64),
    /// Time passes only in exchanges.
    Exchanges,
}

fn pace(text: &str) -> Result<PaceName, String> {
    if text == "fast" {
        return Ok(PaceName::Exchanges);
    }
    let factor = text.parse().ok().filter(|factor| (0.01..=1000.0).contains(factor));
    factor.map(PaceName::Clock).ok_or_else(|| "expected a number from 0.01 to 1000, or `fast`".to_owned())
}

/// The terms for serving a board.
#[derive(Debug)]
pub(super) struct ServeTerms<'a> {
    /// The addresses of the listeners, and the option that names them.
    pub(super) addresses: Vec<String>,
    pub(super) option: &'static str,
    /// The speed of board time relative to the clock; `None` if board time passes only in exchanges.
    pub(super) pace: Option<f64>,
    /// True if the server ends with the last client.
    pub(super) once: bool,
    /// The board time at which it ends, in seconds.
    pub(super) limit: Option<f64>,
    /// The log of the exchanges.
    pub(super) log: Option<&'a Path>,
    /// The recording, and the title of plots.
    pub(super) trace: &'a TraceArguments,
    pub(super) title: String,
    /// The page on which it is shown.
    #[cfg(feature = "live")]
    pub(super) page: Option<page::PagePlan<'a>>,
}

/// Serves clients until it ends.
pub(super) fn serve(arguments: &ServeArguments) -> Result<Exit> {
    arguments.board.controller.refuse_in("serve")?;
    let given = arguments.listen.clone();
    let pace = match arguments.pace {
        PaceName::Clock(speed) => Some(speed),
        PaceName::Exchanges => None,
    };
    let usual = || USUAL.iter().map(|address| (*address).to_owned()).collect();
    let terms = ServeTerms {
        addresses: if given.is_empty() { usual() } else { given },
        option: "--listen",
        pace,
        once: arguments.once,
        limit: arguments.limit,
        log: arguments.log.as_deref(),
        trace: &arguments.trace,
        title: arguments.programs.join(OsStr::new(", ")).to_string_lossy().into_owned(),
        #[cfg(feature = "live")]
        page: page::PagePlan::wanted(arguments, pace),
    };
    if let Some(folder) = &arguments.home {
        let folder = home::make(folder, arguments.mcodes.as_deref())?;
        home::store_arguments(&folder, home::own_words())?;
        output::print(&home::lines(&folder))?;
    }
    if !arguments.serves.is_empty() {
        return boards::serve(&terms, arguments);
    }
    let debugger = arguments.attach.open()?;
    let setup = Setup::new(&arguments.programs, &arguments.board, &arguments.compiler)?;
    let Some(setup) = setup else { return Ok(Exit::Failure) };
    terms.serve(setup, debugger)
}

impl ServeTerms<'_> {
    /// Returns whether a single client uses the board's link.
    pub(super) fn is_on_wire(&self) -> bool {
        self.addresses.iter().any(|address| listen::is_wire(address))
    }

    /// Serves the board of a setup until it ends.
    pub(super) fn serve(&self, setup: Setup, debugger: Option<AttachPoint>) -> Result<Exit> {
        if !self.is_on_wire() {
            return self.serve_one(setup, debugger);
        }
        let [address] = &self.addresses[..] else {
            bail!(
                "the board has one link: `{} {}` cannot be combined with another address",
                self.option,
                self.addresses.join(" ")
            );
        };
        ensure!(
            !self.once || address != "pty",
            "`--once`: who has opened a terminal is not known; tcp-raw:PORT knows it"
        );
        ensure!(
            self.log.is_none(),
            "`--log` writes calls of the vendor's library, which do not come over a wire"
        );
        self.serve_one(setup.with_pc_elsewhere(), debugger)
    }

    fn serve_one(&self, setup: Setup, debugger: Option<AttachPoint>) -> Result<Exit> {
        let (notes, inbox) = channel();
        let opening = ServerStart::new(self, vec![notes])?;
        setup.debugged(debugger, BoardWork { opening: &opening, inbox, index: 0, name: None })
    }
}

/// The boards of a server before its first client: listeners start when all of them are ready.
struct ServerStart<'a> {
    terms: &'a ServeTerms<'a>,
    dispatchers: Vec<Sender<DispatcherMessage>>,
    /// Set when the server should end, even if a debugger has stopped a board.
    is_ending: Arc<AtomicBool>,
    /// The number of boards that are not ready yet.
    missing: AtomicUsize,
    socket_files: Mutex<SocketFiles>,
}

impl<'a> ServerStart<'a> {
    /// Prepares boards with these dispatchers; Ctrl-C and a termination request of the operating system end all of
    /// them.
    fn new(terms: &'a ServeTerms<'a>, dispatchers: Vec<Sender<DispatcherMessage>>) -> Result<Self> {
        let is_ending = Arc::<AtomicBool>::default();
        let (is_signalled, receivers) = (Arc::clone(&is_ending), dispatchers.clone());
        let end = move || {
            is_signalled.store(true, Ordering::Relaxed);
            end_all(&receivers);
        };
        ctrlc::set_handler(end).context("cannot take Ctrl-C")?;
        let missing = AtomicUsize::new(dispatchers.len());
        Ok(Self { terms, dispatchers, is_ending, missing, socket_files: Mutex::default() })
    }

    /// Notes that a board is ready; listeners start with the last one.
    fn note_ready(&self) -> Result<()> {
        if self.missing.fetch_sub(1, Ordering::Relaxed) > 1 {
            return Ok(());
        }
        let opened = listen::listen(&self.terms.addresses, self.terms.option, &self.dispatchers)?;
        if let Ok(mut places) = self.socket_files.lock() {
            *places = opened;
        }
        Ok(())
    }
}

/// Ends all dispatchers.
fn end_all(dispatchers: &[Sender<DispatcherMessage>]) {
    for dispatcher in dispatchers {
        // An error means that the dispatcher has already ended.
        let _ = dispatcher.send(DispatcherMessage::End);
    }
}

/// One of the boards to be served.
struct BoardWork<'a> {
    opening: &'a ServerStart<'a>,
    inbox: Receiver<DispatcherMessage>,
    index: usize,
    /// The board's name, if several are served.
    name: Option<&'a str>,
}

impl Work for BoardWork<'_> {
    fn on<T: Target>(self, mut board: BoardSession<T>) -> Result<Exit> {
        let Self { opening, inbox, index, name } = self;
        let terms = opening.terms;
        board.connect()?;
        let (board, trace) = UsableBoard::new(board, terms, Arc::clone(&opening.is_ending))?;
        let board = ServedBoard::new(board, trace, terms)?;
        opening.note_ready()?;
        name.into_iter().for_each(terminal::name_subject);
        let slot = BoardSlot { index, boards: opening.dispatchers.len() };
        Dispatcher::new(board, slot, terms, inbox).run()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pace_is_a_factor_or_fast() {
        assert_eq!(pace("fast"), Ok(PaceName::Exchanges));
        assert_eq!(pace("10"), Ok(PaceName::Clock(10.0)));
        for text in ["0", "-1", "2000", "NaN", "quick"] {
            assert!(pace(text).is_err(), "{text}");
        }
    }
}
