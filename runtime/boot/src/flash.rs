//! The flash chip, whose bytes are in guest memory.

use chips::flash::{BLOCK, Change, Chip, ERASED};
use kmotiondef::map::FLASH;
use kmotiondef::{Cycles, GuestAddr};
use vm::memory::GuestMemory;

/// The half word that the chip returns at an offset.
pub(super) fn read(chip: &mut Chip, offset: u32, memory: &GuestMemory, now: Cycles) -> u32 {
    chip.read(offset, memory.peek(flash_address(offset)), now).into()
}

/// Handles a half word written by the firmware.
pub(super) fn write(chip: &mut Chip, offset: u32, value: u16, memory: &mut GuestMemory, now: Cycles) {
    match chip.write(offset, value, now) {
        Some(Change::Program { offset, mask }) => {
            let old: u16 = memory.peek(flash_address(offset));
            memory.poke(flash_address(offset), old & mask);
        }
        Some(Change::Erase { offset }) => {
            let erased = memory.poke_bytes(flash_address(offset), &[ERASED; BLOCK as usize]);
            debug_assert!(erased.is_ok(), "a block is inside the flash");
        }
        None => {}
    }
}

/// An address in the flash.
const fn flash_address(offset: u32) -> GuestAddr {
    FLASH.base.offset(offset & (FLASH.size - 1))
}
