//! The client of the board's protocol.
//!
//! Every command line ends with `;Version`, which the board executes directly after the command: its reply shows that
//! the command was executed, and separates the command's own reply from lines caused by others.

mod connect;
mod exchange;
mod flash;
mod load;
mod refusals;
mod status;

pub use load::{LoadImage, Progress};
pub use status::Status;

use std::collections::VecDeque;
use std::fmt;
use std::time::{Duration, Instant};

use kmotiondef::ThreadId;

use crate::address::Address;
use crate::clock::now;
use crate::disk::{NoFiles, PcFiles};
use crate::error::WireError;
use crate::lines::{Decoder, Incoming};
use crate::link::BoardLink;
use refusals::RefusalFinder;

/// The time limit for the reply to a command.
const ANSWER_WITHIN: Duration = Duration::from_secs(3);
/// The time during which connecting is retried if a board disconnects at once, and the pause between attempts. Source:
/// wire.md section 2.
const OPEN_WITHIN: Duration = Duration::from_secs(3);
const OPEN_AGAIN: Duration = Duration::from_millis(100);
/// The time after which a line feed can no longer follow the answer to an abort.
const SETTLED_AFTER: Duration = Duration::from_millis(20);
/// The maximum number of console lines waiting to be taken; further ones are counted and dropped.
const MOST_CONSOLE_LINES: usize = 100_000;

/// A connection to a board.
pub struct Client {
    link: BoardLink,
    /// The address for reconnecting.
    address: Option<Address>,
    decoder: Decoder,
    /// The version text of the board's firmware.
    version: String,
    console: VecDeque<Vec<u8>>,
    lost_console_lines: u64,
    /// The number of lines in replies to commands of other clients.
    foreign_lines: u64,
    files: Box<dyn PcFiles>,
    errors: RefusalFinder,
}

impl fmt::Debug for Client {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Client")
            .field("link", &self.link)
            .field("version", &self.version)
            .finish_non_exhaustive()
    }
}

impl Client {
    /// Connects to the board at an address.
    ///
    /// # Errors
    /// There is no board at the address, access is denied, or it does not answer.
    pub fn connect(address: &Address) -> Result<Self, WireError> {
        let end = now() + OPEN_WITHIN;
        loop {
            match Self::over(crate::transport::open(address)?) {
                Ok(client) => return Ok(Self { address: Some(address.clone()), ..client }),
                // A board that is starting, or that another client is just leaving, appears and disappears.
                Err(error) if error.is_disconnected() && now() < end => std::thread::sleep(OPEN_AGAIN),
                Err(error) => return Err(error),
            }
        }
    }

    /// Connects to the board at the other end of a link.
    ///
    /// # Errors
    /// It does not answer.
    pub fn over(link: BoardLink) -> Result<Self, WireError> {
        let mut client = Self {
            link,
            address: None,
            decoder: Decoder::default(),
            version: String::new(),
            console: VecDeque::new(),
            lost_console_lines: 0,
            foreign_lines: 0,
            files: Box::new(NoFiles),
            errors: RefusalFinder::default(),
        };
        client.handshake()?;
        Ok(client)
    }

    /// Connects again after the link was lost or the board restarted.
    ///
    /// # Errors
    /// As for [`connect`](Self::connect).
    pub fn reconnect(&mut self) -> Result<(), WireError> {
        if let Some(address) = &self.address {
            self.link.close();
            let fresh = crate::transport::open(address)?;
            self.link = fresh;
        }
        self.decoder.clear();
        self.errors.clear();
        self.handshake()
    }

    /// Returns the location of the board, for messages.
    #[must_use]
    pub fn place(&self) -> &str {
        self.link.place()
    }

    /// Returns the board's reply to `Version`: name, version, time stamp of the firmware.
    #[must_use]
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Serves the files of programs on the board with `files`.
    pub fn serve_files(&mut self, files: Box<dyn PcFiles>) {
        self.files = files;
    }

    /// Returns the received console lines, each without its line end.
    pub fn take_console(&mut self) -> Vec<Vec<u8>> {
        self.console.drain(..).collect()
    }

    /// Puts back a line for another client, after the lines that have arrived.
    pub fn return_console(&mut self, line: Vec<u8>) {
        self.keep(line);
    }

    /// The number of console lines that were dropped because nobody took them.
    #[must_use]
    pub const fn lost_console_lines(&self) -> u64 {
        self.lost_console_lines
    }

    /// The number of lines in replies to commands of other clients.
    #[must_use]
    pub const fn foreign_lines(&self) -> u64 {
        self.foreign_lines
    }

