//! The queues between connections and the board: requests on their way in, messages and frames on their way out.
//!
//! Requests wait in a queue of limited length; a page that asks faster than the board answers waits there itself. Each
//! page has a [`Mailbox`]: messages wait until they are sent, of frames only one waits, so a slow page sees fewer.

use std::collections::{BTreeSet, VecDeque};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cc67_host::{CompileMessage, UserProgram};

use crate::Program;
use crate::request::PageRequest;

/// Requests that wait for the board.
const REQUESTS: usize = 256;
/// Messages that wait for a page; one that falls behind further is disconnected.
const MESSAGES: usize = 4000;

/// The number of a page.
pub(crate) type PageId = u64;

/// An item in the board's queue.
#[derive(Debug)]
pub(crate) enum Incoming {
    /// A page has connected.
    Join(PageId, Arc<Mailbox>),
    /// It is gone.
    Leave(PageId),
    /// It asks for something.
    Ask(PageId, PageRequest),
    /// A file of a program was saved.
    Saved(Box<Compiled>),
    /// The machine file was saved; the reason if it is wrong.
    Machine(Result<(), String>),
}

/// The result of compiling a program that was saved.
#[derive(Debug)]
pub(crate) struct Compiled {
    /// The program.
    pub(crate) program: Program,
    /// The image, or what is wrong.
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
    /// A hub, and where its requests come out.
    pub(crate) fn new() -> (Arc<Self>, Receiver<Incoming>) {
        let (sender, receiver) = mpsc::sync_channel(REQUESTS);
        (Arc::new(Self { sender, pages: Mutex::default(), said: Mutex::default() }), receiver)
    }

    /// A number for one more page.
    pub(crate) fn number(&self) -> PageId {
        let mut pages = locked(&self.pages);
        *pages += 1;
        *pages
    }

    /// Hands something to the board, once there is room; whether there still is a board.
    pub(crate) fn hand_in(&self, incoming: Incoming) -> bool {
        self.sender.send(incoming).is_ok()
    }

    /// Says on standard error what is odd about a client, the first time for each kind.
    pub(crate) fn log(&self, kind: &'static str, detail: &str) {
        if locked(&self.said).insert(kind) {
            let colon = if detail.is_empty() { "" } else { ": " };
            eprintln!("cc67 live: {kind}{colon}{detail}; more of this is not reported");
        }
    }
}

/// The outgoing queue of a page.
#[derive(Debug, Default)]
pub(crate) struct Mailbox(Mutex<Waiting>);

#[derive(Debug, Default)]
struct Waiting {
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
    /// Puts in a message.
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

    /// Puts in a frame.
    pub(crate) fn show(&self, frame: Vec<u8>) {
        locked(&self.0).frame = Some(frame);
    }

    /// Takes out the next thing; messages go first, as a frame may be about them.
    pub(crate) fn take(&self) -> Option<Outgoing> {
        let mut waiting = locked(&self.0);
        let message = waiting.messages.pop_front().map(Outgoing::Message);
        message.or_else(|| waiting.frame.take().map(Outgoing::Frame))
    }

    /// No more should be sent.
    pub(crate) fn close(&self) {
        locked(&self.0).is_closed = true;
    }

    /// Returns whether the page should be disconnected.
    pub(crate) fn is_closed(&self) -> bool {
        locked(&self.0).is_closed
    }
}

/// The value under a lock; one whose holder panicked is as good as before, each change being complete.
pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
