//! The board around a real firmware: the user's own firmware file, executed by the processor's engine.
//!
//! Nothing here imitates the firmware. The file is loaded as the board's loader does it ([`file`]), the processor
//! starts at its entry point, and everything that it accesses outside its two RAMs is a device: the timer that
//! interrupts it ([`timer`]), the byte link to the PC ([`link`]), the window on the registers and [`chips`] of the FPGA
//! ([`window`]), the flash chip ([`flash`]). Other connected devices answer through [`ExternalHardware`]. Functions in
//! the processor's ROM, whose code is not in any file, are computed directly ([`rom`]). The loads of the axes
//! ([`loads`]) are updated at each match of the timer. [`bus`] maps addresses to devices. [`BootedBoard`] runs them all
//! on one time base: cycles of 5 ns.
//!
//! Source: `dsp-board.md` of the specification, by section. No address of a firmware is built in: threads and axes are
//! looked up among the symbols of the file.
//!
//! Invariants:
//! - The state consists of registers, memory and devices; a run is a function of the state and of the bytes put into
//!   the link.
//! - An access to an unmapped address ends the run with a report of position and registers; nothing panics.

#![forbid(unsafe_code)]

mod board;
mod bus;
mod control;
mod crash;
mod external;
mod file;
mod flash;
mod link;
mod loads;
mod rom;
mod sent;
#[cfg(test)]
mod tests;
mod timer;
mod window;

pub use board::{
    BootedBoard, BootedSnapshot, FlashError, HaltError, ProcessorState, ProgramCall, ProgramPacket,
    RunOutcome, StopPosition,
};
pub use crash::Crash;
pub use external::{ExternalHardware, TimerMatch};
pub use file::{FirmwareError, FirmwareFile};
pub use sent::{SentKind, SentLine};
