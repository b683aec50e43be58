//! A tick that a debugger holds: it stops between two instructions of a program and is continued later.
//!
//! Nothing else of the board moves meanwhile, and the tick continues as if it had never been held.

use kmotiondef::{Cycles, GuestAddr, ThreadId};

use super::{Machine, Window};
use crate::engine::{ContextId, Engine};
use crate::firmware::Firmware;
use crate::thread::{Progress, ThreadState};
use crate::wake::Wake;

/// The point in a tick at which it is held.
#[derive(Clone, Copy, Debug)]
pub(super) enum Held {
    /// In the call-back.
    Callback {
        /// Its function.
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
        /// Its slice.
        window: Window,
        /// The rest of its budget, in cycles.
        left: Cycles,
        /// The wake that came true, if the thread is in a waiting call.
        woken: Option<Wake>,
    },
}

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// The context in whose code the tick is held, and the instant; `None` between two ticks.
    #[must_use]
    pub fn held(&self) -> Option<(ContextId, Cycles)> {
        Some(match self.held? {
            Held::Callback { begin, left, .. } => {
                (ContextId::CALLBACK, begin + (super::CALLBACK_LIMIT - left))
            }
            Held::Slice { thread, window, left, .. } => (ContextId::of(thread), window.end - left),
        })
    }

    /// The work that a computer has done for the board since power-up, in cycles of programs; a tick counts as some of
    /// them. Skipped time is not work. No snapshot sets it back.
    #[must_use]
    pub const fn work(&self) -> u64 {
        self.work
    }

    /// Continues the tick that was held.
    pub(super) fn go_on(&mut self, held: Held) {
        match held {
            Held::Callback { address, begin, left } => {
                if let Some(spent) = self.resume_callback(address, begin, left) {
                    self.after_callback(begin, spent);
                }
            }
            Held::Slice { thread, window, left, woken } => {
                // Somebody may have stopped or started the thread meanwhile.
                let state = self.threads.state(thread);
                if matches!(state, ThreadState::Active(Progress::Going | Progress::Waiting(_))) {
                    self.run_thread(thread, window, left, woken);
                }
            }
        }
    }
}

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// Holds contexts after these bytes, addresses and how many, are not what they are now; and after no others.
    pub fn set_watched(&mut self, ranges: &[(GuestAddr, u32)]) {
        self.engines.programs.set_watched(&self.memory, ranges);
    }

    /// Returns the index of a watched range that has changed since the last such report.
    pub fn take_change(&mut self) -> Option<usize> {
        self.engines.programs.take_change(&self.memory)
    }
}
