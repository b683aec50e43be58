//! The thread that had the processor in each of the last ticks: some rotations of all threads.

use std::collections::VecDeque;

use cc67_host::{Capability, Session, Target};
use kmotiondef::Ticks;
use runtime::Event;

/// Ticks that are shown.
const SHOWN: u64 = 56;

/// The threads of the last ticks, one after another without a gap.
#[derive(Debug, Default)]
pub(super) struct Turns {
    threads: VecDeque<u8>,
    /// The tick of the last one.
    last: Ticks,
}

impl Turns {
    /// Runs a session to a tick. If somebody looks, or it is not far, tick by tick at the end.
    pub(super) fn advance<T: Target>(
        &mut self,
        session: &mut Session<T>,
        tick: Ticks,
        looks: bool,
        events: &mut dyn FnMut(Event),
    ) {
        let is_near = session.tick().get() + 1 >= tick.get();
        // Which thread has had a tick is not known of a target whose time passes by itself.
        if !session.can(Capability::StopTime) || !looks && !is_near {
            return session.advance(tick, events);
        }
        let first = Ticks::new(tick.get().saturating_sub(SHOWN));
        session.advance(first, events);
        if session.tick() != self.last {
            self.threads.clear();
        }
        while session.tick() < tick {
            session.step_tick(events);
            self.threads.push_back(session.target().turn().number());
        }
        while self.threads.len() as u64 > SHOWN {
            self.threads.pop_front();
        }
        self.last = session.tick();
    }

    /// The numbers of the threads until a tick, 0 for the primary one; `None` if they are not known.
    pub(super) fn until(&self, tick: Ticks) -> Option<Vec<u8>> {
        (tick == self.last).then(|| self.threads.iter().copied().collect())
    }
}
