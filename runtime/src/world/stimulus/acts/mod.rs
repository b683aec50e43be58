//! What the actions are: of each the function that reads it from a statement, and the one that does it.

pub(super) mod computer;
pub(super) mod lines;
pub(super) mod mechanics;
pub(super) mod options;
