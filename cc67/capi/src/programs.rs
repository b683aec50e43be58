//! Compiling and loading programs.

use std::ffi::{c_char, c_int};
use std::path::Path;

use cc67_host::fill;

use crate::border::{buffer, guarded, text};
use crate::handle::{board, check};
use crate::{Client, Outcome};

/// Adds a folder in which included files are searched, for what this client compiles from now on.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; the text ends with a 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_include_dir(client: *mut Client, folder: *const c_char) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the text.
        let folder = unsafe { text(folder) }?;
        // SAFETY: the caller vouches for a client that is alive and that only this call uses.
        unsafe { check(client) }?;
        // SAFETY: the caller vouches for the client, which is not null.
        let client = unsafe { &mut *client };
        client.options.preprocessor.include_dirs.push(folder.into());
        client.board.set_options(client.options.clone());
        Ok(())
    })
}

/// Compiles a source, links it for a thread, 1 to 7, and loads it there; it does not start. If it fails, what was in the
/// thread is still there and running.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; the text ends with a 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_compile_and_load_coff(
    client: *mut Client,
    file: *const c_char,
    thread: c_int,
) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the text.
        let file = unsafe { text(file) }?;
        // SAFETY: the caller vouches for the client.
        Ok(unsafe { board(client) }?.compile_and_load_coff(Path::new(file), thread)?)
    })
}

/// Compiles a source and loads it, with the reason of a failure in `message`: the compiler's messages, lines of
/// `file:line: message`, cut to fit and always ended; empty on success.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; the text ends with a 0; `message` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_compile_and_load_coff_with_message(
    client: *mut Client,
    file: *const c_char,
    thread: c_int,
    message: *mut c_char,
    size: usize,
) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the buffer.
        let message = unsafe { buffer(message, size) };
        fill(message, "");
        // SAFETY: the caller vouches for the text.
        let file = unsafe { text(file) }?;
        // SAFETY: the caller vouches for the client.
        let board = unsafe { board(client) }?;
        board.compile_and_load_coff(Path::new(file), thread).map_err(|error| {
            fill(message, &error.to_string());
            Outcome::from(error)
        })
    })
}

/// Loads an image, as `cc67 build` writes it, into a thread. If it fails, what was in the thread is still there.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; the text ends with a 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_load_coff(client: *mut Client, thread: c_int, file: *const c_char) -> Outcome {
    guarded(|| {
        // SAFETY: the caller vouches for the text.
        let file = unsafe { text(file) }?;
        // SAFETY: the caller vouches for the client.
        Ok(unsafe { board(client) }?.load_coff(thread, Path::new(file))?)
    })
}
