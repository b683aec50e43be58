//! The board around a real firmware: the user's own firmware file, executed by the processor's engine.
//!
//! Nothing here imitates the firmware. The file is loaded as the board's loader does ([`file`]), the processor starts
//! at its entry, and everything that it reaches outside of its two RAMs is a device of this room: the timer that
//! interrupts it ([`timer`]), the byte link to the PC ([`link`]), the registers of the FPGA ([`window`]) with step
//! generators ([`generators`]), pins ([`pins`]) and the serial port ([`uart`]), the flash chip ([`flash`]). What else is connected answers in their place ([`Around`]). What the axes move ([`loads`]) is brought up to date at
//! each match of the timer. [`bus`] says
//! which address is whose. [`BootedBoard`] runs them in one time: cycles of 5 ns.
//!
//! Source: `dsp-board.md` of the specification, by section. No address of a firmware is built in: what is wanted by
//! name (threads, axes) is looked up among the symbols of the file.
//!
//! Invariants:
//! - The state is registers, memory, devices; a run is a function of it and of the bytes put into the link.
//! - An address that is nobody's ends the run with the place and the registers; nothing panics.

#![forbid(unsafe_code)]

mod around;
mod board;
mod bus;
mod control;
mod crash;
mod file;
mod flash;
mod generators;
mod link;
mod loads;
mod pins;
#[cfg(test)]
mod tests;
mod timer;
mod uart;
mod window;

pub use around::{Around, AtMatch};
pub use board::{BootedBoard, BootedSnapshot, Doing, FlashError, Halted, Sent, SentLine};
pub use crash::Crash;
pub use file::{FirmwareError, FirmwareFile};
