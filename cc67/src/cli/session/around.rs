//! The surroundings of a modelled board, attached to the registers of one that runs a firmware file.

use std::any::Any;

use boot::{Around, AtMatch};
use kmotiondef::{Cycles, Ticks};
use runtime::surroundings::{Instant, Surroundings};

/// Surroundings whose time begins when the programs start.
#[derive(Clone, Debug)]
pub(super) struct Attached {
    /// What is around the board.
    pub(super) surroundings: Surroundings,
    /// The cycle, since power-up, that they call 0.
    pub(super) origin: u64,
}

impl Attached {
    /// The time since they began.
    pub(super) fn since(&self, cycle: u64) -> Cycles {
        Cycles::new(i64::try_from(cycle.saturating_sub(self.origin)).unwrap_or(i64::MAX))
    }
}

impl Around for Attached {
    fn read(&mut self, register: usize, is_byte: bool, now: u64) -> Option<u16> {
        let now = self.since(now);
        self.surroundings.read(register, is_byte, now)
    }

    fn write(&mut self, register: usize, is_byte: bool, value: u16, now: u64) {
        let now = self.since(now);
        self.surroundings.write(register, is_byte, value, now);
    }

    fn tick(&mut self, turn: &mut AtMatch<'_>) {
        let now = self.since(turn.now);
        let ticks = u64::try_from(now.get() / Cycles::PER_TICK.get()).unwrap_or(0);
        self.surroundings.tick(&mut Instant {
            memory: turn.memory,
            now,
            tick: Ticks::new(ticks),
            steps: turn.steps,
            encoders: turn.encoders,
            kstep: turn.kstep,
        });
    }

    fn copied(&self) -> Box<dyn Around> {
        Box::new(self.clone())
    }

    fn as_any(&mut self) -> &mut dyn Any {
        self
    }
}
