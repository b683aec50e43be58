//! The start of an executable that `cc67 build --emit native` makes. It is not in the header: only the object file
//! calls it.

use std::ffi::c_int;

use cc67::cli::{self, Exit};
use vm::native::{Description, Linked};

use crate::border::guarded_or;

/// Runs the program that `description` describes as `cc67 run` would; yields the exit code of the process.
///
/// # Safety
/// Called once, by the `main` of an object file that cc67 has made, which hands over its own description.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_run_linked(description: *const Description) -> c_int {
    // SAFETY: the caller hands over what cc67 has written, and it stays as long as the process.
    let linked = unsafe { Linked::new(description) };
    guarded_or(Exit::WrongInput, || cli::stand_alone(std::env::args_os(), linked)) as c_int
}
