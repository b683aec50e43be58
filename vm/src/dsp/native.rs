//! Hot code translated to host code.
//!
//! The executor of packets reports where branches arrive ([`Native::run`]). An address that is reached often is
//! translated with all packets reachable from it ([`region`]), for the effects in flight there ([`flying`]). A region
//! runs until something happens that only the interpreter handles, or until too little time is left. Both agree to the
//! cycle and to the bit. A store to code, like everything else that drops decoded packets, drops all regions.

mod access;
mod arith;
mod float;
mod flying;
mod packet;
mod region;

use std::collections::BTreeMap;

use self::flying::InFlightEffect;
use self::region::{LONGEST, NoRegion, PacketFinder, Region};
use super::cache::Cache;
use super::memory::Memory;
use super::pipeline::State;
use crate::native::Handover;

/// Arrivals after which a place is translated.
const HOT: u32 = 500;
/// A place that is not translated any more.
const COLD: u32 = u32::MAX;
/// Places that are counted, a power of two.
const PLACES: usize = 1024;
/// Most regions of one place, most regions.
const MOST_HERE: usize = 4;
const MOST: usize = 512;
/// Number of code changes after which nothing more is translated.
const MOST_CHANGES: u32 = 64;

/// The function that translates the packets reachable from an address.
#[derive(Clone, Copy, Debug)]
pub(super) struct RegionTranslator(Translate);

type Translate = fn(u32, Vec<InFlightEffect>, &mut PacketFinder<'_>) -> Result<Region, NoRegion>;

/// The translator to code of this computer.
pub(super) const TRANSLATOR: RegionTranslator = RegionTranslator(region::translate);

/// The addresses where branches arrive, and the code translated there.
#[derive(Debug)]
pub(super) struct Native {
    translator: RegionTranslator,
    /// Places, and how often they were reached.
    places: Box<[(u32, u32)]>,
    regions: BTreeMap<u32, Vec<Region>>,
    count: usize,
    /// The generation of the code that the regions were translated from.
    generation: u64,
    changes: u32,
    handover: Box<Handover>,
    flying: Vec<InFlightEffect>,
    /// Packets that regions have executed.
    packets: u64,
}

impl Native {
    /// A translator without any regions yet.
    pub(super) fn new(translator: RegionTranslator) -> Self {
        Self {
            translator,
            places: vec![(0, 0); PLACES].into_boxed_slice(),
            regions: BTreeMap::new(),
            count: 0,
            generation: 0,
            changes: 0,
            handover: Box::default(),
            flying: Vec::new(),
            packets: 0,
        }
    }
}

/// A copy is empty, as is a copy of the decoded packets.
impl Clone for Native {
    fn clone(&self) -> Self {
        Self::new(self.translator)
    }
}

/// The stack watch and the count of executed packets: the data of a core besides its state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Account {
    /// Limit and top.
    pub(super) stack: (u32, u32),
    /// The lowest stack pointer.
    pub(super) lowest: u32,
    /// Packets executed.
    pub(super) packets: u64,
}

impl Native {
    /// Executes regions from the address where a branch has arrived, for as long as there are any.
    pub(super) fn run<M: Memory>(
        &mut self,
        state: &mut State,
        cache: &mut Cache,
        memory: &mut M,
        account: &mut Account,
    ) {
        while state.clock.left() >= i64::from(LONGEST) && !state.is_idle {
            if self.generation != cache.generation() {
                self.clear(cache.generation());
            }
            let pc = state.pc();
            let place = &mut self.places[(pc >> 2) as usize % PLACES];
            if place.0 != pc {
                *place = (pc, 0);
            }
            if place.1 < HOT {
                place.1 += 1;
                return;
            }
            let is_cold = place.1 == COLD;
            if !state.list_flying(&mut self.flying) {
                return;
            }
            let known = self
                .regions
                .get(&pc)
                .and_then(|here| here.iter().position(|region| region.entry == self.flying));
            let index = match known {
                Some(index) => index,
                None if is_cold => return,
                None => match self.translate(pc, cache, memory) {
                    Some(index) => index,
                    None => return,
                },
            };
            if !self.enter(pc, index, state, cache, memory, account) {
                return;
            }
        }
    }

    /// Packets that regions have executed.
    pub(super) const fn packets(&self) -> u64 {
        self.packets
    }

    /// The code has changed.
    #[cold]
    fn clear(&mut self, generation: u64) {
        self.generation = generation;
        self.regions.clear();
        self.count = 0;
        self.changes += 1;
        let heat = if self.changes > MOST_CHANGES { COLD } else { 0 };
        self.places.iter_mut().for_each(|place| place.1 = heat);
    }

    /// Translates the code reached from `pc`; returns the index of the region.
    #[cold]
    fn translate<M: Memory>(&mut self, pc: u32, cache: &mut Cache, memory: &mut M) -> Option<usize> {
        let here = self.regions.get(&pc).map_or(0, Vec::len);
        let place = &mut self.places[(pc >> 2) as usize % PLACES];
        if here >= MOST_HERE || self.count >= MOST || self.changes > MOST_CHANGES || memory.ram().is_none() {
            place.1 = COLD;
            return None;
        }
        cache.mark_lines();
        let find: &mut PacketFinder<'_> = &mut |at| {
            let index = cache.find(at, memory).ok()?;
            let (packet, micros) = cache.packet(index);
            Some((packet, micros.to_vec()))
        };
        let Ok(region) = (self.translator.0)(pc, self.flying.clone(), find) else {
            place.1 = COLD;
            return None;
        };
        self.count += 1;
        let regions = self.regions.entry(pc).or_default();
        regions.push(region);
        Some(regions.len() - 1)
    }

    /// Runs a region; returns whether another one may follow.
    fn enter<M: Memory>(
        &mut self,
        pc: u32,
        index: usize,
        state: &mut State,
        cache: &mut Cache,
        memory: &mut M,
        account: &mut Account,
    ) -> bool {
        let Some(region) = self.regions.get(&pc).and_then(|here| here.get(index)) else { return false };
        let Some(ram) = memory.ram() else { return false };
        let Some(marks) = cache.marks(ram) else { return false };
        let handover = &mut *self.handover;
        state.take_flying(&region.entry, &mut handover.values);
        state.hand_over(handover);
        handover.time.packets = account.packets;
        (handover.stack.limit, handover.stack.top) = account.stack;
        handover.stack.lowest = account.lowest;
        handover.touched = 0;
        let number = region.piece.run(handover, &mut state.regs, ram, marks);
        if handover.touched != 0 {
            ram.mark_touched();
        }
        account.lowest = handover.stack.lowest;
        let went_on = handover.time.packets != account.packets;
        self.packets += handover.time.packets - account.packets;
        account.packets = handover.time.packets;
        state.take_back(handover);
        let Some(exit) = region.exits.get(number as usize) else { return false };
        state.pc = exit.pc.unwrap_or(handover.target);
        state.put_flying(&exit.flying, &handover.values);
        exit.is_end && went_on
    }
}
