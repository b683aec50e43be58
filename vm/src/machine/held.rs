//! A tick that a debugger holds: it stops between two instructions of a program and is continued later.
//!
//! The rest of the board is stopped meanwhile, and the tick continues as if it had never been held.

use kmotiondef::{Cycles, GuestAddr, ThreadId};

use super::{Machine, Window};
use crate::engine::{ContextId, Engine};
use crate::firmware::Firmware;
use crate::thread::{Progress, ThreadState};
use crate::wake::Wake;

/// The point at which a tick is held.
#[derive(Clone, Copy, Debug)]
pub(super) enum HoldPoint {
    /// In the call-back.
    Callback {
        /// The address of the call-back function.
        address: GuestAddr,
        /// The instant at which it began.
        begin: Cycles,
        /// The rest of its budget, in cycles.
        left: Cycles,
    },
    /// In the slice of a thread.
    Slice {
        /// The thread.
        thread: ThreadId,
        /// The slice of the thread.
        window: Window,
        /// The rest of its budget, in cycles.
        left: Cycles,
        /// The wake that came true, if the thread is in a waiting call.
        woken: Option<Wake>,
    },
}

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// The context in whose code the tick is held, and the time; `None` between two ticks.
    #[must_use]
    pub fn held(&self) -> Option<(ContextId, Cycles)> {
        Some(match self.held? {
            HoldPoint::Callback { begin, left, .. } => {
                (ContextId::CALLBACK, begin + (super::CALLBACK_LIMIT - left))
            }
            HoldPoint::Slice { thread, window, left, .. } => (ContextId::of(thread), window.end - left),
        })
    }

    /// The work that the host has done for the board since power-up, in program cycles; a tick counts as a fixed
    /// amount. Skipped time is not work. Restoring a snapshot does not reset it.
    #[must_use]
    pub const fn work(&self) -> u64 {
        self.work
    }

    /// Continues the tick that was held.
    pub(super) fn go_on(&mut self, held: HoldPoint) {
        match held {
            HoldPoint::Callback { address, begin, left } => {
                if let Some(spent) = self.resume_callback(address, begin, left) {
                    self.after_callback(begin, spent);
                }
            }
            HoldPoint::Slice { thread, window, left, woken } => {
                // The thread may have been stopped or started meanwhile.
                let state = self.threads.state(thread);
                if matches!(state, ThreadState::Active(Progress::Going | Progress::Waiting(_))) {
                    self.run_thread(thread, window, left, woken);
                }
            }
        }
    }
}

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// Holds contexts after a change of these bytes (address and length each), and after changes of no others.
    pub fn set_watched(&mut self, ranges: &[(GuestAddr, u32)]) {
        self.engines.programs.set_watched(&self.memory, ranges);
    }

    /// Returns the index of a watched range that has changed since the last such report.
    pub fn take_change(&mut self) -> Option<usize> {
        self.engines.programs.take_change(&self.memory)
    }
}
