//! The C boundary: pointers become references, and panics become results.

use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use cc67_host::{HostError, fill};

/// The result of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Outcome {
    /// The call succeeded.
    Ok = 0,
    /// The call failed; where there is a message, it gives the reason.
    Failed = 1,
    /// The board did not answer in time.
    Timeout = 2,
    /// The connection was lost or closed.
    NotConnected = 3,
    /// Another client has locked the board.
    InUse = 4,
    /// An argument is wrong: a null pointer, a text that is not UTF-8, a number out of range.
    Argument = 5,
    /// The library failed; the board is not to be used any more.
    Internal = 6,
}

impl From<HostError> for Outcome {
    fn from(error: HostError) -> Self {
        match error {
            HostError::NotConnected => Self::NotConnected,
            HostError::Timeout => Self::Timeout,
            HostError::InUse => Self::InUse,
            HostError::Thread(_) => Self::Argument,
            HostError::Read { .. }
            | HostError::Compile(_)
            | HostError::Refused { .. }
            | HostError::Foreign { .. }
            | HostError::NotLoaded(_)
            | HostError::Unmapped(_)
            | HostError::Stimulus(_)
            | HostError::Firmware(_)
            | HostError::Link(_)
            | HostError::Flash(_)
            | HostError::Unsupported(_)
            | HostError::Snapshot(_)
            | HostError::Act(_) => Self::Failed,
        }
    }
}

/// Runs the body of a call, and catches panics.
pub(crate) fn guarded(work: impl FnOnce() -> Result<(), Outcome>) -> Outcome {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => Outcome::Ok,
        Ok(Err(outcome)) => outcome,
        Err(_) => Outcome::Internal,
    }
}

/// Calls `work` and catches panics; returns its value, or `failure` after a panic.
pub(crate) fn guarded_or<R>(failure: R, work: impl FnOnce() -> R) -> R {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(failure)
}

/// A text passed by the caller.
///
/// # Safety
/// The pointer is null, or points to bytes that end with a 0 and do not change during the call.
pub(crate) unsafe fn text<'a>(pointer: *const c_char) -> Result<&'a str, Outcome> {
    if pointer.is_null() {
        return Err(Outcome::Argument);
    }
    // SAFETY: the caller vouches for bytes that end with a 0, and null was ruled out.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| Outcome::Argument)
}

/// An optional text.
///
/// # Safety
/// As for [`text`].
pub(crate) unsafe fn optional_text<'a>(pointer: *const c_char) -> Result<Option<&'a str>, Outcome> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: this function has the same requirement.
    unsafe { text(pointer) }.map(Some)
}

/// A buffer of the caller; empty for a null pointer.
///
/// # Safety
/// The pointer is null, or points to this many bytes that nobody else uses during the call.
pub(crate) unsafe fn buffer<'a>(pointer: *mut c_char, size: usize) -> &'a mut [u8] {
    if pointer.is_null() || isize::try_from(size).is_err() {
        return &mut [];
    }
    // SAFETY: the caller vouches for this many bytes, null and an impossible size were ruled out, and any byte is a u8.
    unsafe { slice::from_raw_parts_mut(pointer.cast::<u8>(), size) }
}

/// Stores a value at the caller's address.
///
/// # Safety
/// The pointer is null, or points to a place for the value that nobody else uses during the call.
pub(crate) unsafe fn store<T>(pointer: *mut T, value: T) -> Result<(), Outcome> {
    // SAFETY: the caller vouches for the place.
    let place = unsafe { pointer.as_mut() };
    *place.ok_or(Outcome::Argument)? = value;
    Ok(())
}

/// Copies a text into a buffer, which needs room for at least the terminating 0.
pub(crate) fn copy_text(buffer: &mut [u8], text: &str) -> Result<(), Outcome> {
    if buffer.is_empty() {
        return Err(Outcome::Argument);
    }
    fill(buffer, text);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_reported_as_an_internal_error() {
        let hook = std::panic::take_hook();
        std::panic::set_hook(Box::new(|_| ()));
        let outcome = guarded(|| panic!("a mistake of ours"));
        let value = guarded_or(-1, || panic!("another one"));
        std::panic::set_hook(hook);
        assert_eq!((outcome, value), (Outcome::Internal, -1));
    }
}
