//! When a statement acts.

use kmotiondef::{Bit, Cycles, ThreadId};

/// Which change of a level counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// From 0 to 1.
    Rises,
    /// From 1 to 0.
    Falls,
    /// Both.
    Changes,
}

impl Edge {
    /// Whether a change to this level counts.
    pub(crate) fn fits(self, level: bool) -> bool {
        match self {
            Self::Rises => level,
            Self::Falls => !level,
            Self::Changes => true,
        }
    }
}

/// Something that happens on the board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Condition {
    /// A bit changes.
    Bit(Bit, Edge),
    /// A console line contains this text.
    Printed(String),
    /// A thread becomes active.
    Starts(ThreadId),
    /// A thread is active no longer.
    Ends(ThreadId),
}

/// When a statement acts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Trigger {
    /// At an instant.
    At(Cycles),
    /// Again and again.
    Every {
        /// Time from one to the next.
        period: Cycles,
        /// The first.
        from: Cycles,
        /// The last, if there is one.
        until: Option<Cycles>,
    },
    /// Some time after something happens, each time or only the first time.
    When {
        /// What happens.
        condition: Condition,
        /// How long after it.
        after: Cycles,
        /// Whether only the first time counts.
        is_once: bool,
    },
    /// When the run is over.
    End,
}
