//! Lines of script commands, and their replies.

use std::ffi::{c_char, c_int, c_void};

use crate::border::{buffer, copy_text, guarded, guarded_or, text};
use crate::handle::board;
use crate::{Client, Outcome};

/// Sends a line of script commands and waits for no reply.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; the text ends with a 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_write_line(client: *mut Client, line: *const c_char) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the text.
        let line = unsafe { text(line) }?;
        // SAFETY: the caller vouches for the client.
        Ok(unsafe { board(client) }?.write_line(line)?)
    })
}

/// Sends a line that the board echoes, and after which it says `Ready`.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; the text ends with a 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_write_line_with_echo(client: *mut Client, line: *const c_char) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the text.
        let line = unsafe { text(line) }?;
        // SAFETY: the caller vouches for the client.
        Ok(unsafe { board(client) }?.write_line_with_echo(line)?)
    })
}

/// Sends a line and reads a line of its reply into `reply`, without line end; waits for the token before, and 3 s of
/// board time for the reply.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; the text ends with a 0; `reply` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_write_line_read_line(
    client: *mut Client,
    line: *const c_char,
    reply: *mut c_char,
    size: usize,
) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the buffer.
        let reply = unsafe { buffer(reply, size) };
        copy_text(reply, "")?;
        // SAFETY: the caller vouches for the text.
        let line = unsafe { text(line) }?;
        // SAFETY: the caller vouches for the client.
        let answer = unsafe { board(client) }?.write_line_read_line(line)?;
        copy_text(reply, &answer)
    })
}

/// The next line of a reply, with its line end, if it comes within this many milliseconds of board time.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; `reply` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_read_line_timeout(
    client: *mut Client,
    reply: *mut c_char,
    size: usize,
    milliseconds: u32,
) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the buffer.
        let reply = unsafe { buffer(reply, size) };
        copy_text(reply, "")?;
        // SAFETY: the caller vouches for the client.
        let line = unsafe { board(client) }?.read_line_timeout(milliseconds)?;
        copy_text(reply, &line)
    })
}

/// Reads lines until `Ready` comes, or none for 0.1 s: 0 nothing came, 1 a part of a line, 2 `Ready`, 3 `Ready` after an
/// error; -1 without a connection.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_check_for_ready(client: *mut Client) -> c_int {
    guarded_or(-1, || {
        // SAFETY: the caller vouches for the client.
        let Ok(board) = (unsafe { board(client) }) else { return -1 };
        board.check_for_ready().map_or(-1, |readiness| readiness as c_int)
    })
}

/// Reads the status record, `MAIN_STATUS` of `PC-DSP.h`, 464 bytes, into `record`, or as much of it as fits.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; `record` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_get_status(client: *mut Client, record: *mut c_void, size: usize) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the room.
        let record = unsafe { buffer(record.cast(), size) };
        // SAFETY: the caller vouches for the client.
        let status = unsafe { board(client) }?.get_status()?;
        let size = record.len().min(status.bytes().len());
        record[..size].copy_from_slice(&status.bytes()[..size]);
        if size == 0 { Err(Outcome::Argument) } else { Ok(()) }
    })
}
