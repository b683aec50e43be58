//! Guest memory: the one copy of everything a program can see.
//!
//! Two ways in. Accesses on behalf of a program ([`GuestMemory::load`], `store`, `read_bytes`, …) are checked: the
//! address is mapped and aligned, and a store is not into program text. The kernel and the loader use
//! [`GuestMemory::peek`] and `poke`, which ignore alignment and protection.
//!
//! Registers of devices are not memory; the engine sends such accesses to the
//! [`Bus`](crate::bus::Bus), and here they count as unmapped.
#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::as_conversions
    )
)]

mod board;
mod flash;
pub mod places;
pub mod snapshot;

use std::ops::Range;
use std::sync::LazyLock;

use kmotiondef::map::{FLASH, IRAM, MemoryMap, ROM_SIZE, SDRAM, silent_from};
use kmotiondef::{Axes, GuestAddr, ThreadId};

use self::flash::Flash;
use self::places::Places;
use self::snapshot::Regions;
use crate::arith::WordDivision;
use crate::protection::Protection;
use crate::trap::{Access, TrapKind};

const SDRAM_SIZE: usize = 0x100_0000;
const IRAM_SIZE: usize = 0x2_0000;

const SDRAM_BASE: u32 = SDRAM.base.get();
const IRAM_BASE: u32 = IRAM.base.get();
const FLASH_BASE: u32 = FLASH.base.get();

/// The effect of accesses and divisions that are errors of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaultPolicy {
    /// The access stops the thread.
    #[default]
    Trap,
    /// As on the real board: an integer division by zero yields a meaningless value, ROM and control registers read 0
    /// and ignore stores, low bits of a misaligned address are ignored. Accesses to other addresses, and stores into
    /// program text, still stop the thread.
    Board,
}

/// The contents of ROM, the largest of the silent regions, and of control registers, as reads see them.
static SILENCE: LazyLock<Box<[u8]>> = LazyLock::new(|| vec![0; index(ROM_SIZE)].into_boxed_slice());

/// A type that one load or store moves.
pub trait Scalar: sealed::Sealed + Copy + Default {
    /// Bytes in memory.
    const SIZE: u32;
    /// A load's address is a multiple of this.
    const LOAD_ALIGN: u32;
    /// A store's address is a multiple of this.
    const STORE_ALIGN: u32;

    /// Little-endian bytes at `offset`; `None` beyond the end.
    #[doc(hidden)]
    fn get(bytes: &[u8], offset: usize) -> Option<Self>;

    /// Reads at a multiple of the size, and returns `None` elsewhere; one comparison tests both, because any other
    /// offset becomes an index far beyond the end.
    #[doc(hidden)]
    fn get_multiple(bytes: &[u8], offset: u32) -> Option<Self>;

    /// Writes little-endian bytes at a multiple of the size; `None` elsewhere and beyond the end.
    #[doc(hidden)]
    fn set_multiple(self, bytes: &mut [u8], offset: u32) -> Option<()>;

    /// Writes little-endian bytes at `offset`; `None` beyond the end.
    #[doc(hidden)]
    fn set(self, bytes: &mut [u8], offset: usize) -> Option<()>;
}

mod sealed {
    /// Closes [`super::Scalar`] to types outside this file.
    pub trait Sealed {}
}

