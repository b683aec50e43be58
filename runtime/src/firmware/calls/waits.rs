//! The calls for which each thread waits: those that it repeats while it does nothing else.
//!
//! A thread waits as long as it calls only functions that poll or let time pass. Any other call ends the wait.

use kmotiondef::firmware::FirmwareFunction;
use kmotiondef::function::PolledState;
use kmotiondef::{AxisId, Bit, CodeAddr, Cycles, ThreadId};
use vm::firmware::Caller;

/// Calls of a wait that are remembered.
const MOST: usize = 16;

/// The weight of polling anything other than the time; polling the time counts 1.
const MANY_LOOKS: u32 = 100;

/// A call that a thread repeats while it waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RepeatedCall {
    /// The state that it polls.
    pub(crate) polls: PolledState,
    /// Its first argument.
    pub(crate) argument: i32,
    /// The code address of the call.
    at: Option<CodeAddr>,
    /// When the thread called it first in this wait.
    pub(crate) since: Cycles,
}

impl RepeatedCall {
    fn is_as(&self, other: &Self) -> bool {
        (self.polls, self.argument, self.at) == (other.polls, other.argument, other.at)
    }
}

/// The wait of one thread.
#[derive(Clone, Debug, Default)]
pub(crate) struct Wait {
    /// When the thread last did anything other than poll.
    pub(crate) since: Cycles,
    /// When it last polled anything.
    pub(crate) looked: Cycles,
    /// How often the thread has polled, weighted by what it polls: polling the time counts least.
    pub(crate) looks: u32,
    /// True if it has read a bit since its last other action; and if it had before that.
    reads: bool,
    pub(crate) has_read: bool,
    /// The number of polls of motions, and of anything else except the time.
    pub(crate) motion_looks: u32,
    pub(crate) other_looks: u32,
    /// True if it has read a bit repeatedly since its last other action; and if it had before that.
    repeats: bool,
    pub(crate) has_repeated: bool,
    /// The bit that it has read last.
    pub(crate) last_bit: Option<Bit>,
    /// The calls since its beginning.
    pub(crate) calls: Vec<RepeatedCall>,
    /// The function of the firmware's table that it has called before its beginning.
    pub(crate) called: Option<&'static FirmwareFunction>,
}

/// The waits of all threads, and the axes that programs have commanded.
#[derive(Clone, Debug, Default)]
pub(crate) struct Waits {
    threads: [Wait; ThreadId::MAX as usize],
    /// A bit for each axis.
    axes: u16,
}

impl Waits {
    /// Notes that a thread polls something or lets time pass.
    pub(crate) fn record_poll(&mut self, thread: ThreadId, polls: PolledState, caller: &Caller<'_>) {
        let wait = &mut self.threads[thread.index()];
        wait.looked = caller.now();
        wait.looks = wait.looks.wrapping_add(if polls == PolledState::Time { 1 } else { MANY_LOOKS });
        let call =
            RepeatedCall { polls, argument: caller.arguments.get(0), at: caller.at, since: caller.now() };
        match polls {
            PolledState::Time => {}
            PolledState::Motion => wait.motion_looks = wait.motion_looks.wrapping_add(1),
            PolledState::Bit | PolledState::Path | PolledState::Recording | PolledState::Lock => {
                wait.other_looks = wait.other_looks.wrapping_add(1);
            }
        }
        let is_known = wait.calls.iter().any(|known| known.is_as(&call));
        if polls == PolledState::Bit {
            wait.last_bit = Bit::new(call.argument);
            wait.reads = true;
            wait.repeats |= is_known;
        }
        if wait.calls.len() < MOST && !is_known {
            wait.calls.push(call);
        }
    }

    /// Notes any other action of a thread: it calls a function of the firmware's table.
    pub(crate) fn act(&mut self, thread: ThreadId, now: Cycles, called: Option<&'static FirmwareFunction>) {
        let wait = &mut self.threads[thread.index()];
        wait.called = called;
        wait.calls.clear();
        wait.has_repeated = std::mem::take(&mut wait.repeats);
        wait.has_read = std::mem::take(&mut wait.reads);
        wait.since = now;
    }

    /// Notes that a program has commanded an axis.
    pub(crate) fn record_commanded(&mut self, axis: AxisId) {
        self.axes |= 1 << axis.index();
    }

    /// Returns whether a thread has called a function for the axis.
    pub(crate) fn has_touched(&self, axis: AxisId) -> bool {
        self.axes >> axis.index() & 1 != 0
    }

    /// Returns the wait of a thread.
    pub(crate) fn wait_of(&self, thread: ThreadId) -> &Wait {
        &self.threads[thread.index()]
    }
}
