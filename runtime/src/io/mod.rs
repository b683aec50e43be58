//! Everything except memory that a program can access: pins, registers of the FPGA, lines, step generators, option
//! boards, flash.
//!
//! The chips themselves are in [`chips`]; this module adds the parts that use guest memory. These parts
//! access each other. `machine` and `world` handle the equipment connected to them.

pub(crate) mod amplifiers;
pub(crate) mod bits;
pub(crate) mod changes;
pub(crate) mod flash;
pub(crate) mod kanalog;
pub(crate) mod kogna;
pub(crate) mod konnect;
pub(crate) mod snapamp;
pub(crate) mod timer;

use chips::encoder::Encoders;
use chips::fpga::{Fpga, Notice, RegisterChips};
use chips::kanalog::Kanalog;
use chips::pins::Pins;
use chips::stepgen::StepGenerators;
use chips::uart::Uart;
use kmotiondef::Cycles;

use crate::io::flash::Banks;
use crate::io::kanalog::Outputs;
use crate::io::kogna::Kogna;
use crate::io::konnect::Konnects;
use crate::io::snapamp::SnapAmps;
use crate::out::Message;

/// The inputs and outputs of the board and of its option boards.
#[derive(Clone, Debug, Default)]
pub(crate) struct Io {
    pub(crate) pins: Pins,
    pub(crate) fpga: Fpga,
    pub(crate) uart: Uart,
    pub(crate) snapamps: SnapAmps,
    pub(crate) konnects: Konnects,
    pub(crate) kanalog: Kanalog,
    /// Kanalog's outputs.
    pub(crate) outputs: Outputs,
    pub(crate) encoders: Encoders,
    pub(crate) stepgens: StepGenerators,
    /// The devices that only a Kogna has.
    pub(crate) kogna: Option<Box<Kogna>>,
    /// The visible part of flash.
    pub(crate) flash: Banks,
}

impl Io {
    /// The registers and the parts on which they act.
    pub(crate) fn registers(&mut self, now: Cycles) -> (&mut Fpga, RegisterChips<'_>) {
        let chips = RegisterChips {
            pins: &mut self.pins,
            uart: &mut self.uart,
            kanalog: &self.kanalog,
            encoders: &mut self.encoders,
            stepgens: &mut self.stepgens,
            now,
        };
        (&mut self.fpga, chips)
    }
}

/// The remark on an action of a program on a register that has no effect.
pub(crate) const fn remark_on(notice: Notice) -> Message {
    match notice {
        Notice::KanalogPin(bit) => Message::KanalogPins { bit },
        Notice::UartUnconnected => Message::UartUnconnected {},
        Notice::UnknownRegister(number) => Message::UnknownRegister { number },
    }
}
