//! The deterministic machine that runs KFLOP user programs.
//!
//! A program is register bytecode ([`op`]). The loader hands its bytes to [`verify`],
//! which yields a [`program::Program`] that an engine can run without further checks.
//!
//! Invariants:
//! - The machine knows no firmware function, device or axis; it meets them through
//!   [`firmware::Firmware`] and [`bus::Bus`].
//! - A run is a function of images, inputs and options: no clock, no randomness, no
//!   operating-system thread, no order of a hash.
//! - `charge` is the only place where a thread can lose the processor.

mod access;
pub mod arith;
pub mod bus;
pub mod engine;
pub mod firmware;
pub mod interp;
pub mod machine;
pub mod memory;
pub mod meter;
#[cfg(feature = "native")]
pub mod native;
pub mod op;
pub mod operand;
pub mod profile;
pub mod program;
mod protection;
pub mod scheduler;
pub mod slot;
#[cfg(test)]
mod testing;
pub mod text;
pub mod thread;
pub mod trap;
pub mod varargs;
pub mod verify;
