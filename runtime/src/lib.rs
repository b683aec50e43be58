//! The simulated KFLOP board: firmware functions, servo, inputs and outputs, console, and a minimal PC.
//!
//! [`Board`] is the way in: load programs, start threads, run, and receive [`Event`]s.
//!
//! Invariants:
//! - Guest memory is the only copy of what a program can see (`chan[]`, `persist`, `VirtualBits`, …); the kernel keeps
//!   only what the structures do not hold.
//! - A run is a function of images, inputs and options: no clock, no randomness, no order of a hash, no host `sin`.
//! - Every firmware function is a row of `kmotiondef::firmware` and one Rust function in `firmware/<group>.rs`. One
//!   whose behaviour is still to come traps as not modelled when it is called.
//! - Nothing here knows the compiler; only the loader knows the image format.

#![forbid(unsafe_code)]

mod board;
pub mod commands;
mod console;
pub mod debug;
mod device;
mod dispatch;
mod event;
mod files;
mod firmware;
mod flash;
mod globals;
mod heap;
mod host;
mod kernel;
pub mod loader;
pub mod machine_file;
mod plant;
mod power_up;
mod servo;
pub mod stimulus;
#[cfg(test)]
mod testing;
mod text;
pub mod trace;
mod views;

pub use board::{Board, Config, RunEnd};
pub use device::attached::DeviceSpec;
pub use device::konnect::{Board as KonnectBoard, Port};
pub use device::snapamp::{Quantity, Side};
pub use event::{Event, EventKind};
pub use files::{Directory, FILE_BYTES, FileError, HostFiles, NoFiles};
pub use flash::FLASH_SIZE;
pub use host::{ANSWERS_HELP, AnswerError, Answers};
pub use kernel::{Kernel, pure_function};
pub use machine_file::{MachineFile, MachineFileError};
