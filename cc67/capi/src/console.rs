//! Console lines, and reports of the simulation.

use std::ffi::{CString, c_char, c_int, c_void};

use cc67_host::fill;

use crate::border::{buffer, guarded, guarded_or};
use crate::handle::board;
use crate::{Client, Outcome};

/// Receives a console line and what was registered with it. The board is in use meanwhile: calls of its clients return
/// `CC67_RESULT_IN_USE`, or as a failure. It must not leave by `longjmp` or an exception.
pub type LineCallback = Option<unsafe extern "C" fn(line: *const c_char, user: *mut c_void)>;

/// The pointer that a caller registered with its call-back, passed back unchanged.
struct User(*mut c_void);

// SAFETY: the library only keeps the pointer and passes it back; the header documents the threads in which that can
// happen.
unsafe impl Send for User {}

/// Has console lines handed to a function as they come, in whatever call of whatever client of the board that is, and so
/// in that call's thread; null lets them wait for `cc67_service_console` of this client again.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; `callback` and `user` stay good until the client is closed or
/// another function is registered.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_set_console_callback(
    client: *mut Client,
    callback: LineCallback,
    user: *mut c_void,
) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the client.
        let board = unsafe { board(client) }?;
        // SAFETY: the caller vouches for the client, which is not null.
        let number = unsafe { (*client).number };
        let Some(callback) = callback else {
            board.drop_console_callback();
            return Ok(());
        };
        let user = User(user);
        board.set_console_callback(move |line| {
            let user = &user;
            // A 0 within a line would end it there; C cannot represent it otherwise.
            let line = line.split('\0').next().unwrap_or_default();
            let line = CString::new(line).unwrap_or_default();
            // SAFETY: the caller vouches for the function, and the line ends with a 0.
            number.call_back(|| unsafe { callback(line.as_ptr(), user.0) });
        });
        Ok(())
    })
}

/// Takes at most one console line into `line`, without line end: 1 there was one, 0 there was none, or it went to the
/// call-back, or another client has the token; -1 if an argument is wrong, or in a call-back.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; `line` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_service_console(client: *mut Client, line: *mut c_char, size: usize) -> c_int {
    guarded_or(-1, || {
        // SAFETY: the caller vouches for the buffer.
        let buffer = unsafe { buffer(line, size) };
        fill(buffer, "");
        // SAFETY: the caller vouches for the client.
        let Ok(board) = (unsafe { board(client) }) else { return -1 };
        board.service_console().map_or(0, |line| {
            fill(buffer, &line);
            1
        })
    })
}

/// Takes the oldest remark of the simulation into `text`, such as a trap with its source line: 1 there was one, 0 there
/// was none; -1 if an argument is wrong, or in a call-back.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; `text` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_take_remark(client: *mut Client, text: *mut c_char, size: usize) -> c_int {
    guarded_or(-1, || {
        // SAFETY: the caller vouches for the buffer.
        let buffer = unsafe { buffer(text, size) };
        fill(buffer, "");
        // SAFETY: the caller vouches for the client.
        let Ok(board) = (unsafe { board(client) }) else { return -1 };
        board.take_remark().map_or(0, |remark| {
            fill(buffer, &remark);
            1
        })
    })
}
