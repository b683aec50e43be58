//! The board of a memory: its memory map and its axes.

use std::ops::Range;

use kmotiondef::map::{MemoryMap, RegionKind};
use kmotiondef::{Axes, GuestAddr};

use super::{Bases, GuestMemory, SDRAM_SIZE, Scalar, flash, index, offset_in};
use crate::protection::Protection;
use crate::trap::Access;

/// Bytes of SDRAM after the first [`SDRAM_SIZE`] on a board other than a KFLOP.
const UPPER_SIZE: usize = 0x40_0000;

impl GuestMemory {
    /// Makes this the memory of another board at power-up; [`set_places`](Self::set_places) gives the addresses of its
    /// objects.
    ///
    /// It has the first 20 MiB of SDRAM.
    pub fn set_map(&mut self, map: &'static MemoryMap) {
        if self.map != map {
            self.map = map;
            let size = index(map.iram.size) + UPPER_SIZE;
            self.other_ram = (*map != MemoryMap::KFLOP).then(|| vec![0; size].into_boxed_slice());
            self.protection = Protection::of(map.programs);
            self.last = None;
        }
    }

    /// The memories and devices of the board of this memory.
    #[inline(always)]
    #[must_use]
    pub const fn map(&self) -> &'static MemoryMap {
        self.map
    }

    /// Says which axes the board of this memory has.
    pub const fn set_axes(&mut self, axes: Axes) {
        self.axes = axes;
    }

    /// The axes of the board of this memory.
    #[inline(always)]
    #[must_use]
    pub const fn axes(&self) -> Axes {
        self.axes
    }

    /// The first addresses of both RAMs, as programs see them.
    #[inline(always)]
    pub(super) const fn bases(&self) -> Bases {
        Bases { sdram: self.map.sdram.base.get(), iram: self.map.iram.base.get() }
    }

    /// On-chip RAM.
    #[inline(always)]
    pub(super) fn iram_bytes(&self) -> &[u8] {
        match &self.other_ram {
            None => &self.iram[..],
            Some(ram) => ram.get(..index(self.map.iram.size)).unwrap_or_default(),
        }
    }

    /// All RAM besides `sdram`, for snapshots.
    pub(super) fn rest_bytes(&self) -> &[u8] {
        self.other_ram.as_deref().unwrap_or(&self.iram[..])
    }

    /// [`rest_bytes`](Self::rest_bytes), to change it.
    pub(super) fn rest_bytes_mut(&mut self) -> &mut [u8] {
        self.other_ram.as_deref_mut().unwrap_or(&mut self.iram[..])
    }

    /// The offset of an address in flash memory, if this board shows it.
    pub(super) fn offset_in_flash(&self, addr: GuestAddr) -> Option<usize> {
        offset_in(addr, self.map.flash?.base.get(), flash::SIZE)
    }

    /// Returns whether the map is not that of a KFLOP.
    #[inline(always)]
    #[must_use]
    pub const fn has_other_map(&self) -> bool {
        self.other_ram.is_some()
    }

    /// The range of `other_ram` from an address to the end of its region.
    fn other_range(&self, address: u32) -> Option<Range<usize>> {
        let (bases, iram) = (self.bases(), index(self.map.iram.size));
        let offset = index(address.wrapping_sub(bases.iram));
        if offset < iram {
            return Some(offset..iram);
        }
        let after = index(address.wrapping_sub(bases.sdram)).checked_sub(SDRAM_SIZE)?;
        (after < UPPER_SIZE).then_some(iram + after..iram + UPPER_SIZE)
    }

    /// On-chip RAM or SDRAM after `sdram`, from an address on, on a board whose map is not that of a KFLOP.
    pub(super) fn other_ram_at(&self, address: u32) -> Option<&[u8]> {
        self.other_ram.as_deref()?.get(self.other_range(address)?)
    }

    /// [`other_ram_at`](Self::other_ram_at), to change it.
    pub(super) fn other_ram_mut(&mut self, address: u32) -> Option<&mut [u8]> {
        let range = self.other_range(address)?;
        let ram = self.other_ram.as_deref_mut()?;
        self.is_touched = true;
        ram.get_mut(range)
    }

    /// RAM from an address on, on a board whose map is not that of a KFLOP.
    fn ram_by_map(&self, address: u32) -> Option<&[u8]> {
        self.other_ram.as_ref()?;
        let found = self.other_ram_at(address);
        found.or_else(|| self.sdram.get(index(address.wrapping_sub(self.bases().sdram))..))
    }

    /// [`ram_by_map`](Self::ram_by_map), to change it.
    fn ram_by_map_mut(&mut self, address: u32) -> Option<&mut [u8]> {
        self.other_ram.as_ref()?;
        if self.other_range(address).is_some() {
            return self.other_ram_mut(address);
        }
        let base = self.bases().sdram;
        self.sdram.get_mut(index(address.wrapping_sub(base))..)
    }

    #[cold]
    pub(super) fn peek_by_map<T: Scalar>(&self, address: u32) -> Option<T> {
        T::get(self.ram_by_map(address)?, 0)
    }

    #[cold]
    pub(super) fn poke_by_map<T: Scalar>(&mut self, address: u32, value: T) -> Option<()> {
        value.set(self.ram_by_map_mut(address)?, 0)
    }

    #[cold]
    pub(super) fn block_by_map<const N: usize>(&self, address: u32) -> Option<&[u8; N]> {
        self.ram_by_map(address)?.first_chunk()
    }

    #[cold]
    pub(super) fn block_mut_by_map<const N: usize>(&mut self, address: u32) -> Option<&mut [u8; N]> {
        self.ram_by_map_mut(address)?.first_chunk_mut()
    }

    /// Reports whether an access of `addr` goes to the bus: registers always, flash only for a store.
    #[must_use]
    pub fn is_on_bus(&self, addr: GuestAddr, access: Access) -> bool {
        let mut regions = self.map.regions().filter(|region| match region.kind {
            RegionKind::Device => true,
            RegionKind::Flash => access == Access::Write,
            RegionKind::Ram => false,
        });
        regions.any(|region| region.holds(addr))
    }
}
