//! Board time, and access to the board and its inputs.

use std::ffi::{c_int, c_void};

use cc67_host::kmotiondef::Bit;
use cc67_host::kmotiondef::limits::TIMEBASE;
use cc67_host::{AnyTarget, Session, Target};

use crate::border::{guarded, guarded_or, store};
use crate::handle::{board, check};
use crate::{Client, Outcome};

/// Says whether a run is over, by a number other than 0. It may use the client.
pub type EndCallback = Option<unsafe extern "C" fn(client: *mut Client, user: *mut c_void) -> c_int>;

/// Lets this many seconds of board time pass.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_run_for(client: *mut Client, seconds: f64) -> Outcome {
    guarded(|| {
        if !(seconds >= 0.0 && seconds.is_finite()) {
            return Err(Outcome::Argument);
        }
        // SAFETY: the caller vouches for the client.
        unsafe { board(client) }?.run_for(seconds);
        Ok(())
    })
}

/// Lets board time pass until `is_over` says so after a tick, at most this many seconds: 1 it said so, 0 the time has passed, -1
/// an argument is wrong, or in a call-back for console lines.
///
/// # Safety
/// `client` is open, and no other thread uses it meanwhile; `is_over` does not close it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_run_until(
    client: *mut Client,
    seconds: f64,
    is_over: EndCallback,
    user: *mut c_void,
) -> c_int {
    guarded_or(-1, || {
        let Some(is_over) = is_over.filter(|_| seconds >= 0.0 && seconds.is_finite()) else { return -1 };
        let mut ticks = (seconds / TIMEBASE).round() as u64;
        // SAFETY: the caller vouches for the client.
        if unsafe { check(client) }.is_err() {
            return -1;
        }
        loop {
            // SAFETY: the caller vouches for the function; no reference to the client is held here.
            if unsafe { is_over(client, user) } != 0 {
                return 1;
            }
            if ticks == 0 {
                return 0;
            }
            ticks -= 1;
            // SAFETY: the caller vouches for the client; the reference ends with the tick.
            let Ok(board) = (unsafe { board(client) }) else { return -1 };
            board.run_for(TIMEBASE);
        }
    })
}

/// Reads an element of `persist.UserData`, 0 to 199, without a command and without board time.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; `value` is a place for the number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_user_data(client: *mut Client, element: c_int, value: *mut i32) -> Outcome {
    guarded(|| {
        let element = usize::try_from(element).map_err(|_| Outcome::Argument)?;
        // SAFETY: the caller vouches for the client.
        let found = unsafe { board(client) }?.with_session(|session| {
            let found = session.user_data(element).ok_or(Outcome::Argument)?;
            check_connected(session).map(|()| found)
        });
        // SAFETY: the caller vouches for the place.
        unsafe { store(value, found?) }
    })
}

/// Stores an element of `persist.UserData`, 0 to 199, without a command and without board time.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_set_user_data(client: *mut Client, element: c_int, value: i32) -> Outcome {
    guarded(|| {
        let element = usize::try_from(element).map_err(|_| Outcome::Argument)?;
        // SAFETY: the caller vouches for the client.
        unsafe { board(client) }?.with_session(|session| {
            let is_stored = session.set_user_data(element, value);
            check_connected(session)?;
            if is_stored { Ok(()) } else { Err(Outcome::Argument) }
        })
    })
}

/// Returns an error if the controller can no longer be reached.
fn check_connected(session: &Session<AnyTarget>) -> Result<(), Outcome> {
    if session.target().loss_reason().is_some() { Err(Outcome::NotConnected) } else { Ok(()) }
}

/// Drives an input bit, 0 to 2047, from outside: 0 low, any other number high.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_drive_input(client: *mut Client, bit: c_int, level: c_int) -> Outcome {
    guarded(|| {
        let bit = Bit::new(bit).ok_or(Outcome::Argument)?;
        // SAFETY: the caller vouches for the client.
        let driven = unsafe { board(client) }?.with_session(|session| session.drive_input(bit, level != 0));
        Ok(driven?)
    })
}
