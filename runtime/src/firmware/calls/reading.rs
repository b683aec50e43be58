//! What the board remembers of the text files that a program has open.

/// What the board remembers of its files.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Reading {
    /// Whether the last opening or reading failed or came to the end, which `feof` tells.
    pub(crate) has_failed: bool,
}
