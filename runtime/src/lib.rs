//! The simulated KFLOP board: firmware functions, servo, inputs and outputs, console, and a minimal PC.
//!
//! A board is a stack of parts, each of which sees only those below it. At the bottom is what goes out ([`Event`]s)
//! and typed views of guest memory. On that are inputs and outputs: pins, registers of the FPGA, lines, option boards.
//! On these is the machine that the board moves: loads of the axes, switches that they trip, devices on the lines. Once
//! a tick the servo reads the axes from guest memory, moves destinations, loads and outputs, and knows nothing above
//! it. Beside each other above it are the PC, which answers requests and keeps files, and the world, which plays a
//! stimulus on the lines and records what happens. Firmware functions (a C call in) and script commands (a word in)
//! are thin: each is a call of one part. The kernel makes the parts implement the traits of `vm` and says in which order
//! they have their turn in a tick. [`Board`] holds the kernel and the programs, and is the way in: load programs, start
//! threads, run, and receive events.
//!
//! | folder | what it is | state |
//! |---|---|---|
//! | `board/` | the public face: programs, start-up, machine files | [`Board`] |
//! | `kernel.rs` | the parts that implement the machine's traits; the order of a tick | [`Kernel`] |
//! | `commands/` | script commands, one row and one function each | `Scripts` |
//! | `firmware/` | firmware functions, one function a row; the parts side by side | `Parts`, `Calls` |
//! | `world/` | stimulus, operator, recordings; the devices that there are | `World` |
//! | `pc/` | requests of programs, disk, bytes that the PC sends | `Pc` |
//! | `servo/` | trajectories, compensation, outputs, limits, coordinated motion | `Servo` |
//! | `machine/` | loads, what they trip, devices while they are attached | `Machine` |
//! | `io/` | pins, FPGA, UART, step generators, option boards, flash | `Io` |
//! | `out/` | events, console text, requests to the board | `Out` |
//! | `views.rs`, `text/` | typed access to guest memory; the board's `printf` and `scanf` | none |
//!
//! Invariants:
//! - Imports point downwards in this table; `tests/tidy` checks it.
//! - Guest memory is the only copy of what a program can see (`chan[]`, `persist`, `VirtualBits`, …); the parts keep
//!   only what the structures do not hold. What the servo derives from it is in one cache with one `invalidate`.
//! - A run is a function of images, inputs and options: no clock, no randomness, no order of a hash, no host `sin`.
//! - Every firmware function is a row of `kmotiondef::firmware` and one Rust function in `firmware/<group>.rs`. One
//!   whose behaviour is still to come traps as not modelled when it is called.
//! - The state of every part can be copied.
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
pub use board::{Board, BoardSnapshot, Config, RunEnd, debug, loader, machine_file, standing, surroundings};
pub use io::flash::FLASH_SIZE;
pub use io::konnect::{KonnectBoard, Port};
pub use io::snapamp::{Quantity, Side};
pub use kernel::{Kernel, pure_function};
pub use out::{Event, EventKind, Message, REMARKS, Remark, RemarkRow, Severity, Speaker};
pub use pc::files::{Directory, FILE_BYTES, FileError, HostFiles, NoFiles, Overlay};
pub use pc::{ANSWERS_HELP, AnswerError, Answers, OpenBox};
pub use world::attached::DeviceSpec;
pub use world::{stimulus, trace};
