//! A connected controller as the target of a [session](cc67_host::Session).
//!
//! [`Controller`] is a [`Target`](cc67_host::Target) whose time passes by itself: a call waits, and reads meanwhile what
//! the board sends. Views that know a session show a controller like a simulated board, except for what it cannot do: it
//! neither stops nor goes back, and no command of its firmware reads memory besides `persist.UserData`.
//!
//! ```text
//! controller  the target: load, start, stop, status
//! files       files of the PC, for programs on the controller
//! image       from a program to what is downloaded
//! seen        memory as the status record shows it
//! clock       the present moment
//! ```
//!
//! Invariants:
//!
//! - **Nothing moves by itself**: connecting sends no command that starts or moves anything.
//! - **Flash and firmware are never written.**
//! - **A lost link is reported once**, and nothing that was read before is shown as present after it.
//! - Threads that were active before the connection are neither waited for nor stopped.
//!
//! Source: host-protocol.md, wire.md.

#![forbid(unsafe_code)]

mod clock;
mod controller;
mod files;
mod image;
mod seen;

pub use cc67_wire::{Address, AddressError, Client, FoundBoard, Progress, WireError, boards};
pub use controller::{Controller, ControllerLink};

/// The facts that a person should know before the first connection of a project.
pub const FIRST_TIME: &str = "\
This connects to a real controller, and programs on it move real machines.

  - cc67's link, downloads and code have run on the released firmware in emulation, never on a controller.
  - Switch the drives off for the first trials, and keep the emergency stop within reach.
  - Connecting starts nothing. A program that is started moves whatever it wants, and continues when cc67 ends.
";
