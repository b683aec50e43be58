//! The simulated KFLOP board: firmware functions, servo, inputs and outputs, console, and a minimal PC.
//!
//! A board is a stack of parts, each of which sees only those below it. At the bottom are the output ([`Event`]s) and
//! typed views of guest memory. Above are inputs and outputs: pins, registers of the FPGA, lines, option boards. Next
//! is the machine that the board moves: loads of the axes, switches that they trip, devices on the lines. Once a tick,
//! the servo reads the axes from guest memory and moves destinations, loads and outputs; it does not depend on anything
//! above it. Above the servo, side by side, are the PC, which answers requests and keeps files, and the world, which
//! plays a stimulus on the lines and records events. Firmware functions (C calls) and script commands (words) are thin:
//! each is a call of one part. The kernel makes the parts implement the traits of `vm` and defines their order in a
//! tick. [`Board`] holds the kernel and the programs, and is the interface: load programs, start threads, run, and
//! receive events.
//!
//! | folder | contents | state |
//! |---|---|---|
//! | `board/` | the public face: programs, start-up, machine files | [`Board`] |
//! | `kernel.rs` | the parts that implement the machine's traits; the order of a tick | [`Kernel`] |
//! | `commands/` | script commands, one row and one function each | `Scripts` |
//! | `firmware/` | firmware functions, one function a row; the parts side by side | `Parts`, `Calls` |
//! | `world/` | stimulus, operator, recordings; the table of devices | `World` |
//! | `pc/` | requests from programs, disk, bytes from the PC | `Pc` |
//! | `servo/` | trajectories, compensation, outputs, limits, coordinated motion | `Servo` |
//! | `machine/` | loads, the switches that they trip, attached devices | `Machine` |
//! | `io/` | the chips of [`chips`], option boards, timer, flash in guest memory | `Io` |
//! | `out/` | events, console text, requests to the board | `Out` |
//! | `views.rs`, `text/` | typed access to guest memory; the board's `printf` and `scanf` | none |
//! | `arithmetic/` | divisions, roots, elementary functions with the bits of the board | none |
//!
//! Invariants:
//! - Imports point downwards in this table; `tests/tidy` checks it.
//! - Guest memory is the only copy of what a program can see (`chan[]`, `persist`, `VirtualBits`, …); the parts keep
//!   only state that these structures do not hold. Values that the servo derives from them are in one cache with one
//!   `invalidate`.
//! - A run is a function of images, inputs and options: no clock, no randomness, no hash order, no host `sin`.
//! - Every firmware function is a row of `kmotiondef::firmware` and one Rust function in `firmware/<group>.rs`. A
//!   function that is not modelled yet traps when it is called.
//! - The state of every part can be copied.
//! - Nothing here knows the compiler; only the loader knows the image format.

#![forbid(unsafe_code)]

mod arithmetic;
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
pub use board::{Board, BoardSnapshot, Config, RunEnd, debug, loader, machine_file, standing, surroundings};
pub use firmware::level::ModelledBoard;
pub use io::flash::FLASH_SIZE;
pub use io::konnect::{KonnectBoard, Port};
pub use io::snapamp::{Quantity, Side};
pub use kernel::{Kernel, pure_function};
pub use out::{Event, EventKind, Message, OtherPlace, REMARKS, Remark, RemarkRow, Severity, Speaker};
pub use pc::directory::Directory;
pub use pc::disk::{FileAnswer, FileServer, ServedFile};
pub use pc::files::{FILE_BYTES, FileError, HostFiles, NoFiles, Overlay};
pub use pc::{ANSWERS_HELP, AnswerError, Answers, OpenBox, RemoteBoard, RequestServer, is_request};
pub use world::attached::DeviceSpec;
pub use world::{stimulus, trace};
