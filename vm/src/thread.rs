//! The seven user threads: their states, and starting, pausing, resuming, ending.
//!
//! States are data only; registers and call frames belong to the engine. A thread that is started is only marked as
//! fresh, and the machine gives it a new context in its next slice. So firmware functions can start and pause threads
//! while an engine runs one. Rules: threads-and-time.md section 2 of the specification.

use kmotiondef::{Cycles, GuestAddr, ThreadId};

use crate::scheduler::ThreadSet;
use crate::trap::Trap;
use crate::wake::Wake;

/// The progress of an active or paused thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Started, but without a slice yet: begins at its entry point.
    Fresh,
    /// In the middle of its program.
    Going,
    /// In a firmware call that waits.
    Waiting(Wake),
    /// Resumed without a program state to continue: takes its slices and does nothing, as the released firmware idles
    /// in this case.
    Idle,
}

/// The state of one thread.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ThreadState {
    /// Nothing is loaded.
    Empty,
    /// Loaded, not active: never started, or ended.
    Ready,
    /// Takes part in the rotation.
    Active(Progress),
    /// Out of the rotation; can continue where it was.
    Paused(Progress),
    /// Stopped by a trap; can be restarted.
    Faulted(Trap),
}

impl ThreadState {
    /// Reports whether the thread takes part in the rotation.
    #[must_use]
    pub const fn is_active(&self) -> bool {
        matches!(self, Self::Active(_))
    }

    /// Reports whether the thread is loaded and not started, or has ended.
    #[must_use]
    pub const fn is_ready(&self) -> bool {
        matches!(self, Self::Ready)
    }
}

/// A request for a thread in which no program is loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no program is loaded in that thread")]
pub struct NotLoaded;

#[derive(Clone, Debug, PartialEq, Eq)]
struct Slot {
    state: ThreadState,
    entry: GuestAddr,
    debt: Cycles,
}

/// The states of all user threads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Threads {
    slots: [Slot; ThreadId::MAX as usize],
    running: Option<ThreadId>,
    /// True if the running thread pauses when its slice is over.
    is_pausing: bool,
    /// The threads that have ever had a slice.
    ran: ThreadSet,
    /// The number of starts of each thread so far.
    starts: [u32; ThreadId::MAX as usize],
}

impl Default for Threads {
    fn default() -> Self {
        Self::new()
    }
}

impl Threads {
    /// Seven empty threads.
    #[must_use]
    pub fn new() -> Self {
        let empty = Slot { state: ThreadState::Empty, entry: GuestAddr::NULL, debt: Cycles::new(0) };
        Self {
            slots: std::array::from_fn(|_| empty.clone()),
            running: None,
            is_pausing: false,
            ran: ThreadSet::default(),
            starts: [0; ThreadId::MAX as usize],
        }
    }

    /// Makes `thread` ready to start at `entry`, whatever its current state.
    pub fn set_entry(&mut self, thread: ThreadId, entry: GuestAddr) {
        *self.slot(thread) = Slot { state: ThreadState::Ready, entry, debt: Cycles::new(0) };
    }

    /// Clears the program of `thread`.
    pub fn clear(&mut self, thread: ThreadId) {
        *self.slot(thread) = Slot { state: ThreadState::Empty, entry: GuestAddr::NULL, debt: Cycles::new(0) };
    }

    /// Starts `thread` at its entry point with a fresh stack, even if it is active or paused.
    ///
    /// A thread that starts itself continues unchanged.
    ///
    /// # Errors
    /// [`NotLoaded`] for an empty thread; nothing happens in that case.
    pub fn start(&mut self, thread: ThreadId) -> Result<(), NotLoaded> {
        if self.running == Some(thread) {
            return Ok(());
        }
        let slot = self.slot(thread);
        if slot.state == ThreadState::Empty {
            return Err(NotLoaded);
        }
        slot.state = ThreadState::Active(Progress::Fresh);
        slot.debt = Cycles::new(0);
        self.starts[thread.index()] = self.starts[thread.index()].wrapping_add(1);
        Ok(())
    }

    /// The number of starts of each thread so far.
    #[must_use]
    pub const fn starts(&self) -> [u32; ThreadId::MAX as usize] {
        self.starts
    }

    /// Takes `thread` out of the rotation, keeping where it was; no effect unless it is active.
    ///
    /// A thread that pauses itself continues to the end of its slice.
    pub fn pause(&mut self, thread: ThreadId) {
        if self.running == Some(thread) {
            self.is_pausing = true;
            return;
        }
        let slot = self.slot(thread);
        if let ThreadState::Active(progress) = slot.state {
            slot.state = ThreadState::Paused(progress);
        }
    }

    /// Lets a paused `thread` continue.
    ///
    /// A thread that never ran or has ended becomes active but executes nothing; on an active or faulted thread this
    /// has no effect.
    ///
    /// # Errors
    /// [`NotLoaded`] for an empty thread.
    pub fn resume(&mut self, thread: ThreadId) -> Result<(), NotLoaded> {
        if self.running == Some(thread) {
            self.is_pausing = false;
        }
        let slot = self.slot(thread);
        match slot.state {
            ThreadState::Empty => return Err(NotLoaded),
            ThreadState::Paused(progress) => slot.state = ThreadState::Active(progress),
            ThreadState::Ready => slot.state = ThreadState::Active(Progress::Idle),
            ThreadState::Active(_) | ThreadState::Faulted(_) => {}
        }
        Ok(())
    }

