//! Implementations of the actions: for each, the function that reads it from a statement and the one that executes it.

pub(super) mod computer;
pub(super) mod lines;
pub(super) mod manual;
pub(super) mod mechanics;
pub(super) mod options;
