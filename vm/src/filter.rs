//! Redundant accesses: those that equal one that the context has already made in the same slice.
//!
//! No other thread runs in a slice. So an instruction that accesses the same address several times is reported once,
//! unless the firmware requests repeats ([`RepeatPolicy`](crate::firmware::RepeatPolicy)). Accesses are kept in a table without
//! collision lists: an access that is evicted by another is reported again. The table is the same on every engine, and
//! so are the reports.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use kmotiondef::map::{PROGRAM_LIMIT, SDRAM};
use kmotiondef::{GuestAddr, Ticks};

use crate::engine::ContextId;

/// The number of entries; machine code has the table in the state of its context.
pub(crate) const ENTRIES: usize = 512;

const _: () = assert!(ENTRIES.is_power_of_two());

/// The bits of a key under the number of the slice.
const SLICE_SHIFT: u32 = 48;

/// The accesses of a context in its present slice.
#[derive(Clone, Debug)]
#[repr(C)]
pub(crate) struct AccessFilter {
    /// A number for the slice, above the bits of the keys.
    pub(crate) slice: Cell<u64>,
    /// The tick of the slice.
    tick: Cell<u64>,
    /// The keys of accesses, with the number of their slice.
    pub(crate) entries: [Cell<u64>; ENTRIES],
    /// The owners of pages, and the context as they have it; machine code has them elsewhere.
    owners: Option<(Arc<PageOwners>, u8)>,
}

impl AccessFilter {
    /// An empty filter.
    pub(crate) const fn new() -> Self {
        Self {
            slice: Cell::new(1 << SLICE_SHIFT),
            tick: Cell::new(u64::MAX),
            entries: [const { Cell::new(0) }; ENTRIES],
            owners: None,
        }
    }

    /// An empty filter for a context.
    pub(crate) fn with_owners(owners: &Arc<PageOwners>, context: ContextId) -> Self {
        Self { owners: Some((Arc::clone(owners), owner_code(context))), ..Self::new() }
    }

    /// Reports whether only this context has accessed the page of an address.
    #[inline(always)]
    pub(crate) fn owns(&self, address: u32) -> bool {
        self.owners.as_ref().is_some_and(|(owners, code)| owners.owner(address) == *code)
    }

    /// The context continues in a slice of `tick`.
    pub(crate) fn continues(&self, tick: Ticks) {
        if self.tick.replace(tick.get()) != tick.get() {
            self.clear();
        }
    }

    /// Forgets all accesses.
    pub(crate) fn clear(&self) {
        let next = self.slice.get().wrapping_add(1 << SLICE_SHIFT);
        if next == 0 {
            self.entries.iter().for_each(|entry| entry.set(0));
        }
        self.slice.set(next.max(1 << SLICE_SHIFT));
    }

    /// Reports whether the instruction `word` has accessed this address.
    #[inline(always)]
    pub(crate) fn knows(&self, word: usize, address: u32) -> bool {
        self.entries[place(word, address)].get() == self.slice.get() + key(word, address)
    }

    /// Notes an access.
    pub(crate) fn note(&self, word: usize, address: u32) {
        self.entries[place(word, address)].set(self.slice.get() + key(word, address));
    }

    /// Restores the entries of `saved`.
    #[cfg(feature = "native")]
    pub(crate) fn put_back(&self, saved: &Self) {
        self.slice.set(saved.slice.get());
        self.tick.set(saved.tick.get());
        for (own, saved) in self.entries.iter().zip(&saved.entries) {
            own.set(saved.get());
        }
    }
}

/// The key of an access of the instruction `word`; the address is the lowest part.
#[inline(always)]
pub(crate) const fn key(word: usize, address: u32) -> u64 {
    (word as u64 & 0xFFFF) << 32 | address as u64
}

/// The entry of an access.
#[inline(always)]
const fn place(word: usize, address: u32) -> usize {
    ((address >> 2) ^ place_of_word(word)) as usize % ENTRIES
}

/// The bits of the entry's number that depend on the instruction.
#[inline(always)]
pub(crate) const fn place_of_word(word: usize) -> u32 {
    (word as u32).wrapping_mul(37)
}

/// The bits of an address within a page of SDRAM, and the number of pages.
pub(crate) const PAGE_BITS: u32 = 12;
const PAGES: usize = (SDRAM.size >> PAGE_BITS) as usize;

const _: () = assert!(PAGES.is_power_of_two());

/// The mark of a page that several contexts have accessed.
const SHARED: u8 = u8::MAX;

