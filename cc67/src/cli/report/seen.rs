//! Events of a run that determine the exit code.

use cc67_host::End;
use runtime::{Event, EventKind};

use crate::cli::io::exit::Exit;

/// The failures so far.
#[derive(Debug, Default)]
pub(crate) struct Failures {
    trapped: bool,
    unmet: bool,
}

impl Failures {
    /// Notes an event.
    pub(crate) fn note(&mut self, event: &Event) {
        self.trapped |= matches!(event.kind, EventKind::Trap(_) | EventKind::Halted(_));
        self.unmet |= matches!(event.kind, EventKind::Unmet(_));
    }

    /// The exit code and the reason.
    pub(crate) fn exit(&self, end: End, is_limited: bool) -> (Exit, &'static str) {
        match end {
            _ if self.trapped => (Exit::Trapped, "trapped"),
            _ if self.unmet => (Exit::Unmet, "unmet"),
            End::Limit if !is_limited => (Exit::StillRunning, "still running"),
            End::Limit => (Exit::Success, "limit"),
            End::AllEnded => (Exit::Success, "ended"),
            End::Interrupted => (Exit::Interrupted, "interrupted"),
        }
    }
}
