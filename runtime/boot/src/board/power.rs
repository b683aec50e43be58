//! Power-up, from a file whose sections a loader has copied to memory, or from the contents of the flash; and reset.
//!
//! The first block of a flash is written at the factory, and `Flash` leaves it unchanged: it identifies the firmware of
//! a flash.

use std::sync::Arc;

use kmotiondef::GuestAddr;
use kmotiondef::map::{FLASH, IRAM, SDRAM};
use vm::dsp::Core;
use vm::memory::GuestMemory;

use super::{BootedBoard, HaltError, SECOND};
use crate::bus::Hardware;
use crate::external::ExternalHardware;
use crate::file::FirmwareFile;
use crate::loads::Loads;
use crate::sent::SentLines;

/// The time limit for a start: many times the duration for any version.
const LONGEST_START: u64 = 3 * SECOND;
/// The address at which a board starts from flash, and its stack pointer there.
const FLASH_START: u32 = 0x1000_1000;
const FLASH_STACK: u32 = 0x1000_0440;
/// The parts of the flash that are copied to memory when the board starts: offset, address, bytes.
const PIECES: [(u32, u32, u32); 4] = [
    (0, 0x1000_0000, 0x1000),
    (0x1000, 0x8000_0000, 0xF000),
    (0x1_0000, 0x1000_1000, 0x1_F000),
    (0x2_F000, 0x8000_F000, 0xD_1000),
];
/// The users' half of the flash, erased.
const USER: u32 = 0x10_0000;
/// The size of the part that only the factory writes.
const FACTORY: u32 = 0x1_0000;

/// The reason why a board does not start from its flash.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FlashError {
    /// The flash belongs to another firmware, or to the modelled board.
    #[error("it belongs to the modelled board or to another firmware file")]
    OtherFirmware,
    /// The firmware crashes when it starts from the contents of the flash.
    #[error(transparent)]
    Halted(#[from] HaltError),
}

impl BootedBoard {
    /// Creates a board at power-up: the sections are in memory, and the processor is at the entry point.
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

    /// Creates a board from a firmware file, and runs it until it first polls the link to the PC.
    ///
    /// # Errors
    /// The firmware never polls the link.
    pub fn booted(file: Arc<FirmwareFile>) -> Result<Self, HaltError> {
        let mut board = Self::new(file);
        board.boot()?;
        Ok(board)
    }

    /// Starts from the flash contents of such a board, 2 MiB.
    ///
    /// # Errors
    /// The flash does not belong to this firmware, or the firmware never polls the link to the PC.
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
    /// Runs until the firmware first polls the link to the PC.
    ///
    /// # Errors
    /// It never polls the link.
    pub fn boot(&mut self) -> Result<(), HaltError> {
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

    /// Resets the board: everything except flash and link is as at power-up.
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

/// Copies bytes within guest memory; both ranges are mapped.
fn copy(memory: &mut GuestMemory, from: u32, to: u32, size: u32) {
    let bytes = memory.read_bytes(GuestAddr::new(from), size).map(<[u8]>::to_vec).unwrap_or_default();
    let stored = memory.poke_bytes(GuestAddr::new(to), &bytes);
    debug_assert!(stored.is_ok(), "{to:X} is mapped");
}

/// Sets the flash as it leaves the factory: the system's half as loaded, the users' half erased.
fn fill_flash(memory: &mut GuestMemory) {
    for (offset, address, size) in PIECES {
        copy(memory, address, FLASH.base.get() + offset, size);
    }
    let erased = vec![0xFF; (FLASH.size - USER) as usize];
    let stored = memory.poke_bytes(FLASH.base.offset(USER), &erased);
    debug_assert!(stored.is_ok(), "the flash is mapped");
}
