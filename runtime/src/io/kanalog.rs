//! Kanalog: eight analog inputs that are converted again in each tick while the board's port serves it.
//!
//! Its outputs are stored bits and `DAC_Buffer`, which nothing else has to copy. Source: devices.md section 2.

use kmotiondef::variables::{ADC_BUFFER_IN, KANALOG_PRESENT};
use vm::memory::GuestMemory;

use super::fpga::Fpga;
use crate::views::Typed;

/// Analog inputs.
pub(crate) const ADC_CHANNELS: usize = 8;
/// The conversion of 0 V.
const ZERO: i32 = 2048;

/// What is connected to the inputs.
#[derive(Clone, Debug)]
pub(crate) struct Kanalog {
    /// Whether anything is; nothing has to be done before.
    is_driven: bool,
    /// The inputs that something drives, or will drive.
    connected: [bool; ADC_CHANNELS],
    /// Conversions, 0 to 4095.
    levels: [i32; ADC_CHANNELS],
}

impl Default for Kanalog {
    fn default() -> Self {
        Self { is_driven: false, connected: [false; ADC_CHANNELS], levels: [ZERO; ADC_CHANNELS] }
    }
}

impl Kanalog {
    /// Puts a voltage on an input, as its conversion.
    pub(crate) fn drive(&mut self, channel: usize, conversion: i32) {
        self.is_driven = true;
        self.connect(channel);
        if let Some(level) = self.levels.get_mut(channel) {
            *level = conversion;
        }
    }

    /// Something will drive an input.
    pub(crate) fn connect(&mut self, channel: usize) {
        if let Some(connected) = self.connected.get_mut(channel) {
            *connected = true;
        }
    }

    /// Whether something drives an input, or will.
    pub(crate) fn is_connected(&self, channel: usize) -> bool {
        self.connected.get(channel).copied().unwrap_or_default()
    }

    /// The conversion of an input, 0 to 4095.
    pub(crate) fn conversion(&self, channel: usize) -> u32 {
        self.levels.get(channel).copied().unwrap_or_default().cast_unsigned()
    }

    /// Converts all inputs, if something is connected to them and the port serves Kanalog.
    pub(crate) fn tick(&self, fpga: &Fpga, memory: &mut GuestMemory) {
        if !self.is_driven || !is_served(fpga, memory) {
            return;
        }
        for (channel, level) in self.levels.into_iter().enumerate() {
            memory.set(ADC_BUFFER_IN.element(channel), level);
        }
    }

    /// Whether the next tick converts what the last one did.
    pub(crate) fn is_settled(&self, fpga: &Fpga, memory: &GuestMemory) -> bool {
        let is_same = |(channel, level): (usize, &i32)| memory.get(ADC_BUFFER_IN.element(channel)) == *level;
        !self.is_driven || !is_served(fpga, memory) || self.levels.iter().enumerate().all(is_same)
    }
}

/// Whether the port serves Kanalog: found at power-up, or switched on by the program.
pub(crate) fn is_served(fpga: &Fpga, memory: &GuestMemory) -> bool {
    fpga.serves_kanalog() || memory.get(KANALOG_PRESENT) != 0
}

/// The conversion of an analog input, 0 to 4095, at a value in counts.
pub(crate) fn conversion(counts: f64) -> i32 {
    // A cast saturates, and NaN becomes 0.
    (libm::round(counts) as i32).clamp(-2048, 2047) + 2048
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversions_stay_within_12_bits() {
        for (counts, expect) in [(0.0, 2048), (-9e9, 0), (2047.4, 4095), (9e9, 4095), (f64::NAN, 2048)] {
            assert_eq!(conversion(counts), expect, "{counts}");
        }
    }

    #[test]
    fn inputs_are_converted_only_while_kanalog_is_present() {
        let (mut kanalog, fpga, mut memory) = (Kanalog::default(), Fpga::default(), GuestMemory::new());
        memory.set(ADC_BUFFER_IN.element(3), ZERO);
        kanalog.drive(3, 4000);
        for (present, expect) in [(0, ZERO), (1, 4000)] {
            memory.set(KANALOG_PRESENT, present);
            kanalog.tick(&fpga, &mut memory);
            assert_eq!(memory.get(ADC_BUFFER_IN.element(3)), expect);
        }
    }
}
