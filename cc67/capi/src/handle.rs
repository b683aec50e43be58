//! The client that C holds a pointer to.

use cc67_host::{Board, Options};

use crate::border::Outcome;

/// A client of a simulated board. One thread at a time may use it; clients of the same board may be used in
/// different threads.
#[derive(Debug)]
pub struct Client {
    pub(crate) board: Board,
    /// The options with which its programs are compiled.
    pub(crate) options: Options,
}

impl Client {
    /// The client as C holds it.
    pub(crate) fn into_pointer(self) -> *mut Self {
        Box::into_raw(Box::new(self))
    }
}

/// The board of a client.
///
/// # Safety
/// Null, or what [`cc67_open`](crate::cc67_open) or [`cc67_another_client`](crate::cc67_another_client) has returned
/// and nobody has closed; no other call uses it meanwhile.
pub(crate) unsafe fn board<'a>(client: *mut Client) -> Result<&'a mut Board, Outcome> {
    // SAFETY: the caller vouches for a client that is alive and that only this call uses.
    let client = unsafe { client.as_mut() };
    client.map(|client| &mut client.board).ok_or(Outcome::Argument)
}