macro_rules! scalars {
    ($($ty:ty: $size:literal, store at $store:literal;)*) => {$(
        impl sealed::Sealed for $ty {}

        impl Scalar for $ty {
            const SIZE: u32 = $size;
            const LOAD_ALIGN: u32 = $size;
            const STORE_ALIGN: u32 = $store;

            #[inline]
            fn get(bytes: &[u8], offset: usize) -> Option<Self> {
                let chunk = bytes.get(offset..offset.checked_add($size)?)?;
                Some(Self::from_le_bytes(*chunk.first_chunk()?))
            }

            #[inline(always)]
            fn get_multiple(bytes: &[u8], offset: u32) -> Option<Self> {
                let number = offset.rotate_right(Self::SIZE.trailing_zeros());
                Some(Self::from_le_bytes(*bytes.as_chunks().0.get(index(number))?))
            }

            #[inline(always)]
            fn set_multiple(self, bytes: &mut [u8], offset: u32) -> Option<()> {
                let number = offset.rotate_right(Self::SIZE.trailing_zeros());
                *bytes.as_chunks_mut().0.get_mut(index(number))? = self.to_le_bytes();
                Some(())
            }

            #[inline]
            fn set(self, bytes: &mut [u8], offset: usize) -> Option<()> {
                let chunk = bytes.get_mut(offset..offset.checked_add($size)?)?;
                *chunk.first_chunk_mut()? = self.to_le_bytes();
                Some(())
            }
        }
    )*};
}

// The DSP stores a double as two words (dialect.md 1.5 of the specification).
scalars! {
    u8: 1, store at 1;
    i8: 1, store at 1;
    u16: 2, store at 2;
    i16: 2, store at 2;
    u32: 4, store at 4;
    i32: 4, store at 4;
    u64: 8, store at 8;
    i64: 8, store at 8;
    f32: 4, store at 4;
    f64: 8, store at 4;
}

/// The guest's 32-bit address space.
///
/// The kernel's accesses try the addresses of a KFLOP first, which are constants. On a board with another map they
/// usually miss, and the access is then made by that map.
#[derive(Clone, Debug)]
pub struct GuestMemory {
    sdram: Box<[u8; SDRAM_SIZE]>,
    iram: Box<[u8; IRAM_SIZE]>,
    /// On-chip RAM of a board other than a KFLOP, in place of `iram`, and after it the SDRAM after `sdram`.
    other_ram: Option<Box<[u8]>>,
    flash: Flash,
    map: &'static MemoryMap,
    protection: Protection,
    faults: FaultPolicy,
    /// True if on-chip RAM may have been written, see [`GuestMemory::take_touched`].
    is_touched: bool,
    /// The regions of the last snapshot, which the next one shares.
    last: Option<Regions>,
    places: Places,
    axes: Axes,
}

/// Compares the memory that a program can see, without its writers.
impl PartialEq for GuestMemory {
    fn eq(&self, other: &Self) -> bool {
        self.map == other.map
            && self.sdram == other.sdram
            && self.iram == other.iram
            && self.other_ram == other.other_ram
            && self.flash == other.flash
            && self.protection == other.protection
    }
}

impl Eq for GuestMemory {}

impl Default for GuestMemory {
    fn default() -> Self {
        Self::new()
    }
}

/// The large memory.
pub(crate) type Sdram = [u8; SDRAM_SIZE];

/// The first addresses of both RAMs.
#[derive(Clone, Copy, Debug)]
struct Bases {
    sdram: u32,
    iram: u32,
}

/// The state for accesses of RAM besides SDRAM, and for divisions.
///
/// An engine that holds both separately can keep the address of SDRAM in a processor register.
pub(crate) struct RamRest<'a> {
    iram: &'a mut [u8],
    bases: Bases,
    protection: &'a Protection,
    faults: FaultPolicy,
    is_touched: &'a mut bool,
}

impl RamRest<'_> {
    /// [`GuestMemory::load_ram`]
    #[inline(always)]
    pub(crate) fn load_ram<T: Scalar>(&self, sdram: &Sdram, addr: GuestAddr) -> Option<T> {
        load_ram(sdram, self.iram, self.bases, addr)
    }

    /// [`GuestMemory::store_ram`]
    #[inline(always)]
    pub(crate) fn store_ram<T: Scalar>(
        &mut self,
        sdram: &mut Sdram,
        addr: GuestAddr,
        value: T,
    ) -> Option<()> {
        let address = addr.get();
        if self.protection.covers_aligned(address) {
            return None;
        }
        if value.set_multiple(sdram, address.wrapping_sub(self.bases.sdram)).is_none() {
            value.set_multiple(self.iram, address.wrapping_sub(self.bases.iram))?;
            *self.is_touched = true;
        }
        Some(())
    }

    /// [`GuestMemory::divided_by_zero`]
    ///
    /// # Errors
    /// [`TrapKind::DivisionByZero`], unless programs get the board's result.
    #[cold]
    pub(crate) const fn divided_by_zero(&self, op: WordDivision, a: i32) -> Result<i32, TrapKind> {
        divided_by_zero(self.faults, op, a)
    }
}

