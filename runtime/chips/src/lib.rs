//! The chips of a KFLOP and of its Kanalog as a processor sees them.
//!
//! The modelled board and the board around a real firmware use the same chips: one through its firmware functions, the
//! other through its instructions. Nothing here depends on a processor, guest memory, an axis' servo or a firmware; the
//! owner passes in the time of each access.
//!
//! | module | contents |
//! |---|---|
//! | [`fpga`] | the map of the registers, and their effect |
//! | [`pins`], [`changes`] | levels, latches and directions of bits; their changes with their times |
//! | [`stepgen`] | the step generators |
//! | [`encoder`] | counters and phases of the encoder inputs |
//! | [`uart`] | the serial port |
//! | [`kanalog`], [`kstep`] | analog inputs of the Kanalog, analog output of the KStep |
//! | [`flash`] | the commands of the flash chip |
//!
//! Invariants:
//! - This crate depends on `kmotiondef` alone.
//! - The state of a chip is a value that can be copied; an access is a function of the state and of its time.
//! - No access panics: registers, lines and offsets that do not exist read as 0 and ignore writes.

#![forbid(unsafe_code)]

pub mod changes;
pub mod encoder;
pub mod flash;
pub mod fpga;
pub mod kanalog;
pub mod kstep;
pub mod pins;
pub mod stepgen;
pub mod uart;

use kmotiondef::Cycles;

use crate::encoder::Encoders;
use crate::fpga::{Fpga, RegisterChips};
use crate::kanalog::Kanalog;
use crate::pins::Pins;
use crate::stepgen::StepGenerators;
use crate::uart::Uart;

/// The chips that are accessed through registers of the FPGA.
///
/// By default they are in the state in which a firmware leaves them after its start.
#[derive(Clone, Debug, Default)]
pub struct Chips {
    /// Registers that only store, and derived state.
    pub fpga: Fpga,
    /// Levels, latches and directions.
    pub pins: Pins,
    /// The serial port.
    pub uart: Uart,
    /// Analog inputs of a Kanalog.
    pub kanalog: Kanalog,
    /// Encoder inputs.
    pub encoders: Encoders,
    /// Step generators.
    pub stepgens: StepGenerators,
}

impl Chips {
    /// The chips before a firmware has started and accesses them through their registers; without a Kanalog.
    #[must_use]
    pub fn at_power_up() -> Self {
        Self {
            fpga: Fpga::at_power_up(),
            pins: Pins::at_power_up(),
            uart: Uart::default(),
            kanalog: Kanalog::absent(),
            encoders: Encoders::default(),
            stepgens: StepGenerators::exact(),
        }
    }

    /// The registers, and the chips on which they act at a given time.
    pub fn registers(&mut self, now: Cycles) -> (&mut Fpga, RegisterChips<'_>) {
        let Self { fpga, pins, uart, kanalog, encoders, stepgens } = self;
        (fpga, RegisterChips { pins, uart, kanalog, encoders, stepgens, now })
    }
}
