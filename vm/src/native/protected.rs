//! The blocks in which stores of compiled code must be checked: a coarse map of the protected program text.
//!
//! Each byte stands for a block of SDRAM and is not 0 if some of the block is protected. A store to such a block takes
//! the slow path, where guest memory checks it exactly.

use std::ops::Range;

use kmotiondef::map::SDRAM;

use crate::protection::Texts;

/// Bytes of one block, as a power of two: data begins at a multiple of 32, so that no block holds both text and data of a program.
pub(super) const BLOCK_BITS: u32 = 5;

/// One byte for each block of SDRAM.
pub(super) type Marks = [u8; (SDRAM.size >> BLOCK_BITS) as usize];

/// The map, and the ranges that it shows.
#[derive(Debug)]
pub(super) struct ProtectedBlocks {
    texts: Texts,
    marks: Box<Marks>,
    /// Number of changes of the ranges.
    version: u64,
}

impl Default for ProtectedBlocks {
    fn default() -> Self {
        // Through a vector, because an array of this size must not pass over the stack.
        let marks = vec![0; size_of::<Marks>()].into_boxed_slice();
        let Ok(marks) = marks.try_into() else { unreachable!("the vector has the length of the array") };
        Self { texts: Default::default(), marks, version: 0 }
    }
}

impl ProtectedBlocks {
    /// Makes the map show `texts`.
    #[inline]
    pub(super) fn follow(&mut self, texts: &Texts) {
        if self.texts != *texts {
            self.redraw(texts);
        }
    }

    #[cold]
    fn redraw(&mut self, texts: &Texts) {
        for text in &self.texts {
            self.marks[blocks(text)].fill(0);
        }
        for text in texts {
            self.marks[blocks(text)].fill(1);
        }
        self.texts.clone_from(texts);
        self.version += 1;
    }

    /// A number that is another one when the ranges have changed.
    pub(super) const fn version(&self) -> u64 {
        self.version
    }

    /// Offsets in SDRAM without program text: from the end of the program's own text on, and from the end of the last
    /// text.
    pub(super) fn windows(&self, own: u32) -> [Range<u32>; 2] {
        let texts = || self.texts.iter().filter(|text| text.start < text.end);
        let last = texts().map(|text| text.end).max().unwrap_or(SDRAM.base.get());
        [own, last].map(|start| {
            let next = texts().filter(|text| text.end > start).map(|text| text.start).min();
            let start = offset(start).next_multiple_of(8);
            start..offset(next.unwrap_or(u32::MAX)).max(start)
        })
    }

    /// The map.
    pub(super) const fn marks(&self) -> &Marks {
        &self.marks
    }
}

/// The offset of an address in SDRAM, or the end of SDRAM that is next to it.
fn offset(address: u32) -> u32 {
    address.clamp(SDRAM.base.get(), SDRAM.base.get() + SDRAM.size) - SDRAM.base.get()
}

/// The blocks of SDRAM that hold bytes of `text`.
fn blocks(text: &Range<u32>) -> Range<usize> {
    let (first, end) = (offset(text.start), offset(text.end));
    if first >= end {
        return 0..0;
    }
    (first >> BLOCK_BITS) as usize..end.div_ceil(1 << BLOCK_BITS) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_that_hold_text_are_marked() {
        let mut protected = ProtectedBlocks::default();
        let mut texts: Texts = Default::default();
        let block = 1 << BLOCK_BITS;
        texts[2] = 0x8007_0000..0x8007_0008 + block;
        protected.follow(&texts);
        let first = 0x7_0000 >> BLOCK_BITS;
        assert_eq!(protected.marks()[first - 1..first + 3], [0, 1, 1, 0]);
        texts[2] = 0x8007_0000 + block..0x8007_0008 + block;
        protected.follow(&texts);
        assert_eq!(protected.marks()[first - 1..first + 3], [0, 0, 1, 0]);
        texts[2] = 0..0xffff_ffff;
        protected.follow(&texts);
        assert_eq!(protected.marks().iter().filter(|mark| **mark == 0).count(), 0);
    }
}
