//! Decoded packets by address.
//!
//! Packets that follow each other in memory are decoded together and follow each other here, so that straight-line code
//! needs no search. Pages of 4 KiB record which packet begins at each word, and which 32-byte lines hold decoded words:
//! a store to such a line drops only the packets of that line.

use super::decode::{DecodedPacket, FORESEEN, MicroOp, NoPacket, Packet, STEADY, decode};
use super::memory::Memory;
use super::work::Work;

/// The number of packets decoded at once.
const RUN: usize = 64;
/// The capacity of the cache, in packets; when it is exceeded, the cache is cleared.
const MOST: usize = 1 << 20;
/// Bytes of a page, of a line.
const PAGE: u32 = 1 << PAGE_BITS;
const PAGE_BITS: u32 = 12;
const LINE: u32 = 32;
/// Words of a page.
const WORDS: usize = PAGE as usize / 4;
/// Places for pages: as many as the two RAMs have.
const PLACES: usize = 1 << 13;
/// Distance before a line at which a packet that reaches into it may begin, in bytes: a packet has at most eight words.
const BEFORE: u32 = 28;
/// No packet begins there.
const NONE: u32 = u32::MAX;

/// The decoded packets of a page.
#[derive(Debug)]
struct Page {
    /// Its number: address / 4096.
    number: u32,
    /// Lines that hold decoded words, a bit each.
    lines: u128,
    /// The packet that begins at each word.
    packets: [u32; WORDS],
}

/// Decoded packets of one context.
#[derive(Debug)]
pub(super) struct Cache {
    packets: Vec<Packet>,
    micros: Vec<MicroOp>,
    pages: Box<[Option<Box<Page>>]>,
    /// Number of times that decoded packets were dropped.
    generation: u64,
    /// Addresses that are searched even where the packet before is followed by them, in order.
    stops: Vec<u32>,
    #[cfg(feature = "native")]
    marks: super::marks::LineMarks,
}

impl Default for Cache {
    fn default() -> Self {
        let pages = std::iter::repeat_with(|| None).take(PLACES).collect();
        Self {
            packets: Vec::new(),
            micros: Vec::new(),
            pages,
            generation: 0,
            stops: Vec::new(),
            #[cfg(feature = "native")]
            marks: Default::default(),
        }
    }
}

/// A copy keeps only its stops: decoded packets can be derived from memory again, and copies are made for snapshots.
impl Clone for Cache {
    fn clone(&self) -> Self {
        Self { stops: self.stops.clone(), ..Self::default() }
    }
}

/// The index of the page of an address: SDRAM and on-chip RAM have a page for every address.
#[inline(always)]
const fn place(at: u32) -> usize {
    (at >> PAGE_BITS & 0xFFF | (at >> 31) << 12) as usize
}

#[inline(always)]
const fn line_bit(at: u32) -> u128 {
    1 << (at % PAGE / LINE)
}

/// Changes each product of doubles of a packet.
fn each_product(packet: Packet, micros: &mut [MicroOp], change: impl Fn(&mut MicroOp)) {
    let first = packet.first as usize;
    let own = micros[first..first + usize::from(packet.count)].iter_mut();
    own.filter(|micro| micro.work == Work::Mpydp).for_each(change);
}

impl Cache {
    /// The packets from this index on, and the instructions from the first one of these packets on: instructions are
    /// stored in the order of their packets.
    #[inline(always)]
    pub(super) fn follow(&self, index: u32) -> (&[Packet], &[MicroOp]) {
        let packets = &self.packets[index as usize..];
        let first = packets.first().map_or(0, |packet| packet.first as usize);
        (packets, &self.micros[first..])
    }

    /// The packet with this index, and its instructions.
    pub(super) fn packet(&self, index: u32) -> (Packet, &[MicroOp]) {
        let packet = self.packets[index as usize];
        let first = packet.first as usize;
        (packet, &self.micros[first..first + usize::from(packet.count)])
    }

    /// The index of the packet at an address, decoded if need be.
    #[inline(always)]
    pub(super) fn find<M: Memory>(&mut self, at: u32, memory: &M) -> Result<u32, NoPacket> {
        match self.known(at) {
            Some(index) => Ok(index),
            None => self.fill(at, memory),
        }
    }

    #[inline(always)]
    fn page(&self, at: u32) -> Option<&Page> {
        self.pages[place(at)].as_deref().filter(|page| page.number == at >> PAGE_BITS)
    }

    #[inline(always)]
    fn known(&self, at: u32) -> Option<u32> {
        let index = self.page(at)?.packets[(at % PAGE / 4) as usize];
        (index != NONE).then_some(index)
    }

