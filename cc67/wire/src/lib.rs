//! The link to a controller: transports, and a client of the board's byte protocol.
//!
//! ```text
//! address    addresses of boards: usb, serial:PATH, server, kogna, tcp:HOST:PORT
//! transport  opens the link to the board at an address
//! boards     lists the connected boards
//! queue      several users of one board, in turn
//! client     connects, executes commands, loads programs, reads the console and the status
//! disk       answers the file requests of programs
//! lines      replies, console lines and requests in the received bytes
//! link       a stream of bytes in both directions that never blocks its user
//! error      errors, each with the location of the board
//! ```
//!
//! Invariants:
//!
//! - **Nothing blocks forever**: each call has a time limit, and bytes are received while others are sent.
//! - Unsafe code exists only in `transport/d2xx.rs`, which is compiled on Windows.
//! - **No program is started automatically**: only [`Client::command`] with `Execute` starts a program.
//! - **Only [`Client::save_to_flash`] writes flash.**
//! - **A program that was not loaded completely cannot be started** ([`Client::load`]).
//!
//! Source of the protocol: host-protocol.md, wire.md.

#![deny(unsafe_code)]

mod address;
mod boards;
mod client;
mod clock;
mod disk;
mod error;
mod found;
mod lines;
mod link;
mod queue;
mod transport;

pub use address::{Address, AddressError, ServerAddress};
pub use boards::boards;
pub use client::{Client, LoadImage, Progress, Status};
pub use disk::{DiskAnswer, NoFiles, PcFiles};
pub use error::WireError;
pub use found::FoundBoard;
pub use lines::{Decoder, Incoming};
pub use link::BoardLink;
pub use queue::Queue;
pub use transport::{ftdi, kognas, open};
