//! An analog input on the analog output of a KStep.

use kmotiondef::Cycles;

use crate::io::kanalog::COUNTS_PER_VOLT;
use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::world::attached::Settings;
use chips::kanalog::conversion;

/// The input, and the supply of the output.
#[derive(Clone, Debug)]
pub(crate) struct KStepAnalog {
    adc: usize,
    supply: f64,
    is_settled: bool,
}

impl KStepAnalog {
    /// `adc`, `volts`.
    pub(crate) fn new(settings: &mut Settings<'_>) -> Result<Self, String> {
        let (adc, supply) = (settings.adc("adc")?, settings.number("volts", 10.0)?);
        Ok(Self { adc, supply, is_settled: false })
    }
}

impl AttachedDevice for KStepAnalog {
    fn tick(&mut self, now: Cycles, outside: &mut DeviceContext<'_>) {
        let output = outside.fpga.kstep_output();
        self.is_settled = output.is_settled(now);
        outside.kanalog.drive(self.adc, conversion(output.level(now) * self.supply * COUNTS_PER_VOLT));
    }

    fn is_settled(&self) -> bool {
        self.is_settled
    }
}
