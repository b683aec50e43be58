//! The surroundings of the board at register level: motors, switches, devices on the lines.
//!
//! The board alone has registers that store the written values, and loads that follow their axes
//! ([`loads`](super::loads)). Other connected hardware answers the input registers instead, sees every write in its
//! cycle, and is updated at each match of the timer, before the interrupt is taken (`dsp-board.md` 8).

use std::fmt::Debug;

use chips::stepgen::GENERATORS;
use vm::memory::GuestMemory;

/// The state that can be read and changed at a match of the timer.
#[derive(Debug)]
pub struct TimerMatch<'a> {
    /// The memory, for data only.
    pub memory: &'a mut GuestMemory,
    /// The cycle of the match, since power-up.
    pub now: u64,
    /// The number of steps that each generator has made.
    pub steps: [f64; GENERATORS],
    /// The count bytes of the encoders from now on.
    pub encoders: &'a mut [u8; 8],
    /// The inputs of a KStep from now on, if there is one: a bit is set while current flows.
    pub kstep: &'a mut Option<u16>,
}

/// Hardware outside the board. Cycles are counted since power-up; a clone is independent and has the same state.
pub trait ExternalHardware: Clone + Debug {
    /// Returns the value of a register that the firmware reads; `None` if the board itself answers.
    fn read(&mut self, register: usize, is_byte: bool, now: u64) -> Option<u16>;

    /// Handles a register write by the firmware.
    fn write(&mut self, register: usize, is_byte: bool, value: u16, now: u64);

    /// Handles a match of the timer.
    fn tick(&mut self, at: &mut TimerMatch<'_>);
}

/// No hardware: every register is the board's own.
impl ExternalHardware for () {
    fn read(&mut self, _: usize, _: bool, _: u64) -> Option<u16> {
        None
    }

    fn write(&mut self, _: usize, _: bool, _: u16, _: u64) {}

    fn tick(&mut self, _: &mut TimerMatch<'_>) {}
}