    /// Reads the console, and serves files, for at most this long; returns as soon as a line has come.
    ///
    /// # Errors
    /// The link is lost.
    pub fn service(&mut self, within: Duration) -> Result<(), WireError> {
        let end = now() + within;
        loop {
            match self.next(end)? {
                Some(Incoming::Reply(_)) => self.foreign_lines += 1,
                Some(_) => {}
                None => return Ok(()),
            }
            if !self.console.is_empty() && !self.has_more() {
                return Ok(());
            }
        }
    }

    /// Reads the console until nothing has come for the time `silence`, but at most for `limit`.
    ///
    /// # Errors
    /// The link is lost.
    pub fn settle(&mut self, silence: Duration, limit: Duration) -> Result<(), WireError> {
        let end = now() + limit;
        while let Some(item) = self.next((now() + silence).min(end))? {
            if matches!(item, Incoming::Reply(_)) {
                self.foreign_lines += 1;
            }
        }
        Ok(())
    }

    /// Returns whether a thread is active.
    ///
    /// # Errors
    /// The board does not answer.
    pub fn is_active(&mut self, thread: ThreadId) -> Result<bool, WireError> {
        let command = format!("CheckThread{thread}");
        match self.ask(&command)?.as_str() {
            "1" => Ok(true),
            "0" => Ok(false),
            answer => Err(self.unexpected(&command, answer)),
        }
    }

    /// Stops a thread, and waits until it has stopped.
    ///
    /// # Errors
    /// It does not stop, or the board does not answer.
    pub fn stop_thread(&mut self, thread: ThreadId) -> Result<(), WireError> {
        self.command(&format!("Kill{thread}"))?;
        let end = now() + Duration::from_secs(1);
        while self.is_active(thread)? {
            if now() >= end {
                return Err(WireError::DoesNotStop(thread));
            }
        }
        Ok(())
    }

    /// Starts the programs of threads with one line, which the board executes without interruption.
    ///
    /// # Errors
    /// The board does not answer.
    pub fn execute(&mut self, threads: &[ThreadId]) -> Result<(), WireError> {
        let commands: Vec<_> = threads.iter().map(|thread| format!("Execute{thread}")).collect();
        if commands.is_empty() { Ok(()) } else { self.command(&commands.join(";")) }
    }

    /// Returns the present status of the board.
    ///
    /// # Errors
    /// The board does not answer, or gives an unexpected answer.
    pub fn status(&mut self) -> Result<Status, WireError> {
        let lines = self.send_line("GetStatus")?;
        let Some((status, foreign)) = Status::read(&lines) else {
            return Err(self.unexpected("GetStatus", &lines.join(" / ")));
        };
        self.foreign_lines += foreign as u64;
        Ok(status)
    }

    /// The error for an answer in an unexpected form.
    #[must_use]
    pub fn unexpected(&self, command: &str, answer: &str) -> WireError {
        WireError::Unexpected {
            place: self.place().to_owned(),
            command: command.to_owned(),
            answer: answer.chars().take(100).collect(),
        }
    }

    /// The next item from the board, until a given time. Console lines and file requests are handled, and returned,
    /// too.
    fn next(&mut self, until: Instant) -> Result<Option<Incoming>, WireError> {
        loop {
            if let Some(item) = self.decoder.take() {
                self.note(&item)?;
                return Ok(Some(item));
            }
            let is_undecided = self.decoder.may_be_aborted();
            let pause = if is_undecided { until.min(now() + SETTLED_AFTER) } else { until };
            match self.link.receive(pause)? {
                Some(bytes) => self.decoder.push(&bytes),
                None if is_undecided => self.decoder.settle(),
                None => return Ok(None),
            }
        }
    }

    /// Returns whether more data have already come.
    fn has_more(&mut self) -> bool {
        self.decoder.has_item()
    }

    fn note(&mut self, item: &Incoming) -> Result<(), WireError> {
        match item {
            Incoming::Console(line) => {
                let shown = self.errors.filter(line.clone());
                shown.into_iter().for_each(|line| self.keep(line));
            }
            Incoming::Disk(code, text) => {
                if let Some(answer) = self.files.request(*code, text) {
                    self.write(&answer.lines())?;
                }
            }
            Incoming::Reply(_) | Incoming::Aborted => {}
        }
        Ok(())
    }

    fn keep(&mut self, line: Vec<u8>) {
        if self.console.len() < MOST_CONSOLE_LINES {
            self.console.push_back(line);
        } else {
            self.lost_console_lines += 1;
        }
    }

    /// Sends lines without echo in one piece, so that no other line of ours comes between them.
    fn write(&self, lines: &[Vec<u8>]) -> Result<(), WireError> {
        let bytes = lines.iter().flat_map(|line| [b"\x1b\x01", &line[..], b"\r"].concat()).collect();
        self.link.send(bytes)
    }
}
