//! A connected controller as the target of a [session](cc67_host::Session).
//!
//! [`Controller`] is a [`Target`](cc67_host::Target) whose time passes by itself: a call waits, and meanwhile reads the
//! data that the board sends. Views of sessions show a controller like a simulated board, except for its limits: it can
//! neither stop nor go back in time, and no command of its firmware reads memory other than `persist.UserData`.
//!
//! ```text
//! connection  a connected controller, before programs are loaded
//! saving      saving to flash
//! controller  the target: load, start, stop, status
//! bench       a stimulus without a model: actions of a person and of the PC
//! commands    actions of the PC for requests of programs
//! monitor     a program in a free thread, for requests without a command
//! files       files of the PC, for programs on the controller
//! terms       the terms on which programs are loaded
//! image       the conversion of a program to a download
//! recording   variables in each servo tick, by the board's data recorder
//! sampler     a program in a free thread that samples variables for a scope
//! resident    loading programs of cc67
//! threads     the known state of the board's threads
//! seen        the known contents of memory
//! clock       board time, which passes by itself
//! ```
//!
//! # The monitor
//!
//! No command of the firmware reads memory. If a view allows it ([`LoadTerms::has_monitor`]), a small program of cc67
//! is loaded into the highest free thread and runs for the duration of a request: it copies memory to the end of the
//! gather buffer, adds up the bytes of a program to verify a load, or pauses threads. So variables of programs can be
//! read by name. The words of one value may have been read at different times, as the programs continue to run.
//!
//! Invariants:
//!
//! - **Nothing moves by itself**: connecting sends no command that starts or moves anything.
//! - **Only [`ControllerLink::save`] writes flash, and nothing writes firmware.**
//! - **A lost link is reported once**, and values read before are not shown as present values after it.
//! - Threads that were active before the connection are not stopped, and the end of a run does not wait for them.
//!
//! Source: host-protocol.md, wire.md.

#![forbid(unsafe_code)]

mod bench;
mod clock;
mod commands;
mod connection;
mod controller;
mod files;
mod image;
mod monitor;
mod recording;
mod resident;
mod sampler;
mod saving;
mod seen;
mod terms;
mod threads;

pub use cc67_wire::{Address, AddressError, Client, FoundBoard, Progress, WireError, boards, kognas};
pub use connection::ControllerLink;
pub use controller::Controller;
pub use saving::UnsettledState;
pub use terms::{LoadTerms, ProgramStart};

/// The beginning of a request to the person at the controller, in an [event](runtime::EventKind::Host).
pub const BY_HAND: &str = "by hand: ";
/// The beginning of the event that names expectations of a stimulus which a controller does not check.
pub const UNCHECKED: &str = "not checked on the controller: ";

/// The facts that a person should know before the first connection of a project.
pub const FIRST_TIME: &str = "\
This connects to a real controller, and programs on it move real machines.

  - cc67's link, downloads and code have run on the released firmware in emulation, never on a controller.
  - Switch the drives off for the first trials, and keep the emergency stop within reach.
  - Connecting starts nothing. A program that is started moves whatever it wants, and continues when cc67 ends.
";
