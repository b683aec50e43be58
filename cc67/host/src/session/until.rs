//! Conditions that end a run.

use crate::target::Target;
use kmotiondef::ThreadId;
use runtime::{Event, EventKind};

use super::{Session, Watch};

/// A condition on a board.
#[derive(Clone, Debug)]
pub enum Until {
    /// An expression is not 0.
    True(Watch),
    /// A thread is active, or no longer active.
    Active(ThreadId, bool),
    /// A console line that contains the text is printed, from now on.
    Printed(String),
    /// A trap stops a thread or the call-back, from now on.
    Trapped,
    /// One of several conditions is met.
    Any(Vec<Until>),
}

/// The events of a step that matter for conditions.
#[derive(Debug, Default)]
pub(super) struct StepEvents {
    lines: Vec<Vec<u8>>,
    is_trapped: bool,
}

impl Until {
    /// Returns whether a step of several ticks might miss the time at which it is met.
    pub(super) fn needs_every_tick(&self) -> bool {
        match self {
            Self::True(_) => true,
            Self::Active(..) | Self::Printed(_) | Self::Trapped => false,
            Self::Any(all) => all.iter().any(Self::needs_every_tick),
        }
    }

    /// Notes an event.
    pub(super) fn note_event(&self, event: &Event, heard: &mut StepEvents) {
        match &event.kind {
            EventKind::ConsoleLine(line) if self.listens() => heard.lines.push(line.clone()),
            EventKind::Trap(_) => heard.is_trapped = true,
            _ => {}
        }
    }

    /// Returns whether console lines matter.
    fn listens(&self) -> bool {
        match self {
            Self::Printed(_) => true,
            Self::True(_) | Self::Active(..) | Self::Trapped => false,
            Self::Any(all) => all.iter().any(Self::listens),
        }
    }

    /// Returns whether it is met.
    pub(super) fn is_met<T: Target>(&self, session: &Session<T>, heard: &StepEvents) -> bool {
        match self {
            Self::True(watch) => session.value(watch) != 0.0,
            Self::Active(thread, is_active) => session.thread(*thread).is_active() == *is_active,
            Self::Printed(text) => {
                heard.lines.iter().any(|line| String::from_utf8_lossy(line).contains(text.as_str()))
            }
            Self::Trapped => heard.is_trapped,
            Self::Any(all) => all.iter().any(|one| one.is_met(session, heard)),
        }
    }
}