/// A value at a multiple of its size in one of the two.
#[inline(always)]
fn load_ram<T: Scalar>(sdram: &Sdram, iram: &[u8], bases: Bases, addr: GuestAddr) -> Option<T> {
    let address = addr.get();
    T::get_multiple(sdram, address.wrapping_sub(bases.sdram))
        .or_else(|| T::get_multiple(iram, address.wrapping_sub(bases.iram)))
}

const fn divided_by_zero(faults: FaultPolicy, op: WordDivision, a: i32) -> Result<i32, TrapKind> {
    match faults {
        FaultPolicy::Trap => Err(TrapKind::DivisionByZero),
        FaultPolicy::Board => Ok(op.by_zero(a)),
    }
}

impl GuestMemory {
    /// Memory as at power-up: zero, the flash erased.
    #[must_use]
    pub fn new() -> Self {
        Self {
            sdram: filled(0),
            iram: filled(0),
            other_ram: None,
            flash: Flash::default(),
            map: &MemoryMap::KFLOP,
            protection: Protection::default(),
            faults: FaultPolicy::default(),
            is_touched: true,
            last: None,
            places: Places::default(),
            axes: Axes::default(),
        }
    }

    /// Sets the effect of accesses and divisions that are errors of a program.
    pub const fn set_faults(&mut self, faults: FaultPolicy) {
        self.faults = faults;
    }

    /// The result of an integer division of `a` by zero.
    ///
    /// # Errors
    /// [`TrapKind::DivisionByZero`], unless programs get the board's result.
    #[cold]
    pub const fn divided_by_zero(&self, op: WordDivision, a: i32) -> Result<i32, TrapKind> {
        divided_by_zero(self.faults, op, a)
    }

    /// Reports whether on-chip RAM, where the variables of the firmware are, may have been written since the last call.
    ///
    /// If not, values derived from them are still valid.
    #[inline]
    pub const fn take_touched(&mut self) -> bool {
        std::mem::replace(&mut self.is_touched, false)
    }

    /// Notes a write to on-chip RAM that did not go through this type.
    #[cfg(feature = "native")]
    pub(crate) const fn mark_touched(&mut self) {
        self.is_touched = true;
    }

