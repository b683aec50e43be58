//! Threads that pause themselves until another resumes them.
//!
//! The thread tests a cell and pauses itself; the other thread stores the cell and resumes it. If that happens between
//! test and pause, the resume finds the thread active and does nothing, and the pause lasts forever.

use kmotiondef::{CodeAddr, ThreadId};

use super::{Actor, CLAIM_TIME, Races, context, index};
use crate::out::{Message, OtherPlace, Out};

/// A thread that has paused itself soon after it had loaded a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct PausedThread {
    cell: u32,
    actor: Actor,
}

/// The last call that resumed a thread, and the cell that its caller had stored before.
#[derive(Clone, Copy, Debug)]
pub(super) struct ResumeCall {
    cell: u32,
    by: usize,
    at: CodeAddr,
}

impl Races {
    /// A thread pauses itself.
    pub(crate) fn pauses(&mut self, actor: Actor, out: &mut Out) {
        let own = index(actor.thread);
        let tested = self.tracks[own].last_load.filter(|(_, then)| actor.now - *then < CLAIM_TIME);
        self.tracks[own].paused = tested.map(|(cell, _)| PausedThread { cell, actor });
        self.check_lost_wakeup(own, out);
    }

    /// A context resumes a thread.
    pub(crate) fn record_resume(&mut self, actor: Actor, resumed: ThreadId, out: &mut Out) {
        let (by, own) = (index(actor.thread), index(Some(resumed)));
        let stored = self.tracks[by].last_store.filter(|_| by != own);
        self.tracks[own].resumed = stored.map(|cell| ResumeCall { cell, by, at: actor.at });
        self.check_lost_wakeup(own, out);
    }

    /// Reports a pause and a call that resumes it if they are about the same cell.
    fn check_lost_wakeup(&mut self, own: usize, out: &mut Out) {
        let (Some(paused), Some(resumed)) = (self.tracks[own].paused, self.tracks[own].resumed) else {
            return;
        };
        if paused.cell == resumed.cell {
            let other = OtherPlace { thread: context(resumed.by), at: resumed.at };
            let cell = self.name_of(paused.cell, 4);
            self.report(out, paused.actor, resumed.at, Message::PauseOvertaken { other, cell });
        }
    }
}
