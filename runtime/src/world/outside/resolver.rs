//! A resolver that the program excites: an output drives its coil, two analog inputs read its windings.
//!
//! While the current in the coil grows, the windings show the sine and cosine of the angle, and while it falls, their
//! negatives; a capacitor smooths these voltages. The angle is the position of the axis' load. Source: the manual's
//! resolver example.

use kmotiondef::{Axes, AxisId, Bit, Cycles};

use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::world::attached::Settings;
use chips::changes::BitChange;
use chips::kanalog::conversion;

/// Time constant of the smoothing in seconds.
const CONSTANT: f64 = 50e-6;

/// A resolver.
#[derive(Clone, Debug)]
pub(crate) struct Resolver {
    drive: Bit,
    sine: usize,
    cosine: usize,
    axis: AxisId,
    /// Units of the load per turn.
    turn: f64,
    /// Counts at the full amplitude.
    amplitude: f64,
    is_driven: bool,
    /// The field of the coil, −1 to 1.
    field: f64,
    at: Cycles,
}

impl Resolver {
    /// `drive`, `sine`, `cosine`, `axis`, `turn`, `amplitude`.
    pub(crate) fn new(settings: &mut Settings<'_>) -> Result<Self, String> {
        let axis = settings
            .optional("axis", "an axis from 0 to 7", |text| Axes::default().get(text.parse().ok()?))?;
        Ok(Self {
            drive: settings.bit("drive")?,
            sine: settings.adc("sine")?,
            cosine: settings.adc("cosine")?,
            axis: axis.or_else(|| AxisId::new(0)).ok_or("there is no axis")?,
            turn: settings.positive("turn", 1000.0)?,
            amplitude: settings.number("amplitude", 400.0)?,
            is_driven: false,
            field: 0.0,
            at: Cycles::default(),
        })
    }

    fn advance(&mut self, at: Cycles) {
        let seconds = (at - self.at).get() as f64 / Cycles::PER_SECOND.get() as f64;
        self.at = at;
        let target = if self.is_driven { 1.0 } else { -1.0 };
        self.field = target + (self.field - target) * libm::exp(-seconds / CONSTANT);
    }
}

impl AttachedDevice for Resolver {
    fn edge(&mut self, change: BitChange, _: &mut DeviceContext<'_>) {
        if change.bit == self.drive {
            self.advance(change.at);
            self.is_driven = change.level;
        }
    }

    fn watches(&self, bit: Bit) -> bool {
        bit == self.drive
    }

    fn tick(&mut self, now: Cycles, outside: &mut DeviceContext<'_>) {
        self.advance(now);
        let angle = outside.loads[self.axis].load / self.turn * std::f64::consts::TAU;
        let level = self.amplitude * self.field;
        outside.kanalog.drive(self.sine, conversion(level * libm::sin(angle)));
        outside.kanalog.drive(self.cosine, conversion(level * libm::cos(angle)));
    }

    fn is_settled(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::AxisId;

    use crate::world::outside::testing::Bench;

    #[test]
    fn windings_show_the_angle_of_the_load() {
        let mut bench = Bench::new("resolver drive=30 sine=0 cosine=1 amplitude=1000");
        bench.loads[AxisId::new(0).expect("an axis")].push(125.0);
        for (level, at, expect) in [(true, 1000, 707), (false, 2000, -707)] {
            bench.output(30, level, at);
            bench.tick(at + 500);
            assert_eq!((bench.adc(0), bench.adc(1)), (expect, expect));
        }
    }
}
