//! Changes of bits in guest memory, in addition to those of the pins.

use chips::changes::Changes;
use kmotiondef::Cycles;
use kmotiondef::variables::{VIRTUAL_BITS, VIRTUAL_BITS_EX};
use vm::memory::GuestMemory;

use crate::views::TypedAccess;

/// The bits of the word of virtual bits that exist.
const VIRTUAL_MASK: u32 = 0xffff;
/// Words of extended virtual bits.
const EX_WORDS: usize = 32;

/// Keeps changes of pins and of virtual bits from now on.
pub(crate) fn switch_on(changes: &mut Changes, memory: &GuestMemory) {
    changes.switch_on((0..=EX_WORDS).map(|index| word(memory, index)).collect());
}

/// Finds the virtual bits that have changed.
pub(crate) fn scan_virtual_bits(changes: &mut Changes, memory: &GuestMemory, at: Cycles) {
    changes.scan_virtual_bits(|index| word(memory, index), at);
}

/// A word of virtual bits: the plain ones, then the extended ones.
fn word(memory: &GuestMemory, index: usize) -> u32 {
    match index.checked_sub(1) {
        None => memory.get(VIRTUAL_BITS) as u32 & VIRTUAL_MASK,
        Some(index) => memory.get(VIRTUAL_BITS_EX.element(index)) as u32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stores_to_virtual_bits_are_found_once() {
        let (mut memory, mut changes) = (GuestMemory::new(), Changes::default());
        switch_on(&mut changes, &memory);
        memory.set(VIRTUAL_BITS, 0x1_8001);
        memory.set(VIRTUAL_BITS_EX.element(1), 2);
        for expect in [vec![(48, true), (63, true), (1057, true)], vec![]] {
            scan_virtual_bits(&mut changes, &memory, Cycles::default());
            let told: Vec<_> = changes.take().iter().map(|change| (change.bit.get(), change.level)).collect();
            assert_eq!(told, expect);
        }
    }
}
