//! Changes of bit levels, recorded with their times only while something reads them.
//!
//! Bits in guest memory can also be changed by plain stores; such changes are found by comparing words at the next
//! tick, which the owner of the memory passes in.

use kmotiondef::{Bit, Cycles};

/// The first virtual bit, and the first extended one.
const VIRTUAL: u16 = 48;
const VIRTUAL_EX: u16 = 1024;

/// A bit whose level has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitChange {
    /// The time, exact to the cycle; a plain store to a virtual bit counts at the next tick.
    pub at: Cycles,
    /// The bit.
    pub bit: Bit,
    /// Its new level.
    pub level: bool,
}

/// The changes since they were last taken.
#[derive(Clone, Debug, Default)]
pub struct Changes {
    is_on: bool,
    list: Vec<BitChange>,
    /// The number of changes that the devices have handled.
    seen: usize,
    /// The virtual bits as last reported, followed by the extended ones.
    words: Vec<u32>,
}

impl Changes {
    /// Returns whether changes are recorded.
    #[inline]
    #[must_use]
    pub fn is_on(&self) -> bool {
        self.is_on
    }

    /// Records changes from now on; `words` are the present virtual bits, followed by the extended ones.
    pub fn switch_on(&mut self, words: Vec<u32>) {
        self.is_on = true;
        self.words = words;
    }

    /// Records the level of a bit.
    pub fn record(&mut self, bit: Bit, level: bool, at: Cycles) {
        if self.is_on {
            self.list.push(BitChange { at, bit, level });
        }
    }

    /// Records the levels in `levels` for those of the first 64 bits that are in `mask`.
    pub fn note_mask(&mut self, mask: u64, levels: u64, at: Cycles) {
        self.note_bits(0, mask, levels, at);
    }

    fn note_bits(&mut self, first: u16, mut mask: u64, levels: u64, at: Cycles) {
        if !self.is_on {
            return;
        }
        while mask != 0 {
            let index = mask.trailing_zeros();
            mask &= mask - 1;
            if let Some(bit) = Bit::new(i32::from(first) + index as i32) {
                self.list.push(BitChange { at, bit, level: levels >> index & 1 != 0 });
            }
        }
    }

    /// Finds the virtual bits that have changed; `word` returns their present words by index.
    pub fn scan_virtual_bits(&mut self, word: impl Fn(usize) -> u32, at: Cycles) {
        if !self.is_on {
            return;
        }
        for index in 0..self.words.len() {
            let (now, before) = (word(index), self.words[index]);
            if now != before {
                self.words[index] = now;
                let first = if index == 0 { VIRTUAL } else { VIRTUAL_EX + 32 * (index as u16 - 1) };
                self.note_bits(first, u64::from(now ^ before), u64::from(now), at);
            }
        }
    }

    /// The next change that the devices have not handled yet.
    pub fn next_unseen(&mut self) -> Option<BitChange> {
        let change = self.list.get(self.seen).copied();
        self.seen += usize::from(change.is_some());
        change
    }

    /// All changes since the last call.
    pub fn take(&mut self) -> Vec<BitChange> {
        self.seen = 0;
        std::mem::take(&mut self.list)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(changes: &mut Changes) -> Vec<(u16, bool)> {
        changes.take().iter().map(|change| (change.bit.get(), change.level)).collect()
    }

    #[test]
    fn changes_are_not_kept_without_a_reader() {
        let mut changes = Changes::default();
        changes.note_mask(0b11, 0b01, Cycles::default());
        assert_eq!(told(&mut changes), []);
    }

    #[test]
    fn a_changed_word_of_virtual_bits_is_found_once() {
        let mut changes = Changes::default();
        changes.switch_on(vec![0; 3]);
        for expect in [vec![(48, true), (63, true), (1057, true)], vec![]] {
            changes.scan_virtual_bits(|index| [0x8001, 0, 2][index], Cycles::default());
            assert_eq!(told(&mut changes), expect);
        }
    }

    #[test]
    fn devices_see_each_change_once() {
        let mut changes = Changes::default();
        changes.switch_on(Vec::new());
        changes.note_mask(1 << 45, 0, Cycles::default());
        assert_eq!(changes.next_unseen().map(|change| change.bit.get()), Some(45));
        assert_eq!(changes.next_unseen(), None);
        assert_eq!(told(&mut changes), [(45, false)]);
    }
}
