//! The bytes that hold program text: one bit for each instruction word of the program area.
//!
//! Stores check it on their fast path, so the ranges of the seven programs are kept as a map.

use std::ops::Range;

use kmotiondef::ThreadId;
use kmotiondef::map::{MemoryMap, ProgramSpaces};

/// The bytes covered by one bit.
const GRANULE: u32 = 8;

/// A range of addresses for each thread.
pub(crate) type Texts = [Range<u32>; ThreadId::MAX as usize];

/// The protected ranges and their map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Protection {
    texts: Texts,
    /// The area of programs.
    area: ProgramSpaces,
    map: Box<[u64]>,
    /// The addresses from the first to the last protected byte: most stores are outside and skip the map.
    hull: ByteRange,
}

/// The `size` bytes from `first` on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct ByteRange {
    first: u32,
    size: u32,
}

impl Default for Protection {
    fn default() -> Self {
        Self::of(MemoryMap::KFLOP.programs)
    }
}

impl Protection {
    /// Nothing is protected in an area of programs.
    pub(crate) fn of(area: ProgramSpaces) -> Self {
        let words = ((area.limit - area.base) / GRANULE).div_ceil(u64::BITS) as usize;
        let map = vec![0; words].into_boxed_slice();
        Self { texts: Default::default(), area, map, hull: ByteRange::default() }
    }

    /// Sets `thread`'s range; only whole granules inside the program area are protected.
    pub(crate) fn set(&mut self, thread: ThreadId, text: Range<u32>) {
        self.texts[thread.index()] = text;
        self.map.fill(0);
        let (mut lowest, mut highest) = (u32::MAX, 0);
        for text in &self.texts {
            let ProgramSpaces { base, limit, .. } = self.area;
            let first = text.start.clamp(base, limit).div_ceil(GRANULE);
            let end = text.end.clamp(base, limit) / GRANULE;
            if first < end {
                lowest = lowest.min(first * GRANULE);
                highest = highest.max(end * GRANULE);
            }
            for granule in first..end {
                let bit = granule - base / GRANULE;
                self.map[(bit / u64::BITS) as usize] |= 1 << (bit % u64::BITS);
            }
        }
        self.hull = ByteRange { first: lowest, size: highest.saturating_sub(lowest) };
    }

    /// The protected ranges, before they are cut to whole granules inside the program area.
    #[cfg(feature = "native")]
    pub(crate) const fn texts(&self) -> &Texts {
        &self.texts
    }

    /// Reports whether one of the `len` bytes from `address` on is protected.
    #[inline]
    pub(crate) fn covers(&self, address: u32, len: u32) -> bool {
        // Within one granule, as all aligned accesses are but a double at an odd word.
        if address % GRANULE + len <= GRANULE {
            return self.covers_aligned(address);
        }
        self.covers_long(address, len)
    }

    /// Reports whether bytes from `address` on within its granule are protected.
    #[inline]
    pub(crate) fn covers_aligned(&self, address: u32) -> bool {
        address.wrapping_sub(self.hull.first) < self.hull.size
            && self.is_set(address.wrapping_sub(self.area.base) / GRANULE)
    }

    #[cold]
    fn covers_long(&self, address: u32, len: u32) -> bool {
        let end = u64::from(address) + u64::from(len);
        self.texts.iter().any(|text| {
            let first = text.start.next_multiple_of(GRANULE);
            let last = text.end / GRANULE * GRANULE;
            first < last && u64::from(address) < u64::from(last) && u64::from(first) < end
        })
    }

    #[inline]
    fn is_set(&self, granule: u32) -> bool {
        match self.map.get((granule / u64::BITS) as usize) {
            Some(word) => word >> (granule % u64::BITS) & 1 != 0,
            None => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::map::PROGRAM_BASE;

    use super::*;

    #[test]
    fn only_whole_words_of_text_are_protected() {
        let mut protection = Protection::default();
        protection.set(ThreadId::new(1).expect("1 is a thread"), PROGRAM_BASE..PROGRAM_BASE + 20);
        let covered = |offset: u32, len| protection.covers(PROGRAM_BASE.wrapping_add(offset), len);
        assert!(covered(0, 1) && covered(15, 1) && covered(12, 8) && covered(8, 8));
        assert!(!covered(16, 4) && !covered(20, 8) && !covered(0_u32.wrapping_sub(8), 8));
        assert!(covered(0_u32.wrapping_sub(8), 9) && covered(0_u32.wrapping_sub(100), 1000));
        assert!(!covered(16, 5000));
    }

    #[test]
    fn a_new_range_releases_the_old_one() {
        let thread = ThreadId::new(2).expect("2 is a thread");
        let mut protection = Protection::default();
        protection.set(thread, PROGRAM_BASE..PROGRAM_BASE + 64);
        protection.set(thread, PROGRAM_BASE + 64..PROGRAM_BASE + 128);
        assert!(!protection.covers(PROGRAM_BASE, 4));
        assert!(protection.covers(PROGRAM_BASE + 64, 4));
        protection.set(thread, 0..0);
        assert!(!protection.covers(PROGRAM_BASE + 64, 4));
    }
}
