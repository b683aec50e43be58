//! When a statement acts.

use std::fmt;

use kmotiondef::{Bit, Cycles, ThreadId};

use super::expectation::Expectation;

/// The change of a level that counts.
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
    /// Returns whether a change to this level counts.
    #[must_use]
    pub const fn fits(self, level: bool) -> bool {
        match self {
            Self::Rises => level,
            Self::Falls => !level,
            Self::Changes => true,
        }
    }
}

/// Something that happens on the board.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// A bit changes.
    Bit(Bit, Edge),
    /// A console line contains this text.
    Printed(String),
    /// The serial port has sent these characters.
    UartSent(Vec<u8>),
    /// A thread becomes active.
    Starts(ThreadId),
    /// A thread is no longer active.
    Ends(ThreadId),
    /// A value of an axis or of `persist.UserData` begins to satisfy a comparison.
    Becomes(Expectation),
}

/// When a statement acts.
#[derive(Clone, Debug, PartialEq)]
pub enum Trigger {
    /// At an instant.
    At(Cycles),
    /// Repeatedly.
    Every {
        /// Time from one to the next.
        period: Cycles,
        /// The first.
        from: Cycles,
        /// The last time, if there is one.
        until: Option<Cycles>,
        /// Only while this condition is met, if there is one.
        while_met: Option<Expectation>,
    },
    /// Some time after an event, each time or only the first time.
    When {
        /// The condition.
        condition: Condition,
        /// The delay after it.
        after: Cycles,
        /// True if only the first time counts.
        is_once: bool,
    },
    /// When the run is over.
    End,
    /// Checked in every tick from a condition on until it is met, at most for this long.
    Within {
        /// The time limit.
        limit: Cycles,
        /// The condition that starts it, each time.
        condition: Condition,
    },
    /// Checked in every tick, or in ticks in which another expectation is met.
    Always {
        /// The expectation that must also be met, if there is one.
        while_met: Option<Expectation>,
    },
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bit(bit, Edge::Rises) => write!(f, "bit {bit} rises"),
            Self::Bit(bit, Edge::Falls) => write!(f, "bit {bit} falls"),
            Self::Bit(bit, Edge::Changes) => write!(f, "bit {bit} changes"),
            Self::Printed(text) => write!(f, "printed \"{text}\""),
            Self::UartSent(bytes) => write!(f, "uart sends \"{}\"", bytes.escape_ascii()),
            Self::Starts(thread) => write!(f, "thread {thread} starts"),
            Self::Ends(thread) => write!(f, "thread {thread} ends"),
            Self::Becomes(expectation) => write!(f, "{expectation}"),
        }
    }
}

impl fmt::Display for Trigger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = |time: &Cycles| time.get() as f64 / Cycles::PER_SECOND.get() as f64;
        match self {
            Self::At(time) => write!(f, "at {} s", seconds(time)),
            Self::Every { period, .. } => write!(f, "every {} s", seconds(period)),
            Self::When { condition, is_once: true, .. } => write!(f, "once {condition}"),
            Self::When { condition, .. } => write!(f, "when {condition}"),
            Self::End => f.write_str("at end"),
            Self::Within { limit, condition } => write!(f, "within {} s of {condition}", seconds(limit)),
            Self::Always { .. } => f.write_str("always while …"),
        }
    }
}

impl Trigger {
    /// Returns the condition for which it waits, if it has one.
    pub(super) const fn condition(&self) -> Option<&Condition> {
        match self {
            Self::When { condition, .. } | Self::Within { condition, .. } => Some(condition),
            Self::At(_) | Self::Every { .. } | Self::End | Self::Always { .. } => None,
        }
    }
}
