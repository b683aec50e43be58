//! The firmware's heap: the SDRAM that the board's own buffers leave free.
//!
//! Sizes are rounded up to 8 bytes and each block has 8 bytes in front, as the board has it; where the free blocks
//! are is kept here, so that no program can damage the heap.

use std::collections::BTreeMap;

use kmotiondef::GuestAddr;

/// First address after the board's own buffers.
const START: u32 = 0x80FE_0D68;
/// One past the last.
const END: u32 = 0x80FF_9020;
/// Bytes before each block.
const HEADER: u32 = 8;

/// The blocks in use: address of the block, and its size without header.
#[derive(Clone, Debug, Default)]
pub(crate) struct Heap {
    blocks: BTreeMap<u32, u32>,
}

impl Heap {
    /// Takes a block at a multiple of `alignment` in the first gap that is large enough.
    pub(crate) fn take(&mut self, size: u32, alignment: u32) -> Option<GuestAddr> {
        let size = size.max(1).checked_next_multiple_of(8)?;
        let alignment = alignment.max(8);
        let mut gap = START;
        let ends = self.blocks.iter().map(|(&block, &size)| (block - HEADER, block + size));
        for (end, next) in ends.chain([(END, END)]) {
            let block = gap.checked_add(HEADER)?.checked_next_multiple_of(alignment)?;
            if block.checked_add(size)? <= end {
                self.blocks.insert(block, size);
                return Some(GuestAddr::new(block));
            }
            gap = next;
        }
        None
    }

    /// The size of a block in use.
    pub(crate) fn size(&self, block: GuestAddr) -> Option<u32> {
        self.blocks.get(&block.get()).copied()
    }

    /// Gives a block back; `false` if there is none at that address.
    pub(crate) fn give(&mut self, block: GuestAddr) -> bool {
        self.blocks.remove(&block.get()).is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_do_not_overlap_and_are_reused() {
        let mut heap = Heap::default();
        let first = heap.take(10, 8).expect("room");
        let second = heap.take(100, 64).expect("room");
        assert_eq!(first.get(), START + HEADER);
        assert!(second.get() >= first.get() + 16 + HEADER && second.get().is_multiple_of(64));
        assert!(heap.give(first) && !heap.give(first));
        assert_eq!(heap.take(16, 8), Some(first));
    }

    #[test]
    fn about_99000_bytes_are_free() {
        assert!(Heap::default().take(98_992, 8).is_some());
        assert!(Heap::default().take(99_000, 8).is_none());
        assert!(Heap::default().take(u32::MAX, 8).is_none());
    }
}
