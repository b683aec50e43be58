//! PWM generators, which drive pins and the analog output of a KStep.
//!
//! A program that reads such a pin sees one level per tick; edges are reported only for watched pins.

use std::ops::Range;

use kmotiondef::{Bit, Cycles};

use super::{Fpga, PORT_BYTE, PRESCALE, PWM, PWM_MOVED, PWMS};
use crate::kstep::AnalogOutput;
use crate::pins::Pins;

/// The pin of generator 0, and its separate pin for a KStep.
const PWM_PIN: i32 = 26;
const PWM_MOVED_PIN: i32 = 44;
/// The PWM period in clocks, the processor cycles per clock, and the clocks per second.
const PWM_PERIOD: f64 = 256.0;
const CLOCK_CYCLES: i64 = 12;
const CLOCK: f64 = 50e6 / 3.0;

impl Fpga {
    /// The duty cycle of a PWM generator, from 0 to 1, and its frequency, if it is on.
    pub fn pwm(&self, generator: u32) -> Option<(f64, f64)> {
        let value = PWM + 2 * generator;
        (self.byte(value + 1) & 1 != 0).then(|| {
            let hz = CLOCK / PWM_PERIOD / (f64::from(self.byte(PRESCALE)) + 1.0);
            (f64::from(self.byte(value)) / (PWM_PERIOD - 1.0), hz)
        })
    }

    /// The duty cycle of generator 0 at the pin for a KStep, from 0 to 1.
    pub(super) fn moved_pwm(&self) -> Option<f64> {
        let (duty, _) = self.pwm(0)?;
        (self.bytes[PORT_BYTE] & PWM_MOVED != 0).then_some(duty)
    }

    /// The resulting analog output of a KStep.
    pub fn kstep_output(&self) -> &AnalogOutput {
        &self.kstep
    }

    /// Returns whether there are edges of watched pins to report in every tick.
    pub fn is_telling(&self, pins: &Pins) -> bool {
        let is_watched = |generator: u32| {
            let pin = Bit::new(PWM_PIN + generator as i32);
            let moved = Bit::new(PWM_MOVED_PIN).filter(|_| generator == 0);
            pin.into_iter().chain(moved).any(|bit| pins.is_watched(bit))
        };
        pins.watches_any()
            && (0..PWMS).any(|generator| self.pwm(generator).is_some() && is_watched(generator))
    }

    /// Reports the edges of watched pins up to a given time. All generators use one clock, which runs from power-up.
    pub fn tell_pwm(&mut self, pins: &mut Pins, now: Cycles) {
        let from = std::mem::replace(&mut self.told, now);
        if !pins.watches_any() {
            return;
        }
        let is_moved = self.bytes[PORT_BYTE] & PWM_MOVED != 0;
        for generator in 0..PWMS {
            let Some((duty, _)) = self.pwm(generator) else { continue };
            let clocks = PWM_PERIOD as i64 * (i64::from(self.byte(PRESCALE)) + 1);
            let period = clocks * CLOCK_CYCLES;
            let high = libm::round(duty * period as f64) as i64;
            let moved = (is_moved && generator == 0).then_some(PWM_MOVED_PIN);
            for pin in [Some(PWM_PIN + generator as i32), moved].into_iter().flatten() {
                if let Some(bit) = Bit::new(pin).filter(|bit| pins.is_watched(*bit)) {
                    tell_train(pins, bit, (period, high), from..now);
                }
            }
        }
    }

    /// Makes the generators that are on drive their pins; read as a level, they are high from half duty on.
    pub(super) fn drive_pwm_pins(&self, pins: &mut Pins, now: Cycles) {
        let mut drive = |pin: i32, level| {
            if let Some(bit) = Bit::new(pin) {
                pins.generate(bit, level, now);
            }
        };
        let level = |generator| self.pwm(generator).map(|(duty, _)| duty >= 0.5);
        for generator in 0..PWMS {
            drive(PWM_PIN + generator as i32, level(generator));
        }
        let is_moved = self.bytes[PORT_BYTE] & PWM_MOVED != 0;
        drive(PWM_MOVED_PIN, level(0).filter(|_| is_moved));
    }
}

/// Reports the edges of a pin that is high at the beginning of each period, for `high` cycles.
fn tell_train(pins: &mut Pins, bit: Bit, (period, high): (i64, i64), span: Range<Cycles>) {
    let mut at = span.start.get();
    while at <= span.end.get() {
        let phase = at.rem_euclid(period);
        pins.report_level(bit, phase < high, Cycles::new(at));
        at += if phase < high { high - phase } else { period - phase };
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::AccessSize;

    use super::*;
    use crate::fpga::tests::Bench;

    #[test]
    fn a_pwm_drives_its_pin_and_reports_its_rate() {
        let mut bench = Bench::default();
        let pins = [26, 44].map(|pin| Bit::new(pin).expect("a bit"));
        for (register, value) in [(0x2f, 65), (0xd0, 128), (0xd1, 1), (0xa0, 4)] {
            bench.write(register, AccessSize::Byte, value);
        }
        let (duty, hz) = bench.fpga.pwm(0).expect("on");
        assert_eq!((libm::round(duty * 1000.0), libm::round(hz)), (502.0, 986.0));
        assert_eq!(pins.map(|pin| bench.pins.is_output(pin) && bench.pins.level(pin)), [true, true]);
        bench.write(0xd0, AccessSize::Byte, 127);
        assert_eq!(pins.map(|pin| bench.pins.level(pin)), [false, false]);
        bench.write(0xd1, AccessSize::Byte, 0);
        assert_eq!(pins.map(|pin| bench.pins.is_output(pin)), [false, false]);
    }

    #[test]
    fn the_edges_of_a_watched_pwm_have_its_period_and_duty() {
        let mut bench = Bench::default();
        let bit = Bit::new(27).expect("a bit");
        bench.pins.changes.switch_on(Vec::new());
        bench.pins.watch(bit);
        // 65.1 kHz: 3072 cycles, high for a fifth of them.
        for (register, value) in [(0xd2, 51), (0xd3, 1)] {
            bench.write(register, AccessSize::Byte, value);
        }
        bench.now = Cycles::new(8000);
        bench.write(0xd3, AccessSize::Byte, 0);
        let told: Vec<_> =
            bench.pins.changes.take().iter().map(|change| (change.at.get(), change.level)).collect();
        let expect = [(0, true), (614, false), (3072, true), (3686, false), (6144, true), (6758, false)];
        assert_eq!(told, expect);
    }
}
