//! The queues between connections and the board: incoming requests, outgoing messages and frames.
//!
//! Requests wait in a queue of limited length; a page that sends requests faster than the board answers has to wait.
//! Each page has a [`Mailbox`]: messages wait until they are sent, but only the latest frame, so a slow page receives
//! fewer frames.

use std::collections::{BTreeSet, VecDeque};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cc67_host::{CompileMessage, UserProgram};

use crate::Program;
use crate::request::PageRequest;

/// The maximum number of requests waiting for the board.
const REQUESTS: usize = 256;
/// The maximum number of messages waiting for a page; a page with more is disconnected.
const MESSAGES: usize = 4000;

/// The number of a page.
pub(crate) type PageId = u64;

/// An item in the board's queue.
#[derive(Debug)]
pub(crate) enum Incoming {
    /// A page has connected.
    Join(PageId, Arc<Mailbox>),
    /// A page has disconnected.
    Leave(PageId),
    /// A page has made a request.
    Ask(PageId, PageRequest),
    /// A file of a program was saved.
    Saved(Box<CompileResult>),
    /// The machine file was saved; the error if it is not valid.
    Machine(Result<(), String>),
}

/// The result of compiling a saved program.
#[derive(Debug)]
pub(crate) struct CompileResult {
    /// The program.
    pub(crate) program: Program,
    /// The image, or the errors.
    pub(crate) result: Result<UserProgram, Vec<CompileMessage>>,
}

/// The hub between connections and the board.
#[derive(Debug)]
pub(crate) struct Hub {
    sender: SyncSender<Incoming>,
    pages: Mutex<u64>,
    said: Mutex<BTreeSet<&'static str>>,
}

impl Hub {
    /// Creates a hub, and the receiver of its requests.
    pub(crate) fn new() -> (Arc<Self>, Receiver<Incoming>) {
        let (sender, receiver) = mpsc::sync_channel(REQUESTS);
        (Arc::new(Self { sender, pages: Mutex::default(), said: Mutex::default() }), receiver)
    }

    /// A number for a new page.
    pub(crate) fn number(&self) -> PageId {
        let mut pages = locked(&self.pages);
        *pages += 1;
        *pages
    }

    /// Sends an item to the board, once there is room; returns whether the board still exists.
    pub(crate) fn hand_in(&self, incoming: Incoming) -> bool {
        self.sender.send(incoming).is_ok()
    }

    /// Reports a problem with a client on standard error, the first time for each kind.
    pub(crate) fn log(&self, kind: &'static str, detail: &str) {
        if locked(&self.said).insert(kind) {
            let colon = if detail.is_empty() { "" } else { ": " };
            eprintln!("cc67 live: {kind}{colon}{detail}; more of this is not reported");
        }
    }
}

/// The outgoing queue of a page.
#[derive(Debug, Default)]
pub(crate) struct Mailbox(Mutex<MailboxState>);

#[derive(Debug, Default)]
struct MailboxState {
    messages: VecDeque<Arc<str>>,
    frame: Option<Vec<u8>>,
    is_closed: bool,
}

/// An item to send.
#[derive(Debug)]
pub(crate) enum Outgoing {
    /// A message in JSON.
    Message(Arc<str>),
    /// A frame.
    Frame(Vec<u8>),
}

impl Mailbox {
    /// Adds a message.
    pub(crate) fn post(&self, message: &Arc<str>) {
        let mut waiting = locked(&self.0);
        if waiting.messages.len() < MESSAGES {
            waiting.messages.push_back(Arc::clone(message));
        } else {
            waiting.is_closed = true;
        }
    }

    /// Returns whether the last frame has been taken, so that there is room for another.
    pub(crate) fn wants_frame(&self) -> bool {
        locked(&self.0).frame.is_none()
    }

    /// Sets the frame to be sent.
    pub(crate) fn show(&self, frame: Vec<u8>) {
        locked(&self.0).frame = Some(frame);
    }

    /// Takes the next item; messages go first, as a frame may depend on them.
    pub(crate) fn take(&self) -> Option<Outgoing> {
        let mut waiting = locked(&self.0);
        let message = waiting.messages.pop_front().map(Outgoing::Message);
        message.or_else(|| waiting.frame.take().map(Outgoing::Frame))
    }

    /// Requests the end of the connection.
    pub(crate) fn close(&self) {
        locked(&self.0).is_closed = true;
    }

    /// Returns whether the page should be disconnected.
    pub(crate) fn is_closed(&self) -> bool {
        locked(&self.0).is_closed
    }
}

/// The value under a lock; if the holder of the lock panicked, the value is still valid, as each change is a single
/// step.
pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
