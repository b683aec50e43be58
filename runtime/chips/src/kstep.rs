//! The analog output of a KStep: PWM 0 through an optocoupler and a low-pass filter of 10 ms.
//!
//! The coupler lengthens short pulses: the first counts of the duty cycle have a disproportionate effect. The curve
//! follows the manual's correction table: its ratios for the counts 0 to 7 and for 240, with linear interpolation.

use kmotiondef::Cycles;

/// The ratio of the output to its supply for the first counts of the duty cycle.
const FIRST: [f64; 8] = [0.001, 0.031, 0.044, 0.054, 0.062, 0.069, 0.074, 0.079];
/// A point on the linear part of the curve.
const FAR: (f64, f64) = (240.0, 0.970);
/// The counts of a full duty cycle.
const FULL: f64 = 255.0;
/// The time constant of the low-pass filter in seconds.
const CONSTANT: f64 = 0.01;

/// The output as a fraction of its supply: computed exactly between changes of the duty cycle, so it needs no updates
/// in between.
#[derive(Clone, Copy, Debug, Default)]
pub struct AnalogOutput {
    level: f64,
    target: f64,
    at: Cycles,
}

/// Returns the output of the coupler for a duty cycle in counts.
fn coupler_output(counts: f64) -> f64 {
    let last = FIRST.len() - 1;
    let below = libm::floor(counts).max(0.0) as usize;
    if below < last {
        let part = counts - below as f64;
        return FIRST[below] + (FIRST[below + 1] - FIRST[below]) * part;
    }
    let slope = (FAR.1 - FIRST[last]) / (FAR.0 - last as f64);
    (FIRST[last] + slope * (counts - last as f64)).min(1.0)
}

impl AnalogOutput {
    /// Sets the duty cycle at the pin; `None` while there is no signal.
    pub fn drive(&mut self, duty: Option<f64>, now: Cycles) {
        self.level = self.level(now);
        self.at = now;
        self.target = duty.map_or(0.0, |duty| coupler_output(duty * FULL));
    }

    /// Returns the level at a given time, from 0 to 1.
    pub fn level(&self, now: Cycles) -> f64 {
        let seconds = (now - self.at).get() as f64 / Cycles::PER_SECOND.get() as f64;
        self.target + (self.level - self.target) * libm::exp(-seconds / CONSTANT)
    }

    /// Returns whether the level is constant.
    pub fn is_settled(&self, now: Cycles) -> bool {
        self.level(now) == self.target
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_optocoupler_follows_the_curve_of_the_table() {
        for (counts, expect) in [(0.0, 0.001), (2.0, 0.044), (6.5, 0.0765), (240.0, 0.970), (255.0, 1.0)] {
            assert!((coupler_output(counts) - expect).abs() < 1e-9, "{counts}: {}", coupler_output(counts));
        }
    }

    #[test]
    fn the_analog_output_follows_in_10_ms_and_settles() {
        let ms = |ms: i64| Cycles::new(ms * Cycles::PER_SECOND.get() / 1000);
        let mut output = AnalogOutput::default();
        output.drive(Some(1.0), ms(5));
        assert!((output.level(ms(15)) - (1.0 - libm::exp(-1.0))).abs() < 1e-12);
        assert!(!output.is_settled(ms(15)) && output.is_settled(ms(1000)));
        output.drive(None, ms(1000));
        assert!((output.level(ms(1010)) - libm::exp(-1.0)).abs() < 1e-12);
    }
}