    /// The state of `thread`.
    #[must_use]
    pub fn state(&self, thread: ThreadId) -> &ThreadState {
        &self.slots[thread.index()].state
    }

    /// The entry point of `thread`; null if nothing is loaded.
    #[must_use]
    pub fn entry(&self, thread: ThreadId) -> GuestAddr {
        self.slots[thread.index()].entry
    }

    /// The threads that take part in the rotation.
    #[must_use]
    pub fn active(&self) -> ThreadSet {
        ThreadId::all().filter(|thread| self.state(*thread).is_active()).collect()
    }

    /// The thread whose slice is being executed now, if any.
    #[must_use]
    pub const fn running(&self) -> Option<ThreadId> {
        self.running
    }

    pub(crate) fn set_running(&mut self, running: Option<ThreadId>) {
        self.running = running;
        self.ran = running.map_or(self.ran, |thread| self.ran.with(thread));
    }

    /// Returns whether a thread has ever had a slice.
    #[must_use]
    pub fn has_run(&self, thread: ThreadId) -> bool {
        self.ran.contains(thread)
    }

    /// Returns, once, whether the thread whose slice is over has paused itself.
    pub(crate) const fn take_pausing(&mut self) -> bool {
        std::mem::replace(&mut self.is_pausing, false)
    }

    pub(crate) fn set_state(&mut self, thread: ThreadId, state: ThreadState) {
        self.slot(thread).state = state;
    }

    /// The overdraft of `thread` in its last slice, as a number not below zero.
    pub(crate) fn overdraft(&self, thread: ThreadId) -> Cycles {
        self.slots[thread.index()].debt
    }

    pub(crate) fn set_debt(&mut self, thread: ThreadId, debt: Cycles) {
        self.slot(thread).debt = debt;
    }

    fn slot(&mut self, thread: ThreadId) -> &mut Slot {
        &mut self.slots[thread.index()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Copy, Debug)]
    enum Action {
        Load,
        Start,
        Pause,
        Resume,
        Run,
        End,
    }
    use Action::{End, Load, Pause, Resume, Run, Start};

    /// The state of thread 2 after `actions`.
    fn after(actions: &[Action]) -> ThreadState {
        let thread = ThreadId::new(2).expect("2 is a thread");
        let mut threads = Threads::new();
        for action in actions {
            match action {
                Load => threads.set_entry(thread, GuestAddr::new(0x8006_0010)),
                Start => drop(threads.start(thread)),
                Pause => threads.pause(thread),
                Resume => drop(threads.resume(thread)),
                Run => threads.set_state(thread, ThreadState::Active(Progress::Going)),
                End => threads.set_state(thread, ThreadState::Ready),
            }
        }
        threads.state(thread).clone()
    }

    #[test]
    fn every_action_leads_where_the_specification_says() {
        let fresh = ThreadState::Active(Progress::Fresh);
        let cases: &[(&[Action], ThreadState)] = &[
            (&[], ThreadState::Empty),
            (&[Start], ThreadState::Empty),
            (&[Pause], ThreadState::Empty),
            (&[Resume], ThreadState::Empty),
            (&[Load], ThreadState::Ready),
            (&[Load, Pause], ThreadState::Ready),
            (&[Load, Resume], ThreadState::Active(Progress::Idle)),
            (&[Load, Start], fresh.clone()),
            (&[Load, Start, Run, Start], fresh.clone()),
            (&[Load, Start, Run, Pause, Start], fresh),
            (&[Load, Start, Run, Pause], ThreadState::Paused(Progress::Going)),
            (&[Load, Start, Run, Pause, Pause, Resume], ThreadState::Active(Progress::Going)),
            (&[Load, Start, Run, Resume], ThreadState::Active(Progress::Going)),
            (&[Load, Start, Run, End], ThreadState::Ready),
            (&[Load, Start, Run, End, Resume], ThreadState::Active(Progress::Idle)),
            (&[Load, Start, Run, Load], ThreadState::Ready),
        ];
        for (actions, expected) in cases {
            assert_eq!(after(actions), *expected, "{actions:?}");
        }
    }

    #[test]
    fn a_thread_does_not_start_itself_and_pauses_when_its_slice_is_over() {
        let thread = ThreadId::new(4).expect("4 is a thread");
        let mut threads = Threads::new();
        threads.set_entry(thread, GuestAddr::new(0x8008_0010));
        threads.set_state(thread, ThreadState::Active(Progress::Going));
        threads.set_running(Some(thread));
        assert_eq!(threads.start(thread), Ok(()));
        threads.pause(thread);
        assert_eq!(*threads.state(thread), ThreadState::Active(Progress::Going));
        assert!(threads.take_pausing() && !threads.take_pausing());
    }
}
