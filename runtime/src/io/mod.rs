//! Everything but memory that a program can access: pins, registers of the FPGA, lines, step generators, option boards,
//! flash.
//!
//! These parts know each other and guest memory. `machine` and `world` handle what is connected to them.

pub(crate) mod amplifiers;
pub(crate) mod bits;
pub(crate) mod changes;
pub(crate) mod encoder;
pub(crate) mod flash;
pub(crate) mod fpga;
pub(crate) mod kanalog;
pub(crate) mod konnect;
pub(crate) mod kstep;
pub(crate) mod pins;
pub(crate) mod snapamp;
pub(crate) mod stepgen;
pub(crate) mod timer;
pub(crate) mod uart;

use kmotiondef::Cycles;

use crate::io::encoder::Encoders;
use crate::io::flash::Banks;
use crate::io::fpga::{Behind, Fpga};
use crate::io::kanalog::Kanalog;
use crate::io::konnect::Konnects;
use crate::io::pins::Pins;
use crate::io::snapamp::SnapAmps;
use crate::io::stepgen::StepGenerators;
use crate::io::uart::Uart;

/// The inputs and outputs of the board and of its option boards.
#[derive(Clone, Debug, Default)]
pub(crate) struct Io {
    pub(crate) pins: Pins,
    pub(crate) fpga: Fpga,
    pub(crate) uart: Uart,
    pub(crate) snapamps: SnapAmps,
    pub(crate) konnects: Konnects,
    pub(crate) kanalog: Kanalog,
    pub(crate) encoders: Encoders,
    pub(crate) stepgens: StepGenerators,
    /// How much of flash is visible.
    pub(crate) flash: Banks,
}

impl Io {
    /// The registers and what they act on.
    pub(crate) fn registers(&mut self, now: Cycles) -> (&mut Fpga, Behind<'_>) {
        let behind = Behind {
            pins: &mut self.pins,
            uart: &mut self.uart,
            kanalog: &self.kanalog,
            encoders: &mut self.encoders,
            stepgens: &mut self.stepgens,
            now,
        };
        (&mut self.fpga, behind)
    }
}
