//! The surroundings of a modelled board, attached to the registers of one that runs a firmware file.

use boot::{ExternalHardware, TimerMatch};
use kmotiondef::{Cycles, Ticks};
use runtime::surroundings::{Instant, Surroundings};

/// Surroundings whose time begins when the programs start.
#[derive(Clone, Debug)]
pub(super) struct DelayedSurroundings {
    pub(super) surroundings: Surroundings,
    /// The cycle since power-up at which the time of the surroundings is 0.
    pub(super) origin: u64,
}

impl DelayedSurroundings {
    /// The time since they began.
    pub(super) fn since(&self, cycle: u64) -> Cycles {
        Cycles::new(i64::try_from(cycle.saturating_sub(self.origin)).unwrap_or(i64::MAX))
    }
}

impl ExternalHardware for DelayedSurroundings {
    fn read(&mut self, register: usize, is_byte: bool, now: u64) -> Option<u16> {
        let now = self.since(now);
        self.surroundings.read(register, is_byte, now)
    }

    fn write(&mut self, register: usize, is_byte: bool, value: u16, now: u64) {
        let now = self.since(now);
        self.surroundings.write(register, is_byte, value, now);
    }

    fn tick(&mut self, at_match: &mut TimerMatch<'_>) {
        let now = self.since(at_match.now);
        let ticks = u64::try_from(now.get() / Cycles::PER_TICK.get()).unwrap_or(0);
        self.surroundings.tick(&mut Instant {
            memory: at_match.memory,
            now,
            tick: Ticks::new(ticks),
            steps: at_match.steps,
            encoders: at_match.encoders,
            kstep: at_match.kstep,
        });
    }
}
