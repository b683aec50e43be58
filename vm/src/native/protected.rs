//! Where a store of compiled code must be checked: a coarse map of the protected program text.
//!
//! One byte stands for a block of SDRAM and is not 0 if some of the block is protected. A store
//! to such a block goes the slow way, where guest memory decides exactly.

use std::ops::Range;

use kmotiondef::map::SDRAM;

use crate::protection::Texts;

/// Bytes of one block, as a power of two.
pub(super) const BLOCK_BITS: u32 = 6;

/// One byte for each block of SDRAM.
pub(super) type Marks = [u8; (SDRAM.size >> BLOCK_BITS) as usize];

/// The map, and the ranges that it shows.
#[derive(Debug)]
pub(super) struct ProtectedBlocks {
    texts: Texts,
    marks: Box<Marks>,
}

impl Default for ProtectedBlocks {
    fn default() -> Self {
        // Through a vector, because an array of this size must not pass over the stack.
        let marks = vec![0; size_of::<Marks>()].into_boxed_slice();
        let Ok(marks) = marks.try_into() else { unreachable!("the vector has the length of the array") };
        Self { texts: Default::default(), marks }
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
    }

    /// The map.
    pub(super) const fn marks(&self) -> &Marks {
        &self.marks
    }
}

/// The blocks of SDRAM that hold bytes of `text`.
fn blocks(text: &Range<u32>) -> Range<usize> {
    let offset =
        |address: u32| address.clamp(SDRAM.base.get(), SDRAM.base.get() + SDRAM.size) - SDRAM.base.get();
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
        texts[2] = 0x8007_0000..0x8007_0048;
        protected.follow(&texts);
        let first = 0x7_0000 >> BLOCK_BITS;
        assert_eq!(protected.marks()[first - 1..first + 3], [0, 1, 1, 0]);
        texts[2] = 0x8007_0040..0x8007_0048;
        protected.follow(&texts);
        assert_eq!(protected.marks()[first - 1..first + 3], [0, 0, 1, 0]);
        texts[2] = 0..0xffff_ffff;
        protected.follow(&texts);
        assert_eq!(protected.marks().iter().filter(|mark| **mark == 0).count(), 0);
    }
}
