//! The board's memory map: regions and the program slots of the threads.
//!
//! Source: firmware 4.34, table `api/memory-map.csv` of the specification.

use std::ops::Range;

use crate::{GuestAddr, ThreadId};

/// The kind of an address range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionKind {
    /// Memory that is read and written.
    Ram,
    /// Memory that is read; writes are commands to the flash chip.
    Flash,
    /// Registers of a device: a read or write is an action.
    Device,
}

/// A range of the guest address space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Name for messages.
    pub name: &'static str,
    /// First address.
    pub base: GuestAddr,
    /// Size in bytes.
    pub size: u32,
    /// Its kind.
    pub kind: RegionKind,
}

macro_rules! regions {
    ($($(#[$doc:meta])* $id:ident = $name:literal at $base:literal, size $size:literal, $kind:ident;)*) => {
        $($(#[$doc])* pub const $id: Region =
            Region { name: $name, base: GuestAddr::new($base), size: $size, kind: RegionKind::$kind };)*

        /// Every mapped region in ascending order of address.
        pub const REGIONS: &[Region] = &[$($id),*];
    };
}

regions! {
    /// On-chip RAM: the firmware's variables, `chan[]` and `persist` among them.
    IRAM = "on-chip RAM" at 0x1000_0000, size 0x2_0000, Ram;
    /// The processor's peripheral registers, of which programs read TIMER0.
    TIMER = "timer registers" at 0x4200_0000, size 0x100, Device;
    /// The 16 MiB SDRAM: programs, stacks, gather buffer, segment buffer, heap.
    SDRAM = "SDRAM" at 0x8000_0000, size 0x100_0000, Ram;
    /// Flash memory, 1 MiB for the system and 1 MiB for users.
    FLASH = "flash" at 0x9000_0000, size 0x20_0000, Flash;
    /// Registers of the FPGA.
    FPGA = "FPGA registers" at 0x9100_0000, size 0x1000, Device;
}

/// The memories and devices of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryMap {
    /// On-chip RAM.
    pub iram: Region,
    /// The registers of the timer that programs read.
    pub timer: Region,
    /// The counting rate of TIMER0, in megahertz.
    pub counter: u32,
    /// SDRAM.
    pub sdram: Region,
    /// Flash memory; `None` if programs do not see it.
    pub flash: Option<Region>,
    /// Registers of the FPGA.
    pub fpga: Region,
    /// Registers of the fast PWM channels, where there are any: of channels 0 and 1, of 2, of 3.
    pub hrpwm: Option<[Region; 3]>,
    /// The start of the buffers for recordings and motion, and of the heap.
    pub buffers: GuestAddr,
    /// The spaces of the programs of threads 1 to 7.
    pub programs: ProgramSpaces,
}

/// The spaces of the programs of threads 1 to 7.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgramSpaces {
    /// The base address of the space of thread 1.
    pub base: u32,
    /// The bytes of each; the next thread's follows.
    pub size: u32,
    /// The first address that no program may use.
    pub limit: u32,
}

impl ProgramSpaces {
    /// The start of the space of a thread.
    #[must_use]
    pub const fn start(&self, thread: ThreadId) -> GuestAddr {
        GuestAddr::new(self.base + thread.index() as u32 * self.size)
    }

    /// The addresses of the space of a thread; a program may continue after them.
    #[must_use]
    pub const fn space(&self, thread: ThreadId) -> Range<u32> {
        let start = self.start(thread).get();
        start..start + self.size
    }

    /// Returns whether an address is in the spaces of programs.
    #[must_use]
    #[inline]
    pub const fn holds(&self, address: u32) -> bool {
        address >= self.base && address < self.limit
    }
}

impl Region {
    /// Returns whether an address is in the region.
    #[must_use]
    #[inline]
    pub const fn holds(&self, address: GuestAddr) -> bool {
        address.get().wrapping_sub(self.base.get()) < self.size
    }

    /// Returns the region with another base and size.
    #[must_use]
    pub const fn at(self, base: u32, size: u32) -> Self {
        Self { base: GuestAddr::new(base), size, ..self }
    }
}

impl MemoryMap {
    /// The map of a KFLOP, which the constants above and below state.
    pub const KFLOP: Self = Self {
        iram: IRAM,
        timer: TIMER,
        counter: 50,
        sdram: SDRAM,
        flash: Some(FLASH),
        fpga: FPGA,
        hrpwm: None,
        buffers: BUFFERS,
        programs: ProgramSpaces { base: PROGRAM_BASE, size: PROGRAM_SIZE, limit: PROGRAM_LIMIT },
    };

    /// The registers of one of the units of fast PWM channels.
    pub(crate) const HRPWM: Region =
        Region { name: "PWM registers", base: GuestAddr::NULL, size: 0x1000, kind: RegionKind::Device };

    /// Returns whether bits from 200 on are those of a Kogna.
    #[must_use]
    pub const fn has_kogna_bits(&self) -> bool {
        self.hrpwm.is_some()
    }

    /// The address of TIMER0, which is at the same place among the timer's registers on every board.
    #[must_use]
    pub const fn timer0(&self) -> GuestAddr {
        self.timer.base.offset(TIMER0.get() - TIMER.base.get())
    }

    /// Every mapped region.
    pub fn regions(&self) -> impl Iterator<Item = Region> {
        [Some(self.iram), Some(self.timer), Some(self.sdram), self.flash, Some(self.fpga)]
            .into_iter()
            .flatten()
            .chain(self.hrpwm.into_iter().flatten())
    }
}

/// Bytes of the internal ROM, which begins at address 0.
pub const ROM_SIZE: u32 = 0x6_0000;

/// Places outside the map that the real board answers: loads give 0, stores do nothing. Base and size of each.
///
/// The ROM, the control of the program cache, the clock, the pins of both serial ports, the control of the memory bus
/// (`dsp-board.md` section 3).
pub const SILENT: [(u32, u32); 6] = [
    (0, ROM_SIZE),
    (0x2000_0000, 0x1000),
    (0x4100_0000, 0x1000),
    (0x4400_0000, 0x1000),
    (0x4500_0000, 0x1000),
    (0xF000_0000, 0x1000),
];

/// The bytes from `addr` to the end of the silent place around it; `None` if there is none.
#[must_use]
pub fn silent_from(addr: GuestAddr) -> Option<u32> {
    SILENT.iter().find_map(|(base, size)| {
        let offset = addr.get().wrapping_sub(*base);
        (offset < *size).then(|| size - offset)
    })
}

/// TIMER0, a free-running 50 MHz counter of 32 bits.
pub const TIMER0: GuestAddr = GuestAddr::new(0x4200_0010);

/// Start of thread 1's program slot.
pub const PROGRAM_BASE: u32 = 0x8005_0000;
/// Bytes of one thread's program slot; the next thread's follows.
pub const PROGRAM_SIZE: u32 = 0x1_0000;
/// First address after every program slot: the limit for a program that needs several.
pub const PROGRAM_LIMIT: u32 = 0x8010_0000;

/// Start of the buffers for recordings and motion, and of the heap.
pub const BUFFERS: GuestAddr = GuestAddr::new(PROGRAM_LIMIT);

/// Start of the stack of thread 1; design choice: where the board has the firmware's own code, of which there is none here.
///
/// All of the space after the programs of threads 1 to 6 is thread 7's, up to [`PROGRAM_LIMIT`], as on the board.
pub const STACK_BASE: u32 = 0x8000_0000;
/// Bytes of one thread's stack. The board itself has 2048, see `BOARD_STACK_SIZE`.
pub const STACK_SIZE: u32 = 0x8000;
/// Start of the stack of thread 1 on the real board, in on-chip RAM; the other threads' follow.
pub const BOARD_STACKS_BASE: u32 = 0x1001_3488;
/// Bytes of one thread's stack on the real board.
pub const BOARD_STACK_SIZE: u32 = 2048;

/// The spaces of programs of a Kogna, and the start of the stack of thread 1 there. Source: its header and firmware file.
pub const KOGNA_PROGRAMS: ProgramSpaces =
    ProgramSpaces { base: 0xC008_0000, size: 0x4_0000, limit: 0xC030_0000 };
/// See [`KOGNA_PROGRAMS`].
pub const KOGNA_STACKS_BASE: u32 = 0x1182_D2F8;

/// Bytes of it that the interrupts of the servo need, rounded up: 172 to 192 were measured.
pub const INTERRUPT_STACK: u32 = 256;

/// Bytes of it for the functions of a thread: without those of the interrupts and the 16 above the first frame.
pub const THREAD_STACK: u32 = BOARD_STACK_SIZE - 16 - INTERRUPT_STACK;

/// The start address of the program of thread `thread`.
#[must_use]
pub fn program_base(thread: ThreadId) -> GuestAddr {
    GuestAddr::new(PROGRAM_BASE + u32::from(thread.get() - 1) * PROGRAM_SIZE)
}

/// The lowest address of `thread`'s stack; it grows down towards it.
#[must_use]
pub fn stack_base(thread: ThreadId) -> GuestAddr {
    GuestAddr::new(STACK_BASE + u32::from(thread.get() - 1) * STACK_SIZE)
}

/// Stack for the call-back, which belongs to no thread: after those of the seven threads.
pub const CALLBACK_STACK_BASE: u32 = STACK_BASE + 7 * STACK_SIZE;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_ascend_without_overlap() {
        for pair in REGIONS.windows(2) {
            assert!(pair[0].base.get() + pair[0].size <= pair[1].base.get());
        }
    }

    #[test]
    fn stacks_are_before_the_programs_and_the_last_program_has_more_room() {
        let last = ThreadId::new(7).expect("7 is a thread");
        assert!(program_base(last).get() + PROGRAM_SIZE < PROGRAM_LIMIT);
        const { assert!(CALLBACK_STACK_BASE + STACK_SIZE <= PROGRAM_BASE) };
    }
}
