//! An encoder whose two phases are outputs of the board: signals from a program or a step generator there turn the load
//! of an axis, so that the axis' encoder counts them.
//!
//! Each edge is a count, four in a period. A change of both phases at once is an error, as for the real counter.

use kmotiondef::{Axes, AxisId, Bit};

use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::world::attached::Settings;
use chips::changes::BitChange;

/// The phases and the axis.
#[derive(Clone, Debug)]
pub(crate) struct Quadrature {
    a: Bit,
    b: Bit,
    axis: AxisId,
    /// Units of the load for a count.
    units: f64,
    levels: [bool; 2],
}

impl Quadrature {
    /// `a`, `b`, `axis`, `units`.
    pub(crate) fn new(settings: &mut Settings<'_>) -> Result<Self, String> {
        let (a, b) = (settings.bit("a")?, settings.bit("b")?);
        let what = format!("an axis from 0 to {}", Axes::default().last());
        let axis = settings.optional("axis", &what, |text| Axes::default().get(text.parse().ok()?))?;
        let axis = axis.or_else(|| AxisId::new(0)).ok_or("there is no axis")?;
        Ok(Self { a, b, axis, units: settings.number("units", 1.0)?, levels: [false; 2] })
    }
}

impl AttachedDevice for Quadrature {
    fn edge(&mut self, change: BitChange, outside: &mut DeviceContext<'_>) {
        let [a, b] = self.levels;
        let forward = if change.bit == self.a {
            self.levels[0] = change.level;
            change.level != b
        } else if change.bit == self.b {
            self.levels[1] = change.level;
            change.level == a
        } else {
            return;
        };
        if self.levels != [a, b] {
            outside.loads.push(self.axis, if forward { self.units } else { -self.units });
        }
    }

    fn watches(&self, bit: Bit) -> bool {
        bit == self.a || bit == self.b
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::AxisId;

    use crate::world::outside::testing::Bench;

    #[test]
    fn each_edge_counts_and_the_order_gives_the_direction() {
        let mut bench = Bench::new("quadrature a=8 b=9 axis=2");
        for (bit, level, expect) in [
            (8, true, 1.0),
            (9, true, 2.0),
            (8, false, 3.0),
            (9, false, 4.0),
            (9, true, 3.0),
            (8, true, 2.0),
            (9, false, 1.0),
            (8, false, 0.0),
        ] {
            bench.output(bit, level, 0);
            assert_eq!(bench.loads[AxisId::new(2).expect("an axis")].load, expect, "{bit} {level}");
        }
    }
}
