//! The thread that had the processor in each of the last ticks, and the statements interrupted by the servo: some
//! rotations of all threads.

use std::collections::VecDeque;

use cc67_host::{Capability, Session, Target};
use kmotiondef::{ThreadId, Ticks};
use runtime::Event;
use serde::Serialize;

/// The number of ticks shown.
const SHOWN: u64 = 56;

/// A tick in the bar of slices.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ShownSlice {
    /// The number of the thread, 0 for the primary one.
    thread: u8,
    /// The file and line of the statement within which the servo interrupt stopped the thread.
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

/// The slices of the last ticks, without gaps.
#[derive(Debug, Default)]
pub(super) struct SliceHistory {
    slices: VecDeque<ShownSlice>,
    /// The tick of the last slice.
    last: Ticks,
}

impl SliceHistory {
    /// Runs a session to a tick. If a page is watching, or the distance is short, the end of the run is executed tick
    /// by tick.
    pub(super) fn advance<T: Target>(
        &mut self,
        session: &mut Session<T>,
        tick: Ticks,
        looks: bool,
        events: &mut dyn FnMut(Event),
    ) {
        let is_near = session.tick().get() + 1 >= tick.get();
        // For a target whose time passes by itself, the thread of a tick is unknown.
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