    /// Does `work` without marking memory as touched, for writes that the firmware makes in every slice.
    #[inline]
    pub fn untouched<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let was_touched = self.is_touched;
        let result = work(self);
        self.is_touched = was_touched;
        result
    }

    /// Loads a value on behalf of a program.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`] or [`TrapKind::Misaligned`].
    #[inline]
    pub fn load<T: Scalar>(&self, addr: GuestAddr) -> Result<T, TrapKind> {
        self.load_ram(addr).map_or_else(|| self.load_elsewhere(addr), Ok)
    }

    /// Loads a value on behalf of a program if [`load`](Self::load) finds it in SDRAM or in on-chip RAM.
    #[must_use]
    #[inline(always)]
    pub fn load_ram<T: Scalar>(&self, addr: GuestAddr) -> Option<T> {
        load_ram(&self.sdram, self.iram_bytes(), self.bases(), addr)
    }

    #[cold]
    fn load_elsewhere<T: Scalar>(&self, addr: GuestAddr) -> Result<T, TrapKind> {
        let addr = self.aligned(addr, T::LOAD_ALIGN);
        let bytes = self.bytes(addr, T::SIZE)?;
        if addr.get() & (T::LOAD_ALIGN - 1) != 0 {
            return Err(TrapKind::Misaligned { addr, size: T::SIZE, access: Access::Read });
        }
        T::get(bytes, 0).ok_or(TrapKind::Unmapped { addr, access: Access::Read })
    }

    /// The address that an access of `addr` reaches: the board ignores the bits below `align`.
    pub(crate) const fn aligned(&self, addr: GuestAddr, align: u32) -> GuestAddr {
        match self.faults {
            FaultPolicy::Trap => addr,
            FaultPolicy::Board => GuestAddr::new(addr.get() & !(align - 1)),
        }
    }

    /// Stores a value on behalf of a program.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`] (flash included), [`TrapKind::Misaligned`] or
    /// [`TrapKind::WriteProtected`].
    #[inline]
    pub fn store<T: Scalar>(&mut self, addr: GuestAddr, value: T) -> Result<(), TrapKind> {
        let addr = self.aligned(addr, T::STORE_ALIGN);
        let address = addr.get();
        if address & (T::STORE_ALIGN - 1) == 0
            && !self.protection.covers(address, T::SIZE)
            && self.write_ram(address, value).is_some()
        {
            return Ok(());
        }
        self.refuse_store(addr, T::SIZE)
    }

    /// Stores a value on behalf of a program as [`store`](Self::store), but only at a multiple of its size in RAM;
    /// `None` elsewhere.
    #[inline(always)]
    pub fn store_ram<T: Scalar>(&mut self, addr: GuestAddr, value: T) -> Option<()> {
        let (sdram, mut rest) = self.split();
        rest.store_ram(sdram, addr, value)
    }

    /// SDRAM, and the rest of the state that an engine needs for accesses of RAM.
    #[inline(always)]
    pub(crate) fn split(&mut self) -> (&mut Sdram, RamRest<'_>) {
        let bases = self.bases();
        let Self { sdram, iram, other_ram, map, protection, faults, is_touched, .. } = self;
        let iram = match other_ram {
            None => &mut iram[..],
            Some(ram) => ram.get_mut(..index(map.iram.size)).unwrap_or_default(),
        };
        (sdram, RamRest { iram, bases, protection, faults: *faults, is_touched })
    }

    #[inline]
    fn write_ram<T: Scalar>(&mut self, address: u32, value: T) -> Option<()> {
        let bases = self.bases();
        if value.set(&mut self.sdram[..], index(address.wrapping_sub(bases.sdram))).is_none() {
            if let Some(ram) = self.other_ram_mut(address) {
                return value.set(ram, 0);
            }
            value.set(&mut self.iram[..], index(address.wrapping_sub(bases.iram)))?;
            self.is_touched = true;
        }
        Some(())
    }

    /// The error for a store that was refused; a silent region ignores it.
    #[cold]
    fn refuse_store(&self, addr: GuestAddr, size: u32) -> Result<(), TrapKind> {
        self.check_writable(addr, size)?;
        if self.zero_area(addr).is_some() {
            return Ok(());
        }
        Err(TrapKind::Misaligned { addr, size, access: Access::Write })
    }

    /// A value in the RAM of a KFLOP, without alignment; `None` anywhere else.
    #[must_use]
    #[inline]
    pub fn peek_ram<T: Scalar>(&self, addr: GuestAddr) -> Option<T> {
        let address = addr.get();
        T::get(&self.iram[..], index(address.wrapping_sub(IRAM_BASE)))
            .or_else(|| T::get(&self.sdram[..], index(address.wrapping_sub(SDRAM_BASE))))
    }

    /// Reads a value for the kernel: no alignment; bytes outside the map read as 0.
    #[must_use]
    #[inline]
    pub fn peek<T: Scalar>(&self, addr: GuestAddr) -> T {
        let address = addr.get();
        self.peek_ram(addr)
            .or_else(|| T::get(self.flash.bytes(), index(address.wrapping_sub(FLASH_BASE))))
            .or_else(|| self.peek_by_map(address))
            .unwrap_or_default()
    }

    /// Writes a value for the kernel: no alignment, no protection, flash included; nothing happens
    /// outside the map.
    #[inline]
    pub fn poke<T: Scalar>(&mut self, addr: GuestAddr, value: T) {
        let address = addr.get();
        if value.set(&mut self.iram[..], index(address.wrapping_sub(IRAM_BASE))).is_some() {
            self.is_touched = true;
            return;
        }
        let _ = value
            .set(&mut self.sdram[..], index(address.wrapping_sub(SDRAM_BASE)))
            .or_else(|| value.set(self.flash.bytes_mut(), index(address.wrapping_sub(FLASH_BASE))))
            .or_else(|| self.poke_by_map(address, value));
    }

    /// The `len` bytes from `addr` on.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`] with the first byte outside the region.
    pub fn read_bytes(&self, addr: GuestAddr, len: u32) -> Result<&[u8], TrapKind> {
        self.bytes(addr, len)
    }

    /// Writes `bytes` at `addr` on behalf of a program.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`] or [`TrapKind::WriteProtected`]; nothing is written in that case.
    pub fn write_bytes(&mut self, addr: GuestAddr, bytes: &[u8]) -> Result<(), TrapKind> {
        self.check_writable(addr, length(bytes))?;
        self.poke_bytes(addr, bytes)
    }

    /// Writes `bytes` at `addr` for the kernel or the loader: no protection, flash included.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`]; nothing is written in that case.
    pub fn poke_bytes(&mut self, addr: GuestAddr, bytes: &[u8]) -> Result<(), TrapKind> {
        if self.is_silent(addr, length(bytes)) {
            return Ok(());
        }
        self.bytes_mut(addr, length(bytes))?.copy_from_slice(bytes);
        Ok(())
    }

    /// A block of RAM for the kernel, located once for many accesses; `None` unless it lies in a single region.
    #[must_use]
    #[inline]
    pub fn block<const N: usize>(&self, addr: GuestAddr) -> Option<&[u8; N]> {
        let address = addr.get();
        if let Some(block) = self.sdram.get(index(address.wrapping_sub(SDRAM_BASE))..) {
            return block.first_chunk();
        }
        if let Some(block) = self.iram.get(index(address.wrapping_sub(IRAM_BASE))..) {
            return block.first_chunk();
        }
        self.block_by_map(address)
    }

    /// [`block`](Self::block), to change it.
    #[must_use]
    #[inline]
    pub fn block_mut<const N: usize>(&mut self, addr: GuestAddr) -> Option<&mut [u8; N]> {
        let address = addr.get();
        self.is_touched = true;
        if let Some(offset) = offset_in(addr, IRAM_BASE, IRAM_SIZE) {
            return self.iram.get_mut(offset..)?.first_chunk_mut();
        }
        if let Some(offset) = offset_in(addr, SDRAM_BASE, SDRAM_SIZE) {
            return self.sdram.get_mut(offset..)?.first_chunk_mut();
        }
        self.block_mut_by_map(address)
    }

    /// Reads a string up to its closing 0, which is not part of the result, or `max` bytes.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`] if the region ends first.
    pub fn read_c_string(&self, addr: GuestAddr, max: u32) -> Result<Vec<u8>, TrapKind> {
        let rest = self.rest_of_region(addr).ok_or(TrapKind::Unmapped { addr, access: Access::Read })?;
        let visible = rest.get(..index(max)).unwrap_or(rest);
        if let Some(end) = visible.iter().position(|byte| *byte == 0) {
            return Ok(visible.get(..end).unwrap_or_default().to_vec());
        }
        if visible.len() < index(max) {
            let end = addr.offset(length(visible));
            return Err(TrapKind::Unmapped { addr: end, access: Access::Read });
        }
        Ok(visible.to_vec())
    }

    /// Copies `len` bytes from `from` to `to` on behalf of a program; the ranges may overlap.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`] or [`TrapKind::WriteProtected`]; nothing is written in that case.
    pub fn copy(&mut self, to: GuestAddr, from: GuestAddr, len: u32) -> Result<(), TrapKind> {
        self.bytes(from, len)?;
        self.check_writable(to, len)?;
        let base = self.bases().sdram;
        let offset = |addr: GuestAddr| index(addr.get().wrapping_sub(base));
        if let Some(source) = range_within(offset(from), len, SDRAM_SIZE)
            && range_within(offset(to), len, SDRAM_SIZE).is_some()
        {
            self.sdram.copy_within(source, offset(to));
            return Ok(());
        }
        let bytes = self.bytes(from, len)?.to_vec();
        self.poke_bytes(to, &bytes)
    }

    /// Writes `byte` `len` times at `addr` on behalf of a program.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`] or [`TrapKind::WriteProtected`]; nothing is written in that case.
    pub fn fill(&mut self, addr: GuestAddr, byte: u8, len: u32) -> Result<(), TrapKind> {
        self.check_writable(addr, len)?;
        if !self.is_silent(addr, len) {
            self.bytes_mut(addr, len)?.fill(byte);
        }
        Ok(())
    }

    /// Protects `text` of `thread`'s program from stores; an earlier range of that thread is released.
    pub fn protect(&mut self, thread: ThreadId, text: Range<GuestAddr>) {
        self.protection.set(thread, text.start.get()..text.end.get());
    }

    /// Releases the protection of `thread`'s program text.
    pub fn unprotect(&mut self, thread: ThreadId) {
        self.protection.set(thread, 0..0);
    }

    /// SDRAM and on-chip RAM, for compiled code, which makes the checks itself and reports the writes.
    #[cfg(feature = "native")]
    pub(crate) fn ram_mut(&mut self) -> (&mut [u8; SDRAM_SIZE], &mut [u8; IRAM_SIZE]) {
        (&mut self.sdram, &mut self.iram)
    }

    /// The ranges of program text, of which only whole words in the program area are protected.
    #[cfg(feature = "native")]
    pub(crate) const fn protected_texts(&self) -> &crate::protection::Texts {
        self.protection.texts()
    }

    /// Checks that a program can store to all of the `len` bytes from `addr` on.
    fn check_writable(&self, addr: GuestAddr, len: u32) -> Result<(), TrapKind> {
        let unmapped = |addr| TrapKind::Unmapped { addr, access: Access::Write };
        match self.bytes(addr, len) {
            Err(TrapKind::Unmapped { addr, .. }) => return Err(unmapped(addr)),
            Err(kind) => return Err(kind),
            Ok(_) => {}
        }
        if FLASH.base <= addr && addr < FLASH.base.offset(FLASH.size) {
            return Err(unmapped(addr));
        }
        if self.protection.covers(addr.get(), len) {
            return Err(TrapKind::WriteProtected { addr });
        }
        Ok(())
    }

    /// Reports whether flash memory was never written. Testing this first saves the host two megabytes of erased bytes.
    #[must_use]
    pub const fn is_flash_erased(&self) -> bool {
        self.flash.is_erased()
    }

    /// The `len` bytes from `addr` on; if `len` is 0, the address need not be mapped.
    fn bytes(&self, addr: GuestAddr, len: u32) -> Result<&[u8], TrapKind> {
        if len == 0 {
            return Ok(&[]);
        }
        let Some(rest) = self.rest_of_region(addr) else {
            return Err(TrapKind::Unmapped { addr, access: Access::Read });
        };
        let end = addr.offset(length(rest));
        rest.get(..index(len)).ok_or(TrapKind::Unmapped { addr: end, access: Access::Read })
    }

    fn bytes_mut(&mut self, addr: GuestAddr, len: u32) -> Result<&mut [u8], TrapKind> {
        if len == 0 {
            return Ok(&mut []);
        }
        let end = addr.offset(self.rest_of_region(addr).map_or(0, length));
        let bases = self.bases();
        let (region, offset) = if let Some(offset) = offset_in(addr, bases.sdram, SDRAM_SIZE) {
            (&mut self.sdram[..], offset)
        } else if self.other_ram.is_some() {
            (self.other_ram_mut(addr.get()).unwrap_or_default(), 0)
        } else if let Some(offset) = offset_in(addr, bases.iram, IRAM_SIZE) {
            self.is_touched = true;
            (&mut self.iram[..], offset)
        } else if let Some(offset) = self.offset_in_flash(addr) {
            (&mut self.flash.bytes_mut()[..], offset)
        } else {
            return Err(TrapKind::Unmapped { addr, access: Access::Write });
        };
        range_within(offset, len, region.len())
            .and_then(|range| region.get_mut(range))
            .ok_or(TrapKind::Unmapped { addr: end, access: Access::Write })
    }

    /// The bytes from `addr` to the end of its region.
    fn rest_of_region(&self, addr: GuestAddr) -> Option<&[u8]> {
        let bases = self.bases();
        if let Some(offset) = offset_in(addr, bases.sdram, SDRAM_SIZE) {
            self.sdram.get(offset..)
        } else if let Some(ram) = self.other_ram_at(addr.get()) {
            Some(ram)
        } else if let Some(offset) =
            offset_in(addr, bases.iram, IRAM_SIZE).filter(|_| self.other_ram.is_none())
        {
            self.iram.get(offset..)
        } else if let Some(offset) = self.offset_in_flash(addr) {
            self.flash.bytes().get(offset..)
        } else {
            self.zero_area(addr)
        }
    }

    /// The bytes from `addr` to the end of its area that reads as 0 on this board, if there is one.
    fn zero_area(&self, addr: GuestAddr) -> Option<&[u8]> {
        match self.faults {
            FaultPolicy::Trap => None,
            FaultPolicy::Board => SILENCE.get(..index(silent_from(addr)?)),
        }
    }

    /// Reports whether a store of `len` bytes at `addr` is ignored.
    fn is_silent(&self, addr: GuestAddr, len: u32) -> bool {
        self.zero_area(addr).is_some_and(|bytes| bytes.len() >= index(len))
    }
}

