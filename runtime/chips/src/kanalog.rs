//! Kanalog: the conversions of its eight analog inputs.
//!
//! Its outputs are bits of [`Pins`](crate::pins::Pins) and `DAC_Buffer`, so they need no state here. Source: devices.md
//! section 2.

/// Analog inputs.
pub const ADC_CHANNELS: usize = 8;
/// The conversion of 0 V.
pub const ZERO: i32 = 2048;

/// The voltages on the inputs.
#[derive(Clone, Debug)]
pub struct Kanalog {
    /// Set once something is connected; before that there is nothing to update.
    is_driven: bool,
    /// The inputs that are driven or will be driven.
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
    /// No Kanalog: its registers read as 0, which tells the firmware that there is none.
    #[must_use]
    pub fn absent() -> Self {
        Self { levels: [0; ADC_CHANNELS], ..Self::default() }
    }

    /// Sets the voltage at an input, given as its conversion.
    pub fn drive(&mut self, channel: usize, conversion: i32) {
        self.is_driven = true;
        self.connect(channel);
        if let Some(level) = self.levels.get_mut(channel) {
            *level = conversion;
        }
    }

    /// Notes that an input will be driven.
    pub fn connect(&mut self, channel: usize) {
        if let Some(connected) = self.connected.get_mut(channel) {
            *connected = true;
        }
    }

    /// Returns whether an input is driven or will be driven.
    #[must_use]
    pub fn is_connected(&self, channel: usize) -> bool {
        self.connected.get(channel).copied().unwrap_or_default()
    }

    /// Returns whether any input is driven.
    #[inline]
    #[must_use]
    pub const fn is_driven(&self) -> bool {
        self.is_driven
    }

    /// The conversion of an input, 0 to 4095.
    #[must_use]
    pub fn conversion(&self, channel: usize) -> u32 {
        self.levels.get(channel).copied().unwrap_or_default().cast_unsigned()
    }

    /// The conversions of all inputs.
    #[must_use]
    pub const fn conversions(&self) -> [i32; ADC_CHANNELS] {
        self.levels
    }
}

/// The conversion, 0 to 4095, for a value in counts.
#[must_use]
pub fn conversion(counts: f64) -> i32 {
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
}
