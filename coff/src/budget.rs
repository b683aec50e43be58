//! The work of reading an image, bounded by the size of the file.
//!
//! The parts of a file may lie anywhere, and many of them could claim the same bytes. The data copied to the image are
//! therefore charged against the length of the file, so that a small file cannot result in a large image.

use crate::error::{Error, ErrorKind, Part};

/// The maximum number of names, on average, that may share a byte of the string table.
pub(crate) const NAME_SHARING: u64 = 4;

/// Subtracts `amount` from the budget, or reports that `part` overlaps with earlier parts.
pub(crate) fn spend(left: &mut u64, amount: u64, at: u64, part: Part) -> Result<(), Error> {
    *left = left.checked_sub(amount).ok_or(Error { at, kind: ErrorKind::Overlap(part) })?;
    Ok(())
}

/// A length in bytes; a usize has at most 64 bits.
pub(crate) fn length(bytes: usize) -> u64 {
    u64::try_from(bytes).unwrap_or(u64::MAX)
}
