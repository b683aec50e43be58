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
mod firmware;
mod io;
mod kernel;
mod machine;
mod out;
mod pc;
mod servo;
#[cfg(test)]
mod testing;
mod text;
mod views;
mod world;

pub use board::machine_file::{MachineFile, MachineFileError};
pub use board::{Board, Config, RunEnd, debug, loader, machine_file};
pub use io::flash::FLASH_SIZE;
pub use io::konnect::{Board as KonnectBoard, Port};
pub use io::snapamp::{Quantity, Side};
pub use kernel::{Kernel, pure_function};
pub use out::{Event, EventKind};
pub use pc::files::{Directory, FILE_BYTES, FileError, HostFiles, NoFiles};
pub use pc::{ANSWERS_HELP, AnswerError, Answers};
pub use world::attached::DeviceSpec;
pub use world::{stimulus, trace};
