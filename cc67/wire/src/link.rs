//! A stream of bytes in both directions that never blocks its user.
//!
//! One thread reads and one writes, so that data from the board are taken even while it blocks its input: a client that
//! only wrote could deadlock with it (wire.md section 2.4). Readers and writers have short time-outs of their own.

use std::io::{ErrorKind, Read, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::clock::now;
use crate::error::WireError;

/// The number of bytes per read.
const READ_SIZE: usize = 4096;
/// The number of bytes per write, small enough to check for the end in between.
const WRITE_SIZE: usize = 4096;
/// The interval at which an idle thread checks whether it should end.
const IDLE: Duration = Duration::from_millis(100);
/// The longest time that a link waits for its threads when it is closed.
const CLOSED_WITHIN: Duration = Duration::from_millis(300);
/// The interval at which a user of the link checks whether its bytes have been written.
const DRAIN: Duration = Duration::from_millis(1);

/// A request to the writing thread.
#[derive(Debug)]
pub(crate) enum Outgoing {
    /// Bytes for the board.
    Bytes(Vec<u8>),
    /// Takes the token of a shared board, with attempts until the given time.
    Claim(Instant, Sender<ClaimResult>),
    /// Releases the token.
    Release,
}

/// The result of taking the token of a shared board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ClaimResult {
    Taken,
    InUse,
    NotConnected,
}

/// A stream of bytes to and from a board.
#[derive(Debug)]
pub struct BoardLink {
    place: String,
    incoming: Receiver<Vec<u8>>,
    outgoing: Sender<Outgoing>,
    /// The number of bytes passed to the writer and not yet to the board.
    unwritten: Arc<AtomicUsize>,
    is_closed: Arc<AtomicBool>,
    is_shared: bool,
}

/// The ends of a link that its threads use.
pub(crate) struct LinkEnds {
    pub(crate) received: Sender<Vec<u8>>,
    pub(crate) requests: Receiver<Outgoing>,
    pub(crate) unwritten: Arc<AtomicUsize>,
    pub(crate) is_closed: Arc<AtomicBool>,
}

impl BoardLink {
    /// Creates a link over a reader and a writer, both with time-outs.
    #[must_use]
    pub fn new(
        place: impl Into<String>,
        reader: impl Read + Send + 'static,
        writer: impl Write + Send + 'static,
    ) -> Self {
        let (link, ends) = Self::with_ends(place.into(), false);
        let LinkEnds { received, requests, unwritten, is_closed } = ends;
        let is_over = Arc::clone(&is_closed);
        thread::spawn(move || read_all(reader, &received, &is_over));
        thread::spawn(move || write_all(writer, &requests, &unwritten, &is_closed));
        link
    }

    /// Creates a link whose other ends are served by a transport.
    pub(crate) fn with_ends(place: String, is_shared: bool) -> (Self, LinkEnds) {
        let (received, incoming) = channel();
        let (outgoing, requests) = channel();
        let (unwritten, is_closed) = (Arc::<AtomicUsize>::default(), Arc::<AtomicBool>::default());
        let ends = LinkEnds {
            received,
            requests,
            unwritten: Arc::clone(&unwritten),
            is_closed: Arc::clone(&is_closed),
        };
        (Self { place, incoming, outgoing, unwritten, is_closed, is_shared }, ends)
    }

    /// The location of the board, for messages.
    #[must_use]
    pub fn place(&self) -> &str {
        &self.place
    }

    /// Sends bytes, and returns before they are written.
    ///
    /// # Errors
    /// The link is lost.
    pub fn send(&self, bytes: Vec<u8>) -> Result<(), WireError> {
        self.unwritten.fetch_add(bytes.len(), Ordering::Relaxed);
        self.outgoing.send(Outgoing::Bytes(bytes)).map_err(|_| self.lost_error())
    }

    /// The number of bytes that the board has not taken yet.
    #[must_use]
    pub fn unwritten(&self) -> usize {
        self.unwritten.load(Ordering::Relaxed)
    }

