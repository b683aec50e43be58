//! A wire: an input follows an output, inverted or late if needed.

use std::collections::VecDeque;

use kmotiondef::{Bit, Cycles};

use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::machine::description;
use crate::world::attached::Settings;
use chips::changes::BitChange;

/// A wire.
#[derive(Clone, Debug)]
pub(crate) struct Wire {
    from: Bit,
    to: Bit,
    is_inverted: bool,
    delay: Cycles,
    /// Levels in transit, if the wire delays.
    late: VecDeque<(Cycles, bool)>,
    is_connected: bool,
}

impl Wire {
    /// The wire of a machine file.
    pub(crate) fn of(wire: &description::Wire) -> Self {
        let description::Wire { from, to, invert, delay_s } = *wire;
        Self::between(from, to, invert, delay_s)
    }

    fn between(from: Bit, to: Bit, is_inverted: bool, delay_s: f64) -> Self {
        let delay = libm::round(delay_s.max(0.0) * Cycles::PER_SECOND.get() as f64) as i64;
        Self { from, to, is_inverted, delay: Cycles::new(delay), late: VecDeque::new(), is_connected: false }
    }

    /// `from`, `to`, `invert`, `delay_s`.
    pub(crate) fn new(settings: &mut Settings<'_>) -> Result<Self, String> {
        let (from, to) = (settings.bit("from")?, settings.bit("to")?);
        let is_inverted = settings.flag("invert")?;
        Ok(Self::between(from, to, is_inverted, settings.number("delay_s", 0.0)?))
    }
}

impl AttachedDevice for Wire {
    fn drives(&self) -> Option<Bit> {
        Some(self.to)
    }

    fn edge(&mut self, change: BitChange, outside: &mut DeviceContext<'_>) {
        if change.bit != self.from {
            return;
        }
        self.is_connected = true;
        let level = change.level != self.is_inverted;
        if self.delay > Cycles::default() {
            self.late.push_back((change.at + self.delay, level));
        } else {
            outside.pins.drive(self.to, level, change.at);
        }
    }

    fn tick(&mut self, now: Cycles, outside: &mut DeviceContext<'_>) {
        if !self.is_connected {
            // It was not notified that its output is high.
            self.is_connected = true;
            outside.pins.drive(self.to, self.is_inverted, now);
        }
        while let Some(&(at, level)) = self.late.front()
            && at <= now
        {
            self.late.pop_front();
            outside.pins.drive(self.to, level, now);
        }
    }

    fn watches(&self, bit: Bit) -> bool {
        bit == self.from
    }

    fn is_settled(&self) -> bool {
        self.late.is_empty() && self.is_connected
    }
}

#[cfg(test)]
mod tests {
    use crate::world::outside::testing::Bench;

    #[test]
    fn an_input_follows_its_output_at_once() {
        let mut bench = Bench::new("wire from=8 to=12 invert=1");
        bench.tick(0);
        assert!(bench.level(12));
        bench.output(8, true, 5);
        assert!(!bench.level(12));
    }

    #[test]
    fn a_delayed_wire_follows_at_a_tick() {
        let mut bench = Bench::new("wire from=8 to=12 delay_s=0.001");
        bench.output(8, true, 5);
        for (us, expect) in [(900, false), (1080, true)] {
            bench.tick(us);
            assert_eq!(bench.level(12), expect, "{us}");
        }
    }
}
