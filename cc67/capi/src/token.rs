//! The token that gives a client the board to itself, and the connection.

use std::ffi::c_int;
use std::time::Duration;

use cc67_host::Lock;

use crate::border::guarded_or;
use crate::handle::board;
use crate::{Client, Outcome};

/// The result of a lock request when there is no board.
fn refused(outcome: Outcome) -> Lock {
    if outcome == Outcome::InUse { Lock::InUse } else { Lock::NotConnected }
}

/// Asks for the token once; connects first if necessary: 0 this client has the board to itself, 1 another client has
/// it, or a call-back of the board is in progress in this thread; 2 there is no connection.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_kmotion_lock(client: *mut Client) -> c_int {
    guarded_or(Lock::NotConnected as c_int, || {
        // SAFETY: the caller vouches for the client.
        let board = unsafe { board(client) };
        board.map_or_else(refused, |board| board.kmotion_lock()) as c_int
    })
}

/// Waits for the token until another client releases it, at most this many milliseconds by the clock, or 2000 s for a
/// negative number. The result is that of `cc67_kmotion_lock`.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_wait_token(client: *mut Client, milliseconds: c_int) -> c_int {
    guarded_or(Lock::NotConnected as c_int, || {
        // SAFETY: the caller vouches for the client.
        let board = unsafe { board(client) };
        let limit = u64::try_from(milliseconds).ok().map(Duration::from_millis);
        board.map_or_else(refused, |board| board.wait_token(limit)) as c_int
    })
}

/// Gives the token back; without it nothing happens.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_release_token(client: *mut Client) {
    guarded_or((), || {
        // SAFETY: the caller vouches for the client.
        if let Ok(board) = unsafe { board(client) } {
            board.release_token();
        }
    });
}

/// Gives the connection up, as after a failure; `cc67_kmotion_lock` connects again.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_failed(client: *mut Client) {
    guarded_or((), || {
        // SAFETY: the caller vouches for the client.
        if let Ok(board) = unsafe { board(client) } {
            board.failed();
        }
    });
}

/// Gives the connection up.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_disconnect(client: *mut Client) {
    // SAFETY: this function has the same requirement.
    unsafe { cc67_failed(client) }
}
