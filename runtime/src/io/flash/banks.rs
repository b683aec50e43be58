//! The window on flash memory, for a board with strict flash.
//!
//! The chip has more address lines than the bus: `SetFlashBank` sets its lines 14 to 19, and every read is from the 32
//! KiB of that bank, whatever its address. Programs that forget to select a bank read the wrong one; a board that is
//! not strict shows the whole chip at its addresses, and hides the mistake. Here guest memory holds the visible bytes,
//! and the chip is kept separately.

use chips::flash::{COMMANDS, USER};
use kmotiondef::GuestAddr;
use kmotiondef::map::FLASH;
use vm::memory::GuestMemory;

use super::FLASH_SIZE;

/// Bytes of a bank: 2^14 words.
const BANK: usize = 0x8000;

/// The contents of the chip, and the visible bank.
#[derive(Clone, Debug)]
struct Chip {
    bytes: Vec<u8>,
    bank: usize,
}

/// Address bits that are selected.
const BANK_BITS: u32 = 0x1F_C000;
/// Below this offset is the boot sector.
const BOOT_SECTOR: u32 = 0x1_0000;

/// The bank of an address was not selected, because it contains the boot sector; the board prints a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub(crate) struct BankRefused;

/// The selected bank; without a chip where all of flash is visible.
#[derive(Clone, Debug, Default)]
pub(crate) struct Banks {
    chip: Option<Chip>,
    /// The bank that was refused last. The message for it is repeated only after another bank was refused.
    refused: Option<u32>,
}

impl Banks {
    /// Makes a single bank visible from now on, initially the first.
    pub(crate) fn be_strict(&mut self, memory: &mut GuestMemory) {
        self.chip = Some(Chip { bytes: flash(memory), bank: 0 });
        self.map_into(memory);
    }

    /// Selects the bank of an address. The boot sector is refused, and the users' first bank is selected in its place.
    pub(crate) fn select(&mut self, address: GuestAddr, memory: &mut GuestMemory) -> Result<(), BankRefused> {
        let address = address.get();
        let offset = address % FLASH.size;
        // A program may select the addresses of the chip's commands there; for other addresses it gets the user half.
        let is_refused = offset < BOOT_SECTOR && !COMMANDS.contains(&address);
        if let Some(chip) = &mut self.chip {
            chip.bank = (if is_refused { USER } else { offset }) as usize / BANK;
            self.map_into(memory);
        }
        let bank = address & BANK_BITS;
        if is_refused && self.refused.replace(bank) != Some(bank) { Err(BankRefused) } else { Ok(()) }
    }

    /// Runs an action that needs all of flash at its addresses.
    pub(crate) fn with_chip<R>(
        &mut self,
        memory: &mut GuestMemory,
        work: impl FnOnce(&mut GuestMemory) -> R,
    ) -> R {
        if let Some(chip) = &self.chip {
            store(memory, &chip.bytes);
        }
        let result = work(memory);
        if let Some(chip) = &mut self.chip {
            chip.bytes = flash(memory);
        }
        self.map_into(memory);
        result
    }

    /// Returns the contents of the chip, if they differ from the visible ones.
    pub(crate) fn chip(&self) -> Option<&[u8]> {
        self.chip.as_ref().map(|chip| &*chip.bytes)
    }

    fn map_into(&self, memory: &mut GuestMemory) {
        let Some(Chip { bytes, bank }) = &self.chip else { return };
        let seen = &bytes[bank * BANK..][..BANK];
        store(memory, &seen.repeat(FLASH_SIZE / BANK));
    }
}

fn flash(memory: &GuestMemory) -> Vec<u8> {
    memory.read_bytes(FLASH.base, FLASH.size).unwrap_or_default().to_vec()
}

fn store(memory: &mut GuestMemory, bytes: &[u8]) {
    let stored = memory.poke_bytes(FLASH.base, bytes);
    debug_assert!(stored.is_ok() && bytes.len() == FLASH_SIZE, "flash is mapped");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::flash;

    #[test]
    fn a_read_at_any_address_sees_the_selected_bank() {
        let (mut memory, mut banks) = (GuestMemory::new(), Banks::default());
        let user = FLASH.base.offset(0x10_0000);
        banks.be_strict(&mut memory);
        assert!(banks.with_chip(&mut memory, |memory| flash::program(memory, user, &[7; 0x8001])));
        let look = |memory: &GuestMemory| {
            [0, 0x10_0000, 0x10_8000].map(|at| memory.peek::<u8>(FLASH.base.offset(at)))
        };
        assert_eq!(look(&memory), [0xFF; 3]);
        assert_eq!(banks.select(FLASH.base.offset(0x1_0000), &mut memory), Ok(()));
        assert_eq!(look(&memory), [0xFF; 3]);
        assert_eq!(banks.select(user.offset(2), &mut memory), Ok(()));
        assert_eq!(look(&memory), [7; 3]);
        assert_eq!(banks.select(user.offset(0x8000), &mut memory), Ok(()));
        assert_eq!(look(&memory), [7; 3]);
        assert_eq!(memory.peek::<u8>(user.offset(1)), 0xFF);
        assert_eq!(banks.chip().map(|bytes| bytes[0x10_7FFF..0x10_8002].to_vec()), Some(vec![7, 7, 0xFF]));
        // The boot sector shows the users' first bank.
        assert_eq!(banks.select(FLASH.base, &mut memory), Err(BankRefused));
        assert_eq!(look(&memory), [7; 3]);
        assert_eq!(banks.select(FLASH.base.offset(2), &mut memory), Ok(()));
    }
}
