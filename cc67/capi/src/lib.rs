//! The host interface for C programs: a library, `cc67board`, and its header, `include/cc67board.h`.
//!
//! The calls are those of [`cc67_host::Board`] under the same names with `cc67_` in front. The result of a call reports
//! success or failure; texts are copied into buffers of the caller, truncated to fit and always terminated with a 0. A
//! client is a pointer to a box with one client of a shared board; each function checks its pointers, calls the method
//! of the same name, and converts its result to a number.
//!
//! ```text
//! client, console, lines, programs, time, token   the functions, by subject
//! handle                                          the box to which a client points
//! border                                          pointers to references, panics and errors to results
//! ```
//!
//! Invariants:
//! - Unsafe code exists only here and in the machine's native engine: only [`border`] and [`handle`] dereference a
//!   caller's pointers. The rules for callers are the same for all calls and are in the header.
//! - No panic leaves a call: it is caught and returned as [`Outcome::Internal`].
//! - A null pointer, a text that is not UTF-8 or a buffer that is too small gives an error result, never undefined
//!   behaviour.
//! - The header is generated from these files; a test compares it.

#![expect(unsafe_code, reason = "what C programs hand over are pointers, and they call by unmangled names")]

mod border;
mod client;
mod console;
mod handle;
mod lines;
mod programs;
mod time;
mod token;

pub use border::Outcome;
pub use console::{LineCallback, cc67_service_console, cc67_set_console_callback, cc67_take_remark};
pub use handle::Client;

pub use client::{
    cc67_another_client, cc67_close, cc67_firmware_version, cc67_list_locations, cc67_open,
    cc67_open_controller, cc67_open_firmware,
};
pub use lines::{
    cc67_check_for_ready, cc67_get_status, cc67_read_line_timeout, cc67_write_line,
    cc67_write_line_read_line, cc67_write_line_with_echo,
};
pub use programs::{
    cc67_compile_and_load_coff, cc67_compile_and_load_coff_with_message, cc67_include_dir, cc67_load_coff,
};
pub use time::{
    EndCallback, cc67_drive_input, cc67_run_for, cc67_run_until, cc67_set_user_data, cc67_user_data,
};
pub use token::{cc67_disconnect, cc67_failed, cc67_kmotion_lock, cc67_release_token, cc67_wait_token};