const _: () = assert!(index_const(SDRAM.size) == SDRAM_SIZE);
const _: () = assert!(index_const(IRAM.size) == IRAM_SIZE);
const _: () = assert!(index_const(FLASH.size) == flash::SIZE);

#[expect(
    clippy::as_conversions,
    reason = "there is no other conversion in constants, and the value is a size"
)]
const fn index_const(size: u32) -> usize {
    size as usize
}

/// A guest number as a host index; no conversion on a 64-bit host.
#[inline]
fn index(number: u32) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}

/// The length of bytes that are copied from or to guest memory.
fn length(bytes: &[u8]) -> u32 {
    u32::try_from(bytes.len()).unwrap_or(u32::MAX)
}

fn offset_in(addr: GuestAddr, base: u32, size: usize) -> Option<usize> {
    let offset = index(addr.get().wrapping_sub(base));
    (offset < size).then_some(offset)
}

fn range_within(offset: usize, len: u32, size: usize) -> Option<Range<usize>> {
    let end = offset.checked_add(index(len))?;
    (end <= size).then_some(offset..end)
}

#[expect(clippy::expect_used, reason = "the vector is made with the length of the array")]
fn filled<const N: usize>(byte: u8) -> Box<[u8; N]> {
    // Through a vector, because an array of this size must not pass over the stack.
    vec![byte; N].into_boxed_slice().try_into().expect("length N")
}

#[cfg(test)]
mod tests;