    /// Returns received bytes; `None` if none come until a given time.
    ///
    /// # Errors
    /// The link is lost.
    pub fn receive(&self, until: Instant) -> Result<Option<Vec<u8>>, WireError> {
        match self.incoming.recv_timeout(until.saturating_duration_since(now())) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(self.lost_error()),
        }
    }

    /// Waits until all bytes are written; returns whether they are.
    #[must_use]
    pub fn drain(&self, within: Duration) -> bool {
        let end = now() + within;
        while self.unwritten() > 0 {
            if now() >= end {
                return false;
            }
            thread::sleep(DRAIN);
        }
        true
    }

    /// Takes the token of a board that other programs share.
    pub(crate) fn claim(&self, within: Duration) -> Result<(), WireError> {
        if !self.is_shared {
            return Ok(());
        }
        let (answer, inbox) = channel();
        self.outgoing.send(Outgoing::Claim(now() + within, answer)).map_err(|_| self.lost_error())?;
        match inbox.recv_timeout(within + Duration::from_secs(1)) {
            Ok(ClaimResult::Taken) => Ok(()),
            Ok(ClaimResult::InUse) | Err(RecvTimeoutError::Timeout) => {
                Err(WireError::InUse { place: self.place.clone(), seconds: within.as_secs_f64() })
            }
            Ok(ClaimResult::NotConnected) | Err(RecvTimeoutError::Disconnected) => Err(self.lost_error()),
        }
    }

    /// Releases the token.
    pub(crate) fn release(&self) {
        if self.is_shared {
            // A lost link holds no token.
            let _ = self.outgoing.send(Outgoing::Release);
        }
    }

    /// The error for a lost link.
    pub(crate) fn lost_error(&self) -> WireError {
        WireError::Disconnected { place: self.place.clone(), during: String::new() }
    }
}

impl BoardLink {
    /// Ends its threads: the port is free for the next user when they have released it.
    pub(crate) fn close(&self) {
        self.is_closed.store(true, Ordering::Relaxed);
        let end = now() + CLOSED_WITHIN;
        // Each thread has its own reference.
        while Arc::strong_count(&self.is_closed) > 1 && now() < end {
            thread::sleep(DRAIN);
        }
    }
}

impl Drop for BoardLink {
    fn drop(&mut self) {
        self.close();
    }
}

/// Returns whether a read or write should be tried again.
fn is_pause(kind: ErrorKind) -> bool {
    matches!(kind, ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

fn read_all(mut reader: impl Read, received: &Sender<Vec<u8>>, is_closed: &AtomicBool) {
    let mut buffer = vec![0; READ_SIZE];
    while !is_closed.load(Ordering::Relaxed) {
        match reader.read(&mut buffer) {
            Ok(0) => return,
            Ok(count) => {
                let bytes = buffer.get(..count).unwrap_or_default();
                if received.send(bytes.to_vec()).is_err() {
                    return;
                }
            }
            Err(error) if is_pause(error.kind()) => {}
            Err(_) => return,
        }
    }
}

fn write_all(
    mut writer: impl Write,
    requests: &Receiver<Outgoing>,
    unwritten: &AtomicUsize,
    is_closed: &AtomicBool,
) {
    while !is_closed.load(Ordering::Relaxed) {
        let bytes = match requests.recv_timeout(IDLE) {
            Ok(Outgoing::Bytes(bytes)) => bytes,
            Ok(Outgoing::Claim(_, answer)) => {
                // The requester may have given up.
                let _ = answer.send(ClaimResult::Taken);
                continue;
            }
            Ok(Outgoing::Release) | Err(RecvTimeoutError::Timeout) => continue,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        let mut rest = bytes.as_slice();
        while !rest.is_empty() {
            if is_closed.load(Ordering::Relaxed) {
                return;
            }
            let piece = rest.get(..WRITE_SIZE).unwrap_or(rest);
            match writer.write(piece) {
                Ok(0) => return,
                Ok(count) => {
                    unwritten.fetch_sub(count, Ordering::Relaxed);
                    rest = rest.get(count..).unwrap_or_default();
                }
                Err(error) if is_pause(error.kind()) => {}
                Err(_) => return,
            }
        }
        if writer.flush().is_err_and(|error| !is_pause(error.kind())) {
            return;
        }
    }
}
