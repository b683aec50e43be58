//! The state of the text files that a program has open.

/// The state of the board's files.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FileState {
    /// True if the last opening or reading failed or reached the end; `feof` returns it.
    pub(crate) has_failed: bool,
}
