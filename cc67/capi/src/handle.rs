//! The client that C holds a pointer to.

use std::cell::RefCell;
use std::sync::atomic::{AtomicU64, Ordering};

use cc67_host::{Board, Options};

use crate::border::Outcome;

thread_local! {
    /// The boards whose call-backs this thread is in. A board is in use meanwhile: to wait for it here would not end.
    static IN_CALLBACK: RefCell<Vec<BoardNumber>> = const { RefCell::new(Vec::new()) };
}

/// The number of a board, which its clients have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BoardNumber(u64);

impl BoardNumber {
    /// Creates the client of a new board.
    pub(crate) fn new() -> Self {
        static LAST: AtomicU64 = AtomicU64::new(0);
        Self(LAST.fetch_add(1, Ordering::Relaxed))
    }

    /// Calls a call-back of the board.
    pub(crate) fn call_back(self, work: impl FnOnce()) {
        IN_CALLBACK.with_borrow_mut(|boards| boards.push(self));
        work();
        IN_CALLBACK.with_borrow_mut(|boards| boards.pop());
    }

    /// Returns an error in a call-back of the board.
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
    /// The options with which its programs are compiled.
    pub(crate) options: Options,
    pub(crate) number: BoardNumber,
}

impl Client {
    /// The client as C holds it.
    pub(crate) fn into_pointer(self) -> *mut Self {
        Box::into_raw(Box::new(self))
    }
}

/// Returns an error for null, and in a call-back of the client's board.
///
/// # Safety
/// As of [`board`].
pub(crate) unsafe fn check(client: *mut Client) -> Result<(), Outcome> {
    if client.is_null() {
        return Err(Outcome::Argument);
    }
    // SAFETY: the caller vouches for a client that is alive. In a call-back, the call that it is in uses the board of the
    // client, but not the number, which nothing changes.
    unsafe { (*client).number }.check()
}

/// The board of a client; [`Outcome::InUse`] in a call-back of it.
///
/// # Safety
/// Null, or what [`cc67_open`](crate::cc67_open) or [`cc67_another_client`](crate::cc67_another_client) has returned
/// and nobody has closed; no other call uses it meanwhile.
pub(crate) unsafe fn board<'a>(client: *mut Client) -> Result<&'a mut Board, Outcome> {
    // SAFETY: the same is asked of the caller.
    unsafe { check(client) }?;
    // SAFETY: the caller vouches for a client that is alive, and that only this call uses, as it is not in a call-back.
    let client = unsafe { client.as_mut() };
    client.map(|client| &mut client.board).ok_or(Outcome::Argument)
}
