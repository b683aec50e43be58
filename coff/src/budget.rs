//! The work that reading an image may cause, bounded by the size of the file.
//!
//! The parts of a file may lie anywhere, and the same bytes could be claimed by many of
//! them. What the image takes is therefore charged against the length of the file, so that
//! a small file cannot make a large image.

use crate::error::{Error, ErrorKind, Part};

/// Maximum number of names of an image, on average, that may share a byte of the string table.
pub(crate) const NAME_SHARING: u64 = 4;

/// Takes `amount` of what is left, or reports that `part` overlaps with what was taken before.
pub(crate) fn spend(left: &mut u64, amount: u64, at: u64, part: Part) -> Result<(), Error> {
    *left = left.checked_sub(amount).ok_or(Error { at, kind: ErrorKind::Overlap(part) })?;
    Ok(())
}

/// A length in bytes; a usize has at most 64 bits.
pub(crate) fn length(bytes: usize) -> u64 {
    u64::try_from(bytes).unwrap_or(u64::MAX)
}
