//! The client to which C holds a pointer.

use std::cell::RefCell;
use std::sync::atomic::{AtomicU64, Ordering};

use cc67_host::{Board, Options};

use crate::border::Outcome;

thread_local! {
    /// The boards whose call-backs this thread executes. Such a board is in use: waiting for it here would never end.
    static IN_CALLBACK: RefCell<Vec<BoardNumber>> = const { RefCell::new(Vec::new()) };
}

/// The number of a board, shared by its clients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BoardNumber(u64);

impl BoardNumber {
    /// Creates the client of a new board.
    pub(crate) fn new() -> Self {
        static LAST: AtomicU64 = AtomicU64::new(0);
        Self(LAST.fetch_add(1, Ordering::Relaxed))
    }

    /// Runs a call-back of the board.
    pub(crate) fn call_back(self, work: impl FnOnce()) {
        IN_CALLBACK.with_borrow_mut(|boards| boards.push(self));
        work();
        IN_CALLBACK.with_borrow_mut(|boards| boards.pop());
    }

    /// Returns an error within a call-back of the board.
    fn check(self) -> Result<(), Outcome> {
        let is_in_callback = IN_CALLBACK.with_borrow(|boards| boards.contains(&self));
        if is_in_callback { Err(Outcome::InUse) } else { Ok(()) }
    }
}

/// A client of a simulated board. One thread at a time may use it; clients of the same board may be used in
/// different threads.
#[derive(Debug)]
pub struct Client {
    pub(crate) board: Board,
    /// The options for compiling its programs.
    pub(crate) options: Options,
    pub(crate) number: BoardNumber,
}

impl Client {
    /// The client as a pointer for C.
    pub(crate) fn into_pointer(self) -> *mut Self {
        Box::into_raw(Box::new(self))
    }
}

/// Returns an error for null, and within a call-back of the client's board.
///
/// # Safety
/// As for [`board`].
pub(crate) unsafe fn check(client: *mut Client) -> Result<(), Outcome> {
    if client.is_null() {
        return Err(Outcome::Argument);
    }
    // SAFETY: the caller vouches for a client that is alive. Within a call-back, the enclosing call uses the board of
    // the client, but not the number, which never changes.
    unsafe { (*client).number }.check()
}

/// The board of a client; [`Outcome::InUse`] within a call-back of that board.
///
/// # Safety
/// The pointer is null, or was returned by [`cc67_open`](crate::cc67_open) or
/// [`cc67_another_client`](crate::cc67_another_client) and is not closed; no other call uses it meanwhile.
pub(crate) unsafe fn board<'a>(client: *mut Client) -> Result<&'a mut Board, Outcome> {
    // SAFETY: this function has the same requirement.
    unsafe { check(client) }?;
    // SAFETY: the caller vouches for a client that is alive, and that only this call uses, as it is not in a call-back.
    let client = unsafe { client.as_mut() };
    client.map(|client| &mut client.board).ok_or(Outcome::Argument)
}
