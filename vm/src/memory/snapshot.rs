//! Guest memory as it was at an instant, in pages that snapshots share.
//!
//! Compiled code does not report where it writes, so a snapshot compares every page with the page of the last snapshot:
//! equal pages are shared. RAM that was never written to is compared with a single page of zeros, which takes almost no
//! time.

use std::fmt;
use std::sync::Arc;

use super::flash::{self, Flash};
use super::{GuestMemory, IRAM_SIZE, SDRAM_SIZE};
use crate::protection::Protection;

/// Bytes of a page.
const PAGE: usize = 0x1000;

type Page = [u8; PAGE];

const _: () = assert!(SDRAM_SIZE.is_multiple_of(PAGE) && IRAM_SIZE.is_multiple_of(PAGE));
const _: () = assert!(flash::SIZE.is_multiple_of(PAGE));

/// A region of memory.
#[derive(Clone)]
struct Pages(Vec<Arc<Page>>);

/// Shows the offset and a checksum of each page that differs from the page before it.
impl fmt::Debug for Pages {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut map = f.debug_map();
        let mut before: Option<&Arc<Page>> = None;
        for (index, page) in self.0.iter().enumerate() {
            if before.is_none_or(|before| !Arc::ptr_eq(before, page) && before != page) {
                map.entry(&index, &checksum(page));
            }
            before = Some(page);
        }
        map.finish()
    }
}

/// 64-bit FNV-1a of a page.
fn checksum(page: &Page) -> u64 {
    page.iter()
        .fold(0xcbf2_9ce4_8422_2325, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

impl Pages {
    /// A region of `size` bytes that all are `byte`.
    fn filled(byte: u8, size: usize) -> Self {
        let page = Arc::new([byte; PAGE]);
        Self(vec![page; size / PAGE])
    }

    /// A snapshot of a region that shares equal pages with `before`.
    fn of(region: &[u8], before: &Self) -> Self {
        let pages = region.as_chunks::<PAGE>().0.iter().zip(&before.0);
        Self(
            pages
                .map(|(page, known)| if *page == **known { Arc::clone(known) } else { Arc::new(*page) })
                .collect(),
        )
    }

    /// Restores the region; equal pages are not written to.
    fn put_back(&self, region: &mut [u8]) {
        for (page, saved) in region.as_chunks_mut::<PAGE>().0.iter_mut().zip(&self.0) {
            if *page != **saved {
                *page = **saved;
            }
        }
    }

    /// Bytes of the pages that `other` does not share.
    fn bytes_beyond(&self, other: &Self) -> usize {
        self.0.iter().zip(&other.0).filter(|(page, known)| !Arc::ptr_eq(page, known)).count() * PAGE
    }
}

/// The regions.
#[derive(Clone, Debug)]
pub(super) struct Regions {
    sdram: Pages,
    iram: Pages,
    flash: Pages,
}

impl Regions {
    /// The regions of memory at power-up, with on-chip RAM of a size.
    fn new(iram: usize) -> Self {
        Self {
            sdram: Pages::filled(0, SDRAM_SIZE),
            iram: Pages::filled(0, iram),
            flash: Pages::filled(flash::ERASED_BYTE, flash::SIZE),
        }
    }
}

/// Guest memory as it was at an instant.
#[derive(Clone, Debug)]
pub struct MemorySnapshot {
    regions: Regions,
    is_flash_erased: bool,
    protection: Protection,
    is_touched: bool,
}

impl MemorySnapshot {
    /// Bytes of the pages that this snapshot does not share with `other`.
    #[must_use]
    pub fn bytes_beyond(&self, other: &Self) -> usize {
        let Regions { sdram, iram, flash } = &self.regions;
        sdram.bytes_beyond(&other.regions.sdram)
            + iram.bytes_beyond(&other.regions.iram)
            + flash.bytes_beyond(&other.regions.flash)
    }
}

impl GuestMemory {
    /// A snapshot of all memory, with the protection of program text.
    ///
    /// It takes host memory for the pages of 4 KiB that have changed since the last snapshot was taken or restored, and
    /// less than 40 KiB for the list of pages.
    pub fn snapshot(&mut self) -> MemorySnapshot {
        let before = self.last.take().unwrap_or_else(|| Regions::new(self.rest_bytes().len()));
        let regions = Regions {
            sdram: Pages::of(&self.sdram[..], &before.sdram),
            iram: Pages::of(self.rest_bytes(), &before.iram),
            flash: if self.flash.is_erased() {
                before.flash
            } else {
                Pages::of(self.flash.bytes(), &before.flash)
            },
        };
        self.last = Some(regions.clone());
        MemorySnapshot {
            regions,
            is_flash_erased: self.flash.is_erased(),
            protection: self.protection.clone(),
            is_touched: self.is_touched,
        }
    }

    /// Restores memory from `snapshot`, which may come from another memory.
    pub fn restore(&mut self, snapshot: &MemorySnapshot) {
        let MemorySnapshot { regions, is_flash_erased, protection, is_touched } = snapshot;
        regions.sdram.put_back(&mut self.sdram[..]);
        regions.iram.put_back(self.rest_bytes_mut());
        if *is_flash_erased {
            self.flash = Flash::default();
        } else {
            regions.flash.put_back(self.flash.bytes_mut());
        }
        self.protection.clone_from(protection);
        self.is_touched = *is_touched;
        self.last = Some(regions.clone());
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::GuestAddr;
    use kmotiondef::map::{FLASH, IRAM, SDRAM};

    use super::*;

    #[test]
    fn snapshots_restore_memory_and_share_unchanged_parts() {
        let mut memory = GuestMemory::new();
        let empty = memory.snapshot();
        memory.poke(SDRAM.base.offset(0x12_3456), 1_u8);
        let first = memory.snapshot();
        memory.poke(SDRAM.base.offset(0x12_3456), 2_u8);
        memory.poke(IRAM.base.offset(4), 3_u32);
        memory.poke(FLASH.base.offset(8), 4_u32);
        let changed = memory.clone();
        let second = memory.snapshot();
        assert_eq!(first.bytes_beyond(&empty), PAGE);
        assert_eq!(second.bytes_beyond(&first), 3 * PAGE);
        assert_eq!(memory.snapshot().bytes_beyond(&second), 0);
        memory.restore(&first);
        let peek = |memory: &GuestMemory, addr: GuestAddr| memory.peek::<u8>(addr);
        assert_eq!(peek(&memory, SDRAM.base.offset(0x12_3456)), 1);
        assert_eq!((peek(&memory, IRAM.base.offset(4)), peek(&memory, FLASH.base.offset(8))), (0, 0xff));
        for _ in 0..2 {
            memory.restore(&second);
            assert!(memory == changed);
        }
        let mut other = GuestMemory::new();
        other.restore(&second);
        assert!(other == changed);
    }
}