    /// Decodes packets from `at` on, up to one that is already decoded or cannot be decoded.
    #[cold]
    fn fill<M: Memory>(&mut self, at: u32, memory: &M) -> Result<u32, NoPacket> {
        if self.packets.len() >= MOST {
            self.clear();
        }
        let start = self.packets.len();
        let mut next = at;
        while self.packets.len() < start + RUN && self.known(next).is_none() {
            let DecodedPacket { packet, writes } = match decode(memory, next, &mut self.micros) {
                Ok(packet) => packet,
                Err(reason) if self.packets.len() == start => return Err(reason),
                Err(_) => break,
            };
            self.note(next, packet.end);
            if self.packets.len() > start && !self.is_stop(next) {
                self.link_last(writes);
            }
            next = packet.end;
            self.packets.push(packet);
        }
        Ok(start as u32)
    }

    /// The last packet is followed by one that writes these registers in E1.
    fn link_last(&mut self, writes: u64) {
        let Some(last) = self.packets.last_mut() else { return };
        last.is_linked = !last.is_idle;
        let writes = if last.cycles == 1 { writes } else { 0 };
        each_product(*last, &mut self.micros, |micro| {
            let is_foreseen = micro.flags & STEADY != 0 && writes >> (micro.a | 1) & 1 == 0;
            micro.extra = if is_foreseen { FORESEEN } else { 0 };
        });
    }

    /// The next packet begins at `at`, and its words end before `end`.
    fn note(&mut self, at: u32, end: u32) {
        let index = self.packets.len() as u32;
        self.page_mut(at).packets[(at % PAGE / 4) as usize] = index;
        let mut word = at;
        while word != end {
            self.page_mut(word).lines |= line_bit(word);
            #[cfg(feature = "native")]
            self.marks.mark_code(word);
            word = word.wrapping_add(4);
        }
    }

    fn page_mut(&mut self, at: u32) -> &mut Page {
        let number = at >> PAGE_BITS;
        let page = &mut self.pages[place(at)];
        if page.as_ref().is_some_and(|page| page.number != number) {
            // Only addresses outside both RAMs share places.
            *page = None;
        }
        page.get_or_insert_with(|| Box::new(Page { number, lines: 0, packets: [NONE; WORDS] }))
    }

    /// Reports whether a store to `at` changes words that were decoded.
    #[inline(always)]
    pub(super) fn is_code(&self, at: u32) -> bool {
        self.page(at).is_some_and(|page| page.lines & line_bit(at) != 0)
    }

    /// The line of `at` has changed: drops the packets that have words of it.
    #[cold]
    pub(super) fn drop_line(&mut self, at: u32) {
        let line = at & !(LINE - 1);
        self.generation += 1;
        for word in (line.wrapping_sub(BEFORE)..line.wrapping_add(LINE)).step_by(4) {
            if let Some(index) = self.known(word) {
                self.page_mut(word).packets[(word % PAGE / 4) as usize] = NONE;
                if let Some(previous) = index.checked_sub(1) {
                    let previous = &mut self.packets[previous as usize];
                    previous.is_linked = false;
                    each_product(*previous, &mut self.micros, |micro| micro.extra = 0);
                }
            }
        }
        self.page_mut(line).lines &= !line_bit(line);
    }

    /// Drops all decoded packets.
    pub(super) fn clear(&mut self) {
        let stops = std::mem::take(&mut self.stops);
        *self = Self { generation: self.generation + 1, stops, ..Self::default() };
    }

    /// Has these addresses be searched, and no others.
    pub(super) fn set_stops(&mut self, addresses: impl IntoIterator<Item = u32>) {
        let mut stops: Vec<_> = addresses.into_iter().collect();
        stops.sort_unstable();
        stops.dedup();
        if stops != self.stops {
            self.stops = stops;
            self.clear();
        }
    }

    /// Addresses that are searched, in order.
    pub(super) fn stops(&self) -> &[u32] {
        &self.stops
    }

    /// Reports whether an address is one of them.
    #[inline(always)]
    pub(super) fn is_stop(&self, at: u32) -> bool {
        self.stops.binary_search(&at).is_ok()
    }

    /// A number that changes whenever decoded packets are dropped.
    pub(super) const fn generation(&self) -> u64 {
        self.generation
    }

    /// Begins to mark the lines of decoded packets for translated code.
    #[cfg(feature = "native")]
    pub(super) fn mark_lines(&mut self) {
        if self.marks.begin() {
            let pages = self.pages.iter().flatten();
            for page in pages {
                for line in (0..PAGE / LINE).filter(|line| page.lines >> line & 1 != 0) {
                    self.marks.mark_code((page.number << PAGE_BITS) + line * LINE);
                }
            }
        }
    }

    /// Marks the lines that translated code must not store to: decoded packets, and the protected parts of `memory`.
    #[cfg(feature = "native")]
    pub(super) fn marks(&mut self, memory: &crate::memory::GuestMemory) -> Option<&crate::native::Marks> {
        self.marks.follow(memory.protected_texts())
    }
}
