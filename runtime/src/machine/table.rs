//! The table that a load moves through a coupling that gives: a screw with backlash, a spring.
//!
//! The encoder is on the motor; switches, probes and analog sources see the table.

use std::f64::consts::TAU;

use kmotiondef::AxisId;
use kmotiondef::limits::TIMEBASE;

use super::description::{Spring, Travel};

/// The coupling between a load and its table.
#[derive(Clone, Copy, Debug)]
enum Coupling {
    /// Backlash in units of the axis.
    Play(f64),
    Spring(Spring),
}

/// The table of an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Table {
    pub(crate) axis: AxisId,
    coupling: Coupling,
    /// Its machine coordinate.
    pub(crate) place: f64,
    /// The velocity in units per second, for a table with a spring.
    velocity: f64,
}

impl Table {
    /// A distance in units that counts as zero for a spring.
    const REST: f64 = 1e-3;

    /// Returns the table of an axis, if its coupling gives. A spring has no backlash.
    pub(crate) fn new(axis: AxisId, travel: &Travel) -> Option<Self> {
        let play = (travel.backlash > 0.0).then_some(Coupling::Play(travel.backlash));
        let coupling = travel.spring.map(Coupling::Spring).or(play)?;
        Some(Self { axis, coupling, place: travel.start, velocity: 0.0 })
    }

    /// The load moves the table for a tick.
    pub(crate) fn follow(&mut self, load: f64) {
        match self.coupling {
            // The load pushes the table where the play ends.
            Coupling::Play(width) => self.place = self.place.clamp(load - width / 2.0, load + width / 2.0),
            Coupling::Spring(spring) => self.step_spring(load, spring),
        }
    }

    fn step_spring(&mut self, load: f64, Spring { hz, damping }: Spring) {
        let omega = TAU * hz;
        let pull = omega * omega * (load - self.place);
        self.velocity += TIMEBASE * (pull - 2.0 * damping * omega * self.velocity);
        self.place += TIMEBASE * self.velocity;
        if (load - self.place).abs() < Self::REST && self.velocity.abs() < Self::REST * omega {
            (self.place, self.velocity) = (load, 0.0);
        }
    }

    /// Returns whether it moves although its load may rest.
    pub(crate) fn is_moving(&self) -> bool {
        self.velocity != 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(travel: Travel) -> Table {
        Table::new(AxisId::new(0).expect("0 is an axis"), &travel).expect("its coupling gives")
    }

    #[test]
    fn backlash_is_taken_up_before_the_table_moves() {
        let mut table = table(Travel { backlash: 10.0, ..Travel::default() });
        for (load, place) in [(4.0, 0.0), (8.0, 3.0), (-4.0, 1.0)] {
            table.follow(load);
            assert_eq!(table.place, place, "{load}");
        }
    }

    #[test]
    fn a_spring_swings_with_its_frequency_and_comes_to_rest() {
        let mut table =
            table(Travel { spring: Some(Spring { hz: 20.0, damping: 0.05 }), ..Travel::default() });
        let places: Vec<f64> = (0..60_000)
            .map(|_| {
                table.follow(100.0);
                table.place
            })
            .collect();
        let peak = places.iter().copied().fold(0.0, f64::max);
        assert!((180.0..195.0).contains(&peak), "{peak}");
        // Half a period after the step, the table is at its peak.
        let at = places.iter().position(|place| *place == peak).expect("it is there") as f64 * TIMEBASE;
        assert!((at - 0.025).abs() < 1e-3, "{at}");
        assert!(!table.is_moving() && table.place == 100.0, "{}", table.place);
    }
}
