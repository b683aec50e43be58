//! The locks that threads hold, each with the call that took it.

use kmotiondef::{CodeAddr, GuestAddr, ThreadId};

/// A lock that a thread holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct HeldLock {
    pub(crate) thread: ThreadId,
    /// Its word.
    pub(crate) lock: GuestAddr,
    /// The call that took it.
    pub(crate) at: Option<CodeAddr>,
}

/// All of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Locks(Vec<HeldLock>);

impl Locks {
    /// A thread takes a lock.
    pub(crate) fn record_taken(&mut self, held: HeldLock) {
        self.record_freed(held.lock);
        self.0.push(held);
    }

    /// Notes that a lock is free again.
    pub(crate) fn record_freed(&mut self, lock: GuestAddr) {
        self.0.retain(|held| held.lock != lock);
    }

    /// The locks that are held.
    pub(crate) fn held(&self) -> &[HeldLock] {
        &self.0
    }
}