/// For each page of SDRAM after the programs, the only context that has accessed it so far; 0 for none.
///
/// Accesses to a page by its only user are not reported. From the first access by another context on, all accesses to
/// the page are. The pages before, which hold stacks and programs, have no owner; an address outside SDRAM is treated
/// like one of them.
#[derive(Debug)]
pub(crate) struct PageOwners(Box<[AtomicU8; PAGES]>);

impl Default for PageOwners {
    fn default() -> Self {
        Self(Box::new([const { AtomicU8::new(0) }; PAGES]))
    }
}

/// The mark of the pages of a context.
pub(crate) const fn owner_code(context: ContextId) -> u8 {
    context.index() as u8 + 1
}

impl PageOwners {
    #[inline(always)]
    fn owner(&self, address: u32) -> u8 {
        let page = (address.wrapping_sub(SDRAM.base.get()) >> PAGE_BITS) as usize % PAGES;
        self.0[page].load(Ordering::Relaxed)
    }

    /// Notes an access of `size` bytes; returns whether no other context has accessed its pages.
    pub(crate) fn claim(&self, context: ContextId, address: GuestAddr, size: u32) -> bool {
        let (first, end) = (address.get(), address.get().wrapping_add(size.max(1)));
        if first < PROGRAM_LIMIT || end.wrapping_sub(SDRAM.base.get()) > SDRAM.size || end < first {
            return false;
        }
        let (own, mut is_own) = (owner_code(context), true);
        let page = |address: u32| ((address - SDRAM.base.get()) >> PAGE_BITS) as usize;
        for page in &self.0[page(first)..=page(end - 1)] {
            let owner = page.load(Ordering::Relaxed);
            let is_free = owner == 0 || owner == own;
            page.store(if is_free { own } else { SHARED }, Ordering::Relaxed);
            is_own &= is_free;
        }
        is_own
    }

    /// The marks of all pages, to be put back.
    pub(crate) fn marks(&self) -> Box<[u8]> {
        self.0.iter().map(|page| page.load(Ordering::Relaxed)).collect()
    }

    /// Restores the marks.
    pub(crate) fn put_back(&self, marks: &[u8]) {
        for (page, mark) in self.0.iter().zip(marks) {
            page.store(*mark, Ordering::Relaxed);
        }
    }

    /// The mark of the first page, for machine code, which reads them.
    #[cfg(feature = "native")]
    pub(crate) fn first(&self) -> *const u8 {
        self.0.as_ptr().cast()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_an_owner_until_another_context_accesses_it() {
        let owners = Arc::new(PageOwners::default());
        let [one, other] =
            [1, 2].map(|number| ContextId::of(kmotiondef::ThreadId::new(number).expect("one")));
        let filter = AccessFilter::with_owners(&owners, one);
        let page = |number: u32| GuestAddr::new(0x8020_0000 + (number << PAGE_BITS));
        assert!(!filter.owns(page(0).get()));
        assert!(owners.claim(one, page(0), 8) && owners.claim(one, page(0).offset(8), 1 << PAGE_BITS));
        assert!(filter.owns(page(0).get()) && filter.owns(page(1).get()) && !filter.owns(page(2).get()));
        let marks = owners.marks();
        assert!(!owners.claim(other, page(1), 4) && !owners.claim(one, page(1), 4));
        assert!(filter.owns(page(0).get()) && !filter.owns(page(1).get()));
        owners.put_back(&marks);
        assert!(filter.owns(page(1).get()));
        for address in [0x1001_6E00, 0x8000_0100, 0x8005_0000, 0x80FF_FFFE] {
            assert!(!owners.claim(one, GuestAddr::new(address), 4) && !filter.owns(address), "{address:#x}");
        }
    }

    #[test]
    fn an_access_is_known_until_the_slice_is_over() {
        let filter = AccessFilter::new();
        filter.continues(Ticks::new(7));
        assert!(!filter.knows(3, 0x1000_0040));
        filter.note(3, 0x1000_0040);
        filter.note(4, 0x1000_0044);
        filter.continues(Ticks::new(7));
        assert!(filter.knows(3, 0x1000_0040) && filter.knows(4, 0x1000_0044));
        assert!(!filter.knows(4, 0x1000_0040) && !filter.knows(3, 0x1000_0044));
        filter.continues(Ticks::new(9));
        assert!(!filter.knows(3, 0x1000_0040));
    }

    #[test]
    fn what_was_known_does_not_come_back_when_the_numbers_of_slices_do() {
        let filter = AccessFilter::new();
        filter.note(3, 0x1000_0040);
        for _ in 0..1 << 16 {
            filter.clear();
            assert!(!filter.knows(3, 0x1000_0040));
        }
    }
}
