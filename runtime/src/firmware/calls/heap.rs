//! The firmware's heap: the SDRAM that the board's own buffers leave free.
//!
//! Sizes are rounded up to 8 bytes and each block has 8 bytes in front, as the board has it. Free blocks are in a list
//! ordered by size, and the first that is large enough is taken; of blocks of the same size, the one freed last.
//! Adjacent free blocks are merged. The list of blocks is kept here, so that programs cannot damage the heap.

use std::collections::BTreeMap;

use kmotiondef::GuestAddr;

/// First address after the board's own buffers.
const START: u32 = 0x80FE_0D68;
/// One past the last.
const END: u32 = 0x80FF_9020;
/// Bytes before each block.
const HEADER: u32 = 8;
/// The least size in bytes of a remainder that becomes a block: a header, and 8 bytes.
const LEAST: u32 = HEADER + 8;

/// A free block: its address after the header, and its size without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Free {
    block: u32,
    size: u32,
}

/// The blocks: allocated ones by address, with their sizes without header, and free ones.
#[derive(Clone, Debug)]
pub(crate) struct Heap {
    used: BTreeMap<u32, u32>,
    free: Vec<Free>,
}

impl Default for Heap {
    fn default() -> Self {
        let block = START + HEADER;
        Self { used: BTreeMap::new(), free: vec![Free { block, size: END - block }] }
    }
}

impl Heap {
    /// Allocates a block; `None` for a size of 0.
    pub(crate) fn allocate(&mut self, size: u32) -> Option<GuestAddr> {
        let size = block_size(size)?;
        let place = self.free.iter().position(|free| free.size >= size)?;
        let Free { block, size: found } = self.free.remove(place);
        self.use_part(block, found, size);
        Some(GuestAddr::new(block))
    }

    /// Takes a block at a multiple of `alignment`, which is a power of two.
    pub(crate) fn take_aligned(&mut self, size: u32, alignment: u32) -> Option<GuestAddr> {
        let size = block_size(size)?;
        let begin = |free: &Free| {
            let aligned = free.block.checked_next_multiple_of(alignment.max(8))?;
            // The rest before it becomes a separate block.
            let begin = if aligned == free.block || aligned - free.block >= LEAST {
                aligned
            } else {
                aligned.checked_add(alignment.max(LEAST))?
            };
            (begin.checked_add(size)? <= free.block + free.size).then_some(begin)
        };
        let place = self.free.iter().position(|free| begin(free).is_some())?;
        let begin = begin(self.free.get(place)?)?;
        let Free { block, size: found } = self.free.remove(place);
        if begin > block {
            self.insert(Free { block, size: begin - block - HEADER });
        }
        self.use_part(begin, found - (begin - block), size);
        Some(GuestAddr::new(begin))
    }

    /// Allocates a part of a free block; the rest remains free if it is large enough.
    fn use_part(&mut self, block: u32, found: u32, size: u32) {
        if found - size < LEAST {
            self.used.insert(block, found);
            return;
        }
        self.used.insert(block, size);
        self.insert(Free { block: block + size + HEADER, size: found - size - HEADER });
    }

    /// Inserts a free block before others of the same size.
    fn insert(&mut self, free: Free) {
        let place = self.free.iter().position(|other| other.size >= free.size);
        self.free.insert(place.unwrap_or(self.free.len()), free);
    }

    /// Takes the free block that a condition holds for out of the list.
    fn remove(&mut self, is_it: impl Fn(&Free) -> bool) -> Option<Free> {
        self.free.iter().position(is_it).map(|place| self.free.remove(place))
    }

    /// Changes the size of a block in place; returns whether that was possible.
    pub(crate) fn resize(&mut self, block: GuestAddr, size: u32) -> bool {
        let (Some(old), Some(size)) = (self.size(block), block_size(size)) else { return false };
        let block = block.get();
        if size <= old {
            if old - size >= LEAST {
                self.used.insert(block, size);
                self.release(Free { block: block + size + HEADER, size: old - size - HEADER });
            }
            return true;
        }
        let end = block + old + HEADER;
        let next = self.free.iter().find(|free| free.block == end).map_or(0, |free| free.size + HEADER);
        if old + next < size {
            return false;
        }
        self.remove(|free| free.block == end);
        self.use_part(block, old + next, size);
        true
    }

    /// The size of a block in use.
    pub(crate) fn size(&self, block: GuestAddr) -> Option<u32> {
        self.used.get(&block.get()).copied()
    }

    /// Frees a block; `false` if there is none at that address.
    pub(crate) fn free(&mut self, block: GuestAddr) -> bool {
        let Some(size) = self.used.remove(&block.get()) else { return false };
        self.release(Free { block: block.get(), size });
        true
    }

    /// Adds a free block, merged with adjacent free blocks.
    fn release(&mut self, mut released: Free) {
        let end = released.block + released.size + HEADER;
        if let Some(next) = self.remove(|free| free.block == end) {
            released.size += next.size + HEADER;
        }
        let begin = released.block - HEADER;
        if let Some(last) = self.remove(|free| free.block + free.size == begin) {
            released = Free { block: last.block, size: last.size + HEADER + released.size };
        }
        self.insert(released);
    }
}

/// The size of the block for a number of bytes; `None` for 0 bytes.
fn block_size(size: u32) -> Option<u32> {
    if size == 0 { None } else { size.checked_next_multiple_of(8) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_do_not_overlap_and_are_reused() {
        let mut heap = Heap::default();
        let first = heap.allocate(10).expect("room");
        let second = heap.take_aligned(100, 64).expect("room");
        assert_eq!(first.get(), START + HEADER);
        assert!(second.get() >= first.get() + 16 + HEADER && second.get().is_multiple_of(64));
        assert!(heap.free(first) && !heap.free(first));
        assert_eq!(heap.allocate(16), Some(first));
    }

    #[test]
    fn about_99000_bytes_are_free() {
        assert!(Heap::default().allocate(98_992).is_some());
        assert!(Heap::default().allocate(99_000).is_none());
        assert!(Heap::default().allocate(u32::MAX).is_none());
    }
}
