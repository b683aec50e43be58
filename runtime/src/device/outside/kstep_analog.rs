//! The analog output of KStep: PWM 0 through an opto coupler and a low pass of 10 ms.
//!
//! The coupler makes short pulses longer: the first counts of the duty give more than their share. The curve is that of
//! the manual's correction table: its ratios for the counts 0 to 7 and for 240, straight lines between them.

use kmotiondef::Cycles;

use crate::device::attached::{Attached, Outside, Settings};
use crate::stimulus::conversion;

/// Ratio of the output to its supply for the first counts of duty.
const FIRST: [f64; 8] = [0.001, 0.031, 0.044, 0.054, 0.062, 0.069, 0.074, 0.079];
/// The same far up, where the curve is straight.
const FAR: (f64, f64) = (240.0, 0.970);
/// Counts of a full duty.
const FULL: f64 = 255.0;
/// Time constant of the low pass in seconds.
const CONSTANT: f64 = 0.01;
/// Counts of an analog input in a volt.
const COUNTS_PER_VOLT: f64 = 204.8;

/// The output and the analog input on it.
#[derive(Debug)]
pub(crate) struct KStepAnalog {
    adc: usize,
    supply: f64,
    ratio: f64,
    target: f64,
    at: Cycles,
}

impl KStepAnalog {
    /// `adc`, `volts`.
    pub(crate) fn new(settings: &mut Settings<'_>) -> Result<Self, String> {
        let (adc, supply) = (settings.adc("adc")?, settings.number("volts", 10.0)?);
        Ok(Self { adc, supply, ratio: 0.0, target: 0.0, at: Cycles::default() })
    }
}

/// What the coupler makes of a duty in counts.
fn coupled(counts: f64) -> f64 {
    let last = FIRST.len() - 1;
    let below = libm::floor(counts).max(0.0) as usize;
    if below < last {
        let part = counts - below as f64;
        return FIRST[below] + (FIRST[below + 1] - FIRST[below]) * part;
    }
    let slope = (FAR.1 - FIRST[last]) / (FAR.0 - last as f64);
    (FIRST[last] + slope * (counts - last as f64)).min(1.0)
}

impl Attached for KStepAnalog {
    fn tick(&mut self, now: Cycles, outside: &mut Outside<'_>) {
        let seconds = (now - self.at).get() as f64 / Cycles::PER_SECOND.get() as f64;
        self.at = now;
        self.ratio = self.target + (self.ratio - self.target) * libm::exp(-seconds / CONSTANT);
        self.target = outside.fpga.moved_pwm().map_or(0.0, |duty| coupled(duty * FULL));
        outside.kanalog.drive(self.adc, conversion(self.ratio * self.supply * COUNTS_PER_VOLT));
    }

    fn is_settled(&self) -> bool {
        self.ratio == self.target
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coupler_has_the_curve_of_the_table() {
        for (counts, expect) in [(0.0, 0.001), (2.0, 0.044), (6.5, 0.0765), (240.0, 0.970), (255.0, 1.0)] {
            assert!((coupled(counts) - expect).abs() < 1e-9, "{counts}: {}", coupled(counts));
        }
    }
}
