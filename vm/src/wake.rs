//! The events for which a thread can wait.

use kmotiondef::Cycles;

/// The event for which a thread waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wake {
    /// A time: the thread continues at that time if it falls into one of its slices, otherwise at the beginning of its
    /// next slice.
    At(Cycles),
    /// The beginning of its next slice.
    NextSlice,
    /// A condition that only the firmware can evaluate, at the beginning of each slice.
    Retry,
}
