//! The known state of the board's threads: their programs, and their activity in the last status record.

use std::sync::Arc;

use kmotiondef::ThreadId;
use runtime::debug::DebugInfo;
use vm::thread::{Progress, ThreadState};

/// A thread.
#[derive(Debug)]
struct BoardThread {
    state: ThreadState,
    /// Names and lines of the loaded program.
    program: Option<Arc<DebugInfo>>,
    /// True if the thread was active before the connection, and has not ended since.
    is_foreign: bool,
    /// True if it was paused by this session.
    is_paused: bool,
}

/// The threads of a board.
#[derive(Debug)]
pub(crate) struct BoardThreads {
    all: [BoardThread; ThreadId::MAX as usize],
    /// Threads that start with the first call that lets time pass.
    waiting: Vec<ThreadId>,
}

impl BoardThreads {
    /// Creates the table; nothing is known about any thread.
    pub(crate) fn new() -> Self {
        let empty =
            |_| BoardThread { state: ThreadState::Empty, program: None, is_foreign: false, is_paused: false };
        Self { all: std::array::from_fn(empty), waiting: Vec::new() }
    }

    /// The state of a thread.
    pub(crate) const fn state(&self, thread: ThreadId) -> &ThreadState {
        &self.all[thread.index()].state
    }

    /// The program that was loaded into a thread.
    pub(crate) fn program(&self, thread: ThreadId) -> Option<&DebugInfo> {
        self.all[thread.index()].program.as_deref()
    }

    /// Keeps threads that start when time passes.
    pub(crate) fn keep_waiting(&mut self, threads: Vec<ThreadId>) {
        self.waiting = threads;
    }

    /// Takes the threads that start when time passes.
    pub(crate) fn take_waiting(&mut self) -> Vec<ThreadId> {
        std::mem::take(&mut self.waiting)
    }

    /// Returns whether a thread is active or waits to start that was started by this session.
    pub(crate) fn has_own_active(&self) -> bool {
        !self.waiting.is_empty()
            || self.all.iter().any(|thread| thread.state.is_active() && !thread.is_foreign)
    }

    /// The inactive threads without a program of this session.
    pub(crate) fn free(&self) -> Vec<ThreadId> {
        let is_free = |thread: &ThreadId| self.program(*thread).is_none() && !self.state(*thread).is_active();
        ThreadId::all().filter(is_free).collect()
    }

    /// Notes that the presently active threads were not started by this session.
    pub(crate) fn note_foreign(&mut self) {
        for thread in &mut self.all {
            thread.is_foreign = thread.state.is_active();
        }
    }

    /// Notes whether a thread is active.
    pub(crate) fn note(&mut self, thread: ThreadId, is_active: bool) {
        let thread = &mut self.all[thread.index()];
        thread.state = match is_active {
            true => ThreadState::Active(Progress::Going),
            false if thread.is_paused => ThreadState::Paused(Progress::Going),
            false if thread.program.is_some() => ThreadState::Ready,
            false => ThreadState::Empty,
        };
        thread.is_foreign = thread.is_foreign && is_active;
    }

    /// Notes that a program was loaded.
    pub(crate) fn note_loaded(&mut self, thread: ThreadId, program: DebugInfo) {
        self.all[thread.index()].program = Some(Arc::new(program));
        self.note_stopped(thread);
    }

    /// Notes that a thread was started by this session.
    pub(crate) fn note_started(&mut self, thread: ThreadId) {
        let known = &mut self.all[thread.index()];
        (known.is_foreign, known.is_paused) = (false, false);
        self.note(thread, true);
    }

    /// Notes that a thread runs one of cc67's own programs, for whose end nobody waits.
    pub(crate) fn note_served(&mut self, thread: ThreadId) {
        self.note_started(thread);
        self.all[thread.index()].is_foreign = true;
    }

    /// Notes that a thread was stopped.
    pub(crate) fn note_stopped(&mut self, thread: ThreadId) {
        self.all[thread.index()].is_paused = false;
        self.note(thread, false);
    }

    /// Notes that a thread was paused or resumed.
    pub(crate) fn note_paused(&mut self, thread: ThreadId, is_paused: bool) {
        self.all[thread.index()].is_paused = is_paused;
        self.note(thread, !is_paused);
    }
}
