//! Lines of history that were left: an action in the past on a page starts a new line, and the previous one is kept.

use cc67_host::{Branch, BranchId, Session, Target, Timeline};
use serde_json::{Value, json};

use super::{ViewState, log_message};

/// The maximum number of lines that are kept; beyond it, the oldest is dropped.
pub(super) const MOST: usize = 8;

impl<T: Target> ViewState<T> {
    /// The lines that were left, as a message to pages.
    pub(super) fn branches(&self) -> Value {
        let describe = |branch: &Branch<T>| json!({ "id": branch.id, "from": branch.from.get(), "end": branch.end.get() });
        let branches = self.timeline.as_ref().map_or(&[][..], Timeline::branches);
        json!({ "kind": "branches", "branches": branches.iter().map(describe).collect::<Vec<_>>() })
    }

    /// Keeps the log of a line that was just left, and drops the logs of lines that no longer exist.
    pub(super) fn note_branches(&mut self) {
        let branches = self.timeline.as_ref().map_or(&[][..], Timeline::branches);
        for branch in branches {
            if !self.log.left.contains_key(&branch.id) {
                self.log.left.insert(branch.id, self.log.in_order());
            }
        }
        self.log.left.retain(|id, _| branches.iter().any(|branch| branch.id == *id));
        self.broadcast(&self.branches());
    }

    /// Shows the end of a line that was left; the present line is kept as a branch in turn.
    pub(super) fn take_branch(&mut self, session: &mut Session<T>, id: BranchId) -> Result<(), String> {
        let gone = || "this run is not kept any more".to_owned();
        let timeline = self.timeline.as_mut().ok_or_else(gone)?;
        let entries = self.log.left.get(&id).cloned().ok_or_else(gone)?;
        self.clock.pause();
        let common = timeline.common_with(id).ok_or_else(gone)?;
        // The samples of re-executed ticks are added as they are executed.
        let rows = self.samples.truncate(common);
        timeline.take_branch(session, id).map_err(|error| error.to_string())?;
        self.note_branches();
        self.log.replace(entries);
        self.pages.values_mut().for_each(|page| page.next_row = page.next_row.min(rows));
        self.broadcast(&json!({ "kind": "cut", "tick": common.get() }));
        self.broadcast(&log_message(&self.log.entries_after(common)));
        Ok(())
    }

    /// Drops a line that was left.
    pub(super) fn forget_branch(&mut self, id: BranchId) -> Result<(), String> {
        let is_gone = self.timeline.as_mut().is_some_and(|timeline| timeline.forget_branch(id));
        self.note_branches();
        is_gone.then_some(()).ok_or_else(|| "this run is not kept any more".to_owned())
    }
}
