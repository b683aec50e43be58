//! Power-up: from the file as a loader puts it into memory, or from what the flash holds; and the reset.
//!
//! The first block of a flash is of the factory, and `Flash` leaves it as it is: by it a flash is known to be of this
//! firmware.

use std::sync::Arc;

use kmotiondef::GuestAddr;
use kmotiondef::map::{FLASH, IRAM, SDRAM};
use vm::dsp::Core;
use vm::memory::GuestMemory;

use super::{BootedBoard, Halted, SECOND};
use crate::bus::Hardware;
use crate::external::ExternalHardware;
use crate::file::FirmwareFile;
use crate::loads::Loads;
use crate::sent::SentLines;

/// The time limit for a start: many times that of any version.
const LONGEST_START: u64 = 3 * SECOND;
/// The address at which a board with flash starts, and its stack there.
const FLASH_START: u32 = 0x1000_1000;
const FLASH_STACK: u32 = 0x1000_0440;
/// Flash content and where it is copied to when the board starts: offset, address, bytes.
const PIECES: [(u32, u32, u32); 4] = [
    (0, 0x1000_0000, 0x1000),
    (0x1000, 0x8000_0000, 0xF000),
    (0x1_0000, 0x1000_1000, 0x1_F000),
    (0x2_F000, 0x8000_F000, 0xD_1000),
];
/// The users' half of the flash, erased.
const USER: u32 = 0x10_0000;
/// Bytes of the flash that only the factory writes.
const FACTORY: u32 = 0x1_0000;

/// The reason for which a board does not start from its flash.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FlashError {
    /// The flash is of another firmware, or of the modelled board.
    #[error("it belongs to the modelled board or to another firmware file")]
    OtherFirmware,
    /// The firmware does not start with what the flash holds.
    #[error(transparent)]
    Halted(#[from] Halted),
}

impl BootedBoard {
    /// A board at power-up: the sections are in memory, the processor is before the entry.
    #[must_use]
    pub fn new(file: Arc<FirmwareFile>) -> Self {
        let mut hardware = Hardware::default();
        file.load(&mut hardware.memory);
        hardware.memory.set_places(file.places());
        fill_flash(&mut hardware.memory);
        let mut core = Core::at_power_up(file.entry(), 0, 0);
        core.skip_waits(true);
        let (sent, loads) = (SentLines::default(), Loads::default());
        Self { file, core, hardware, sent, waits_since: 0, loads, skips: true, packets: None, crash: None }
    }

    /// The board that a firmware file makes, when it first looks for what the PC sends.
    ///
    /// # Errors
    /// The firmware never comes to that.
    pub fn booted(file: Arc<FirmwareFile>) -> Result<Self, Halted> {
        let mut board = Self::new(file);
        board.boot()?;
        Ok(board)
    }

    /// Starts from the flash content of such a board, 2 MiB.
    ///
    /// # Errors
    /// The flash is not of this firmware, or the firmware never comes to look for what the PC sends.
    pub fn booted_from(file: Arc<FirmwareFile>, flash: &[u8]) -> Result<Self, FlashError> {
        let mut board = Self::new(file);
        let factory = FACTORY as usize;
        let is_whole = flash.len() == FLASH.size as usize;
        if !is_whole || board.flash().get(..factory) != flash.get(..factory) {
            return Err(FlashError::OtherFirmware);
        }
        let stored = board.hardware.memory.poke_bytes(FLASH.base, flash);
        debug_assert!(stored.is_ok(), "the flash is mapped");
        board.restart();
        board.boot()?;
        Ok(board)
    }
}

impl<A: ExternalHardware> BootedBoard<A> {
    /// Runs until the firmware first looks for what the PC sends.
    ///
    /// # Errors
    /// It never comes to that.
    pub fn boot(&mut self) -> Result<(), Halted> {
        while self.hardware.first_look.is_none() {
            if self.cycle() >= LONGEST_START {
                let reason = "it has not begun to wait for the PC within 3 s of its start";
                return Err(self.crash(reason.to_owned()));
            }
            let _ = self.run_events(self.cycle() + SECOND / 100)?;
        }
        Ok(())
    }

    /// Returns the contents of the flash.
    #[must_use]
    pub fn flash(&self) -> &[u8] {
        self.memory().read_bytes(FLASH.base, FLASH.size).unwrap_or_default()
    }

    /// A reset: everything but flash and link as at power-up.
    pub(super) fn restart(&mut self) {
        let Hardware { memory, window, forgives, register_waits, .. } = std::mem::take(&mut self.hardware);
        self.hardware = Hardware { memory, window, forgives, register_waits, ..Hardware::default() };
        self.hardware.window.reset();
        let memory = &mut self.hardware.memory;
        for region in [IRAM, SDRAM] {
            let zeros = vec![0; region.size as usize];
            let stored = memory.poke_bytes(region.base, &zeros);
            debug_assert!(stored.is_ok(), "both RAMs are mapped");
        }
        for (offset, address, size) in PIECES {
            copy(memory, FLASH.base.get() + offset, address, size);
        }
        let stops = self.core.stops().to_vec();
        self.core = Core::at_power_up(FLASH_START, FLASH_STACK, self.cycle());
        self.core.skip_waits(self.skips);
        self.core.set_stops(stops);
    }
}

/// Copies bytes inside of guest memory; both places are mapped.
fn copy(memory: &mut GuestMemory, from: u32, to: u32, size: u32) {
    let bytes = memory.read_bytes(GuestAddr::new(from), size).map(<[u8]>::to_vec).unwrap_or_default();
    let stored = memory.poke_bytes(GuestAddr::new(to), &bytes);
    debug_assert!(stored.is_ok(), "{to:X} is mapped");
}

/// A board as it leaves the factory: the system's half as loaded, the users' half erased.
fn fill_flash(memory: &mut GuestMemory) {
    for (offset, address, size) in PIECES {
        copy(memory, address, FLASH.base.get() + offset, size);
    }
    let erased = vec![0xFF; (FLASH.size - USER) as usize];
    let stored = memory.poke_bytes(FLASH.base.offset(USER), &erased);
    debug_assert!(stored.is_ok(), "the flash is mapped");
}
