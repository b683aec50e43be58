//! What a waiting thread waits for.

use kmotiondef::Cycles;

/// What a waiting thread waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wake {
    /// A point in time: the thread goes on at that instant if it falls into one of its slices, else at the
    /// beginning of its next slice.
    At(Cycles),
    /// The beginning of its next slice.
    NextSlice,
    /// Something that only the firmware can judge; it is asked again at the beginning of each slice.
    Retry,
}
