//! The events that a waiting thread waits for.

use kmotiondef::Cycles;

/// The event that a waiting thread waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wake {
    /// An instant: the thread continues then if it falls into one of its slices, else at the beginning of its next
    /// slice.
    At(Cycles),
    /// The beginning of its next slice.
    NextSlice,
    /// A condition that only the firmware can evaluate, at the beginning of each slice.
    Retry,
}
