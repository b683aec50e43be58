//! The thread that had the processor in each of the last ticks, and the statements that were split: some rotations of all
//! threads.

use std::collections::VecDeque;

use cc67_host::{Capability, Session, Target};
use kmotiondef::{ThreadId, Ticks};
use runtime::Event;
use serde::Serialize;

/// Ticks that are shown.
const SHOWN: u64 = 56;

/// A tick as the bar of slices shows it.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ShownSlice {
    /// The number of the thread, 0 for the primary one.
    thread: u8,
    /// The file and line of the statement inside which the servo interrupt has stopped the thread.
    #[serde(skip_serializing_if = "Option::is_none")]
    split: Option<String>,
}

impl ShownSlice {
    /// The slice of a session's last tick.
    fn last<T: Target>(session: &Session<T>) -> Self {
        let thread = session.target().turn().number();
        let place = ThreadId::new(thread.into()).and_then(|thread| session.split_statement(thread));
        let split = place.and_then(|place| Some(format!("{}:{}", place.file, place.line?)));
        Self { thread, split }
    }
}

/// The slices of the last ticks, one after another without a gap.
#[derive(Debug, Default)]
pub(super) struct Turns {
    slices: VecDeque<ShownSlice>,
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
            self.slices.clear();
        }
        while session.tick() < tick {
            session.step_tick(events);
            self.slices.push_back(ShownSlice::last(session));
        }
        while self.slices.len() as u64 > SHOWN {
            self.slices.pop_front();
        }
        self.last = session.tick();
    }

    /// The slices until a tick; `None` if they are not known.
    pub(super) fn until(&self, tick: Ticks) -> Option<&VecDeque<ShownSlice>> {
        (tick == self.last).then_some(&self.slices)
    }
}
